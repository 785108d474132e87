//! What a step did, and the sums over all steps.

use crate::space::Vector;

/// What one step did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReport<V> {
    /// Steps made: 1, or 0 for engines without steps.
    pub steps: u64,
    /// Length of the step [time].
    pub duration: f64,
    /// Whether the cap on the step shortened it.
    pub capped: bool,
    /// What happened in it.
    pub counts: Counts<V>,
    /// What events there were, where the engine has events.
    pub events: EventCounts,
    /// Collisions in the step up to the departure of each grain that left, of engines without steps; empty for others.
    pub removals: Vec<u64>,
}

/// Bins of the histogram of impact parameters, over 0 ≤ |b|/d ≤ 1.
pub const IMPACT_BINS: usize = 40;

/// What the events of an event-driven engine were.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EventCounts {
    /// Events of every kind.
    pub all: u64,
    /// Hits on walls.
    pub wall_hits: u64,
    /// Crossings from cell to cell.
    pub crossings: u64,
    /// Renewals of neighbour lists.
    pub list_renewals: u64,
    /// Collisions called off because the partner had met another grain before.
    pub annulled: u64,
    /// Collisions, of pairs and with walls, that a cure of inelastic collapse has changed.
    pub cured: u64,
    /// Collisions of pairs by impact parameter |b|/d, `[bin]`.
    pub impacts: [u64; IMPACT_BINS],
}

impl Default for EventCounts {
    fn default() -> Self {
        EventCounts {
            all: 0,
            wall_hits: 0,
            crossings: 0,
            list_renewals: 0,
            annulled: 0,
            cured: 0,
            impacts: [0; IMPACT_BINS],
        }
    }
}

impl EventCounts {
    /// Adds what `other` counted.
    pub fn add(&mut self, other: &Self) {
        self.all += other.all;
        self.wall_hits += other.wall_hits;
        self.crossings += other.crossings;
        self.list_renewals += other.list_renewals;
        self.annulled += other.annulled;
        self.cured += other.cured;
        for (mine, theirs) in self.impacts.iter_mut().zip(&other.impacts) {
            *mine += theirs;
        }
    }
}

/// Countable and summable things that steps do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts<V> {
    /// Collisions of pairs of grains.
    pub collisions: u64,
    /// Candidate pairs that were looked at.
    pub candidates: u64,
    /// Collisions of pairs of cells.
    pub cell_collisions: u64,
    /// Moves that were rejected for lack of room.
    pub rejected_moves: u64,
    /// Grains that left through an open side.
    pub removed: u64,
    /// Momentum given to the walls, `[axis][side]` [mass·length/time].
    pub wall_momentum: [[V; 2]; 3],
    /// Σ p·s: momentum that displacements, cell collisions and collisions of hard grains carry, times the way
    /// [mass·length²/time]; over D·V·time it is the collisional pressure.
    pub carried_momentum: f64,
}

impl<V: Vector> Counts<V> {
    /// Adds what `other` counted.
    pub fn add(&mut self, other: &Self) {
        self.collisions += other.collisions;
        self.candidates += other.candidates;
        self.cell_collisions += other.cell_collisions;
        self.rejected_moves += other.rejected_moves;
        self.removed += other.removed;
        self.carried_momentum += other.carried_momentum;
        for (mine, theirs) in self.wall_momentum.iter_mut().zip(&other.wall_momentum) {
            mine[0] += theirs[0];
            mine[1] += theirs[1];
        }
    }
}

/// Sums since the start of the run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Totals<V> {
    /// Steps made.
    pub steps: u64,
    /// Steps that the cap shortened.
    pub steps_capped: u64,
    /// Grains poured.
    pub poured: u64,
    /// Σ 2ΔC/N, collisions per particle.
    pub collisions_per_particle: f64,
    /// Σ N over steps: particle-steps.
    pub particle_steps: u64,
    /// Everything that steps count.
    pub counts: Counts<V>,
    /// The events, where the engine has events.
    pub events: EventCounts,
    /// From where an engine without steps counts collisions per particle.
    pub since: Since,
}

/// When the number of grains last changed: from here on collisions per particle are counted anew, so that they
/// do not depend on where an engine without steps was stopped.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Since {
    /// Grains from then on.
    pub grains: u64,
    /// Collisions up to then.
    pub collisions: u64,
    /// Collisions per particle up to then.
    pub collisions_per_particle: f64,
}

/// Collisions that no run will see, and the last number up to which all are told apart as floating-point ones.
const BEYOND_REACH: u64 = 1 << 53;

impl<V: Vector> Totals<V> {
    /// Adds one step of a gas of `grains` grains.
    pub fn add(&mut self, report: &StepReport<V>, grains: usize) {
        self.steps += report.steps;
        self.steps_capped += u64::from(report.capped);
        self.particle_steps += report.steps * grains as u64;
        if report.steps == 0 {
            self.count_per_particle(report, grains);
        } else if grains > 0 {
            self.collisions_per_particle += 2.0 * report.counts.collisions as f64 / grains as f64;
        }
        self.counts.add(&report.counts);
        self.events.add(&report.events);
    }

    /// Counts collisions per particle up to the departure of each grain, then up to the end of what `report` tells.
    fn count_per_particle(&mut self, report: &StepReport<V>, grains: usize) {
        let before = self.counts.collisions;
        let places = report.removals.iter().chain([&report.counts.collisions]);
        for (left, collisions) in places.enumerate() {
            let further = before + collisions - self.counts.collisions;
            self.since = self.since_change(grains - left);
            self.collisions_per_particle = self.per_particle_after(further, grains - left);
            self.counts.collisions += further;
        }
        // They are counted with everything else.
        self.counts.collisions = before;
    }

    /// From where collisions of a gas of `grains` grains count: from now on, if their number is new.
    fn since_change(&self, grains: usize) -> Since {
        if self.since.grains == grains as u64 {
            return self.since;
        }
        Since {
            grains: grains as u64,
            collisions: self.counts.collisions,
            collisions_per_particle: self.collisions_per_particle,
        }
    }

    /// Collisions per particle after so many `further` collisions of `grains` grains in an engine without steps.
    pub fn per_particle_after(&self, further: u64, grains: usize) -> f64 {
        let since = self.since_change(grains);
        if grains == 0 {
            return since.collisions_per_particle;
        }
        let collisions = self.counts.collisions - since.collisions + further;
        since.collisions_per_particle + 2.0 * collisions as f64 / grains as f64
    }

    /// The fewest further collisions of `grains` grains, one at least, after which `is_reached` holds of the
    /// collisions per particle; `goal` is about where that is.
    pub fn collisions_until(&self, grains: usize, goal: f64, is_reached: impl Fn(f64) -> bool) -> u64 {
        if grains == 0 || !goal.is_finite() {
            return u64::MAX;
        }
        let missing = (0.5 * (goal - self.collisions_per_particle) * grains as f64).ceil();
        if missing >= BEYOND_REACH as f64 {
            return BEYOND_REACH;
        }
        let mut further = missing.max(1.0) as u64;
        let is_enough = |further: u64| is_reached(self.per_particle_after(further, grains));
        while further > 1 && is_enough(further - 1) {
            further -= 1;
        }
        while further < BEYOND_REACH && !is_enough(further) {
            further += 1;
        }
        further
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    fn collided(collisions: u64) -> StepReport<DVec2> {
        StepReport { counts: Counts { collisions, ..Counts::default() }, ..StepReport::default() }
    }

    #[test]
    fn where_an_engine_without_steps_stops_does_not_matter() {
        let (mut whole, mut cut) = (Totals::default(), Totals::default());
        whole.add(&collided(1000), 7);
        whole.add(&collided(300), 11);
        for _ in 0..1000 {
            cut.add(&collided(1), 7);
        }
        for _ in 0..100 {
            cut.add(&collided(3), 11);
        }
        assert_eq!(whole, cut);
        assert!((whole.collisions_per_particle - (2000.0 / 7.0 + 600.0 / 11.0)).abs() < 1e-12);
    }

    #[test]
    fn grains_that_leave_are_not_counted_from_then_on() {
        let (mut whole, mut cut) = (Totals::default(), Totals::default());
        whole.add(&StepReport { removals: vec![40, 40, 70], ..collided(100) }, 9);
        let leaves =
            |collisions, left: usize| StepReport { removals: vec![collisions; left], ..collided(collisions) };
        cut.add(&collided(10), 9);
        cut.add(&leaves(30, 2), 9);
        cut.add(&collided(5), 7);
        cut.add(&leaves(25, 1), 7);
        cut.add(&collided(30), 6);
        assert_eq!(whole, cut);
        let expected = 2.0 * (40.0 / 9.0 + 30.0 / 7.0 + 30.0 / 6.0);
        assert!((whole.collisions_per_particle - expected).abs() < 1e-12);
    }

    #[test]
    fn the_collisions_that_are_missing_are_exact() {
        let mut totals = Totals::default();
        totals.add(&collided(5), 9);
        for k in 1..400 {
            let place = f64::from(k) / 400.0;
            let is_reached = |per_particle: f64| per_particle / 31.7 >= place;
            let missing = totals.collisions_until(9, place * 31.7, is_reached);
            assert!(is_reached(totals.per_particle_after(missing, 9)));
            assert!(missing == 1 || !is_reached(totals.per_particle_after(missing - 1, 9)));
        }
        assert_eq!(totals.collisions_until(0, 1.0, |_| true), u64::MAX);
        // A limit that is never reached is not looked for one collision after the other.
        assert_eq!(totals.collisions_until(9, 1e30, |per_particle| per_particle >= 1e30), BEYOND_REACH);
    }
}
