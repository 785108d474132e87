use super::*;
use crate::engine::report::Totals;
use crate::matter::grain::Grain;
use crate::observe::testing::{
    assert_resumes, figure_of, random_positions, random_velocities, setting_of, show, smooth,
};
use crate::statistics::average;
use glam::{DVec2, DVec3};

/// A gas at one place with these velocities.
fn moving<V: Vector>(velocities: Vec<V>) -> Gas<V> {
    let size = V::from_fn(|_| 4.0);
    setting_of(size, [1, 1, 1]).gas(0.0, vec![size * 0.5; velocities.len()], velocities)
}

/// Velocities on a lattice that fills the cube [−1, 1]ᴰ evenly, about a drift.
fn even<V: Vector>(per_axis: usize) -> Gas<V> {
    let drift = V::from_fn(|axis| 3.0 - axis as f64);
    let place = |k: usize| (2 * k + 1) as f64 / per_axis as f64 - 1.0;
    let number = per_axis.pow(V::DIMENSION as u32);
    moving(
        (0..number)
            .map(|k| V::from_fn(|axis| place(k / per_axis.pow(axis as u32) % per_axis)) + drift)
            .collect(),
    )
}

#[test]
fn an_even_distribution_has_its_own_moments() {
    // σ² = 1/3: 9/5 of 3, 27/7 of 15, 81/9 of 105; the lattice is coarse by 1/K².
    let close = |found: &[f64], a2: f64, coarse: f64| {
        let expected = [1.0, 0.6, 9.0 / 35.0, 3.0 / 35.0, a2];
        found
            .iter()
            .zip(expected)
            .for_each(|(f, e)| assert!((f - e).abs() < coarse, "{found:?} {expected:?}"));
    };
    close(&look(&even::<DVec2>(100), 0)[..5], -0.3, 2e-4);
    close(&look(&even::<DVec3>(30), 2)[..5], -0.24, 2e-3);
    // Of width 2√3: 34.6 bins.
    let density = look(&even::<DVec2>(1000), 0)[NAMES.len()..].to_vec();
    assert!((density[60] - 1.0 / 12.0_f64.sqrt()).abs() < 0.01 && density[60 + 18] == 0.0);
    assert!((density.iter().sum::<f64>() * WIDTH - 1.0).abs() < 1e-12);
}

/// Standard errors of the moments of a Gaussian sample with its own mean and variance, times the root of the number
/// of components; of a₂ in two dimensions: (96 − 72)/3², 6120/15², 1 663 200/105², and 8/(D(D + 2)) per grain.
fn errors(components: f64) -> [f64; 4] {
    [24.0 / 9.0, 27.2, 1_663_200.0 / 11_025.0, 2.0].map(|variance| (variance / components).sqrt())
}

/// Whether all moments of a gas in two dimensions are Maxwell's within four standard errors.
fn is_maxwell(gas: &Gas<DVec2>) -> bool {
    let found = look(gas, 0);
    let expected = [1.0, 1.0, 1.0, 0.0];
    (0..4).all(|k| (found[1 + k] - expected[k]).abs() < 4.0 * errors(2.0 * gas.len() as f64)[k])
}

#[test]
fn a_maxwell_gas_has_the_moments_one() {
    let mut velocities: Vec<DVec2> = random_velocities(3, 100_000);
    let gas = moving(velocities.clone());
    assert!(is_maxwell(&gas));
    // Every second grain slower by a fifth: 1 + a₂ = 2 (1 + 0.8⁴)/(1 + 0.8²)² = 1.048, its error is 0.003.
    velocities.iter_mut().step_by(2).for_each(|v| *v *= 0.8);
    assert!(!is_maxwell(&moving(velocities)));
    // χ² over bins that are not nearly empty has their number as mean and twice it as variance.
    let mut measure = VelocityDistribution::new(&setting_of(DVec2::splat(4.0), [1, 1, 1]).setting);
    let profiles = measure.profiles(&Snapshot::new(&gas, &Totals::default()));
    let [_, density, error, maxwell] = &profiles[0].values[..] else { panic!("four columns") };
    let squares: Vec<f64> = (0..BINS)
        .filter(|&bin| maxwell[bin] * WIDTH * 200_000.0 > 20.0)
        .map(|bin| ((density[bin] - maxwell[bin]) / error[bin]).powi(2))
        .collect();
    let (sum, bins) = (squares.iter().sum::<f64>(), squares.len() as f64);
    assert!(bins > 60.0 && (sum - bins).abs() < 4.0 * (2.0 * bins).sqrt(), "{sum} of {bins}");
    assert!((maxwell.iter().sum::<f64>() * WIDTH - 1.0).abs() < 3e-9);
}

/// Grains all over a box of 20, in cells of 1.
fn spread(velocities: Vec<DVec2>) -> Gas<DVec2> {
    let size = DVec2::splat(20.0);
    let positions = random_positions(9, velocities.len(), size);
    setting_of(size, [20, 20, 1]).gas(0.0, positions, velocities)
}

/// `gas` sheared at 1.
fn sheared(mut gas: Gas<DVec2>) -> Gas<DVec2> {
    let heights: Vec<f64> = gas.positions().iter().map(|place| place.y).collect();
    gas.velocities_mut().iter_mut().zip(heights).for_each(|(v, y)| v.x += y);
    gas
}

#[test]
fn a_flow_is_not_in_the_moments() {
    let gas = spread(random_velocities(3, 100_000));
    assert!(is_maxwell(&gas));
    let at_rest = look(&gas, 0);
    let moving = look(&sheared(gas), 0);
    for k in 0..NAMES.len() {
        assert!((moving[k] - at_rest[k]).abs() < 1e-9, "{}: {} beside {}", NAMES[k], moving[k], at_rest[k]);
    }
    assert!((at_rest[0] - 1.0).abs() < 0.02, "{}", at_rest[0]);
    // A gas of another shape is seen through the flow: 97 % of a₂.
    let mut velocities: Vec<DVec2> = random_velocities(3, 100_000);
    velocities.iter_mut().step_by(2).for_each(|v| *v *= 0.5);
    let a2 = look(&sheared(spread(velocities)), 0)[4];
    // 2 (1 + 1/16)/(1 + 1/4)² − 1 = 0.36, its error is 0.006: three of them beside what is left out.
    assert!((a2 / 0.36 - 0.97).abs() < 0.055, "{a2}");
}

#[test]
fn few_grains_miss_by_what_their_own_mean_takes() {
    let replicas: Vec<Vec<f64>> =
        (0..4000).map(|k| look(&moving(random_velocities::<DVec3>(k, 20)), 0)).collect();
    // D (N − 1) = 57.
    let m = 57.0;
    let fourth = m / (m + 2.0);
    let sixth = fourth * m / (m + 4.0);
    let expected = [1.0, fourth, sixth, sixth * m / (m + 6.0), fourth - 1.0];
    for (k, expected) in expected.into_iter().enumerate() {
        let found = average(&replicas.iter().map(|row| row[k]).collect::<Vec<_>>()).unwrap();
        let error = found.standard_error.unwrap();
        assert!((found.value - expected).abs() < 4.0 * error, "{k}: {found:?} {expected}");
        // Without that there would be 1.
        let naive = if k < 4 { 1.0 } else { 0.0 };
        assert!(k == 0 || (found.value - naive).abs() > 4.0 * error);
    }
}

#[test]
fn every_grain_of_a_mixture_has_its_thermal_velocity() {
    let mut velocities: Vec<DVec2> = random_velocities(8, 60_000);
    velocities.iter_mut().step_by(2).for_each(|v| *v *= 0.5);
    let mut gas = moving(velocities);
    assert!(!is_maxwell(&gas));
    gas.species = vec![Grain { diameter: 1.0, mass: 4.0 }, Grain { diameter: 1.0, mass: 1.0 }];
    gas.parts_mut().2.species = Some((0..60_000).map(|k| (k % 2) as u8).collect());
    assert!(is_maxwell(&gas));
}

#[test]
fn axes_are_told_apart() {
    let gas = moving(vec![DVec2::X, -DVec2::X, DVec2::new(0.0, 0.5), DVec2::new(0.0, -0.5)]);
    // ⟨v_x²⟩ = 1/2, ⟨v_y²⟩ = 1/8: shares 8/5 and 2/5.
    assert!((look(&gas, 0)[0] - 1.6).abs() < 1e-15 && (look(&gas, 1)[0] - 0.4).abs() < 1e-15);
    let mut bed = setting_of(DVec2::new(4.0, 3.0), [1, 1, 1]);
    assert_eq!(VelocityDistribution::new(&bed.setting).axis, 0);
    bed.walls(1, smooth(), smooth());
    assert_eq!(VelocityDistribution::new(&bed.setting).axis, 1);
}

#[test]
fn what_does_not_move_has_no_distribution() {
    let bed = setting_of(DVec2::splat(4.0), [1, 1, 1]);
    let drift = DVec2::new(0.1, 0.7);
    for velocities in [vec![], vec![DVec2::X], vec![drift; 7]] {
        let state = (moving(velocities), Totals::default());
        let mut measure = VelocityDistribution::new(&bed.setting);
        assert!(show(&mut measure, &state).iter().all(|x| x.is_nan()));
        assert_eq!(figure_of(&mut measure, &[state], 0.0, "alpha_4"), (None, None));
    }
}

#[test]
fn a_run_is_averaged_and_resumes() {
    let bed = setting_of(DVec3::splat(4.0), [2, 2, 2]);
    let states = bed.random_states(20, 500);
    assert_resumes(|| Box::new(VelocityDistribution::new(&bed.setting)), &states);
    let mut measure = VelocityDistribution::new(&bed.setting);
    let (value, error) = figure_of(&mut measure, &states, 5.0, "alpha_4");
    let late: Vec<f64> = states[5..].iter().map(|(gas, _)| look(gas, 0)[1]).collect();
    // The ends stand for half as much time.
    let mean = (late.iter().sum::<f64>() - 0.5 * (late[0] + late[14])) / 14.0;
    assert!((value.unwrap() - mean).abs() < 1e-14 && error.unwrap() > 0.0);
}

#[test]
fn threads_change_no_bit() {
    let gas = moving::<DVec3>(random_velocities(2, 20_000));
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| look(&gas, 0))
    };
    assert_eq!(with(1), with(5));
}
