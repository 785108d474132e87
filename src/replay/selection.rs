//! The part of a log that somebody asks for.

use crate::simulation::schedule::ROUNDING;

/// Which recordings, states or frames of a log are wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Selection {
    /// The earliest time [time].
    pub from: f64,
    /// The latest time [time].
    pub to: f64,
    /// Of those in between, the first and then every how many.
    pub every: u32,
}

impl Default for Selection {
    /// Everything.
    fn default() -> Self {
        Selection { from: f64::NEG_INFINITY, to: f64::INFINITY, every: 1 }
    }
}

impl Selection {
    /// Picks things that are shown to it in the order of their times.
    pub fn picker(self) -> Picker {
        Picker { selection: self, seen: 0 }
    }

    /// Whether `time` [time] lies in the span. Its ends are typed as decimal numbers and times are sums: one that is at an end
    /// but for rounding belongs to the span.
    pub fn spans(&self, time: f64) -> bool {
        let slack = ROUNDING * time.abs();
        self.from <= time + slack && time - slack <= self.to
    }

    /// The span in words, as in `from t = 2 to the end`.
    pub fn words(&self) -> String {
        let end = |time: f64, otherwise: &str| match time.is_finite() {
            true => format!("t = {time}"),
            false => otherwise.to_owned(),
        };
        format!("from {} to {}", end(self.from, "the start"), end(self.to, "the end"))
    }
}

/// A selection at work.
#[derive(Clone, Copy, Debug)]
pub struct Picker {
    selection: Selection,
    /// How many in the span there were so far.
    seen: u64,
}

impl Picker {
    /// Whether the thing at `time` [time] is wanted.
    pub fn takes(&mut self, time: f64) -> bool {
        if !self.selection.spans(time) {
            return false;
        }
        self.seen += 1;
        (self.seen - 1).is_multiple_of(u64::from(self.selection.every.max(1)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_belong_to_the_span_and_counting_starts_in_it() {
        let picked = |selection: Selection| -> Vec<u32> {
            let mut picker = selection.picker();
            (0..10).filter(|&k| picker.takes(f64::from(k))).collect()
        };
        assert_eq!(picked(Selection { from: 2.0, to: 7.0, every: 2 }), [2, 4, 6]);
        assert_eq!(picked(Selection::default()).len(), 10);
        assert_eq!(picked(Selection { from: 3.5, ..Selection::default() })[0], 4);
        // 3 · 0.2 and 0.1 + 0.2 are one step of double precision beyond the numbers that are typed.
        let at = |time: f64| Selection { from: time, to: time, every: 1 };
        assert!(at(0.6).spans(3.0 * 0.2) && at(0.3).spans(0.1 + 0.2) && at(0.9).spans(3.0 * 0.3));
        assert!(!at(0.3).spans(0.3 + 1e-15) && !at(0.3).spans(0.3 - 1e-15));
        assert_eq!(Selection { from: 2.0, ..Selection::default() }.words(), "from t = 2 to the end");
    }
}
