//! A made-up comparison for tests of what is written.

use super::model::{
    Basis, Compared, ComparedFigure, Comparison, Contestant, Correlation, Cost, CurveOf, Difference, Overall,
    Peak, TheoryCurve, Verdict,
};
use crate::observe::units::{ENERGY, PURE, column};
use crate::record::contents::Frame;
use crate::statistics::{Estimate, Trend};

/// HSMC beside event-driven dynamics: one series of two places, one profile, one figure.
pub(super) fn made_up() -> Comparison {
    Comparison {
        title: "A \"gas\", small".to_owned(),
        scenario: "gas".to_owned(),
        dimension: 2,
        units: ["length", "mass", "time"].map(str::to_owned),
        seed: 7,
        replicas: 2,
        remarks: vec!["Errors come from 2 replicas.".to_owned()],
        contestants: vec![contestant("hsmc, again"), contestant("event-driven")],
        reference: 1,
        series: vec![temperature()],
        profiles: vec![Compared {
            name: "density-profile".to_owned(),
            abscissa: column("position", PURE),
            ordinate: column("volume_fraction", PURE),
            time: Some(2.5),
            theory: Vec::new(),
            ..temperature()
        }],
        figures: vec![ComparedFigure {
            name: "pressure".to_owned(),
            unit: ENERGY,
            values: vec![Some(Estimate { value: 1.25, standard_error: Some(0.5) }), None],
            trends: vec![Some(Trend::Rising), None],
            differences: vec![Some(difference(vec![0.25], vec![0.75])), None],
            theory: Some((1.5, "Enskog".to_owned())),
        }],
        ..Comparison::default()
    }
}

fn contestant(label: &str) -> Contestant {
    let frame =
        Frame { time: 0.0, grains: 1, positions: vec![[0.5; 3]], velocities: vec![[0.0; 3]], ids: vec![0] };
    let cost = Cost { wall_seconds: 2.0, peak_memory: Some(1e6), ..Cost::default() };
    Contestant {
        label: label.to_owned(),
        engine: label.split(',').next().unwrap_or_default().to_owned(),
        folders: vec!["run-1".to_owned()],
        cost: Some(cost),
        frames: vec![frame],
        diameter: 1.0,
        ..Contestant::default()
    }
}

fn temperature() -> Compared {
    let curve = |values: [f64; 2]| Some(CurveOf { values: values.to_vec(), errors: vec![0.0, f64::NAN] });
    Compared {
        name: "temperature".to_owned(),
        abscissa: column("time", PURE),
        ordinate: column("temperature", ENERGY),
        time: None,
        places: vec![0.0, 0.5],
        curves: vec![curve([1.0, 0.1]), curve([1.0, f64::NAN])],
        differences: vec![Some(difference(vec![0.0, f64::NAN], vec![0.0, f64::NAN])), None],
        theory: vec![TheoryCurve {
            name: "Haff’s law".to_owned(),
            source: "Haff 1983".to_owned(),
            values: vec![1.0, 0.125],
        }],
    }
}

fn difference(values: Vec<f64>, errors: Vec<f64>) -> Difference {
    Difference {
        is_relative: true,
        values,
        errors,
        most: Some(Peak { place: 0.5, standard_errors: 4.0 }),
        threshold: 3.5,
        last_threshold: Some(3.125),
        overall: Some(Overall { value: 0.25, error: 0.0625, standard_errors: 4.0, threshold: 3.25 }),
        basis: Basis::Growth,
        freedom: 12.0,
        correlation: Some(Correlation { time: 0.75, clock: "time".to_owned() }),
        parts_at: None,
        verdict: Verdict::Differs,
        sentence: "They differ.".to_owned(),
    }
}
