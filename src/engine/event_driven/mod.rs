//! The event-driven engine: exact dynamics of hard grains, one event after another.

pub mod growth;
pub mod rules;
