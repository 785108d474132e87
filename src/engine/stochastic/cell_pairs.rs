//! Pair collisions inside one cell (Nanbu's form of DSMC; Müller 2001, section 2.4.1).

use super::Step;
use super::laws::Laws;
use super::rules::Transfer;
use super::tally::Tally;
use crate::law::restitution::Restitution;
use crate::random::{Phase, PhaseStreams, Stream};
use crate::space::Vector;

/// Pair collisions of one step, the same for all cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairCollisions<R> {
    restitution: R,
    mass: f64,
    /// σ τ / (2 V_c): candidates per ordered pair and unit of relative speed.
    candidates_per_speed: f64,
    /// σ/(2 V_c) times the mean relative speed at unit thermal speed.
    rate_per_speed: f64,
    displacement: Displacement,
    streams: PhaseStreams,
}

/// Along what a collision displaces its partners, and how far.
#[derive(Clone, Copy, Debug)]
enum Displacement {
    None,
    MomentumChange { distance: f64 },
    RelativeVelocity { distance: f64 },
}

/// A grain pair that has just collided and the way its first partner should be displaced;
/// the second goes the opposite way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Displaced<V> {
    /// Places of the partners inside the cell.
    pub(crate) pair: (usize, usize),
    /// Displacement of the first partner [length].
    pub(crate) shift: V,
}

/// The box in velocity space that holds all velocities of a cell. Its diagonal bounds their relative speeds.
struct SpeedBound<V> {
    /// One of the velocities: the box is kept relative to it.
    pivot: V,
    lowest: V,
    highest: V,
    /// The diagonal, squared [length²/time²].
    square: f64,
}

impl<R: Restitution> PairCollisions<R> {
    pub(crate) fn new<V: Vector>(laws: &Laws<V, R>, cell_volume: f64, step: Step, phase: Phase) -> Self {
        let per_pair = V::cross_section(laws.grain.diameter) / (2.0 * cell_volume);
        PairCollisions {
            restitution: laws.restitution,
            mass: laws.grain.mass,
            candidates_per_speed: per_pair * step.duration,
            rate_per_speed: per_pair * V::MEAN_RELATIVE_SPEED,
            displacement: Displacement::of(laws),
            streams: laws.streams.at(step.number, phase),
        }
    }

    /// Collides the grains of `cell`, whose Enskog factor is `enskog_factor` χ. `displace` is told of
    /// every collision that should displace its partners, and says whether it did.
    ///
    /// M = χ N(N − 1) σ v_max τ/(2V_c) candidates, rounded at random; a pair collides with
    /// probability |v_i − v_j|/v_max (Müller 2001, 2.34; the test of 2.38 is printed the wrong way round).
    #[inline]
    pub(crate) fn collide<V: Vector>(
        &self,
        cell: u32,
        enskog_factor: f64,
        velocities: &mut [V],
        tally: &mut Tally<V>,
        mut displace: impl FnMut(Displaced<V>, &[V]) -> bool,
    ) {
        let grains = velocities.len() as u32;
        if grains < 2 {
            return;
        }
        let (mut bound, sum_of_squares) = SpeedBound::of(velocities);
        if !sum_of_squares.is_finite() {
            // Endless speeds would mean endless candidates; the end of the step says what is wrong.
            return;
        }
        let pairs = enskog_factor * f64::from(grains) * f64::from(grains - 1);
        tally.collision_rate += self.expected_rate::<V>(pairs, grains, sum_of_squares);
        let mut random = self.streams.stream(u64::from(cell));
        let mut candidates = random.round(pairs * self.candidates_per_speed * bound.square.sqrt());
        while candidates > 0 {
            candidates -= 1;
            tally.counts.candidates += 1;
            let (pair, z) = random.pair_and_uniform(grains);
            let relative = velocities[pair.0] - velocities[pair.1];
            let square = relative.length_squared();
            if square <= z * z * bound.square {
                continue;
            }
            tally.counts.collisions += 1;
            let (change, after) = self.exchange(pair, relative, velocities, &mut random);
            if let Some(shift) = self.displacement.shift(change, after)
                && displace(Displaced { pair, shift }, velocities)
            {
                tally.counts.carried_momentum += self.mass * after.dot(shift);
            }
            let growth = bound.raise(velocities[pair.0]).max(bound.raise(velocities[pair.1]));
            if growth > 1.0 && candidates > 0 {
                candidates = random.round(candidates as f64 * growth);
            }
        }
    }

    /// Expected collisions per time in a cell with these `velocities` [1/time].
    pub(crate) fn rate<V: Vector>(&self, enskog_factor: f64, velocities: &[V]) -> f64 {
        let grains = velocities.len() as u32;
        if grains < 2 {
            return 0.0;
        }
        let pairs = enskog_factor * f64::from(grains) * f64::from(grains - 1);
        self.expected_rate::<V>(pairs, grains, SpeedBound::of(velocities).1)
    }

    /// From the unbiased temperature of the cell, Σ|v − v_c|²/(D(N − 1)) per mass.
    #[inline(always)]
    fn expected_rate<V: Vector>(&self, pairs: f64, grains: u32, sum_of_squares: f64) -> f64 {
        let thermal_square = sum_of_squares / (V::DIMENSION as f64 * f64::from(grains - 1));
        pairs * self.rate_per_speed * thermal_square.sqrt()
    }

    /// Exchanges momentum along a random contact normal; the normal relative velocity becomes
    /// −r times itself. Returns the change of the first velocity and the relative velocity afterwards.
    #[inline(always)]
    fn exchange<V: Vector>(
        &self,
        pair: (usize, usize),
        relative: V,
        velocities: &mut [V],
        random: &mut Stream,
    ) -> (V, V) {
        let elastic = V::exchange(relative, random);
        let change = elastic * (0.5 * (1.0 + self.restitution.at(elastic.length())));
        velocities[pair.0] += change;
        velocities[pair.1] -= change;
        (change, relative + change * 2.0)
    }
}

impl Displacement {
    fn of<V: Vector, R: Restitution>(laws: &Laws<V, R>) -> Self {
        let diameter = laws.grain.diameter;
        match laws.dense {
            None => Displacement::None,
            Some(dense) => match dense.transfer {
                Transfer::MomentumChange => Displacement::MomentumChange { distance: diameter },
                Transfer::Corrected => {
                    Displacement::RelativeVelocity { distance: dense.displacement_ratio * diameter }
                }
            },
        }
    }

    /// The way of the first partner, whose velocity has changed by `change`.
    #[inline(always)]
    fn shift<V: Vector>(self, change: V, after: V) -> Option<V> {
        let (direction, distance) = match self {
            Displacement::None => return None,
            Displacement::MomentumChange { distance } => (change, distance),
            Displacement::RelativeVelocity { distance } => (after, distance),
        };
        let length = direction.length();
        (length > 0.0).then(|| direction * (distance / length))
    }
}

impl<V: Vector> SpeedBound<V> {
    /// The bound, and the sum of squared deviations from the mean.
    #[inline(always)]
    fn of(velocities: &[V]) -> (Self, f64) {
        let pivot = velocities[0];
        let (mut lowest, mut highest) = (V::ZERO, V::ZERO);
        let (mut sum, mut squares) = (V::ZERO, 0.0);
        for &velocity in &velocities[1..] {
            let relative = velocity - pivot;
            lowest = lowest.lower(relative);
            highest = highest.upper(relative);
            sum += relative;
            squares += relative.length_squared();
        }
        let about_mean = squares - sum.length_squared() / velocities.len() as f64;
        let square = (highest - lowest).length_squared();
        (SpeedBound { pivot, lowest, highest, square }, if about_mean < 0.0 { 0.0 } else { about_mean })
    }

    /// Makes the bound hold for `velocity` too. Returns by which factor it grew, so that
    /// candidates still to come can be multiplied: acceptance never exceeds one.
    #[inline(always)]
    fn raise(&mut self, velocity: V) -> f64 {
        let relative = velocity - self.pivot;
        let (lowest, highest) = (self.lowest.lower(relative), self.highest.upper(relative));
        if lowest == self.lowest && highest == self.highest {
            return 1.0;
        }
        let before = self.square;
        (self.lowest, self.highest) = (lowest, highest);
        self.square = (highest - lowest).length_squared();
        (self.square / before).sqrt()
    }
}
