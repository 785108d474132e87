//! Simulated time, summed so that millions of steps lose nothing.

/// A compensated sum of time steps (Kahan 1965).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Clock {
    time: f64,
    compensation: f64,
}

impl Clock {
    /// A clock that shows `time`, with the rounding `compensation` it had when it was saved.
    pub fn restored(time: f64, compensation: f64) -> Self {
        Clock { time, compensation }
    }

    /// The time shown [time].
    pub fn time(self) -> f64 {
        self.time
    }

    /// What rounding has taken from the sum so far; part of a saved state.
    pub fn compensation(self) -> f64 {
        self.compensation
    }

    /// Moves on by `duration` [time].
    pub fn advance(&mut self, duration: f64) {
        let increment = duration - self.compensation;
        let sum = self.time + increment;
        self.compensation = (sum - self.time) - increment;
        self.time = sum;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_small_steps_add_up() {
        let mut clock = Clock::restored(1e6, 0.0);
        for _ in 0..1_000_000 {
            clock.advance(1e-7);
        }
        assert!((clock.time() - (1e6 + 0.1)).abs() < 2e-10);
    }
}
