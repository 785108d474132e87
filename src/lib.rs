//! # grainflow
//!
//! Granular matter, simulated fast enough for millions of grains and honestly enough to be trusted.
//!
//! Grains live in a box that is cut into cells and stand in memory in the order of their cells. A
//! stochastic step lets grains of one cell collide at random, at the rate and with the impact
//! parameters that kinetic theory gives, and then moves them all:
//!
//! * **DSMC**: pairs of point grains collide at the rate of the Boltzmann equation;
//! * **CBA**: at the rate of Enskog theory, and each collision displaces its partners by a
//!   diameter, so that the pressure of a dense gas comes out;
//! * **HSMC**: cells fill up: nobody enters a full cell, and full cells pass momentum on to their
//!   neighbours like grains, so that matter can come to rest and carry load.
//!
//! **Event-driven** dynamics is exact, and what the others are held against: hard grains, smooth or rough, of one kind or
//! several, fly freely from collision to collision. Every grain stands at the time of its own last event and has one
//! next event; those of all grains wait in a calendar whose pages follow the rate at which things happen.
//!
//! The floors of the house, each built on those above it only: mathematics ([`space`], [`random`],
//! [`statistics`], [`number`]), [`matter`], [`law`]s, [`engine`]s, observation ([`observe`], [`record`]), runs
//! ([`scenario`], [`simulation`], [`run`], [`replay`], [`export`], [`comparison`], [`report`], [`view`]), campaigns of many runs
//! ([`campaign`]) and the command line ([`cli`]).

pub mod number;
pub mod random;
pub mod space;
pub mod statistics;

pub mod matter;

pub mod law;

pub mod engine;

pub mod observe;
pub mod record;

pub mod comparison;
pub mod export;
pub mod machine;
pub mod placing;
pub mod replay;
pub mod report;
pub mod run;
pub mod scenario;
pub mod simulation;
pub mod stopwatch;
pub mod view;

pub mod campaign;

pub mod cli;
