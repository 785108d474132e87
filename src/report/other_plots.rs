//! Everything else that was recorded, so that nothing stays invisible.

use super::axis::Scale;
use super::energy_plots;
use super::evidence::{Evidence, points, spread};
use super::plot::{Curve, Ink, Plot, Stroke};
use super::{figures, heap_plots, shear_plots, wave_plots};
use crate::number::{in_words, number, with_error};
use crate::observe::measure::Profile;

/// Profiles that have plots of their own.
const OWN: [&str; 4] = [shear_plots::PROFILE, wave_plots::DENSITY, wave_plots::SPECTRUM, heap_plots::PROFILE];

/// A plot for every column and every profile that no other plot shows.
pub(super) fn plots(evidence: &Evidence<'_>) -> Vec<Plot> {
    let mut plots: Vec<Plot> =
        (1..evidence.log.columns.len()).filter_map(|column| series(evidence, column)).collect();
    let names = evidence.profile_names().into_iter().filter(|name| !OWN.contains(name));
    for name in names {
        plots.extend(profile(evidence, name));
    }
    plots
}

/// A column of the series against time, with its steady mean where the summary has one.
fn series(evidence: &Evidence<'_>, column: usize) -> Option<Plot> {
    let described = &evidence.log.columns[column];
    let points = evidence.series(0, column);
    if energy_plots::SHOWN.contains(&described.name.as_str()) || points.len() < 2 {
        return None;
    }
    // A number of grains that never changes is said in the header.
    if points.iter().all(|p| p[1] == points[0][1]) && described.name == "grains" {
        return None;
    }
    let ends = [points[0][0], points[points.len() - 1][0]];
    let mut curves = vec![Curve::new("", points, Stroke::Line, Ink::Series(0))];
    let error = evidence.standard_error(&described.name);
    let is_steady = figures::is_steady(evidence, &described.name);
    if let Some(mean) = evidence.figure(&described.name).filter(|_| error.is_some() && is_steady) {
        curves[0].name = "at recordings".to_owned();
        let steady = [0.5 * (ends[0] + ends[1]), ends[1]].map(|t| [t, mean]).to_vec();
        let name = if evidence.trend(&described.name).is_some() { "steady mean" } else { "mean" };
        let name = format!("{name} {}", with_error(mean, error));
        curves.push(Curve::new(name, steady, Stroke::Dashed, Ink::Text));
    }
    let is_floor = figures::is_stress_on_untouched_floor(evidence.setup, &described.name);
    let caption = match evidence.unsteady(&described.name) {
        _ if is_floor => {
            "Not the weight of the packing: in HSMC a grain that full cells keep back does not touch the floor."
                .to_owned()
        }
        Some(trend) => format!("Not steady: {} over the stretch of the run that means are made of.", trend.name()),
        None => String::new(),
    };
    let scale =
        if is_energy_like(&described.name) { Scale::of_energy(&curves[0].points) } else { Scale::Linear };
    let plot = Plot {
        title: capital(&in_words(&described.name)),
        x_label: evidence.setup.time_label(),
        y_label: evidence.setup.label(described),
        x_scale: energy_plots::scale_of_times(&curves[0].points),
        y_scale: scale,
        curves,
        caption,
        ..Plot::default()
    };
    Some(plot.focused())
}

/// Whether decades are what a reader asks of a quantity.
pub(super) fn is_energy_like(name: &str) -> bool {
    ["energy", "temperature", "spectrum", "power", "pressure"].iter().any(|word| name.contains(word))
}

/// A profile: every column against the first; at several times when it was taken at several.
fn profile(evidence: &Evidence<'_>, name: &str) -> Vec<Plot> {
    let profiles = evidence.profiles(name);
    let Some(last) = profiles.last() else {
        return Vec::new();
    };
    let shown = spread(&profiles, 6);
    let is_value = |column: &usize| last.columns[*column].name != "standard_error";
    let scale = if is_energy_like(name) { Scale::Logarithmic } else { Scale::Linear };
    let plot = |column: usize| {
        let described = &last.columns[column];
        let is_single = last.columns.len() == 2;
        let title = if is_single {
            in_words(name)
        } else {
            format!("{}: {}", in_words(name), in_words(&described.name))
        };
        Plot {
            title: capital(&title),
            x_label: evidence.setup.label(&last.columns[0]),
            y_label: evidence.setup.label(described),
            x_scale: scale,
            y_scale: scale,
            curves: stages(&shown, column),
            ordered: (shown.len() > 1).then(|| {
                [format!("t = {}", number(shown[0].time, 3)), format!("t = {}", number(last.time, 3))]
            }),
            ..Plot::default()
        }
    };
    (1..last.columns.len()).filter(is_value).map(plot).collect()
}

fn stages(shown: &[&Profile], column: usize) -> Vec<Curve> {
    let curve = |(index, profile): (usize, &&Profile)| {
        let Some(values) = profile.values.get(column) else {
            return Curve::new("", Vec::new(), Stroke::Line, Ink::Text);
        };
        let ink = match shown.len() {
            1 => Ink::Series(0),
            count => Ink::Ordered(index as f64 / (count - 1) as f64),
        };
        let mut curve = Curve::new("", points(&profile.values[0], values), Stroke::Line, ink);
        let follows = profile.columns.get(column + 1).is_some_and(|next| next.name == "standard_error");
        if follows && shown.len() == 1 {
            curve.errors = profile.values.get(column + 1).cloned().unwrap_or_default();
        }
        curve
    };
    shown.iter().enumerate().map(curve).collect()
}

/// With a capital first letter.
pub(super) fn capital(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| first.to_uppercase().chain(characters).collect())
}
