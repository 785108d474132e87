//! Observation: one measure a file, each reads the gas and the totals and changes neither.

pub mod measure;
