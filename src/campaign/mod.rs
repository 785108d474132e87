//! What takes many runs to answer one question.

pub mod calibrate;
pub mod compare;
pub mod sweep;
