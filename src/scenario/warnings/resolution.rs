//! Cells and steps that are too coarse for what happens in them.

use crate::law::restitution::{Constant, RestitutionLaw};
use crate::number::exact;
use crate::scenario::bound::rounded;
use crate::scenario::check::grains_per_cell;
use crate::scenario::model::{EngineKind, EnskogFactor, Scenario, TimeStep};
use crate::scenario::{estimate, initial, pace};
use crate::space::Vector;

/// Fewer cells than this across a gap do not show its profile.
const CELLS_OF_A_GRADIENT: u32 = 8;
/// Fewer grains than this in a cell say little about the density there.
const FEWEST_GRAINS: f64 = 5.0;
/// A step that is capped to less than this share of its length is another choice than it says.
const CAPPED: f64 = 0.5;

/// Cells of a size, or with a number of grains, that mislead.
pub(super) fn cells<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    // The cells of an event-driven run serve its measures alone.
    if scenario.engine.kind.is_event_driven() {
        return Vec::new();
    }
    [noisy_factor(scenario), small_capacity(scenario), full_cells(scenario)].into_iter().flatten().collect()
}

/// The local Enskog factor of too few grains.
fn noisy_factor<V: Vector>(scenario: &Scenario<V>) -> Option<String> {
    let engine = &scenario.engine;
    let per_cell = grains_per_cell(scenario, f64::from(scenario.count));
    let local = engine.kind != EngineKind::Dsmc && engine.enskog_factor == EnskogFactor::Local;
    // Between moving walls larger cells do more harm than this does good: what is known of both stands in one place.
    let gas = scenario.source.is_none()
        && scenario.gravity == V::ZERO
        && scenario.boundary.largest_wall_speed() == 0.0;
    (local && gas && scenario.count > 0 && per_cell < FEWEST_GRAINS).then(|| {
        format!(
            "{} grains per cell: below {FEWEST_GRAINS} the local Enskog factor follows noise; enlarge engine.cell_size or \
             write enskog_factor = \"smoothed\"",
            rounded(per_cell)
        )
    })
}

/// Cells that hold next to nothing.
fn small_capacity<V: Vector>(scenario: &Scenario<V>) -> Option<String> {
    scenario.capacity().filter(|&capacity| capacity < 4).map(|capacity| {
        format!("a cell holds {capacity} grains only: from 4 on hsmc is sound; enlarge engine.cell_size")
    })
}

/// Cells with more grains than they may have.
fn full_cells<V: Vector>(scenario: &Scenario<V>) -> Option<String> {
    initial::cells_above_capacity(scenario).filter(|&above| above > 0).map(|above| {
        format!(
            "{above} cells start above their capacity: they admit nobody until they empty; take fewer grains, another \
             engine.cell_size or a larger engine.hsmc.maximum_volume_fraction if that is not meant"
        )
    })
}

/// Axes along which flow and density change from wall to wall, and cells that are too few to show how.
pub(super) fn gradients<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let mut warnings = Vec::new();
    if scenario.engine.kind.is_event_driven() {
        return warnings;
    }
    for axis in 0..V::DIMENSION {
        let moving =
            scenario.boundary.walls().any(|(other, _, wall)| other == axis && wall.largest_speed() > 0.0);
        let falling = scenario.gravity[axis] != 0.0 && !scenario.boundary.is_periodic(axis);
        let cells = scenario.cells[axis];
        if (moving || falling) && cells < CELLS_OF_A_GRADIENT {
            let (name, what) = (V::AXIS_NAMES[axis], if falling { "gravity" } else { "a moving wall" });
            warnings.push(format!(
                "{cells} cells along {name}: what {what} makes of density and flow there changes within a cell, and from \
                 {CELLS_OF_A_GRADIENT} on it is resolved; reduce engine.cell_size or enlarge domain.size"
            ));
        }
    }
    warnings
}

/// A fixed step that does not fit what the gas becomes.
pub(super) fn time_step<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let mut warnings = Vec::new();
    let TimeStep::Fixed(step) = scenario.engine.time_step else { return warnings };
    if scenario.engine.kind.is_event_driven() {
        return warnings;
    }
    let (start, later) = (pace::starting_speed(scenario), pace::falling_speed(scenario));
    let too_long = |speed: f64| step > pace::longest_step(scenario, speed);
    if too_long(later) {
        let (who, speed) = if too_long(start) {
            ("the fastest grain of the start moves", start)
        } else {
            ("a grain that falls freely comes to move", later)
        };
        warnings.push(format!(
            "the fixed step {} will be too long: {who} at {}, and a step that is too long ends the run; \
             engine.time_step.fixed = {} would do",
            exact(step),
            rounded(speed),
            pace::rounded_down(pace::longest_step(scenario, later))
        ));
    }
    let undriven = scenario.gravity == V::ZERO && scenario.boundary.largest_wall_speed() == 0.0;
    let elastic = scenario.restitution == RestitutionLaw::Constant(Constant(1.0));
    if undriven && !elastic {
        warnings.push(
            "a fixed step suits a gas that cools badly: time_step = { collisions_per_particle = 0.1 } grows with it"
                .to_owned(),
        );
    }
    warnings
}

/// A step that the cap decides, not the key.
pub(super) fn capped_step<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let capped = estimate::capped_step(scenario).filter(|(chosen, longest)| *longest < CAPPED * chosen);
    let warning = |(chosen, longest)| {
        format!(
            "the step is capped throughout: engine.time_step.collisions_per_particle asks for {}, and half a cell at the \
             largest speed takes {}; a larger engine.cell_size allows it, time_step = {{ crossing = 0.5 }} says what happens",
            rounded(chosen),
            rounded(longest)
        )
    };
    capped.map(warning).into_iter().collect()
}
