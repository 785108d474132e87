//! The stochastic engines.
