//! `structure-factor`: S(k), the power of density waves (Müller 2001, section 3.2.1).

use std::f64::consts::PI;

use super::density_waves::DensityWaves;
use super::measure::{Figure, Measure, Profile, Snapshot};
use super::samples::{Samples, steady_means};
use super::setting::Setting;
use super::units::{PURE, WAVENUMBER, column};
use crate::matter::gas::Gas;
use crate::space::Vector;

/// Grid points of the longest side at most, and with them the shells: a quarter as many.
const LONGEST: usize = 2048;
/// Grid points in all at most.
const POINTS: usize = 1 << 22;
/// Grid points of a side with waves at least.
const FEWEST: usize = 8;

/// S(k) = |Σ_j exp(−i k·x_j)|²/N of all grains, averaged over shells of |k| as wide as the lowest wavenumber of
/// the longest periodic side; 1 for independent grains, and as k → 0 T (∂ρ/∂p)_T of a fluid in equilibrium.
///
/// Waves run along periodic axes; k has no component along others. As in Müller's thesis the power of two is
/// taken that gives a lattice box of about one diameter, and waves are followed up to its Nyquist wavenumber π/d.
/// But his lattice alone would smear the positions, S would be off by what the smearing does and by aliases;
/// here a lattice twice as fine and splines give the amplitudes of the true positions (`observe::density_waves`).
/// Of large boxes only long waves are followed: at most 512 shells and 2²² grid points, some tenths of a second.
///
/// Errors of one moment are those of waves that are independent and of Gaussian amplitude, where k and −k are one:
/// S √(2/n) of the n waves of a shell. Averages are taken over recordings.
#[derive(Clone, Debug)]
pub struct StructureFactor<V> {
    waves: DensityWaves<V>,
    /// `[wave]`: where it belongs, if it is in a shell.
    members: Vec<Option<Member>>,
    /// `[shell]`.
    shells: Vec<Shell>,
    /// `[sample][S of each shell]`.
    samples: Samples,
}

/// A wave of a shell.
#[derive(Clone, Copy, Debug)]
struct Member {
    shell: u32,
    /// Waves that it stands for.
    number: f32,
}

/// Waves of about one length.
#[derive(Clone, Copy, Debug, Default)]
struct Shell {
    /// Number of waves.
    waves: f64,
    /// Mean |k| [1/length].
    wavenumber: f64,
}

/// Grid points along each axis: one without waves, else powers of two half a diameter apart, coarser in large boxes.
fn grid_points<V: Vector>(setting: &Setting<V>) -> [usize; 3] {
    let size = setting.grid.size();
    let is_wavy = |axis: usize| axis < V::DIMENSION && setting.boundary.is_periodic(axis);
    let spacing = |axis: usize, points: usize| size[axis] / points as f64;
    let mut points = std::array::from_fn(|axis| {
        if !is_wavy(axis) {
            return 1;
        }
        let boxes = (size[axis] / setting.grain.diameter).log2().round();
        (2.0 * boxes.exp2()).clamp(FEWEST as f64, LONGEST as f64) as usize
    });
    while points.iter().product::<usize>() > POINTS {
        let finest = (0..V::DIMENSION)
            .filter(|&axis| points[axis] > FEWEST)
            .min_by(|&a, &b| spacing(a, points[a]).total_cmp(&spacing(b, points[b])));
        match finest {
            Some(axis) => points[axis] /= 2,
            None => break,
        }
    }
    points
}

impl<V: Vector> StructureFactor<V> {
    /// The measure for `setting`, if it has a periodic axis.
    pub fn new(setting: &Setting<V>) -> Option<Self> {
        let size = setting.grid.size();
        let wavy: Vec<usize> = (0..V::DIMENSION).filter(|&axis| setting.boundary.is_periodic(axis)).collect();
        let waves = DensityWaves::new(setting.grid.origin(), size, grid_points(setting));
        let lowest = |axis: usize| 2.0 * PI / size[axis];
        let width = wavy.iter().map(|&axis| lowest(axis)).min_by(f64::total_cmp)?;
        // Shells are complete up to the shortest wave along every axis.
        let highest = wavy.iter().map(|&axis| lowest(axis) * waves.highest(axis) as f64);
        let highest = highest.min_by(f64::total_cmp)? * (1.0 + 1e-12);
        let mut shells = vec![Shell::default(); (highest / width) as usize];
        let mut members = Vec::new();
        for wave in waves.waves() {
            let wavenumber = wave.vector.length();
            let number = (wavenumber / width).round() as usize;
            let is_inside = wavenumber <= highest && (1..=shells.len()).contains(&number);
            members.push(is_inside.then(|| Member { shell: number as u32 - 1, number: wave.number as f32 }));
            if is_inside {
                shells[number - 1].waves += wave.number;
                shells[number - 1].wavenumber += wave.number * wavenumber;
            }
        }
        shells.iter_mut().for_each(|shell| shell.wavenumber /= shell.waves);
        let samples = Samples::new(shells.len());
        Some(StructureFactor { waves, members, shells, samples })
    }

    /// S of each shell `[shell]`; NaN without grains.
    fn look(&self, gas: &Gas<V>) -> Vec<f64> {
        if gas.is_empty() {
            return vec![f64::NAN; self.shells.len()];
        }
        let mut sums = vec![0.0; self.shells.len()];
        for (power, member) in self.waves.powers(gas.positions()).into_iter().zip(&self.members) {
            if let Some(Member { shell, number }) = *member {
                sums[shell as usize] += f64::from(number) * power;
            }
        }
        sums.iter().zip(&self.shells).map(|(sum, shell)| sum / (shell.waves * gas.len() as f64)).collect()
    }

    fn profile(&self, name: &str, time: f64, values: Vec<f64>, errors: Vec<f64>) -> Profile {
        Profile {
            name: name.to_owned(),
            time,
            columns: vec![
                column("wavenumber", WAVENUMBER),
                column("structure_factor", PURE),
                column("standard_error", PURE),
            ],
            values: vec![self.shells.iter().map(|shell| shell.wavenumber).collect(), values, errors],
        }
    }
}

impl<V: Vector> Measure<V> for StructureFactor<V> {
    fn name(&self) -> &'static str {
        "structure-factor"
    }

    fn is_costly(&self) -> bool {
        true
    }

    fn profiles(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<Profile> {
        let time = snapshot.gas.time();
        let values = self.look(snapshot.gas);
        self.samples.push(time, &values);
        let error = |(value, shell): (&f64, &Shell)| value * (2.0 / shell.waves).sqrt();
        let errors = values.iter().zip(&self.shells).map(error).collect();
        vec![self.profile("structure-factor", time, values, errors)]
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let (values, errors) = steady_means(&self.samples.since(from), 0..self.shells.len());
        (vec![self.profile("structure-factor-mean", snapshot.gas.time(), values, errors)], Vec::new())
    }

    fn memory(&self) -> Vec<f64> {
        self.samples.memory().to_vec()
    }

    fn recall(&mut self, memory: &[f64]) -> bool {
        self.samples.recall(memory)
    }
}

#[cfg(test)]
#[path = "structure_factor_tests.rs"]
mod tests;
