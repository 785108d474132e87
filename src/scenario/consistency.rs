//! What the tables of a scenario owe each other.

use super::model::{EngineKind, InitialPositions, InitialVelocities, RunLimits};
use super::reader::Section;
use super::tables::initial::InitialTable;
use super::tables::particles::{MOST_GRAINS, ParticlesTable};
use crate::law::boundary::{Boundary, WallKind};
use crate::law::source::Source;
use crate::space::Vector;

/// The scenario as far as it is known; `None` for what is wrong.
#[derive(Clone, Debug)]
pub(super) struct Story<'a, V> {
    pub(super) gravity: Option<V>,
    pub(super) size: Option<V>,
    pub(super) boundary: Option<&'a Boundary<V>>,
    pub(super) count: Option<u32>,
    pub(super) source: Option<Option<&'a Source<V>>>,
    pub(super) diameter: Option<f64>,
    pub(super) run: Option<RunLimits>,
}

/// Notes contradictions between the tables; `None` when there is one.
pub(super) fn check<V: Vector>(root: &Section<'_>, story: &Story<'_, V>) -> Option<()> {
    let checks = [room(root, story), grains(root, story), fall(root, story), end(root, story)];
    checks.into_iter().all(|check| check.is_some()).then_some(())
}

/// Whether a grain fits into the box, as far as is known.
pub(super) fn fits<V: Vector>(story: &Story<'_, V>) -> bool {
    let (Some(size), Some(diameter)) = (story.size, story.diameter) else { return true };
    (0..V::DIMENSION).all(|axis| size[axis] >= diameter)
}

/// A grain fits into the box.
fn room<V: Vector>(root: &Section<'_>, story: &Story<'_, V>) -> Option<()> {
    let (size, diameter) = (story.size?, story.diameter?);
    for axis in 0..V::DIMENSION {
        if size[axis] < diameter {
            root.mistake(
                "domain.size",
                format!(
                    "{} along {} is less than the diameter {diameter} of a grain; enlarge it",
                    size[axis],
                    V::AXIS_NAMES[axis]
                ),
            );
            return None;
        }
    }
    Some(())
}

/// The engine has what the grains and the limits ask for.
pub(super) fn abilities<V: Vector>(
    root: &Section<'_>,
    kind: EngineKind,
    particles: &ParticlesTable,
    story: &Story<'_, V>,
) -> Option<()> {
    // A single grain never collides.
    let collides = story.count != Some(1) || !matches!(story.source, Some(None));
    let mut able = Some(());
    let mut refuse = |key: &str, message: String| {
        root.mistake(key, message);
        able = None;
    };
    let (name, having) = (kind.name(), EngineKind::EventDriven.name());
    if !kind.is_event_driven() {
        if matches!(particles.roughness, Some(Some(_))) {
            refuse(
                "particles.tangential_restitution",
                format!(
                    "{name} knows smooth grains only; leave it out, or take an engine that has it: {having}"
                ),
            );
        }
        if particles.matter.as_ref().is_some_and(|matter| matter.are_species) {
            refuse(
                "particles.species",
                format!(
                    "{name} knows grains of one kind only; give particles.diameter and particles.mass, or take an \
                     engine that has species: {having}"
                ),
            );
        }
    } else if let Some(RunLimits { time: None, steps: Some(_), collisions_per_particle, rest: None }) =
        story.run
        && (collisions_per_particle.is_none() || !collides)
    {
        refuse(
            "run.steps",
            format!(
                "{name} has no steps, so it would never end; give run.time{}",
                if collides { " or run.collisions_per_particle" } else { "" }
            ),
        );
    }
    able
}

/// There are grains, and no more than can be named.
fn grains<V: Vector>(root: &Section<'_>, story: &Story<'_, V>) -> Option<()> {
    match (story.count?, story.source?) {
        (0, None) => {
            root.mistake(
                "particles.count",
                "0 grains and no [source]: nothing to simulate; give a count or a [source]",
            );
            None
        }
        (count, Some(source)) if u64::from(count) + u64::from(source.count) > MOST_GRAINS => {
            root.mistake("source.count", format!("makes more than {MOST_GRAINS} grains in all; pour fewer"));
            None
        }
        _ => Some(()),
    }
}

/// Poured grains come to an end somewhere.
fn fall<V: Vector>(root: &Section<'_>, story: &Story<'_, V>) -> Option<()> {
    let (gravity, boundary, Some(_)) = (story.gravity?, story.boundary?, story.source?) else {
        return Some(());
    };
    let mut axes = 0..V::DIMENSION;
    if let Some(axis) = axes.find(|&axis| gravity[axis] != 0.0 && boundary.is_periodic(axis)) {
        let name = V::AXIS_NAMES[axis];
        root.mistake(
            &format!("boundary.{name}"),
            format!(
                "is periodic, so poured grains would fall for ever; write {name}.lower = {{ wall = \"rough\" }} and \
                 {name}.upper = \"open\""
            ),
        );
        return None;
    }
    Some(())
}

/// The limits can be reached.
fn end<V: Vector>(root: &Section<'_>, story: &Story<'_, V>) -> Option<()> {
    let run = story.run?;
    let only_collisions = RunLimits { collisions_per_particle: None, ..run } == RunLimits::default();
    let grains = u64::from(story.count?) + story.source?.map_or(0, |source| u64::from(source.count));
    if only_collisions && grains == 1 {
        root.mistake(
            "run.collisions_per_particle",
            "a single grain never collides; give run.time, or run.steps to an engine that has steps",
        );
        return None;
    }
    Some(())
}

/// The initial velocities: as given, or rest where something drives.
pub(super) fn velocities<V: Vector>(
    root: &Section<'_>,
    table: &InitialTable,
    story: &Story<'_, V>,
) -> Option<InitialVelocities> {
    if let (Some(InitialPositions::Log(_)), Some(Some(_))) = (&table.positions, table.velocities) {
        root.mistake(
            "initial.velocities",
            "stands beside a log, which brings its own velocities; leave it out",
        );
        return None;
    }
    if matches!(table.positions, Some(InitialPositions::Log(_))) {
        return Some(InitialVelocities::Rest);
    }
    match table.velocities? {
        given @ (None | Some(InitialVelocities::Rest)) => {
            let is_missing = given.is_none();
            let rest = match never_moved(story)? {
                Some(reason) => Some(reason),
                None => never_collides(story)?,
            };
            if let Some(reason) = rest {
                let message = format!(
                    "{}{reason}; write {{ maxwell = 1.0 }}",
                    if is_missing { "is missing, and " } else { "\"rest\": " }
                );
                if is_missing {
                    root.missing("initial.velocities", message);
                } else {
                    root.mistake("initial.velocities", message);
                }
                return None;
            }
            Some(InitialVelocities::Rest)
        }
        Some(given) => Some(given),
    }
}

/// Why grains at rest would never be moved: by nothing but gravity, a source, or a wall that comes towards them. A wall that moves
/// along itself meets only grains that come to it. The outer `None`: not known.
fn never_moved<V: Vector>(story: &Story<'_, V>) -> Option<Option<&'static str>> {
    let boundary = story.boundary?;
    let vibrates = boundary.walls().any(|(_, _, wall)| matches!(wall.kind, WallKind::Vibrating { .. }));
    if story.gravity? != V::ZERO || story.source?.is_some() || vibrates {
        return Some(None);
    }
    Some(Some(if boundary.largest_wall_speed() > 0.0 {
        "no grain at rest ever meets a wall that moves along itself, so nothing would ever move"
    } else {
        "without gravity, source or vibrating wall nothing would ever move"
    }))
}

/// Why grains that begin at rest would never collide, where only collisions end the run: gravity along periodic axes alone lets all
/// of them fall alike. The outer `None`: not known.
fn never_collides<V: Vector>(story: &Story<'_, V>) -> Option<Option<&'static str>> {
    let run = story.run?;
    let ends = run.time.is_some() || run.steps.is_some();
    let alike = fall_alike(story.gravity?, story.boundary?);
    Some((alike && !ends).then_some(
        "all grains fall alike along a periodic axis and never collide, so run.collisions_per_particle is never reached",
    ))
}

/// Whether gravity moves grains that begin at rest, but none against another one or a wall: it pulls along periodic axes alone, and
/// no wall comes towards them.
pub(super) fn fall_alike<V: Vector>(gravity: V, boundary: &Boundary<V>) -> bool {
    let vibrates = boundary.walls().any(|(_, _, wall)| matches!(wall.kind, WallKind::Vibrating { .. }));
    let pulled = (0..V::DIMENSION).filter(|&axis| gravity[axis] != 0.0);
    gravity != V::ZERO && !vibrates && pulled.into_iter().all(|axis| boundary.is_periodic(axis))
}

/// There is something to equilibrate.
pub(super) fn equilibration<V: Vector>(
    root: &Section<'_>,
    table: &InitialTable,
    velocities: Option<InitialVelocities>,
    story: &Story<'_, V>,
) -> Option<()> {
    if table.equilibrate? == 0.0 {
        return Some(());
    }
    let message = match (&table.positions, velocities) {
        (Some(InitialPositions::Log(_)), _) => "a log brings a state of its own; leave equilibrate out",
        (_, Some(InitialVelocities::Rest)) => {
            "grains at rest never collide; give initial.velocities = { maxwell = 1.0 } or leave equilibrate out"
        }
        _ if story.count? < 2 => "needs at least two grains; leave equilibrate out",
        _ => return Some(()),
    };
    root.mistake("initial.equilibrate", message);
    None
}
