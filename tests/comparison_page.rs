//! The page of a made-up comparison: complete, self-contained, and safe for any text.
//!
//! `GRAINFLOW_REPORT_SAMPLES=DIR cargo test --test comparison_page` leaves the page in DIR, to be looked at.

use grainflow::comparison::model::{
    Basis, Compared, ComparedFigure, Comparison, Contestant, Cost, CurveOf, Difference, Peak, TheoryCurve,
    Verdict,
};
use grainflow::observe::measure::{Column, Dimension};
use grainflow::record::contents::{Frame, Walls};
use grainflow::report::{judgements, render_comparison};
use grainflow::statistics::{Estimate, Trend};

const PURE: Dimension = Dimension { mass: 0, length: 0, time: 0 };
const LENGTH: Dimension = Dimension { mass: 0, length: 1, time: 0 };
const TIME: Dimension = Dimension { mass: 0, length: 0, time: 1 };
const ENERGY: Dimension = Dimension { mass: 1, length: 2, time: -2 };

const ENGINES: [&str; 3] = ["hsmc", "dsmc", "event-driven"];
const REFERENCE: usize = 2;

fn column(name: &str, unit: Dimension) -> Column {
    Column { name: name.to_owned(), unit }
}

/// `value` of each engine at each place, with errors of a hundredth; DSMC differs, HSMC agrees.
fn compared(
    name: &str,
    abscissa: Column,
    ordinate: Column,
    places: Vec<f64>,
    value: impl Fn(usize, f64) -> f64,
) -> Compared {
    let curve = |engine: usize| CurveOf {
        values: places.iter().map(|x| value(engine, *x)).collect(),
        errors: places.iter().map(|x| 0.01 * value(engine, *x).abs()).collect(),
    };
    let difference = |engine: usize| {
        (engine != REFERENCE).then(|| {
            let exact = |x: &f64| value(REFERENCE, *x);
            let is_different = engine == 1;
            Difference {
                is_relative: true,
                values: places.iter().map(|x| value(engine, *x) / exact(x) - 1.0).collect(),
                errors: places.iter().map(|_| 0.014).collect(),
                most: Some(Peak { place: places[1], standard_errors: if is_different { 9.0 } else { 1.2 } }),
                threshold: 3.6,
                last_threshold: Some(3.2),
                overall: None,
                basis: Basis::Replicas,
                freedom: 100.0,
                correlation: None,
                parts_at: is_different.then(|| places[places.len() / 3]),
                verdict: if is_different { Verdict::Differs } else { Verdict::Agrees },
                sentence: format!("{} of {name} in words", ENGINES[engine]),
            }
        })
    };
    Compared {
        name: name.to_owned(),
        abscissa,
        ordinate,
        time: None,
        curves: (0..3).map(|engine| Some(curve(engine))).collect(),
        differences: (0..3).map(difference).collect(),
        places: places.clone(),
        theory: Vec::new(),
    }
}

fn cooling() -> Compared {
    let times: Vec<f64> = (0..60).map(|k| 0.1 * 1.12_f64.powi(k)).collect();
    compared("temperature", column("time", TIME), column("temperature", ENERGY), times, |engine, t| {
        let wave = 0.01 * (3.0 * t).sin();
        let pace = [3.0, 4.5, 3.05][engine];
        (1.0 + wave) / (1.0 + t / pace).powi(2)
    })
}

fn with_theory(compared: Compared) -> Compared {
    let values = compared.places.iter().map(|t| 1.0 / (1.0 + t / 3.0).powi(2)).collect();
    let law = TheoryCurve { name: "Haff’s law".to_owned(), source: "Haff, by hand".to_owned(), values };
    Compared { theory: vec![law], ..compared }
}

fn density(time: f64) -> Compared {
    let places = (0..40).map(|k| 0.5 + f64::from(k)).collect();
    let fraction = column("volume_fraction", PURE);
    let profile = compared("density-profile", column("position", LENGTH), fraction, places, |engine, x| {
        0.25 + 0.002 * time * (0.15 * x).cos() * [1.0, 1.8, 1.05][engine]
    });
    Compared { time: Some(time), ..profile }
}

fn figure() -> ComparedFigure {
    let estimate = |value: f64| Some(Estimate { value, standard_error: Some(0.01) });
    let series = cooling();
    let alone = |difference: &Option<Difference>| {
        difference.as_ref().map(|difference| Difference {
            values: vec![difference.values[0]],
            errors: vec![0.01],
            ..difference.clone()
        })
    };
    ComparedFigure {
        name: "pressure".to_owned(),
        unit: ENERGY,
        values: vec![estimate(1.02), None, estimate(1.0)],
        trends: vec![Some(Trend::Steady), None, Some(Trend::Steady)],
        differences: series
            .differences
            .iter()
            .enumerate()
            .map(|(k, d)| if k == 1 { None } else { alone(d) })
            .collect(),
        theory: Some((1.01, "Enskog, by hand".to_owned())),
    }
}

fn contestant(engine: &str, order: usize) -> Contestant {
    let grains = 400;
    let frame = |time: f64| {
        let place = |k: usize| ((k * 37 + order * 5) % 100) as f32 * 0.4;
        Frame {
            time,
            grains: grains as u64,
            positions: (0..grains).map(|k| [place(k), place(k * 3 + 1), 0.0]).collect(),
            velocities: (0..grains).map(|k| [place(k) / (1.0 + time as f32), 0.0, 0.0]).collect(),
            ids: (0..grains as u32).collect(),
        }
    };
    let side = || ["periodic".to_owned(), "periodic".to_owned()];
    let is_exact = engine == "event-driven";
    Contestant {
        label: engine.to_owned(),
        engine: engine.to_owned(),
        folders: vec![format!("{engine}-1"), format!("{engine}-2")],
        failures: Vec::new(),
        cost: Some(Cost {
            wall_seconds: 3.0,
            advancing_seconds: if is_exact { 2.5 } else { 0.5 },
            particle_steps_per_second: (!is_exact).then_some(2.1e7),
            events_per_second: is_exact.then_some(9.3e5),
            peak_memory: Some(3.1e7),
        }),
        walls: Some(Walls {
            lower: [0.0; 3],
            upper: [40.0, 40.0, 0.0],
            sides: [side(), side(), Default::default()],
        }),
        diameter: 1.0,
        kinds: Default::default(),
        frames: [0.0, 10.0, 20.0, 40.0, 80.0].map(frame).to_vec(),
    }
}

fn made_up() -> Comparison {
    Comparison {
        title: "Cooling, side by side".to_owned(),
        scenario: "cooling".to_owned(),
        scenario_text: "title = \"Cooling\"\n".to_owned(),
        dimension: 2,
        units: ["length", "mass", "time"].map(str::to_owned),
        version: "0.1.0".to_owned(),
        numerics: 2,
        seed: 7,
        replicas: 2,
        remarks: vec!["Errors come from 2 replicas.".to_owned()],
        contestants: ENGINES.iter().enumerate().map(|(k, engine)| contestant(engine, k)).collect(),
        reference: REFERENCE,
        series: vec![with_theory(cooling())],
        profiles: [1.0, 10.0, 40.0, 80.0].map(density).to_vec(),
        figures: vec![figure()],
    }
}

#[test]
fn the_page_is_complete_and_needs_no_network() {
    let page = render_comparison(&made_up());
    if let Some(folder) = std::env::var_os("GRAINFLOW_REPORT_SAMPLES") {
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(std::path::Path::new(&folder).join("comparison.html"), &page).unwrap();
    }
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>\n"));
    for foreign in ["http://", "https://", "<link rel=\"stylesheet", "@import", "src=\"//", "<script"] {
        assert!(!page.contains(foreign), "{foreign}");
    }
    assert!(page.split("<svg").skip(1).all(|plot| !plot.contains("\"NaN") && !plot.contains(" NaN")));
    for text in [
        "Cooling, side by side",
        "hsmc of temperature in words",
        "dsmc of density-profile in words",
        "<b>agrees</b>",
        "<b>differs</b>",
        "5 times faster",
        "0.93 million events/s",
        "relative difference from event-driven",
        "Enskog, by hand",
        "Haff’s law: Haff, by hand.",
        "Errors come from 2 replicas.",
        "href=\"hsmc-1/report.html\"",
        "title = &quot;Cooling&quot;",
        "(t = 80)",
        "stroke-dasharray",
    ] {
        assert!(page.contains(text), "{text}");
    }
    // Theory, and the line at zero of each difference.
    assert_eq!(page.matches("class=\"curve dashed\"").count(), 1 + 4);
    // Four times of three engines; a series and three of four times of a profile, each with its difference.
    assert_eq!(page.matches("<img ").count(), 12);
    assert_eq!(page.matches("role=\"img\"").count(), 8);
}

#[test]
fn verdicts_are_counted_by_engine() {
    let judged = judgements(&made_up());
    // Temperature, density profile and pressure; DSMC has no pressure.
    let counted: Vec<(&str, usize, usize)> =
        judged.iter().map(|j| (j.engine.as_str(), j.agreeing, j.differing.len())).collect();
    assert_eq!(counted, [("hsmc", 3, 0), ("dsmc", 0, 2)]);
    let mut unknown = made_up();
    let difference = unknown.series[0].differences[0].as_mut().unwrap();
    (difference.verdict, difference.most) = (Verdict::Unknown, None);
    assert_eq!((judgements(&unknown)[0].unknown, judgements(&unknown)[0].quantities()), (1, 3));
    assert!(render_comparison(&unknown).contains("1 without errors to judge by"));
}

#[test]
fn the_loudest_time_of_a_profile_speaks() {
    let mut loud = made_up();
    let difference = loud.profiles[2].differences[0].as_mut().unwrap();
    difference.verdict = Verdict::Differs;
    difference.sentence = "hsmc parts here".to_owned();
    assert!(render_comparison(&loud).contains("hsmc parts here (t = 40)"));
    assert_eq!(judgements(&loud)[0].differing, ["hsmc parts here"]);
}

#[test]
fn text_from_outside_cannot_become_markup() {
    let attack = "</style></script><script>alert(1)</script>";
    let mut comparison = made_up();
    let outside = || attack.to_owned();
    (comparison.title, comparison.scenario, comparison.scenario_text) = (outside(), outside(), outside());
    (comparison.version, comparison.remarks) = (outside(), vec![outside()]);
    comparison.units = [outside(), outside(), outside()];
    for contestant in &mut comparison.contestants {
        (contestant.label, contestant.folders, contestant.failures) =
            (outside(), vec![outside()], vec![outside()]);
    }
    for compared in comparison.series.iter_mut().chain(&mut comparison.profiles) {
        (compared.name, compared.ordinate.name, compared.abscissa.name) = (outside(), outside(), outside());
        compared.differences.iter_mut().flatten().for_each(|difference| difference.sentence = outside());
        compared.theory.iter_mut().for_each(|theory| (theory.name, theory.source) = (outside(), outside()));
    }
    comparison.figures[0].name = outside();
    comparison.figures[0].theory = Some((1.0, outside()));
    assert!(!render_comparison(&comparison).contains("<script"));
}

#[test]
fn what_failed_is_told_and_what_is_missing_survived() {
    let mut comparison = made_up();
    let exact = &mut comparison.contestants[REFERENCE];
    exact.failures = vec!["replica 2: inelastic collapse".to_owned()];
    (exact.frames, exact.cost, exact.folders) = (Vec::new(), None, Vec::new());
    for compared in comparison.series.iter_mut().chain(&mut comparison.profiles) {
        compared.curves[REFERENCE] = None;
        compared.differences = vec![None, None, None];
    }
    let page = render_comparison(&comparison);
    assert!(page.contains("event-driven: replica 2: inelastic collapse"));
    assert!(page.contains("none came to its end") && page.contains("not known"));
    assert_eq!((page.matches("<img ").count(), page.matches("role=\"img\"").count()), (8, 4));
    assert!(render_comparison(&Comparison::default()).contains("Nothing to compare."));
}
