//! What a log holds, in memory: the only thing that reports and comparisons look at.

use std::collections::BTreeMap;

use crate::law::boundary::{Boundary, Face};
use crate::observe::field::Field;
use crate::observe::measure::{Column, Profile};
use crate::space::Vector;

/// The contents of a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunLog {
    /// Version, numerics, seed, engine, units and the like, as `key = value`.
    pub metadata: BTreeMap<String, String>,
    /// The scenario as TOML text.
    pub scenario: String,
    /// Columns of the series; the first is `time`.
    pub columns: Vec<Column>,
    /// `[recording][column]`.
    pub series: Vec<Vec<f64>>,
    /// The state hash at every recording, in hexadecimal digits.
    pub state_hashes: Vec<String>,
    /// All profiles, in the order they were written.
    pub profiles: Vec<Profile>,
    /// Pictures of the grains, in the order of their times.
    pub frames: Vec<Frame>,
    /// Fields, in the order of their times.
    pub fields: Vec<Field>,
    /// The box and its walls.
    pub walls: Option<Walls>,
    /// The species of every grain `[id]` that a state holds, 0 where none does; empty where all grains are alike, and where
    /// frames were not read.
    pub species: Vec<u8>,
    /// What is missing, as a sentence, where the file was cut off; nothing for a whole log.
    pub cut_off: Option<String>,
}

/// A part of a run that went by another scenario, before the run was resumed with changes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EarlierPart {
    /// Its scenario as TOML text.
    pub scenario: String,
    /// When it ended [time].
    pub time: f64,
    /// Steps made up to there.
    pub steps: u64,
    /// Events up to there.
    pub events: u64,
    /// What was changed then, as on the command line.
    pub changes: String,
}

/// Where the grains are at one time, at the precision of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Simulated time [time].
    pub time: f64,
    /// Grains in the gas; more than there are points when the frame was thinned.
    pub grains: u64,
    /// Positions [length]; z = 0 in 2D.
    pub positions: Vec<[f32; 3]>,
    /// Velocities [length/time]; z = 0 in 2D.
    pub velocities: Vec<[f32; 3]>,
    /// Identities.
    pub ids: Vec<u32>,
}

/// `place`, a coordinate in single precision [length], brought back into `lower` … `upper` [length] where only its rounding
/// has carried it out; a place that is farther out stays.
///
/// Rounding keeps order: what was inside at full precision is never beyond the rounded ends.
pub fn within_rounding(place: f64, lower: f64, upper: f64) -> f64 {
    if place > upper && place <= f64::from(upper as f32) {
        upper
    } else if place < lower && place >= f64::from(lower as f32) {
        lower
    } else {
        place
    }
}

/// The box and which of its sides are walls.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Walls {
    /// Lower corner of the space that grains may be in, the strokes of vibrating walls included [length]; z = 0 in 2D.
    /// Logs written before walls were so have a vibrating wall at its mean place.
    pub lower: [f64; 3],
    /// Upper corner, likewise [length]; z = 0 in 2D.
    pub upper: [f64; 3],
    /// `[axis][side]`: `wall`, `open`, `periodic` or, for an axis that does not exist, empty.
    pub sides: [[String; 2]; 3],
}

impl Walls {
    /// The box of `boundary` with corners at `lower` and `upper` [length].
    pub fn new<V: Vector>(boundary: &Boundary<V>, lower: V, upper: V) -> Self {
        let mut walls = Walls::default();
        for axis in 0..V::DIMENSION {
            walls.lower[axis] = lower[axis];
            walls.upper[axis] = upper[axis];
            walls.sides[axis] = match boundary.faces(axis) {
                None => ["periodic".to_owned(), "periodic".to_owned()],
                Some(faces) => faces.map(|face| match face {
                    Face::Open => "open".to_owned(),
                    Face::Wall(_) => "wall".to_owned(),
                }),
            };
        }
        walls
    }
}
