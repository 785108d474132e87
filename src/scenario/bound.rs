//! Bounds of numbers, and how they are told.

use crate::number::{exact, plain};

/// The largest magnitude of any number in a scenario: products of a few stay finite.
const HUGE: f64 = 1e40;
/// The smallest positive number where one is asked for.
const TINY: f64 = 1e-40;

/// An interval, and how to ask for a number inside it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound {
    low: f64,
    high: f64,
    request: &'static str,
}

impl Bound {
    /// Any sensible number.
    pub(super) const ANY: Bound =
        Bound { low: -HUGE, high: HUGE, request: "a number between -1e40 and 1e40, or other units" };
    /// Above zero.
    pub(super) const POSITIVE: Bound =
        Bound { low: TINY, high: HUGE, request: "a number above 0 (from 1e-40 to 1e40)" };
    /// Zero or above.
    pub(super) const NOT_NEGATIVE: Bound =
        Bound { low: 0.0, high: HUGE, request: "a number from 0 on (at most 1e40)" };
    /// From zero to one.
    pub(super) const SHARE: Bound = Bound { low: 0.0, high: 1.0, request: "a number from 0 to 1" };

    /// An interval with an own request.
    pub(super) const fn within(low: f64, high: f64, request: &'static str) -> Self {
        Bound { low, high, request }
    }

    /// An interval from just above zero.
    pub(super) const fn up_to(high: f64, request: &'static str) -> Self {
        Bound { low: TINY, high, request }
    }

    /// What is wrong with `value`, if anything.
    pub(super) fn refusal(self, value: f64) -> Option<String> {
        if (self.low..=self.high).contains(&value) {
            return None;
        }
        Some(format!("{} is out of bounds; give {}", exact(value), self.request))
    }
}

/// A number with four digits, for estimates.
pub(super) fn rounded(value: f64) -> String {
    plain(value, 4)
}
