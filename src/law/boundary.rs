//! What happens at the sides of the box.

use crate::space::Vector;

/// One axis of the box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AxisBoundary<V> {
    /// What leaves on one side enters on the other.
    Periodic,
    /// A face on either side.
    Faces {
        /// At the lower end.
        lower: Face<V>,
        /// At the upper end.
        upper: Face<V>,
    },
}

/// One side of the box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Face<V> {
    /// Grains that pass it are removed.
    Open,
    /// Grains are reflected.
    Wall(Wall<V>),
}

/// A wall and its restitution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall<V> {
    /// Restitution r_w of the velocity normal to the wall, in [0, 1].
    pub restitution: f64,
    /// What it does to the tangential velocity, and how it moves.
    pub kind: WallKind<V>,
}

/// Kinds of walls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WallKind<V> {
    /// The tangential velocity stays.
    Smooth,
    /// The tangential velocity is reversed in the frame of the wall: v∥ → 2v_w − v∥ (Müller 2001, 3.8).
    Rough {
        /// Velocity v_w of the wall along itself [length/time].
        velocity: V,
    },
    /// The tangential velocity is reversed with a probability p (Müller 2001, section 3.4).
    Statistical {
        /// p, in [0, 1].
        reversal_probability: f64,
    },
    /// Smooth, and moving as z₀ = A sin 2πft about its place.
    Vibrating {
        /// A [length].
        amplitude: f64,
        /// f [1/time].
        frequency: f64,
    },
}

/// The boundary of the box, axis by axis; only the first D entries are used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boundary<V> {
    /// `[axis]`.
    pub axes: [AxisBoundary<V>; 3],
}

impl<V: Vector> Boundary<V> {
    /// Periodic along every axis.
    pub fn periodic() -> Self {
        Boundary { axes: [AxisBoundary::Periodic; 3] }
    }

    /// Whether `axis` is periodic.
    pub fn is_periodic(&self, axis: usize) -> bool {
        matches!(self.axes[axis], AxisBoundary::Periodic)
    }

    /// Whether every axis is periodic.
    pub fn is_fully_periodic(&self) -> bool {
        (0..V::DIMENSION).all(|axis| self.is_periodic(axis))
    }

    /// The lower and upper face of `axis`; `None` where it is periodic.
    pub fn faces(&self, axis: usize) -> Option<[Face<V>; 2]> {
        match self.axes[axis] {
            AxisBoundary::Periodic => None,
            AxisBoundary::Faces { lower, upper } => Some([lower, upper]),
        }
    }

    /// All walls with their axis and side (0 lower, 1 upper).
    pub fn walls(&self) -> impl Iterator<Item = (usize, usize, Wall<V>)> + '_ {
        (0..V::DIMENSION).flat_map(|axis| {
            self.faces(axis).into_iter().flatten().enumerate().filter_map(move |(side, face)| match face {
                Face::Wall(wall) => Some((axis, side, wall)),
                Face::Open => None,
            })
        })
    }

    /// Which faces are walls at a fixed place: `[axis][side]`, side 0 the lower one.
    pub fn fixed_walls(&self) -> [[bool; 2]; 3] {
        let mut fixed = [[false; 2]; 3];
        for (axis, side, wall) in self.walls() {
            fixed[axis][side] = !matches!(wall.kind, WallKind::Vibrating { .. });
        }
        fixed
    }

    /// The fastest speed at which a wall moves [length/time].
    pub fn largest_wall_speed(&self) -> f64 {
        self.walls().map(|(_, _, wall)| wall.largest_speed()).fold(0.0, f64::max)
    }

    /// The same faces with every wall elastic, smooth and at rest: for equilibration.
    pub fn at_rest(&self) -> Self {
        let quiet = |face: Face<V>| match face {
            Face::Open => Face::Wall(Wall { restitution: 1.0, kind: WallKind::Smooth }),
            Face::Wall(wall) => Face::Wall(Wall { restitution: 1.0, kind: wall.kind.at_rest() }),
        };
        Boundary {
            axes: self.axes.map(|axis| match axis {
                AxisBoundary::Periodic => AxisBoundary::Periodic,
                AxisBoundary::Faces { lower, upper } => {
                    AxisBoundary::Faces { lower: quiet(lower), upper: quiet(upper) }
                }
            }),
        }
    }
}

impl<V: Vector> Wall<V> {
    /// The fastest speed at which the wall moves [length/time].
    pub fn largest_speed(&self) -> f64 {
        match self.kind {
            WallKind::Rough { velocity } => velocity.length(),
            WallKind::Vibrating { amplitude, frequency } => std::f64::consts::TAU * amplitude * frequency,
            WallKind::Smooth | WallKind::Statistical { .. } => 0.0,
        }
    }
}

impl<V: Vector> WallKind<V> {
    fn at_rest(self) -> Self {
        match self {
            WallKind::Rough { .. } => WallKind::Rough { velocity: V::ZERO },
            // A vibrating wall keeps its amplitude, which decides where the grid begins.
            WallKind::Vibrating { amplitude, .. } => WallKind::Vibrating { amplitude, frequency: 0.0 },
            other => other,
        }
    }
}
