//! `pressure`: the equation of state of a periodic gas, kinetic and collisional (Miller 2004, equation 4.44).

use super::measure::{Cadence, Column, Effort, Figure, Measure, Profile, Snapshot};
use super::samples::{Samples, figure, steady_rate, steady_ratio};
use super::setting::Setting;
use super::units::{PURE, column, stress};
use crate::space::Vector;

/// P = ((N − 1) T + Σ p·s / (D Δt)) / V from the virial theorem about the centre of mass (Hansen and McDonald 2006, section
/// 2.2), the compressibility factor PV/((N − 1) T); (N − 1) T D = Σ m|v − v̄|² where nothing flows.
///
/// T is the granular temperature about the local flow u, in the bins of `local_flow`. Momentum flows
/// through a plane as Σ m v v = Σ m c c + Σ m u u, c = v − u: the first part is the kinetic pressure, the second the flux ρ u u of
/// the flow, which Euler's equations have beside the pressure, and which moves along with the gas. Where nothing flows
/// the second is zero.
///
/// Between two looks at the gas T is taken as √(T₁T₂): the exact mean of a temperature that
/// falls by Haff's law, and right to second order for any other. The figures are those of whole stretches: the pressure is
/// its mean over time, PV/NT is the ratio of the means of PV and NT.
#[derive(Clone, Debug)]
pub struct Pressure {
    /// V [lengthᴰ].
    volume: f64,
    dimension: f64,
    /// The row of the previous recording.
    previous: Option<Row>,
    samples: Samples,
}

/// First in a memory whose temperatures are about the local flow: older ones begin with 0 or 1.
const ABOUT_LOCAL_FLOW: f64 = -2.0;

/// Time, temperature, Σ p·s, grains.
type Row = [f64; 4];

/// What an interval between two rows says.
struct Interval {
    pressure: f64,
    compressibility_factor: f64,
}

impl Pressure {
    /// The measure for `setting`, if it is periodic everywhere and has no gravity.
    pub fn new<V: Vector>(setting: &Setting<V>) -> Option<Self> {
        let applies = setting.boundary.is_fully_periodic() && setting.gravity == V::ZERO;
        applies.then(|| Pressure {
            volume: setting.size.product(),
            dimension: V::DIMENSION as f64,
            previous: None,
            samples: Samples::new(3),
        })
    }

    fn interval(&self, first: &[f64], last: &[f64]) -> Interval {
        let duration = last[0] - first[0];
        let thermal = thermal(first, last);
        let collisional = (last[2] - first[2]) / (self.dimension * duration);
        Interval {
            pressure: (thermal + collisional) / self.volume,
            compressibility_factor: 1.0 + collisional / thermal,
        }
    }

    /// Time, ∫ (N − 1) T dt since the first row, and Σ p·s/D, `[row]`.
    fn integrals(&self, rows: &[&[f64]]) -> Vec<[f64; 3]> {
        let mut sum = 0.0;
        let mut integrals = Vec::with_capacity(rows.len());
        for (k, row) in rows.iter().enumerate() {
            let before = rows[k.saturating_sub(1)];
            sum += thermal(before, row) * (row[0] - before[0]);
            integrals.push([row[0], sum, row[2] / self.dimension]);
        }
        integrals
    }
}

/// (N − 1) T between two rows.
fn thermal(first: &[f64], last: &[f64]) -> f64 {
    (last[3] - 1.0) * (first[1] * last[1]).sqrt()
}

fn row<V: Vector>(snapshot: &Snapshot<'_, V>) -> Row {
    let (gas, totals) = (snapshot.gas, snapshot.totals);
    let temperature = snapshot.local_flow().temperature().unwrap_or(f64::NAN);
    [gas.time(), temperature, totals.counts.carried_momentum, gas.len() as f64]
}

impl<V: Vector> Measure<V> for Pressure {
    fn name(&self) -> &'static str {
        "pressure"
    }

    fn cadence(&self) -> Cadence {
        Cadence::Spread
    }

    fn effort(&self) -> Effort {
        Effort::Table
    }

    fn sample(&mut self, snapshot: &Snapshot<'_, V>) {
        let row = row(snapshot);
        self.samples.push(row[0], &row[1..]);
    }

    fn columns(&self) -> Vec<Column> {
        vec![column("pressure", stress::<V>()), column("compressibility_factor", PURE)]
    }

    fn values(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        let now = row(snapshot);
        match self.previous.replace(now) {
            Some(before) if before[0] < now[0] => {
                let interval = self.interval(&before, &now);
                vec![interval.pressure, interval.compressibility_factor]
            }
            _ => vec![f64::NAN; 2],
        }
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let end = row(snapshot);
        let samples = self.samples.with(end[0], &end[1..]);
        let rows = self.integrals(&samples.since(from));
        let rows: Vec<&[f64]> = rows.iter().map(|row| &row[..]).collect();
        let figures = vec![
            figure("pressure", steady_rate(&rows, |row| (row[1] + row[2]) / self.volume)),
            figure("compressibility_factor", steady_ratio(&rows, |row| row[1] + row[2], |row| row[1])),
        ];
        (Vec::new(), figures)
    }

    fn memory(&self) -> Vec<f64> {
        let mut memory = vec![ABOUT_LOCAL_FLOW];
        memory.extend(self.samples.memory_behind(self.previous));
        memory
    }

    fn recall(&mut self, memory: &[f64]) -> bool {
        let [ABOUT_LOCAL_FLOW, memory @ ..] = memory else { return false };
        self.samples.recall_behind(&mut self.previous, memory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::report::Totals;
    use crate::observe::testing::{
        State, assert_resumes, figure_of, random_positions, random_velocities, setting_of, show, smooth,
    };
    use glam::{DVec2, DVec3};

    /// Temperature 1/(1 + t/5)², and Σ p·s growing by `carried` T per time.
    fn cooling(cooling: bool, carried: f64) -> Vec<State<DVec2>> {
        let bed = setting_of(DVec2::splat(4.0), [2, 2, 1]);
        let state = |time: f64| {
            let (speed, integral) =
                if cooling { (1.0 / (1.0 + time / 5.0), time / (1.0 + time / 5.0)) } else { (1.0, time) };
            let mut totals = Totals::default();
            totals.counts.carried_momentum = carried * integral;
            let velocities = vec![DVec2::ONE * speed, -DVec2::ONE * speed];
            (bed.gas(time, vec![DVec2::ONE; 2], velocities), totals)
        };
        (0..40).map(|k| state(f64::from(k))).collect()
    }

    fn figure(states: &[State<DVec2>], name: &str) -> f64 {
        let bed = setting_of(DVec2::splat(4.0), [2, 2, 1]);
        let (value, error) = figure_of(&mut Pressure::new(&bed.setting).unwrap(), states, 20.0, name);
        assert!(error.unwrap() < 1e-12 * (1.0 + value.unwrap()) || name == "pressure");
        value.unwrap()
    }

    #[test]
    fn an_ideal_gas() {
        // (N − 1) T / V = 1 · 2 / 16.
        assert_eq!(figure(&cooling(false, 0.0), "pressure"), 0.125);
        assert_eq!(figure(&cooling(false, 0.0), "compressibility_factor"), 1.0);
        assert!((figure(&cooling(true, 0.0), "compressibility_factor") - 1.0).abs() < 1e-15);
    }

    #[test]
    fn carried_momentum_adds_to_it() {
        // (2 + 6/2) / 16, and 1 + 3/2.
        assert!((figure(&cooling(false, 6.0), "pressure") - 0.3125).abs() < 1e-13);
        assert!((figure(&cooling(false, 6.0), "compressibility_factor") - 2.5).abs() < 1e-13);
        // A gas that cools by Haff's law keeps its compressibility factor, however coarse the look.
        assert!((figure(&cooling(true, 6.0), "compressibility_factor") - 2.5).abs() < 1e-12);
    }

    #[test]
    fn the_flux_of_a_flow_is_no_pressure() {
        let size = DVec2::splat(24.0);
        let bed = setting_of(size, [24, 24, 1]);
        let states = |flow: f64| -> Vec<State<DVec2>> {
            let state = |k: u32| {
                let places = random_positions(u64::from(k), 1500, size);
                let thermal = random_velocities(100 + u64::from(k), 1500).into_iter().zip(&places);
                let wave = |y: f64| flow * (std::f64::consts::TAU * y / 24.0).sin();
                let velocities = thermal.map(|(v, x): (DVec2, &DVec2)| v + DVec2::X * wave(x.y)).collect();
                let mut totals = Totals::default();
                totals.counts.carried_momentum = 1500.0 * f64::from(k);
                (bed.gas(f64::from(k), places, velocities), totals)
            };
            (0..40).map(state).collect()
        };
        let of = |flow, name| {
            figure_of(&mut Pressure::new(&bed.setting).unwrap(), &states(flow), 0.0, name).0.unwrap()
        };
        // n T (1 + 1/D), with 1 ± 0.01 of the temperature.
        for flow in [0.0, 5.0] {
            let (pressure, factor) = (of(flow, "pressure"), of(flow, "compressibility_factor"));
            assert!((pressure * 576.0 / 1500.0 - 1.5).abs() < 0.02, "{pressure} at {flow}");
            assert!((factor - 1.5).abs() < 0.01, "{factor} at {flow}");
        }
    }

    #[test]
    fn the_series_has_the_same_values() {
        let bed = setting_of(DVec2::splat(4.0), [2, 2, 1]);
        let mut measure = Pressure::new(&bed.setting).unwrap();
        let states = cooling(false, 6.0);
        assert!(show(&mut measure, &states[0]).iter().all(|x| x.is_nan()));
        let values = show(&mut measure, &states[1]);
        for (value, expected) in values.iter().zip([0.3125, 2.5]) {
            assert!((value - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn walls_and_gravity_have_other_measures() {
        let mut bed = setting_of(DVec3::splat(4.0), [2, 2, 2]);
        assert!(Pressure::new(&bed.setting).is_some());
        bed.setting.gravity = DVec3::X;
        assert!(Pressure::new(&bed.setting).is_none());
        bed.setting.gravity = DVec3::ZERO;
        bed.walls(1, smooth(), smooth());
        assert!(Pressure::new(&bed.setting).is_none());
    }

    #[test]
    fn it_resumes() {
        let bed = setting_of(DVec3::splat(4.0), [2, 2, 2]);
        let make = || Box::new(Pressure::new(&bed.setting).unwrap()) as Box<dyn Measure<DVec3>>;
        assert_resumes(make, &bed.random_states(30, 20));
        assert_resumes(make, &bed.random_states(1, 20));
    }
}
