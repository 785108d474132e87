//! temporary
use super::rules::Cure;
use crate::law::pair_collision::PairOfGrains;
use crate::random::Stream;
use crate::space::Vector;
impl Cure {
    pub fn restitution(&self, nominal: f64, _speed: f64, _waits: [Option<f64>; 2]) -> (f64, bool) {
        (nominal, false)
    }
    pub fn turn<V: Vector>(&self, _pair: &PairOfGrains, _separation: V, _velocities: &mut [V; 2], _random: &mut Stream) {}
    pub fn turn_at_wall<V: Vector>(&self, after: V, _wall: V, _inward: V, _random: &mut Stream) -> V {
        after
    }
}
#[derive(Debug, Default)]
pub struct CollapseWatch;
impl CollapseWatch {
    pub fn note(&mut self, _row: u32, _collisions: u32, _now: f64, _span: f64) -> Option<u32> {
        None
    }
    pub fn forget(&mut self) {}
}
