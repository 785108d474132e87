//! The state as numbers and words, to be saved and taken up again bit for bit.

use super::body::{Body, Contact, Event, Face, NONE, Plan};
use super::calendar::Entry;
use super::cells::Cells;
use super::collapse::CollapseWatch;
use super::laws::Laws;
use super::lists::Lists;
use super::rules::Structure;
use super::world::World;
use super::year::Pace;
use crate::engine::{EngineMisfit, EngineState};
use crate::matter::clock::Clock;
use crate::matter::gas::Gas;
use crate::space::Vector;

/// Numbers and words that are read in the order in which they were written.
struct Tape<'a> {
    numbers: std::slice::Iter<'a, f64>,
    words: std::slice::Iter<'a, u32>,
}

const CUT_OFF: EngineMisfit = EngineMisfit("it is cut off");

impl Tape<'_> {
    /// Whether each of the `grains` that follow has, beside `numbers` others, the time of its last collision. It has one where
    /// the run had a contact time when it was saved, whatever cure it goes on with. Behind the grains stands the watch for
    /// collapse, but in older states.
    fn has_last_collisions(&self, grains: u32, numbers: usize) -> Result<bool, EngineMisfit> {
        let (here, grains) = (self.numbers.len(), grains as usize);
        let is_of = |each: usize, watch: usize| here == each * grains + watch;
        match [0, 1].map(|more| is_of(numbers + more, 1)) {
            [false, false] if is_of(numbers, 0) => Ok(false),
            [false, false] if is_of(numbers + 1, 0) => Ok(true),
            [false, false] => Err(CUT_OFF),
            [without, _] => Ok(!without),
        }
    }
    fn number(&mut self) -> Result<f64, EngineMisfit> {
        self.numbers.next().copied().ok_or(CUT_OFF)
    }
    fn word(&mut self) -> Result<u32, EngineMisfit> {
        self.words.next().copied().ok_or(CUT_OFF)
    }
    fn long(&mut self) -> Result<u64, EngineMisfit> {
        Ok(u64::from(self.word()?) | u64::from(self.word()?) << 32)
    }
    /// The watch for collapse, which is what remains; older states have none.
    fn watch(&mut self) -> Result<CollapseWatch, EngineMisfit> {
        if self.numbers.as_slice().is_empty() && self.words.as_slice().is_empty() {
            return Ok(CollapseWatch::default());
        }
        let start = self.number()?;
        let (pairs, rest) = self.words.as_slice().as_chunks::<2>();
        if !(self.numbers.as_slice().is_empty() && rest.is_empty()) {
            return Err(EngineMisfit("it has more numbers than its grains need"));
        }
        Ok(CollapseWatch::restored(start, pairs.iter().map(|&[row, before]| (row, before)).collect()))
    }
    fn vector<V: Vector>(&mut self) -> Result<V, EngineMisfit> {
        let mut vector = V::ZERO;
        for axis in 0..V::DIMENSION {
            vector[axis] = self.number()?;
        }
        Ok(vector)
    }
}

impl<V: Vector> World<V> {
    /// Everything that the next event depends on.
    pub(super) fn state(&self) -> EngineState {
        let mut numbers = vec![
            self.origin.time(),
            self.origin.compensation(),
            self.now,
            self.scale,
            self.calendar.year(),
            self.pace.rate,
            self.pace.planned,
            self.pace.shortest_span,
            self.lists.as_ref().map_or(-1.0, Lists::half_width),
        ];
        let mut words = vec![self.bodies.len() as u32, self.next_id];
        words.extend(self.cells.counts());
        let pace = &self.pace;
        for count in [
            pace.events,
            pace.collisions,
            pace.crossings,
            pace.crossings_since_order,
            pace.arranged_for,
            pace.gone,
        ] {
            words.extend([count as u32, (count >> 32) as u32]);
        }
        for row in 0..self.bodies.len() {
            self.write_grain(row, &mut numbers, &mut words);
        }
        let (start, seen) = self.watch.state();
        numbers.push(start);
        words.extend(seen);
        EngineState { numbers, words, ..EngineState::default() }
    }

    fn write_grain(&self, row: usize, numbers: &mut Vec<f64>, words: &mut Vec<u32>) {
        let (body, plan) = (&self.bodies[row], &self.plans[row]);
        for vector in [body.position, body.velocity] {
            numbers.extend((0..V::DIMENSION).map(|axis| vector[axis]));
        }
        numbers.extend([body.time, plan.time, plan.contact.time]);
        words.extend([self.ids[row], body.collisions, plan.cell, code(plan.event)]);
        words.extend([plan.contact.partner, plan.contact.collisions]);
        if let Some(spins) = &self.spins {
            numbers.extend(spins[row].as_ref());
        }
        if let Some(last) = &self.last_collisions {
            numbers.push(last[row]);
        }
        if let Some(lists) = &self.lists {
            numbers.extend((0..V::DIMENSION).map(|axis| lists.anchors()[row][axis]));
        }
        if let Some(species) = &self.species {
            words.push(u32::from(species[row]));
        }
    }

    /// Takes up what [`World::state`] gave, under the same laws and with the grains of `gas`.
    pub(super) fn restored(
        laws: &Laws<V>,
        structure: Structure,
        state: &EngineState,
        gas: &Gas<V>,
    ) -> Result<Self, EngineMisfit> {
        let mut tape = Tape { numbers: state.numbers.iter(), words: state.words.iter() };
        let mut world = World::empty(laws, structure);
        world.origin = Clock::restored(tape.number()?, tape.number()?);
        (world.now, world.scale) = (tape.number()?, tape.number()?);
        let year = tape.number()?;
        world.pace = Pace {
            rate: tape.number()?,
            planned: tape.number()?,
            shortest_span: tape.number()?,
            ..Pace::default()
        };
        let half_width = tape.number()?;
        let grains = tape.word()?;
        world.next_id = tape.word()?;
        let counts = [tape.word()?, tape.word()?, tape.word()?];
        world.pace.events = tape.long()?;
        world.pace.collisions = tape.long()?;
        world.pace.crossings = tape.long()?;
        world.pace.crossings_since_order = tape.long()?;
        world.pace.arranged_for = tape.long()?;
        world.pace.gone = tape.long()?;
        let lists = (half_width != -1.0).then(|| Lists::new(half_width));
        if year != world.pace.year() {
            return Err(EngineMisfit("its year has another length than its pace"));
        }
        world.check_frame(counts, lists.as_ref().map(Lists::half_width), gas)?;
        let periodic = [0, 1, 2].map(|axis| axis < V::DIMENSION && laws.boundary.is_periodic(axis));
        world.cells = Cells::with_counts(laws.size, counts, periodic);
        world.spins = laws.roughness.map(|_| Vec::new());
        world.species = (!laws.species.is_empty()).then(Vec::new);
        world.last_collisions = laws.cure.contact_time.map(|_| Vec::new());
        let mut anchors = lists.is_some().then(Vec::new);
        let has_last = tape.has_last_collisions(grains, world.numbers_of_a_grain(anchors.is_some()))?;
        for _ in 0..grains {
            world.read_grain(&mut tape, &mut anchors, has_last)?;
        }
        world.watch = tape.watch()?;
        world.lists = lists.map(|mut lists| {
            lists.reset(anchors.unwrap_or_default());
            lists
        });
        world.check_grains(gas)?;
        world.walls.set_origin(world.origin);
        world.link();
        world.calendar.begin(year, world.pace.planned);
        for (row, plan) in world.plans.iter().enumerate() {
            world.calendar.write(Entry { time: plan.time, id: world.ids[row], row: row as u32 });
        }
        Ok(world)
    }

    /// Numbers of a grain on a tape, without the time of its last collision.
    fn numbers_of_a_grain(&self, has_anchor: bool) -> usize {
        let spin = self.spins.as_ref().map_or(0, |_| V::Spin::default().as_ref().len());
        2 * V::DIMENSION + 3 + spin + if has_anchor { V::DIMENSION } else { 0 }
    }

    /// Reads the next grain, with the time of its last collision where the tape `has_last` collisions.
    fn read_grain(
        &mut self,
        tape: &mut Tape<'_>,
        anchors: &mut Option<Vec<V>>,
        has_last: bool,
    ) -> Result<(), EngineMisfit> {
        let (position, velocity) = (tape.vector()?, tape.vector()?);
        let (time, plan_time, contact_time) = (tape.number()?, tape.number()?, tape.number()?);
        self.ids.push(tape.word()?);
        self.bodies.push(Body { position, velocity, time, collisions: tape.word()?, next: NONE });
        let cell = tape.word()?;
        let event =
            event(tape.word()?).filter(is_along_an_axis::<V>).ok_or(EngineMisfit("an event is none"))?;
        let contact = Contact { time: contact_time, partner: tape.word()?, collisions: tape.word()? };
        self.plans.push(Plan { time: plan_time, contact, cell, event });
        if let Some(spins) = &mut self.spins {
            let mut spin = V::Spin::default();
            for component in spin.as_mut() {
                *component = tape.number()?;
            }
            spins.push(spin);
        }
        // A contact time that comes with a new cure knows of no collision before.
        let last = if has_last { tape.number()? } else { f64::NEG_INFINITY };
        self.last_collisions.iter_mut().for_each(|all| all.push(last));
        if let Some(anchors) = anchors {
            anchors.push(tape.vector()?);
        }
        if let Some(species) = &mut self.species {
            let kind =
                u8::try_from(tape.word()?).ok().filter(|&kind| usize::from(kind) < self.laws.species.len());
            species.push(kind.ok_or(EngineMisfit("a grain is of no species"))?);
        }
        Ok(())
    }
}

/// An event as a word.
fn code(event: Event) -> u32 {
    let side = |face: Face| u32::from(face.axis) << 1 | u32::from(face.upper);
    match event {
        Event::Rest => 0,
        Event::Gone => 1,
        Event::Collision => 2,
        Event::Exit => 3,
        Event::Outlook => 4,
        Event::Crossing(face) => 8 | side(face),
        Event::Wall(face) => 16 | side(face),
    }
}

/// Whether the face of `event`, if it has one, is normal to an axis of space.
fn is_along_an_axis<V: Vector>(event: &Event) -> bool {
    match event {
        Event::Crossing(face) | Event::Wall(face) => face.axis() < V::DIMENSION,
        _ => true,
    }
}

/// The event of a word; `None` for none.
fn event(code: u32) -> Option<Event> {
    let face = Face { axis: (code >> 1 & 3) as u8, upper: code & 1 == 1 };
    match code {
        0 => Some(Event::Rest),
        1 => Some(Event::Gone),
        2 => Some(Event::Collision),
        3 => Some(Event::Exit),
        4 => Some(Event::Outlook),
        8..16 => Some(Event::Crossing(face)),
        16..24 => Some(Event::Wall(face)),
        _ => None,
    }
}
