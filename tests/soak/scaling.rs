//! Nothing in an engine knows a length, a mass or a time of its own: the same scenario, counted in other units that
//! are powers of two, gives the same trajectory to the bit, but for the exponents.

use grainflow::engine::{Horizon, NoLaps};
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::scenario::{Overrides, initial, parse};
use grainflow::simulation::Simulation;
use grainflow::space::Vector;

use super::draw::{Units, scenario_text};

/// What the grains came to, counted in `units`.
#[derive(Debug, PartialEq)]
pub(crate) struct Trajectory {
    failed: bool,
    time: u64,
    counts: [u64; 5],
    ids: Vec<u32>,
    /// Bits of positions, velocities and spins.
    numbers: Vec<u64>,
}

/// The scenario number `seed`, which is `scenario`, in units of its own and in others.
pub(crate) fn check_units<V: Vector>(seed: u64, scenario: &Scenario<V>) -> Result<(), String> {
    let units = Units::drawn(seed);
    let text = scenario_text(seed, units);
    let other =
        parse("scaled", &text, &Overrides::default()).map_err(|error| format!("{units:?}: {error}"))?;
    let expected = trajectory(scenario, Units::ONE)?;
    let found = match &other {
        AnyScenario::Two(scenario) => trajectory(scenario, units)?,
        AnyScenario::Three(scenario) => trajectory(scenario, units)?,
    };
    expected.compare(&found).map_err(|problem| format!("in {units:?}: {problem}"))
}

/// The end of the run, in units of one.
pub(crate) fn trajectory<V: Vector>(scenario: &Scenario<V>, units: Units) -> Result<Trajectory, String> {
    let gas = initial::build(scenario, None).map_err(|error| error.to_string())?;
    let Ok(mut simulation) = Simulation::start(scenario, gas, &mut NoLaps) else {
        return Ok(Trajectory { failed: true, time: 0, counts: [0; 5], ids: vec![], numbers: vec![] });
    };
    let mut failed = false;
    while !failed && simulation.end_reason().is_none() {
        failed = simulation.advance(&mut NoLaps, Horizon::NONE).is_err();
    }
    let (gas, totals) = (simulation.gas(), simulation.totals());
    let bits = |vectors: &[V], unit: f64| -> Vec<u64> {
        let components =
            |vector: &V| (0..V::DIMENSION).map(|axis| (vector[axis] / unit).to_bits()).collect::<Vec<_>>();
        vectors.iter().flat_map(components).collect()
    };
    let mut numbers = bits(gas.positions(), units.length);
    numbers.extend(bits(gas.velocities(), units.speed()));
    let spins = gas.columns().spins.iter().flatten();
    numbers.extend(spins.flat_map(|spin| spin.as_ref().to_vec()).map(|spin| (spin * units.time).to_bits()));
    let counts = &totals.counts;
    Ok(Trajectory {
        failed,
        time: (gas.time() / units.time).to_bits(),
        counts: [totals.steps, counts.collisions, counts.cell_collisions, counts.removed, totals.poured],
        ids: gas.ids().to_vec(),
        numbers,
    })
}

impl Trajectory {
    pub(crate) fn compare(&self, other: &Self) -> Result<(), String> {
        let times = (f64::from_bits(self.time), f64::from_bits(other.time));
        if (self.failed, self.time, self.counts) != (other.failed, other.time, other.counts) {
            return Err(format!(
                "{:?} at {times:?} and {:?}",
                (self.failed, self.counts),
                (other.failed, other.counts)
            ));
        }
        if self.ids != other.ids {
            return Err("the grains are in another order".to_owned());
        }
        let differing =
            self.numbers.iter().zip(&other.numbers).filter(|(mine, theirs)| mine != theirs).count();
        if differing > 0 || self.numbers.len() != other.numbers.len() {
            return Err(format!("{differing} of {} numbers are other ones", self.numbers.len()));
        }
        Ok(())
    }
}
