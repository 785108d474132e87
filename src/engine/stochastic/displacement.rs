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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::stochastic::laws::DenseGas;
    use crate::engine::stochastic::trial::{DENSE, laws};
    use glam::DVec2;

    #[test]
    fn a_collision_displaces_by_a_diameter_along_what_the_rule_says() {
        let (change, after) = (DVec2::new(0.3, -0.4), DVec2::new(-6.0, 8.0));
        let way = |dense: Option<DenseGas>| Displacement::of(&laws(dense)).shift(change, after);
        assert_eq!(way(None), None);
        let along_change = way(Some(DENSE)).unwrap();
        assert!((along_change - DVec2::new(0.6, -0.8)).length() < 1e-15);
        let corrected = DenseGas { transfer: Transfer::Corrected, displacement_ratio: 0.75, ..DENSE };
        let along_velocity = way(Some(corrected)).unwrap();
        assert!((along_velocity - DVec2::new(-0.45, 0.6)).length() < 1e-15);
    }

    #[test]
    fn a_collision_that_changes_nothing_displaces_nothing() {
        assert_eq!(Displacement::of(&laws(Some(DENSE))).shift(DVec2::ZERO, DVec2::X), None);
    }
}
