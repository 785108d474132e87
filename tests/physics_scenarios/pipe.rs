//! Density waves in a pipe (Müller 2001, section 3.4).

use super::trial::{for_each, run, scenario};

/// Contrast between slices over that of independent grains, for each restitution.
fn contrasts(restitutions: &[&str], sets: &[&str]) -> Vec<f64> {
    let contrasts = for_each(restitutions, |restitution| {
        let restitution = format!("particles.restitution={restitution}");
        let mut all = vec![restitution.as_str()];
        all.extend(sets);
        run(&scenario("pipe", 1, &all))["contrast_over_poisson"]
    });
    println!("contrast over Poisson at r = {restitutions:?}: {contrasts:.3?}");
    contrasts
}

/// Strong dissipation gathers grains; next to none leaves less contrast than chance, as in any dense gas.
fn has_waves(contrast: f64) -> bool {
    contrast > 2.5
}

fn has_none(contrast: f64) -> bool {
    contrast < 1.1
}

#[test]
fn dissipation_makes_waves() {
    let contrasts = contrasts(&["0.6", "0.999"], &["run.time=120.0"]);
    assert!(has_waves(contrasts[0]) && has_none(contrasts[1]));
    assert!(!has_none(contrasts[0]) && !has_waves(contrasts[1]));
}

/// Cells that hold four grains leave no room for a contrast; with steps in which grains collide four times
/// an all but elastic gas makes one by itself: the claims need the cells and the steps of the scenario.
#[test]
fn small_cells_have_no_waves_and_long_steps_false_ones() {
    assert!(!has_waves(contrasts(&["0.6"], &["run.time=120.0", "engine.cell_size=2.0"])[0]));
    assert!(!has_none(contrasts(&["0.999"], &["run.time=120.0", "engine.time_step.crossing=0.5"])[0]));
}

#[test]
#[ignore = "full length: cargo test --release --test physics_scenarios -- --ignored"]
fn dissipation_makes_waves_at_full_length() {
    let contrasts = contrasts(&["0.0", "0.6", "0.9", "0.999"], &[]);
    assert!(contrasts[..3].iter().all(|&contrast| has_waves(contrast)));
    assert!(has_none(contrasts[3]));
}
