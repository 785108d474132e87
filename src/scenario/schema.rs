//! Every key of a scenario file, table by table.

/// The keys above the first table, and the tables.
pub(super) const ROOT: &[&str] = &[
    "title",
    "dimension",
    "seed",
    "gravity",
    "engine",
    "domain",
    "boundary",
    "particles",
    "initial",
    "source",
    "run",
    "record",
    "units",
];
/// `[engine]`.
pub(super) const ENGINE: &[&str] = &[
    "kind",
    "cell_size",
    "time_step",
    "enskog_factor",
    "transfer",
    "impact_parameter",
    "hsmc",
    "event_driven",
];
/// `engine.time_step`.
pub(super) const TIME_STEP: &[&str] = &["fixed", "collisions_per_particle", "crossing"];
/// `[engine.hsmc]`.
pub(super) const HSMC: &[&str] = &[
    "maximum_volume_fraction",
    "cell_restitution",
    "sweeps",
    "admission",
    "displacement",
    "entry_probability",
];
/// `engine.impact_parameter`, where it is a table; the last names a file that holds the others.
pub(super) const IMPACT_PARAMETER: &[&str] = &["collisions_per_particle", "c", "table"];
/// `engine.hsmc.entry_probability`, where it is a table; the last names a file that holds the others.
pub(super) const ENTRY_PROBABILITY: &[&str] = &["volume_fraction", "probability", "table"];
/// `[engine.event_driven]`.
pub(super) const EVENT_DRIVEN: &[&str] = &["structure", "collapse"];
/// `engine.event_driven.collapse`, where it is a table.
pub(super) const COLLAPSE: &[&str] = &["elastic_below", "contact_time", "rotation"];
/// `[domain]`.
pub(super) const DOMAIN: &[&str] = &["size"];
/// `boundary.x` and the like, where it is a table.
pub(super) const FACES: &[&str] = &["lower", "upper"];
/// `[particles]`.
pub(super) const PARTICLES: &[&str] = &[
    "count",
    "volume_fraction",
    "diameter",
    "mass",
    "restitution",
    "tangential_restitution",
    "moment_of_inertia",
    "species",
];
/// What is said of `friction`, which users of other programs look for.
pub(super) const NO_FRICTION: &str = "; there is no Coulomb friction, neither between grains nor at walls. Rough grains of event-driven \
    runs turn each other by particles.tangential_restitution (-1 smooth … 1), and walls take up momentum along them \
    as { wall = \"rough\" } or { wall = \"statistical\", reversal_probability = p }";
/// Keys of walls of all kinds.
pub(super) const WALL: &[&str] =
    &["wall", "restitution", "velocity", "reversal_probability", "amplitude", "frequency"];
/// `[[particles.species]]`.
pub(super) const SPECIES: &[&str] = &["diameter", "mass", "share"];
/// `particles.restitution`, where it is a table.
pub(super) const RESTITUTION: &[&str] = &["law", "r0", "v0"];
/// `[initial]`.
pub(super) const INITIAL: &[&str] = &["positions", "velocities", "equilibrate"];
/// `[source]`.
pub(super) const SOURCE: &[&str] = &["count", "rate", "position", "width", "height", "velocity"];
/// `[run]`.
pub(super) const RUN: &[&str] = &["time", "steps", "collisions_per_particle", "rest"];
/// `[record]`.
pub(super) const RECORD: &[&str] = &[
    "frames",
    "every",
    "spacing",
    "share",
    "measures",
    "points",
    "states",
    "state_every",
    "from",
    "full",
    "particles",
    "profiles",
    "fields",
];
/// `record.full`.
pub(super) const RECORD_FULL: &[&str] = &["every_nth"];
/// `record.particles`.
pub(super) const RECORD_PARTICLES: &[&str] = &["every_nth", "points"];
/// `record.profiles`.
pub(super) const RECORD_PROFILES: &[&str] = &["every_nth"];
/// `record.fields`, where it is a table.
pub(super) const RECORD_FIELDS: &[&str] = &["names", "every_nth"];
/// `[units]`.
pub(super) const UNITS: &[&str] = &["length", "mass", "time"];

/// The tables that a key put into the wrong one may belong to.
pub(super) const TABLES: &[(&str, &[&str])] = &[
    ("engine", ENGINE),
    ("engine.time_step", TIME_STEP),
    ("engine.impact_parameter", IMPACT_PARAMETER),
    ("engine.hsmc", HSMC),
    ("engine.hsmc.entry_probability", ENTRY_PROBABILITY),
    ("engine.event_driven", EVENT_DRIVEN),
    ("engine.event_driven.collapse", COLLAPSE),
    ("domain", DOMAIN),
    ("particles", PARTICLES),
    ("[particles.species]", SPECIES),
    ("initial", INITIAL),
    ("source", SOURCE),
    ("run", RUN),
    ("record", RECORD),
    ("record.full", RECORD_FULL),
    ("record.particles", RECORD_PARTICLES),
    ("record.fields", RECORD_FIELDS),
];

pub use crate::observe::NAMES as MEASURES;

/// Keys of `[initial]` that a start from a log leaves no room for; setting `positions` to a log on the
/// command line removes them.
pub(super) const WITHOUT_A_LOG: &[&str] = &["velocities", "equilibrate"];

/// Keys of which a scenario has one; setting one on the command line removes the others.
pub(super) const EITHER_OR: &[(&str, &[&[&str]])] = &[
    ("particles", &[&["count"], &["volume_fraction"]]),
    ("particles", &[&["diameter", "mass"], &["species"]]),
    ("record", &[&["frames", "spacing"], &["every"]]),
    ("record", &[&["states"], &["state_every"]]),
    ("engine.time_step", &[&["fixed"], &["collisions_per_particle"], &["crossing"]]),
    ("engine.impact_parameter", &[&["collisions_per_particle", "c"], &["table"]]),
    ("engine.hsmc.entry_probability", &[&["volume_fraction", "probability"], &["table"]]),
    ("initial.velocities", &[&["maxwell"], &["uniform"]]),
];
