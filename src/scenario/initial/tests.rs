use glam::DVec2;

use super::*;
use crate::scenario::model::AnyScenario;
use crate::scenario::{Overrides, parse};

const GAS: &str = "dimension = 2\n[engine]\nkind = 'dsmc'\ncell_size = 4\n[domain]\nsize = [40, 40]\n\
                   [particles]\ncount = 500\nrestitution = 0.9\n[initial]\nvelocities = { maxwell = 1.7 }\n\
                   [run]\ntime = 1\n";

fn scenario(sets: &[&str]) -> Scenario<DVec2> {
    let overrides = Overrides { sets: sets.iter().map(ToString::to_string).collect(), ..Default::default() };
    match parse("gas", GAS, &overrides).unwrap() {
        AnyScenario::Two(scenario) => scenario,
        AnyScenario::Three(_) => unreachable!("the dimension is 2"),
    }
}

fn gas(sets: &[&str]) -> Gas<DVec2> {
    build(&scenario(sets), None).unwrap()
}

fn temperature(gas: &Gas<DVec2>) -> f64 {
    gas.grain.mass * gas.velocities().iter().map(|v| v.length_squared()).sum::<f64>()
        / (2.0 * gas.len() as f64)
}

#[test]
fn momentum_is_zero_and_the_temperature_exact() {
    for sets in [&[][..], &["initial.velocities={uniform=2}", "particles.mass=1.275"], &["particles.count=2"]]
    {
        let gas = gas(sets);
        let momentum: DVec2 = gas.velocities().iter().sum();
        assert!(momentum.length() < 1e-12 * gas.len() as f64, "{momentum}");
        assert!((temperature(&gas) / 1.7 - 1.0).abs() < 1e-14, "{}", temperature(&gas));
    }
}

#[test]
fn one_grain_keeps_its_temperature_and_none_is_fine() {
    assert!((temperature(&gas(&["particles.count=1"])) / 1.7 - 1.0).abs() < 1e-14);
    let sets = ["particles.count=0", "source={count=1,rate=1}", "gravity=[0,-1]", "boundary.y='open'"];
    assert_eq!(gas(&sets).len(), 0);
}

#[test]
fn velocities_scale_exactly_with_the_temperature() {
    let slow = gas(&[]);
    let fast = gas(&[&format!("initial.velocities.maxwell={:e}", 1.7 * 1_048_576.0)]);
    for (slow, fast) in slow.velocities().iter().zip(fast.velocities()) {
        assert_eq!(*slow * 1024.0, *fast);
    }
}

#[test]
fn rescaling_a_gas_scales_exactly() {
    let mut slow = gas(&[]);
    let mut fast = slow.clone();
    fast.velocities_mut().iter_mut().for_each(|velocity| *velocity *= 1024.0);
    rescale(&mut slow, 3.3);
    rescale(&mut fast, 3.3);
    assert_eq!(slow, fast);
    assert!((temperature(&slow) / 3.3 - 1.0).abs() < 1e-14);
}

#[test]
fn a_lattice_has_counts_that_differ_by_at_most_one() {
    for count in [1, 99, 100, 101, 150, 517] {
        let gas = gas(&["initial.positions=lattice", &format!("particles.count={count}")]);
        let counts: Vec<u32> = gas.offsets().windows(2).map(|w| w[1] - w[0]).collect();
        let (least, most) = (counts.iter().min().unwrap(), counts.iter().max().unwrap());
        assert!(most - least <= 1, "{count}: {least} … {most}");
        assert_eq!(gas.len(), count);
        // Spread evenly: no half of the box has more than a tenth of the cells too many.
        for axis in 0..2 {
            let lower = gas.positions().iter().filter(|p| p[axis] < 20.0).count() as f64;
            assert!((lower - 0.5 * count as f64).abs() <= 6.0, "{lower} of {count} along {axis}");
        }
    }
}

#[test]
fn no_cell_of_hsmc_starts_above_its_capacity() {
    // 10 × 10 cells of 4 d × 4 d hold 16 each: 1600 in all.
    for count in [1000, 1430, 1500, 1600] {
        let gas = gas(&["engine.kind=hsmc", &format!("particles.count={count}")]);
        assert_eq!(gas.len(), count);
        assert!(gas.largest_occupancy() <= 16, "{}", gas.largest_occupancy());
    }
}

#[test]
fn grains_start_inside_the_domain_of_a_vibrating_floor() {
    let sets = [
        "engine.kind=hsmc",
        "boundary.y={lower={wall='vibrating',amplitude=3,frequency=1},upper='open'}",
        "particles.count=1560",
    ];
    let gas = gas(&sets);
    assert_eq!(gas.grid().origin(), DVec2::new(0.0, -3.0));
    assert_eq!(gas.len(), 1560);
    assert!(gas.positions().iter().all(|p| p.y >= 0.0 && p.y < 40.0));
    assert!(gas.largest_occupancy() <= scenario(&sets).capacity().unwrap());
}

#[test]
fn a_log_has_to_be_read_and_to_fit() {
    let scenario = scenario(&["initial={positions={log='a.mcap'}}", "particles.count=2"]);
    assert!(matches!(build(&scenario, None), Err(InitialError::LogNotRead(_))));
    let columns = |x: f64| Columns {
        positions: vec![DVec2::ONE, DVec2::splat(x)],
        velocities: vec![DVec2::ONE; 2],
        ids: vec![4, 7],
        spins: None,
        species: None,
    };
    assert_eq!(build(&scenario, Some(columns(3.0))).unwrap().next_id(), 8);
    assert_eq!(build(&scenario, Some(columns(43.0))), Err(InitialError::Outside { id: 7 }));
    assert!(matches!(build(&scenario, Some(Columns::default())), Err(InitialError::Count { found: 0, .. })));
}
