//! Dimensions of what is measured.

use super::measure::{Column, Dimension};
use crate::space::Vector;

/// A pure number.
pub(crate) const PURE: Dimension = Dimension { mass: 0, length: 0, time: 0 };
/// A length.
pub(crate) const LENGTH: Dimension = Dimension { mass: 0, length: 1, time: 0 };
/// A velocity.
pub(crate) const VELOCITY: Dimension = Dimension { mass: 0, length: 1, time: -1 };
/// A rate or a frequency.
pub(crate) const RATE: Dimension = Dimension { mass: 0, length: 0, time: -1 };
/// A wavenumber.
pub(crate) const WAVENUMBER: Dimension = Dimension { mass: 0, length: -1, time: 0 };
/// An energy, or a granular temperature.
pub(crate) const ENERGY: Dimension = Dimension { mass: 1, length: 2, time: -2 };

/// A pressure or stress: force per area, in 2D per length.
pub(crate) fn stress<V: Vector>() -> Dimension {
    Dimension { mass: 1, length: 2 - V::DIMENSION as i8, time: -2 }
}

/// A column of that name and unit.
pub(crate) fn column(name: &str, unit: Dimension) -> Column {
    Column { name: name.to_owned(), unit }
}
