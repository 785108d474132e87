//! What the benches share: the yardstick kernel and the gases that engines are timed on.

pub(crate) mod cases;
pub(crate) mod yardstick;
