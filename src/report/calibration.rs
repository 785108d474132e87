//! What a calibration has found, and its page.

use std::fmt::Write;

use super::axis::Scale;
use super::escape::escape;
use super::page::{document, section};
use super::plot::{Curve, Ink, Plot, Stroke};
use crate::engine::report::IMPACT_BINS;
use crate::number::{count, number, with_error};
use crate::statistics::Estimate;

/// Laws for the stochastic engines, measured in event-driven runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Calibration {
    /// Title of the scenario.
    pub title: String,
    /// Its name.
    pub scenario: String,
    /// Two or three.
    pub dimension: usize,
    /// Grains at the start.
    pub particles: u32,
    /// Volume fraction of the scenario.
    pub volume_fraction: f64,
    /// Seed of the first run; the others have the numbers that follow.
    pub seed: u64,
    /// Event-driven runs.
    pub replicas: u32,
    /// Sides of the cells for which p(ν) was measured [length].
    pub cell: Vec<f64>,
    /// Grains that make such a cell full.
    pub capacity: u32,
    /// p(b) in the course of the runs.
    pub stages: Vec<Stage>,
    /// p(ν), by the number of grains in a cell.
    pub entries: Vec<Entry>,
    /// What a reader must know beside the numbers, a sentence each.
    pub remarks: Vec<String>,
}

/// Impact parameters in a stretch of the runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Collisions per particle at its beginning and its end.
    pub stretch: [f64; 2],
    /// Collisions by |b|/d, `[bin]`.
    pub impacts: [u64; IMPACT_BINS],
    /// c of p(b) ∝ 1/(1 − c b²).
    pub c: Estimate,
    /// χ² of the bins against that law; 38 are expected of a law that holds.
    pub chi_squared: f64,
    /// ⟨1 − b²⟩ of that law over its value under molecular chaos.
    pub cooling_factor: f64,
    /// The density of |b|/d that belongs to c, as points.
    pub density: Vec<[f64; 2]>,
}

impl Stage {
    /// Its middle, in collisions per particle.
    pub fn place(&self) -> f64 {
        0.5 * (self.stretch[0] + self.stretch[1])
    }

    /// The density of |b|/d that was measured, as points, and its standard errors.
    pub fn measured(&self) -> (Vec<[f64; 2]>, Vec<f64>) {
        let width = 1.0 / IMPACT_BINS as f64;
        let all: u64 = self.impacts.iter().sum();
        let norm = 1.0 / (all.max(1) as f64 * width);
        let point = |(bin, &number): (usize, &u64)| [(bin as f64 + 0.5) * width, number as f64 * norm];
        let points = self.impacts.iter().enumerate().map(point).collect();
        (points, self.impacts.iter().map(|&number| (number as f64).sqrt() * norm).collect())
    }
}

/// Entries into cells that held about the same number of grains.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Mean ν of these cells before the step.
    pub volume_fraction: f64,
    /// Grains whose free flight would have led into them.
    pub attempts: u64,
    /// Those of them that were there after the step.
    pub entered: u64,
    /// Grains that came into them from other cells, whatever their free flight.
    pub arrivals: u64,
    /// p(ν) = entered/attempts.
    pub probability: Estimate,
}

impl Entry {
    /// Arrivals over attempts: by how much interaction changes the flux into such cells.
    pub fn flux_ratio(&self) -> f64 {
        self.arrivals as f64 / self.attempts as f64
    }
}

/// `calibration.html`: one page that needs no network.
pub fn calibration_page(calibration: &Calibration) -> String {
    let mut body = format!("<header>\n<h1>{}</h1>\n", escape(&calibration.title));
    let _ = writeln!(
        body,
        "<p>Calibration of <code>{}</code>: {} event-driven runs of {} grains in {} dimensions, ν = {}, seeds from {}. \
         p(ν) is for cells of {} that are full at {} grains.</p>\n</header>",
        escape(&calibration.scenario),
        calibration.replicas,
        count(f64::from(calibration.particles)),
        calibration.dimension,
        number(calibration.volume_fraction, 4),
        calibration.seed,
        calibration.cell.iter().map(|side| number(*side, 4)).collect::<Vec<_>>().join(" × "),
        calibration.capacity,
    );
    let plots = [course_of_c(calibration), densities(calibration), entry_probability(calibration)];
    let plots: String = plots.iter().flatten().map(Plot::html).collect();
    body.push_str(&section("What was measured", &format!("<div class=\"plots\">\n{plots}</div>\n")));
    body.push_str(&table(calibration));
    for remark in &calibration.remarks {
        let _ = writeln!(body, "<p class=\"note\">{}</p>", escape(remark));
    }
    document(&format!("{}: calibration", calibration.title), &body, env!("CARGO_PKG_VERSION"))
}

/// c against collisions per particle.
fn course_of_c(calibration: &Calibration) -> Option<Plot> {
    let stages = &calibration.stages;
    let (first, last) = (stages.first()?, stages.last()?);
    let mut measured = Curve::new("measured", Vec::new(), Stroke::Dots, Ink::Series(0));
    measured.points = stages.iter().map(|stage| [stage.place(), stage.c.value]).collect();
    measured.errors = stages.iter().map(|stage| stage.c.standard_error.unwrap_or(0.0)).collect();
    let chaos = vec![[first.stretch[0], 0.0], [last.stretch[1], 0.0]];
    let table = Curve::new("table", measured.points.clone(), Stroke::Line, Ink::Series(0));
    Some(Plot {
        title: "c in the course of the runs".to_owned(),
        caption: "p(b) ∝ 1/(1 − c b²) for disks, b/(1 − c b²) for spheres (Müller 2001, 3.18 and figure 3.36). c = 0 is \
                  molecular chaos; c > 0 means more glancing collisions. Bars are standard errors."
            .to_owned(),
        x_label: "collisions per particle".to_owned(),
        y_label: "c".to_owned(),
        curves: vec![Curve::new("molecular chaos", chaos, Stroke::Dashed, Ink::Text), table, measured],
        wide: true,
        ..Plot::default()
    })
}

/// p(b) of the first, the middle and the last stage, with the fits.
fn densities(calibration: &Calibration) -> Option<Plot> {
    let stages = &calibration.stages;
    let last = stages.len().checked_sub(1)?;
    let mut chosen = vec![0, last / 2, last];
    chosen.dedup();
    let mut curves = Vec::new();
    for (series, stage) in chosen.into_iter().map(|index| &stages[index]).enumerate() {
        let (points, errors) = stage.measured();
        let c = with_error(stage.c.value, stage.c.standard_error);
        let name = format!("{} … {}: c = {c}", number(stage.stretch[0], 3), number(stage.stretch[1], 3));
        let mut measured = Curve::new(name, points, Stroke::Dots, Ink::Series(series));
        measured.errors = errors;
        curves.push(Curve::new("", stage.density.clone(), Stroke::Dashed, Ink::Series(series)));
        curves.push(measured);
    }
    Some(Plot {
        title: "Impact parameters and their fits".to_owned(),
        caption: "The density of |b|/d, by stretches of collisions per particle (Müller 2001, figure 3.35)."
            .to_owned(),
        x_label: "|b|/d".to_owned(),
        y_label: "p".to_owned(),
        curves,
        ..Plot::default()
    })
}

/// p(ν), and the ratio of fluxes beside it.
fn entry_probability(calibration: &Calibration) -> Option<Plot> {
    let entries = &calibration.entries;
    let last = entries.last()?;
    let points = |value: fn(&Entry) -> f64| -> Vec<[f64; 2]> {
        entries.iter().map(|entry| [entry.volume_fraction, value(entry)]).collect()
    };
    let mut measured = Curve::new("p", points(|entry| entry.probability.value), Stroke::Dots, Ink::Series(0));
    measured.errors = entries.iter().map(|entry| entry.probability.standard_error.unwrap_or(0.0)).collect();
    let arrivals =
        Curve::new("arrivals over attempts", points(Entry::flux_ratio), Stroke::Line, Ink::Series(1));
    let ends = [0.0, 1.06 * last.volume_fraction.max(1e-3)];
    Some(Plot {
        title: "Probability of entering a cell".to_owned(),
        caption: "p: of the grains whose free flight through a step leads into a cell of volume fraction ν, the share that \
                  is found there after the step (Müller 2001, figure 2.1). Arrivals count everybody who came."
            .to_owned(),
        x_label: "ν of the cell".to_owned(),
        y_label: "probability".to_owned(),
        x_scale: Scale::Linear,
        curves: vec![arrivals, measured],
        ranges: [Some(ends), None],
        ..Plot::default()
    })
}

/// The numbers of c.
fn table(calibration: &Calibration) -> String {
    if calibration.stages.is_empty() {
        return String::new();
    }
    let mut html = String::from(
        "<section>\n<h2>Numbers</h2>\n<div class=\"references\"><table>\n<thead><tr><th>Collisions per particle</th>\
         <th>Collisions</th><th>c</th><th>χ² (38 expected)</th><th>Energy per collision over that of chaos</th></tr></thead>\n<tbody>\n",
    );
    let cell = |text: &str| format!("<td class=\"number\">{text}</td>");
    for stage in &calibration.stages {
        let all: u64 = stage.impacts.iter().sum();
        let _ = writeln!(
            html,
            "<tr><td>{} … {}</td>{}{}{}{}</tr>",
            number(stage.stretch[0], 4),
            number(stage.stretch[1], 4),
            cell(&count(all as f64)),
            cell(&with_error(stage.c.value, stage.c.standard_error)),
            cell(&number(stage.chi_squared, 3)),
            cell(&number(stage.cooling_factor, 4)),
        );
    }
    html.push_str("</tbody>\n</table></div>\n</section>\n");
    html
}
