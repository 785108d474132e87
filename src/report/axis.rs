//! Axes: how values become places, and where the ticks go.

use crate::number::{number, power_of_ten};

/// How an axis is scaled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scale {
    /// Even steps.
    Linear,
    /// Even factors; values must be positive.
    Logarithmic,
}

impl Scale {
    /// Of an energy, a temperature, a power: logarithmic when all values after the first twentieth of the points are
    /// positive and span more than one and a half decades.
    pub(super) fn of_energy(points: &[[f64; 2]]) -> Self {
        let settled = &points[points.len() / 20..];
        let (least, most) = range(settled.iter().map(|p| p[1]).filter(|v| v.is_finite()));
        let spans = least > 0.0 && most > least * 10f64.powf(1.5);
        if spans { Self::Logarithmic } else { Self::Linear }
    }
}

/// An axis with its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    /// Lower end.
    pub lower: f64,
    /// Upper end.
    pub upper: f64,
    /// Whether places go by the logarithm.
    pub logarithmic: bool,
}

/// A tick: where, and its label, empty for a minor one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// Value.
    pub value: f64,
    /// Text beside it.
    pub label: String,
}

impl Axis {
    /// An axis that holds `values`; `exact` keeps their range as it is, else it ends a little beyond them.
    pub(super) fn over(values: impl Iterator<Item = f64> + Clone, scale: Scale, exact: bool) -> Self {
        let finite = values.filter(|v| v.is_finite());
        let positive = finite.clone().filter(|v| *v > 0.0);
        let (least, most) = range(positive);
        let logarithmic = match scale {
            Scale::Linear => false,
            Scale::Logarithmic => least < most,
        };
        if logarithmic {
            let room = if exact { 1.0 } else { (most / least).powf(0.04) };
            return Self { lower: least / room, upper: most * room, logarithmic };
        }
        let (mut lower, mut upper) = range(finite);
        if lower > upper {
            (lower, upper) = (0.0, 1.0);
        }
        let size = lower.abs().max(upper.abs());
        if upper - lower <= 1e-9 * size || upper == lower {
            let room = if size > 0.0 { 0.1 * size } else { 1.0 };
            return Self { lower: lower - room, upper: upper + room, logarithmic };
        }
        if !exact {
            let room = 0.06 * (upper - lower);
            // A quantity that cannot be negative keeps its zero when that is near.
            let near_zero = lower >= 0.0 && lower < 0.35 * upper;
            lower = if near_zero { 0.0 } else { lower - room };
            upper += room;
        }
        Self { lower, upper, logarithmic }
    }

    /// Where `value` lies, 0 at the lower and 1 at the upper end.
    pub(super) fn share(&self, value: f64) -> f64 {
        if self.logarithmic {
            (value / self.lower).ln() / (self.upper / self.lower).ln()
        } else {
            (value - self.lower) / (self.upper - self.lower)
        }
    }

    /// Ticks, about `wanted` of them labelled.
    pub(super) fn ticks(&self, wanted: usize) -> Vec<Tick> {
        if self.logarithmic { self.logarithmic_ticks(wanted) } else { self.linear_ticks(wanted) }
    }

    fn linear_ticks(&self, wanted: usize) -> Vec<Tick> {
        let step = round_step((self.upper - self.lower) / wanted.max(1) as f64);
        let first = (self.lower / step - 1e-9).ceil() as i64;
        let last = (self.upper / step + 1e-9).floor() as i64;
        let largest = self.lower.abs().max(self.upper.abs());
        let digits = ((largest / step).log10().floor() as i32 + 2).clamp(2, 9) as usize;
        (first..=last)
            .map(|k| {
                let value = k as f64 * step;
                // As many digits as set neighbours apart; trailing zeros are dropped by `number`.
                let own = if k == 0 { 1 } else { significant(value, step).min(digits) };
                Tick { value, label: number(value, own) }
            })
            .collect()
    }

    fn logarithmic_ticks(&self, wanted: usize) -> Vec<Tick> {
        let first = self.lower.log10().floor() as i32;
        let last = self.upper.log10().ceil() as i32;
        let decades = (self.upper / self.lower).log10();
        let every = ((decades / wanted.max(1) as f64).ceil() as i32).max(1);
        let labelled: &[i32] = match decades {
            d if d < 1.2 => &[1, 2, 3, 5],
            d if d < 2.2 => &[1, 3],
            _ => &[1],
        };
        let mut ticks = Vec::new();
        for decade in first..=last {
            for factor in 1..10 {
                let value = f64::from(factor) * 10f64.powi(decade);
                if value < self.lower * (1.0 - 1e-9) || value > self.upper * (1.0 + 1e-9) {
                    continue;
                }
                if factor > 1 && decades > 9.0 {
                    continue;
                }
                let is_labelled = labelled.contains(&factor) && decade.rem_euclid(every) == 0;
                let label = match is_labelled {
                    false => String::new(),
                    true if factor == 1 && !(-2..4).contains(&decade) => power_of_ten(decade),
                    true => number(value, 1),
                };
                ticks.push(Tick { value, label });
            }
        }
        ticks
    }
}

/// Least and most; the wrong way round when there is nothing.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), v| (least.min(v), most.max(v)))
}

/// The nearest of 1, 2, 2.5, 5 times a power of ten that is not below `rough`.
fn round_step(rough: f64) -> f64 {
    let power = 10f64.powf(rough.log10().floor());
    let factor = [1.0, 2.0, 2.5, 5.0].into_iter().find(|f| f * power >= rough * 0.999).unwrap_or(10.0);
    factor * power
}

/// Significant digits that show `value` down to the place of `step` and one below.
fn significant(value: f64, step: f64) -> usize {
    (value.abs().log10().floor() - step.log10().floor() + 2.0).clamp(1.0, 12.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: Axis, wanted: usize) -> Vec<String> {
        axis.ticks(wanted).into_iter().map(|t| t.label).filter(|l| !l.is_empty()).collect()
    }

    #[test]
    fn linear_ticks_are_round() {
        let axis = Axis { lower: -0.5, upper: 0.5, logarithmic: false };
        assert_eq!(labels(axis, 5), ["−0.4", "−0.2", "0", "0.2", "0.4"]);
        let axis = Axis { lower: 1000.0, upper: 1001.0, logarithmic: false };
        assert_eq!(labels(axis, 2), ["1000", "1000.5", "1001"]);
    }

    #[test]
    fn logarithmic_ticks_are_decades() {
        let axis = Axis { lower: 1e-6, upper: 1e2, logarithmic: true };
        assert_eq!(labels(axis, 4), ["10⁻⁶", "10⁻⁴", "0.01", "1", "100"]);
        assert!(axis.ticks(4).len() > 60);
    }

    #[test]
    fn the_scale_of_energies_follows_the_span() {
        let of = |values: &[f64]| Scale::of_energy(&values.iter().map(|v| [0.0, *v]).collect::<Vec<_>>());
        assert_eq!(of(&[1.0, 100.0]), Scale::Logarithmic);
        assert_eq!(of(&[1.0, 10.0]), Scale::Linear);
        assert_eq!(of(&[0.0, 100.0]), Scale::Linear);
        // A start that is forgotten at once does not count.
        let mut values = [1.0; 40];
        values[0] = 1e-16;
        assert_eq!(of(&values), Scale::Linear);
    }

    #[test]
    fn empty_and_constant_data_have_an_axis() {
        for values in [&[][..], &[f64::NAN], &[3.0, 3.0], &[0.0]] {
            let axis = Axis::over(values.iter().copied(), Scale::Linear, false);
            assert!(axis.upper > axis.lower && !axis.ticks(5).is_empty());
        }
    }
}
