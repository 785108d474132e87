//! What follows from a scenario alone.

use super::model::{AnyScenario, EngineKind, InitialPositions, RunLimits, Scenario};
use crate::matter::grain::Grain;
use crate::matter::grid::Grid;
use crate::observe::field::Quantity;
use crate::observe::setting::Setting;
use crate::record::contents::Walls;
use crate::space::Vector;

impl<V: Vector> Scenario<V> {
    /// The box and its cells.
    pub fn grid(&self) -> Grid<V> {
        let periodic: [bool; 3] = std::array::from_fn(|axis| self.boundary.is_periodic(axis));
        Grid::new(self.grid_origin, self.grid_size, &self.cells, &periodic)
    }

    /// The space that grains may be in and the kinds of its sides, as logs, exports and pictures have it.
    pub fn walls(&self) -> Walls {
        let grid = self.grid();
        Walls::new(&self.boundary, grid.origin(), grid.end())
    }

    /// What measures may know of it.
    pub fn setting(&self) -> Setting<V> {
        Setting {
            gravity: self.gravity,
            size: self.size,
            grid: self.grid(),
            boundary: self.boundary,
            grain: self.grain,
            species: self.species.len(),
            is_poured: self.source.is_some(),
            roughness: self.roughness,
            counts_impacts: self.engine.kind == EngineKind::EventDriven,
        }
    }

    /// Fields that are recorded: those that are named, where the engine has them.
    pub fn fields(&self) -> impl Iterator<Item = Quantity> + '_ {
        let draws_candidates = !self.engine.kind.is_event_driven();
        self.record.fields.iter().copied().filter(move |field| draws_candidates || !field.is_of_candidates())
    }

    /// The true volume fraction at the start, N V_p over the volume of `domain.size`; V_p is the mean over
    /// the species where there are several.
    pub fn volume_fraction(&self) -> f64 {
        f64::from(self.count) * self.mean_volume() / self.size.product()
    }

    /// Species with their numbers at the start; one where all grains are alike.
    pub fn constituents(&self) -> impl Iterator<Item = (Grain, u32)> + '_ {
        let alike = self.species.is_empty().then_some((self.grain, self.count));
        alike.into_iter().chain(self.species.iter().copied().zip(self.species_counts.iter().copied()))
    }

    /// Mean volume (2D: area) of a grain at the start [lengthᴰ].
    pub fn mean_volume(&self) -> f64 {
        self.mean(|grain| grain.volume::<V>())
    }

    /// Mean mass of a grain at the start [mass].
    pub fn mean_mass(&self) -> f64 {
        self.mean(|grain| grain.mass)
    }

    /// A grain of mean volume and mean mass: for estimates, not for contacts.
    pub fn mean_grain(&self) -> Grain {
        if self.species.is_empty() {
            return self.grain;
        }
        let diameter = (self.mean_volume() / V::UNIT_SPHERE_VOLUME).powf(1.0 / V::DIMENSION as f64);
        Grain { diameter, mass: self.mean_mass() }
    }

    /// Diameter of the largest grain [length].
    pub fn largest_diameter(&self) -> f64 {
        self.constituents().map(|(grain, _)| grain.diameter).fold(0.0, f64::max)
    }

    fn mean(&self, quantity: impl Fn(Grain) -> f64) -> f64 {
        if self.species.is_empty() || self.count == 0 {
            return quantity(self.grain);
        }
        let sum: f64 = self.constituents().map(|(grain, count)| f64::from(count) * quantity(grain)).sum();
        sum / f64::from(self.count)
    }

    /// Grains that fit into one cell; `None` for engines without excluded volume.
    pub fn capacity(&self) -> Option<u32> {
        let maximum = self.engine.hsmc.maximum_volume_fraction;
        (self.engine.kind == EngineKind::Hsmc).then(|| self.grid().capacity(self.grain.diameter, maximum))
    }
}

impl AnyScenario {
    /// The file's stem, or the built-in name.
    pub fn name(&self) -> &str {
        match self {
            AnyScenario::Two(scenario) => &scenario.name,
            AnyScenario::Three(scenario) => &scenario.name,
        }
    }

    /// The scenario as TOML text, with every override applied.
    pub fn source_text(&self) -> &str {
        match self {
            AnyScenario::Two(scenario) => &scenario.source_text,
            AnyScenario::Three(scenario) => &scenario.source_text,
        }
    }

    /// Which engine.
    pub fn engine(&self) -> EngineKind {
        match self {
            AnyScenario::Two(scenario) => scenario.engine.kind,
            AnyScenario::Three(scenario) => scenario.engine.kind,
        }
    }

    /// Seed of all random streams.
    pub fn seed(&self) -> u64 {
        match self {
            AnyScenario::Two(scenario) => scenario.seed,
            AnyScenario::Three(scenario) => scenario.seed,
        }
    }

    /// Diameter of a grain, of the first species where there are several [length].
    pub fn diameter(&self) -> f64 {
        match self {
            AnyScenario::Two(scenario) => scenario.grain.diameter,
            AnyScenario::Three(scenario) => scenario.grain.diameter,
        }
    }

    /// When the run ends.
    pub fn run(&self) -> RunLimits {
        match self {
            AnyScenario::Two(scenario) => scenario.run,
            AnyScenario::Three(scenario) => scenario.run,
        }
    }

    /// Where the grains are at the start.
    pub fn positions(&self) -> &InitialPositions {
        match self {
            AnyScenario::Two(scenario) => &scenario.initial.positions,
            AnyScenario::Three(scenario) => &scenario.initial.positions,
        }
    }
}
