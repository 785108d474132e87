//! Density waves in a pipe (Müller 2001, section 3.4).

use grainflow::statistics::{mean, standard_error};

use super::trial::{for_each, run, scenario};

/// Contrast between slices over that of independent grains, of a run for each seed; a list for each restitution.
fn contrasts(restitutions: &[&str], seeds: &[u64], sets: &[&str]) -> Vec<Vec<f64>> {
    let cases: Vec<_> = restitutions.iter().flat_map(|r| seeds.iter().map(move |seed| (r, *seed))).collect();
    let contrasts = for_each(&cases, |&(restitution, seed)| {
        let restitution = format!("particles.restitution={restitution}");
        let mut all = vec![restitution.as_str()];
        all.extend(sets);
        run(&scenario("pipe", seed, &all))["contrast_over_poisson"]
    });
    println!("contrast over Poisson at r = {restitutions:?}, seeds {seeds:?}: {contrasts:.3?}");
    contrasts.chunks(seeds.len()).map(<[f64]>::to_vec).collect()
}

/// The mean of independent runs, less and more three of its standard errors.
fn bounds(contrasts: &[f64]) -> (f64, f64) {
    let (mean, error) = (mean(contrasts).unwrap(), standard_error(contrasts).unwrap());
    (mean - 3.0 * error, mean + 3.0 * error)
}

/// Strong dissipation gathers grains: slices differ more than twice as much as by chance.
fn has_waves(contrasts: &[f64]) -> bool {
    bounds(contrasts).0 > 2.0
}

/// Next to no dissipation leaves less contrast than chance, as in any dense gas.
fn has_none(contrasts: &[f64]) -> bool {
    bounds(contrasts).1 < 1.0
}

#[test]
fn dissipation_makes_waves() {
    let contrasts = contrasts(&["0.6", "0.999"], &[1, 2, 3], &["run.time=120.0"]);
    assert!(has_waves(&contrasts[0]));
    assert!(has_none(&contrasts[1]));
}

/// Cells that hold four grains leave no room for a contrast: the claim needs the cells of the scenario, and fails without.
#[test]
fn small_cells_have_no_waves() {
    let contrasts = contrasts(&["0.6"], &[1, 2, 3], &["run.time=120.0", "engine.cell_size=2.0"]);
    assert!(bounds(&contrasts[0]).1 < 2.0);
}

#[test]
#[ignore = "full length: cargo test --release --test physics_scenarios -- --ignored"]
fn dissipation_makes_waves_at_full_length() {
    let contrasts = contrasts(&["0.0", "0.6", "0.9", "0.999"], &[1, 2, 3, 4, 5, 6], &[]);
    assert!(contrasts[..3].iter().all(|contrasts| has_waves(contrasts)));
    assert!(has_none(&contrasts[3]));
}
