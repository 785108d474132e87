//! The pouring source.

/// Grains that fall one by one onto what lies below (Müller 2001, section 3.5).
#[derive(Clone, Debug, PartialEq)]
pub struct Source<V> {
    /// How many grains are poured in all.
    pub count: u32,
    /// Grains per time [1/time].
    pub rate: f64,
    /// Centre of the spout [length]; its component along gravity is not used.
    pub position: V,
    /// Width of the spout along each horizontal axis [length].
    pub width: f64,
    /// Height above the highest full place of a grid two diameters wide [length].
    pub height: f64,
    /// Velocity of a new grain [length/time].
    pub velocity: V,
}
