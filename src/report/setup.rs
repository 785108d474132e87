//! What a report needs to know about the run beside its measures: from the scenario in its log, and the summary.

use serde_json::{Map, Value};

use super::plain_text::PlainText;
use super::unit::unit;
use crate::comparison::laws;
use crate::law::restitution::{Constant, RestitutionLaw};
use crate::observe::layout;
use crate::observe::measure::{Column, Dimension};
use crate::record::contents::{RunLog, Walls};
use crate::scenario::kinds::Kinds;
use crate::scenario::model::{AnyScenario, EngineKind, Scenario};
use crate::scenario::{Overrides, parse};
use crate::space::Vector;

/// The parameters that plots, laws and references depend on; `None` where the scenario does not have them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Setup {
    /// Title of the scenario, or its name.
    pub title: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the engine.
    pub engine: String,
    /// 2 or 3.
    pub dimension: usize,
    /// Sides of the box [length].
    pub size: Vec<f64>,
    /// Constant acceleration [length/time²].
    pub gravity: Vec<f64>,
    /// Diameter of a grain, of the first kind where there are several [length].
    pub diameter: f64,
    /// Sizes of the grains, and which grain is of which kind.
    pub kinds: Kinds,
    /// N·V_p over the volume of the box.
    pub volume_fraction: Option<f64>,
    /// Whether every axis is periodic.
    pub is_periodic: bool,
    /// `[axis]`: whether that axis is periodic.
    pub periodic_axes: [bool; 3],
    /// Whether a side is open, so that grains can leave.
    pub has_open_side: bool,
    /// Grains at the start.
    pub count: Option<f64>,
    /// Names of the units of length, mass and time.
    pub units: [String; 3],
    /// What a checked scenario says beside this; `None` where that in the log cannot be read.
    pub known: Option<Known>,
    /// Why it cannot be read.
    pub unreadable: Option<String>,
}

/// What only a checked scenario tells.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Known {
    /// The scenario, for laws of theory.
    pub scenario: AnyScenario,
    /// Constant normal restitution; `None` for another law.
    pub restitution: Option<f64>,
    /// Mass of a grain, of the first kind where there are several [mass].
    pub mass: f64,
    /// Kinds of grains.
    pub species: usize,
    /// Whether grains spin.
    pub is_rough: bool,
    /// Sides of a cell [length].
    pub cell: Vec<f64>,
    /// Walls that move past each other.
    pub shear: Option<Shear>,
    /// Whether a wall moves.
    pub has_moving_wall: bool,
    /// Grains that the source pours, and how many per time.
    pub source: Option<[f64; 2]>,
}

/// Walls that move past each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shear {
    /// Velocity of the lower wall along the direction of shear [length/time].
    pub lower: f64,
    /// Velocity of the upper wall relative to it [length/time].
    pub speed: f64,
    /// Between the walls [length].
    pub height: f64,
    /// Whether nothing else drives the grains, so that a straight line from wall to wall is expected.
    pub is_alone: bool,
}

impl Known {
    fn of(scenario: AnyScenario) -> Self {
        match &scenario {
            AnyScenario::Two(checked) => Self::read(checked, scenario.clone()),
            AnyScenario::Three(checked) => Self::read(checked, scenario.clone()),
        }
    }

    fn read<V: Vector>(checked: &Scenario<V>, scenario: AnyScenario) -> Self {
        let restitution = match checked.restitution {
            RestitutionLaw::Constant(Constant(restitution)) => Some(restitution),
            _ => None,
        };
        let is_alone = laws::Laws::of(checked).shear().is_some();
        let shear = layout::shear(&checked.setting()).map(|shear| Shear {
            lower: shear.lower,
            speed: shear.speed,
            height: checked.size[shear.axis],
            is_alone,
        });
        let sides = checked.grid_size.components().into_iter().zip(checked.cells);
        Known {
            restitution,
            mass: checked.grain.mass,
            species: checked.species.len().max(1),
            is_rough: checked.roughness.is_some(),
            cell: sides.map(|(side, cells)| side / f64::from(cells)).collect(),
            shear,
            has_moving_wall: checked.boundary.largest_wall_speed() > 0.0,
            source: checked.source.as_ref().map(|source| [f64::from(source.count), source.rate]),
            scenario,
        }
    }

    /// Whether cells have sides of `diameters` of a grain, to 2.5 %.
    pub(crate) fn has_cells_of(&self, diameters: f64) -> bool {
        let expected = diameters * self.scenario.diameter();
        !self.scenario.engine().is_event_driven()
            && self.cell.iter().all(|side| (side / expected - 1.0).abs() < 0.025)
    }

    /// Whether grains are smooth, of one kind and of this constant restitution.
    pub(crate) fn is_plain(&self, restitution: f64) -> bool {
        let is_it = self.restitution.is_some_and(|r| (r - restitution).abs() < 1e-9);
        is_it && self.species == 1 && !self.is_rough
    }

    /// Whether it runs with `engine`.
    pub(crate) fn runs_with(&self, engine: EngineKind) -> bool {
        self.scenario.engine() == engine
    }
}

impl Setup {
    /// The parameters of `log`, with `summary` first where both have one.
    pub(crate) fn of(log: &RunLog, summary: &Map<String, Value>) -> Self {
        let text = |key: &str| {
            let known = summary.get(key).and_then(Value::as_str).map(str::to_owned);
            known.or_else(|| log.metadata.get(key).cloned())
        };
        let name = text("scenario").unwrap_or_else(|| "run".to_owned());
        let mut setup = match parse(&name, &log.scenario, &Overrides::default()) {
            Ok(AnyScenario::Two(scenario)) => Self::checked(&scenario, log, AnyScenario::Two),
            Ok(AnyScenario::Three(scenario)) => Self::checked(&scenario, log, AnyScenario::Three),
            Err(error) => Self::unchecked(&name, log, &error.to_string()),
        };
        let figure = |key: &str| summary.get(key).and_then(Value::as_f64);
        if let Some(engine) = text("engine") {
            setup.engine = engine;
        }
        if let Some(dimension) = figure("dimension") {
            setup.dimension = dimension as usize;
        }
        if setup.known.is_some() {
            setup.volume_fraction = figure("volume_fraction").or(setup.volume_fraction);
        }
        setup.count = figure("particles_initial").or(setup.count);
        setup.scenario = name;
        if let Some(walls) = &log.walls {
            setup.see_walls(walls);
        }
        setup
    }

    /// From a checked scenario.
    fn checked<V: Vector>(
        scenario: &Scenario<V>,
        log: &RunLog,
        any: impl Fn(Scenario<V>) -> AnyScenario,
    ) -> Self {
        let units = [&scenario.units.length, &scenario.units.mass, &scenario.units.time];
        let mut setup = Self {
            title: scenario.title.clone(),
            engine: scenario.engine.kind.name().to_owned(),
            dimension: V::DIMENSION,
            size: scenario.size.components(),
            gravity: scenario.gravity.components(),
            diameter: scenario.grain.diameter,
            kinds: Kinds::new(scenario, log.species.clone()),
            volume_fraction: Some(scenario.volume_fraction()),
            count: Some(f64::from(scenario.count)),
            units: units.map(|name| if name == "1" { String::new() } else { name.clone() }),
            known: Some(Known::of(any(scenario.clone()))),
            ..Self::nothing()
        };
        setup.see_walls(&scenario.walls());
        setup
    }

    /// From the text of a scenario that this version does not take: what pictures need, and no more.
    fn unchecked(name: &str, log: &RunLog, reason: &str) -> Self {
        let text = PlainText::of(&log.scenario);
        Self {
            title: text.title.unwrap_or_else(|| name.to_owned()),
            engine: text.engine.unwrap_or_else(|| "unknown engine".to_owned()),
            dimension: text.dimension.unwrap_or(2),
            size: text.size,
            gravity: text.gravity,
            diameter: text.diameter,
            kinds: Kinds::of_diameter(text.diameter),
            units: text.units,
            unreadable: Some(if log.scenario.is_empty() {
                "it is not there".to_owned()
            } else {
                reason.to_owned()
            }),
            ..Self::nothing()
        }
    }

    fn nothing() -> Self {
        Self {
            title: String::new(),
            scenario: String::new(),
            engine: String::new(),
            dimension: 2,
            size: Vec::new(),
            gravity: Vec::new(),
            diameter: 1.0,
            kinds: Kinds::of_diameter(1.0),
            volume_fraction: None,
            is_periodic: false,
            periodic_axes: [false; 3],
            has_open_side: false,
            count: None,
            units: ["length", "mass", "time"].map(str::to_owned),
            known: None,
            unreadable: None,
        }
    }

    /// What the sides of the box are.
    fn see_walls(&mut self, walls: &Walls) {
        let mut sides = walls.sides.iter().flatten();
        self.is_periodic = sides.clone().all(|side| side.is_empty() || side == "periodic");
        self.has_open_side = sides.any(|side| side == "open");
        self.periodic_axes =
            std::array::from_fn(|axis| walls.sides[axis].iter().all(|side| side == "periodic"));
    }

    /// Grains that the source pours, and how many per time.
    pub(crate) fn source(&self) -> Option<[f64; 2]> {
        self.known.as_ref()?.source
    }

    /// Walls that move past each other.
    pub(crate) fn shear(&self) -> Option<Shear> {
        self.known.as_ref()?.shear
    }

    /// Whether a constant force acts.
    pub(crate) fn has_gravity(&self) -> bool {
        self.gravity.iter().any(|g| *g != 0.0)
    }

    /// The axis along which a constant force acts, if it acts along one alone.
    pub(crate) fn gravity_axis(&self) -> Option<usize> {
        let mut axes = (0..self.gravity.len()).filter(|axis| self.gravity[*axis] != 0.0);
        axes.next().filter(|_| axes.next().is_none())
    }

    /// Whether grains fall without end: a force along a periodic axis.
    pub(crate) fn is_pipe(&self) -> bool {
        self.gravity_axis().is_some_and(|axis| self.periodic_axes.get(axis) == Some(&true))
    }

    /// Whether grains come to lie on something.
    pub(crate) fn has_floor(&self) -> bool {
        self.gravity_axis().is_some() && !self.is_pipe()
    }

    /// Whether nothing drives the gas, so that it ages by its collisions; not where nobody knows.
    pub(crate) fn is_undriven(&self) -> bool {
        let is_still = |known: &Known| known.source.is_none() && !known.has_moving_wall;
        !self.has_gravity() && self.known.as_ref().is_some_and(is_still)
    }

    /// The unit of a quantity in the names of the scenario.
    pub(crate) fn unit(&self, dimension: Dimension) -> String {
        unit(dimension, &self.units)
    }

    /// "name [unit]" of a column.
    pub(crate) fn label(&self, column: &Column) -> String {
        self.with_unit(&crate::number::in_words(&column.name), column.unit)
    }

    /// "name [unit]".
    pub(crate) fn with_unit(&self, name: &str, dimension: Dimension) -> String {
        let unit = self.unit(dimension);
        // "time [time]" says nothing.
        if unit.is_empty() || unit == name { name.to_owned() } else { format!("{name} [{unit}]") }
    }

    /// The unit of length (0), mass (1) or time (2) behind a number: one without a name is called a unit.
    pub(crate) fn named(&self, kind: usize) -> String {
        let kinds = ["length", "mass", "time"];
        if self.units[kind] == kinds[kind] {
            format!("{} units", kinds[kind])
        } else {
            self.units[kind].clone()
        }
    }

    /// The label of a time axis.
    pub(crate) fn time_label(&self) -> String {
        self.with_unit("time", Dimension { time: 1, ..Dimension::default() })
    }

    /// The label of a length.
    pub(crate) fn length_label(&self, name: &str) -> String {
        self.with_unit(name, Dimension { length: 1, ..Dimension::default() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAS: &str = "dimension = 3\n[domain]\nsize = [20, 20.5, 30]\n[particles]\ncount = 100\n\
                       diameter = 2\nmass = 3\nrestitution = 0.9\n[engine]\nkind = \"cba\"\n[initial]\nvelocities = { maxwell = 1.0 }\n[run]\ntime = 1.0\n";

    fn setup(text: &str) -> Setup {
        Setup::of(&RunLog { scenario: text.to_owned(), ..RunLog::default() }, &Map::new())
    }

    #[test]
    fn parameters_are_those_of_the_scenario() {
        let walls = "[boundary]\nx.lower = { wall = \"rough\", velocity = [0, 0, -0.5] }\n\
                     x.upper = { wall = \"rough\", velocity = [0, 0, 0.5] }\n[units]\nlength = \"d\"\n";
        let sheared = setup(&format!("{GAS}{walls}"));
        assert_eq!(sheared.unreadable, None);
        assert_eq!(sheared.size, [20.0, 20.5, 30.0]);
        let shear = sheared.shear().unwrap();
        assert_eq!((shear.speed, shear.height, shear.is_alone), (1.0, 20.0, true));
        assert_eq!((sheared.diameter, sheared.known.as_ref().unwrap().restitution), (2.0, Some(0.9)));
        assert!(!sheared.is_periodic && !sheared.has_gravity() && !sheared.is_undriven());
        assert_eq!(sheared.length_label("height"), "height [d]");
        let falling = setup(&format!("gravity = [0, 0, -1]\n{GAS}{walls}"));
        assert!(falling.shear().is_some_and(|shear| !shear.is_alone));
    }

    #[test]
    fn a_shaken_box_is_driven() {
        let free = setup(&format!("{GAS}[boundary]\nx = \"periodic\"\ny = \"periodic\"\nz = \"periodic\"\n"));
        assert!(free.is_undriven() && free.is_periodic, "{:?}", free.unreadable);
        let still = format!(
            "{GAS}[boundary]\nz.lower = {{ wall = \"smooth\" }}\nz.upper = {{ wall = \"smooth\" }}\n"
        );
        assert!(setup(&still).is_undriven());
        let shaken =
            still.replacen("wall = \"smooth\"", "wall = \"vibrating\", amplitude = 0.1, frequency = 1.0", 1);
        let shaken = setup(&shaken);
        assert!(shaken.unreadable.is_none() && !shaken.is_undriven(), "{:?}", shaken.unreadable);
    }

    #[test]
    fn a_text_of_another_version_says_less() {
        let newer = setup(&format!("{GAS}[engine.quantum]\nspin = 1\n"));
        assert!(newer.unreadable.as_ref().unwrap().contains("quantum"), "{newer:?}");
        assert_eq!((newer.diameter, newer.volume_fraction), (2.0, None));
        assert!(newer.known.is_none() && !newer.is_undriven());
        let broken = setup("= [");
        assert_eq!((broken.title.as_str(), broken.known), ("run", None));
    }
}
