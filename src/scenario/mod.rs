//! What a run is made of: a checked scenario. Only this module makes one,
//! so to hold a `Scenario` is the proof that it was checked.

pub mod model;
