//! When measures that sample the whole run do so.
//!
//! The progress of a run, from 0 to 1, is cut into 2ˡ equal strata, and one sample is taken in each, at a place that a hash of the
//! number of the stratum gives (stratified sampling; Cochran 1977, chapter 5). Places of neighbouring strata have nothing to do with
//! each other, so that no period of the scenario can be in step with them. They are functions of the seed, l and the number alone:
//! threads, recordings and interruptions do not change them. Strata of a coarse cut take the place of one of their
//! halves, so that measures with different l sample at common times.
//!
//! l follows from work that is counted, not from a clock: samples may take [`SHARE`] of the work of the run so far, carried on
//! to its end, or about [`SMALL`] altogether where that is more.

use super::schedule::Due;
use crate::observe::measure::Effort;
use crate::random::{Phase, Streams};

/// Share of the work of a run that the samples of each [`Effort`] may take.
const SHARE: f64 = 0.02;
/// Work that samples may always take, in grains advanced by a step, about a tenth of a second; and up to how many grains: of
/// twice as many they may take half of it.
const SMALL: f64 = 2e6;
const FEW: f64 = 2e4;
/// Work of an event of an engine without steps, in grains advanced by a step.
const EVENT: f64 = 40.0;
/// Work of showing one grain of such an engine: it has to be brought to the common time and sorted.
const SYNCHRONISATION: f64 = 3.0;
/// The fewest strata are 2 to this power.
const COARSEST: u32 = 2;
/// The cut whose places all others use, 2 to this power.
const FINEST: u32 = 11;
/// The finest cut for tables, whose rows are long.
const FINEST_FOR_TABLES: u32 = 9;
/// Where the number of the cut stands in the number of a sample.
const SHIFT: u32 = 32;

/// The sample at the start of a run.
pub(super) const START: u64 = 0;
/// No sample.
const NEVER: u64 = u64::MAX;

/// What samples cost, beside what the run costs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Work {
    /// Grains advanced by a step so far, or the like.
    done: f64,
    /// Of showing one grain to a measure, before that does anything.
    showing: f64,
    /// Grains now.
    grains: f64,
}

impl Work {
    /// The work of an engine with steps, after so many grains were advanced by a step.
    pub(super) fn of_steps(particle_steps: u64, grains: usize) -> Self {
        Work { done: particle_steps as f64, showing: 0.0, grains: grains.max(1) as f64 }
    }

    /// The work of an engine without steps after so many events.
    pub(super) fn of_events(events: u64, grains: usize) -> Self {
        Work { done: EVENT * events as f64, showing: SYNCHRONISATION, grains: grains.max(1) as f64 }
    }

    /// The cut for which samples of that `effort` take no more than their share; the run is at `progress`.
    fn cut(self, effort: Effort, progress: f64) -> u32 {
        let (each, finest) = match effort {
            Effort::Sums => (1.0, FINEST),
            Effort::Table => (2.0, FINEST_FOR_TABLES),
        };
        let expected = if progress > 0.0 { self.done / progress } else { 0.0 };
        let small = SMALL * (FEW / self.grains).min(1.0);
        let affordable = small.max(SHARE * expected) / (self.grains * (self.showing + each));
        (COARSEST..finest)
            .take_while(|cut| f64::from(2_u32 << cut) <= affordable)
            .last()
            .map_or(COARSEST, |cut| cut + 1)
    }
}

/// What sample number `next` waits for.
pub(super) fn due(seed: u64, next: u64) -> Due {
    match next {
        START => Due::Progress(0.0),
        NEVER => Due::Never,
        _ => Due::Progress(place(seed, (next >> SHIFT) as u32, next & ((1 << SHIFT) - 1))),
    }
}

/// The number of the first sample after `progress` of a measure of that `effort`.
pub(super) fn next(seed: u64, effort: Effort, progress: f64, work: Work) -> u64 {
    let cut = work.cut(effort, progress);
    let strata = 1_u64 << cut;
    let here = (progress * strata as f64) as u64;
    let following = (here..strata).find(|stratum| place(seed, cut, *stratum) > progress);
    following.map_or(NEVER, |stratum| u64::from(cut) << SHIFT | stratum)
}

/// The progress at which the sample of a `stratum` of a `cut` is taken.
fn place(seed: u64, cut: u32, stratum: u64) -> f64 {
    let hash = |cut: u32, stratum: u64| Streams::new(seed).at(u64::from(cut), Phase::Samples).hash(stratum);
    let finest = (cut..FINEST).fold(stratum, |stratum, cut| 2 * stratum + (hash(cut, stratum) >> 63));
    let inside = (hash(FINEST, finest) >> 11) as f64 / (1_u64 << 53) as f64;
    (finest as f64 + inside) / f64::from(1 << FINEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stratum_of_every_cut_has_a_place_inside() {
        for cut in COARSEST..=FINEST {
            for stratum in 0..1 << cut {
                let place = place(3, cut, stratum) * f64::from(1 << cut);
                assert_eq!(place as u64, stratum, "{cut}");
            }
        }
    }

    #[test]
    fn coarse_cuts_take_places_of_finer_ones() {
        for cut in COARSEST..FINEST {
            for stratum in 0..1 << cut {
                let halves = [place(3, cut + 1, 2 * stratum), place(3, cut + 1, 2 * stratum + 1)];
                assert!(halves.contains(&place(3, cut, stratum)));
            }
        }
    }

    #[test]
    fn no_period_is_in_step_with_the_places() {
        // |⟨exp(2πi f p)⟩| of n independent places is about 1/√n, at any frequency; even places have 1 at f = n.
        let strata = 1_u32 << FINEST;
        for frequency in 1..=4 * strata {
            let angle = |k: u64| std::f64::consts::TAU * f64::from(frequency) * place(3, FINEST, k);
            let sum = |part: fn(f64) -> f64| (0..u64::from(strata)).map(|k| part(angle(k))).sum::<f64>();
            let share = sum(f64::cos).hypot(sum(f64::sin)) / f64::from(strata);
            // exp(−n share²) of so many frequencies.
            assert!(share < 5.0 / f64::from(strata).sqrt(), "{frequency}: {share}");
        }
    }

    #[test]
    fn samples_follow_each_other_to_the_end() {
        let work = Work::of_steps(1_000_000_000, 900);
        let (mut number, mut progress, mut taken) = (START, 0.0, 0);
        while let Due::Progress(place) = due(3, number) {
            assert!(place > progress || taken == 0);
            progress = place;
            taken += 1;
            number = next(3, Effort::Sums, progress, work);
        }
        assert_eq!((number, taken), (NEVER, 1 + (1 << FINEST)));
        assert_eq!(next(3, Effort::Sums, 1.0, work), NEVER);
    }

    #[test]
    fn samples_are_as_many_as_the_work_deserves() {
        let of = |work: Work, effort| 1 << work.cut(effort, 0.5);
        // 2 % of twice 50 million, over a unit for each of 10⁵ grains: 20.
        assert_eq!(of(Work::of_steps(50_000_000, 100_000), Effort::Sums), 16);
        // A small gas may always have some.
        assert_eq!(of(Work::of_steps(0, 900), Effort::Sums), 2048);
        assert_eq!(of(Work::of_steps(0, 1000), Effort::Table), 512);
        // A million spheres that collide once are shown four times.
        assert_eq!(of(Work::of_events(400_000, 1_000_000), Effort::Table), 4);
        assert_eq!(of(Work::of_events(400_000_000, 1_000_000), Effort::Table), 128);
    }
}
