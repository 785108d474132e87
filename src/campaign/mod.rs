//! What takes many runs.

pub mod calibrate;
