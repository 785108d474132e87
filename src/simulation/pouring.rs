//! The pouring source at work.

use crate::engine::Engine;
use crate::law::source::Source;
use crate::matter::gas::Gas;
use crate::random::{Phase, Streams};
use crate::scenario::model::Scenario;
use crate::space::Vector;

/// Width of a place of the grid in which the highest full place is looked for, in diameters.
const PLACE_WIDTH: f64 = 2.0;

/// Why nothing can be poured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PouringError {
    /// The spout has left the box.
    #[error(
        "the heap has grown too high for its box at t = {time}: grains are poured at height {height}, the box \
         ends at {end}; enlarge `domain.size` along gravity or lower `source.height`"
    )]
    AboveTheBox {
        /// Height of the spout [length].
        height: f64,
        /// Upper end of the box along gravity [length].
        end: f64,
        /// When [time].
        time: f64,
    },
}

/// Time after which a grain that overlapped another one is tried again, in times between two grains.
const RETRY: f64 = 0.05;

/// Where a new grain finds room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Room {
    /// Everywhere.
    Everywhere,
    /// In cells of fewer grains than this.
    Cells(u32),
    /// Where it overlaps no other grain.
    Gaps,
}

impl Room {
    /// Where `engine` has room.
    pub fn of<V: Vector>(engine: &dyn Engine<V>, gas: &Gas<V>) -> Self {
        if engine.excludes_overlap() {
            return Room::Gaps;
        }
        engine.capacity(gas).map_or(Room::Everywhere, Room::Cells)
    }
}

/// A source and what it has poured so far.
#[derive(Clone, Debug)]
pub struct Pouring<V> {
    source: Source<V>,
    streams: Streams,
    axis: usize,
    /// +1 where up is along the axis, −1 where gravity points along it.
    up: f64,
    gravity: V,
    poured: u32,
    last_poured: f64,
    /// No grain comes before [time].
    held_until: f64,
}

impl<V: Vector> Pouring<V> {
    /// The source of `scenario`, with nothing poured yet.
    pub fn new(source: Source<V>, scenario: &Scenario<V>) -> Self {
        let gravity = scenario.gravity;
        let axis = (0..V::DIMENSION)
            .max_by(|&a, &b| gravity[a].abs().total_cmp(&gravity[b].abs()))
            .expect("a space has axes");
        let up = if gravity[axis] < 0.0 { 1.0 } else { -1.0 };
        Pouring {
            source,
            streams: Streams::new(scenario.seed),
            axis,
            up,
            gravity,
            poured: 0,
            last_poured: -1.0,
            held_until: 0.0,
        }
    }

    /// Goes on after `poured` grains, the last of them at `last_poured`; none comes before `held_until`. `None` where the
    /// source never comes to that.
    #[must_use]
    pub fn restore(&mut self, poured: u64, last_poured: f64, held_until: f64) -> Option<()> {
        let poured = u32::try_from(poured).ok().filter(|&poured| poured <= self.source.count)?;
        if !(last_poured.is_finite() && held_until.is_finite()) {
            return None;
        }
        (self.poured, self.last_poured, self.held_until) = (poured, last_poured, held_until);
        Some(())
    }

    /// Whether all grains are poured.
    pub fn is_done(&self) -> bool {
        self.poured >= self.source.count
    }

    /// When the last grain was poured [time]; −1 before the first.
    pub fn last_poured(&self) -> f64 {
        self.last_poured
    }

    /// Until when the source is held up by grains in its way [time]; 0 where it never was.
    pub fn held_until(&self) -> f64 {
        self.held_until
    }

    /// When the next grain is due, or is tried again [time]. Its rounding is part of the trajectory: grains come at these times
    /// and at no others, and nothing here is compared with slack, as schedules of recordings are.
    pub fn next_time(&self) -> Option<f64> {
        let nominal = f64::from(self.poured) / self.source.rate;
        (!self.is_done()).then(|| nominal.max(self.held_until))
    }

    /// Adds the grains that are due; one that finds no room waits. Returns how many came.
    pub fn pour(&mut self, gas: &mut Gas<V>, room: Room) -> Result<u64, PouringError> {
        let mut came = 0;
        while self.next_time().is_some_and(|due| gas.time() >= due) {
            let position = self.spout(gas)?;
            match room {
                Room::Cells(capacity) if gas.occupancy(gas.grid().cell_of(position)) >= capacity => break,
                Room::Gaps if overlaps(gas, position) => {
                    self.held_until = (gas.time() + RETRY / self.source.rate).max(gas.time().next_up());
                    break;
                }
                Room::Everywhere | Room::Cells(_) | Room::Gaps => {}
            }
            gas.insert(position, self.source.velocity);
            self.poured += 1;
            self.last_poured = gas.time();
            came += 1;
        }
        Ok(came)
    }

    /// Where the next grain begins: above the highest full place, somewhere across the spout.
    fn spout(&self, gas: &Gas<V>) -> Result<V, PouringError> {
        let mut random = self.streams.at(u64::from(self.poured), Phase::Source).stream(0);
        let ground = if self.up > 0.0 { gas.grid().origin() } else { gas.grid().end() }[self.axis];
        let height = self.top_of_full_places(gas) + self.source.height;
        if height >= gas.grid().size()[self.axis] {
            let (end, time) = (gas.grid().size()[self.axis], gas.time());
            return Err(PouringError::AboveTheBox { height, end, time });
        }
        Ok(V::from_fn(|axis| {
            if axis == self.axis {
                ground + self.up * height
            } else {
                self.source.position[axis] + 0.5 * self.source.width * random.symmetric()
            }
        }))
    }

    /// Height above the ground of the upper side of the highest place that is full: a place is a cube
    /// two diameters wide, full at random close packing. 0 while none is full. Where the stream from the spout is so dense
    /// that it fills half a place by itself, grains that have met nothing yet do not count, nor do places that fall: they are on
    /// their way, and nothing lies on them.
    fn top_of_full_places(&self, gas: &Gas<V>) -> f64 {
        let width =
            PLACE_WIDTH * gas.species.iter().fold(gas.grain.diameter, |d, grain| d.max(grain.diameter));
        let grid = gas.grid();
        let places: Vec<usize> =
            (0..V::DIMENSION).map(|a| (grid.size()[a] / width).ceil().max(1.0) as usize).collect();
        let volume = gas.grain.volume::<V>();
        let full = (V::RANDOM_CLOSE_PACKING * width.powi(V::DIMENSION as i32) / volume).floor();
        let is_mixture = !gas.species.is_empty();
        // Grains in each place, counted by their volumes where those differ.
        let mut counts = vec![0.0; places.iter().product()];
        // How fast they fall, summed in the same way, where that has to be known.
        let is_dense = 2.0 * self.source.in_flight(self.gravity, width) >= full;
        let mut falling = vec![0.0; if is_dense { counts.len() } else { 0 }];
        let mut top = 0;
        for (row, &position) in gas.positions().iter().enumerate() {
            if is_dense && self.falls_freely(gas.velocities()[row]) {
                continue;
            }
            let (mut place, mut level) = (0, 0);
            for axis in (0..V::DIMENSION).rev() {
                let upwards = axis != self.axis || self.up > 0.0;
                let x = if upwards {
                    position[axis] - grid.origin()[axis]
                } else {
                    grid.end()[axis] - position[axis]
                };
                let k = ((x / width) as usize).min(places[axis] - 1);
                place = place * places[axis] + k;
                level = if axis == self.axis { k + 1 } else { level };
            }
            let share = if is_mixture { gas.grain_at(row).volume::<V>() / volume } else { 1.0 };
            counts[place] += share;
            if is_dense {
                falling[place] -= share * self.up * gas.velocities()[row][self.axis];
            } else if counts[place] >= full {
                top = top.max(level);
            }
        }
        if is_dense {
            top = self.top_of_what_lies((width, full), &places, &counts, &falling);
        }
        top as f64 * width
    }

    /// Whether a grain of this velocity has met nothing since the spout let it go: gravity changes its velocity along one
    /// axis alone, and downwards alone, while a collision with another grain changes the others as well.
    fn falls_freely(&self, velocity: V) -> bool {
        (0..V::DIMENSION).all(|axis| match axis == self.axis {
            true => self.up * velocity[axis] <= self.up * self.source.velocity[axis],
            false => velocity[axis] == self.source.velocity[axis],
        })
    }

    /// The level of the highest place that is `full` and lies. Places lie that are at least half full and stand on the ground or on
    /// places that lie, and whose grains are slower, on an average, than half of what a fall by the height of a place gives: grains
    /// of a stream from rest are faster from the second place on.
    fn top_of_what_lies(
        &self,
        (width, full): (f64, f64),
        places: &[usize],
        counts: &[f64],
        falling: &[f64],
    ) -> usize {
        let most = 0.5 * (self.gravity.length() * width).sqrt();
        let layer: usize = places[..self.axis].iter().product();
        let mut lie = vec![false; counts.len()];
        let mut top = 0;
        for place in 0..counts.len() {
            let level = place / layer % places[self.axis];
            let is_carried = level == 0 || lie[place - layer];
            lie[place] = is_carried && 2.0 * counts[place] >= full && falling[place] < most * counts[place];
            if lie[place] && counts[place] >= full {
                top = top.max(level + 1);
            }
        }
        top
    }
}

/// Whether a grain of the first species at `position` would overlap another one.
fn overlaps<V: Vector>(gas: &Gas<V>, position: V) -> bool {
    gas.positions().iter().enumerate().any(|(row, &other)| {
        let contact = 0.5 * (gas.grain.diameter + gas.grain_at(row).diameter);
        gas.grid().separation(position, other).length_squared() < contact * contact
    })
}
