//! Inelastic collapse is named without a cure, and does not happen with one.

use super::drive::{Drive, STRUCTURES, faces, laws, restitution, scatter, scattered, wall};
use glam::{DVec2, DVec3};
use grainflow::engine::EngineError;
use grainflow::engine::event_driven::laws::Laws;
use grainflow::engine::event_driven::rules::{Cure, Structure};
use grainflow::law::boundary::WallKind;
use grainflow::space::Vector;

/// Each cure alone, and two of them: below this speed, within this time.
fn cures(speed: f64, time: f64) -> [Cure; 4] {
    let none = Cure::default();
    [
        Cure { elastic_below: Some(speed), ..none },
        Cure { contact_time: Some(time), ..none },
        Cure { rotation: Some(0.2), ..none },
        Cure { elastic_below: Some(speed), rotation: Some(0.2), ..none },
    ]
}

#[track_caller]
fn assert_collapse(result: Result<(), EngineError>) -> f64 {
    match result {
        Err(EngineError::Collapse { time, .. }) => time,
        other => panic!("{other:?}"),
    }
}

/// A row of `number` grains with uneven gaps, pressed together from both sides.
fn row<V: Vector>(number: usize) -> Vec<(V, V)> {
    let grain = |k: usize| {
        let place = V::from_fn(|axis| if axis == 0 { 3.0 + 1.5 * k as f64 + 0.2 * scatter(k) } else { 5.0 });
        let velocity = 1.0 - 2.0 * k as f64 / (number - 1) as f64;
        (place, V::along(0, velocity))
    };
    (0..number).map(grain).collect()
}

fn rows<V: Vector>() {
    // Three collapse below 7 − 4√3 = 0.072, more of them at ever larger r (McNamara and Young 1992).
    for (number, r) in [(3, 0.05), (5, 0.2), (8, 0.3), (16, 0.5), (40, 0.7), (200, 0.9)] {
        for structure in STRUCTURES {
            let mut laws = laws::<V>(V::from_fn(|_| 10.0 + 2.0 * number as f64));
            laws.restitution = restitution(r);
            let time = assert_collapse(Drive::new(&laws, structure, &row::<V>(number)).try_to(100.0));
            println!("{number} in a row at r = {r}: collapse at t = {time}");
            assert!(time < 0.5 * number as f64, "{time}");
        }
    }
}

#[test]
fn rows_collapse() {
    rows::<DVec2>();
    rows::<DVec3>();
}

#[test]
fn cured_rows_do_not_collapse() {
    for structure in STRUCTURES {
        for cure in cures(1e-3, 1e-3) {
            for (number, r) in [(3, 0.05), (8, 0.3), (16, 0.5)] {
                let mut laws = laws(DVec2::splat(10.0 + 2.0 * number as f64));
                (laws.restitution, laws.cure) = (restitution(r), cure);
                if cure == cures(1e-3, 1e-3)[2] {
                    // Turns of 0.2 alone do not bring grains out of a row that is pressed together at so small an r.
                    continue;
                }
                let mut row = Drive::new(&laws, structure, &row::<DVec2>(number));
                row.to(100.0);
                assert!(row.events.cured > 0, "{cure:?}");
            }
        }
    }
}

fn dissipative(r: f64) -> (Laws<DVec2>, Vec<(DVec2, DVec2)>) {
    // 32² at ν = 0.4.
    let spacing = 1.4;
    let mut laws = laws(DVec2::splat(32.0 * spacing));
    laws.restitution = restitution(r);
    (laws, scattered(32, spacing, 0.15))
}

#[test]
fn a_dissipative_gas_collapses() {
    let (laws, grains) = dissipative(0.3);
    for structure in STRUCTURES {
        let mut gas = Drive::new(&laws, structure, &grains);
        let time = assert_collapse(gas.try_to(1e6));
        println!("N = 1024, r = 0.3, {structure:?}: collapse at t = {time}");
    }
}

#[test]
fn a_cured_gas_cools_on() {
    let (mut laws, grains) = dissipative(0.3);
    for structure in STRUCTURES {
        for cure in cures(1e-4, 1e-3) {
            laws.cure = cure;
            let mut gas = Drive::new(&laws, structure, &grains);
            let (start, mut energy) = (gas.energy(), gas.energy());
            for k in 1..=100 {
                gas.to(3.0 * f64::from(k));
                assert!(gas.energy() <= energy * (1.0 + 1e-12), "{cure:?} {k}");
                energy = gas.energy();
            }
            println!(
                "{cure:?} {structure:?}: T/T0 = {:.1e} after {} collisions, {} of them cured",
                energy / start,
                gas.counts.collisions,
                gas.events.cured
            );
            assert!(energy < 0.1 * start && gas.counts.collisions > 10_000);
        }
    }
}

/// A grain over a floor under gravity 1, with restitution 0.9.
fn over_floor(kind: WallKind<DVec2>, cure: Cure, structure: Structure) -> Drive<DVec2> {
    let mut laws = laws(DVec2::splat(10.0));
    laws.gravity = DVec2::Y * -1.0;
    laws.cure = cure;
    laws.boundary.axes[1] = faces(wall(0.9, kind), wall(1.0, WallKind::Smooth));
    Drive::new(&laws, structure, &[(DVec2::new(5.0, 2.5), DVec2::X * 0.1)])
}

/// From a height of 2: bounces end at √4 (1 + 2 · 0.9/(1 − 0.9)) = 38.
#[test]
fn a_bouncing_grain_comes_to_rest() {
    for structure in STRUCTURES {
        let mut grain = over_floor(WallKind::Smooth, Cure::default(), structure);
        let time = assert_collapse(grain.try_to(100.0));
        assert!((time - 38.0).abs() < 1e-3, "{time}");
        for cure in cures(1e-2, 1e-2) {
            let mut grain = over_floor(WallKind::Smooth, cure, structure);
            if cure.elastic_below.or(cure.contact_time).is_none() {
                // Turns mix the directions of a velocity, which still comes to nothing.
                let time = assert_collapse(grain.try_to(1e4));
                println!("a turned bouncing grain: at rest at t = {time}");
                continue;
            }
            grain.to(500.0);
            // It goes on at the speed that the cure leaves: below 10⁻², at a flight of 2v = 10⁻² at least.
            let energy = grain.energy() + grain.position(0).y - 0.5;
            assert!(grain.events.cured > 10_000, "{cure:?} {energy}");
            // Turns make a part of the fall an unhindered motion along the floor.
            assert!(energy < 0.01 || cure.rotation.is_some(), "{cure:?} {energy}");
        }
    }
}

/// A floor that shakes too little to keep the grain bouncing, Aω²/g = 0.1 below π(1 − r)/(1 + r) = 0.165, so that it
/// comes to lie on it; and two on which it goes on, one of which throws it (1.1).
#[test]
fn a_chattering_grain() {
    for structure in STRUCTURES {
        for gamma in [0.1_f64, 0.8, 1.1] {
            let frequency = 1.0;
            let amplitude = gamma / (std::f64::consts::TAU * frequency).powi(2);
            let floor = WallKind::Vibrating { amplitude, frequency };
            let mut grain = over_floor(floor, Cure::default(), structure);
            let time = if gamma < 0.165 { Some(assert_collapse(grain.try_to(1e4))) } else { None };
            println!("chattering at Γ = {gamma}: collapse at t = {time:?}");
            for cure in cures(1e-2, 1e-2) {
                if cure.elastic_below.or(cure.contact_time).is_none() {
                    continue;
                }
                let mut grain = over_floor(floor, cure, structure);
                grain.to(500.0);
                println!(
                    "Γ = {gamma} {cure:?}: {} hits, {} cured",
                    grain.events.wall_hits, grain.events.cured
                );
                assert!(gamma > 0.165 || grain.events.cured > 1000, "{:?}", grain.events);
            }
        }
    }
}
