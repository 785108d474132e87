//! Small runs under gravity drawn from a seed, as text: heaps, sediments, beds, chutes, with every engine.

use super::draw::Dice;

/// The kinds of run; the seed goes through them in turn.
pub(crate) const KINDS: [&str; 4] = ["heap", "sediment", "bed", "chute"];
const ENGINES: [&str; 5] = ["hsmc", "event-driven", "hsmc", "cba", "dsmc"];
const AXES: [&str; 3] = ["x", "y", "z"];

/// A drawn run.
pub(crate) struct Drawn {
    pub(crate) kind: &'static str,
    pub(crate) engine: &'static str,
    pub(crate) text: String,
}

/// The run number `seed`.
pub(crate) fn drawn(seed: u64) -> Drawn {
    let turn = seed.wrapping_sub(1);
    let kind = KINDS[(turn % 4) as usize];
    let engine = ENGINES[(turn / 4 % 5) as usize];
    let dice = &mut Dice::new(seed ^ 0x9e37_79b9);
    let dimension = if dice.chance(0.65) { 2 } else { 3 };
    let case = Case { kind, dimension, engine };
    let head = format!("dimension = {dimension}\nseed = {seed}\ngravity = {}\n", case.gravity(dice));
    let parts = [
        head,
        case.engine(dice),
        case.domain(dice),
        case.boundary(dice),
        case.particles(dice),
        case.initial(dice),
        case.source(dice),
        case.end(dice),
        record(dice),
    ];
    Drawn { kind, engine, text: parts.concat() }
}

/// What the parts of a scenario depend on.
struct Case {
    kind: &'static str,
    dimension: usize,
    engine: &'static str,
}

impl Case {
    fn up(&self) -> usize {
        self.dimension - 1
    }

    fn is_exact(&self) -> bool {
        self.engine == "event-driven"
    }

    fn vector(&self, component: impl Fn(usize) -> f64) -> String {
        let all: Vec<String> = (0..self.dimension).map(|axis| format!("{:?}", component(axis))).collect();
        format!("[{}]", all.join(", "))
    }

    /// Down the last axis; along the first one, too, in a chute.
    fn gravity(&self, dice: &mut Dice) -> String {
        let slope = if self.kind == "chute" { dice.between(0.1, 0.6) } else { 0.0 };
        self.vector(|axis| match axis {
            0 => slope,
            axis if axis == self.up() => -1.0,
            _ => 0.0,
        })
    }

    fn engine(&self, dice: &mut Dice) -> String {
        let mut text = format!("[engine]\nkind = \"{}\"\n", self.engine);
        if self.is_exact() {
            // Where there is no cure many of these runs collapse; how they fail belongs to what is tried.
            let cure = dice.one_of(&[
                "",
                "collapse = { elastic_below = 0.1 }\n",
                "collapse = { contact_time = 0.02 }\n",
                "collapse = { rotation = 5.0 }\n",
            ]);
            let structure = dice.one_of(&["automatic", "cells", "neighbour-lists"]);
            return text + &format!("[engine.event_driven]\nstructure = \"{structure}\"\n{cure}");
        }
        text += &format!("cell_size = {:?}\n", dice.between(1.8, 3.0));
        // The last one is soon too long, if not at once.
        let steps = [
            "{ fixed = 0.1 }",
            "{ fixed = 0.05 }",
            "{ crossing = 0.5 }",
            "{ collisions_per_particle = 0.2 }",
            "{ fixed = 0.4 }",
        ];
        text += &format!("time_step = {}\n", dice.one_of(&steps));
        if self.engine != "hsmc" {
            return text;
        }
        text += &format!("[engine.hsmc]\nsweeps = {}\n", 1 + dice.below(4));
        text += &format!("admission = \"{}\"\n", dice.one_of(&["strict", "strict", "thesis"]));
        text += &format!("displacement = \"{}\"\n", dice.one_of(&["paired", "paired", "thesis"]));
        text +=
            &format!("cell_restitution = {}\n", dice.one_of(&["0.9", "1.0", "{ at_least = 0.9 }", "0.0"]));
        if dice.chance(0.2) {
            text +=
                "entry_probability = { volume_fraction = [0.0, 0.6, 0.8], probability = [1.0, 0.7, 0.0] }\n";
        }
        text
    }

    fn domain(&self, dice: &mut Dice) -> String {
        let (width, height) = match (self.dimension, self.kind) {
            (2, "heap") => (dice.between(24.0, 40.0), 60.0),
            (2, _) => (dice.between(12.0, 24.0), dice.between(24.0, 40.0)),
            (_, "heap") => (dice.between(9.0, 14.0), 40.0),
            _ => (dice.between(6.0, 9.0), dice.between(14.0, 24.0)),
        };
        format!("[domain]\nsize = {}\n", self.vector(|axis| if axis == self.up() { height } else { width }))
    }

    fn boundary(&self, dice: &mut Dice) -> String {
        let still = |dice: &mut Dice| {
            dice.one_of(&[
                "{ wall = \"smooth\" }",
                "{ wall = \"rough\", restitution = 0.3 }",
                "{ wall = \"statistical\", reversal_probability = 0.4, restitution = 0.7 }",
            ])
            .to_owned()
        };
        let mut text = "[boundary]\n".to_owned();
        for name in &AXES[..self.up()] {
            let sides = match self.kind {
                "chute" => 0,
                "heap" => 1 + dice.below(2),
                _ => dice.below(3),
            };
            text += &match sides {
                0 => String::new(),
                1 => format!("{name} = \"open\"\n"),
                _ => format!("{name}.lower = {}\n{name}.upper = {}\n", still(dice), still(dice)),
            };
        }
        let floor = match self.kind {
            "bed" => format!(
                "{{ wall = \"vibrating\", amplitude = {:?}, frequency = {:?} }}",
                dice.between(0.2, 0.8),
                dice.between(0.2, 0.6)
            ),
            // Whatever falls through is gone, often before the next grain comes.
            "heap" if dice.chance(0.15) => "\"open\"".to_owned(),
            "chute" if dice.chance(0.3) => format!(
                "{{ wall = \"rough\", velocity = {}, restitution = 0.5 }}",
                self.vector(|axis| if axis == 0 { -0.5 } else { 0.0 })
            ),
            _ => still(dice),
        };
        let sky = if dice.chance(0.5) { "\"open\"".to_owned() } else { still(dice) };
        let up = AXES[self.up()];
        text + &format!("{up}.lower = {floor}\n{up}.upper = {sky}\n")
    }

    fn particles(&self, dice: &mut Dice) -> String {
        let densest = match (self.is_exact(), self.dimension) {
            (true, 2) => 0.3,
            (true, _) => 0.2,
            (false, 2) => 0.45,
            (false, _) => 0.35,
        };
        let mut text = match (self.kind, dice.chance(0.8)) {
            ("heap", true) => "[particles]\ncount = 0\n".to_owned(),
            ("heap", false) => "[particles]\ncount = 15\n".to_owned(),
            _ => format!("[particles]\nvolume_fraction = {:?}\n", dice.between(0.03, densest)),
        };
        text += &format!("restitution = {:?}\n", dice.one_of(&[0.4, 0.7, 0.9, 0.95, 1.0]));
        if self.is_exact() && dice.chance(0.3) {
            text += &format!("tangential_restitution = {:?}\n", dice.between(-0.9, 0.9));
        }
        if self.is_exact() && dice.chance(0.3) {
            text += "species = [{ diameter = 1.0, mass = 1.0, share = 2.0 }, { diameter = 0.7, mass = 0.4, share = 1.0 }]\n";
        }
        text
    }

    fn initial(&self, dice: &mut Dice) -> String {
        let velocities = dice.one_of(&["\"rest\"", "{ maxwell = 1.0 }", "{ uniform = 0.8 }"]);
        format!("[initial]\npositions = \"random\"\nvelocities = {velocities}\n")
    }

    fn source(&self, dice: &mut Dice) -> String {
        // Grains are poured down one axis only.
        if self.kind == "chute" || self.kind != "heap" && !dice.chance(0.15) {
            return String::new();
        }
        // Grains that come one by one, each after the last has come to rest or left, up to a stream that is held up.
        let (count, rate) = dice.one_of(&[(8, 0.15), (25, 0.6), (60, 3.0), (60, 12.0)]);
        let speed = dice.one_of(&[0.0, 1.0, 3.0]);
        let velocity = self.vector(|axis| if axis == self.up() { -speed } else { 0.0 });
        let width = dice.one_of(&[1.0, 4.0]);
        let height = dice.between(3.0, 8.0);
        format!(
            "[source]\ncount = {count}\nrate = {rate:?}\nheight = {height:?}\nwidth = {width:?}\nvelocity = {velocity}\n"
        )
    }

    fn end(&self, dice: &mut Dice) -> String {
        match self.kind {
            // A heap that has grown into its source holds it up for ever.
            "heap" if dice.chance(0.7) => {
                format!("[run]\nrest = {:?}\ntime = 70.0\n", dice.between(5.0, 15.0))
            }
            // Where grains have come to lie, exact dynamics takes very many events.
            _ if self.is_exact() => format!("[run]\ntime = {:?}\n", dice.between(4.0, 12.0)),
            _ => format!("[run]\ntime = {:?}\n", dice.between(8.0, 25.0)),
        }
    }
}

fn record(dice: &mut Dice) -> String {
    let frames = dice.one_of(&[0, 3, 12]);
    let fields = if dice.chance(0.2) { "fields = [\"density\", \"collisions\"]\n" } else { "" };
    let full = dice.one_of(&["", "full = { every_nth = 3 }\n"]);
    format!("[record]\nframes = {frames}\nstates = {}\npoints = 20\n{fields}{full}", 6 + dice.below(5))
}
