//! Slowly grown spheres freeze: their pressure falls (Miller 2004, figure 4.2).

use glam::DVec3;
use grainflow::engine::event_driven::EventDriven;
use grainflow::engine::event_driven::laws::{Growth, Laws};
use grainflow::engine::event_driven::rules::{Cure, Structure};
use grainflow::engine::report::Totals;
use grainflow::engine::{Engine, Horizon, NoLaps};
use grainflow::law::boundary::Boundary;
use grainflow::law::restitution::{Constant, RestitutionLaw};
use grainflow::matter::grain::Grain;
use grainflow::observe::moments;
use grainflow::random::Streams;
use grainflow::scenario::initial::rescale;

use crate::trial::{Trial, periodic};

/// Where grains begin to grow, where they stop, and how far apart pressures are taken, all in ν.
const START: f64 = 0.46;
const END: f64 = 0.60;
const WINDOWS: u32 = 28;

/// PV/NT at one density.
#[derive(Clone, Copy, Debug)]
struct Point {
    volume_fraction: f64,
    compressibility: f64,
}

fn laws(size: DVec3, largest: f64) -> Laws<DVec3> {
    Laws {
        grain: Grain { diameter: largest, mass: 1.0 },
        species: Vec::new(),
        restitution: RestitutionLaw::Constant(Constant(1.0)),
        roughness: None,
        gravity: DVec3::ZERO,
        size,
        boundary: Boundary::periodic(),
        cure: Cure::default(),
        growth: Growth::NONE,
        streams: Streams::new(1),
        seed: 1,
    }
}

/// Pressures of `count` spheres whose diameter grows at `rate` thermal speeds.
fn compress(count: u32, rate: f64, seed: u64) -> Vec<Point> {
    let mut gas = Trial::<DVec3>::equilibrated(&periodic::<DVec3>(count, START, 1.0), seed, 20.0).gas;
    let size = gas.grid().size();
    let diameter = |volume_fraction: f64| (volume_fraction / START).cbrt();
    let width = (END - START) / f64::from(WINDOWS);
    let mut laws = laws(size, diameter(END));
    let mut points = Vec::new();
    for window in 0..WINDOWS {
        let begin = START + width * f64::from(window);
        let [share, next] = [begin, begin + width].map(|density| diameter(density) / diameter(END));
        let rate = rate / diameter(END);
        laws.growth = Growth { start: share, rate };
        rescale(&mut gas, 1.0);
        gas.clock = Default::default();
        let duration = (next - share) / rate * (1.0 - 1e-12);
        let mut engine = EventDriven::new(laws.clone(), Structure::Automatic);
        let mut totals = Totals::default();
        while gas.time() < duration {
            let report =
                engine.step(&mut gas, Horizon { time: duration, collisions: u64::MAX }, &mut NoLaps).unwrap();
            totals.add(&report, gas.len());
        }
        let temperature = 0.5 * (1.0 + moments::temperature(&gas));
        let carried = totals.counts.carried_momentum / (3.0 * f64::from(count) * temperature * duration);
        points.push(Point { volume_fraction: begin + 0.5 * width, compressibility: 1.0 + carried });
    }
    points
}

/// The deepest fall of PV/NT: from the highest point so far to a later one, as a share of the former.
fn fall(points: &[Point]) -> (Point, Point, f64) {
    let mut highest = points[0];
    let mut deepest = (highest, highest, 0.0);
    for &point in points {
        if point.compressibility > highest.compressibility {
            highest = point;
        }
        let depth = 1.0 - point.compressibility / highest.compressibility;
        if depth > deepest.2 {
            deepest = (highest, point, depth);
        }
    }
    deepest
}

fn show(count: u32, rate: f64, seed: u64) -> (Point, Point, f64) {
    let start = std::time::Instant::now();
    let points = compress(count, rate, seed);
    let table: Vec<(f64, f64)> =
        points.iter().map(|point| (point.volume_fraction, point.compressibility)).collect();
    let (high, low, depth) = fall(&points);
    println!(
        "N = {count}, rate {rate}: {table:.4?}\nfalls by {depth:.3} from {high:?} to {low:?}; {:.1} s",
        start.elapsed().as_secs_f64()
    );
    (high, low, depth)
}

#[test]
fn trial_rates() {
    let count: u32 = std::env::var("COUNT").map_or(500, |text| text.parse().unwrap());
    let rate: f64 = std::env::var("RATE").map_or(1e-3, |text| text.parse().unwrap());
    show(count, rate, 1);
}
