//! Choices that a scenario makes for the event-driven engine.

/// How the engine works.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EventDrivenRules {
    /// How partners are found.
    pub structure: Structure,
    /// What prevents inelastic collapse.
    pub cure: Cure,
}

/// How the partners of a grain are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Structure {
    /// Cells or neighbour lists, by the counts of events.
    #[default]
    Automatic,
    /// The cells around its own.
    Cells,
    /// A list of the grains nearby.
    NeighbourLists,
}

/// Cures of inelastic collapse (Simić 2017, section 5.2); those that are given act together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cure {
    /// A collision with a normal relative speed below this one is elastic [length/time].
    pub elastic_below: Option<f64>,
    /// A collision is elastic when either partner has collided less than this time ago [time]: the TC
    /// model (Luding and McNamara 1998).
    pub contact_time: Option<f64>,
    /// An inelastic collision turns the relative velocity by a random angle up to this one [radian].
    pub rotation: Option<f64>,
}

/// The speed of [`Cure::elastic_below`] with which grains that come to rest under `gravity` have been followed to the end
/// [length/time]: 0.3 √(g d). docs/event-driven.md has the runs, among them those that ended in collapse with a third of it.
pub fn resting_speed(gravity: f64, diameter: f64) -> f64 {
    0.3 * (gravity * diameter).sqrt()
}
