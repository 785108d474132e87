//! Columns filled by several threads at once, each grain at a place of its own.
//!
//! The one trick of the container that the compiler cannot follow: the counting sort gives no place twice.

use std::marker::PhantomData;

use super::columns::Columns;
use super::sort::CountingSort;
use crate::space::Vector;

/// A column that threads write to at different places.
///
/// It is copied into the loops that fill it: read through a reference, its address would have to be read again after
/// every store, which might have changed it for all that the compiler knows.
struct Shared<'a, T> {
    first: *mut T,
    length: usize,
    column: PhantomData<&'a mut [T]>,
}

impl<T> Clone for Shared<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Shared<'_, T> {}

#[expect(unsafe_code, reason = "threads share the column and write to places that no two of them have")]
// SAFETY: values are only ever moved in, by `put`, which demands that no place is used twice.
unsafe impl<T: Send> Sync for Shared<'_, T> {}

#[expect(unsafe_code, reason = "as above")]
// SAFETY: as above; a copy is as good as a reference.
unsafe impl<T: Send> Send for Shared<'_, T> {}

impl<V: Vector> Labels<'_, V> {
    /// No grain has any.
    pub const NONE: Self = Labels { spins: None, species: None };
}

impl<'a, T: Copy> Shared<'a, T> {
    fn new(column: &'a mut [T]) -> Self {
        Shared { first: column.as_mut_ptr(), length: column.len(), column: PhantomData }
    }

    /// Writes `value` to `place`.
    ///
    /// # Safety
    /// Nobody else may write to the same place while this column is shared.
    #[inline(always)]
    #[expect(unsafe_code, reason = "see the module")]
    unsafe fn put(self, place: usize, value: T) {
        assert!(place < self.length, "a place in the column");
        // SAFETY: the place lies inside the column, which is borrowed for as long as `self` lives; nobody else
        // writes to it, as the caller promises, and nobody reads before the threads have come together.
        unsafe { *self.first.add(place) = value };
    }
}

/// Angular velocities and species of the rows that a sort takes grains from, where there are any.
#[derive(Clone, Copy, Debug)]
pub struct Labels<'a, V: Vector> {
    /// Angular velocities [1/time].
    pub spins: Option<&'a [V::Spin]>,
    /// Species.
    pub species: Option<&'a [u8]>,
}

/// Where one grain belongs in sorted columns.
#[derive(Clone, Copy)]
pub struct Slot<'a, V: Vector> {
    columns: SharedColumns<'a, V>,
    place: usize,
}

/// The columns that a sort fills.
#[derive(Clone, Copy)]
struct SharedColumns<'a, V: Vector> {
    positions: Shared<'a, V>,
    velocities: Shared<'a, V>,
    ids: Shared<'a, u32>,
}

impl<V: Vector> Slot<'_, V> {
    /// Puts the grain there.
    #[inline(always)]
    #[expect(unsafe_code, reason = "see the module")]
    pub fn put(self, position: V, velocity: V, id: u32) {
        // SAFETY: the sort gives no place twice, and slots are made by the sort alone.
        unsafe {
            self.columns.positions.put(self.place, position);
            self.columns.velocities.put(self.place, velocity);
            self.columns.ids.put(self.place, id);
        }
    }
}

impl CountingSort {
    /// Fills `columns`, which are as long as grains stay: `put` puts the grain of a row into its slot, for all
    /// rows of `cells`, in cell order. The sort has counted and accumulated these `cells`.
    #[expect(unsafe_code, reason = "see the module")]
    pub fn fill<V: Vector>(
        &mut self,
        cells: &[u32],
        columns: &mut Columns<V>,
        labels: Labels<'_, V>,
        put: impl Fn(usize, Slot<'_, V>) + Copy + Sync,
    ) {
        let shared = SharedColumns {
            positions: Shared::new(&mut columns.positions),
            velocities: Shared::new(&mut columns.velocities),
            ids: Shared::new(&mut columns.ids),
        };
        let spins = columns.spins.as_deref_mut().map(Shared::new).zip(labels.spins);
        let species = columns.species.as_deref_mut().map(Shared::new).zip(labels.species);
        self.place(cells, move |row, place| {
            put(row, Slot { columns: shared, place });
            // SAFETY: the sort gives no place twice.
            unsafe {
                if let Some((column, spins)) = spins {
                    column.put(place, spins[row]);
                }
                if let Some((column, species)) = species {
                    column.put(place, species[row]);
                }
            }
        });
    }
}
