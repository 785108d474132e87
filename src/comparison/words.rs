//! A difference as a sentence.

use super::errors::Missing;
use super::model::{Difference, Overall, Peak};
use crate::number::{plain, with_error};

/// What a sentence is about.
#[derive(Clone, Debug)]
pub(super) struct Subject<'a> {
    /// The contestant.
    pub(super) label: &'a str,
    /// The one that it is compared with.
    pub(super) reference: &'a str,
    /// Name of the quantity, in words.
    pub(super) quantity: String,
    /// Name of the abscissa, in words; empty for a single number.
    pub(super) abscissa: String,
    /// When, for one profile of several [time].
    pub(super) time: Option<f64>,
    /// Whether it falls in the reference because the grains cool.
    pub(super) is_cooling: bool,
}

/// Where a difference that counts is shown, and what it is beyond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shown {
    /// Number of the place.
    pub(super) place: Option<usize>,
    /// Standard errors.
    pub(super) limit: f64,
}

impl Subject<'_> {
    /// The quantity, with the time of a profile.
    fn what(&self) -> String {
        let when = self.time.map_or_else(String::new, |time| format!(" at time {}", plain(time, 3)));
        format!("{}{when}", self.quantity)
    }

    fn at(&self, x: f64) -> String {
        match self.abscissa.is_empty() {
            true => String::new(),
            false => format!(" at {} {}", self.abscissa, plain(x, 3)),
        }
    }

    /// That it is apart by `value` ± `error`, in words.
    fn claim(&self, value: f64, error: f64, is_relative: bool) -> String {
        let Subject { label, reference, .. } = self;
        let amount = match is_relative {
            true => format!("{} %", with_error(100.0 * value.abs(), Some(100.0 * error))),
            false => with_error(value.abs(), Some(error)),
        };
        let (side, cools) = if value < 0.0 { ("below", "faster") } else { ("above", "more slowly") };
        match self.is_cooling {
            true => format!("{label}: cools {cools} than {reference}, {} {amount} {side}", self.what()),
            false => format!("{label}: {} is {amount} {side} {reference}", self.what()),
        }
    }
}

/// What is said where no error is known, and why.
pub(super) fn unknown_sentence(missing: Missing, subject: &Subject<'_>) -> String {
    let why = match missing {
        Missing::NotStated => "a single run states none",
        Missing::Remembers => {
            "its series remembers longer than the blocks from which a single run states one"
        }
        Missing::NoColumn => "a single profile has no column of errors",
        Missing::BeginsApart => {
            "a single run of each begins at another value, and their difference does not settle about a mean"
        }
        Missing::TooShort => {
            "what one run of each adds from recording to recording holds fewer than 20 independent stretches"
        }
    };
    let Subject { label, reference, .. } = subject;
    format!(
        "{label}: no error is known for {} ({why}), so nothing is said against {reference}",
        subject.what()
    )
}

/// What is said of a figure that `shown` says is not steady in the runs of `label`.
pub(super) fn not_steady_sentence(subject: &Subject<'_>, label: &str, shown: &str) -> String {
    let Subject { label: own, reference, .. } = subject;
    format!("{own}: {} of {label} is {shown}, so it is not compared with {reference}", subject.what())
}

/// What `difference` says at `places`, with its `ratios` to its errors; where it counts, at the place that is `shown`.
pub(super) fn sentence(
    difference: &Difference,
    shown: Option<Shown>,
    ratios: &[f64],
    places: &[f64],
    subject: &Subject<'_>,
) -> String {
    let Subject { label, reference, .. } = subject;
    let most = difference.most.unwrap_or(Peak { place: 0.0, standard_errors: 0.0 });
    let Some(Shown { place: Some(place), limit }) = shown else {
        return match most.standard_errors == 0.0 {
            true => format!("{label}: {} is equal to that of {reference}", subject.what()),
            false => format!(
                "{label}: {} agrees with {reference}, at most {} standard errors apart{} (differs beyond {})",
                subject.what(),
                plain(most.standard_errors, 2),
                subject.at(most.place),
                plain(difference.threshold, 2)
            ),
        };
    };
    let claim = subject.claim(difference.values[place], difference.errors[place], difference.is_relative);
    let apart = match ratios[place].is_finite() {
        true => format!("{} standard errors, beyond {}", plain(ratios[place], 2), plain(limit, 2)),
        false => "the same in all replicas".to_owned(),
    };
    let stays = difference
        .parts_at
        .filter(|_| places.len() > 1)
        .map_or_else(String::new, |x| format!("; apart from {} {} on", subject.abscissa, plain(x, 3)));
    format!("{claim}{} ({apart}){stays}", subject.at(places[place]))
}

/// What whole curves say where no single place says it.
pub(super) fn overall_sentence(all: Overall, is_relative: bool, subject: &Subject<'_>) -> String {
    format!(
        "{} in the mean of the whole curve ({} standard errors, beyond {}; the error is too wide at any single {})",
        subject.claim(all.value, all.error, is_relative),
        plain(all.standard_errors, 2),
        plain(all.threshold, 2),
        subject.abscissa
    )
}
