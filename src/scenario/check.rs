//! What a scenario means, in figures, before anything runs.

use std::fmt;

use super::bound::rounded;
use super::estimate::{self, Estimate};
use super::initial;
use super::model::{AnyScenario, EngineKind, InitialPositions, Scenario};
use super::{cost, exact, warnings};
use crate::law::piecewise::PiecewiseLinear;
use crate::machine::Machine;
use crate::space::Vector;

/// What a scenario means.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Check {
    /// Quantities and their values, in the order of reading.
    pub facts: Vec<(String, String)>,
    /// What may spoil the result.
    pub warnings: Vec<String>,
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = self.facts.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
        for (name, value) in &self.facts {
            writeln!(f, "{name:width$}  {value}")?;
        }
        for warning in &self.warnings {
            writeln!(f, "warning: {warning}")?;
        }
        Ok(())
    }
}

/// Says what `scenario` means.
pub fn check(scenario: &AnyScenario) -> Check {
    check_on(scenario, Machine::default())
}

/// Says what `scenario` means, and what it means for `machine`.
pub fn check_on(scenario: &AnyScenario, machine: Machine) -> Check {
    match scenario {
        AnyScenario::Two(scenario) => check_in_space(scenario, machine),
        AnyScenario::Three(scenario) => check_in_space(scenario, machine),
    }
}

fn check_in_space<V: Vector>(scenario: &Scenario<V>, machine: Machine) -> Check {
    let mut check = Check { facts: Vec::new(), warnings: Vec::new() };
    check.add("scenario", format!("{}: {}", scenario.name, scenario.title));
    check.add("engine", scenario.engine.kind.name().to_owned());
    check.matter(scenario);
    check.cells(scenario);
    check.laws(scenario);
    check.time(scenario);
    check.cost(scenario);
    check.warnings = warnings::warnings(scenario, machine);
    check
}

impl Check {
    fn add(&mut self, name: &str, value: String) {
        self.facts.push((name.to_owned(), value));
    }

    fn matter<V: Vector>(&mut self, scenario: &Scenario<V>) {
        let all = cost::final_grains(scenario);
        self.add("grains", now_and_then(scenario, scenario.count.to_string(), all.to_string()));
        let fractions = (scenario.volume_fraction(), volume_fraction_of(scenario, all));
        self.add("volume fraction", now_and_then(scenario, rounded(fractions.0), rounded(fractions.1)));
        if let Some(path) = estimate::mean_free_path(scenario) {
            let in_diameters = rounded(path / scenario.mean_grain().diameter);
            self.add("mean free path", format!("{} ({in_diameters} diameters)", length(scenario, path)));
        }
        for (number, (grain, count)) in
            scenario.constituents().enumerate().filter(|_| !scenario.species.is_empty())
        {
            let (diameter, mass) = (length(scenario, grain.diameter), rounded(grain.mass));
            let mass = with_unit(mass, &scenario.units.mass, "mass");
            let value = format!("{count} grains of diameter {diameter} and mass {mass}");
            self.add(&format!("species {}", number + 1), value);
        }
        let hard = scenario.engine.kind.is_event_driven() && scenario.count > 0;
        if hard && scenario.initial.positions == InitialPositions::Random && !initial::has_room(scenario) {
            self.add("positions", "compressed: too dense for grains to be put in one by one".to_owned());
        }
    }

    fn cells<V: Vector>(&mut self, scenario: &Scenario<V>) {
        let grid = scenario.grid();
        let join = |parts: Vec<String>| parts.join(" × ");
        let counts = join(grid.cells()[..V::DIMENSION].iter().map(ToString::to_string).collect());
        let sides = join(grid.side().components().into_iter().map(rounded).collect());
        self.add("cells", format!("{counts} of {}", with_unit(sides, &scenario.units.length, "length")));
        if let Some(wish) = wished_cell_size(scenario)
            && grid.side().components().iter().any(|side| (side / wish - 1.0).abs() > 1e-9)
        {
            self.add("", format!("(rounded from cell_size = {} so that whole cells fit)", rounded(wish)));
        }
        let per_cell = |grains: f64| rounded(grains_per_cell(scenario, grains));
        let (now, all) = (f64::from(scenario.count), cost::final_grains(scenario));
        self.add("grains per cell", now_and_then(scenario, per_cell(now), per_cell(all)));
        let Some(capacity) = scenario.capacity() else { return };
        self.add("capacity of a cell", format!("{capacity} grains"));
        let above = initial::cells_above_capacity(scenario);
        let unknown = match scenario.initial.positions {
            InitialPositions::Compressed => "known when the grains have grown",
            _ => "known when the log is read",
        };
        let above = above.map_or_else(|| unknown.to_owned(), |cells| cells.to_string());
        self.add("cells that start above it", above);
    }

    /// Laws that calibrations measure, where the engine uses them.
    fn laws<V: Vector>(&mut self, scenario: &Scenario<V>) {
        let engine = &scenario.engine;
        let range = |curve: &PiecewiseLinear| {
            let values = || curve.points().map(|[_, value]| value);
            let (low, high) =
                (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
            if low == high { rounded(low) } else { format!("{} to {}", rounded(low), rounded(high)) }
        };
        if let Some(c) = engine.impact_law.table().filter(|_| !engine.kind.is_event_driven()) {
            self.add("impact parameters", format!("p(b) ∝ 1/(1 − c b²) with c = {}", range(c)));
        }
        if let Some(p) = engine.entry_probability.as_ref().filter(|_| engine.kind == EngineKind::Hsmc) {
            self.add("entry probability", format!("{} by volume fraction", range(p)));
        }
    }

    fn time<V: Vector>(&mut self, scenario: &Scenario<V>) {
        if let Some(rates) = estimate::rates(scenario).filter(|_| estimate::is_within_theory(scenario)) {
            let theory = if scenario.engine.kind == EngineKind::Dsmc { "Boltzmann" } else { "Enskog" };
            let frequency = rounded(rates.collision_frequency);
            let unit = if scenario.units.time == "time" { "unit of time" } else { &scenario.units.time };
            self.add(
                "collision frequency",
                format!("{frequency} per grain and {unit} ({theory}, at the start)"),
            );
            if let Some(haff_time) = rates.haff_time {
                self.add("Haff time t₀", time(scenario, haff_time));
            }
        }
        if scenario.engine.kind.is_event_driven() {
            return;
        }
        match estimate::first_step(scenario) {
            Some(step) => self.add("first time step", format!("about {}", time(scenario, step))),
            None => self.add("first time step", "set by the first grains that move".to_owned()),
        }
    }

    fn cost<V: Vector>(&mut self, scenario: &Scenario<V>) {
        self.add("memory", format!("about {}", bytes(cost::memory(scenario))));
        self.add("log", format!("about {} before compression", bytes(cost::log_size(scenario))));
        if let Some(collisions) = estimate::collisions(scenario) {
            self.add("expected collisions", told(collisions, 1.2, count_of));
        }
        if let Some(steps) = estimate::steps(scenario) {
            self.add("expected steps", told(steps, 1.2, count_of));
        }
        if let Some(seconds) = cost::seconds(scenario) {
            self.add("expected time", format!("{} on one core", told(seconds, 2.0, spoken)));
        }
        if let Some(exact) = exact::proposal(scenario) {
            let long = told(exact.seconds, 2.0, spoken);
            self.add("exact dynamics", format!("{long} on one core ({})", exact.options()));
        }
    }
}

/// An estimate in words; bounds within a `factor` of each other are one number.
fn told(estimate: Estimate, factor: f64, show: fn(f64) -> String) -> String {
    let Estimate { least, most, open } = estimate;
    let (from, to) = (show(least), show(most));
    match (open, most <= factor * least || from == to) {
        (false, true) => format!("about {to}"),
        (false, false) => format!("{from} to {to}"),
        (true, true) => format!("about {to} or more"),
        (true, false) => format!("{from} to {to} or more"),
    }
}

/// A figure at the start, and with all grains of a source where there is one.
fn now_and_then<V: Vector>(scenario: &Scenario<V>, now: String, then: String) -> String {
    if scenario.source.is_some() { format!("{now} now, {then} when all are poured") } else { now }
}

/// A number with its unit where the scenario names one, without where it has the built-in word.
fn with_unit(number: String, unit: &str, unnamed: &str) -> String {
    if unit == unnamed { number } else { format!("{number} {unit}") }
}

fn length<V: Vector>(scenario: &Scenario<V>, value: f64) -> String {
    with_unit(rounded(value), &scenario.units.length, "length")
}

fn time<V: Vector>(scenario: &Scenario<V>, value: f64) -> String {
    with_unit(rounded(value), &scenario.units.time, "time")
}

/// Volume fraction of so many grains: those of the start, and poured ones.
pub(super) fn volume_fraction_of<V: Vector>(scenario: &Scenario<V>, grains: f64) -> f64 {
    let poured = grains - f64::from(scenario.count);
    let volume = f64::from(scenario.count) * scenario.mean_volume() + poured * scenario.grain.volume::<V>();
    volume / scenario.size.product()
}

/// Mean number of `grains` in a cell's volume of the domain.
pub(super) fn grains_per_cell<V: Vector>(scenario: &Scenario<V>, grains: f64) -> f64 {
    grains * scenario.grid().cell_volume() / scenario.size.product()
}

/// `engine.cell_size` as it stands in the text.
fn wished_cell_size<V: Vector>(scenario: &Scenario<V>) -> Option<f64> {
    let document: toml_edit::DocumentMut = scenario.source_text.parse().ok()?;
    let engine = document.get("engine")?.as_table_like()?;
    super::reader::number_of(engine.get("cell_size")?).ok()
}

pub(super) fn bytes(number: f64) -> String {
    let units = [(1e12, "TB"), (1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    match units.into_iter().find(|(size, _)| number >= *size) {
        Some((size, unit)) => format!("{:.1} {unit}", number / size),
        None => format!("{number:.0} bytes"),
    }
}

/// A duration as people say it: a factor of two is all that can be known.
pub(super) fn spoken(seconds: f64) -> String {
    const WORDS: [(f64, &str); 9] = [
        (2.0, "a second"),
        (7.0, "a few seconds"),
        (20.0, "ten seconds"),
        (45.0, "half a minute"),
        (100.0, "a minute"),
        (420.0, "a few minutes"),
        (1080.0, "ten minutes"),
        (2700.0, "half an hour"),
        (5400.0, "an hour"),
    ];
    match WORDS.iter().find(|(limit, _)| seconds < *limit) {
        Some((_, words)) => (*words).to_owned(),
        None if seconds < 172_800.0 => format!("{:.0} hours", seconds / 3600.0),
        None => format!("{} days", count_of((seconds / 86_400.0).round())),
    }
}

pub(super) fn count_of(number: f64) -> String {
    if number < 1e7 { format!("{number:.0}") } else { format!("{number:.2e}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{Overrides, load};

    fn checked(name: &str, sets: &[&str]) -> String {
        let sets = sets.iter().map(ToString::to_string).collect();
        check(&load(name, &Overrides { sets, ..Default::default() }).unwrap()).to_string()
    }

    fn fact(name: &str, sets: &[&str], fact: &str) -> String {
        let text = checked(name, sets);
        let line = text.lines().find(|line| line.starts_with(fact)).unwrap_or_default();
        line.trim_start_matches(fact).trim().to_owned()
    }

    #[test]
    fn shear_is_what_the_book_says() {
        assert_eq!(fact("shear", &[], "grains "), "2037");
        assert_eq!(fact("shear", &[], "cells "), "160 × 16 of 2.5 × 2.5");
        assert_eq!(fact("shear", &[], "capacity of a cell"), "6 grains");
        assert_eq!(fact("shear", &[], "cells that start above it"), "0");
        assert!(fact("shear", &[], "mean free path").starts_with("2.35"));
    }

    #[test]
    fn haff_time_is_that_of_enskog_theory() {
        // t₀ = √π d/(2 λ ν g √(T/m)) in 2D: 1.77245/(2 · 0.19 · 0.25 · 1.58333).
        assert!(fact("cooling", &[], "Haff time").contains("11.78"), "{}", checked("cooling", &[]));
        assert!(fact("cooling", &["engine.kind=dsmc"], "Haff time").contains("18.66"));
    }

    #[test]
    fn a_source_counts_with_all_its_grains() {
        assert_eq!(fact("heap", &[], "grains "), "0 now, 3000 when all are poured");
        assert_eq!(fact("heap", &[], "volume fraction"), "0 now, 0.03682 when all are poured");
        assert_eq!(fact("heap", &[], "grains per cell"), "0 now, 0.1875 when all are poured");
    }

    #[test]
    fn units_are_named_where_the_scenario_names_them() {
        assert_eq!(fact("shear", &[], "first time step"), "about 0.1877");
        assert!(fact("shear", &[], "collision frequency").contains("per grain and unit of time"));
        assert_eq!(fact("sedimentation", &[], "first time step"), "about 0.0002 s");
        assert_eq!(fact("sedimentation", &[], "cells "), "10 × 20 of 0.002 × 0.002 m");
    }

    #[test]
    fn costs_are_those_of_real_runs() {
        // Measured on one core: heap 64 000 steps in 28 s, pipe 10 804 steps, shear 3672, cooling 499.
        assert_eq!(fact("heap", &[], "expected steps"), "about 64000");
        assert_eq!(fact("heap", &[], "expected time"), "about half a minute on one core");
        assert_eq!(fact("cooling", &[], "expected steps"), "about 500");
        assert!(fact("pipe", &[], "expected steps").ends_with("or more"));
        let far = ["run={collisions_per_particle=4000}", "particles.restitution=0.9"];
        assert!(fact("cooling", &far, "expected steps").ends_with("or more"));
        assert!(!fact("cooling", &[], "expected steps").ends_with("or more"));
        let pipe: f64 = fact("pipe", &[], "expected steps").split(' ').nth(1).unwrap().parse().unwrap();
        assert!((4000.0..10_804.0).contains(&pipe), "{pipe}");
        let crossing = ["engine.time_step={crossing=0.5}"];
        assert!(fact("sedimentation", &crossing, "expected steps").contains(" to "));
    }

    #[test]
    fn measured_laws_are_told_where_they_apply() {
        let curve = "engine.impact_parameter={collisions_per_particle=[0,9],c=[0,0.4]}";
        assert_eq!(fact("cooling", &[curve], "impact parameters"), "p(b) ∝ 1/(1 − c b²) with c = 0 to 0.4");
        assert_eq!(fact("cooling", &[], "impact parameters"), "");
        assert_eq!(fact("cooling", &[curve, "engine.kind=event-driven"], "impact parameters"), "");
        let entry = "engine.hsmc.entry_probability={volume_fraction=[0],probability=[0.5]}";
        assert_eq!(fact("cooling", &[entry], "entry probability"), "0.5 by volume fraction");
    }

    #[test]
    fn durations_are_spoken() {
        let words = [0.1, 30.0, 3000.0, 20_000.0, 1e6].map(spoken);
        assert_eq!(words, ["a second", "half a minute", "an hour", "6 hours", "12 days"]);
        assert_eq!(
            told(Estimate { least: 10.0, most: 100.0, open: true }, 2.0, count_of),
            "10 to 100 or more"
        );
    }
}
