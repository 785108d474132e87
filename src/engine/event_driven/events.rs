//! What happens at an event (Miller 2004, section 2.4).

use super::body::{Contact, Event, Face, Plan};
use super::collapse::{cured_restitution, turn_relative_velocity};
use super::rules::Cure;
use super::world::World;
use crate::engine::EngineError;
use crate::engine::report::IMPACT_BINS;
use crate::law::boundary::WallKind;
use crate::law::pair_collision::{Meeting, PairOfGrains};
use crate::law::restitution::{Restitution, RestitutionLaw};
use crate::random::{Phase, Stream};
use crate::space::Vector;

impl<V: Vector> World<V> {
    /// The grain in `row` meets its partner, unless that has met another grain before.
    pub(super) fn collide(&mut self, row: u32) -> Result<(), EngineError> {
        let Contact { partner, collisions, .. } = self.plans[row as usize].contact;
        self.advance(row);
        if self.bodies[partner as usize].collisions != collisions {
            self.events.annulled += 1;
            self.foresee(row);
            return Ok(());
        }
        self.advance(partner);
        // Who has foreseen the collision must not matter for the angle that a turn draws.
        let turns = self.laws.cure.rotation.is_some();
        let (row, partner) = match turns && self.ids[partner as usize] < self.ids[row as usize] {
            true => (partner, row),
            false => (row, partner),
        };
        let [one, other] = [row, partner].map(|row| self.bodies[row as usize]);
        let mut velocities = [one.velocity, other.velocity];
        let separation = self.nearest_image(other.position - one.position);
        let mut meeting = Meeting::of(separation, &velocities);
        if self.laws.growth.rate != 0.0 {
            // The surfaces approach faster than the centres (Miller 2004, equation 2.17). The product is the one
            // by which the contact was foreseen, to the last bit.
            let distance = self.contact_distance(row, partner);
            meeting.approach += distance * self.scale_now() * (distance * self.laws.growth.rate);
        }
        // A rounding may make a grazing pair pass: the event is evaluated again, now that both stand here.
        if meeting.approach > 0.0 {
            self.count_in_its_cell(one.position, separation);
            self.exchange_momentum(row, partner, &meeting, &mut velocities);
            for (row, velocity) in [(row, velocities[0]), (partner, velocities[1])] {
                self.bodies[row as usize].velocity = velocity;
                self.note_collision(row)?;
            }
        }
        self.foresee(row);
        self.foresee(partner);
        Ok(())
    }

    /// Two grains that touch and approach exchange momentum; the collision is counted.
    fn exchange_momentum(&mut self, row: u32, partner: u32, meeting: &Meeting<V>, velocities: &mut [V; 2]) {
        let speed = meeting.normal_speed();
        let waits = [row, partner].map(|row| self.time_since_collision(row));
        let nominal = restitution_at(self.laws.restitution, speed);
        let (restitution, mut cured) = cured_restitution(&self.laws.cure, nominal, speed, waits);
        let pair = PairOfGrains::of(self.grain(row), self.grain(partner));
        let mut transferred = match (self.laws.roughness, &mut self.spins) {
            (Some(roughness), Some(all)) => {
                let mut spins = [all[row as usize], all[partner as usize]];
                let transferred =
                    meeting.collide_rough(&pair, roughness, restitution, velocities, &mut spins);
                (all[row as usize], all[partner as usize]) = (spins[0], spins[1]);
                transferred
            }
            _ => meeting.collide_smooth(&pair, restitution, velocities),
        };
        if let Some(largest) = self.laws.cure.rotation.filter(|_| restitution < 1.0) {
            let mut random = self.stream(row, Phase::Rotation);
            transferred +=
                turn_relative_velocity(largest, &pair, meeting.separation, velocities, &mut random);
            cured = true;
        }
        if restitution == 1.0 {
            part(meeting, &pair, velocities);
        }
        let distance = meeting.distance_squared.sqrt();
        let head_on = meeting.approach * meeting.approach
            / (meeting.distance_squared * meeting.relative_velocity.length_squared());
        let impact = (1.0 - head_on).max(0.0).sqrt() * IMPACT_BINS as f64;
        self.events.impacts[(impact as usize).min(IMPACT_BINS - 1)] += 1;
        self.events.cured += u64::from(cured);
        self.counts.collisions += 1;
        self.pace.collisions += 1;
        self.counts.carried_momentum += transferred * distance;
    }

    /// The grain in `row` has collided, with a grain or a wall.
    fn note_collision(&mut self, row: u32) -> Result<(), EngineError> {
        if let Some(last) = &mut self.last_collisions {
            last[row as usize] = self.now;
        }
        self.note_contact(row)
    }

    /// The grain in `row` was in contact, whether or not that changed anything: at rest on a floor it is so
    /// without end.
    fn note_contact(&mut self, row: u32) -> Result<(), EngineError> {
        let body = &mut self.bodies[row as usize];
        body.collisions = body.collisions.wrapping_add(1);
        let span = self.pace.shortest_span;
        match self.watch.note(row, body.collisions, self.now, span) {
            None => Ok(()),
            Some(collisions) => {
                let remedy = self.remedy();
                Err(EngineError::Collapse {
                    id: self.ids[row as usize],
                    collisions,
                    span,
                    seed: self.laws.seed,
                    time: self.origin.time() + self.now,
                    remedy,
                })
            }
        }
    }

    /// A cure that goes on where this one did not do. Under gravity it is no less than what has been tried. A contact time alone
    /// is none there: it would take the collisions of grains at rest for lasting contacts.
    fn remedy(&self) -> Cure {
        let cure = self.laws.cure;
        let stronger = Cure {
            elastic_below: cure.elastic_below.map(|speed| 2.0 * speed),
            contact_time: cure.contact_time.map(|time| 10.0 * time),
            rotation: cure.rotation,
        };
        let (gravity, boundary) = (self.laws.gravity, &self.laws.boundary);
        if (0..V::DIMENSION).any(|axis| gravity[axis] != 0.0 && !boundary.is_periodic(axis)) {
            let tried = Cure::at_rest(gravity.length(), self.laws.largest_diameter());
            // What lacks a part of it is completed first.
            let is_less = tried.or_more(cure) != cure;
            return if is_less { cure.or_more(tried) } else { stronger };
        }
        let short = 1e-3 * self.pace.time_between_events(self.bodies.len());
        stronger.or_more(Cure { contact_time: Some(short), ..Cure::default() })
    }

    /// Time since the grain in `row` last collided, where a cure asks for it [time].
    fn time_since_collision(&self, row: u32) -> Option<f64> {
        self.last_collisions.as_ref().map(|last| self.now - last[row as usize])
    }

    /// Random numbers for this collision of the grain in `row`.
    fn stream(&self, row: u32, phase: Phase) -> Stream {
        let collisions = u64::from(self.bodies[row as usize].collisions);
        self.laws.streams.at(collisions, phase).stream(u64::from(self.ids[row as usize]))
    }

    /// The grain in `row` leaves its cell, or the surroundings of its list.
    pub(super) fn cross(&mut self, row: u32, face: Face) {
        self.advance(row);
        let plan = self.plans[row as usize];
        self.pace.crossings += 1;
        self.pace.crossings_since_order += 1;
        self.cells.remove(row, &mut self.bodies, &mut self.plans);
        if self.lists.is_some() {
            self.events.list_renewals += 1;
            self.renew_list(row);
            self.foresee(row);
            return;
        }
        self.events.crossings += 1;
        let (cell, shift) = self.cells.beyond(plan.cell, face);
        self.bodies[row as usize].position[face.axis()] += shift;
        self.cells.insert(cell, row, &mut self.bodies, &mut self.plans);
        // Grains in the cells that it sees already were looked at when its path began.
        let contact = self.next_contact(row, Some(face), plan.contact);
        self.settle(row, contact);
    }

    /// Moves the anchor of the grain in `row`, which is in no cell, to where it is.
    fn renew_list(&mut self, row: u32) {
        let mut position = self.bodies[row as usize].position;
        for axis in (0..V::DIMENSION).filter(|&axis| self.laws.boundary.is_periodic(axis)) {
            let period = self.laws.size[axis];
            if position[axis] < 0.0 {
                position[axis] += period;
            } else if position[axis] >= period {
                position[axis] -= period;
            }
        }
        self.bodies[row as usize].position = position;
        if let Some(lists) = &mut self.lists {
            lists.withdraw(row);
            lists.anchor(row, position);
        }
        let cell = self.cells.cell_of(position);
        self.cells.insert(cell, row, &mut self.bodies, &mut self.plans);
        self.find_neighbours(row);
    }

    /// The grain in `row` hits the wall at `face`.
    pub(super) fn hit_wall(&mut self, row: u32, face: Face) -> Result<(), EngineError> {
        self.advance(row);
        let wall = self.walls.wall(face);
        let axis = face.axis();
        let grain = self.grain(row);
        let inward = if face.upper { -1.0 } else { 1.0 };
        let before = self.bodies[row as usize].velocity;
        // The wall moves, and a growing grain meets it sooner.
        let surface =
            self.walls.speed(face, self.now) + inward * 0.5 * grain.diameter * self.laws.growth.rate;
        let normal = before[axis] - surface;
        if inward * normal < 0.0 {
            let wait = self.time_since_collision(row);
            let (restitution, mut cured) =
                cured_restitution(&self.laws.cure, wall.restitution, normal.abs(), [wait; 2]);
            let mut after = self.along_wall(row, wall.kind, before);
            after[axis] = before[axis] - (1.0 + restitution) * normal;
            if let Some(largest) = self.laws.cure.rotation.filter(|_| restitution < 1.0) {
                let mut random = self.stream(row, Phase::Rotation);
                let frame = V::along(axis, surface);
                let mut turned = (after - frame).turns(largest, &mut random).into_iter();
                after =
                    turned.find(|turned| inward * turned[axis] > 0.0).map_or(after, |turned| turned + frame);
                cured = true;
            }
            self.bodies[row as usize].velocity = after;
            self.counts.wall_momentum[axis][face.side()] += (before - after) * grain.mass;
            self.events.wall_hits += 1;
            self.events.cured += u64::from(cured);
            self.note_collision(row)?;
        } else {
            self.note_contact(row)?;
        }
        self.foresee(row);
        Ok(())
    }

    /// The velocity of the grain in `row` after a hit on a wall of this kind, but for its normal part.
    fn along_wall(&self, row: u32, kind: WallKind<V>, before: V) -> V {
        match kind {
            WallKind::Smooth | WallKind::Vibrating { .. } => before,
            WallKind::Rough { velocity } => velocity * 2.0 - before,
            WallKind::Statistical { reversal_probability } => {
                let reversed = self.stream(row, Phase::Wall).uniform() < reversal_probability;
                if reversed { -before } else { before }
            }
        }
    }

    /// The grain in `row` leaves the box through an open side.
    pub(super) fn leave(&mut self, row: u32) {
        self.advance(row);
        self.cells.remove(row, &mut self.bodies, &mut self.plans);
        if let Some(lists) = &mut self.lists {
            lists.withdraw(row);
        }
        // Nobody meets it any more.
        let body = &mut self.bodies[row as usize];
        body.collisions = body.collisions.wrapping_add(1);
        self.plans[row as usize] = Plan { event: Event::Gone, ..Plan::default() };
        self.counts.removed += 1;
        self.removals.push(self.counts.collisions);
        self.pace.gone += 1;
    }

    /// The future of the grain in `row` is looked into once more.
    pub(super) fn look_again(&mut self, row: u32) {
        self.advance(row);
        self.foresee(row);
    }
}

/// Rounding swallows what an elastic collision changes where two grains all but slide along each other: they would
/// collide again and again at the same moment. The smallest change that rounding leaves parts them.
fn part<V: Vector>(meeting: &Meeting<V>, pair: &PairOfGrains, velocities: &mut [V; 2]) {
    // What growth adds to the approach is the same after the collision.
    let growth = meeting.approach - meeting.relative_velocity.dot(meeting.separation);
    let mut change =
        f64::EPSILON * (velocities[0] - velocities[1]).length() / meeting.distance_squared.sqrt();
    for _ in 0..64 {
        if Meeting::of(meeting.separation, velocities).approach + growth <= 0.0 {
            return;
        }
        velocities[0] -= meeting.separation * (change * pair.shares[0]);
        velocities[1] += meeting.separation * (change * pair.shares[1]);
        change *= 2.0;
    }
}

fn restitution_at(law: RestitutionLaw, normal_speed: f64) -> f64 {
    match law {
        RestitutionLaw::Constant(law) => law.at(normal_speed),
        RestitutionLaw::VelocityDependent(law) => law.at(normal_speed),
    }
}
