//! What may spoil a run that is not wrong.

use super::bound::{rounded, shown};
use super::check::{bytes, count_of, grains_per_cell, spoken};
use super::estimate;
use super::model::{EngineKind, EnskogFactor, Scenario, Spacing, TimeStep};
use super::{collapse, cost, initial, pace};
use crate::law::boundary::Face;
use crate::law::kinetic_theory::mean_free_path;
use crate::law::restitution::{Constant, RestitutionLaw};
use crate::space::Vector;
use crate::stopwatch::Machine;

/// Logs above this size are seldom meant [bytes].
const LARGE_LOG: f64 = 1e10;
/// Nobody waits longer for a run [s].
const LONGEST_WAIT: f64 = 30.0 * 86_400.0;
/// Fewer cells than this across a gap do not show its profile.
const CELLS_OF_A_GRADIENT: u32 = 8;
/// A step that is capped to less than this share of its length is another choice than it says.
const CAPPED: f64 = 0.5;

/// Everything that may spoil `scenario` on `machine`.
pub(super) fn warnings<V: Vector>(scenario: &Scenario<V>, machine: Machine) -> Vec<String> {
    let groups = [
        engine(scenario),
        cells(scenario),
        gradients(scenario),
        gravity(scenario),
        collapse::warning(scenario).into_iter().collect(),
        time_step(scenario),
        capped_step(scenario),
        recordings(scenario),
        fields(scenario),
        patience(scenario),
        memory(scenario, machine),
        disk(scenario, machine),
    ];
    groups.into_iter().flatten().collect()
}

/// What the engine lacks.
fn engine<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let mut warnings = Vec::new();
    let kind = scenario.engine.kind;
    if kind == EngineKind::Dsmc && scenario.volume_fraction() > 0.1 {
        warnings.push(format!(
            "dsmc treats grains as points: at ν = {} it collides {} times too rarely; cba, hsmc and event-driven do not",
            rounded(scenario.volume_fraction()),
            rounded(V::contact_correlation(scenario.volume_fraction()))
        ));
    }
    if matches!(kind, EngineKind::Dsmc | EngineKind::Cba) && cost::settles(scenario) {
        warnings.push(format!(
            "{} has no excluded volume: under gravity grains pile up beyond any possible density; hsmc and \
             event-driven have one",
            kind.name()
        ));
    }
    warnings
}

/// Cells of a size, or with a number of grains, that mislead.
fn cells<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let mut warnings = Vec::new();
    let engine = &scenario.engine;
    // The cells of an event-driven run serve its measures alone.
    if engine.kind.is_event_driven() {
        return warnings;
    }
    let per_cell = grains_per_cell(scenario, f64::from(scenario.count));
    let local = engine.kind != EngineKind::Dsmc && engine.enskog_factor == EnskogFactor::Local;
    let gas = scenario.source.is_none() && scenario.gravity == V::ZERO;
    if local && gas && scenario.count > 0 && per_cell < 5.0 {
        warnings.push(format!(
            "{} grains per cell: below 5 the local Enskog factor follows noise; enlarge engine.cell_size or \
             write enskog_factor = \"smoothed\"",
            rounded(per_cell)
        ));
    }
    let driven = scenario.boundary.largest_wall_speed() > 0.0;
    let longest = scenario.grid().side().components().into_iter().fold(0.0, f64::max);
    let path = mean_free_path::<V>(scenario.mean_grain(), scenario.volume_fraction());
    if driven && scenario.count > 0 && longest > 1.1 * path {
        warnings.push(format!(
            "cells of {} are longer than the mean free path {}: they raise the viscosity of a driven flow",
            rounded(longest),
            rounded(path)
        ));
    }
    if let Some(capacity) = scenario.capacity().filter(|&capacity| capacity < 4) {
        warnings.push(format!(
            "a cell holds {capacity} grains only: from 4 on hsmc is sound; enlarge engine.cell_size"
        ));
    }
    if let Some(above) = initial::cells_above_capacity(scenario).filter(|&above| above > 0) {
        warnings.push(format!(
            "{above} cells start above their capacity: they admit nobody until they empty; take fewer grains, another \
             engine.cell_size or a larger engine.hsmc.maximum_volume_fraction if that is not meant"
        ));
    }
    warnings
}

/// Axes along which flow and density change from wall to wall, and cells that are too few to show how.
fn gradients<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
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

/// Where gravity takes the grains.
fn gravity<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let mut warnings = Vec::new();
    for axis in (0..V::DIMENSION).filter(|&axis| scenario.gravity[axis] != 0.0) {
        let Some(faces) = scenario.boundary.faces(axis) else { continue };
        let (side, name) = if scenario.gravity[axis] < 0.0 { (0, "lower") } else { (1, "upper") };
        if faces[side] == Face::Open {
            let axis = V::AXIS_NAMES[axis];
            warnings.push(format!("gravity pulls grains out of the open face boundary.{axis}.{name}"));
        }
    }
    warnings
}

/// A fixed step that does not fit what the gas becomes.
fn time_step<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
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
            shown(step),
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
fn capped_step<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
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

/// More recordings, or larger ones, than anybody wants.
fn recordings<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let mut warnings = Vec::new();
    let recordings = cost::recordings(scenario);
    let key = if matches!(scenario.record.spacing, Spacing::Every(_)) { "every" } else { "frames" };
    // The number of steps is an estimate, and may be a little short.
    if let Some(steps) = estimate::steps(scenario).filter(|_| recordings.wanted > 1.2 * recordings.made) {
        warnings.push(format!(
            "record.{key} asks for {} recordings of about {} steps: every step will be recorded, none more often",
            count_of(recordings.wanted),
            count_of(steps.most)
        ));
    }
    let size = cost::log_size(scenario);
    if size > LARGE_LOG {
        let remedy = if key == "every" { "a larger record.every" } else { "fewer record.frames" };
        warnings.push(format!(
            "the log takes about {} before compression; {remedy}, record.points or record.states make it smaller",
            bytes(size)
        ));
    }
    warnings
}

/// Fields that the engine does not have.
fn fields<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let lacking =
        scenario.record.fields.iter().filter(|&&named| scenario.fields().all(|field| field != named));
    let names: Vec<&str> = lacking.map(|field| field.name()).collect();
    let warning = || {
        format!(
            "record.fields names {}, but {} draws no candidate pairs: nothing is recorded of that",
            names.join(" and "),
            scenario.engine.kind.name()
        )
    };
    (!names.is_empty()).then(warning).into_iter().collect()
}

/// More time than anybody has.
fn patience<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let long = cost::seconds(scenario).filter(|seconds| seconds.least > LONGEST_WAIT);
    let warning = |seconds: estimate::Estimate| {
        format!(
            "the run takes about {} on one core; fewer grains, a longer step or a lower limit of [run] make it shorter",
            spoken(seconds.least)
        )
    };
    long.map(warning).into_iter().collect()
}

/// More memory than there is.
fn memory<V: Vector>(scenario: &Scenario<V>, machine: Machine) -> Vec<String> {
    lacking(cost::memory(scenario), machine.memory, |needed, free| {
        format!(
            "the run takes about {needed} of memory, and {free} are free; take fewer grains, cells, frames or points"
        )
    })
}

/// A larger log than there is room for.
fn disk<V: Vector>(scenario: &Scenario<V>, machine: Machine) -> Vec<String> {
    lacking(cost::log_size(scenario), machine.disk, |needed, free| {
        format!(
            "the log takes about {needed} before compression, and the disk has room for {free}; free some, choose another \
             --out, or take fewer record.frames, record.points or record.states"
        )
    })
}

/// What to say where more is needed than there is, if that is known [bytes].
fn lacking(needed: f64, there: Option<u64>, words: impl Fn(String, String) -> String) -> Vec<String> {
    let there = there.map(|bytes| bytes as f64).filter(|&there| needed > there);
    there.map(|there| words(bytes(needed), bytes(there))).into_iter().collect()
}

#[cfg(test)]
mod tests {
    use crate::scenario::check::{check, check_on};
    use crate::scenario::model::AnyScenario;
    use crate::scenario::{Overrides, load};
    use crate::stopwatch::Machine;

    fn scenario(name: &str, sets: &[&str]) -> AnyScenario {
        let sets = sets.iter().map(ToString::to_string).collect();
        load(name, &Overrides { sets, ..Default::default() }).unwrap_or_else(|error| panic!("{error}"))
    }

    fn warned(name: &str, sets: &[&str]) -> String {
        check(&scenario(name, sets)).warnings.join("\n")
    }

    #[test]
    fn what_may_spoil_the_result_is_said() {
        assert!(!warned("shear", &["engine.kind=dsmc"]).contains("as points"));
        assert!(warned("cooling", &["engine.kind=dsmc"]).contains("as points"));
        assert!(warned("cooling", &["engine.kind=cba", "engine.cell_size=3"]).contains("below 5"));
        assert!(warned("shear", &["engine.cell_size=8"]).contains("mean free path 2.35"));
        assert!(warned("heap", &["boundary.y.lower=open"]).contains("boundary.y.lower"));
        for quiet in ["heap", "heap-full", "pipe", "cooling", "clustering", "sedimentation"] {
            assert_eq!(warned(quiet, &[]), "", "{quiet}");
        }
    }

    #[test]
    fn points_under_gravity_pile_up() {
        for kind in ["dsmc", "cba"] {
            let kind = format!("engine.kind={kind}");
            assert!(warned("heap", &[&kind]).contains("beyond any possible density"));
            assert!(warned("sedimentation", &[&kind]).contains("no excluded volume"));
            assert!(!warned("pipe", &[&kind]).contains("no excluded volume"));
        }
    }

    #[test]
    fn a_fixed_step_that_a_fall_makes_too_long_is_foreseen() {
        // √(2 · 9.81 · 0.04) = 0.886: 0.002/0.886 = 2.26e-3.
        let warning = warned("sedimentation", &["engine.time_step.fixed=3e-3"]);
        assert!(warning.contains("falls freely comes to move at 0.8859"), "{warning}");
        assert!(warning.contains("engine.time_step.fixed = 0.0022"), "{warning}");
        assert_eq!(warned("sedimentation", &["engine.time_step.fixed=2e-3"]), "");
        // The spout of a heap is low; its box is not.
        let filled = ["particles.count=10", "engine.time_step.fixed=0.15"];
        assert!(warned("heap", &filled).contains("17.89"), "{}", warned("heap", &filled));
        // The tail of a Maxwellian at the start.
        let tail = ["engine.time_step.fixed=1", "engine.cell_size=2.5"];
        assert!(warned("shear", &tail).contains("the fastest grain of the start"));
    }

    #[test]
    fn cells_that_start_too_full_are_allowed_and_said() {
        let full = ["particles.volume_fraction=0.9", "initial.velocities={maxwell=1}"];
        let warning = warned("cooling", &full);
        assert!(warning.contains("cells start above their capacity: they admit nobody"), "{warning}");
        let share = ["particles.volume_fraction=0.8", "initial.positions=lattice"];
        assert_eq!(warned("cooling", &share), "");
    }

    #[test]
    fn recordings_beyond_reason_are_said() {
        let often = warned("heap", &["record.every=1e-9"]);
        assert!(often.contains("of about 64000 steps: every step will be recorded"), "{often}");
        assert!(!often.contains("TB"), "{often}");
        let all = ["record.points=all", "record.frames=4000", "particles.count=100000"];
        let large = warned("clustering", &all);
        assert!(large.contains("record.frames asks for 4001 recordings of about 527 steps"), "{large}");
        let large = warned("clustering", &["record.points=all", "record.frames=4000", "run={steps=5000}"]);
        assert!(large.contains("the log takes about 11"), "{large}");
    }

    #[test]
    fn memory_and_disk_are_compared_with_what_is_free() {
        let clustering = scenario("clustering", &[]);
        let warnings = |memory, disk| check_on(&clustering, Machine { memory, disk }).warnings;
        assert!(warnings(Some(16_000_000_000), Some(16_000_000_000)).is_empty());
        let said = warnings(Some(50_000_000), None);
        assert!(said.len() == 1 && said[0].contains("50.0 MB are free"), "{said:?}");
        let said = warnings(None, Some(2_000_000));
        assert!(said.len() == 1 && said[0].contains("the disk has room for 2.0 MB"), "{said:?}");
    }

    #[test]
    fn a_step_that_is_capped_throughout_is_said() {
        let dilute = ["particles.volume_fraction=0.002", "engine.cell_size=5"];
        let said = warned("cooling", &dilute);
        assert!(said.contains("the step is capped throughout") && said.contains("crossing = 0.5"), "{said}");
        assert!(!warned("cooling", &["engine.time_step={crossing=0.5}"]).contains("capped"));
        assert!(
            !warned("cooling", &[&dilute[..], &["engine.kind=event-driven"]].concat()).contains("capped")
        );
    }

    #[test]
    fn too_few_cells_for_a_gradient_are_said() {
        assert!(
            warned("shear", &["engine.cell_size=8"]).contains("5 cells along y: what a moving wall makes")
        );
        assert!(!warned("shear", &[]).contains("cells along"));
        let flat = ["domain.size[1]=0.012", "particles.count=5"];
        assert!(warned("sedimentation", &flat).contains("6 cells along y: what gravity makes"));
    }

    #[test]
    fn runs_that_nobody_waits_for_are_said() {
        assert!(warned("heap", &["engine.time_step.fixed=1e-9"]).contains("days on one core; fewer grains"));
        assert!(!warned("heap-full", &[]).contains("on one core"));
    }
}
