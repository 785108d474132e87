//! What makes many runs to answer one question.

pub mod compare;
