//! The messages of this program's own: profiles and states.
//!
//! Fields may be added with new numbers; none is ever given another number or meaning.

use super::message;

message! {
    /// A column of a profile.
    "grainflow" "grainflow/ProfileColumn.proto" ProfileColumn {
        /// Name, in snake case.
        name: String = 1 [string],
        /// Unit, such as `mass length^2 time^-2`; `1` for a pure number.
        unit: String = 2 [string],
        /// `[row]`.
        values: Vec<f64> = 3 [double, repeated],
    }
}

message! {
    /// A table at one time.
    "grainflow" "grainflow/Profile.proto" Profile {
        /// When it was taken, or when its average ended [time].
        time: f64 = 1 [double],
        /// The measure's name.
        name: String = 2 [string],
        /// The abscissa, then what depends on it.
        columns: Vec<ProfileColumn> = 3 [message, repeated] ".grainflow.ProfileColumn",
    }
}

message! {
    /// What the next step reads beside the grains.
    "grainflow" "grainflow/Engine.proto" Engine {
        /// Steps made.
        step: u64 = 1 [uint64],
        /// Largest speed of the flights of the last step, from which the next one gets its length [length/time], or −1.
        largest_speed: Option<f64> = 2 [double, optional],
        /// Collisions per time that the next step expects [1/time], or −1.
        collision_rate: Option<f64> = 3 [double, optional],
    }
}

message! {
    /// Sums since the start of the run.
    "grainflow" "grainflow/Totals.proto" Totals {
        /// Steps made.
        steps: u64 = 1 [uint64],
        /// Steps that the cap shortened.
        steps_capped: u64 = 2 [uint64],
        /// Grains poured.
        poured: u64 = 3 [uint64],
        /// Σ 2ΔC/N.
        collisions_per_particle: Option<f64> = 4 [double, optional],
        /// Σ N over steps.
        particle_steps: u64 = 5 [uint64],
        /// Collisions of pairs of grains.
        collisions: u64 = 6 [uint64],
        /// Candidate pairs that were looked at.
        candidates: u64 = 7 [uint64],
        /// Collisions of pairs of cells.
        cell_collisions: u64 = 8 [uint64],
        /// Moves that were rejected for lack of room.
        rejected_moves: u64 = 9 [uint64],
        /// Grains that left through an open side.
        removed: u64 = 10 [uint64],
        /// Momentum given to the walls, `[axis][side][component]` with 3 axes [mass·length/time].
        wall_momentum: Vec<f64> = 11 [double, repeated],
        /// Σ p·s [mass·length²/time].
        carried_momentum: Option<f64> = 12 [double, optional],
        /// Events, of engines that have them.
        events: Option<Events> = 13 [message, optional] ".grainflow.Events",
        /// Grains since their number last changed.
        since_grains: u64 = 14 [uint64],
        /// Collisions up to then.
        since_collisions: u64 = 15 [uint64],
        /// Collisions per particle up to then.
        since_collisions_per_particle: Option<f64> = 16 [double, optional],
    }
}

message! {
    /// What the events of an event-driven engine were.
    "grainflow" "grainflow/Events.proto" Events {
        /// Events of every kind.
        all: u64 = 1 [uint64],
        /// Hits on walls.
        wall_hits: u64 = 2 [uint64],
        /// Crossings from cell to cell.
        crossings: u64 = 3 [uint64],
        /// Renewals of neighbour lists.
        list_renewals: u64 = 4 [uint64],
        /// Collisions called off because the partner had met another grain before.
        annulled: u64 = 5 [uint64],
        /// Collisions, of pairs and with walls, that a cure of inelastic collapse has changed.
        cured: u64 = 6 [uint64],
        /// Collisions of pairs in equal bins of the impact parameter |b|/d, 0 … 1.
        impacts: Vec<u64> = 7 [uint64, repeated],
    }
}

message! {
    /// What a run began with.
    "grainflow" "grainflow/Beginning.proto" Beginning {
        /// Grains at t = 0.
        particles: u64 = 1 [uint64],
        /// Kinetic energy at t = 0 [mass·length²/time²].
        kinetic_energy: Option<f64> = 2 [double, optional],
        /// Momentum at t = 0 [mass·length/time].
        momentum: Vec<f64> = 3 [double, repeated],
        /// Σ m|v| at t = 0 [mass·length/time].
        momentum_scale: Option<f64> = 4 [double, optional],
    }
}

message! {
    /// What a measure remembers.
    "grainflow" "grainflow/Memory.proto" Memory {
        /// The measure's name.
        name: String = 1 [string],
        /// Its memory.
        values: Vec<f64> = 2 [double, repeated],
    }
}

message! {
    /// A saved state, or one part of it: rows `first_row` … of `grains`. The first part holds
    /// everything that is not a column.
    "grainflow" "grainflow/State.proto" State {
        /// Simulated time [time].
        time: Option<f64> = 1 [double, optional],
        /// Rounding held back by the clock [time].
        compensation: Option<f64> = 2 [double, optional],
        /// D, 2 or 3.
        dimension: u32 = 3 [uint32],
        /// Grains in the whole state.
        grains: u64 = 4 [uint64],
        /// The row that this part starts with.
        first_row: u64 = 5 [uint64],
        /// Positions `[grain][axis]` as float64, little-endian [length].
        positions: Vec<u8> = 6 [bytes = "vec"],
        /// Velocities `[grain][axis]` as float64, little-endian [length/time].
        velocities: Vec<u8> = 7 [bytes = "vec"],
        /// Identities `[grain]` as uint32, little-endian.
        ids: Vec<u8> = 8 [bytes = "vec"],
        /// Angular velocities `[grain][component]` as float64, little-endian [1/time].
        spins: Option<Vec<u8>> = 9 [bytes = "vec", optional],
        /// Species `[grain]` as uint8.
        species: Option<Vec<u8>> = 10 [bytes = "vec", optional],
        /// The next identity to be given.
        next_id: u32 = 11 [uint32],
        /// What the engine remembers.
        engine: Option<Engine> = 12 [message, optional] ".grainflow.Engine",
        /// Sums since the start of the run.
        totals: Option<Totals> = 13 [message, optional] ".grainflow.Totals",
        /// When the last grain was poured [time]; −1 before.
        last_poured: Option<f64> = 14 [double, optional],
        /// Recordings made.
        recordings: u64 = 15 [uint64],
        /// Samples taken, by measure.
        samples: Vec<u64> = 16 [uint64, repeated],
        /// Memories of the measures.
        memories: Vec<Memory> = 17 [message, repeated] ".grainflow.Memory",
        /// What the run began with.
        beginning: Option<Beginning> = 18 [message, optional] ".grainflow.Beginning",
        /// States saved before this one.
        states: u64 = 19 [uint64],
        /// Until when the source is held up by grains in its way [time].
        held_until: Option<f64> = 20 [double, optional],
        /// Share of this part in what an event-driven engine holds, as float64, little-endian.
        engine_numbers: Vec<u8> = 21 [bytes = "vec"],
        /// The same, as uint32, little-endian.
        engine_words: Vec<u8> = 22 [bytes = "vec"],
        /// Overlaps found by audits, of engines that allow none.
        invalid_states: Option<u64> = 23 [uint64, optional],
        /// Largest speed of the grains of the state [length/time].
        largest_speed: Option<f64> = 24 [double, optional],
    }
}
