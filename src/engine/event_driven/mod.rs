//! The event-driven engine: exact dynamics of hard grains, one event after another.

pub mod collapse;
pub mod contact;
pub mod rules;
