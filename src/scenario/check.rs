//! What a scenario means, in figures, before anything runs.

use std::fmt;

use super::bound::rounded;
use super::estimate;
use super::initial;
use super::model::{AnyScenario, EngineKind, EnskogFactor, InitialPositions, Scenario, TimeStep};
use crate::law::boundary::Face;
use crate::law::kinetic_theory::mean_free_path;
use crate::law::restitution::{Constant, RestitutionLaw};
use crate::space::Vector;

/// Up to so many grains the initial state is built to count full cells.
const BUILT_GRAINS: u32 = 4_000_000;

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
    match scenario {
        AnyScenario::Two(scenario) => check_in_space(scenario),
        AnyScenario::Three(scenario) => check_in_space(scenario),
    }
}

fn check_in_space<V: Vector>(scenario: &Scenario<V>) -> Check {
    let mut check = Check { facts: Vec::new(), warnings: Vec::new() };
    check.add("scenario", format!("{}: {}", scenario.name, scenario.title));
    check.add("engine", scenario.engine.kind.name().to_owned());
    check.matter(scenario);
    check.cells(scenario);
    check.time(scenario);
    check.cost(scenario);
    check.warn(scenario);
    check
}

impl Check {
    fn add(&mut self, name: &str, value: String) {
        self.facts.push((name.to_owned(), value));
    }

    fn matter<V: Vector>(&mut self, scenario: &Scenario<V>) {
        let poured = scenario.source.as_ref().map(|source| format!(", and {} poured", source.count));
        self.add("grains", format!("{}{}", scenario.count, poured.unwrap_or_default()));
        self.add("volume fraction", rounded(scenario.volume_fraction()));
        if scenario.count > 0 {
            let path = mean_free_path::<V>(scenario.grain, scenario.volume_fraction());
            let in_diameters = rounded(path / scenario.grain.diameter);
            self.add(
                "mean free path",
                format!("{} {} ({in_diameters} diameters)", rounded(path), scenario.units.length),
            );
        }
    }

    fn cells<V: Vector>(&mut self, scenario: &Scenario<V>) {
        let grid = scenario.grid();
        let join = |parts: Vec<String>| parts.join(" × ");
        let counts = join(grid.cells()[..V::DIMENSION].iter().map(ToString::to_string).collect());
        let sides = join(grid.side().components().into_iter().map(rounded).collect());
        self.add("cells", format!("{counts} of {sides} {}", scenario.units.length));
        if let Some(wish) = wished_cell_size(scenario)
            && grid.side().components().iter().any(|side| (side / wish - 1.0).abs() > 1e-9)
        {
            self.add("", format!("(rounded from cell_size = {} so that whole cells fit)", rounded(wish)));
        }
        self.add("grains per cell", rounded(grains_per_cell(scenario)));
        let Some(capacity) = scenario.capacity() else { return };
        self.add("capacity of a cell", format!("{capacity} grains"));
        let above = match scenario.initial.positions {
            InitialPositions::Log(_) => "known when the log is read".to_owned(),
            _ if scenario.count > BUILT_GRAINS => "none".to_owned(),
            _ => initial::build(scenario, None).map_or_else(
                |error| error.to_string(),
                |gas| gas.offsets().windows(2).filter(|w| w[1] - w[0] > capacity).count().to_string(),
            ),
        };
        self.add("cells that start above it", above);
    }

    fn time<V: Vector>(&mut self, scenario: &Scenario<V>) {
        let unit = &scenario.units.time;
        if let Some(rates) = estimate::rates(scenario) {
            let theory = if scenario.engine.kind == EngineKind::Dsmc { "Boltzmann" } else { "Enskog" };
            let frequency = rounded(rates.collision_frequency);
            self.add(
                "collision frequency",
                format!("{frequency} per grain and {unit} ({theory}, at the start)"),
            );
            if let Some(haff_time) = rates.haff_time {
                self.add("Haff time t₀", format!("{} {unit}", rounded(haff_time)));
            }
        }
        match estimate::first_step(scenario) {
            Some(step) => self.add("first time step", format!("about {} {unit}", rounded(step))),
            None => self.add("first time step", "set by the first grains that move".to_owned()),
        }
    }

    fn cost<V: Vector>(&mut self, scenario: &Scenario<V>) {
        self.add("memory", format!("about {}", bytes(estimate::memory(scenario))));
        self.add("log", format!("about {} before compression", bytes(estimate::log_size(scenario))));
        let Some(steps) = estimate::steps(scenario) else { return };
        self.add("expected steps", format!("about {}", count_of(steps)));
        if let Some(seconds) = estimate::seconds(scenario) {
            self.add("expected time", format!("about {} on one core", duration(seconds)));
        }
    }

    fn warn<V: Vector>(&mut self, scenario: &Scenario<V>) {
        let mut warn = |text: String| self.warnings.push(text);
        let engine = &scenario.engine;
        let per_cell = grains_per_cell(scenario);
        let enskog = engine.kind != EngineKind::Dsmc;
        let gas = scenario.source.is_none() && scenario.gravity == V::ZERO;
        if enskog
            && engine.enskog_factor == EnskogFactor::Local
            && gas
            && scenario.count > 0
            && per_cell < 5.0
        {
            warn(format!(
                "{} grains per cell: below 5 the local Enskog factor follows noise; enlarge engine.cell_size or \
                 write enskog_factor = \"smoothed\"",
                rounded(per_cell)
            ));
        }
        let walls = scenario.boundary.walls().any(|(_, _, wall)| wall.largest_speed() > 0.0);
        let longest = scenario.grid().side().components().into_iter().fold(0.0, f64::max);
        let path = mean_free_path::<V>(scenario.grain, scenario.volume_fraction());
        if walls && scenario.count > 0 && longest > 1.1 * path {
            warn(format!(
                "cells of {} are longer than the mean free path {}: they raise the viscosity of a driven flow",
                rounded(longest),
                rounded(path)
            ));
        }
        if engine.kind == EngineKind::Dsmc && scenario.volume_fraction() > 0.1 {
            warn(format!(
                "dsmc treats grains as points: at ν = {} it collides {} times too rarely; cba and hsmc do not",
                rounded(scenario.volume_fraction()),
                rounded(V::contact_correlation(scenario.volume_fraction()))
            ));
        }
        if let Some(capacity) = scenario.capacity().filter(|&capacity| capacity < 4) {
            warn(format!(
                "a cell holds {capacity} grains only: from 4 on hsmc is sound; enlarge engine.cell_size"
            ));
        }
        self.warn_of_loss(scenario);
    }

    fn warn_of_loss<V: Vector>(&mut self, scenario: &Scenario<V>) {
        for axis in (0..V::DIMENSION).filter(|&axis| scenario.gravity[axis] != 0.0) {
            let Some(faces) = scenario.boundary.faces(axis) else { continue };
            let (side, name) = if scenario.gravity[axis] < 0.0 { (0, "lower") } else { (1, "upper") };
            if faces[side] == Face::Open {
                let axis = V::AXIS_NAMES[axis];
                self.warnings
                    .push(format!("gravity pulls grains out of the open face boundary.{axis}.{name}"));
            }
        }
        let undriven = scenario.gravity == V::ZERO && scenario.boundary.largest_wall_speed() == 0.0;
        let elastic = scenario.restitution == RestitutionLaw::Constant(Constant(1.0));
        if undriven && !elastic && matches!(scenario.engine.time_step, TimeStep::Fixed(_)) {
            self.warnings.push(
                "a fixed step suits a gas that cools badly: time_step = { collisions_per_particle = 0.1 } grows with it"
                    .to_owned(),
            );
        }
    }
}

/// Mean number of grains in a cell's volume of the domain.
fn grains_per_cell<V: Vector>(scenario: &Scenario<V>) -> f64 {
    f64::from(scenario.count) * scenario.grid().cell_volume() / scenario.size.product()
}

/// `engine.cell_size` as it stands in the text.
fn wished_cell_size<V: Vector>(scenario: &Scenario<V>) -> Option<f64> {
    let document: toml_edit::DocumentMut = scenario.source_text.parse().ok()?;
    let engine = document.get("engine")?.as_table_like()?;
    super::reader::number_of(engine.get("cell_size")?).ok()
}

fn bytes(number: f64) -> String {
    let units = [(1e12, "TB"), (1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    match units.into_iter().find(|(size, _)| number >= *size) {
        Some((size, unit)) => format!("{:.1} {unit}", number / size),
        None => format!("{number:.0} bytes"),
    }
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "a second".to_owned(),
        s if s < 120.0 => format!("{s:.0} seconds"),
        s if s < 7200.0 => format!("{:.0} minutes", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} hours", s / 3600.0),
        s => format!("{:.0} days", s / 86_400.0),
    }
}

fn count_of(number: f64) -> String {
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
        assert_eq!(fact("shear", &[], "cells "), "160 × 16 of 2.5 × 2.5 length");
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
    fn what_may_spoil_the_result_is_said() {
        assert!(!checked("shear", &["engine.kind=dsmc"]).contains("as points"));
        assert!(checked("cooling", &["engine.kind=dsmc"]).contains("as points"));
        assert!(checked("cooling", &["engine.kind=cba", "engine.cell_size=3"]).contains("below 5"));
        assert!(checked("shear", &["engine.cell_size=8"]).contains("mean free path 2.35"));
        assert!(checked("shear", &["engine.cell_size=2.6"]).contains("rounded from cell_size = 2.6"));
        assert!(checked("heap", &["boundary.y.lower=open"]).contains("boundary.y.lower"));
        assert!(!checked("heap", &[]).contains("warning"));
    }
}
