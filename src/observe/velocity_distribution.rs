//! `velocity-distribution`: velocities beside Maxwell's, and the moments of both (Müller 2001, section 3.1).

use super::last_look::LastLook;
use super::layout;
use super::local_flow::LocalFlow;
use super::measure::{Cadence, Column, Effort, Figure, Measure, Profile, Snapshot};
use super::moments::kinetic_energy;
use super::samples::{Samples, figure, steady_mean, steady_means};
use super::setting::Setting;
use super::units::{PURE, column};
use crate::matter::gas::Gas;
use crate::space::Vector;

/// Components of so many thermal velocities are shown, to either side.
const REACH: f64 = 6.0;
/// Bins of the density.
const BINS: usize = 120;
/// Width of a bin in thermal velocities.
const WIDTH: f64 = 2.0 * REACH / BINS as f64;
/// Grains in a bin of the flow on the average; each one moves the flow of its bin, which takes 2 (1 + D)/200 of a₂ away.
const GRAINS_OF_A_BIN: f64 = 200.0;
/// A thermal velocity below this share of the speeds is their rounding.
const ROUNDING: f64 = 1e-14;
/// The figures, as series and summary name them.
const NAMES: [&str; 5] = ["temperature_anisotropy", "alpha_4", "alpha_6", "alpha_8", "sonine_a2"];

/// Components c of the velocities about the local flow u, in thermal velocities: c = (v − u) √(m/T), m the mass of the
/// grain, T about the same flow; those of all axes are taken together. The flow is that of
/// `local_flow`, in bins of 200 grains on the average over the box; of a gas of fewer than 400 grains in a
/// periodic box it is the velocity of their centre of mass. v − u is divided by √(1 − h), h the share of the grain in the
/// flow of its bin.
///
/// * `alpha_4`, `alpha_6`, `alpha_8`: ⟨c⁴⟩/3, ⟨c⁶⟩/15, ⟨c⁸⟩/105, the moments of a component (Müller 2001, 3.3)
///   over those of a Gaussian one of the same variance. σ is the gas's own, so that α₂ = ⟨c²⟩ is 1 always;
/// * `temperature_anisotropy`: ⟨c²⟩ of the axis that density profiles run along, T of that axis over T;
/// * `sonine_a2`: a₂ = D/(D + 2) ⟨|v − u|⁴⟩/⟨|v − u|²⟩² − 1 (van Noije and Ernst 1998).
///
/// In a Maxwell gas of N grains with given momentum and energy, α₄ and 1 + a₂ are M/(M + 2) on the average, with
/// M = D (N − 1), not 1: the mean and the temperature are those of the same grains. In several bins M is D Σ (N − 1 − r), r
/// the axes along which the flow has a gradient. A bin of N grains shows a share (1 − (1 + r)/N)² of the a₂ of its gas, of the
/// others' velocities being mixed into the flow: 97 % in 2D, 96 % in 3D.
#[derive(Clone, Debug)]
pub struct VelocityDistribution {
    axis: usize,
    /// `[sample][figures, probability density of each bin]`.
    samples: Samples,
    last: LastLook<Vec<f64>>,
}

/// Sums over grains of scaled velocities.
#[derive(Clone, Debug)]
struct Tally {
    /// Σ c⁴, Σ c⁶, Σ c⁸ over all axes, Σ |c|⁴.
    powers: [f64; 4],
    /// `[bin]`.
    counts: [u32; BINS],
}

impl Tally {
    fn new() -> Self {
        Tally { powers: [0.0; 4], counts: [0; BINS] }
    }

    #[inline]
    fn count<V: Vector>(&mut self, scaled: V) {
        let square = scaled.length_squared();
        self.powers[3] += square * square;
        for a in 0..V::DIMENSION {
            let second = scaled[a] * scaled[a];
            let fourth = second * second;
            self.powers[0] += fourth;
            self.powers[1] += fourth * second;
            self.powers[2] += fourth * fourth;
            let place = (scaled[a] + REACH) * (1.0 / WIDTH);
            if (0.0..BINS as f64).contains(&place) {
                self.counts[place as usize] += 1;
            }
        }
    }

    fn add(&mut self, other: &Tally) {
        self.powers.iter_mut().zip(other.powers).for_each(|(sum, part)| *sum += part);
        self.counts.iter_mut().zip(other.counts).for_each(|(sum, part)| *sum += part);
    }
}

/// What the gas shows: the figures, then the density of each bin; NaN of a gas that does not move.
fn look<V: Vector>(gas: &Gas<V>, axis: usize) -> Vec<f64> {
    let flow = LocalFlow::of(gas, GRAINS_OF_A_BIN);
    let Some(tally) = tally(gas, &flow) else { return vec![f64::NAN; NAMES.len() + BINS] };
    let grains = flow.grains() as f64;
    let dimension = V::DIMENSION as f64;
    let components = grains * dimension;
    let [fourth, sixth, eighth, fourth_of_speed] = tally.powers;
    let mut row = vec![
        flow.anisotropy(axis),
        fourth / (3.0 * components),
        sixth / (15.0 * components),
        eighth / (105.0 * components),
        fourth_of_speed / (components * (dimension + 2.0)) - 1.0,
    ];
    row.extend(tally.counts.iter().map(|&count| f64::from(count) / (components * WIDTH)));
    row
}

/// The sums over all grains, bin by bin; `None` of a gas without thermal motion.
fn tally<V: Vector>(gas: &Gas<V>, flow: &LocalFlow<V>) -> Option<Tally> {
    let temperature = flow.temperature()?;
    let rounding = ROUNDING * ROUNDING * 2.0 * kinetic_energy(gas);
    if temperature * flow.freedom() <= rounding {
        return None;
    }
    let scale = |mass: f64| (mass / temperature).sqrt();
    let alike = gas.species.is_empty().then(|| scale(gas.grain.mass));
    let (positions, velocities) = (gas.positions(), gas.velocities());
    let bins = flow.each_bin(gas, |flow, rows| {
        let mut tally = Tally::new();
        rows.for_each(|rows| {
            for row in rows {
                let mass = alike.map_or_else(|| gas.grain_at(row).mass, |_| gas.grain.mass);
                let scale = alike.unwrap_or_else(|| scale(mass));
                tally.count(flow.peculiar(mass, positions[row], velocities[row]) * scale);
            }
        });
        tally
    });
    let mut total = Tally::new();
    bins.iter().flatten().for_each(|bin| total.add(bin));
    Some(total)
}

/// Probability of each bin of a Gaussian component, over the bin's width `[bin]`.
fn maxwell() -> Vec<f64> {
    let below =
        |edge: usize| 0.5 * libm::erf((edge as f64 * WIDTH - REACH) * std::f64::consts::FRAC_1_SQRT_2);
    (0..BINS).map(|bin| (below(bin + 1) - below(bin)) / WIDTH).collect()
}

/// The table of a density and its errors `[bin]`.
fn profile(name: &str, time: f64, density: Vec<f64>, errors: Vec<f64>) -> Profile {
    let names = ["scaled_velocity", "probability_density", "standard_error", "maxwell"];
    let middles = (0..BINS).map(|bin| (bin as f64 + 0.5) * WIDTH - REACH).collect();
    Profile {
        name: name.to_owned(),
        time,
        columns: names.into_iter().map(|name| column(name, PURE)).collect(),
        values: vec![middles, density, errors, maxwell()],
    }
}

impl VelocityDistribution {
    /// The measure for `setting`; every one has it.
    pub fn new<V: Vector>(setting: &Setting<V>) -> Self {
        let samples = Samples::new(NAMES.len() + BINS);
        VelocityDistribution { axis: layout::profile_axis(setting), samples, last: LastLook::default() }
    }

    /// What the gas of `snapshot` shows.
    fn look<V: Vector>(&mut self, snapshot: &Snapshot<'_, V>) -> &[f64] {
        self.last.of(snapshot, || look(snapshot.gas, self.axis))
    }
}

impl<V: Vector> Measure<V> for VelocityDistribution {
    fn name(&self) -> &'static str {
        "velocity-distribution"
    }

    fn cadence(&self) -> Cadence {
        Cadence::Spread
    }

    fn effort(&self) -> Effort {
        Effort::Table
    }

    fn sample(&mut self, snapshot: &Snapshot<'_, V>) {
        let row = self.last.of(snapshot, || look(snapshot.gas, self.axis));
        self.samples.push(snapshot.gas.time(), row);
    }

    fn columns(&self) -> Vec<Column> {
        NAMES.into_iter().map(|name| column(name, PURE)).collect()
    }

    fn values(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        self.look(snapshot)[..NAMES.len()].to_vec()
    }

    /// The density of this moment; errors are those of independent components.
    fn profiles(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<Profile> {
        let gas = snapshot.gas;
        let density = self.look(snapshot)[NAMES.len()..].to_vec();
        let components = (gas.len() * V::DIMENSION) as f64;
        let error = |p: &f64| (p * (1.0 - p * WIDTH) / (components * WIDTH)).sqrt();
        let errors = density.iter().map(error).collect();
        vec![profile("velocity-distribution", gas.time(), density, errors)]
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let samples = self.samples.with(snapshot.gas.time(), &look(snapshot.gas, self.axis));
        let rows = samples.since(from);
        let figures =
            NAMES.iter().enumerate().map(|(k, name)| figure(name, steady_mean(&rows, |row| row[1 + k])));
        let (density, errors) = steady_means(&rows, NAMES.len()..NAMES.len() + BINS);
        let mean = profile("velocity-distribution-mean", snapshot.gas.time(), density, errors);
        (vec![mean], figures.collect())
    }

    fn memory(&self) -> Vec<f64> {
        self.samples.memory().to_vec()
    }

    fn recall(&mut self, memory: &[f64]) -> bool {
        self.samples.recall(memory)
    }
}

#[cfg(test)]
#[path = "velocity_distribution_tests.rs"]
mod tests;
