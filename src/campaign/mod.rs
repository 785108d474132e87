//! What takes many runs to answer one question.

pub mod calibrate;
pub mod compare;
mod pools;
pub mod sweep;
