//! What was seen last: a sample and the recording of the same state look only once.

use super::measure::{Place, Snapshot};
use crate::space::Vector;

/// The last look, and which state it was of.
#[derive(Clone, Debug, Default)]
pub(crate) struct LastLook<T> {
    last: Option<(Place, T)>,
}

impl<T> LastLook<T> {
    /// What `look` sees in the gas of `snapshot`, or has seen there before.
    pub(crate) fn of<V: Vector>(&mut self, snapshot: &Snapshot<'_, V>, look: impl FnOnce() -> T) -> &T {
        let place = snapshot.place();
        let seen = self.last.take().filter(|(known, _)| *known == place);
        &self.last.insert(seen.unwrap_or_else(|| (place, look()))).1
    }
}
