//! What follows from a scenario alone.

use super::model::{AnyScenario, EngineKind, Scenario};
use crate::matter::grid::Grid;
use crate::observe::setting::Setting;
use crate::space::Vector;

impl<V: Vector> Scenario<V> {
    /// The box and its cells.
    pub fn grid(&self) -> Grid<V> {
        let periodic: [bool; 3] = std::array::from_fn(|axis| self.boundary.is_periodic(axis));
        Grid::new(self.grid_origin, self.grid_size, &self.cells, &periodic)
    }

    /// What measures may know of it.
    pub fn setting(&self) -> Setting<V> {
        Setting {
            gravity: self.gravity,
            size: self.size,
            grid: self.grid(),
            boundary: self.boundary,
            grain: self.grain,
            is_poured: self.source.is_some(),
            // To connect: the scenario's roughness, and whether its engine is the event-driven one.
            roughness: None,
            counts_impacts: false,
        }
    }

    /// The true volume fraction at the start, N V_p over the volume of `domain.size`.
    pub fn volume_fraction(&self) -> f64 {
        f64::from(self.count) * self.grain.volume::<V>() / self.size.product()
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
}
