//! What a step did, and the sums over all steps.

use crate::space::Vector;

/// What one step did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport<V> {
    /// Length of the step [time].
    pub duration: f64,
    /// Whether the cap on the step shortened it.
    pub capped: bool,
    /// What happened in it.
    pub counts: Counts<V>,
}

/// Countable and summable things that steps do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts<V> {
    /// Collisions of pairs of grains.
    pub collisions: u64,
    /// Candidate pairs that were looked at.
    pub candidates: u64,
    /// Collisions of pairs of cells.
    pub cell_collisions: u64,
    /// Moves that were rejected for lack of room.
    pub rejected_moves: u64,
    /// Grains that left through an open side.
    pub removed: u64,
    /// Momentum given to the walls, `[axis][side]` [mass·length/time].
    pub wall_momentum: [[V; 2]; 3],
    /// Σ p·s: momentum that displacements and cell collisions carry times the way it is carried
    /// [mass·length²/time]; over D·V·time it is the collisional pressure.
    pub carried_momentum: f64,
}

impl<V: Vector> Counts<V> {
    /// Adds what `other` counted.
    pub fn add(&mut self, other: &Self) {
        self.collisions += other.collisions;
        self.candidates += other.candidates;
        self.cell_collisions += other.cell_collisions;
        self.rejected_moves += other.rejected_moves;
        self.removed += other.removed;
        self.carried_momentum += other.carried_momentum;
        for (mine, theirs) in self.wall_momentum.iter_mut().zip(&other.wall_momentum) {
            mine[0] += theirs[0];
            mine[1] += theirs[1];
        }
    }
}

/// Sums since the start of the run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Totals<V> {
    /// Steps made.
    pub steps: u64,
    /// Steps that the cap shortened.
    pub steps_capped: u64,
    /// Grains poured.
    pub poured: u64,
    /// Σ 2ΔC/N, collisions per particle.
    pub collisions_per_particle: f64,
    /// Σ N over steps: particle-steps.
    pub particle_steps: u64,
    /// Everything that steps count.
    pub counts: Counts<V>,
}

impl<V: Vector> Totals<V> {
    /// Adds one step of a gas of `grains` grains.
    pub fn add(&mut self, report: &StepReport<V>, grains: usize) {
        self.steps += 1;
        self.steps_capped += u64::from(report.capped);
        self.particle_steps += grains as u64;
        if grains > 0 {
            self.collisions_per_particle += 2.0 * report.counts.collisions as f64 / grains as f64;
        }
        self.counts.add(&report.counts);
    }
}
