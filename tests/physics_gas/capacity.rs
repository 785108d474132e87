//! HSMC never fills a cell beyond its capacity, and never adds to a cell that is beyond it.

use glam::{DVec2, DVec3};
use grainflow::random::{Phase, Streams};
use grainflow::space::Vector;

use crate::bed::{Bed, Kind, Plan};

const STEPS: u32 = 1000;

/// The same dense gas, with `crowd` of its grains in the first quarter along the first axis.
fn bed<V: Vector>(plan: Plan, crowd: f64, seed: u64) -> Bed<V> {
    let size = plan.grid::<V>().size();
    let mut random = Streams::new(seed).at(0, Phase::InitialPositions).stream(0);
    let mut place = |_| {
        let squeeze = if random.uniform() < crowd { 0.25 } else { 1.0 };
        V::from_fn(|axis| size[axis] * random.uniform() * if axis == 0 { squeeze } else { 1.0 })
    };
    let positions = (0..plan.grains::<V>()).map(&mut place).collect();
    Bed::with_positions(plan, seed, positions)
}

fn occupancies<V: Vector>(bed: &Bed<V>) -> Vec<u32> {
    (0..bed.gas.grid().number_of_cells() as u32).map(|cell| bed.gas.occupancy(cell)).collect()
}

/// Checks every cell after every step: at most the capacity, or fewer than it held before.
fn check<V: Vector>(plan: Plan, crowd: f64, seed: u64) {
    let mut bed = bed::<V>(plan, crowd, seed);
    let capacity = bed.capacity().expect("HSMC has a capacity");
    let mut before = occupancies(&bed);
    let overfull_at_the_start = before.iter().filter(|&&grains| grains > capacity).count();
    assert!(overfull_at_the_start > 0, "the start leaves nothing to be tested");
    for step in 0..STEPS {
        bed.step();
        let after = occupancies(&bed);
        for (cell, (&then, &now)) in before.iter().zip(&after).enumerate() {
            assert!(
                now <= capacity.max(then),
                "cell {cell} goes from {then} to {now} in step {step}, K = {capacity}"
            );
        }
        before = after;
    }
    let counts = bed.totals.counts;
    println!(
        "{}D crowd {crowd}: K = {capacity}, {overfull_at_the_start} cells overfull, {counts:?}",
        V::DIMENSION
    );
    assert!(counts.rejected_moves > 0 && counts.cell_collisions > 0);
}

#[test]
fn no_cell_gets_too_full() {
    for restitution in [0.9, 1.0] {
        for crowd in [0.0, 0.5] {
            // K = 8 at 6 grains per cell, and K = 15 at 11.
            let flat = Plan::new(Kind::Hsmc, 0.6, 16, 6.0).with_restitution(restitution);
            check::<DVec2>(flat, crowd, 7);
            let deep = Plan::new(Kind::Hsmc, 0.45, 6, 11.0).with_restitution(restitution);
            check::<DVec3>(deep, crowd, 7);
        }
    }
}
