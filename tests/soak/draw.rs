//! Small scenarios drawn from a seed, as text: what a user might write, in every combination that is allowed.

use grainflow::random::{Phase, Stream, Streams};

/// Steps of a case with an engine that has steps.
const STEPS: u64 = 24;
const AXES: [&str; 3] = ["x", "y", "z"];

/// Choices, all of them from one seed.
pub(crate) struct Dice(Stream);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Dice(Streams::new(seed).at(0, Phase::Replica).stream(0))
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        self.0.below(n as u64) as usize
    }

    pub(crate) fn one_of<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len())]
    }

    pub(crate) fn chance(&mut self, probability: f64) -> bool {
        self.0.uniform() < probability
    }

    /// A number with three digits, so that texts can be read.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        ((low + (high - low) * self.0.uniform()) * 1000.0).round() / 1000.0
    }
}

/// Powers of two in which a text counts. The grains do not know them: every number of their way is the same one,
/// but for its exponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Units {
    pub(crate) length: f64,
    pub(crate) mass: f64,
    pub(crate) time: f64,
}

impl Units {
    pub(crate) const ONE: Units = Units { length: 1.0, mass: 1.0, time: 1.0 };

    /// Other units, up to nine orders of magnitude away.
    pub(crate) fn drawn(seed: u64) -> Self {
        let mut dice = Dice::new(seed ^ 0x5bd1_e995);
        let mut power = |most: usize| 2.0_f64.powi(dice.below(2 * most + 1) as i32 - most as i32);
        Units { length: power(12), mass: power(9), time: power(30) }
    }

    pub(crate) fn speed(self) -> f64 {
        self.length / self.time
    }
    fn acceleration(self) -> f64 {
        self.speed() / self.time
    }
    fn temperature(self) -> f64 {
        self.mass * self.speed() * self.speed()
    }
}

/// What the parts of a scenario have to know of each other.
struct Frame {
    units: Units,
    dimension: usize,
    event_driven: bool,
    gravity: f64,
    /// Along the last axis, down which gravity points.
    floor: bool,
    source: bool,
    large: bool,
}

/// The text of the scenario number `seed`, counted in `units`.
pub(crate) fn scenario_text(seed: u64, units: Units) -> String {
    let dice = &mut Dice::new(seed);
    let engine = dice.one_of(&["dsmc", "cba", "hsmc", "hsmc", "event-driven"]);
    let dimension = 2 + dice.below(2);
    let mut frame = Frame {
        units,
        dimension,
        event_driven: engine == "event-driven",
        gravity: if dice.chance(0.5) { 0.0 } else { dice.between(0.1, 1.0) },
        floor: false,
        source: false,
        // Work is shared among threads only from some number of grains on.
        large: engine != "event-driven" && dice.chance(0.1),
    };
    let boundary = boundary(dice, &mut frame);
    frame.source = frame.floor && frame.gravity > 0.0 && dice.chance(0.4);
    let gravity =
        frame.vector(|axis| if axis + 1 == dimension { -frame.gravity * units.acceleration() } else { 0.0 });
    let head = format!("dimension = {dimension}\nseed = {}\ngravity = {gravity}\n", seed >> 1);
    let parts = [
        head,
        engine_tables(dice, engine, units),
        domain(dice, &frame),
        boundary,
        particles(dice, &frame),
        initial(dice, &frame),
        run(dice, &frame),
    ];
    parts.concat()
}

impl Frame {
    fn vector(&self, component: impl Fn(usize) -> f64) -> String {
        let all: Vec<String> = (0..self.dimension).map(|axis| format!("{:?}", component(axis))).collect();
        format!("[{}]", all.join(", "))
    }
}

fn engine_tables(dice: &mut Dice, kind: &str, units: Units) -> String {
    let mut text = format!("[engine]\nkind = \"{kind}\"\n");
    if dice.chance(0.8) {
        text += &format!("cell_size = {:?}\n", dice.between(2.0, 4.0) * units.length);
    }
    let fixed = format!("{{ fixed = {:?} }}", 0.02 * units.time);
    let steps = [
        "{ collisions_per_particle = 0.1 }",
        "{ collisions_per_particle = 1.0 }",
        "{ crossing = 0.5 }",
        &fixed,
    ];
    text += &format!("time_step = {}\n", dice.one_of(&steps));
    text += &format!("enskog_factor = \"{}\"\n", dice.one_of(&["local", "half-grain", "smoothed"]));
    text += &format!("transfer = \"{}\"\n", dice.one_of(&["momentum-change", "corrected"]));
    let impacts = ["\"uniform\"", "{ c = 0.4 }", "{ collisions_per_particle = [0.0, 1.0], c = [0.0, -0.5] }"];
    text += &format!("impact_parameter = {}\n", dice.one_of(&impacts));
    text += &format!("[engine.hsmc]\nsweeps = {}\n", 1 + dice.below(4));
    text += &format!("admission = \"{}\"\n", dice.one_of(&["strict", "strict", "thesis"]));
    text += &format!("displacement = \"{}\"\n", dice.one_of(&["paired", "paired", "thesis"]));
    if dice.chance(0.3) {
        text += "cell_restitution = { at_least = 0.9 }\n";
    }
    if dice.chance(0.3) {
        text += "entry_probability = { volume_fraction = [0.0, 0.6], probability = [1.0, 0.3] }\n";
    }
    let cures = [
        &format!("{{ contact_time = {:?} }}", 1e-3 * units.time),
        &format!("{{ elastic_below = {:?} }}", 1e-3 * units.speed()),
        "{ rotation = 5.0 }",
    ];
    let structure = dice.one_of(&["automatic", "cells", "neighbour-lists"]);
    text +=
        &format!("[engine.event_driven]\nstructure = \"{structure}\"\ncollapse = {}\n", dice.one_of(&cures));
    text
}

fn domain(dice: &mut Dice, frame: &Frame) -> String {
    let side = match (frame.dimension, frame.large) {
        (2, false) => dice.between(12.0, 26.0),
        (2, true) => 110.0,
        (_, false) => dice.between(8.0, 11.0),
        (_, true) => 26.0,
    };
    let side = side * frame.units.length;
    let size = frame.vector(|axis| if axis + 1 == frame.dimension { 2.0 * side } else { side });
    format!("[domain]\nsize = {size}\n")
}

/// Faces of every axis; a periodic one is left out.
fn boundary(dice: &mut Dice, frame: &mut Frame) -> String {
    let mut text = "[boundary]\n".to_owned();
    for (axis, name) in AXES.iter().enumerate().take(frame.dimension) {
        if dice.chance(0.4) {
            continue;
        }
        let [lower, upper] = [face(dice, frame, axis), face(dice, frame, axis)];
        frame.floor |= axis + 1 == frame.dimension;
        text += &format!("{name}.lower = {lower}\n{name}.upper = {upper}\n");
    }
    text
}

fn face(dice: &mut Dice, frame: &Frame, axis: usize) -> String {
    let units = frame.units;
    let along = |other| if other == (axis + 1) % frame.dimension { 0.5 * units.speed() } else { 0.0 };
    let (amplitude, frequency) = (0.3 * units.length, 0.7 / units.time);
    match dice.below(7) {
        0 | 1 => "{ wall = \"smooth\" }".to_owned(),
        2 => "{ wall = \"rough\", restitution = 0.3 }".to_owned(),
        3 => format!("{{ wall = \"rough\", velocity = {} }}", frame.vector(along)),
        4 => "{ wall = \"statistical\", reversal_probability = 0.5, restitution = 1.0 }".to_owned(),
        5 => {
            format!("{{ wall = \"vibrating\", amplitude = {amplitude:?}, frequency = {frequency:?} }}")
        }
        _ => "\"open\"".to_owned(),
    }
}

fn particles(dice: &mut Dice, frame: &Frame) -> String {
    let densest = match (frame.event_driven, frame.dimension) {
        (true, 2) => 0.38,
        (true, _) => 0.25,
        (false, 2) => 0.55,
        (false, _) => 0.4,
    };
    let fraction = dice.between(0.02, densest) * if frame.source { 0.3 } else { 1.0 };
    let units = frame.units;
    let mut text = format!("[particles]\nvolume_fraction = {fraction:.4}\n");
    let some = dice.between(0.3, 1.0);
    text += &match dice.below(5) {
        0 => "restitution = 1.0\n".to_owned(),
        1 => "restitution = 0.0\n".to_owned(),
        2 => {
            let v0 = 0.5 * units.speed();
            format!("restitution = {{ law = \"velocity-dependent\", r0 = 0.9, v0 = {v0:?} }}\n")
        }
        _ => format!("restitution = {some}\n"),
    };
    let grain = format!("diameter = {:?}\nmass = {:?}\n", units.length, units.mass);
    if !frame.event_driven {
        return text + &grain;
    }
    if dice.chance(0.3) {
        text += &format!("tangential_restitution = {}\n", dice.between(-1.0, 1.0));
    }
    if dice.chance(0.7) {
        return text + &grain;
    }
    let species = |diameter: f64, mass: f64| {
        format!(
            "{{ diameter = {:?}, mass = {:?}, share = {:?} }}",
            diameter * units.length,
            mass * units.mass,
            2.0
        )
    };
    text + &format!("species = [{}, {}]\n", species(1.0, 1.0), species(0.7, 0.4))
}

fn initial(dice: &mut Dice, frame: &Frame) -> String {
    let at_rest = frame.gravity > 0.0 && dice.chance(0.2);
    let positions = dice.one_of(&["random", "random", "lattice"]);
    let mut text = format!("[initial]\npositions = \"{positions}\"\n");
    if at_rest {
        return text + "velocities = \"rest\"\n" + &source(frame);
    }
    text += &match dice.chance(0.5) {
        true => format!("velocities = {{ maxwell = {:?} }}\n", frame.units.temperature()),
        false => format!("velocities = {{ uniform = {:?} }}\n", 0.7 * frame.units.speed()),
    };
    if dice.chance(0.2) {
        text += "equilibrate = 0.5\n";
    }
    text + &source(frame)
}

fn source(frame: &Frame) -> String {
    if !frame.source {
        return String::new();
    }
    let units = frame.units;
    let velocity = frame.vector(|axis| if axis + 1 == frame.dimension { -2.0 * units.speed() } else { 0.0 });
    let (rate, height, width) = (6.0 / units.time, 1.5 * units.length, 4.0 * units.length);
    format!(
        "[source]\ncount = 12\nrate = {rate:?}\nheight = {height:?}\nwidth = {width:?}\nvelocity = {velocity}\n"
    )
}

fn run(dice: &mut Dice, frame: &Frame) -> String {
    let limits = if frame.event_driven {
        format!("time = {:?}\ncollisions_per_particle = 20.0\n", 2.0 * frame.units.time)
    } else {
        format!("steps = {STEPS}\n")
    };
    let frames = dice.one_of(&[0, 5, 24]);
    let states = dice.one_of(&[0, 2, 3]);
    let full = dice.one_of(&["", "full = { every_nth = 3 }\n"]);
    format!("[run]\n{limits}[record]\nframes = {frames}\nstates = {states}\npoints = 40\n{full}")
}
