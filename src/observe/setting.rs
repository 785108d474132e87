//! What a measure may know of the place that it looks at, and of nothing else.

use crate::law::boundary::Boundary;
use crate::law::roughness::Roughness;
use crate::matter::grain::Grain;
use crate::matter::grid::Grid;

/// The place that grains live in, whichever engine moves them.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting<V> {
    /// Constant acceleration of every grain [length/time²].
    pub gravity: V,
    /// Sides of the space that grain surfaces have: `domain.size` [length].
    pub size: V,
    /// The box with its cells; larger than `size` by the strokes of vibrating walls.
    pub grid: Grid<V>,
    /// The sides of the box.
    pub boundary: Boundary<V>,
    /// Diameter and mass of a grain.
    pub grain: Grain,
    /// Number of species; 0 where all grains are alike.
    pub species: usize,
    /// Whether grains are poured in.
    pub is_poured: bool,
    /// How rough grains are; `None` where they do not spin.
    pub roughness: Option<Roughness>,
    /// Whether the impact parameters of single collisions are counted.
    pub counts_impacts: bool,
}
