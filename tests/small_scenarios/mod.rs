//! Scenarios small enough for tests: gases, and one of each kind of drive.

use grainflow::scenario::model::AnyScenario;
use grainflow::scenario::{Overrides, parse};

/// The engines.
pub(crate) const ENGINES: [&str; 3] = ["dsmc", "cba", "hsmc"];

/// A scenario as text.
#[derive(Clone, Debug)]
pub(crate) struct Small {
    pub(crate) name: String,
    pub(crate) text: String,
}

impl Small {
    /// The checked scenario, after some `--set`.
    pub(crate) fn with(&self, sets: &[&str]) -> AnyScenario {
        let sets = sets.iter().map(ToString::to_string).collect();
        parse(&self.name, &self.text, &Overrides { sets, ..Default::default() })
            .unwrap_or_else(|error| panic!("{}: {error}\n{}", self.name, self.text))
    }
}

/// A periodic gas of some 7000 grains; a dense one fills its cells, a dilute one has a fiftieth of
/// its volume full.
pub(crate) fn gas(dimension: usize, engine: &str, dense: bool) -> Small {
    let (side, cell, fraction) = match (dimension, dense) {
        (2, true) => (96.0, 2.5, 0.62),
        (2, false) => (500.0, 15.0, 0.02),
        (_, true) => (20.0, 2.0, 0.48),
        (_, false) => (56.0, 6.0, 0.02),
    };
    let density = if dense { "dense" } else { "dilute" };
    Small {
        name: format!("{density}-gas-{engine}-{dimension}d"),
        text: format!(
            "dimension = {dimension}
seed = 5
[engine]
kind = \"{engine}\"
cell_size = {cell}
[engine.hsmc]
sweeps = 2
[domain]
size = {size}
[particles]
volume_fraction = {fraction}
restitution = 0.9
[initial]
velocities = {{ maxwell = 1.0 }}
[run]
steps = 40
",
            size = list(dimension, |_| side),
        ),
    }
}

/// A heap that is poured, a pipe with statistical walls, a sheared gas, a shaken box.
pub(crate) fn driven(dimension: usize, engine: &str) -> Vec<Small> {
    vec![
        heap(dimension, engine),
        pipe(dimension, engine),
        shear(dimension, engine),
        shaken_box(dimension, engine),
    ]
}

/// Grains that fall on a rough floor while others are poured on them; what rolls aside is gone.
pub(crate) fn heap(dimension: usize, engine: &str) -> Small {
    let up = dimension - 1;
    let (side, height, count, width) =
        if dimension == 2 { (120.0, 80.0, 400, 40.0) } else { (16.0, 40.0, 1400, 12.0) };
    let down = |speed: f64| list(dimension, |axis| if axis == up { -speed } else { 0.0 });
    let boundary = (0..up).map(|axis| format!("{} = \"open\"\n", NAMES[axis])).collect::<String>()
        + &format!("{0}.lower = {{ wall = \"rough\" }}\n{0}.upper = \"open\"\n", NAMES[up]);
    let parts = Parts {
        gravity: down(1.0),
        size: list(dimension, |axis| if axis == up { height } else { side }),
        time_step: "{ fixed = 0.08 }",
        boundary,
        count,
        // Fast and wide enough that the falling grains do not count as a heap that has grown.
        more: format!(
            "[initial]\nvelocities = {{ maxwell = 1.0 }}\n[source]\ncount = 500\nrate = 15.0\nheight = 5.0\n\
             width = {width}\nvelocity = {}\n[run]\nsteps = 60\n",
            down(3.0)
        ),
    };
    parts.small("heap", dimension, engine)
}

/// Grains that fall for ever between statistical walls, with an adaptive step.
pub(crate) fn pipe(dimension: usize, engine: &str) -> Small {
    let wall = "{ wall = \"statistical\", reversal_probability = 0.3 }";
    let boundary = (0..dimension - 1)
        .map(|axis| format!("{0}.lower = {wall}\n{0}.upper = {wall}\n", NAMES[axis]))
        .collect();
    let parts = Parts {
        gravity: list(dimension, |axis| if axis == dimension - 1 { -1.0 } else { 0.0 }),
        size: list(dimension, |axis| match axis + 1 == dimension {
            true if dimension == 2 => 160.0,
            true => 40.0,
            false if dimension == 2 => 20.0,
            false => 10.0,
        }),
        time_step: "{ collisions_per_particle = 0.2 }",
        boundary,
        count: 2100,
        more: "[initial]\nvelocities = { maxwell = 1.0 }\n[run]\nsteps = 60\n".to_owned(),
    };
    parts.small("pipe", dimension, engine)
}

/// A gas between rough walls that move past each other, equilibrated before.
pub(crate) fn shear(dimension: usize, engine: &str) -> Small {
    let velocity = |speed: f64| list(dimension, |axis| if axis == 0 { speed } else { 0.0 });
    let parts = Parts {
        gravity: list(dimension, |_| 0.0),
        size: list(dimension, |axis| match axis {
            0 if dimension == 2 => 150.0,
            0 => 40.0,
            _ => 24.0,
        }),
        time_step: "{ collisions_per_particle = 0.1 }",
        boundary: format!(
            "y.lower = {{ wall = \"rough\", velocity = {} }}\ny.upper = {{ wall = \"rough\", velocity = {} }}\n",
            velocity(-0.7),
            velocity(0.7)
        ),
        count: 2100,
        more: "[initial]\nvelocities = { maxwell = 1.0 }\nequilibrate = 0.5\n[run]\nsteps = 60\n".to_owned(),
    };
    parts.small("shear", dimension, engine)
}

/// Grains on a vibrating floor under an open sky, with a step by crossing.
pub(crate) fn shaken_box(dimension: usize, engine: &str) -> Small {
    let up = dimension - 1;
    let side = if dimension == 2 { 40.0 } else { 12.0 };
    let boundary = (0..up)
        .map(|axis| {
            format!("{0}.lower = {{ wall = \"smooth\" }}\n{0}.upper = {{ wall = \"smooth\" }}\n", NAMES[axis])
        })
        .collect::<String>()
        + &format!(
            "{0}.lower = {{ wall = \"vibrating\", amplitude = 0.4, frequency = 0.9 }}\n{0}.upper = \"open\"\n",
            NAMES[up]
        );
    let parts = Parts {
        gravity: list(dimension, |axis| if axis == up { -1.0 } else { 0.0 }),
        size: list(dimension, |axis| if axis == up { 80.0 } else { side }),
        time_step: "{ crossing = 0.3 }",
        boundary,
        count: 2100,
        more: "[initial]\nvelocities = { uniform = 1.0 }\n[run]\nsteps = 60\n".to_owned(),
    };
    parts.small("shaken-box", dimension, engine)
}

const NAMES: [&str; 3] = ["x", "y", "z"];

/// What driven scenarios differ in.
struct Parts {
    gravity: String,
    size: String,
    time_step: &'static str,
    boundary: String,
    count: u32,
    more: String,
}

impl Parts {
    fn small(&self, name: &str, dimension: usize, engine: &str) -> Small {
        let Parts { gravity, size, time_step, boundary, count, more } = self;
        Small {
            name: format!("{name}-{engine}-{dimension}d"),
            text: format!(
                "dimension = {dimension}
seed = 9
gravity = {gravity}
[engine]
kind = \"{engine}\"
cell_size = 2.0
time_step = {time_step}
enskog_factor = \"smoothed\"
[engine.hsmc]
sweeps = 3
cell_restitution = {{ at_least = 0.9 }}
[domain]
size = {size}
[boundary]
{boundary}[particles]
count = {count}
restitution = 0.85
{more}"
            ),
        }
    }
}

fn list(dimension: usize, component: impl Fn(usize) -> f64) -> String {
    let components: Vec<String> = (0..dimension).map(|axis| format!("{:?}", component(axis))).collect();
    format!("[{}]", components.join(", "))
}
