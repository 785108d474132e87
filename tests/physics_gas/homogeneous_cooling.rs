//! A gas without space: cooling per collision follows the fourth moment of its velocities.

use glam::{DVec2, DVec3};
use grainflow::law::kinetic_theory::cooling_per_collision;
use grainflow::matter::gas::Gas;
use grainflow::observe::moments::mean_velocity;
use grainflow::space::Vector;

use crate::bed::{Bed, Kind, Plan};
use crate::claim::{Claim, replicas};

const RESTITUTION: f64 = 0.3;
const GRAINS: f64 = 20_000.0;
/// Collisions per particle until velocities have forgotten the Maxwellian start.
const TRANSIENT: f64 = 10.0;
/// Collisions per particle that are looked at: 10⁶ collisions.
const WINDOW: f64 = 100.0;

/// a₂ = D/(D + 2) ⟨v⁴⟩/⟨v²⟩² − 1.
fn sonine_coefficient<V: Vector>(gas: &Gas<V>) -> f64 {
    let mean = mean_velocity(gas);
    let (mut second, mut fourth) = (0.0, 0.0);
    for &velocity in gas.velocities() {
        let square = (velocity - mean).length_squared();
        second += square;
        fourth += square * square;
    }
    let d = V::DIMENSION as f64;
    d / (d + 2.0) * gas.len() as f64 * fourth / (second * second) - 1.0
}

/// Cooling per collision over 2γ₀ (1 + a₂/4).
///
/// A collision takes λm⟨vₙ²⟩/4, and pairs collide in proportion to their relative speed v: the loss goes as
/// ⟨v³⟩/⟨v⟩. With f = Maxwell·(1 + a₂S₂), the relative velocity has a₂/2 in place of a₂, and
/// ⟨vᵖ⟩ changes by the factor 1 + (a₂/2)(p/2)(p/2 − 1)/2: 1 + 3a₂/16 for p = 3, 1 − a₂/16 for p = 1, so
/// that −d ln T/dτ = 2γ₀ (1 + a₂/4). Left out are 5a₂²/128, below 10⁻³ here, and a₃/32 ≈ −2·10⁻³ (a₃ ≈ −0.05).
/// The law holds at every τ: ln T over a stretch of τ takes a₂ averaged over collisions, not over time.
fn cooling_over_theory<V: Vector>(seed: u64) -> f64 {
    let mut bed = Bed::<V>::new(Plan::new(Kind::Dsmc, 0.05, 1, GRAINS).with_restitution(RESTITUTION), seed);
    bed.advance_to(TRANSIENT);
    let (start, hot) = (bed.totals.collisions_per_particle, bed.temperature());
    let (mut weighted, mut tau, mut here) = (0.0, start, sonine_coefficient(&bed.gas));
    while tau < start + WINDOW {
        bed.step();
        let (now, there) = (bed.totals.collisions_per_particle, sonine_coefficient(&bed.gas));
        weighted += (now - tau) * 0.5 * (here + there);
        (tau, here) = (now, there);
    }
    let mean_coefficient = weighted / (tau - start);
    let rate = (hot / bed.temperature()).ln() / (tau - start);
    println!("{}D a₂ = {mean_coefficient:.4}", V::DIMENSION);
    rate / (2.0 * cooling_per_collision::<V>(RESTITUTION)) / (1.0 + mean_coefficient / 4.0)
}

#[test]
fn two_dimensions_follow_the_measured_fourth_moment() {
    Claim { theory: 1.0, tolerance: 0.005 }
        .check("homogeneous cooling, 2D", &replicas(6, cooling_over_theory::<DVec2>));
}

#[test]
fn three_dimensions_follow_the_measured_fourth_moment() {
    Claim { theory: 1.0, tolerance: 0.005 }
        .check("homogeneous cooling, 3D", &replicas(6, cooling_over_theory::<DVec3>));
}
