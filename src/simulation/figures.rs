//! The keys that the summary of every run has, whatever its scenario measures, and what each is.

/// What a key of a summary holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A text, or true and false.
    Text,
    /// A number of the run; null where it does not apply.
    Number,
    /// What an engine counts while it works, and shares of it; null where it does not apply.
    Counter,
    /// What the machine had to give: another number each time.
    Cost,
}

/// Every key, in the order in which pages and messages name them. All other keys of a summary are figures of its scenario.
pub const KEYS: [(&str, Kind); 43] = [
    ("scenario", Kind::Text),
    ("engine", Kind::Text),
    ("version", Kind::Text),
    ("end_reason", Kind::Text),
    ("interrupted", Kind::Text),
    ("failure", Kind::Text),
    ("state_hash", Kind::Text),
    ("dimension", Kind::Number),
    ("particles_initial", Kind::Number),
    ("particles_final", Kind::Number),
    ("volume_fraction", Kind::Number),
    ("seed", Kind::Number),
    ("threads", Kind::Number),
    ("numerics", Kind::Number),
    ("collisions_per_particle", Kind::Number),
    ("simulated_time", Kind::Number),
    ("resumed_at", Kind::Number),
    ("kinetic_energy_initial", Kind::Number),
    ("kinetic_energy_final", Kind::Number),
    ("temperature", Kind::Number),
    ("momentum_drift", Kind::Number),
    ("steps", Kind::Counter),
    ("steps_capped", Kind::Counter),
    ("events", Kind::Counter),
    ("wall_hits", Kind::Counter),
    ("cell_crossings", Kind::Counter),
    ("list_renewals", Kind::Counter),
    ("annulled_events", Kind::Counter),
    ("cured_share", Kind::Counter),
    ("invalid_states", Kind::Counter),
    ("collisions", Kind::Counter),
    ("candidates", Kind::Counter),
    ("cell_collisions", Kind::Counter),
    ("rejected_moves", Kind::Counter),
    ("cell_capacity", Kind::Counter),
    ("largest_occupancy", Kind::Counter),
    ("poured", Kind::Counter),
    ("removed", Kind::Counter),
    ("wall_seconds", Kind::Cost),
    ("advancing_seconds", Kind::Cost),
    ("particle_steps_per_second", Kind::Cost),
    ("events_per_second", Kind::Cost),
    ("peak_memory_bytes", Kind::Cost),
];

/// What stands beside a figure in a summary, as endings of its name: standard error, degrees of freedom of that error,
/// whether the figure is steady (true, false or null), and what it does where it is not (`rising`, `falling`, `wandering`).
pub const ATTRIBUTES: [&str; 4] = [STANDARD_ERROR, DEGREES_OF_FREEDOM, STEADY, TREND];
/// Ending of the key of a standard error.
pub const STANDARD_ERROR: &str = "_standard_error";
/// Ending of the key of the degrees of freedom of a standard error.
pub const DEGREES_OF_FREEDOM: &str = "_degrees_of_freedom";
/// Ending of the key that says whether a figure is steady.
pub const STEADY: &str = "_steady";
/// Ending of the key that says what an unsteady figure does.
pub const TREND: &str = "_trend";

/// Whether `key` is an attribute of a figure, not a figure itself.
pub fn is_attribute(key: &str) -> bool {
    ATTRIBUTES.iter().any(|ending| key.ends_with(ending))
}

/// Whether every summary has this key.
pub fn is_of_every_run(name: &str) -> bool {
    KEYS.iter().any(|(key, _)| *key == name)
}

/// The keys that hold numbers.
pub fn numbers() -> impl Iterator<Item = &'static str> + Clone {
    KEYS.iter().filter(|(_, kind)| *kind != Kind::Text).map(|(key, _)| *key)
}

/// What an engine counts.
pub fn counters() -> impl Iterator<Item = &'static str> {
    KEYS.iter().filter(|(_, kind)| *kind == Kind::Counter).map(|(key, _)| *key)
}
