//! Structure of arrays: one column per quantity, all in the same order.

use super::scatter::Labels;
use crate::space::Vector;

/// The columns of a gas; row `i` of each belongs to the same grain.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns<V: Vector> {
    /// Positions [length].
    pub positions: Vec<V>,
    /// Velocities [length/time].
    pub velocities: Vec<V>,
    /// Identities: given once, never reused.
    pub ids: Vec<u32>,
    /// Angular velocities [1/time], where grains are rough.
    pub spins: Option<Vec<V::Spin>>,
    /// Index into the list of species, where there are several.
    pub species: Option<Vec<u8>>,
}

/// The rows of the columns that all grains have, to be read.
#[derive(Clone, Copy, Debug)]
pub struct Rows<'a, V: Vector> {
    /// Positions [length].
    pub positions: &'a [V],
    /// Velocities [length/time].
    pub velocities: &'a [V],
    /// Identities.
    pub ids: &'a [u32],
}

impl<V: Vector> Columns<V> {
    /// All rows.
    pub fn rows(&self) -> Rows<'_, V> {
        Rows { positions: &self.positions, velocities: &self.velocities, ids: &self.ids }
    }

    /// Number of grains.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are no grains.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// Columns of the same kind and length, of unspecified content.
    pub fn like(other: &Self) -> Self {
        let mut columns = Columns::default();
        columns.match_shape(other);
        columns
    }

    /// Takes the length and the optional columns of `other`; the content is unspecified.
    pub fn match_shape(&mut self, other: &Self) {
        self.resize(other.len(), &other.labels());
    }

    /// Takes length `n` and the optional columns of `labels`; the content is unspecified.
    pub fn resize(&mut self, n: usize, labels: &Labels<'_, V>) {
        self.positions.resize(n, V::ZERO);
        self.velocities.resize(n, V::ZERO);
        self.ids.resize(n, 0);
        resize_optional(&mut self.spins, labels.spins.is_some(), n);
        resize_optional(&mut self.species, labels.species.is_some(), n);
    }

    /// Keeps the first `n` grains.
    pub fn truncate(&mut self, n: usize) {
        self.positions.truncate(n);
        self.velocities.truncate(n);
        self.ids.truncate(n);
        if let Some(spins) = &mut self.spins {
            spins.truncate(n);
        }
        if let Some(species) = &mut self.species {
            species.truncate(n);
        }
    }

    /// Puts a grain at row `row`, moving later ones back.
    pub fn insert(&mut self, row: usize, position: V, velocity: V, id: u32) {
        self.positions.insert(row, position);
        self.velocities.insert(row, velocity);
        self.ids.insert(row, id);
        if let Some(spins) = &mut self.spins {
            spins.insert(row, V::Spin::default());
        }
        if let Some(species) = &mut self.species {
            species.insert(row, 0);
        }
    }

    /// Angular velocities and species, where there are any.
    pub fn labels(&self) -> Labels<'_, V> {
        Labels { spins: self.spins.as_deref(), species: self.species.as_deref() }
    }
}

fn resize_optional<T: Copy + Default>(column: &mut Option<Vec<T>>, wanted: bool, n: usize) {
    if wanted {
        column.get_or_insert_default().resize(n, T::default());
    } else {
        *column = None;
    }
}
