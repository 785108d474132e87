//! Density waves: the density in space and time, its last profile, and the spectrum of its changes.

use super::axis::Scale;
use super::colour::ColourMap;
use super::evidence::{Evidence, points, spread, values};
use super::plot::{Curve, Field, Ink, Plot, Stroke};
use super::raster::Raster;
use crate::number::{figure_text, number};
use crate::observe::measure::Profile;

/// Name of the profile of every recording.
pub(super) const DENSITY: &str = "density-profile";
/// Name of the profile of the whole run.
pub(super) const SPECTRUM: &str = "spectrum";
/// Columns of the space–time picture at most.
const MOST_TIMES: usize = 800;

/// All plots of density and its waves.
pub(super) fn plots(evidence: &Evidence<'_>) -> Vec<Plot> {
    let densities = evidence.profiles(DENSITY);
    let mut plots = Vec::new();
    // Elsewhere the density is a profile that does not travel.
    if evidence.setup.is_pipe() {
        plots.extend(space_time(evidence, &densities));
    }
    plots.extend(last_profiles(evidence, &densities));
    plots.extend(spectrum(evidence));
    plots
}

/// Volume fraction coloured over time and position.
fn space_time(evidence: &Evidence<'_>, densities: &[&Profile]) -> Option<Plot> {
    let [first, .., last] = densities else {
        return None;
    };
    let positions = values(last, "position", 0);
    let columns = densities.len().min(MOST_TIMES);
    let duration = last.time - first.time;
    if duration <= 0.0 || !duration.is_finite() || positions.len() < 2 {
        return None;
    }
    // Recordings need not be even in time: each column shows the nearest one.
    let nearest = |k: usize| {
        let time = first.time + duration * (k as f64 + 0.5) / columns as f64;
        let after = densities.partition_point(|p| p.time < time).clamp(1, densities.len() - 1);
        let before = after - 1;
        if time - densities[before].time < densities[after].time - time { before } else { after }
    };
    let table: Vec<Vec<f64>> =
        (0..columns).map(|k| values(densities[nearest(k)], "volume_fraction", 1).to_vec()).collect();
    let most = upper_end(&table);
    let half = 0.5 * (positions[1] - positions[0]);
    let height = [positions[0] - half, positions[positions.len() - 1] + half];
    let field = Field {
        picture: Raster::from_table(&table, ColourMap::Field, [0.0, most]).address(),
        extent: [[first.time, last.time], height],
        colours: [0.0, most],
        label: "volume fraction".to_owned(),
    };
    Some(Plot {
        title: "Density in space and time".to_owned(),
        x_label: evidence.setup.time_label(),
        y_label: evidence.setup.label(&last.columns[0]),
        field: Some(field),
        caption: "Waves are bright bands; their slope is their velocity.".to_owned(),
        wide: true,
        ..Plot::default()
    })
}

/// The value that 99.5 % do not exceed: a single dense slice does not set the colours.
fn upper_end(table: &[Vec<f64>]) -> f64 {
    let mut all: Vec<f64> = table.iter().flatten().copied().filter(|v| v.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    let most = all.get(all.len().saturating_sub(1) * 995 / 1000).copied().unwrap_or(1.0);
    if most > 0.0 { most } else { 1.0 }
}

/// The last profile, with some before it behind; of a sheared gas the mean of many.
fn last_profiles(evidence: &Evidence<'_>, densities: &[&Profile]) -> Option<Plot> {
    let setup = evidence.setup;
    let last = densities.last()?;
    let name = if setup.has_floor() { "height above the floor" } else { "position" };
    let mut plot = Plot {
        title: "Density profile".to_owned(),
        x_label: setup.with_unit(name, last.columns[0].unit),
        y_label: "volume fraction".to_owned(),
        ..Plot::default()
    };
    if setup.shear().is_some() && densities.len() >= 4 {
        let late = &densities[densities.len() / 2..];
        plot.curves = vec![
            Curve::new("last recording", density_points(last), Stroke::Faint, Ink::Series(5)),
            Curve::new("mean of the second half", mean_profile(late), Stroke::Line, Ink::Series(0)),
        ];
        return Some(plot);
    }
    let shown = spread(densities, 3);
    let curve = |(index, profile): (usize, &&Profile)| {
        let share = if shown.len() > 1 { index as f64 / (shown.len() - 1) as f64 } else { 0.0 };
        // The last stands out.
        let stroke = if index + 1 == shown.len() { Stroke::Line } else { Stroke::Faint };
        Curve::new("", density_points(profile), stroke, Ink::Ordered(share))
    };
    let time = |profile: &Profile| format!("t = {}", number(profile.time, 3));
    plot.curves = shown.iter().enumerate().map(curve).collect();
    plot.ordered = (shown.len() > 1).then(|| [time(shown[0]), time(last)]);
    if setup.has_floor() {
        plot.ranges[0] = filled(&plot.curves);
        plot.caption = "Means over whole layers of the box.".to_owned();
    }
    Some(plot)
}

fn density_points(profile: &Profile) -> Vec<[f64; 2]> {
    points(values(profile, "position", 0), values(profile, "volume_fraction", 1))
}

/// The mean at every place, over all profiles.
fn mean_profile(profiles: &[&Profile]) -> Vec<[f64; 2]> {
    let mut mean = profiles.first().map(|first| density_points(first)).unwrap_or_default();
    for (place, point) in mean.iter_mut().enumerate() {
        let at = profiles.iter().filter_map(|p| values(p, "volume_fraction", 1).get(place));
        point[1] = at.sum::<f64>() / profiles.len() as f64;
    }
    mean
}

/// The stretch in which there is matter, with some room above.
fn filled(curves: &[Curve]) -> Option<[f64; 2]> {
    let places = || curves.iter().flat_map(|curve| &curve.points);
    let first = places().map(|p| p[0]).fold(f64::INFINITY, f64::min);
    let last = places().filter(|p| p[1] > 0.0).map(|p| p[0]).fold(f64::NEG_INFINITY, f64::max);
    let end = places().map(|p| p[0]).fold(f64::NEG_INFINITY, f64::max);
    (first < last).then(|| [first, (last + 0.15 * (last - first)).min(end)])
}

/// Power against frequency, with the fitted power law.
fn spectrum(evidence: &Evidence<'_>) -> Option<Plot> {
    let profiles = evidence.profiles(SPECTRUM);
    let profile = profiles.last()?;
    let power = points(values(profile, "frequency", 0), values(profile, "power", 1));
    let power: Vec<[f64; 2]> = power.into_iter().filter(|p| p[0] > 0.0 && p[1] > 0.0).collect();
    let mut plot = Plot {
        title: "Spectrum of the density".to_owned(),
        x_label: evidence.setup.label(&profile.columns[0]),
        y_label: evidence.setup.label(&profile.columns[1]),
        x_scale: Scale::Logarithmic,
        y_scale: Scale::Logarithmic,
        ..Plot::default()
    };
    if let Some(slope) = evidence.figure("spectrum_slope") {
        let name = format!(
            "slope {}",
            figure_text(slope, evidence.standard_error("spectrum_slope"), evidence.trend("spectrum_slope"))
        );
        plot.curves.push(Curve::new(name, power_law(evidence, &power, slope), Stroke::Dashed, Ink::Text));
        plot.caption =
            "Dashed: the straight line fitted for f = 0.3 … 5 √(g/d). The slope depends on the band."
                .to_owned();
    }
    let stroke = if power.len() > 60 { Stroke::Line } else { Stroke::Dots };
    plot.curves.insert(0, Curve::new("measured", power, stroke, Ink::Series(0)));
    Some(plot)
}

/// The line of `slope` through the centre of the fitted band.
fn power_law(evidence: &Evidence<'_>, power: &[[f64; 2]], slope: f64) -> Vec<[f64; 2]> {
    let setup = evidence.setup;
    let gravity = setup.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
    let unit = if gravity > 0.0 { (gravity / setup.diameter).sqrt() } else { 1.0 };
    let band = [0.3 * unit, 5.0 * unit];
    // Every point counts by its stretch of log f, as the logarithmic bins of the fit do.
    let (mut weight, mut level) = (0.0, 0.0);
    for pair in power.windows(2).filter(|p| p[0][0] >= band[0] && p[1][0] <= band[1]) {
        let stretch = (pair[1][0] / pair[0][0]).ln();
        weight += stretch;
        level += stretch * (pair[0][1].ln() - slope * pair[0][0].ln());
    }
    if weight == 0.0 {
        return Vec::new();
    }
    band.map(|frequency| [frequency, (level / weight + slope * frequency.ln()).exp()]).to_vec()
}
