//! What a recording shows beside the series.

use std::ops::Range;

use crate::scenario::model::RecordPlan;

/// What a recording shows beside the part of the series that costs little.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shown {
    /// All of the series, and the state hash.
    pub(super) full: bool,
    /// The picture of the grains.
    pub(super) frame: bool,
    /// Profiles.
    pub(super) profiles: bool,
    /// Fields over the cells.
    pub(super) fields: bool,
}

impl Shown {
    /// Everything.
    pub(super) const ALL: Shown = Shown { full: true, frame: true, profiles: true, fields: true };

    /// What `plan` asks for at the recording that has these `numbers`: several where a step was longer than the pause.
    pub(super) fn at(numbers: Range<u64>, plan: &RecordPlan) -> Self {
        let is_due = |every: u32| numbers.start.next_multiple_of(u64::from(every)) < numbers.end;
        let full = is_due(plan.full_every);
        Shown {
            full,
            frame: full && is_due(plan.frames_every),
            profiles: full && is_due(plan.profiles_every),
            fields: full && is_due(plan.fields_every),
        }
    }
}
