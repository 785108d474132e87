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

/// Discs on a square lattice of this spacing, with the velocities of a Maxwell gas.
fn world(per_axis: u32, spacing: f64, restitution: f64, cure: Cure, structure: Structure) -> World<DVec2> {
    let size = DVec2::splat(f64::from(per_axis) * spacing);
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
    let place = |k: u32| DVec2::new(f64::from(k % per_axis) + 0.5, f64::from(k / per_axis) + 0.5) * spacing;
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
/// year after year its length follows. Held to it for twenty years, in which the gas stays about even; later, in
/// clusters, grains collide again within the page that is open, which is printed.
#[test]
fn pages_stay_full_as_a_gas_cools() {
    let cure = Cure { contact_time: Some(1e-4), ..Cure::default() };
    let mut world = world(71, 1.8, 0.7, cure, Structure::Automatic);
    let start = temperature(&world);
    let mut years = 0;
    while years < 20 || (temperature(&world) > 1e-8 * start && world.events.all < 10_000_000) {
        let Some(usage) = go_on(&mut world, 2000) else { continue };
        years += 1;
        let per_page = usage.entries as f64 / usage.opened as f64;
        let late = usage.late as f64 / (usage.entries + usage.late) as f64;
        let cooled = temperature(&world) / start;
        println!("year {years}, T/T0 = {cooled:.1e}: {per_page:.1} entries on a page, late {late:.3}");
        assert!(years > 20 || (5.0..200.0).contains(&per_page), "year {years}: {per_page}");
        // The first year, of a lattice, is planned by a guess.
        assert!(years == 1 || years > 20 || late < 0.1, "year {years}: {late}");
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
    println!("{renewals} renewals of the order in {crossings:.0} crossings of each grain");
    assert!(f64::from(renewals) > crossings / 20.0 && f64::from(renewals) <= crossings / CROSSINGS_PER_ORDER);
}

/// A dense gas begins with lists, a dilute one with cells; a gas that clusters or loosens changes over by its counts.
#[test]
fn the_structure_follows_from_counts() {
    for (spacing, lists) in [(1.05, true), (1.8, false)] {
        let mut world = world(30, spacing, 1.0, Cure::default(), Structure::Automatic);
        assert_eq!(world.lists.is_some(), lists);
        for _ in 0..100 {
            go_on(&mut world, 2000);
        }
        assert_eq!(world.lists.is_some(), lists, "{spacing} after many years");
        // Counts as those of a year in the other kind of matter turn the choice round, and no others.
        let grains = world.bodies.len() as u64;
        let (collisions, crossings) = if lists { (grains, 2 * grains) } else { (9 * grains, grains) };
        (world.pace.collisions, world.pace.crossings) = (crossings, collisions);
        assert_eq!(world.next_arrangement(), None);
        (world.pace.collisions, world.pace.crossings) = (collisions, crossings);
        let next = world.next_arrangement().unwrap();
        assert_eq!(next.half_width.is_some(), !lists);
        world.turn_year(world.now.max(1e-9));
        assert_eq!(world.lists.is_some(), !lists);
    }
}
