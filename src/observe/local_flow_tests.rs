use super::*;
use crate::matter::grain::Grain;
use crate::observe::moments::temperature;
use crate::observe::testing::{random_positions, random_velocities, setting_of};
use glam::{DVec2, DVec3};

/// What a gas at rest is given: a velocity that all share, and a gradient, `[axis]` the change of velocity along that axis.
struct Motion<V> {
    wind: V,
    gradient: [V; 3],
}

/// A Maxwell gas of temperature 1 with this motion; a mixture of masses 1 and 8, or of masses 1 alone.
fn gas<V: Vector>(seed: u64, grains: usize, size: V, is_mixture: bool, motion: &Motion<V>) -> Gas<V> {
    let bed = setting_of(size, [24; 3]);
    let positions = random_positions(seed, grains, size);
    let mut gas = bed.gas(0.0, positions, random_velocities(seed + 1, grains));
    if is_mixture {
        gas.species = vec![Grain { diameter: 1.0, mass: 1.0 }, Grain { diameter: 1.0, mass: 8.0 }];
        gas.parts_mut().2.species = Some((0..grains).map(|row| (row % 2) as u8).collect());
    }
    let moved: Vec<V> = (0..grains)
        .map(|row| {
            let thermal = gas.velocities()[row] * (1.0 / gas.grain_at(row).mass.sqrt());
            let place = gas.positions()[row];
            let axes = 0..V::DIMENSION;
            axes.fold(thermal + motion.wind, |sum, axis| sum + motion.gradient[axis] * place[axis])
        })
        .collect();
    gas.velocities_mut().copy_from_slice(&moved);
    gas
}

/// Temperatures of 40 gases with this motion about their flow, and the standard error of their mean.
fn mean_temperature<V: Vector>(size: V, grains: usize, is_mixture: bool, motion: &Motion<V>) -> (f64, f64) {
    let values: Vec<f64> = (0..40)
        .map(|k| {
            let gas = gas(100 + 2 * k, grains, size, is_mixture, motion);
            LocalFlow::of(&gas, grains_of_a_bin::<V>()).temperature().unwrap()
        })
        .collect();
    let mean = values.iter().sum::<f64>() / 40.0;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / 39.0;
    (mean, (variance / 40.0).sqrt())
}

/// A gas has its temperature at rest, in a wind, and in a flow that is linear along every axis.
fn check<V: Vector>(size: V) {
    let none = [V::ZERO; 3];
    let wind = V::from_fn(|axis| [40.0, -7.0, 3.0][axis]);
    let gradient =
        [0, 1, 2].map(|axis| V::from_fn(|a| [[0.3, -0.4, 0.2], [0.9, 0.1, -0.3], [0.5, 0.2, -0.4]][axis][a]));
    for is_mixture in [false, true] {
        let at_rest = mean_temperature(size, 1500, is_mixture, &Motion { wind: V::ZERO, gradient: none });
        let (value, error) = at_rest;
        assert!(error < 0.008 && (value - 1.0).abs() < 3.0 * error, "at rest {value} ± {error}");
        for motion in [Motion { wind, gradient: none }, Motion { wind, gradient }] {
            let moving = mean_temperature(size, 1500, is_mixture, &motion);
            // The same thermal velocities: the fit takes the motion out to rounding.
            assert!((moving.0 - at_rest.0).abs() < 1e-9, "{moving:?} beside {at_rest:?}");
            let gas = gas(100, 1500, size, is_mixture, &motion);
            let whole = temperature(&gas);
            let speed = LocalFlow::of(&gas, grains_of_a_bin::<V>()).mean_speed(&gas);
            // ⟨|v|⟩ √(m/T) is √(π/2) in 2D and √(8/π) in 3D; half of the grains of a mixture are slower by √8.
            let maxwell = V::MEAN_RELATIVE_SPEED * 0.5_f64.sqrt();
            let share = if is_mixture { 0.5 + 0.5 / 8.0_f64.sqrt() } else { 1.0 };
            assert!((speed / (maxwell * share) - 1.0).abs() < 0.05, "{speed}");
            let is_linear = motion.gradient[0] != V::ZERO;
            assert_eq!(whole > 3.0, is_linear, "about the mean of all grains it is {whole}");
        }
    }
}

#[test]
fn a_gas_at_rest_in_a_wind_and_in_a_linear_flow_has_one_temperature_in_2d() {
    check(DVec2::new(24.0, 48.0));
}

#[test]
fn a_gas_at_rest_in_a_wind_and_in_a_linear_flow_has_one_temperature_in_3d() {
    check(DVec3::new(12.0, 12.0, 24.0));
}

#[test]
fn a_wave_of_a_few_bins_adds_little() {
    // A shear wave of 5 thermal velocities, its length that of the box: 8.7 bins.
    let size = DVec2::splat(24.0);
    let mut gas = gas(5, 1500, size, false, &Motion { wind: DVec2::ZERO, gradient: [DVec2::ZERO; 3] });
    let calm = LocalFlow::of(&gas, grains_of_a_bin::<DVec2>()).temperature().unwrap();
    let places: Vec<f64> = gas.positions().iter().map(|place| place.y).collect();
    for (velocity, y) in gas.velocities_mut().iter_mut().zip(places) {
        velocity.x += 5.0 * (std::f64::consts::TAU * y / 24.0).sin();
    }
    let wave = LocalFlow::of(&gas, grains_of_a_bin::<DVec2>()).temperature().unwrap();
    // m (u″Δ²)²/720 halved by the sine's square and by D: (5 (2π/8)²)²/720/4 = 0.003.
    assert!((wave - calm).abs() < 0.02, "{wave} beside {calm}; whole {}", temperature(&gas));
    assert!(temperature(&gas) > 6.0);
}

#[test]
fn peculiar_velocities_of_a_mixture_have_the_variance_of_their_species() {
    let mut squares = [[0.0, 0.0]; 2];
    for seed in 0..60 {
        let motion = Motion { wind: DVec2::ONE, gradient: [DVec2::Y, DVec2::X * 0.7, DVec2::ZERO] };
        let gas = gas(900 + 2 * seed, 400, DVec2::splat(20.0), true, &motion);
        let flow = LocalFlow::of(&gas, 10.0);
        for bin in flow
            .each_bin(&gas, |flow, rows| {
                let mut sums = [[0.0, 0.0]; 2];
                for row in rows.flatten() {
                    let grain = gas.grain_at(row);
                    let c = flow.peculiar(grain.mass, gas.positions()[row], gas.velocities()[row]);
                    let sum = &mut sums[usize::from(grain.mass > 1.0)];
                    sum[0] += grain.mass * c.length_squared() / 2.0;
                    sum[1] += 1.0;
                }
                sums
            })
            .into_iter()
            .flatten()
        {
            for (sum, part) in squares.iter_mut().zip(bin) {
                sum[0] += part[0];
                sum[1] += part[1];
            }
        }
    }
    for [sum, count] in squares {
        // The square of two components has a variance of 1, and few grains of a bin are correlated.
        assert!((sum / count - 1.0).abs() < 3.5 / f64::sqrt(count), "{} of {count}", sum / count);
    }
}

#[test]
fn bins_are_cubes_of_cells_that_leave_nothing_out() {
    let size = DVec3::new(2.0, 12.0, 48.0);
    let bed = setting_of(size, [2, 12, 48]);
    let gas = bed.gas(0.0, random_positions(1, 3000, size), random_velocities(2, 3000));
    let bins = Bins::of(&gas, 40.0);
    // 40 grains fill 15.4: 2 × 2.77 × 2.77.
    assert_eq!((bins.counts, bins.has_gradient), ([1, 4, 17], [false, true, true]));
    let mut rows: Vec<usize> = (0..bins.number()).flat_map(|bin| bins.rows(&gas, bin).flatten()).collect();
    rows.sort_unstable();
    assert_eq!(rows, (0..3000).collect::<Vec<_>>());
}

#[test]
fn few_grains_say_nothing_and_grains_in_a_row_have_a_gradient_along_it_alone() {
    let mut bed = setting_of(DVec2::splat(8.0), [4, 4, 1]);
    let temperature = |gas: &Gas<DVec2>| LocalFlow::of(gas, 20.0).temperature();
    assert_eq!(temperature(&bed.gas(0.0, vec![], vec![])), None);
    assert_eq!(temperature(&bed.gas(0.0, vec![DVec2::ONE], vec![DVec2::X])), None);
    // One bin, all of it periodic: about the mean alone.
    let pair = bed.gas(0.0, vec![DVec2::ONE, DVec2::splat(3.0)], vec![DVec2::X, -DVec2::X]);
    assert_eq!(temperature(&pair), Some(1.0));
    bed.walls(0, crate::observe::testing::smooth(), crate::observe::testing::smooth());
    bed.walls(1, crate::observe::testing::smooth(), crate::observe::testing::smooth());
    let row = |velocities: &[f64]| {
        let places = (0..velocities.len()).map(|k| DVec2::new(1.0 + k as f64, 2.0)).collect();
        bed.gas(0.0, places, velocities.iter().map(|&v| DVec2::new(0.0, v)).collect())
    };
    // Two points make a line.
    assert_eq!(temperature(&row(&[1.0, 4.0])), None);
    // About the line through 4/3, 7/3, 10/3: (1 + 4 + 1)/9 over D (3 − 1 − 1).
    let bent = temperature(&row(&[1.0, 3.0, 3.0])).unwrap();
    assert!((bent - 1.0 / 3.0).abs() < 1e-12, "{bent}");
}

#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    let motion = Motion { wind: DVec3::X, gradient: [DVec3::Y, DVec3::ZERO, DVec3::X] };
    let gas = gas(3, 30_000, DVec3::splat(24.0), true, &motion);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| LocalFlow::of(&gas, 40.0).temperature().unwrap().to_bits())
    };
    assert_eq!(with(1), with(3));
}
