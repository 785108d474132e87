//! What no step may break: the number of grains, their identities, the order of cells, the capacity, the box,
//! momentum, energy.

use std::collections::BTreeSet;

use grainflow::law::boundary::{Face, WallKind};
use grainflow::matter::gas::Gas;
use grainflow::observe::moments;
use grainflow::scenario::model::{Admission, DisplacementRule, EngineKind, Scenario};
use grainflow::simulation::Simulation;
use grainflow::space::Vector;

/// What rounding may add in one step, as a share.
const ENERGY_TOLERANCE: f64 = 1e-12;
const MOMENTUM_TOLERANCE: f64 = 1e-11;

/// What of a scenario must not change, and what it was.
pub(crate) struct Laws<V> {
    /// Energy never grows: nothing moves the grains from outside.
    undriven: bool,
    /// `[axis]`: momentum stays.
    kept: [bool; 3],
    /// Occupancies of the start; `None` where rules of admission allow more than the capacity.
    starts: Option<Vec<u32>>,
    momentum: V,
    scale: f64,
    energy: f64,
    /// What rounding may add to momentum and energy between two looks, as a share.
    tolerance: [f64; 2],
}

impl<V: Vector> Laws<V> {
    /// What holds from now on.
    pub(crate) fn of(scenario: &Scenario<V>, gas: &Gas<V>) -> Self {
        let rules = scenario.engine.hsmc;
        let strict = rules.admission == Admission::Strict && rules.displacement == DisplacementRule::Paired;
        let starts = gas.offsets().windows(2).map(|ends| ends[1] - ends[0]).collect();
        Laws {
            undriven: scenario.gravity == V::ZERO && scenario.boundary.largest_wall_speed() == 0.0,
            kept: std::array::from_fn(|axis| axis < V::DIMENSION && keeps_momentum(scenario, axis)),
            starts: strict.then_some(starts),
            momentum: moments::momentum(gas),
            scale: moments::momentum_scale(gas),
            energy: energy(scenario, gas),
            tolerance: [MOMENTUM_TOLERANCE, ENERGY_TOLERANCE],
        }
    }

    /// The same for looks with very many steps between them.
    pub(crate) fn for_long(self) -> Self {
        Laws { tolerance: [1e-9, 1e-9], ..self }
    }

    /// What the step that has just been made has broken, if anything.
    pub(crate) fn check(&mut self, simulation: &Simulation<'_, V>) -> Result<(), String> {
        let (scenario, gas, totals) = (simulation.scenario(), simulation.gas(), simulation.totals());
        ordered(gas)?;
        inside(scenario, gas)?;
        let came = u64::from(scenario.count) + totals.poured;
        if gas.len() as u64 != came - totals.counts.removed || u64::from(gas.next_id()) != came {
            return Err(format!(
                "{} grains and next identity {} after {came} that came and {} that left",
                gas.len(),
                gas.next_id(),
                totals.counts.removed
            ));
        }
        self.check_capacity(simulation)?;
        self.check_moments(scenario, gas)
    }

    fn check_capacity(&self, simulation: &Simulation<'_, V>) -> Result<(), String> {
        let (Some(capacity), Some(starts)) = (simulation.capacity(), &self.starts) else { return Ok(()) };
        for (cell, &start) in starts.iter().enumerate() {
            let occupancy = simulation.gas().occupancy(cell as u32);
            if occupancy > capacity.max(start) {
                return Err(format!("{occupancy} grains in cell {cell} of capacity {capacity}"));
            }
        }
        Ok(())
    }

    fn check_moments(&mut self, scenario: &Scenario<V>, gas: &Gas<V>) -> Result<(), String> {
        // Grains that begin at rest have a scale once they move.
        self.scale = self.scale.max(moments::momentum_scale(gas));
        let drift = moments::momentum(gas) - self.momentum;
        for axis in (0..V::DIMENSION).filter(|&axis| self.kept[axis]) {
            if drift[axis].abs() > self.tolerance[0] * self.scale {
                return Err(format!("momentum along axis {axis} drifted by {:e}", drift[axis]));
            }
        }
        let now = energy(scenario, gas);
        if self.undriven && now > self.energy * (1.0 + self.tolerance[1]) {
            return Err(format!("energy rose from {:?} to {now:?}", self.energy));
        }
        self.energy = now;
        Ok(())
    }
}

/// Energy of translation and rotation [mass·length²/time²].
fn energy<V: Vector>(scenario: &Scenario<V>, gas: &Gas<V>) -> f64 {
    let inertia = scenario.roughness.map_or(0.0, |roughness| roughness.reduced_inertia);
    moments::kinetic_energy(gas) + moments::rotational_energy(gas, inertia)
}

/// Whether nothing takes or gives momentum along `axis`.
fn keeps_momentum<V: Vector>(scenario: &Scenario<V>, axis: usize) -> bool {
    let slides = |other: usize| match scenario.boundary.faces(other) {
        None => true,
        Some(faces) => faces.iter().all(|face| match face {
            Face::Open => false,
            Face::Wall(wall) => matches!(wall.kind, WallKind::Smooth | WallKind::Vibrating { .. }),
        }),
    };
    // A cure that turns velocities turns them at walls, too.
    let turned =
        scenario.engine.kind.is_event_driven() && scenario.engine.event_driven.cure.rotation.is_some();
    scenario.source.is_none()
        && (!turned || scenario.boundary.is_fully_periodic())
        && scenario.gravity[axis] == 0.0
        && scenario.boundary.is_periodic(axis)
        && (0..V::DIMENSION).all(slides)
}

/// Every grain stands in the rows of the cell of its position, every identity once.
pub(crate) fn ordered<V: Vector>(gas: &Gas<V>) -> Result<(), String> {
    let offsets = gas.offsets();
    let whole = offsets.len() == gas.grid().number_of_cells() + 1
        && offsets[0] == 0
        && offsets[offsets.len() - 1] as usize == gas.len()
        && offsets.is_sorted();
    if !whole {
        return Err("the offsets of the cells do not divide the rows".to_owned());
    }
    for cell in 0..gas.grid().number_of_cells() as u32 {
        for row in gas.rows(cell) {
            if gas.grid().cell_of(gas.positions()[row]) != cell {
                return Err(format!("the grain of row {row} is not in cell {cell}"));
            }
        }
    }
    let ids: BTreeSet<u32> = gas.ids().iter().copied().collect();
    if ids.len() != gas.len() || ids.last().is_some_and(|&id| id >= gas.next_id()) {
        return Err("an identity is there twice, or was never given".to_owned());
    }
    Ok(())
}

/// Every grain is where it may be: inside the box, below its end where that is periodic; no grain overlaps
/// another one where the engine forbids it.
fn inside<V: Vector>(scenario: &Scenario<V>, gas: &Gas<V>) -> Result<(), String> {
    let (origin, end) = (gas.grid().origin(), gas.grid().end());
    for (&position, &velocity) in gas.positions().iter().zip(gas.velocities()) {
        if !(position.is_finite() && velocity.is_finite()) {
            return Err(format!("{position:?} moves with {velocity:?}"));
        }
        for axis in 0..V::DIMENSION {
            let x = position[axis];
            let wrapped = !scenario.boundary.is_periodic(axis) || x < end[axis];
            if x < origin[axis] || x > end[axis] || !wrapped {
                return Err(format!("{position:?} is outside along axis {axis}"));
            }
        }
    }
    if scenario.engine.kind == EngineKind::EventDriven {
        let overlaps = grainflow::matter::overlaps::overlaps(gas, scenario.boundary.fixed_walls());
        if overlaps > 0 {
            return Err(format!("{overlaps} overlaps"));
        }
    }
    Ok(())
}
