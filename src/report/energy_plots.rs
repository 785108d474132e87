//! How the energy goes: temperature against time and against collisions, beside Haff's law where it applies.

use super::axis::Scale;
use super::evidence::Evidence;
use super::plot::{Curve, Ink, Plot, Stroke};
use crate::comparison::laws;
use crate::law::homogeneous_cooling::HomogeneousCooling;
use crate::number::number;

/// Haff's law for a run, with the first Sonine correction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Haff(HomogeneousCooling);

impl Haff {
    /// The law of a gas that cools, where [`laws::cooling`] knows one of it.
    pub(super) fn of(evidence: &Evidence<'_>) -> Option<Self> {
        let known = evidence.setup.known.as_ref()?;
        laws::cooling(&known.scenario, initial_temperature(evidence)?).map(Self)
    }

    /// t₀ [time].
    pub(super) fn time(&self) -> f64 {
        self.0.time
    }

    /// t₀ as measured: 1/slope of √(T₀/T) − 1 over the points up to 2 t₀, through the origin.
    pub(super) fn measured_time(&self, temperatures: &[[f64; 2]]) -> Option<f64> {
        let early = temperatures.iter().filter(|p| p[0] > 0.0 && p[0] <= 2.0 * self.0.time && p[1] > 0.0);
        let (mut squares, mut products, mut count) = (0.0, 0.0, 0);
        for [time, temperature] in early {
            squares += time * time;
            products += time * ((self.0.temperature / temperature).sqrt() - 1.0);
            count += 1;
        }
        (count >= 3 && products > 0.0).then(|| squares / products)
    }
}

/// From the first recording, else from the energy of the summary.
fn initial_temperature(evidence: &Evidence<'_>) -> Option<f64> {
    if let Some((column, _)) = evidence.column("temperature")
        && let Some(first) = evidence.series(0, column).first()
        && first[0] == 0.0
    {
        return Some(first[1]);
    }
    let energy = evidence.figure("kinetic_energy_initial")?;
    Some(2.0 * energy / (evidence.setup.count? * evidence.setup.dimension as f64))
}

/// Columns of the series that these plots show.
pub(super) const SHOWN: [&str; 3] = ["kinetic_energy", "temperature", "collisions_per_particle"];

/// Temperature (or energy) against time and collisions, and collisions against time.
pub(super) fn plots(evidence: &Evidence<'_>) -> Vec<Plot> {
    let mut plots = Vec::new();
    let haff = Haff::of(evidence);
    if let Some((column, described)) = evidence.column("temperature") {
        plots.push(against_time(evidence, column, haff, evidence.setup.with_unit("T", described.unit)));
        // Where grains lie or are driven, collisions are no clock.
        if let Some((collisions, _)) = evidence.column("collisions_per_particle")
            && evidence.setup.is_undriven()
        {
            let points = evidence.series(collisions, column);
            plots.extend(against_collisions(points, haff, evidence.setup.with_unit("T", described.unit)));
        }
    }
    if let Some((column, described)) = evidence.column("kinetic_energy") {
        let points = evidence.series(0, column);
        let plot = Plot {
            title: "Kinetic energy".to_owned(),
            x_label: evidence.setup.time_label(),
            y_label: evidence.setup.with_unit("E", described.unit),
            x_scale: scale_of_times(&points),
            y_scale: Scale::of_energy(&points),
            curves: vec![Curve::new("", points, Stroke::Line, Ink::Series(0))],
            ..Plot::default()
        };
        plots.push(plot.focused());
    }
    if let Some((column, _)) = evidence.column("collisions_per_particle") {
        let points = evidence.series(0, column);
        plots.push(Plot {
            title: "Collisions".to_owned(),
            x_label: evidence.setup.time_label(),
            y_label: "collisions per particle, 2C/N".to_owned(),
            x_scale: scale_of_times(&points),
            curves: vec![Curve::new("", points, Stroke::Line, Ink::Series(0))],
            ..Plot::default()
        });
    }
    plots
}

fn against_time(evidence: &Evidence<'_>, column: usize, haff: Option<Haff>, label: String) -> Plot {
    let points = evidence.series(0, column);
    let mut plot = Plot {
        title: "Temperature".to_owned(),
        x_label: evidence.setup.time_label(),
        y_label: label,
        x_scale: scale_of_times(&points),
        y_scale: Scale::of_energy(&points),
        ..Plot::default()
    };
    if let Some([count, rate]) = evidence.setup.source() {
        plot.caption = format!("The last grain is poured at about t = {}.", number(count / rate, 3));
    }
    if let Some(haff) = haff {
        let law = points.iter().map(|p| [p[0], haff.0.at_time(p[0])]).collect();
        plot.curves.push(Curve::new("Haff’s law, Sonine-corrected", law, Stroke::Dashed, Ink::Text));
        plot.caption = format!(
            "T₀(1 + t/t₀)⁻² with t₀ = {} from kinetic theory; nothing is fitted. A gas that clusters leaves the law.",
            number(haff.time(), 4)
        );
    }
    plot.curves.insert(0, Curve::new("measured", points, Stroke::Line, Ink::Series(0)));
    plot.focused()
}

fn against_collisions(points: Vec<[f64; 2]>, haff: Option<Haff>, label: String) -> Option<Plot> {
    if !points.iter().any(|p| p[0] > 0.0) {
        return None;
    }
    let mut plot = Plot {
        title: "Temperature against collisions".to_owned(),
        x_label: "collisions per particle, 2C/N".to_owned(),
        y_label: label,
        y_scale: Scale::of_energy(&points),
        ..Plot::default()
    };
    if let Some(haff) = haff {
        let law = points.iter().map(|p| [p[0], haff.0.after_collisions(p[0])]).collect();
        plot.curves.push(Curve::new("homogeneous cooling", law, Stroke::Dashed, Ink::Text));
        plot.caption = format!("T₀ exp(−γτ) with γ = {} per collision.", number(haff.0.per_collision, 4));
    }
    plot.curves.insert(0, Curve::new("measured", points, Stroke::Line, Ink::Series(0)));
    Some(plot)
}

/// Recordings spread by factors want an axis of factors; the one at time 0 then stays outside.
pub(super) fn scale_of_times(points: &[[f64; 2]]) -> Scale {
    let times: Vec<f64> = points.iter().map(|p| p[0]).filter(|t| *t > 0.0).collect();
    let (Some(first), Some(last)) = (times.first(), times.last()) else {
        return Scale::Linear;
    };
    let middle = times[times.len() / 2];
    if *last > first * 30.0 && middle < 0.3 * last { Scale::Logarithmic } else { Scale::Linear }
}
