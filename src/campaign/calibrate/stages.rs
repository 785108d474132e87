//! p(b) in the course of the runs: slices of collisions taken together until c is known well enough.

use crate::engine::report::IMPACT_BINS;
use crate::law::impact::Impacts;
use crate::observe::impact_parameter::most_likely_c;
use crate::report::calibration::Stage;
use crate::space::Vector;
use crate::statistics::{Estimate, standard_error};

/// The fewest collisions of a stage, of all runs together: an error of c of 0.024 at c = 0.
const FEWEST_COLLISIONS: u64 = 20_000;
/// A stage ends at least this factor behind its beginning.
const LEAST_FACTOR: f64 = 1.25;
/// A stage lasts at least this many collisions per particle.
const LEAST_LENGTH: f64 = 1.0;
/// Points of the curve that shows a density.
const CURVE_POINTS: usize = 81;

/// Collisions between two looks at a run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Slice {
    /// Collisions per particle at its beginning and its end.
    pub(super) stretch: [f64; 2],
    /// Collisions by |b|/d, `[bin]`.
    pub(super) impacts: [u64; IMPACT_BINS],
}

/// The end of the slice that begins after so many `collisions_per_particle`.
pub(super) fn end_of_slice(collisions_per_particle: f64) -> f64 {
    collisions_per_particle + (0.05 * collisions_per_particle).max(0.25)
}

/// Stages from the slices `[run][slice]` of all runs; those whose c cannot be told are left out.
pub(super) fn stages<V: Vector>(runs: &[Vec<Slice>]) -> Vec<Stage> {
    let spans = spans(runs);
    spans.into_iter().filter_map(|[first, end]| stage::<V>(runs, first, end)).collect()
}

/// First slice and the one behind the last, of every stage.
fn spans(runs: &[Vec<Slice>]) -> Vec<[usize; 2]> {
    let longest = runs.iter().map(Vec::len).max().unwrap_or(0);
    let mut spans: Vec<[usize; 2]> = Vec::new();
    let mut first = 0;
    for slice in 0..longest {
        let [from, to] = stretch(runs, first, slice + 1);
        let collisions: u64 = total(runs, first, slice + 1).iter().sum();
        let is_long = to >= LEAST_FACTOR * from && to - from >= LEAST_LENGTH;
        if is_long && collisions >= FEWEST_COLLISIONS {
            spans.push([first, slice + 1]);
            first = slice + 1;
        }
    }
    // What is left at the end is too short for a stage of its own.
    match spans.last_mut() {
        Some(last) => last[1] = longest,
        None if longest > 0 => spans.push([0, longest]),
        None => {}
    }
    spans
}

/// Where the slices from `first` to before `end` begin and end, in the run that went farthest.
fn stretch(runs: &[Vec<Slice>], first: usize, end: usize) -> [f64; 2] {
    let inside = || runs.iter().flat_map(|run| run.iter().take(end).skip(first));
    let from = inside().map(|slice| slice.stretch[0]).fold(f64::INFINITY, f64::min);
    [from, inside().map(|slice| slice.stretch[1]).fold(0.0, f64::max)]
}

fn total(runs: &[Vec<Slice>], first: usize, end: usize) -> [u64; IMPACT_BINS] {
    let mut total = [0; IMPACT_BINS];
    for slice in runs.iter().flat_map(|run| run.iter().take(end).skip(first)) {
        total.iter_mut().zip(slice.impacts).for_each(|(sum, count)| *sum += count);
    }
    total
}

fn stage<V: Vector>(runs: &[Vec<Slice>], first: usize, end: usize) -> Option<Stage> {
    let impacts = total(runs, first, end);
    let c = c_of::<V>(&impacts)?;
    // Collisions of one cluster are not independent of each other; runs are.
    let of_runs: Vec<f64> = runs
        .iter()
        .filter_map(|run| Some(c_of::<V>(&total(std::slice::from_ref(run), first, end))?.value))
        .collect();
    let errors = [c.standard_error, standard_error(&of_runs)];
    let law = Impacts::new(c.value);
    let whole = V::impact_integral(c.value, 1.0);
    let density = |k: usize| {
        let (b, half) = (k as f64 / (CURVE_POINTS - 1) as f64, 0.5 / IMPACT_BINS as f64);
        let ends = [(b - half).max(0.0), (b + half).min(1.0)];
        let inside = V::impact_integral(c.value, ends[1]) - V::impact_integral(c.value, ends[0]);
        [b, inside / (whole * (ends[1] - ends[0]))]
    };
    Some(Stage {
        stretch: stretch(runs, first, end),
        impacts,
        c: Estimate { value: c.value, standard_error: errors.into_iter().flatten().reduce(f64::max) },
        chi_squared: chi_squared::<V>(&impacts, c.value),
        cooling_factor: law.cooling_factor::<V>(),
        density: (0..CURVE_POINTS).map(density).collect(),
    })
}

/// χ² of `impacts` against the law of this c; there are two degrees of freedom less than bins.
fn chi_squared<V: Vector>(impacts: &[u64; IMPACT_BINS], c: f64) -> f64 {
    let (whole, all) = (V::impact_integral(c, 1.0), impacts.iter().sum::<u64>() as f64);
    let below = |bin: usize| V::impact_integral(c, bin as f64 / IMPACT_BINS as f64) / whole;
    let term = |(bin, &count): (usize, &u64)| {
        let expected = all * (below(bin + 1) - below(bin));
        (count as f64 - expected) * (count as f64 - expected) / expected
    };
    impacts.iter().enumerate().map(term).sum()
}

fn c_of<V: Vector>(impacts: &[u64; IMPACT_BINS]) -> Option<Estimate> {
    most_likely_c::<V>(&impacts.map(|count| count as f64))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Phase, Streams};
    use glam::{DVec2, DVec3};

    /// Slices of so many collisions each whose c rises from slice to slice.
    fn run<V: Vector>(seed: u64, slices: usize, collisions: usize, c: impl Fn(f64) -> f64) -> Vec<Slice> {
        let mut random = Streams::new(seed).at(0, Phase::Collisions).stream(0);
        let mut at = 0.0;
        (0..slices)
            .map(|_| {
                let stretch = [at, end_of_slice(at)];
                at = stretch[1];
                let mut impacts = [0; IMPACT_BINS];
                for _ in 0..collisions {
                    let b = V::impact_quantile(c(0.5 * (stretch[0] + stretch[1])), random.symmetric()).abs();
                    impacts[((b * IMPACT_BINS as f64) as usize).min(IMPACT_BINS - 1)] += 1;
                }
                Slice { stretch, impacts }
            })
            .collect()
    }

    fn finds<V: Vector>(c: f64) {
        let runs: Vec<_> = (1..=4).map(|seed| run::<V>(seed, 40, 2000, |_| c)).collect();
        let stages = stages::<V>(&runs);
        assert!(stages.len() > 3);
        for stage in &stages {
            let error = stage.c.standard_error.unwrap();
            assert!((stage.c.value - c).abs() < 4.0 * error, "{c}: {:?}", stage.c);
            // 20 000 collisions or more; runs may scatter by more than that.
            assert!(error < 0.1);
            // 38 degrees of freedom: standard deviation √76.
            assert!(stage.chi_squared < 38.0 + 5.0 * 76.0_f64.sqrt(), "χ² = {}", stage.chi_squared);
        }
        let all: u64 = stages.iter().flat_map(|stage| stage.impacts).sum();
        assert_eq!(all, 4 * 40 * 2000);
        assert!(stages.windows(2).all(|pair| pair[0].stretch[1] == pair[1].stretch[0]));
    }

    #[test]
    fn a_known_c_is_found_in_every_stage() {
        for c in [-0.5, 0.0, 0.6] {
            finds::<DVec2>(c);
            finds::<DVec3>(c);
        }
    }

    #[test]
    fn a_rising_c_is_followed() {
        let runs: Vec<_> =
            (1..=4).map(|seed| run::<DVec2>(seed, 60, 2000, |at| (0.01 * at).min(0.8))).collect();
        let stages = stages::<DVec2>(&runs);
        assert!(stages.len() > 2);
        for stage in &stages {
            let expected = (0.01 * stage.place()).min(0.8);
            // Inside a stage of length factor 1.25 or more, c bends little: 0.01 covers it.
            let room = 4.0 * stage.c.standard_error.unwrap() + 0.01;
            assert!((stage.c.value - expected).abs() < room, "{expected}: {:?}", stage.c);
        }
    }

    #[test]
    fn scatter_of_runs_counts_where_it_is_larger() {
        // Runs of different c: the curvature of the likelihood knows nothing of that.
        let runs: Vec<_> =
            [0.0, 0.2, 0.4, 0.6].iter().map(|&c| run::<DVec2>(9, 20, 4000, move |_| c)).collect();
        let stage = &stages::<DVec2>(&runs)[0];
        let error = stage.c.standard_error.unwrap();
        // The standard deviation of the four is 0.26, half of that is their standard error.
        assert!((error - 0.13).abs() < 0.06, "{error}");
    }

    #[test]
    fn a_density_of_another_form_has_a_large_chi_squared() {
        // Half of the collisions are chaotic, half glance as of c = 0.99: no single c does both.
        let mut runs: Vec<_> = [0.0, 0.99].iter().map(|&c| run::<DVec2>(4, 20, 20_000, move |_| c)).collect();
        assert!(stages::<DVec2>(&runs)[0].chi_squared > 38.0 + 10.0 * 76.0_f64.sqrt());
        runs.truncate(1);
        assert!(stages::<DVec2>(&runs)[0].chi_squared < 38.0 + 5.0 * 76.0_f64.sqrt());
    }

    #[test]
    fn no_collisions_make_no_stage() {
        assert!(stages::<DVec2>(&[Vec::new()]).is_empty());
        let silent = Slice { stretch: [0.0, 0.25], impacts: [0; IMPACT_BINS] };
        assert!(stages::<DVec2>(&[vec![silent]]).is_empty());
    }
}
