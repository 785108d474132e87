//! Runs through the library, down to their figures.

use grainflow::engine::{Horizon, NoLaps};
use grainflow::observe::measure::Figure;
use grainflow::scenario::initial;
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::scenario::{Overrides, parse};
use grainflow::simulation::Simulation;
use grainflow::space::Vector;
use grainflow::statistics::student::two_sided;

/// The figures of the run of `text` with `sets`, from the time on that the run chooses itself.
pub(crate) fn figures(text: &str, sets: &[&str]) -> Vec<Figure> {
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    let scenario = parse("trial", text, &Overrides { sets, ..Default::default() });
    match scenario.unwrap_or_else(|error| panic!("{error}\n{text}")) {
        AnyScenario::Two(scenario) => run(&scenario),
        AnyScenario::Three(scenario) => run(&scenario),
    }
}

fn run<V: Vector>(scenario: &Scenario<V>) -> Vec<Figure> {
    let gas = initial::build(scenario, None).unwrap();
    let mut simulation = Simulation::start(scenario, gas, &mut NoLaps).unwrap();
    while simulation.end_reason().is_none() {
        simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
    }
    let from = simulation.steady_from();
    let (measures, snapshot) = simulation.observation();
    measures.iter().flat_map(|measure| measure.conclusion(&snapshot, from).1).collect()
}

/// The figure of that name.
pub(crate) fn figure(figures: &[Figure], name: &str) -> Figure {
    figures.iter().find(|figure| figure.name == name).unwrap_or_else(|| panic!("no {name}")).clone()
}

/// Probability of a distance from `truth` as large as that of `figure` or larger, by Student's t.
pub(crate) fn chance(figure: &Figure, truth: f64) -> f64 {
    let (Some(value), Some(error), Some(freedom)) =
        (figure.value, figure.standard_error, figure.degrees_of_freedom)
    else {
        panic!("{figure:?} has no error")
    };
    two_sided((value - truth).abs() / error, freedom)
}
