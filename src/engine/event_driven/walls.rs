//! The sides of the box as the dynamics sees them.

use super::body::Face;
use super::contact::{FlightOverVibration, plane_contact, vibrating_contact};
use super::laws::Laws;
use crate::law::boundary::{Face as Side, Wall, WallKind};
use crate::matter::clock::Clock;
use crate::space::Vector;

/// Turns of a vibrating wall that are looked into the future.
const OUTLOOK: f64 = 4.0;

/// What lies at each side, with the phases of those that vibrate.
#[derive(Clone, Debug)]
pub(super) struct Walls<V> {
    /// Whether an axis is not periodic.
    pub(super) any: bool,
    /// Half the period of periodic axes, infinite for others [length].
    pub(super) half_period: V,
    /// `[axis][side]`.
    sides: [[Option<Side<V>>; 2]; 3],
    /// `[axis][side]`: the place beyond which a grain cannot touch it [length].
    pub(super) zones: [[f64; 2]; 3],
    /// `[axis][side]`: phase of a vibrating wall at the origin of time, in turns.
    phases: [[f64; 2]; 3],
    size: V,
}

/// What a grain at a side does, and when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Meeting {
    /// It hits the wall after this time [time].
    Hit(f64),
    /// It passes an open side after this time [time].
    Passage(f64),
    /// Nothing is known beyond this time [time].
    Unknown(f64),
    /// It never comes there.
    Never,
}

/// A coordinate along one axis: where, how fast, how accelerated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fall {
    pub(super) place: f64,
    pub(super) velocity: f64,
    pub(super) acceleration: f64,
    /// Radius of the grain and the rate at which it grows.
    pub(super) radius: f64,
    pub(super) growth: f64,
}

impl<V: Vector> Walls<V> {
    pub(super) fn new(laws: &Laws<V>) -> Self {
        let mut walls = Walls {
            any: !laws.boundary.is_fully_periodic(),
            half_period: V::from_fn(|axis| {
                if laws.boundary.is_periodic(axis) { 0.5 * laws.size[axis] } else { f64::INFINITY }
            }),
            sides: [[None; 2]; 3],
            zones: [[f64::NEG_INFINITY, f64::INFINITY]; 3],
            phases: [[0.0; 2]; 3],
            size: laws.size,
        };
        for axis in 0..V::DIMENSION {
            let Some(sides) = laws.boundary.faces(axis) else { continue };
            let depth = |side: Side<V>| laws.largest_diameter() + amplitude(&side);
            walls.sides[axis] = sides.map(Some);
            walls.zones[axis] = [depth(sides[0]), laws.size[axis] - depth(sides[1])];
        }
        walls
    }

    /// Counts the phases of vibrating walls from `origin` on.
    pub(super) fn set_origin(&mut self, origin: Clock) {
        for (phases, sides) in self.phases.iter_mut().zip(&self.sides) {
            for (phase, side) in phases.iter_mut().zip(sides) {
                *phase = frequency(side).map_or(0.0, |frequency| turns(frequency, origin));
            }
        }
    }

    /// Whether there is a wall at `face`.
    pub(super) fn is_wall(&self, face: Face) -> bool {
        matches!(self.sides[face.axis()][face.side()], Some(Side::Wall(_)))
    }

    /// Whether grains can leave the box anywhere.
    pub(super) fn has_open_side(&self) -> bool {
        self.sides.iter().flatten().any(|side| matches!(side, Some(Side::Open)))
    }

    /// The wall at `face`.
    pub(super) fn wall(&self, face: Face) -> Wall<V> {
        match self.sides[face.axis()][face.side()] {
            Some(Side::Wall(wall)) => wall,
            _ => unreachable!("only walls are hit"),
        }
    }

    /// Velocity of the wall at `face` along its normal axis, `now` after the origin of time [length/time].
    pub(super) fn speed(&self, face: Face, now: f64) -> f64 {
        match self.wall(face).kind {
            WallKind::Vibrating { amplitude, frequency } => {
                let omega = std::f64::consts::TAU * frequency;
                amplitude * omega * libm::cos(self.angle(face, frequency, now))
            }
            _ => 0.0,
        }
    }

    fn angle(&self, face: Face, frequency: f64, now: f64) -> f64 {
        let turns = self.phases[face.axis()][face.side()] + frequency * now;
        std::f64::consts::TAU * (turns - turns.floor())
    }

    /// What a grain does at `face`, as far as `until` after `now` [time].
    pub(super) fn meeting(&self, face: Face, fall: Fall, now: f64, until: f64) -> Meeting {
        let Some(side) = self.sides[face.axis()][face.side()] else { return Meeting::Never };
        let (sign, edge) = if face.upper { (-1.0, self.size[face.axis()]) } else { (1.0, 0.0) };
        let height = sign * (fall.place - edge);
        let (velocity, acceleration) = (sign * fall.velocity, sign * fall.acceleration);
        let Side::Wall(wall) = side else {
            return plane_contact(height, velocity, acceleration).map_or(Meeting::Never, Meeting::Passage);
        };
        let (height, velocity) = (height - fall.radius, velocity - fall.growth);
        match wall.kind {
            WallKind::Vibrating { amplitude, frequency } if amplitude * frequency > 0.0 => {
                let outlook = until.min(OUTLOOK / frequency);
                let omega = std::f64::consts::TAU * frequency;
                // Seen from above, the motion of an upper wall is upside down.
                let half_turn = if face.upper { std::f64::consts::PI } else { 0.0 };
                let angle = self.angle(face, frequency, now) + half_turn;
                let flight = FlightOverVibration {
                    height,
                    velocity,
                    acceleration,
                    amplitude,
                    angular_frequency: omega,
                    phase: angle,
                };
                match vibrating_contact(&flight, outlook) {
                    Some(time) => Meeting::Hit(time),
                    None if outlook < until => Meeting::Unknown(outlook),
                    None => Meeting::Never,
                }
            }
            _ => plane_contact(height, velocity, acceleration).map_or(Meeting::Never, Meeting::Hit),
        }
    }
}

fn amplitude<V>(side: &Side<V>) -> f64 {
    match side {
        Side::Wall(Wall { kind: WallKind::Vibrating { amplitude, .. }, .. }) => *amplitude,
        _ => 0.0,
    }
}

fn frequency<V>(side: &Option<Side<V>>) -> Option<f64> {
    match side {
        Some(Side::Wall(Wall { kind: WallKind::Vibrating { frequency, .. }, .. })) => Some(*frequency),
        _ => None,
    }
}

/// The part of a turn that is left of `frequency` times the time of `clock`, without the rounding of
/// the product: a fused multiplication gives what it loses.
fn turns(frequency: f64, clock: Clock) -> f64 {
    let product = frequency * clock.time();
    let lost = frequency.mul_add(clock.time(), -product) - frequency * clock.compensation();
    let part = (product - product.floor()) + lost;
    part - part.floor()
}
