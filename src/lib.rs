//! Granular matter, simulated fast and honestly.

pub mod random;
pub mod space;
pub mod statistics;

pub mod matter;

pub mod law;

pub mod engine;

pub mod observe;
pub mod record;

pub mod report;
pub mod scenario;
