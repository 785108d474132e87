//! Made-up runs whose reports tests can look at: every plot has something to show.

use grainflow::observe::measure::{Column, Dimension, Profile};
use grainflow::record::contents::{Frame, RunLog, Walls};
use serde_json::{Map, Value, json};

/// A made-up run: its log and its summary.
pub(crate) struct Sample {
    pub(crate) name: &'static str,
    pub(crate) log: RunLog,
    pub(crate) summary: Map<String, Value>,
}

/// All samples.
pub(crate) fn all() -> Vec<Sample> {
    vec![heap(), cooling(), shear(), pipe(), bed()]
}

const PURE: Dimension = Dimension { mass: 0, length: 0, time: 0 };
const LENGTH: Dimension = Dimension { mass: 0, length: 1, time: 0 };
const TIME: Dimension = Dimension { mass: 0, length: 0, time: 1 };
const VELOCITY: Dimension = Dimension { mass: 0, length: 1, time: -1 };
const ENERGY: Dimension = Dimension { mass: 1, length: 2, time: -2 };
const STRESS: Dimension = Dimension { mass: 1, length: 0, time: -2 };

fn column(name: &str, unit: Dimension) -> Column {
    Column { name: name.to_owned(), unit }
}

fn profile(name: &str, time: f64, columns: Vec<Column>, values: Vec<Vec<f64>>) -> Profile {
    Profile { name: name.to_owned(), time, columns, values }
}

/// Numbers in 0 … 1 that look random and are the same everywhere.
pub(crate) struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn gauss(&mut self) -> f64 {
        (0..12).map(|_| self.next()).sum::<f64>() - 6.0
    }
}

fn sides(kinds: [[&str; 2]; 3]) -> [[String; 2]; 3] {
    kinds.map(|pair| pair.map(str::to_owned))
}

fn summary(pairs: Value) -> Map<String, Value> {
    let mut all = json!({
        "seed": 7, "threads": 2, "version": "0.1.0", "numerics": 1, "steps": 40_000, "steps_capped": 0, "events": null,
        "interrupted": false, "end_reason": "limit", "wall_seconds": 12.34, "particle_steps_per_second": 2.4e7,
        "peak_memory_bytes": 31_000_000, "momentum_drift": null,
        "state_hash": "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08"
    });
    let all = all.as_object_mut().expect("an object");
    all.extend(pairs.as_object().expect("an object").clone());
    std::mem::take(all)
}

fn log(scenario: &str, columns: Vec<Column>) -> RunLog {
    let metadata = [("version", "0.1.0"), ("numerics", "1"), ("seed", "7"), ("rustc", "1.95")];
    RunLog {
        metadata: metadata.map(|(k, v)| (k.to_owned(), v.to_owned())).into(),
        scenario: scenario.to_owned(),
        columns,
        ..RunLog::default()
    }
}

fn frame(time: f64, grains: usize, mut grain: impl FnMut(usize) -> ([f64; 3], [f64; 3])) -> Frame {
    let mut frame = Frame { time, grains: grains as u64, ..Frame::default() };
    for k in 0..grains {
        let (position, velocity) = grain(k);
        frame.positions.push(position.map(|x| x as f32));
        frame.velocities.push(velocity.map(|v| v as f32));
        frame.ids.push(k as u32);
    }
    frame
}

/// x as a function of h is the law of a heap with a logarithmic tail.
fn heap_height(x: f64, peak: f64) -> f64 {
    let place = |h: f64| (peak - h) / 0.58 + 0.22 * peak * (peak / h).ln();
    let (mut low, mut high) = (1e-6, peak);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if place(middle) > x { low = middle } else { high = middle }
    }
    low
}

pub(crate) fn heap() -> Sample {
    let scenario = "title = \"A heap poured on a rough plane\"\ndimension = 2\ngravity = [0.0, -1.0]\n[engine]\nkind = \"hsmc\"\ncell_size = 2.0\n\
        [domain]\nsize = [400.0, 160.0]\n[boundary]\nx = \"open\"\ny.lower = { wall = \"rough\" }\ny.upper = \"open\"\n\
        [particles]\ncount = 0\ndiameter = 1.0\nmass = 1.0\nrestitution = 0.9\n[source]\ncount = 3000\nrate = 0.5\nposition = [200.0]\nwidth = 1.0\nheight = 10.0\n[run]\nrest = 400.0\n\
        [units]\nlength = \"d\"\nmass = \"m\"\ntime = \"√(d/g)\"\n";
    let names = [
        ("time", TIME),
        ("kinetic_energy", ENERGY),
        ("temperature", ENERGY),
        ("collisions_per_particle", PURE),
        ("grains", PURE),
        ("centre_of_mass_height", LENGTH),
    ];
    let mut log = log(scenario, names.map(|(n, u)| column(n, u)).to_vec());
    let mut noise = Noise(3);
    log.walls = Some(Walls {
        lower: [0.0; 3],
        upper: [400.0, 160.0, 0.0],
        sides: sides([["open"; 2], ["wall", "open"], ["", ""]]),
    });
    for k in 0..=80 {
        let time = f64::from(k) * 80.0;
        let grains = (0.5 * time).min(3000.0);
        let peak = (0.62 * grains.sqrt()).max(0.01);
        let energy = if time < 6000.0 { 40.0 + 12.0 * noise.gauss() } else { 1.5 + 0.3 * noise.gauss() };
        log.series.push(vec![
            time,
            energy.max(0.2),
            energy.max(0.2) / grains.max(1.0),
            0.2 * time,
            grains,
            peak / 3.2,
        ]);
        let xs: Vec<f64> = (0..200).map(|b| 2.0 * f64::from(b) + 1.0).collect();
        let surface =
            xs.iter().map(|x| (heap_height((x - 200.0).abs(), peak) + 0.4 * noise.gauss()).max(0.0));
        let surface: Vec<f64> = surface.map(|h| if h < 0.5 { 0.0 } else { h }).collect();
        let mut placed = Vec::new();
        for (x, h) in xs.iter().zip(&surface) {
            for row in 0..(h * 1.7) as usize {
                placed.push([x + 2.0 * noise.next() - 1.0, (row as f64 + noise.next()) / 1.7, 0.0]);
            }
        }
        log.frames.push(frame(time, placed.len(), |index| {
            let [x, y, _] = placed[index];
            let depth = (heap_height((x - 200.0).abs(), peak) - y).max(0.0);
            let speed = if time < 6000.0 { 1.6 * (-depth / 2.0).exp() } else { 0.02 };
            ([x, y, 0.0], [speed * noise.next(), speed * noise.next(), 0.0])
        }));
        if k % 2 == 0 {
            log.profiles.push(profile(
                "heap-surface",
                time,
                vec![column("position", LENGTH), column("height", LENGTH)],
                vec![xs, surface],
            ));
        }
    }
    Sample { name: "heap", log, summary: heap_summary() }
}

fn heap_summary() -> Map<String, Value> {
    summary(json!({
        "scenario": "heap", "engine": "hsmc", "dimension": 2, "particles_initial": 0, "particles_final": 3000, "volume_fraction": 0.0368,
        "collisions": 123_456_789, "collisions_per_particle": 1280.4, "simulated_time": 6400.0, "kinetic_energy_initial": 0.0,
        "kinetic_energy_final": 1.4, "temperature": 4.7e-4, "heap_slope": 0.571, "heap_slope_standard_error": 0.012,
        "centre_of_mass_height": 10.61, "centre_of_mass_height_standard_error": null
    }))
}

pub(crate) fn cooling() -> Sample {
    let scenario = "title = \"Homogeneous cooling <script>alert('no')</script>\"\ndimension = 2\n[engine]\nkind = \"hsmc\"\n[domain]\nsize = [177.2, 177.2]\n\
        [boundary]\nx = \"periodic\"\ny = \"periodic\"\n[particles]\ndiameter = 1.0\nmass = 1.0\nrestitution = 0.8\nvolume_fraction = 0.25\n[initial]\nvelocities = { maxwell = 1.0 }\n[run]\ntime = 400.0\n";
    let names = [
        ("time", TIME),
        ("kinetic_energy", ENERGY),
        ("temperature", ENERGY),
        ("collisions_per_particle", PURE),
        ("grains", PURE),
        ("cluster_share", PURE),
    ];
    let mut log = log(scenario, names.map(|(n, u)| column(n, u)).to_vec());
    log.walls = Some(Walls {
        lower: [0.0; 3],
        upper: [177.2, 177.2, 0.0],
        sides: sides([["periodic"; 2], ["periodic"; 2], ["", ""]]),
    });
    let mut noise = Noise(11);
    for k in 0..=120 {
        let time = if k == 0 { 0.0 } else { 0.05 * 1.083f64.powi(k) };
        let growth = 1.0 + (time / 60.0).powf(1.2) / (1.0 + time / 200.0);
        let temperature = (1.0 + time / 6.24f64).powi(-2) * growth;
        log.series.push(vec![
            time,
            1e4 * temperature,
            temperature,
            11.0 * (1.0 + time / 6.24).ln(),
            10_000.0,
            0.02 + 0.5 * time / (time + 100.0),
        ]);
        let clumping = time / (time + 80.0);
        if k % 2 == 0 {
            log.frames.push(frame(time, 10_000, |index| {
                let (mut x, y) = (177.2 * noise.next(), 177.2 * noise.next());
                if noise.next() < clumping {
                    x = (x + 24.0 * (0.07 * x + index as f64 * 0.0 + 0.05 * y).sin()).rem_euclid(177.2);
                }
                let speed = temperature.sqrt() * (0.35 + 0.65 * (0.5 + 0.5 * (0.035 * y + 0.02 * x).cos()));
                ([x, y, 0.0], [speed * noise.gauss(), speed * noise.gauss(), 0.0])
            }));
        }
    }
    let gaussian = |b: f64| (1.0 / (1.0 - 0.35 * b * b)) * 0.44;
    let bins: Vec<f64> = (0..40).map(|k| -0.975 + 0.05 * f64::from(k)).collect();
    let values = bins.iter().map(|b| gaussian(*b) + 0.006 * noise.gauss()).collect();
    log.profiles.push(profile(
        "impact-parameter",
        700.0,
        vec![column("b", PURE), column("probability", PURE), column("standard_error", PURE)],
        vec![bins, values, vec![0.006; 40]],
    ));
    let summary = summary(json!({
        "scenario": "cooling", "engine": "hsmc", "dimension": 2, "particles_initial": 10_000, "particles_final": 10_000, "volume_fraction": 0.2501,
        "collisions": 30_000_000u64, "collisions_per_particle": 61.2, "simulated_time": 715.2, "kinetic_energy_initial": 10_000.0,
        "kinetic_energy_final": 1.4, "temperature": 4.7e-4, "momentum_drift": 2.3e-14, "compressibility_factor": 1.71, "compressibility_factor_standard_error": 0.01
    }));
    Sample { name: "cooling", log, summary }
}

pub(crate) fn shear() -> Sample {
    let scenario = "title = \"Bagnold shear flow\"\ndimension = 2\n[engine]\nkind = \"hsmc\"\ncell_size = 2.5\n[domain]\nsize = [40.0, 40.0]\n[boundary]\nx = \"periodic\"\n\
        y.lower = { wall = \"rough\", velocity = [-0.5, 0.0] }\ny.upper = { wall = \"rough\", velocity = [0.5, 0.0] }\n\
        [particles]\nvolume_fraction = 0.1\ndiameter = 1.0\nmass = 1.0\nrestitution = 0.9\n[initial]\nvelocities = { maxwell = 0.02 }\n[run]\ntime = 400.0\n";
    let names = [
        ("time", TIME),
        ("kinetic_energy", ENERGY),
        ("temperature", ENERGY),
        ("collisions_per_particle", PURE),
        ("wall_shear_stress", STRESS),
        ("wall_normal_stress", STRESS),
    ];
    let mut log = log(scenario, names.map(|(n, u)| column(n, u)).to_vec());
    log.walls = Some(Walls {
        lower: [0.0; 3],
        upper: [40.0, 40.0, 0.0],
        sides: sides([["periodic"; 2], ["wall"; 2], ["", ""]]),
    });
    let mut noise = Noise(5);
    for k in 0..=200 {
        let time = f64::from(k) * 10.0;
        let temperature = 0.006 + 0.0006 * noise.gauss();
        log.series.push(vec![
            time,
            18.0 + noise.gauss(),
            temperature,
            0.05 * time,
            1.3e-3 + 1e-4 * noise.gauss(),
            2.0e-3 + 1e-4 * noise.gauss(),
        ]);
        log.frames.push(frame(time, 204, |_| {
            let (x, y) = (40.0 * noise.next(), 40.0 * noise.next());
            ([x, y, 0.0], [y / 40.0 - 0.5 + 0.08 * noise.gauss(), 0.08 * noise.gauss(), 0.0])
        }));
    }
    let heights: Vec<f64> = (0..16).map(|k| 1.25 + 2.5 * f64::from(k)).collect();
    let velocities = heights.iter().map(|y| 0.985 * (y / 40.0 - 0.5) + 0.008 * noise.gauss()).collect();
    log.profiles.push(profile(
        "velocity-profile",
        2000.0,
        vec![column("height", LENGTH), column("velocity", VELOCITY), column("standard_error", VELOCITY)],
        vec![heights, velocities, vec![0.008; 16]],
    ));
    let summary = summary(json!({
        "scenario": "shear", "engine": "hsmc", "dimension": 2, "particles_initial": 204, "particles_final": 204, "volume_fraction": 0.1001,
        "collisions": 20_400, "collisions_per_particle": 200.0, "simulated_time": 2000.0, "kinetic_energy_initial": 20.0,
        "kinetic_energy_final": 18.0, "temperature": 0.006, "wall_shear_stress": 1.31e-3, "wall_shear_stress_standard_error": 3.1e-5,
        "velocity_profile_slope": 0.985, "velocity_profile_slope_standard_error": 0.0072
    }));
    Sample { name: "shear", log, summary }
}

pub(crate) fn pipe() -> Sample {
    let scenario = "title = \"Density waves in a pipe\"\ndimension = 2\ngravity = [0.0, -1.0]\n[engine]\nkind = \"hsmc\"\ncell_size = 4.0\n[domain]\nsize = [20.0, 400.0]\n[boundary]\n\
        x = { lower = { wall = \"statistical\", reversal_probability = 0.1 }, upper = { wall = \"statistical\", reversal_probability = 0.1 } }\ny = \"periodic\"\n[particles]\nvolume_fraction = 0.38\nrestitution = 0.6\n[run]\ntime = 400.0\n";
    let names = [
        ("time", TIME),
        ("kinetic_energy", ENERGY),
        ("temperature", ENERGY),
        ("collisions_per_particle", PURE),
        ("density_contrast", PURE),
        ("flow_rate", Dimension { time: -1, ..PURE }),
        ("flow_velocity", VELOCITY),
    ];
    let mut log = log(scenario, names.map(|(n, u)| column(n, u)).to_vec());
    log.walls = Some(Walls {
        lower: [0.0; 3],
        upper: [20.0, 400.0, 0.0],
        sides: sides([["wall"; 2], ["periodic"; 2], ["", ""]]),
    });
    let mut noise = Noise(9);
    let wave = |y: f64, t: f64| {
        1.0 + 0.8
            * (2.0 * std::f64::consts::PI * (3.0 * y / 400.0 + 0.11 * t)).sin()
            * (1.0 - (-t / 20.0).exp())
    };
    for k in 0..=200 {
        let time = f64::from(k);
        let speed = 50.0 * (1.0 - (-time / 40.0).exp());
        log.series.push(vec![
            time,
            3870.0 * 0.5 * speed * speed,
            2.0 + time / 50.0,
            3.0 * time,
            0.16 + 0.4 * (1.0 - (-time / 30.0).exp()) + 0.02 * noise.gauss(),
            190.0 * speed / 20.0,
            -speed,
        ]);
        let positions: Vec<f64> = (0..100).map(|b| 2.0 + 4.0 * f64::from(b)).collect();
        let density =
            positions.iter().map(|y| (0.38 * wave(*y, time) + 0.03 * noise.gauss()).max(0.0)).collect();
        log.profiles.push(profile(
            "density-profile",
            time,
            vec![column("position", LENGTH), column("volume_fraction", PURE)],
            vec![positions, density],
        ));
        if k % 2 == 0 {
            log.frames.push(frame(time, 3870, |_| {
                let y = loop {
                    let y = 400.0 * noise.next();
                    if 1.8 * noise.next() < wave(y, time) {
                        break y;
                    }
                };
                ([20.0 * noise.next(), y, 0.0], [2.0 * noise.gauss(), -speed / wave(y, time).max(0.4), 0.0])
            }));
        }
    }
    log.profiles.push(pipe_spectrum(&mut noise));
    Sample { name: "pipe", log, summary: pipe_summary() }
}

fn pipe_spectrum(noise: &mut Noise) -> Profile {
    let frequencies: Vec<f64> = (1..400).map(|k| 0.025 * f64::from(k)).collect();
    let power = frequencies.iter().map(|f| 2e-3 * f.powf(-1.6) * (1.0 + 0.3 * noise.gauss()).abs()).collect();
    profile(
        "spectrum",
        200.0,
        vec![column("frequency", Dimension { time: -1, ..PURE }), column("power", TIME)],
        vec![frequencies, power],
    )
}

fn pipe_summary() -> Map<String, Value> {
    summary(json!({
        "scenario": "pipe", "engine": "hsmc", "dimension": 2, "particles_initial": 3870, "particles_final": 3870, "volume_fraction": 0.38,
        "collisions": 1_160_000, "collisions_per_particle": 600.0, "simulated_time": 200.0, "kinetic_energy_initial": 3870.0,
        "kinetic_energy_final": 4.8e6, "temperature": 6.0, "density_contrast": 0.56, "density_contrast_standard_error": 0.011,
        "contrast_over_poisson": 3.4, "contrast_over_poisson_standard_error": 0.07, "spectrum_slope": -1.61, "spectrum_slope_standard_error": 0.04,
        "flow_rate": 470.0, "flow_rate_standard_error": 4.0, "flow_velocity": -49.0, "flow_velocity_standard_error": 0.4
    }))
}

/// Three dimensions, cut short.
pub(crate) fn bed() -> Sample {
    let scenario = "title = \"A bed of spheres\"\ndimension = 3\ngravity = [0.0, 0.0, -1.0]\n[engine]\nkind = \"cba\"\n[domain]\nsize = [20.0, 20.0, 40.0]\n[boundary]\nx = \"periodic\"\ny = \"periodic\"\nz.lower = { wall = \"smooth\" }\nz.upper = \"open\"\n[particles]\ncount = 3000\nrestitution = 0.95\n[run]\ntime = 100.0\n";
    let names = [("time", TIME), ("kinetic_energy", ENERGY), ("temperature", ENERGY)];
    let mut log = log(scenario, names.map(|(n, u)| column(n, u)).to_vec());
    log.walls = Some(Walls {
        lower: [0.0; 3],
        upper: [20.0, 20.0, 40.0],
        sides: sides([["periodic"; 2], ["periodic"; 2], ["wall", "open"]]),
    });
    let mut noise = Noise(21);
    for k in 0..=40 {
        let time = f64::from(k) * 0.5;
        log.series.push(vec![time, 900.0 + 30.0 * noise.gauss(), 0.8 + 0.02 * noise.gauss()]);
        log.frames.push(frame(time, 3000, |_| {
            let z = -5.0 * (1.0 - noise.next()).ln() * (1.0 + 0.2 * (time).sin());
            (
                [20.0 * noise.next(), 20.0 * noise.next(), z.min(38.0)],
                [0.9 * noise.gauss(), 0.9 * noise.gauss(), 0.9 * noise.gauss()],
            )
        }));
    }
    let summary = summary(json!({
        "scenario": "bed", "engine": "cba", "dimension": 3, "particles_initial": 3000, "particles_final": 3000, "volume_fraction": 0.098,
        "collisions": 99_000, "collisions_per_particle": 66.0, "simulated_time": 20.0, "interrupted": true, "temperature": 0.8,
        "kinetic_energy_initial": 900.0, "kinetic_energy_final": 910.0
    }));
    Sample { name: "bed", log, summary }
}
