//! One reader for each table of a scenario file.

pub(super) mod boundary;
pub(super) mod calibrated;
pub(super) mod channels;
pub(super) mod engine;
pub(super) mod head;
pub(super) mod initial;
pub(super) mod particles;
pub(super) mod record;
pub(super) mod run;
pub(super) mod source;
