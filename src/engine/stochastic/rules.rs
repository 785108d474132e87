//! Choices that a user makes about the stochastic engines.

/// How the length of a step is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeStep {
    /// Always this long [time].
    Fixed(f64),
    /// This many collisions per particle and step, in the local frame of each cell.
    CollisionsPerParticle(f64),
    /// This fraction of a cell at the largest speed.
    Crossing(f64),
}

impl TimeStep {
    /// Collisions that a grain may have in a step at most, on an average: beyond that pairs that should have parted long ago
    /// collide again, and candidates outnumber grains.
    pub const MOST_COLLISIONS: f64 = 2.0;

    /// The share of min(L/v_max, √(2L/|g|)) that a step may last where a jump over a cell could matter:
    /// an adaptive step keeps a margin of two, a fixed one is obeyed as long as nothing jumps.
    pub fn largest_crossing(self) -> f64 {
        match self {
            TimeStep::Fixed(_) => 1.0,
            TimeStep::CollisionsPerParticle(_) | TimeStep::Crossing(_) => 0.5,
        }
    }
}

/// Where the Enskog factor g(ν) takes its density from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnskogFactor {
    /// ν = N_c V_p/V_c of the cell.
    Local,
    /// ν = (N_c − ½) V_p/V_c.
    HalfGrain,
    /// ν of the 3ᴰ cells around.
    Smoothed,
}

/// How a collision displaces its partners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transfer {
    /// By d along the own change of momentum (Alexander et al. 1995): exact for r = 1.
    MomentumChange,
    /// By c(r) d along the relative velocity after the collision: the pressure of Enskog theory for every r.
    Corrected,
}

/// Rules of HSMC beside those of CBA.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HsmcRules {
    /// ν_max of a full cell.
    pub maximum_volume_fraction: f64,
    /// Restitution of cell–cell collisions, resolved: in [0, 1].
    pub cell_restitution: f64,
    /// Sweeps of cell–cell collisions per step, at least 1.
    pub sweeps: u32,
    /// Who may enter a cell.
    pub admission: Admission,
    /// When a displacement is made.
    pub displacement: DisplacementRule,
}

/// Who may enter a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Admission {
    /// Never more than the capacity; departures are credited; surplus arrivals lose by rank.
    Strict,
    /// Open to any number when below the capacity at the start of the move (Müller 2001).
    Thesis,
}

/// When a displacement is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplacementRule {
    /// Both partners or none; not from full cells, not into full cells, not through walls.
    Paired,
    /// Not from full cells (Müller 2001); targets are not looked at, walls are respected.
    Thesis,
}
