//! When something is due. A step is never shortened: what is due happens at the first
//! step end at or after its nominal time. An engine without steps stops at nominal times.

/// Places spread over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// This many, evenly over the progress of the run, and one at its start.
    Even(u32),
    /// This many, evenly in the logarithm of the progress over three decades, and one at the start.
    Logarithmic(u32),
    /// Every so much time, beginning at 0 [time].
    Every(f64),
    /// This many, evenly inside the run: not at its start nor at its end.
    Inside(u32),
    /// At the start only; the end is not a matter of schedules.
    Start,
}

/// What something waits for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Due {
    /// Progress of the run, in [0, 1].
    Progress(f64),
    /// Simulated time [time].
    Time(f64),
    /// Nothing: it has happened.
    Never,
}

/// What rounding may take from a time, as a share of it: a multiple of an interval is rounded twice, once as the interval
/// and once as the product, and so is a sum of steps.
pub const ROUNDING: f64 = 4.0 * f64::EPSILON;

impl Due {
    /// Whether it has come at `time` and `progress`.
    pub fn is_reached(self, time: f64, progress: f64) -> bool {
        match self {
            Due::Progress(place) => progress >= place,
            Due::Time(nominal) => time >= nominal,
            Due::Never => false,
        }
    }
}

/// Decades of progress that a logarithmic spread covers.
const DECADES: f64 = 3.0;

impl Spread {
    /// What number `done` (0 for the first) waits for.
    pub fn due(self, done: u64) -> Due {
        let k = done as f64;
        match self {
            Spread::Even(number) if done <= u64::from(number) => Due::Progress(k / f64::from(number.max(1))),
            Spread::Logarithmic(_) | Spread::Start if done == 0 => Due::Progress(0.0),
            Spread::Logarithmic(number) if done <= u64::from(number) => {
                Due::Progress(logarithmic_place(done, number))
            }
            Spread::Every(interval) => Due::Time(k * interval),
            Spread::Inside(number) if done < u64::from(number) => {
                Due::Progress((k + 1.0) / (f64::from(number) + 1.0))
            }
            Spread::Even(_) | Spread::Logarithmic(_) | Spread::Inside(_) | Spread::Start => Due::Never,
        }
    }

    /// Whether number `done` (0 for the first) is due at `time` and `progress`.
    pub fn is_due(self, done: u64, time: f64, progress: f64) -> bool {
        self.due(done).is_reached(time, progress)
    }

    /// The number that is due next after everything up to `time` and `progress` is done.
    pub fn next(self, time: f64, progress: f64) -> u64 {
        let mut next = match self {
            Spread::Even(number) => (progress * f64::from(number.max(1))) as u64,
            Spread::Every(interval) if interval > 0.0 => (time / interval) as u64,
            Spread::Every(_) => u64::MAX,
            Spread::Logarithmic(_) | Spread::Inside(_) | Spread::Start => 0,
        };
        // Rounding may have left the estimate one short or one beyond.
        next = next.saturating_sub(1);
        while next < u64::MAX && self.is_due(next, time, progress) {
            next += 1;
        }
        next
    }
}

/// Progress at which number `k` ≥ 1 of `number` is due: 10⁻³ for the first, 1 for the last.
fn logarithmic_place(k: u64, number: u32) -> f64 {
    let share = if number > 1 { (k - 1) as f64 / f64::from(number - 1) } else { 1.0 };
    if share >= 1.0 { 1.0 } else { libm::exp(std::f64::consts::LN_10 * DECADES * (share - 1.0)) }
}

/// A time near `estimate` at which `is_reached` holds: `estimate` itself where it does, else the next that
/// was found; `is_reached` has to hold from some time on [time].
pub fn first_time(estimate: f64, is_reached: impl Fn(f64) -> bool) -> f64 {
    let mut time = estimate;
    let mut stride = estimate.abs().next_up() - estimate.abs();
    while time.is_finite() && !is_reached(time) {
        time = (time + stride).max(time.next_up());
        stride *= 2.0;
    }
    time
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_frames_include_start_and_end() {
        let spread = Spread::Even(4);
        let due = |progress| (0..10).take_while(|&k| spread.is_due(k, 0.0, progress)).count();
        assert_eq!((due(0.0), due(0.2), due(0.25), due(1.0)), (1, 1, 2, 5));
        assert_eq!((spread.next(0.0, 0.0), spread.next(0.0, 0.6), spread.next(0.0, 1.0)), (1, 3, 5));
    }

    #[test]
    fn pauses_shorter_than_any_step_are_no_endless_work() {
        for interval in [0.0, 5e-324, 1e-22] {
            assert_eq!(Spread::Every(interval).next(0.1, 0.0), u64::MAX);
        }
        assert!(Spread::Every(0.0).next(0.0, 0.0) >= u64::MAX - 1);
    }

    #[test]
    fn a_place_is_really_reached_at_its_time() {
        for number in [3, 7, 10, 400, 997] {
            for limit in [0.1, 0.3, 1.0, 7.7, 1e-9, 12345.6] {
                for k in 1..=number {
                    let place = f64::from(k) / f64::from(number);
                    let time = first_time(place * limit, |time| time / limit >= place);
                    assert!(Spread::Even(number).is_due(u64::from(k), time, time / limit));
                    assert!((time - place * limit).abs() <= 4.0 * f64::EPSILON * time);
                }
            }
        }
        // Where progress is flat, many times round to the same progress.
        let place = 1.0 - 1e-9;
        let time = first_time(place / (1.0 - place), |time| time / (time + 1.0) >= place);
        assert!((time * 1e-9 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn every_counts_from_zero() {
        let spread = Spread::Every(0.1);
        for k in 0..1000_u64 {
            let next = spread.next(k as f64 * 0.1, 0.0);
            assert_eq!(next, k + 1);
        }
    }

    #[test]
    fn logarithmic_places_span_three_decades() {
        assert!((logarithmic_place(1, 7) - 1e-3).abs() < 1e-15);
        assert!((logarithmic_place(3, 7) - 1e-2).abs() < 1e-14);
        assert_eq!(logarithmic_place(7, 7), 1.0);
        assert_eq!(Spread::Logarithmic(7).next(0.0, 0.011), 4);
    }

    #[test]
    fn inside_leaves_out_both_ends() {
        let spread = Spread::Inside(4);
        assert!(!spread.is_due(0, 0.0, 0.19) && spread.is_due(0, 0.0, 0.2));
        assert!(!spread.is_due(4, 0.0, 1.0));
    }
}
