//! Inelastic collapse: infinitely many collisions in a finite time, its cures and its detection.

use super::rules::Cure;
use crate::law::pair_collision::PairOfGrains;
use crate::random::Stream;
use crate::space::Vector;

/// Restitution of a collision under `cure`, and whether the cure has changed it.
///
/// The nominal `restitution` becomes 1 where the `normal_speed` [length/time] is below [`Cure::elastic_below`],
/// or where either partner has collided less than [`Cure::contact_time`] ago; `since_last` has the times since then
/// [time], `None` for a grain that has not collided yet (TC model, Luding and McNamara 1998; Simić 2017,
/// section 5.2).
#[inline]
pub(super) fn cured_restitution(
    cure: &Cure,
    restitution: f64,
    normal_speed: f64,
    since_last: [Option<f64>; 2],
) -> (f64, bool) {
    let slow = cure.elastic_below.is_some_and(|least| normal_speed < least);
    let soon = cure
        .contact_time
        .is_some_and(|contact_time| since_last.into_iter().flatten().any(|since| since < contact_time));
    if (slow || soon) && restitution < 1.0 { (1.0, true) } else { (restitution, false) }
}

/// Turns the relative velocity v₁₂ of two grains that have just collided by a random angle up to `largest_angle`
/// [radian], such that they still separate: by the angle drawn, else by its opposite, else not at all.
///
/// `separation` is x₂ − x₁. Momentum and energy stay; angular momentum does not. Returns the momentum that the
/// turn transfers along k, beside that of the collision [mass·length/time] (Simić 2017, section 5.2).
pub(super) fn turn_relative_velocity<V: Vector>(
    largest_angle: f64,
    pair: &PairOfGrains,
    separation: V,
    velocities: &mut [V; 2],
    random: &mut Stream,
) -> f64 {
    let relative = velocities[0] - velocities[1];
    let turns = relative.turns(largest_angle, random);
    let Some(turned) = turns.into_iter().find(|turned| turned.dot(separation) < 0.0) else {
        return 0.0;
    };
    let change = turned - relative;
    velocities[0] += change * pair.shares[0];
    velocities[1] -= change * pair.shares[1];
    -pair.reduced_mass * change.dot(separation) / separation.length()
}

/// Notices when one grain collides very often within next to no time.
///
/// A window of time begins with a collision and ends a given span later. Within it the watch remembers the grains
/// that have collided, at most [`CollapseWatch::GRAINS`] of them: those that have collided last. Only they can take part in
/// a collapse, since time stands still in one for all the others.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CollapseWatch {
    /// When the window began [time].
    start: f64,
    /// Grains with their counts of collisions before the window; the last to collide comes last.
    seen: Vec<(u32, u32)>,
}

impl CollapseWatch {
    /// So many collisions of one grain in a window are a collapse.
    pub(super) const COLLISIONS: u32 = 200;
    /// So many grains are remembered.
    pub(super) const GRAINS: usize = 64;

    /// A watch that has seen nothing.
    pub(super) fn new() -> Self {
        CollapseWatch { start: f64::NEG_INFINITY, seen: Vec::with_capacity(Self::GRAINS) }
    }

    /// Notes that grain `row` collides at time `now`, its own `counter` of collisions being at this number with
    /// this one. Returns the number of its collisions in the window of length `span` [time] if that makes a collapse.
    #[inline]
    pub(super) fn note(&mut self, row: u32, counter: u32, now: f64, span: f64) -> Option<u32> {
        if now - self.start > span {
            self.start = now;
            self.seen.clear();
        }
        let place = self.seen.iter().rposition(|&(seen, _)| seen == row);
        let before = match place {
            Some(place) => self.seen.remove(place).1,
            None => {
                if self.seen.len() == Self::GRAINS {
                    self.seen.remove(0);
                }
                counter.wrapping_sub(1)
            }
        };
        self.seen.push((row, before));
        let collisions = counter.wrapping_sub(before);
        (collisions >= Self::COLLISIONS).then_some(collisions)
    }

    /// The window as numbers: when it began, then rows and counts of the grains in it.
    pub(super) fn state(&self) -> (f64, impl Iterator<Item = u32>) {
        (self.start, self.seen.iter().flat_map(|&(row, before)| [row, before]))
    }

    /// The window that began at `start` [time], with these grains in it.
    pub(super) fn restored(start: f64, seen: Vec<(u32, u32)>) -> Self {
        CollapseWatch { start, seen }
    }

    /// Whether this is the watch over a world of so many `rows`.
    pub(super) fn is_over(&self, rows: usize) -> bool {
        !self.start.is_nan()
            && self.seen.len() <= Self::GRAINS
            && self.seen.iter().all(|&(row, _)| (row as usize) < rows)
    }

    /// Forgets the window: rows have been renumbered.
    pub(super) fn forget(&mut self) {
        *self = Self::new();
    }
}

impl Default for CollapseWatch {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::pair_collision::Meeting;
    use crate::matter::grain::Grain;
    use crate::random::{Phase, Streams};
    use glam::{DVec2, DVec3};

    #[test]
    fn slow_collisions_and_collisions_in_close_succession_are_elastic() {
        let none = [None, None];
        assert_eq!(cured_restitution(&Cure::default(), 0.8, 0.0, [Some(0.0); 2]), (0.8, false));
        let slow = Cure { elastic_below: Some(0.1), ..Cure::default() };
        assert_eq!(cured_restitution(&slow, 0.8, 0.099, none), (1.0, true));
        assert_eq!(cured_restitution(&slow, 0.8, 0.1, none), (0.8, false));
        assert_eq!(cured_restitution(&slow, 1.0, 0.01, none), (1.0, false));
        let soon = Cure { contact_time: Some(1e-3), ..Cure::default() };
        assert_eq!(cured_restitution(&soon, 0.8, 0.01, none), (0.8, false));
        assert_eq!(cured_restitution(&soon, 0.8, 9.0, [None, Some(9e-4)]), (1.0, true));
        assert_eq!(cured_restitution(&soon, 0.8, 9.0, [Some(0.0), Some(5.0)]), (1.0, true));
        assert_eq!(cured_restitution(&soon, 0.8, 9.0, [Some(1e-3), Some(1.0)]), (0.8, false));
        let both = Cure { elastic_below: Some(0.1), ..soon };
        assert_eq!(cured_restitution(&both, 0.8, 0.05, [Some(1.0); 2]), (1.0, true));
        assert_eq!(cured_restitution(&both, 0.8, 0.5, [Some(1e-4); 2]), (1.0, true));
        assert_eq!(cured_restitution(&both, 0.8, 0.5, [Some(1.0); 2]), (0.8, false));
    }

    fn turning<V: Vector>() {
        let mut random = Streams::new(6).at(0, Phase::Collisions).stream(0);
        let grains = [Grain { diameter: 1.0, mass: 1.5 }, Grain { diameter: 1.4, mass: 4.0 }];
        let pair = PairOfGrains::of(grains[0], grains[1]);
        let (mut turned, mut left) = (0, 0);
        for k in 0..3000 {
            let mut vector = || V::from_fn(|_| random.gaussian());
            let (separation, mut velocities) = (vector(), [vector(), vector()]);
            let meeting = Meeting::of(separation, &velocities);
            if meeting.approach <= 0.0 {
                continue;
            }
            let restitution = [0.0, 1e-3, 0.3, 0.9][k % 4];
            let passed = meeting.collide_smooth(&pair, restitution, &mut velocities);
            let energy =
                |v: [V; 2]| grains[0].mass * v[0].length_squared() + grains[1].mass * v[1].length_squared();
            let momentum = |v: [V; 2]| v[0] * grains[0].mass + v[1] * grains[1].mass;
            let before = velocities;
            let extra = turn_relative_velocity(0.2, &pair, separation, &mut velocities, &mut random);
            assert!((momentum(velocities) - momentum(before)).length() < 1e-13);
            assert!((energy(velocities) / energy(before) - 1.0).abs() < 1e-14);
            let rate = (velocities[0] - velocities[1]).dot(separation);
            if velocities == before {
                left += 1;
                assert_eq!(extra, 0.0);
            } else {
                turned += 1;
                assert!(rate < 1e-15);
                let (was, is) = (before[0] - before[1], velocities[0] - velocities[1]);
                let cosine = was.dot(is) / was.length_squared();
                assert!(cosine > libm::cos(0.2) - 1e-12 && cosine < 1.0);
            }
            // What is transferred along k in all takes v₁₂·k from what it was to what it is.
            let normal_change = (meeting.approach - rate) / separation.length();
            assert!((passed + extra - pair.reduced_mass * normal_change).abs() < 1e-13);
        }
        assert!(turned > 1000, "{turned} {left}");
    }

    #[test]
    fn a_turn_keeps_momentum_and_energy_and_separates() {
        turning::<DVec2>();
        turning::<DVec3>();
    }

    #[test]
    fn grains_that_would_meet_again_are_left_alone() {
        let grain = Grain { diameter: 1.0, mass: 1.0 };
        let pair = PairOfGrains::of(grain, grain);
        let mut random = Streams::new(6).at(0, Phase::Collisions).stream(1);
        // At rest relative to each other, and approaching head on: no turn up to 0.1 separates them.
        for approach in [0.0, 1.0] {
            let mut velocities = [DVec3::X * approach, DVec3::ZERO];
            let before = velocities;
            assert_eq!(turn_relative_velocity(0.1, &pair, DVec3::X, &mut velocities, &mut random), 0.0);
            assert_eq!(velocities, before);
        }
        // Sliding along each other: one of the two turns separates them in 2D.
        for _ in 0..100 {
            let mut velocities = [DVec2::Y, -DVec2::Y];
            let passed = turn_relative_velocity(0.1, &pair, DVec2::X, &mut velocities, &mut random);
            assert!(passed > 0.0 && velocities[0].x < 0.0);
        }
    }

    #[test]
    fn two_hundred_collisions_in_a_window_are_a_collapse() {
        let mut watch = CollapseWatch::new();
        // Grain 7 has collided 1000 times before; three of its neighbours take part.
        let mut told = None;
        for k in 1..=300_u32 {
            let now = 5.0 + f64::from(k) * 1e-12;
            watch.note(k % 3, 10 + k / 3, now, 1e-9);
            let found = watch.note(7, 1000 + k, now, 1e-9);
            assert_eq!(found.is_some(), k >= 200);
            told = told.or(found);
        }
        assert_eq!(told, Some(200));
    }

    #[test]
    fn the_same_collisions_spread_over_windows_are_none() {
        let mut watch = CollapseWatch::new();
        for k in 1..=10_000_u32 {
            assert_eq!(watch.note(7, k, f64::from(k) * 1e-9, 150e-9), None);
        }
        let mut watch = CollapseWatch::new();
        for k in 1..=199_u32 {
            assert_eq!(watch.note(7, k, 1.0, 1e-9), None);
        }
        watch.forget();
        assert_eq!(watch.note(7, 200, 1.0, 1e-9), None);
    }

    /// Many grains collide in the window before the collapse of two others stops the time.
    #[test]
    fn a_crowd_does_not_hide_a_collapse() {
        let mut watch = CollapseWatch::new();
        for row in 0..1000 {
            assert_eq!(watch.note(row, 50, 1.0, 1e-9), None);
        }
        let found = (1..=200).find(|&k| {
            watch.note(5000, k, 1.0, 1e-9);
            watch.note(5001, 40 + k, 1.0, 1e-9).is_some()
        });
        assert_eq!(found, Some(200));
        // A grain that the crowd has pushed out is counted afresh.
        assert_eq!(watch.note(3, 900, 1.0, 1e-9), None);
        assert!(watch.seen.len() == CollapseWatch::GRAINS);
    }
}
