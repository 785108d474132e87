//! The free flight of one grain through a step, with the walls it meets.

use super::Step;
use super::laws::{Laws, wall_place, wall_speed};
use crate::engine::report::Counts;
use crate::law::boundary::{AxisBoundary, Face, Wall, WallKind};
use crate::law::restitution::Restitution;
use crate::matter::grid::Grid;
use crate::matter::sort::REMOVED;
use crate::random::{Phase, PhaseStreams, Stream};
use crate::space::Vector;

/// Momentum given to the walls, `[axis][side]` [mass·length/time].
pub(crate) type WallMomentum<V> = [[V; 2]; 3];

/// The flights of one step.
#[derive(Clone, Debug)]
pub(crate) struct Flights<'a, V: Vector, R: Restitution> {
    laws: &'a Laws<V, R>,
    grid: &'a Grid<V>,
    start: f64,
    duration: f64,
    fall: V,
    gain: V,
    /// Inside this no wall can be met, at any phase of a vibration.
    safe_lower: V,
    safe_upper: V,
    wall_streams: PhaseStreams,
}

/// Where a flight leads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Flight<V> {
    pub(crate) position: V,
    pub(crate) velocity: V,
    /// Whether it led out through an open side.
    pub(crate) left: bool,
}

/// A meeting with a wall ahead.
struct Meeting<V> {
    axis: usize,
    side: usize,
    wall: Wall<V>,
    /// Time until it [time].
    after: f64,
}

impl<'a, V: Vector, R: Restitution> Flights<'a, V, R> {
    pub(crate) fn new(laws: &'a Laws<V, R>, grid: &'a Grid<V>, step: Step) -> Self {
        let Step { number, start, duration } = step;
        let reach = |axis: usize, side: usize| match laws.boundary.faces(axis).map(|faces| faces[side]) {
            Some(Face::Wall(Wall { kind: WallKind::Vibrating { amplitude, .. }, .. })) => 2.0 * amplitude,
            _ => 0.0,
        };
        Flights {
            laws,
            grid,
            start,
            duration,
            fall: laws.gravity * (0.5 * duration * duration),
            gain: laws.gravity * duration,
            safe_lower: V::from_fn(|a| grid.origin()[a] + reach(a, 0)),
            safe_upper: V::from_fn(|a| grid.end()[a] - reach(a, 1)),
            wall_streams: laws.streams.at(number, Phase::Wall),
        }
    }

    /// Where a grain gets that meets nothing, and its velocity there.
    #[inline(always)]
    pub(crate) fn free(&self, position: V, velocity: V) -> (V, V) {
        (position + velocity * self.duration + self.fall, velocity + self.gain)
    }

    /// Whether a free flight that ends in `there` is all there is to it: no edge is near.
    #[inline(always)]
    pub(crate) fn is_free(&self, there: V) -> bool {
        let mut inside = true;
        for axis in 0..V::DIMENSION {
            inside &= there[axis] >= self.safe_lower[axis] && there[axis] < self.safe_upper[axis];
        }
        inside
    }

    /// The flight of grain `id` from `position` with `velocity`; what walls gain is added to `momentum`.
    #[inline(always)]
    pub(crate) fn fly(&self, position: V, velocity: V, id: u32, momentum: &mut WallMomentum<V>) -> Flight<V> {
        let (there, gained) = self.free(position, velocity);
        if self.is_free(there) {
            return Flight { position: there, velocity: gained, left: false };
        }
        self.fly_to_the_edge(position, velocity, id, momentum)
    }

    /// Moves one grain that comes near an edge; returns the cell it goes to.
    #[cold]
    #[inline(never)]
    pub(crate) fn meet_the_edge(
        &self,
        (position, velocity, id): (&mut V, &mut V, u32),
        counts: &mut Counts<V>,
    ) -> u32 {
        let flight = self.fly_to_the_edge(*position, *velocity, id, &mut counts.wall_momentum);
        (*position, *velocity) = (flight.position, flight.velocity);
        if flight.left {
            counts.removed += 1;
            return REMOVED;
        }
        self.cell_of(flight.position)
    }

    /// The cell that holds `position`.
    #[inline(always)]
    pub(crate) fn cell_of(&self, position: V) -> u32 {
        self.grid.cell_of(position)
    }

    /// The same for a position that is free ([`Flights::is_free`]), and so inside the box.
    #[inline(always)]
    pub(crate) fn cell_inside(&self, position: V) -> u32 {
        self.grid.cell_inside(position)
    }

    /// Whether `position` lies beyond an open side.
    pub(crate) fn is_out(&self, position: V) -> bool {
        (0..V::DIMENSION).any(|axis| {
            let x = position[axis];
            self.laws.boundary.faces(axis).is_some_and(|[below, above]| {
                (below == Face::Open && x < self.grid.origin()[axis])
                    || (above == Face::Open && x >= self.grid.end()[axis])
            })
        })
    }

    /// A flight that ends near or beyond an edge: wraps, walls and open sides.
    ///
    /// At most one hit per axis and step; a second one on the same axis brings the grain to rest at
    /// the wall (an even number of reversals would make a rough floor frictionless). The wall then carries it for the
    /// rest of the step: what gravity would give the grain along that axis, m g t, goes into the wall.
    #[cold]
    #[inline(never)]
    pub(crate) fn fly_to_the_edge(
        &self,
        position: V,
        velocity: V,
        id: u32,
        momentum: &mut WallMomentum<V>,
    ) -> Flight<V> {
        if !(position.is_finite() && velocity.is_finite()) {
            // Walls would give it a place again. A velocity that is no number is seen at the end of the step.
            return Flight { position, velocity: V::from_fn(|_| f64::NAN), left: false };
        }
        let mut grain = Flight { position, velocity, left: false };
        let mut left = self.duration;
        let mut hits = [false; 3];
        let mut resting = [false; 3];
        let mut random = None;
        while let Some(meeting) = self.next_meeting(&grain, left, &resting) {
            self.drift(&mut grain, meeting.after, &resting);
            left -= meeting.after;
            let before = grain.velocity;
            if hits[meeting.axis] {
                self.come_to_rest(&mut grain, &meeting);
                resting[meeting.axis] = true;
            } else {
                hits[meeting.axis] = true;
                let random = random.get_or_insert_with(|| self.wall_streams.stream(u64::from(id)));
                self.reflect(&mut grain, &meeting, self.duration - left, random);
            }
            let carried = if resting[meeting.axis] { self.laws.gravity[meeting.axis] * left } else { 0.0 };
            let given = before - grain.velocity + V::along(meeting.axis, carried);
            momentum[meeting.axis][meeting.side] += given * self.laws.grain.mass;
        }
        self.drift(&mut grain, left, &resting);
        self.settle_at_the_edges(&mut grain);
        grain
    }

    /// Free flight for `duration`, except along axes on which the grain rests.
    fn drift(&self, grain: &mut Flight<V>, duration: f64, resting: &[bool; 3]) {
        for axis in (0..V::DIMENSION).filter(|&axis| !resting[axis]) {
            let g = self.laws.gravity[axis];
            grain.position[axis] += grain.velocity[axis] * duration + 0.5 * g * duration * duration;
            grain.velocity[axis] += g * duration;
        }
    }

    /// The first wall that the grain ends up behind within the time `left`.
    fn next_meeting(&self, grain: &Flight<V>, left: f64, resting: &[bool; 3]) -> Option<Meeting<V>> {
        let elapsed = self.duration - left;
        let mut first: Option<Meeting<V>> = None;
        for (axis, side, wall) in self.laws.boundary.walls().filter(|&(axis, ..)| !resting[axis]) {
            let Some(after) = self.time_to_wall(grain, axis, side, &wall, elapsed, left) else { continue };
            if first.as_ref().is_none_or(|meeting| after < meeting.after) {
                first = Some(Meeting { axis, side, wall, after });
            }
        }
        first
    }

    /// When the grain passes the wall for good within `left`, if it does.
    fn time_to_wall(
        &self,
        grain: &Flight<V>,
        axis: usize,
        side: usize,
        wall: &Wall<V>,
        elapsed: f64,
        left: f64,
    ) -> Option<f64> {
        let inward = if side == 0 { 1.0 } else { -1.0 };
        let now = self.start + elapsed;
        let (x, v, g) = (grain.position[axis], grain.velocity[axis], self.laws.gravity[axis]);
        let place = |after: f64| wall_place(self.grid, axis, side == 1, wall, now + after);
        let clearance = |after: f64| inward * (x + v * after + 0.5 * g * after * after - place(after));
        if clearance(left) >= 0.0 {
            return None;
        }
        if clearance(0.0) <= 0.0 {
            return Some(0.0);
        }
        if matches!(wall.kind, WallKind::Vibrating { .. }) {
            return Some(bisect(clearance, left));
        }
        Some(first_root(inward * (x - place(0.0)), inward * v, 0.5 * inward * g).clamp(0.0, left))
    }

    /// The wall's law: normal velocity times −r_w in the wall's frame, tangential velocity by kind.
    fn reflect(&self, grain: &mut Flight<V>, meeting: &Meeting<V>, elapsed: f64, random: &mut Stream) {
        let Meeting { axis, side, wall, .. } = meeting;
        let now = self.start + elapsed;
        grain.position[*axis] = wall_place(self.grid, *axis, *side == 1, wall, now);
        let wall_speed = wall_speed(wall, now);
        let normal = grain.velocity[*axis];
        let approaching = if *side == 0 { normal < wall_speed } else { normal > wall_speed };
        let reversed = match wall.kind {
            WallKind::Smooth | WallKind::Vibrating { .. } => None,
            WallKind::Rough { velocity } => Some(velocity * 2.0 - grain.velocity),
            WallKind::Statistical { reversal_probability } => {
                (random.uniform() < reversal_probability).then(|| -grain.velocity)
            }
        };
        grain.velocity = reversed.unwrap_or(grain.velocity);
        grain.velocity[*axis] =
            if approaching { wall_speed - wall.restitution * (normal - wall_speed) } else { normal };
    }

    /// A second hit in one step: the grain stays at the wall and moves with it.
    fn come_to_rest(&self, grain: &mut Flight<V>, meeting: &Meeting<V>) {
        let end = self.start + self.duration;
        let Meeting { axis, side, wall, .. } = meeting;
        grain.position[*axis] = wall_place(self.grid, *axis, *side == 1, wall, end);
        grain.velocity[*axis] = wall_speed(wall, end);
    }

    /// Wraps periodic axes, notices open sides, takes rounding off at walls.
    fn settle_at_the_edges(&self, grain: &mut Flight<V>) {
        grain.left = self.is_out(grain.position);
        for axis in 0..V::DIMENSION {
            let (lower, upper) = (self.grid.origin()[axis], self.grid.end()[axis]);
            match self.laws.boundary.axes[axis] {
                AxisBoundary::Periodic => self.grid.wrap(&mut grain.position, axis),
                AxisBoundary::Faces { lower: below, upper: above } => {
                    if below != Face::Open {
                        grain.position[axis] = grain.position[axis].max(lower);
                    }
                    if above != Face::Open {
                        grain.position[axis] = grain.position[axis].min(upper);
                    }
                }
            }
        }
    }
}

/// The first s ≥ 0 at which c + b s + a s² = 0, for c > 0 and a value that is negative later on;
/// in the form that does not cancel.
fn first_root(c: f64, b: f64, a: f64) -> f64 {
    let root = (b * b - 4.0 * a * c).max(0.0).sqrt();
    if b <= 0.0 {
        let denominator = root - b;
        if denominator > 0.0 { 2.0 * c / denominator } else { 0.0 }
    } else {
        (-b - root) / (2.0 * a)
    }
}

/// A place where `clearance` turns from positive to negative between 0 and `end`.
fn bisect(clearance: impl Fn(f64) -> f64, end: f64) -> f64 {
    let (mut inside, mut outside) = (0.0, end);
    for _ in 0..64 {
        let middle = 0.5 * (inside + outside);
        if clearance(middle) > 0.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::boundary::Boundary;
    use crate::law::restitution::Constant;
    use crate::matter::grain::Grain;
    use crate::random::Streams;
    use glam::DVec2;

    fn wall(kind: WallKind<DVec2>, restitution: f64) -> Face<DVec2> {
        Face::Wall(Wall { restitution, kind })
    }

    fn laws(gravity: f64, lower: Face<DVec2>, upper: Face<DVec2>) -> Laws<DVec2, Constant> {
        let mut boundary = Boundary::periodic();
        boundary.axes[1] = AxisBoundary::Faces { lower, upper };
        Laws {
            grain: Grain { diameter: 1.0, mass: 2.0 },
            restitution: Constant(1.0),
            impacts: crate::law::impact::Impacts::UNIFORM,
            gravity: DVec2::new(0.0, -gravity),
            boundary,
            dense: None,
            streams: Streams::new(1),
            seed: 1,
        }
    }

    fn grid() -> Grid<DVec2> {
        Grid::new(DVec2::ZERO, DVec2::splat(10.0), &[5, 5], &[true, false])
    }

    fn fly(
        laws: &Laws<DVec2, Constant>,
        duration: f64,
        x: DVec2,
        v: DVec2,
    ) -> (Flight<DVec2>, WallMomentum<DVec2>) {
        let grid = grid();
        let mut momentum = WallMomentum::default();
        let flight =
            Flights::new(laws, &grid, Step { number: 0, start: 0.0, duration }).fly(x, v, 7, &mut momentum);
        (flight, momentum)
    }

    #[test]
    fn a_bounce_under_gravity_is_exact() {
        let laws = laws(1.0, wall(WallKind::Smooth, 0.5), Face::Open);
        let (end, momentum) = fly(&laws, 1.0, DVec2::new(1.0, 0.5), DVec2::new(0.3, -0.75));
        // y(s) = 0.5 − 0.75 s − s²/2 = 0 at s = 0.5, v = −1.25; back up with 0.625 for 0.5.
        assert!((end.position - DVec2::new(1.3, 0.1875)).length() < 1e-15);
        assert!((end.velocity - DVec2::new(0.3, 0.125)).length() < 1e-15);
        assert!((momentum[1][0] - DVec2::new(0.0, -2.0 * 1.875)).length() < 1e-15);
    }

    #[test]
    fn a_second_hit_comes_to_rest() {
        let laws = laws(1.0, wall(WallKind::Rough { velocity: DVec2::ZERO }, 0.5), Face::Open);
        let (end, momentum) = fly(&laws, 2.0, DVec2::new(1.0, 0.0), DVec2::new(0.3, -0.1));
        assert_eq!((end.position.y, end.velocity.y), (0.0, 0.0));
        // One reversal only: the grain goes back along the floor.
        assert!((end.position.x - 0.4).abs() < 1e-15 && end.velocity.x == -0.3);
        // The wall takes the momentum change of the grain and, all along, its weight: 2·(−0.1 − 1·2).
        assert!((momentum[1][0] - DVec2::new(2.0 * 0.6, -2.0 * 2.1)).length() < 1e-14);
    }

    #[test]
    fn a_wall_carries_the_grain_that_rests_on_it() {
        let floor = wall(WallKind::Smooth, 0.5);
        let (end, momentum) =
            fly(&laws(1.0, floor, Face::Open), 0.25, DVec2::new(1.0, 0.0), DVec2::new(0.3, 0.0));
        assert_eq!((end.position, end.velocity), (DVec2::new(1.075, 0.0), DVec2::new(0.3, 0.0)));
        // m g t on the floor.
        assert_eq!(momentum[1][0], DVec2::new(0.0, -2.0 * 0.25));
        // Hung from a ceiling by gravity that points upwards: the weight is the ceiling's.
        let (end, momentum) =
            fly(&laws(-1.0, Face::Open, floor), 0.25, DVec2::new(1.0, 10.0), DVec2::new(0.3, 0.0));
        assert_eq!(end.velocity, DVec2::new(0.3, 0.0));
        assert_eq!(momentum[1][1], DVec2::new(0.0, 2.0 * 0.25));
    }

    #[test]
    fn a_moving_rough_wall_turns_the_tangential_velocity() {
        let laws = laws(
            0.0,
            wall(WallKind::Rough { velocity: DVec2::new(0.5, 0.0) }, 1.0),
            wall(WallKind::Smooth, 1.0),
        );
        let (end, _) = fly(&laws, 1.0, DVec2::new(5.0, 0.25), DVec2::new(0.2, -1.0));
        assert!((end.velocity - DVec2::new(0.8, 1.0)).length() < 1e-15);
        assert!((end.position - DVec2::new(5.0 + 0.05 + 0.6, 0.75)).length() < 1e-15);
    }

    #[test]
    fn open_sides_let_go_and_periodic_ones_wrap() {
        let laws = laws(0.0, Face::Open, Face::Open);
        let (end, _) = fly(&laws, 1.0, DVec2::new(9.9, 0.5), DVec2::new(0.3, -1.0));
        assert!(end.left && (end.position.x - 0.2).abs() < 1e-14);
        let (end, _) = fly(&laws, 1.0, DVec2::new(9.9, 0.5), DVec2::new(0.3, 1.0));
        assert!(!end.left);
    }

    #[test]
    fn a_vibrating_floor_throws() {
        let kind = WallKind::Vibrating { amplitude: 0.5, frequency: 0.1 };
        let laws = laws(0.0, wall(kind, 1.0), Face::Open);
        // The floor's place is 0.5 on this grid; at t = 0 it rises with 2πAf.
        let (end, _) = fly(&laws, 0.1, DVec2::new(5.0, 0.5), DVec2::new(0.0, -0.1));
        let floor_speed = std::f64::consts::TAU * 0.05;
        assert!((end.velocity.y - (2.0 * floor_speed + 0.1)).abs() < 1e-12);
        assert!((end.position.y - (0.5 + 0.1 * end.velocity.y)).abs() < 1e-12);
    }
}
