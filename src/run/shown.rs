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

    /// What `plan` asks for at the recording that has these `numbers`: several where a step was longer than the pause. What comes
    /// with full recordings only comes as seldom as it should, or a little more so.
    pub(super) fn at(numbers: Range<u64>, plan: &RecordPlan) -> Self {
        let is_due = |every: u64| numbers.start.next_multiple_of(every) < numbers.end;
        let full_every = u64::from(plan.full_every);
        let with_full = |every: u32| is_due(u64::from(every).next_multiple_of(full_every));
        Shown {
            full: is_due(full_every),
            frame: with_full(plan.frames_every),
            profiles: with_full(plan.profiles_every),
            fields: with_full(plan.fields_every),
        }
    }
}
