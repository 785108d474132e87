//! How far a collision carries its partners.

use super::laws::Laws;
use super::rules::Transfer;
use crate::law::restitution::Restitution;
use crate::space::Vector;

/// Along what a collision displaces its partners, and how far.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Displacement {
    None,
    MomentumChange { distance: f64 },
    RelativeVelocity { distance: f64 },
}

impl Displacement {
    pub(crate) fn of<V: Vector, R: Restitution>(laws: &Laws<V, R>) -> Self {
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
    pub(crate) fn shift<V: Vector>(self, change: V, after: V) -> Option<V> {
        let (direction, distance) = match self {
            Displacement::None => return None,
            Displacement::MomentumChange { distance } => (change, distance),
            Displacement::RelativeVelocity { distance } => (after, distance),
        };
        let length = direction.length();
        (length > 0.0).then(|| direction * (distance / length))
    }
}
