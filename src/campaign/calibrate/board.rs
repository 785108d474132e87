//! How several runs that go on side by side are going, told as one.

use std::sync::Mutex;

use crate::run::{Listener, Status};

/// What every run has told last.
pub(super) struct Board<'a> {
    told: Mutex<(Vec<Option<Status>>, Listener<'a>)>,
}

impl<'a> Board<'a> {
    pub(super) fn new(runs: usize, tell: Listener<'a>) -> Self {
        Board { told: Mutex::new((vec![None; runs], tell)) }
    }

    /// Takes the `status` of run `number`, and tells of all: the mean progress, the events together.
    pub(super) fn tell(&self, number: usize, status: Status) {
        // Only a panic while telling poisons the lock; it is on its way to the user.
        let Ok(mut told) = self.told.lock() else { return };
        let (runs, listener) = &mut *told;
        runs[number] = Some(status);
        let known = || runs.iter().flatten();
        let all = Status {
            progress: known().map(|status| status.progress).sum::<f64>() / runs.len() as f64,
            events: known().map(|status| status.events).sum(),
            ..status
        };
        listener(&all);
    }
}
