//! From a table of keys to a checked scenario.

use super::cells::CellPlan;
use super::consistency::{self, Story};
use super::model::{
    EngineChoice, EngineKind, HsmcRules, Initial, InitialPositions, InitialVelocities, Scenario,
};
use super::reader::Section;
use super::tables::engine::{CellRestitution, EngineTable};
use super::tables::initial::InitialTable;
use super::tables::particles::{self, Matter, ParticlesTable};
use super::tables::source::Surroundings;
use super::tables::{boundary, engine, head, initial, record, run, source};
use super::walls;
use super::{initial as state, pace};
use crate::law::restitution::RestitutionLaw;
use crate::space::Vector;

/// Reads every table and notes every mistake; `None` when there is one.
pub(super) fn read<V: Vector>(root: &Section<'_>, name: &str, source_text: String) -> Option<Scenario<V>> {
    let head = head::read::<V>(root, name);
    let size = head::size::<V>(root);
    let engine = engine::read::<V>(root);
    let axes = boundary::read::<V>(root);
    let particles = particles::read::<V>(root);
    let initial = initial::read(root);
    let diameter = particles.matter.as_ref().map(Matter::largest_diameter);
    let source = source::read(root, Surroundings { gravity: head.gravity, size, diameter });
    let run = run::read(root);
    let record = record::read(root, run);
    let units = head::units(root);

    let count = count(root, &particles, size);
    // An unknown ν or r changes the restitution of walls, not whether they are right.
    let volume_fraction = volume_fraction(count, &particles, size).unwrap_or(0.0);
    let typical = particles.restitution.map_or(1.0, RestitutionLaw::typical);
    let boundary = walls::resolve(axes, typical, volume_fraction);
    let story = Story {
        gravity: head.gravity,
        size,
        boundary: boundary.as_ref(),
        count,
        source: source.as_ref().map(Option::as_ref),
        diameter,
        run,
    };
    let consistent = consistency::check(root, &story);
    let initial = resolve_initial(root, initial, &story);
    let able = engine.kind.map_or(Some(()), |kind| consistency::abilities(root, kind, &particles, &story));
    let (grid_origin, grid_size, cells) = cut(root, &engine, &particles, &story)?;
    let (matter, count) = (consistent.and(able).and(particles.matter)?, count?);
    checked(
        root,
        Scenario {
            name: name.to_owned(),
            title: head.title?,
            source_text,
            seed: head.seed?,
            gravity: head.gravity?,
            engine: resolve_engine(engine, typical)?,
            size: size?,
            grid_origin,
            grid_size,
            cells,
            boundary: boundary?,
            grain: *matter.kinds.first()?,
            species: matter.species(),
            species_counts: matter.species_counts(count),
            roughness: particles.roughness?,
            restitution: particles.restitution?,
            count,
            initial: initial?,
            source: source?,
            run: run?,
            record: record?,
            units: units?,
        },
    )
}

/// What can only be checked on a whole scenario.
fn checked<V: Vector>(root: &Section<'_>, scenario: Scenario<V>) -> Option<Scenario<V>> {
    pace::check_fixed_step(root, &scenario)?;
    state::check_lattice(root, &scenario)?;
    Some(scenario)
}

fn count<V: Vector>(root: &Section<'_>, table: &ParticlesTable, size: Option<V>) -> Option<u32> {
    let (amount, matter, size) = (table.amount?, table.matter.as_ref()?, size?);
    match particles::count(amount, matter, size) {
        Ok(count) => Some(count),
        Err(message) => {
            root.mistake(&format!("particles.{}", amount.key()), message);
            None
        }
    }
}

fn volume_fraction<V: Vector>(count: Option<u32>, table: &ParticlesTable, size: Option<V>) -> Option<f64> {
    Some(f64::from(count?) * table.matter.as_ref()?.mean_volume::<V>() / size?.product())
}

/// Origin, size and cells of the grid.
fn cut<V: Vector>(
    root: &Section<'_>,
    engine: &EngineTable,
    particles: &ParticlesTable,
    story: &Story<'_, V>,
) -> Option<(V, V, [u32; 3])> {
    let (size, boundary, count, source) = (story.size?, story.boundary?, story.count?, story.source?);
    walls::check_strokes(root, boundary, size)?;
    if !consistency::fits(story) {
        return None;
    }
    let hsmc = engine.kind? == EngineKind::Hsmc;
    let settling = source.is_some() || story.gravity? != V::ZERO;
    let matter = particles.matter.as_ref()?;
    // The cells of an event-driven run serve its measures alone: small ones show a surface.
    let small = (engine.kind?.is_event_driven() && settling).then(|| 2.0 * matter.largest_diameter());
    let maximum = engine.hsmc.maximum_volume_fraction;
    let (grid_origin, grid_size) = walls::swept_box(boundary, size);
    let plan = CellPlan {
        wish: engine.cell_size?.or(small),
        grid_origin,
        grid_size,
        size,
        periodic: std::array::from_fn(|axis| boundary.is_periodic(axis)),
        diameter: matter.largest_diameter(),
        grain_volume: matter.mean_volume::<V>(),
        final_count: u64::from(count) + source.map_or(0, |source| u64::from(source.count)),
        maximum_volume_fraction: if hsmc { Some(maximum?) } else { None },
        settling,
    };
    match plan.cells() {
        Ok(cells) => Some((grid_origin, grid_size, cells)),
        Err(message) => {
            root.mistake("engine.cell_size", message);
            None
        }
    }
}

fn resolve_engine(engine: EngineTable, restitution: f64) -> Option<EngineChoice> {
    let hsmc = engine.hsmc;
    let cell_restitution = match hsmc.cell_restitution? {
        CellRestitution::AsGrains => restitution,
        CellRestitution::Number(number) => number,
        CellRestitution::AtLeast(least) => restitution.max(least),
    };
    Some(EngineChoice {
        kind: engine.kind?,
        time_step: engine.time_step?,
        enskog_factor: engine.enskog_factor?,
        transfer: engine.transfer?,
        impact_law: engine.impact_law?,
        hsmc: HsmcRules {
            maximum_volume_fraction: hsmc.maximum_volume_fraction?,
            cell_restitution,
            sweeps: hsmc.sweeps?,
            admission: hsmc.admission?,
            displacement: hsmc.displacement?,
        },
        entry_probability: hsmc.entry_probability?,
        event_driven: engine.event_driven?,
    })
}

fn resolve_initial<V: Vector>(
    root: &Section<'_>,
    table: InitialTable,
    story: &Story<'_, V>,
) -> Option<Initial> {
    let velocities = consistency::velocities(root, &table, story);
    consistency::equilibration(root, &table, velocities, story)?;
    let velocities = match table.positions {
        Some(InitialPositions::Log(_)) => InitialVelocities::Rest,
        _ => velocities?,
    };
    table.velocities?;
    Some(Initial { positions: table.positions?, velocities, equilibrate: table.equilibrate? })
}
