//! What the colours of grains may tell.

use super::log::ViewedLog;
use super::{clusters, density};
use crate::record::contents::Frame;

/// What the colours tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Colouring {
    /// How fast a grain is: every frame has that.
    Speed,
    /// The volume fraction around a grain.
    Density,
    /// How many grains its cluster has.
    Clusters,
}

/// A number for every point of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Scalars {
    /// `[point]`; NaN where there is none.
    pub(super) values: Vec<f32>,
    /// Of densities the side of a cell [length]; of clusters the size of the largest.
    pub(super) detail: f64,
}

impl Colouring {
    /// The one that a request calls `word`.
    pub(super) fn of(word: &str) -> Option<Self> {
        match word {
            "speed" => Some(Colouring::Speed),
            "density" => Some(Colouring::Density),
            "clusters" => Some(Colouring::Clusters),
            _ => None,
        }
    }

    /// The numbers that colour `frame` of `log`, beside the speeds; `None` where they have no meaning.
    pub(super) fn scalars(self, log: &ViewedLog, frame: &Frame) -> Option<Scalars> {
        let walls = log.walls()?;
        match self {
            Colouring::Speed => None,
            Colouring::Density => density::volume_fractions(frame, walls, &log.diameters(frame)),
            Colouring::Clusters => clusters::sizes(frame, walls, &log.diameters(frame)),
        }
    }
}
