//! Simulated time as whole ticks, which is what MCAP orders messages by.

/// Ticks per unit of time where nothing speaks against it: a nanosecond per tick, for viewers.
const USUAL: u64 = 1_000_000_000;
/// Ticks that should lie between two recordings.
const APART: f64 = 1000.0;
/// Ticks that a run should not exceed; viewers count nanoseconds in 63 bits.
const MOST: f64 = 4e18;

/// Ticks per unit of simulated time, a power of ten: 10⁹, or more where recordings `shortest_interval`
/// [time] apart need it, or less where a run of `duration` [time] needs it. What is not known
/// is given as 0 or infinity.
pub fn time_scale(duration: f64, shortest_interval: f64) -> u64 {
    let mut scale = USUAL;
    let fits = |scale: u64| !duration.is_finite() || duration * scale as f64 <= MOST;
    if shortest_interval > 0.0 {
        while shortest_interval * (scale as f64) < APART && scale < USUAL * USUAL && fits(scale * 10) {
            scale *= 10;
        }
    }
    while scale > 1 && !fits(scale) {
        scale /= 10;
    }
    scale
}

/// Whether rising `ticks` of recordings tell their times: none beyond the range, and pauses so long that the rounding to a
/// tick is lost in them.
pub(crate) fn tell_times(ticks: &[u64]) -> bool {
    let are_apart = ticks.windows(2).all(|pair| pair[1].saturating_sub(pair[0]) as f64 >= APART);
    are_apart && ticks.last().is_none_or(|&last| last < i64::MAX as u64)
}

/// The tick of `time` [time] at `scale` ticks per unit; times beyond the range are its ends.
pub(crate) fn tick(time: f64, scale: u64) -> u64 {
    ((time * scale as f64).round() as u64).min(i64::MAX as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usually_a_nanosecond_is_a_tick() {
        assert_eq!(time_scale(500.0, 2.5), USUAL);
        assert_eq!(time_scale(f64::INFINITY, 0.0), USUAL);
        assert_eq!(time_scale(f64::NAN, f64::NAN), USUAL);
    }

    #[test]
    fn short_intervals_are_kept_apart_and_long_runs_fit() {
        assert_eq!(time_scale(1e-7, 1e-9), 1_000_000_000_000);
        assert_eq!(time_scale(1e12, 1e9), 1_000_000);
        assert_eq!(time_scale(1e-30, 1e-40), USUAL * USUAL);
        assert_eq!(time_scale(1e30, 1e20), 1);
        // Both wishes cannot be had: the range comes first.
        assert!(1e9 * time_scale(1e9, 1e-9) as f64 <= MOST);
    }

    #[test]
    fn ticks_tell_times_where_they_are_far_apart_and_in_range() {
        assert!(tell_times(&[]) && tell_times(&[7]) && tell_times(&[0, 1000, 2500]));
        assert!(!tell_times(&[0, 1000, 1000]) && !tell_times(&[0, 999]));
        assert!(!tell_times(&[0, 5000, i64::MAX as u64]));
    }

    #[test]
    fn ticks_never_leave_the_range() {
        assert_eq!(tick(1.5, USUAL), 1_500_000_000);
        assert_eq!(tick(-1.0, USUAL), 0);
        assert_eq!(tick(f64::NAN, USUAL), 0);
        assert_eq!(tick(1e300, USUAL), i64::MAX as u64);
    }
}
