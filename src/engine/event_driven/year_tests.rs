use super::super::calendar::Usage;
use super::super::laws::{Growth, Laws};
use super::super::rules::{Cure, Structure};
use super::*;
use crate::engine::Horizon;
use crate::law::boundary::Boundary;
use crate::law::restitution::{Constant, RestitutionLaw};
use crate::matter::gas::Gas;
use crate::matter::grain::Grain;
use crate::matter::grid::Grid;
use crate::random::{Phase, Streams};
use glam::DVec2;

/// Discs on a triangular lattice of this spacing, an even number on each axis, with the velocities of a Maxwell gas.
fn world(per_axis: u32, spacing: f64, restitution: f64, cure: Cure, structure: Structure) -> World<DVec2> {
    let apart = DVec2::new(1.0, 0.75_f64.sqrt()) * spacing;
    let size = f64::from(per_axis) * apart;
    let grain = Grain { diameter: 1.0, mass: 1.0 };
    let laws = Laws {
        grain,
        species: Vec::new(),
        restitution: RestitutionLaw::Constant(Constant(restitution)),
        roughness: None,
        gravity: DVec2::ZERO,
        size,
        boundary: Boundary::periodic(),
        cure,
        growth: Growth::NONE,
        streams: Streams::new(3),
        seed: 3,
    };
    let streams = laws.streams.at(0, Phase::InitialVelocities);
    let number = per_axis * per_axis;
    let place = |k: u32| {
        let (column, row) = (k % per_axis, k / per_axis);
        DVec2::new(f64::from(column) + 0.25 + 0.5 * f64::from(row % 2), f64::from(row) + 0.5) * apart
    };
    let velocity = |k: u32| {
        let mut random = streams.stream(u64::from(k));
        DVec2::new(random.gaussian(), random.gaussian())
    };
    let grid = Grid::new(DVec2::ZERO, size, &[8, 8], &[true; 2]);
    let gas = Gas::new(grid, grain, (0..number).map(place).collect(), (0..number).map(velocity).collect());
    World::new(&laws, structure, &gas)
}

fn temperature(world: &World<DVec2>) -> f64 {
    world.bodies.iter().map(|body| body.velocity.length_squared()).sum::<f64>() / world.bodies.len() as f64
}

/// Goes on by some events; tells how the calendar was used in a year that ended meanwhile.
fn go_on(world: &mut World<DVec2>, events: u64) -> Option<Usage> {
    let (usage, origin) = (world.calendar.usage(), world.origin);
    let most = world.events.all + events;
    world.run(Horizon::NONE, most).unwrap();
    (world.origin != origin).then_some(usage)
}

/// While the gas cools its pages stay as full as they should be, and few events are written on the page that is open:
/// year after year its length follows. Late entries are bounded for twenty years, in which the gas stays about even;
/// later, in clusters, grains collide again within the page that is open.
#[test]
fn pages_stay_full_as_a_gas_cools() {
    let cure = Cure { contact_time: Some(1e-4), ..Cure::default() };
    let mut world = world(70, 1.8, 0.7, cure, Structure::Automatic);
    let start = temperature(&world);
    let mut years = 0;
    while years < 20 || (temperature(&world) > 1e-8 * start && world.events.all < 10_000_000) {
        let Some(usage) = go_on(&mut world, 2000) else { continue };
        years += 1;
        let per_page = usage.entries as f64 / usage.opened as f64;
        let late = usage.late as f64 / (usage.entries + usage.late) as f64;
        let cooled = temperature(&world) / start;
        assert!(years > 20 || (30.0..400.0).contains(&per_page), "year {years}: {per_page}");
        // The first year, of a lattice, is planned by a guess.
        assert!(years == 1 || years > 20 || late < 0.2, "year {years}: {late}");
        assert!(world.events.all < 100_000_000, "the year does not follow: T/T0 = {cooled}");
    }
}

/// The order in memory is renewed when crossings have undone it, and follows the curve through the cells.
#[test]
fn the_order_in_memory_is_renewed() {
    let mut world = world(40, 1.8, 1.0, Cure::default(), Structure::Cells);
    let (mut renewals, mut last) = (0, 0);
    for _ in 0..400 {
        go_on(&mut world, 1000);
        renewals += u32::from(world.pace.crossings_since_order < last);
        last = world.pace.crossings_since_order;
    }
    let crossings = world.events.crossings as f64 / world.bodies.len() as f64;
    assert!(f64::from(renewals) > crossings / 20.0 && f64::from(renewals) <= crossings / CROSSINGS_PER_ORDER);
}

/// Discs in a crystal begin with lists, a gas with cells; matter that clusters or loosens changes over by its counts.
#[test]
fn the_structure_follows_from_counts() {
    for (spacing, lists) in [(1.03, true), (1.8, false)] {
        let mut world = world(30, spacing, 1.0, Cure::default(), Structure::Automatic);
        assert_eq!(world.lists.is_some(), lists);
        for _ in 0..100 {
            go_on(&mut world, 2000);
        }
        assert_eq!(world.lists.is_some(), lists, "{spacing} after many years");
        // Counts as those of a year in the other kind of matter turn the choice round; others do not.
        let grains = world.bodies.len() as u64;
        let (turn, stay) = if lists { (3, 5) } else { (42, 40) };
        (world.pace.collisions, world.pace.crossings) = (stay * grains, grains);
        assert_eq!(world.next_arrangement(), None);
        (world.pace.collisions, world.pace.crossings) = (turn * grains, grains);
        let next = world.next_arrangement().unwrap();
        assert_eq!(next.half_width.is_some(), !lists);
        world.turn_year(world.now.max(1e-9));
        assert_eq!(world.lists.is_some(), !lists);
    }
}
