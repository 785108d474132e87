//! Rows of numbers taken at rising times, and steady figures from them.

use std::ops::Range;

use super::measure::Figure;
use crate::statistics::SteadyEstimate;

/// Samples of a fixed number of values; each row begins with its time.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Samples {
    width: usize,
    /// `[sample][time, value …]`, flat.
    flat: Vec<f64>,
}

impl Samples {
    /// No samples yet, of `values` values each.
    pub(crate) fn new(values: usize) -> Self {
        Samples { width: values + 1, flat: Vec::new() }
    }

    /// Adds a row, unless the last one is as late: no time counts twice.
    pub(crate) fn push(&mut self, time: f64, values: &[f64]) {
        debug_assert_eq!(values.len() + 1, self.width);
        let is_later = self.flat.rchunks_exact(self.width).next().is_none_or(|last| last[0] < time);
        if is_later {
            self.flat.push(time);
            self.flat.extend_from_slice(values);
        }
    }

    /// The same samples and one more.
    pub(crate) fn with(&self, time: f64, values: &[f64]) -> Self {
        let mut all = self.clone();
        all.push(time, values);
        all
    }

    /// Rows at times from `from` on.
    pub(crate) fn since(&self, from: f64) -> Vec<&[f64]> {
        self.flat.chunks_exact(self.width).filter(|row| row[0] >= from).collect()
    }

    /// Everything, as numbers to be saved.
    pub(crate) fn memory(&self) -> &[f64] {
        &self.flat
    }

    /// The same behind a row that somebody saw last; the first number says whether there is one.
    pub(crate) fn memory_behind<const N: usize>(&self, last: Option<[f64; N]>) -> Vec<f64> {
        let row = last.map_or(Vec::new(), |row| row.to_vec());
        [&[f64::from(u8::from(last.is_some()))], &row[..], self.memory()].concat()
    }

    /// Takes over what [`Samples::memory_behind`] gave, and tells whether it is that.
    pub(crate) fn recall_behind<const N: usize>(
        &mut self,
        last: &mut Option<[f64; N]>,
        memory: &[f64],
    ) -> bool {
        let (row, samples) = match memory {
            [0.0, samples @ ..] => (None, samples),
            [1.0, rest @ ..] => match rest.split_first_chunk() {
                Some((row, samples)) => (Some(*row), samples),
                None => return false,
            },
            _ => return false,
        };
        let is_one = self.recall(samples);
        if is_one {
            *last = row;
        }
        is_one
    }

    /// Takes over what [`Samples::memory`] gave, and tells whether it is that: whole rows at rising times.
    pub(crate) fn recall(&mut self, memory: &[f64]) -> bool {
        let rows = memory.chunks_exact(self.width);
        let is_whole = rows.remainder().is_empty();
        let is_one = is_whole && rows.map(|row| row[0]).is_sorted_by(|first, next| first < next);
        if is_one {
            self.flat.clear();
            self.flat.extend_from_slice(memory);
        }
        is_one
    }
}

/// Mean of one value over the time of the rows ([`SteadyEstimate`]): each row stands for half of the time to its neighbours.
/// Values that are not finite are left out.
pub(crate) fn steady_mean(rows: &[&[f64]], value: impl Fn(&[f64]) -> f64) -> Option<SteadyEstimate> {
    let weights = weights(rows);
    let pairs = rows.iter().zip(weights).map(|(row, weight)| [value(row) * weight, weight]);
    let pairs: Vec<[f64; 2]> = pairs.filter(|[product, _]| product.is_finite()).collect();
    SteadyEstimate::ratio(&pairs)
}

/// The time that each row stands for; 1 for a single row [time].
pub(crate) fn weights(rows: &[&[f64]]) -> Vec<f64> {
    let Some(last) = rows.len().checked_sub(1).filter(|last| *last > 0) else { return vec![1.0; rows.len()] };
    let weight = |k: usize| 0.5 * (rows[(k + 1).min(last)][0] - rows[k.saturating_sub(1)][0]);
    (0..rows.len()).map(weight).collect()
}

/// Means of several values over the time of the rows and their errors, `[value]`; NaN where there is none.
pub(crate) fn steady_means(rows: &[&[f64]], values: Range<usize>) -> (Vec<f64>, Vec<f64>) {
    let estimates = values.map(|value| steady_mean(rows, |row| row[1 + value]));
    let pairs = estimates.map(|estimate| {
        let error = estimate.and_then(|e| e.standard_error);
        (estimate.map_or(f64::NAN, |e| e.value), error.unwrap_or(f64::NAN))
    });
    pairs.unzip()
}

/// Growth of a running total per time over all rows ([`SteadyEstimate`]).
pub(crate) fn steady_rate(rows: &[&[f64]], total: impl Fn(&[f64]) -> f64) -> Option<SteadyEstimate> {
    steady_ratio(rows, total, |row| row[0])
}

/// Growth of a running total per growth of another one over all rows ([`SteadyEstimate`]).
pub(crate) fn steady_ratio(
    rows: &[&[f64]],
    total: impl Fn(&[f64]) -> f64,
    other: impl Fn(&[f64]) -> f64,
) -> Option<SteadyEstimate> {
    let growth = |pair: &[&[f64]]| [total(pair[1]) - total(pair[0]), other(pair[1]) - other(pair[0])];
    let pairs: Vec<[f64; 2]> = rows.windows(2).map(growth).collect();
    SteadyEstimate::ratio(&pairs)
}

/// The figure of that name.
pub(crate) fn figure<E: Into<SteadyEstimate>>(name: &str, estimate: Option<E>) -> Figure {
    let estimate: Option<SteadyEstimate> = estimate.map(E::into);
    let error = estimate.and_then(|e| e.standard_error).filter(|x| x.is_finite());
    let value = estimate.map(|e| e.value).filter(|x| x.is_finite());
    Figure {
        name: name.to_owned(),
        value,
        standard_error: error,
        degrees_of_freedom: error.and(estimate).and_then(|e| e.freedom),
        trend: value.and(estimate).and_then(|e| e.trend),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Estimate;

    fn counted() -> Samples {
        let mut samples = Samples::new(1);
        for k in 0..=20 {
            // Grows by 1 and by 3 in turn: 2 per time.
            samples.push(f64::from(k), &[f64::from(2 * k + k % 2)]);
        }
        samples
    }

    #[test]
    fn a_time_counts_once() {
        let mut samples = counted();
        samples.push(20.0, &[99.0]);
        assert_eq!(samples, counted());
        assert_eq!(samples.since(19.0), [[19.0, 39.0], [20.0, 40.0]]);
    }

    #[test]
    fn only_whole_rows_at_rising_times_are_recalled() {
        let mut samples = Samples::new(1);
        for wrong in [&[0.0, 1.0, 2.0][..], &[1.0, 0.0, 1.0, 0.0], &[f64::NAN, 0.0, 1.0, 0.0]] {
            assert!(!samples.recall(wrong));
            assert_eq!(samples, Samples::new(1));
        }
        assert!(samples.recall(counted().memory()));
        assert_eq!(samples, counted());
    }

    #[test]
    fn rates_come_from_the_ends() {
        let samples = counted();
        let rows = samples.since(0.0);
        let rate = steady_rate(&rows, |row| row[1]).unwrap();
        assert_eq!(rate.value, 2.0);
        // What one interval has too much the next one lacks: far less than the error 1/√20 of independent intervals.
        assert!(rate.standard_error.unwrap() < 0.5 / 20.0_f64.sqrt(), "{rate:?}");
        assert_eq!(steady_rate(&rows[..1], |row| row[1]), None);
        assert_eq!(steady_rate(&[], |row| row[1]), None);
    }

    #[test]
    fn what_is_not_finite_is_left_out() {
        let rows: [&[f64]; 3] = [&[0.0, 1.0], &[1.0, f64::NAN], &[2.0, 3.0]];
        assert_eq!(steady_mean(&rows, |row| row[1]).unwrap().value, 2.0);
        assert_eq!(steady_means(&rows, 0..1), (vec![2.0], vec![1.0]));
        assert!(steady_means(&[], 0..1).0[0].is_nan());
        assert_eq!(figure("x", Some(Estimate { value: f64::NAN, standard_error: None })).value, None);
    }

    #[test]
    fn a_row_stands_for_the_time_around_it() {
        // A value that stays at 1 for three times as long as at 5, seen at uneven times.
        let rows: [&[f64]; 4] = [&[0.0, 1.0], &[2.0, 1.0], &[4.0, 1.0], &[6.0, 5.0]];
        assert_eq!(weights(&rows), [1.0, 2.0, 2.0, 1.0]);
        assert_eq!(steady_mean(&rows, |row| row[1]).unwrap().value, 10.0 / 6.0);
        let ramp: [&[f64]; 4] = [&[0.0, 0.0], &[1.0, 1.0], &[5.0, 5.0], &[6.0, 6.0]];
        assert_eq!(steady_mean(&ramp, |row| row[1]).unwrap().value, 3.0);
    }
}
