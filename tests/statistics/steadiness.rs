//! What is called steady and what is not.

use crate::trial::{figure, figures};
use grainflow::observe::measure::Figure;
use grainflow::statistics::Trend;

/// The built-in scenario of that name.
fn builtin(name: &str) -> String {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenarios/{name}.toml"));
    std::fs::read_to_string(path).unwrap()
}

fn unsteady(figures: &[Figure]) -> Vec<&Figure> {
    figures.iter().filter(|figure| figure.trend.is_some_and(|trend| trend != Trend::Steady)).collect()
}

/// Elastic gases in equilibrium, of all engines and densities. The slowest waves of density of a dense gas take hundreds of
/// collisions to even out: the runs last for 50 times of that at least, 1/(D k²) with k = 2π/L and D ≈ λv̄/2.
fn steady_gas(number: u64) -> String {
    let engine = ["dsmc", "cba", "hsmc", "event-driven"][number as usize % 4];
    let (fraction, collisions) =
        [(0.05, 2000.0), (0.1, 3000.0), (0.2, 6000.0), (0.3, 12_000.0), (0.25, 8000.0)][number as usize % 5];
    format!(
        "dimension = 2\nseed = {number}\n[engine]\nkind = \"{engine}\"\n[domain]\nsize = [30.0, 30.0]\n[particles]\n\
         volume_fraction = {fraction}\nrestitution = 1.0\n[initial]\nvelocities = {{ maxwell = 1.0 }}\nequilibrate = 20.0\n\
         [run]\ncollisions_per_particle = {collisions}\n"
    )
}

/// Figures that are called unsteady, of so many steady gases.
fn false_alarms(gases: impl Iterator<Item = u64>) -> (usize, usize) {
    let (mut alarms, mut tested) = (0, 0);
    for number in gases {
        let figures = figures(&steady_gas(number), &[]);
        tested += figures.iter().filter(|figure| figure.trend.is_some()).count();
        for figure in unsteady(&figures) {
            println!("gas {number}: {figure:?}");
            alarms += 1;
        }
    }
    println!("{alarms} of {tested} figures");
    (alarms, tested)
}

#[test]
fn a_few_steady_gases_are_called_steady() {
    // The most dilute of each engine.
    let (alarms, tested) = false_alarms([5, 10, 15, 20].into_iter());
    assert!(tested >= 4 * 10, "{tested}");
    assert!(alarms <= 1, "{alarms}");
}

#[test]
#[ignore = "minutes: cargo test --release --test statistics -- --ignored --nocapture twenty_steady_gases"]
fn of_twenty_steady_gases_at_most_one_figure_is_called_unsteady() {
    let (alarms, tested) = false_alarms(1..=20);
    assert!(tested >= 20 * 10 && alarms <= 1, "{alarms} of {tested}");
}

#[test]
fn a_gas_that_cools_has_no_steady_pressure() {
    let text = builtin("cooling");
    let sets = ["particles.count=1000", "domain.size=[56.05, 56.05]", "run.collisions_per_particle=40"];
    let figures = figures(&text, &sets);
    for name in ["pressure", "collision_frequency"] {
        assert_eq!(figure(&figures, name).trend, Some(Trend::Falling), "{name}");
    }
}

#[test]
#[ignore = "minutes: cargo test --release --test statistics -- --ignored --nocapture a_shear_cell"]
fn a_shear_cell_that_has_not_settled_is_not_called_steady() {
    let text = builtin("shear");
    let sets = [
        "particles.volume_fraction=0.4",
        "boundary.y.lower.velocity[0]=-5",
        "boundary.y.upper.velocity[0]=5",
        "run.collisions_per_particle=300",
    ];
    let early = figures(&text, &sets);
    println!("{:?}", figure(&early, "velocity_profile_slope"));
    assert!(!unsteady(&early).is_empty());
    let slope = figure(&early, "velocity_profile_slope");
    assert_ne!(slope.trend, Some(Trend::Steady), "{slope:?}");
}
