use super::*;
use crate::random::{Phase, Stream, Streams};
use glam::{DVec2, DVec3};

fn stream(place: u64) -> Stream {
    Streams::new(4).at(0, Phase::Collisions).stream(place)
}

fn near(found: Option<f64>, expected: f64) {
    let t = found.expect("they meet");
    assert!((t - expected).abs() <= 1e-12 * expected.abs().max(1.0), "{t} {expected}");
}

/// Bisects `f`, positive at `low` and not at `high`.
fn bisect(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn grains_meet_head_on_aslant_and_not_at_all() {
    let at_x = DVec2::new(5.0, 0.0);
    near(pair_contact(at_x, DVec2::new(-2.0, 0.0), 1.0, 0.0), 2.0);
    // At an offset 3/5 of the contact distance the centres are 4/5 of it apart along the way.
    near(pair_contact(DVec3::new(10.0, 0.6, 0.0), DVec3::new(-4.0, 0.0, 0.0), 1.0, 0.0), 2.3);
    assert_eq!(pair_contact(at_x, DVec2::new(2.0, 0.0), 1.0, 0.0), None);
    assert_eq!(pair_contact(at_x, DVec2::ZERO, 1.0, 0.0), None);
    assert_eq!(pair_contact(DVec2::new(5.0, 1.0 + 1e-12), DVec2::new(-2.0, 0.0), 1.0, 0.0), None);
    // A brush: as uncertain as the square root of rounding.
    let t = pair_contact(DVec2::new(5.0, 1.0 - 1e-12), DVec2::new(-2.0, 0.0), 1.0, 0.0).unwrap();
    assert!((t - (2.5 - 0.5 * f64::sqrt(2e-12))).abs() < 1e-8);
}

#[test]
fn overlapping_grains_meet_now_or_not_at_all() {
    let overlapping = DVec2::new(1.0 - 1e-15, 0.0);
    assert_eq!(pair_contact(overlapping, DVec2::new(-1e-9, 1.0), 1.0, 0.0), Some(0.0));
    assert_eq!(pair_contact(overlapping, DVec2::new(1e-9, 1.0), 1.0, 0.0), None);
    assert_eq!(pair_contact(overlapping, DVec2::ZERO, 1.0, 0.0), None);
    assert_eq!(pair_contact(DVec2::X * 0.1, -DVec2::X, 1.0, 0.0), Some(0.0));
    // Apart by less than rounding resolves in the root's other form: 1e-9 away at speed 1.
    let t = pair_contact(DVec2::new(1.0 + 1e-9, 0.0), DVec2::new(-1.0, 0.0), 1.0, 0.0).unwrap();
    assert!((t - 1e-9).abs() < 1e-15);
}

#[test]
fn growing_grains_meet_even_as_they_part() {
    // At rest: 5 = 1 + 2t. Parting at 1, growing at 2: 5 + t = 1 + 2t. Approaching: 5 − t = 1 + 2t.
    let at_x = DVec2::new(5.0, 0.0);
    near(pair_contact(at_x, DVec2::ZERO, 1.0, 2.0), 2.0);
    near(pair_contact(at_x, DVec2::X, 1.0, 2.0), 4.0);
    near(pair_contact(at_x, -DVec2::X, 1.0, 2.0), 4.0 / 3.0);
    // As fast as they grow: the quadratic coefficient is zero. 5 + 2t never is 1 + 2t; 5 − 2t is.
    assert_eq!(pair_contact(at_x, DVec2::X * 2.0, 1.0, 2.0), None);
    near(pair_contact(at_x, DVec2::X * -2.0, 1.0, 2.0), 1.0);
    // Aslant at the same speed: 25 + 4t² = (1 + 2t)².
    near(pair_contact(at_x, DVec2::Y * 2.0, 1.0, 2.0), 6.0);
    // Shrinking: 5 − 2t = 1 − t/4.
    near(pair_contact(at_x, DVec2::X * -2.0, 1.0, -0.25), 16.0 / 7.0);
    // At contact and parting faster than they grow, or slower.
    assert_eq!(pair_contact(DVec2::X, DVec2::X * 3.0, 1.0, 2.0), None);
    assert_eq!(pair_contact(DVec2::X, DVec2::X, 1.0, 2.0), Some(0.0));
    // Overlapping (3/4 of the distance), parting across at speed 1.5 > 1, and growth catches up only ever more.
    assert_eq!(pair_contact(DVec2::X * 0.75, DVec2::new(1.0, 1.5), 1.0, 2.0), Some(0.0));
}

#[test]
fn random_pairs_meet_where_a_scan_finds_it() {
    let mut random = stream(0);
    let mut met = 0;
    for k in 0..2000 {
        let dx = DVec3::from_fn(|_| 3.0 * random.symmetric());
        let dv = DVec3::from_fn(|_| random.gaussian()) - dx * 0.3;
        let growth = [0.0, 0.3, -0.1, 2.0][k % 4];
        let gap = |t: f64| (dx + dv * t).length_squared() - (1.0 + growth * t).powi(2);
        if gap(0.0) <= 0.0 {
            continue;
        }
        let (steps, horizon) = (4000, 8.0);
        let time = |k: u32| horizon * f64::from(k) / f64::from(steps);
        // A shrinking contact distance is scanned until it is zero.
        let first = (1..=steps).find(|&k| gap(time(k)) <= 0.0 && 1.0 + growth * time(k) > 0.0);
        let found = pair_contact(dx, dv, 1.0, growth).filter(|&t| t < horizon);
        if let Some(first) = first {
            met += 1;
            let t = found.expect("they meet");
            let exact = bisect(gap, time(first - 1), time(first));
            // Near grazing the root is as uncertain as the square root of rounding.
            let slope = (gap(exact + 1e-4) - gap(exact - 1e-4)).abs() / 2e-4;
            assert!((t - exact).abs() * slope.min(1.0) < 1e-12, "{t} {exact} {slope}");
        } else if let Some(t) = found {
            // A brush between two points of the scan.
            assert!(gap(t).abs() < 1e-12 && gap(t - 2e-3) > 0.0 && gap(t + 2e-3) > 0.0, "{t}");
        }
    }
    assert!(met > 300, "{met}");
}

#[test]
fn grains_fall_on_planes() {
    near(plane_contact(6.0, -3.0, 0.0), 2.0);
    assert_eq!(plane_contact(6.0, 3.0, 0.0), None);
    assert_eq!(plane_contact(6.0, 0.0, 0.0), None);
    // 20 m up at g = 10: two seconds; thrown up at 15 from 20: 4 s. Thrown down at 10 from 40: 2 s.
    near(plane_contact(20.0, 0.0, -10.0), 2.0);
    near(plane_contact(20.0, 15.0, -10.0), 4.0);
    near(plane_contact(40.0, -10.0, -10.0), 2.0);
    // Against an acceleration away: 8 − 6t + t² has its first root at 2; 10 − 6t + t² has none.
    near(plane_contact(8.0, -6.0, 2.0), 2.0);
    assert_eq!(plane_contact(10.0, -6.0, 2.0), None);
    assert_eq!(plane_contact(9.0, -6.0, 2.0), None);
    // A weak field must not spoil the straight root, nor be lost where it alone decides.
    near(plane_contact(6.0, -3.0, -1e-300), 2.0);
    near(plane_contact(0.5, 0.0, -1e-12), 1e6);
}

#[test]
fn a_grain_on_a_plane_rests_bounces_or_leaves() {
    assert_eq!(plane_contact(0.0, 0.0, -10.0), Some(0.0));
    assert_eq!(plane_contact(-1e-17, 0.0, -10.0), Some(0.0));
    assert_eq!(plane_contact(-1e-17, -1e-20, 10.0), Some(0.0));
    assert_eq!(plane_contact(0.0, 0.0, 0.0), None);
    assert_eq!(plane_contact(-1e-17, 0.0, 10.0), None);
    assert_eq!(plane_contact(-1e-17, 1.0, 0.0), None);
    // A bounce at 5 under g = 10 takes a second, wherever rounding has put the grain.
    for height in [0.0, 1e-17, -1e-17] {
        near(plane_contact(height, 5.0, -10.0), 1.0);
    }
    // Too slow to come above the plane again: it falls from the top of its flight, at v/g.
    near(plane_contact(-1.0, 1.0, -10.0), 0.1);
}

#[test]
fn a_coordinate_leaves_its_interval_once() {
    assert_eq!(leave_interval(2.0, 1.0, 4.0, 1.0, 0.0), (2.0, true));
    assert_eq!(leave_interval(2.0, 1.0, 4.0, -1.0, 0.0), (1.0, false));
    assert_eq!(leave_interval(2.0, 1.0, 4.0, 0.0, 0.0).0, f64::INFINITY);
    // Thrown up at 4 under g = 10 it rises 0.8: it leaves above 2.5 but turns below 3.
    let (t, upper) = leave_interval(2.0, 1.0, 2.5, 4.0, -10.0);
    assert!(upper && (t - (4.0 - 6.0_f64.sqrt()) / 10.0).abs() < 1e-15);
    let (t, upper) = leave_interval(2.0, 1.0, 3.0, 4.0, -10.0);
    assert!(!upper && (t - 1.0).abs() < 1e-15);
    // Beyond an end: outward now, inward on to the other end.
    let beyond = 4.0_f64.next_up();
    assert_eq!(leave_interval(beyond, 1.0, 4.0, 1e-9, 0.0), (0.0, true));
    let (t, upper) = leave_interval(beyond, 1.0, 4.0, -1.0, 0.0);
    assert!(!upper && (t - 3.0).abs() < 1e-14);
    assert_eq!(leave_interval(1.0, 1.0, 4.0, -1e-9, 0.0), (0.0, false));
    assert_eq!(leave_interval(1.0, 1.0, 4.0, 0.0, -1.0), (0.0, false));
    // At the lower end under gravity and thrown up: back at the same end.
    let (t, upper) = leave_interval(1.0, 1.0, 4.0, 5.0, -10.0);
    assert!(!upper && (t - 1.0).abs() < 1e-15);
    // At the upper end with nothing but a pull inward.
    let (t, upper) = leave_interval(4.0, 1.0, 4.0, 0.0, -6.0);
    assert!(!upper && (t - 1.0).abs() < 1e-15);
}

/// Earliest contact that a scan with steps of 1/2000 of a period or of `until` sees.
fn scan(flight: &FlightOverVibration, until: f64) -> Option<f64> {
    let periods = flight.angular_frequency * until / std::f64::consts::TAU;
    let steps = (2000.0 * (1.0 + periods)) as u32;
    let mut above = false;
    for k in 0..=steps {
        let time = |k: u32| until * f64::from(k) / f64::from(steps);
        let [gap, rate, _] = flight.gap(time(k));
        if gap > 0.0 {
            above = true;
        } else if above {
            return Some(bisect(|t| flight.gap(t)[0], time(k - 1), time(k)));
        } else if rate < 0.0 {
            // Below from the start and already turned.
            return Some(if k == 0 { 0.0 } else { bisect(|t| flight.gap(t)[1], time(k - 1), time(k)) });
        }
    }
    None
}

/// Compares with the scan; hits that a scan misses must be genuine brushes.
fn agrees_with_scan(flight: &FlightOverVibration, until: f64) -> bool {
    let (expected, found) = (scan(flight, until), vibrating_contact(flight, until));
    match (expected, found) {
        (None, None) => false,
        (Some(expected), Some(t))
            if (t - expected).abs() * flight.gap(expected)[1].abs().min(1.0) < 1e-12 =>
        {
            true
        }
        (_, Some(t)) => {
            let [gap, rate, curvature] = flight.gap(t);
            let scale = flight.amplitude + flight.height.abs();
            assert!(expected.is_none_or(|expected| t < expected), "{flight:?} {t} {expected:?}");
            assert!(gap <= 1e-14 * scale && rate < 1e-12, "{flight:?} {t} {gap} {rate}");
            // It comes up again within the step of the scan.
            let back = -2.0 * rate / curvature;
            let step = std::f64::consts::TAU / flight.angular_frequency / 1000.0;
            assert!(curvature > 0.0 && back < step, "{flight:?} {t} {back}");
            true
        }
        (Some(expected), None) => panic!("{flight:?}: missed at {expected}"),
    }
}

#[test]
fn random_flights_meet_the_wall_where_a_scan_finds_it() {
    let mut random = stream(1);
    let mut met = 0;
    for k in 0..4000 {
        let amplitude = 0.2 * random.uniform();
        let flight = FlightOverVibration {
            amplitude,
            angular_frequency: [0.5, 5.0, 50.0, 1000.0][k % 4] * (0.5 + random.uniform()),
            phase: 6.3 * random.uniform(),
            acceleration: [-9.81, 0.0, 2.0, -0.1][(k / 4) % 4],
            velocity: random.gaussian() * [1.0, 0.1, 0.001][(k / 16) % 3],
            height: amplitude + random.uniform() * [1.0, 1e-3, -amplitude][(k / 48) % 3],
        };
        let period = std::f64::consts::TAU / flight.angular_frequency;
        met += usize::from(agrees_with_scan(&flight, f64::min(2.0, 20.0 * period)));
    }
    assert!((1000..4000).contains(&met), "{met}");
}

/// A grain on the wall at a random phase, leaving it at a random speed: rounding has put it on either side.
#[test]
fn a_bounce_is_not_met_again_but_chattering_is() {
    let mut random = stream(2);
    let mut soon = 0;
    for k in 0..3000 {
        let (amplitude, omega, phase) = (0.1, 20.0, 6.3 * random.uniform());
        let (sine, cosine) = libm::sincos(phase);
        let speed = random.uniform() * [2.0, 0.1, 1e-3, 1e-6][k % 4];
        let flight = FlightOverVibration {
            amplitude,
            angular_frequency: omega,
            phase,
            acceleration: -9.81,
            velocity: amplitude * omega * cosine + speed,
            height: amplitude * sine + [0.0, 1e-17, -1e-17][k % 3],
        };
        let t = vibrating_contact(&flight, 10.0).expect("it falls back");
        let curvature = flight.gap(0.0)[2];
        // Where the wall accelerates towards the grain, the next hit comes after 2 v/|h''| if that is soon.
        if curvature < -10.0 && speed < 1e-3 {
            soon += 1;
            let expected = 2.0 * speed / -curvature;
            let jerk = amplitude * omega.powi(3);
            assert!(
                (t / expected - 1.0).abs() < jerk * expected / -curvature + 1e-9 + 1e-16 / (speed * expected),
                "{t} {expected}"
            );
        } else {
            assert!(t > 0.0);
        }
        // Nothing came before: the gap is positive on the way.
        for k in 1..100 {
            assert!(flight.gap(t * f64::from(k) / 100.0)[0] > -1e-16);
        }
    }
    assert!(soon > 200, "{soon}");
}

#[test]
fn a_brush_counts_if_it_reaches_the_wall() {
    // Level flight at the wall's highest place, give or take: the wall touches it at a quarter of a period.
    let level = |height: f64| FlightOverVibration {
        height,
        velocity: 0.0,
        acceleration: 0.0,
        amplitude: 1.0,
        angular_frequency: 3.0,
        phase: 0.0,
    };
    assert_eq!(vibrating_contact(&level(1.0 + 1e-15), 1e9), None);
    let t = vibrating_contact(&level(1.0 - 1e-12), 10.0).unwrap();
    assert!((t - libm::asin(1.0 - 1e-12) / 3.0).abs() < 1e-9);
    near(vibrating_contact(&level(0.5), 10.0), std::f64::consts::FRAC_PI_6 / 3.0);
    // A descent that the wall just fails to meet, and one that it just meets: least gap ±1e-9 at some time.
    let falling = |lift: f64| FlightOverVibration { height: 4.0 + lift, velocity: -1.0, ..level(0.0) };
    let least = |lift: f64| {
        let flight = falling(lift);
        let turn = bisect(|t| -flight.gap(t)[1], 2.1, 3.1);
        flight.gap(turn)[0]
    };
    let lift = bisect(|lift| -least(lift), -3.0, 3.0);
    let late = vibrating_contact(&falling(lift + 1e-9), 100.0).unwrap();
    let soon = vibrating_contact(&falling(lift - 1e-9), 100.0).unwrap();
    assert!(late - soon > 0.3, "{soon} {late}");
    assert!(soon > 2.1 && soon < 3.1);
}

#[test]
fn a_long_flight_takes_few_steps_and_no_precision() {
    // Thrown up at 5 km/s over a fast small wall: 1000 s, 10⁵ periods.
    let flight = FlightOverVibration {
        height: 0.0,
        velocity: 5000.0,
        acceleration: -10.0,
        amplitude: 1e-3,
        angular_frequency: 600.0,
        phase: 1.0,
    };
    let t = vibrating_contact(&flight, 2000.0).unwrap();
    let [before, ..] = flight.gap(t - 1e-11);
    let [after, ..] = flight.gap(t + 1e-11);
    assert!(before > 0.0 && after < 0.0 && (t - 1000.0).abs() < 1e-6);
    assert_eq!(vibrating_contact(&flight, 999.0), None);
    // Without a field it never comes back, and that takes no time to find out.
    assert_eq!(vibrating_contact(&FlightOverVibration { acceleration: 0.0, ..flight }, 1e15), None);
}

#[test]
fn a_still_wall_is_a_plane() {
    for (amplitude, angular_frequency) in [(0.0, 7.0), (0.3, 0.0), (0.0, 0.0)] {
        let phase = 1.1;
        let wall = amplitude * libm::sin(phase);
        let flight = FlightOverVibration {
            height: 20.0 + wall,
            velocity: 15.0,
            acceleration: -10.0,
            amplitude,
            angular_frequency,
            phase,
        };
        near(vibrating_contact(&flight, 10.0), 4.0);
        assert_eq!(vibrating_contact(&FlightOverVibration { acceleration: 0.0, ..flight }, 10.0), None);
    }
}
