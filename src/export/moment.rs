//! The grains at one time, as every format writes them.

use std::io::{self, Write};

use crate::record::contents::Frame;
use crate::record::state::SavedState;
use crate::scenario::kinds::Kinds;
use crate::space::Vector;

/// The grains at one time, in rising identity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moment {
    /// The recording that it belongs to, or the place among the states, from 0.
    pub number: u64,
    /// Simulated time [time].
    pub time: f64,
    /// Grains in the gas; more than stand here where the frame was thinned.
    pub grains: u64,
    /// Whether the numbers have single precision, as frames do.
    pub is_single: bool,
    /// Identities.
    pub ids: Vec<u32>,
    /// Index into the list of species.
    pub species: Vec<u8>,
    /// Radii [length].
    pub radii: Vec<f64>,
    /// Masses [mass].
    pub masses: Vec<f64>,
    /// Positions [length]; z = 0 in 2D.
    pub positions: Vec<[f64; 3]>,
    /// Velocities [length/time]; z = 0 in 2D.
    pub velocities: Vec<[f64; 3]>,
    /// Angular velocities [1/time], of states of grains that spin; about z in 2D.
    pub spins: Option<Vec<[f64; 3]>>,
}

impl Moment {
    /// The moment of `frame`, which belongs to recording `number`.
    pub(super) fn of_frame(number: u64, frame: &Frame, kinds: &Kinds) -> Self {
        let wide = |vectors: &[[f32; 3]]| vectors.iter().map(|vector| vector.map(f64::from)).collect();
        let mut moment = Moment {
            number,
            time: frame.time,
            grains: frame.grains,
            is_single: true,
            ids: frame.ids.clone(),
            species: frame.ids.iter().map(|&id| kinds.species_of(id)).collect(),
            positions: wide(&frame.positions),
            velocities: wide(&frame.velocities),
            ..Moment::default()
        };
        moment.measure(kinds);
        moment
    }

    /// The moment of `state`, which is number `number` among the states.
    pub(super) fn of_state<V: Vector>(number: u64, state: &SavedState<'_, V>, kinds: &Kinds) -> Self {
        let columns = &state.columns;
        let mut rows: Vec<usize> = (0..columns.len()).collect();
        rows.sort_unstable_by_key(|&row| columns.ids[row]);
        let of = |row: usize| columns.species.as_ref().map_or(0, |species| species[row]);
        let mut moment = Moment {
            number,
            time: state.time,
            grains: columns.len() as u64,
            is_single: false,
            ids: rows.iter().map(|&row| columns.ids[row]).collect(),
            species: rows.iter().map(|&row| of(row)).collect(),
            positions: rows.iter().map(|&row| in_space(columns.positions[row])).collect(),
            velocities: rows.iter().map(|&row| in_space(columns.velocities[row])).collect(),
            spins: columns
                .spins
                .as_ref()
                .map(|spins| rows.iter().map(|&row| turning::<V>(spins[row])).collect()),
            ..Moment::default()
        };
        moment.measure(kinds);
        moment
    }

    /// Gives every grain its size and mass.
    fn measure(&mut self, kinds: &Kinds) {
        self.radii = self.species.iter().map(|&kind| 0.5 * kinds.grain(kind).diameter).collect();
        self.masses = self.species.iter().map(|&kind| kinds.grain(kind).mass).collect();
    }

    /// Number of grains that stand here.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether no grain stands here.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// Whether there are grains that do not stand here.
    pub fn is_thinned(&self) -> bool {
        (self.ids.len() as u64) < self.grains
    }

    /// `value` in the shortest form that reads back to the same bits at the precision of this moment.
    pub(super) fn text(&self, value: f64) -> String {
        if self.is_single { format!("{:?}", value as f32) } else { format!("{value:?}") }
    }

    /// `vector` in that form, with `separator` in between.
    pub(super) fn vector_text(&self, vector: [f64; 3], separator: &str) -> String {
        vector.map(|component| self.text(component)).join(separator)
    }

    /// The line of the grain in `row`: what `lead` says, position, velocity, radius, and spin where there is one.
    pub(super) fn write_row(
        &self,
        to: &mut dyn Write,
        row: usize,
        lead: &str,
        separator: &str,
    ) -> io::Result<()> {
        let place = self.vector_text(self.positions[row], separator);
        let velocity = self.vector_text(self.velocities[row], separator);
        write!(to, "{lead}{separator}{place}{separator}{velocity}{separator}{:?}", self.radii[row])?;
        match &self.spins {
            Some(spins) => writeln!(to, "{separator}{}", self.vector_text(spins[row], separator)),
            None => writeln!(to),
        }
    }

    /// What is to be said of a moment that is not all of the gas, or nothing.
    pub(super) fn remark(&self) -> Option<String> {
        self.is_thinned().then(|| format!("thinned: {} of {} grains", self.len(), self.grains))
    }
}

fn in_space<V: Vector>(vector: V) -> [f64; 3] {
    std::array::from_fn(|axis| if axis < V::DIMENSION { vector[axis] } else { 0.0 })
}

/// One number turns about z.
fn turning<V: Vector>(spin: V::Spin) -> [f64; 3] {
    match *spin.as_ref() {
        [x, y, z] => [x, y, z],
        [about_z] => [0.0, 0.0, about_z],
        _ => [0.0; 3],
    }
}
