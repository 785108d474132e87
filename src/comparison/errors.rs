//! Differences with their errors, before anything is judged: from replicas, from one run, or as the runs state them.

use super::memory::blocked;
use super::model::{Basis, Correlation, CurveOf};
use super::scatter::{Scatter, of_noise};
use super::walk;
use crate::statistics::{Estimate, average, mean};

/// Differences that scatter less than this share of themselves are the same in all replicas.
const SHARED: f64 = 1e-9;
/// Places whose gaps differ by a larger factor are not evenly spaced, and no blocks are made of them.
const EVEN: f64 = 1.5;
/// Independent stretches from which on a curve scatters about itself, and does not walk.
const NOISE: f64 = 20.0;
/// Degrees of freedom of errors that runs state themselves: those of ten blocks.
pub(super) const STATED: f64 = crate::statistics::BLOCKS as f64 - 1.0;

/// The terms in which values are subtracted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Terms {
    /// As they are, in their own unit.
    Own,
    /// Already divided by the reference.
    Shares,
    /// By their logarithms; all are then above zero.
    Logarithms,
}

/// A curve of one replica at the common places.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Drawn {
    /// The initial state.
    pub(super) replica: u32,
    /// NaN where it is not known.
    pub(super) values: Vec<f64>,
    /// Standard errors that the run states itself; empty where it states none.
    pub(super) errors: Vec<f64>,
}

/// Where curves are compared.
#[derive(Clone, Debug, Default)]
pub(super) struct Along<'a> {
    /// The abscissa.
    pub(super) places: &'a [f64],
    /// Its name.
    pub(super) abscissa: &'a str,
    /// What counts the events that a curve accumulates, and its name; `None` for places that do not follow in time.
    pub(super) clock: Option<(Vec<f64>, &'a str)>,
    /// Size of the quantity at each place, in the terms in which it is subtracted.
    pub(super) level: Vec<f64>,
}

/// Why there is no error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Missing {
    /// A single figure that its run states no error of.
    NotStated,
    /// A single figure whose series remembers longer than the blocks last from which its run states an error.
    Remembers,
    /// A single profile without a column of errors.
    NoColumn,
    /// A single series that neither settles nor begins alike in both runs.
    BeginsApart,
    /// A single series that adds less than twenty independent stretches.
    TooShort,
}

/// The mean of a whole curve, in the terms of its values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Whole {
    pub(super) value: f64,
    pub(super) error: f64,
    /// Degrees of freedom.
    pub(super) freedom: f64,
}

/// Differences with the errors of their means.
#[derive(Clone, Debug)]
pub(super) struct Raw {
    pub(super) values: Vec<f64>,
    pub(super) errors: Vec<f64>,
    /// Degrees of freedom of the errors.
    pub(super) freedom: f64,
    /// Values among which the largest is looked for.
    pub(super) compared: usize,
    /// The difference of whole curves.
    pub(super) whole: Option<Whole>,
    pub(super) basis: Basis,
    pub(super) correlation: Option<Correlation>,
    /// Said where no error is known.
    pub(super) missing: Missing,
}

impl Raw {
    /// `values` of which nothing more is known.
    pub(super) fn bare(values: Vec<f64>, missing: Missing) -> Self {
        let errors = vec![f64::NAN; values.len()];
        Raw {
            values,
            errors,
            freedom: 1.0,
            compared: 1,
            whole: None,
            basis: Basis::Nothing,
            correlation: None,
            missing,
        }
    }

    /// Differences that all pairs share by chance, as counts of few grains do, get the error of two independent means
    /// with the given `errors` `[own, reference][place]`.
    fn unpair(&mut self, errors: &[Vec<f64>; 2]) {
        for (place, error) in self.errors.iter_mut().enumerate() {
            let is_shared = *error <= SHARED * self.values[place].abs();
            if is_shared && self.values[place] != 0.0 {
                *error = errors[0][place].hypot(errors[1][place]);
            }
        }
    }
}

/// Mean over replicas; NaN where one of them has no value. Of one run the errors that it states.
pub(super) fn curve(of: &[Drawn], places: usize) -> CurveOf {
    let (mut values, mut errors) = (Vec::with_capacity(places), Vec::with_capacity(places));
    for place in 0..places {
        let here: Vec<f64> = of.iter().map(|drawn| drawn.values[place]).collect();
        let estimate = average(&here);
        let stated = if of.len() == 1 { of[0].errors.get(place).copied() } else { None };
        let error = stated.or(estimate.and_then(|estimate| estimate.standard_error));
        values.push(estimate.map_or(f64::NAN, |estimate| estimate.value));
        errors.push(error.unwrap_or(f64::NAN));
    }
    CurveOf { values, errors }
}

/// From the differences of `pairs` `[replica][place]`; `unpaired` are the errors of both means by themselves.
pub(super) fn of_replicas(pairs: &[Vec<f64>], along: &Along<'_>, unpaired: &[Vec<f64>; 2]) -> Raw {
    let drawn: Vec<Drawn> =
        pairs.iter().map(|values| Drawn { values: values.clone(), ..Drawn::default() }).collect();
    let CurveOf { values, errors } = curve(&drawn, along.places.len());
    let known: Vec<usize> = (0..values.len()).filter(|k| values[*k].is_finite()).collect();
    let rest: Vec<Vec<f64>> =
        pairs.iter().map(|pair| known.iter().map(|k| pair[*k] - values[*k]).collect()).collect();
    let mut raw = Raw {
        values,
        errors,
        freedom: pairs.len() as f64 - 1.0,
        compared: 0,
        whole: if along.places.len() > 1 { whole(pairs) } else { None },
        basis: Basis::Replicas,
        correlation: None,
        missing: Missing::NotStated,
    };
    raw.help(&rest, &known, along);
    raw.unpair(unpaired);
    let is_tested = |(value, error): (&f64, &f64)| *error > 0.0 || (*error == 0.0 && *value != 0.0);
    raw.compared = raw.values.iter().zip(&raw.errors).filter(|pair| is_tested(*pair)).count();
    raw
}

impl Raw {
    /// Takes the errors from neighbouring places together, where that makes them better known.
    fn help(&mut self, rest: &[Vec<f64>], known: &[usize], along: &Along<'_>) {
        let level: Vec<f64> = known.iter().map(|k| along.level[*k]).collect();
        let at = |of: &[f64]| -> Vec<f64> { known.iter().map(|k| of[*k]).collect() };
        let places = at(along.places);
        let noise = of_noise(rest, &level);
        let is_noise = |scatter: &Scatter| known.len() as f64 / (2.0 * scatter.correlation) >= NOISE;
        let (errors, freedom, basis, correlation) = match (noise, &along.clock) {
            (Some(noise), Some((clock, name))) if !is_noise(&noise) => {
                let begins_alike = rest.iter().all(|row| row.first() == Some(&0.0));
                let walk = if begins_alike { walk::of_replicas(rest, &at(clock)) } else { None };
                let Some(walk) = walk else { return };
                (
                    walk.errors,
                    walk.freedom,
                    Basis::Growth,
                    Correlation { time: walk.correlation, clock: (*name).to_owned() },
                )
            }
            (Some(noise), _) => {
                let gap = mean_gap(&places);
                let correlation =
                    Correlation { time: noise.correlation * gap, clock: along.abscissa.to_owned() };
                (noise.errors, noise.freedom, Basis::Neighbours, correlation)
            }
            (None, _) => return,
        };
        if freedom <= self.freedom {
            return;
        }
        (self.freedom, self.basis, self.correlation) = (freedom, basis, Some(correlation));
        known.iter().zip(errors).for_each(|(k, error)| self.errors[*k] = error);
    }
}

fn mean_gap(places: &[f64]) -> f64 {
    let ends = places.first().zip(places.last());
    ends.map_or(0.0, |(first, last)| (last - first) / (places.len() as f64 - 1.0).max(1.0))
}

/// The mean over the places that all pairs have, and its scatter over pairs; `None` where nothing scatters.
fn whole(pairs: &[Vec<f64>]) -> Option<Whole> {
    let places = pairs.iter().map(Vec::len).min()?;
    let shared: Vec<usize> = (0..places).filter(|k| pairs.iter().all(|pair| pair[*k].is_finite())).collect();
    let of_pair = |pair: &Vec<f64>| mean(&shared.iter().map(|k| pair[*k]).collect::<Vec<f64>>());
    let means: Vec<f64> = pairs.iter().filter_map(of_pair).collect();
    let Estimate { value, standard_error } = average(&means)?;
    let error = standard_error.filter(|error| *error > 0.0)?;
    Some(Whole { value, error, freedom: pairs.len() as f64 - 1.0 })
}

/// One run of each: blocks where the difference settles, the scatter of its growth where it does not; errors stay
/// unknown otherwise, but for equal values.
pub(super) fn of_one(values: &[f64], along: &Along<'_>) -> Raw {
    let known: Vec<usize> = (0..values.len()).filter(|k| values[*k].is_finite()).collect();
    let mut raw = Raw::bare(values.to_vec(), Missing::NoColumn);
    if known.iter().all(|k| values[*k] == 0.0) {
        known.iter().for_each(|k| raw.errors[*k] = 0.0);
        return raw;
    }
    let Some((clock, name)) = &along.clock else { return raw };
    let at = |of: &[f64]| -> Vec<f64> { known.iter().map(|k| of[*k]).collect() };
    let (places, series) = (at(along.places), at(values));
    if let Some(found) = if is_even(&places) { blocked(&series) } else { None } {
        for (order, k) in known.iter().enumerate() {
            (raw.values[*k], raw.errors[*k]) = (found.values[order], found.errors[order]);
        }
        let time = found.correlation * mean_gap(&places);
        raw.correlation = Some(Correlation { time, clock: along.abscissa.to_owned() });
        raw.whole = Some(Whole { value: found.whole[0], error: found.whole[1], freedom: found.freedom });
        (raw.freedom, raw.compared, raw.basis) = (found.freedom, found.blocks, Basis::Blocks);
        return raw;
    }
    if series[0] != 0.0 {
        raw.missing = Missing::BeginsApart;
    } else if let Some(walk) = walk::of_one(&series, &at(clock)) {
        known.iter().zip(&walk.errors).for_each(|(k, error)| raw.errors[*k] = *error);
        raw.correlation = Some(Correlation { time: walk.correlation, clock: (*name).to_owned() });
        (raw.freedom, raw.compared, raw.basis) = (walk.freedom, known.len() - 1, Basis::Growth);
    } else {
        raw.missing = Missing::TooShort;
    }
    raw
}

fn is_even(places: &[f64]) -> bool {
    let gaps = || places.windows(2).map(|pair| pair[1] - pair[0]);
    gaps().fold(0.0, f64::max) <= EVEN * gaps().fold(f64::INFINITY, f64::min)
}

/// The difference of one run each with the errors that both state.
pub(super) fn as_stated(values: Vec<f64>, errors: [&[f64]; 2], missing: Missing) -> Raw {
    let mut raw = Raw::bare(values, missing);
    for (k, value) in raw.values.iter().enumerate() {
        let error = |of: &[f64]| of.get(k).copied().unwrap_or(f64::NAN);
        let both = error(errors[0]).hypot(error(errors[1]));
        raw.errors[k] = if both.is_nan() && *value == 0.0 { 0.0 } else { both };
    }
    if raw.errors.iter().any(|error| *error > 0.0) {
        raw.compared = raw.errors.iter().filter(|error| error.is_finite()).count();
        (raw.freedom, raw.basis) = (STATED, Basis::Stated);
    }
    raw
}
