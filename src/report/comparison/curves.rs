//! Curves of all engines in one frame, and below it how far each is from the reference.

use super::judgement::stages;
use super::{label, labelled, moment, reference};
use crate::comparison::model::{Compared, Comparison, Difference, TheoryCurve};
use crate::number::in_words;
use crate::report::axis::Scale;
use crate::report::energy_plots::scale_of_times;
use crate::report::evidence::spread;
use crate::report::other_plots::{capital, is_energy_like};
use crate::report::plot::{Curve, Ink, Plot, Stroke};

/// Times of a profile that are shown.
const TIMES: usize = 3;

/// What every pair of plots needs to be read.
const HOW_TO_READ: &str = "<p class=\"note\">Above, each engine with a band of one standard error. Below, its difference \
    from the reference: the dark band is one standard error, the pale one goes as far as chance can bring one of all places. An \
    engine differs where its pale band does not touch the line at zero, or from a thin upright line on: from there to the \
    end it is apart, tested from the last place backwards.</p>\n";

/// All series.
pub(super) fn series(comparison: &Comparison) -> String {
    let pairs: String = comparison.series.iter().map(|compared| pair(comparison, compared)).collect();
    framed(HOW_TO_READ, &pairs)
}

/// All profiles, each at a few of its times.
pub(super) fn profiles(comparison: &Comparison) -> String {
    let groups = stages(comparison);
    let shown = groups.iter().flat_map(|group| spread(group, TIMES));
    let pairs: String = shown.map(|compared| pair(comparison, compared)).collect();
    // Whoever has come past the series has read it.
    framed(if comparison.series.is_empty() { HOW_TO_READ } else { "" }, &pairs)
}

fn framed(note: &str, pairs: &str) -> String {
    if pairs.is_empty() {
        return String::new();
    }
    format!("{note}<div class=\"plots\">\n{pairs}</div>\n")
}

/// The plot of a quantity with that of its differences below.
fn pair(comparison: &Comparison, compared: &Compared) -> String {
    let above = values(comparison, compared);
    let below = differences(comparison, compared, above.x_scale);
    let below = below.map_or_else(String::new, |plot| plot.html());
    format!("<div class=\"pair\">\n{}{below}</div>\n", above.html())
}

/// How a contestant is drawn everywhere: the reference in the colour of the text, the others in colours and dashes.
fn look(comparison: &Comparison, place: usize) -> (Stroke, Ink) {
    if place == comparison.reference {
        return (Stroke::Patterned(0), Ink::Text);
    }
    let order = place - usize::from(place > comparison.reference);
    (Stroke::Patterned(order + 1), Ink::Series(order))
}

/// `values` over the places of `compared`; a place without a value stays as a gap.
fn over_places(compared: &Compared, values: &[f64]) -> Vec<[f64; 2]> {
    compared.places.iter().zip(values).map(|(x, y)| [*x, *y]).collect()
}

fn values(comparison: &Comparison, compared: &Compared) -> Plot {
    let of_contestants = compared.curves.iter().enumerate().filter_map(|(place, of)| {
        let of = of.as_ref()?;
        let (stroke, ink) = look(comparison, place);
        let curve = Curve::new(label(comparison, place), over_places(compared, &of.values), stroke, ink);
        Some(Curve { errors: of.errors.clone(), ..curve })
    });
    let mut curves: Vec<Curve> = of_contestants.collect();
    let [x_scale, y_scale] = scales(compared, &curves);
    let theory = |of: &TheoryCurve| {
        Curve::new(of.name.as_str(), over_places(compared, &of.values), Stroke::Dashed, Ink::Text)
    };
    curves.extend(compared.theory.iter().map(theory));
    Plot {
        title: title(comparison, compared),
        x_label: labelled(comparison, &compared.abscissa),
        y_label: labelled(comparison, &compared.ordinate),
        x_scale,
        y_scale,
        curves,
        caption: caption(compared),
        ..Plot::default()
    }
}

/// Where each theory is from.
fn caption(compared: &Compared) -> String {
    let told: Vec<String> =
        compared.theory.iter().map(|theory| format!("{}: {}.", theory.name, theory.source)).collect();
    told.join(" ")
}

fn title(comparison: &Comparison, compared: &Compared) -> String {
    let mut title = capital(&in_words(&compared.name));
    if compared.ordinate.name != compared.name {
        title += &format!(": {}", in_words(&compared.ordinate.name));
    }
    match compared.time {
        Some(time) => format!("{title}, {}", moment(comparison, time)),
        None => title,
    }
}

/// Decades where physics asks for them: powers of a frequency on both axes, energies that fall far upright.
fn scales(compared: &Compared, curves: &[Curve]) -> [Scale; 2] {
    let is_profile = compared.abscissa.name != "time" && compared.abscissa.name != "collisions_per_particle";
    if is_profile {
        let is_power = ["spectrum", "power"].iter().any(|word| compared.name.contains(word));
        return [if is_power { Scale::Logarithmic } else { Scale::Linear }; 2];
    }
    let Some(longest) = curves.iter().max_by_key(|curve| finite(&curve.points)) else {
        return [Scale::Linear; 2];
    };
    let points: Vec<[f64; 2]> = longest.points.iter().copied().filter(|point| point[1].is_finite()).collect();
    let is_energy = is_energy_like(&compared.name) || is_energy_like(&compared.ordinate.name);
    let y_scale = if is_energy && !points.is_empty() { Scale::of_energy(&points) } else { Scale::Linear };
    let in_time = compared.abscissa.name == "time";
    [if in_time { scale_of_times(&points) } else { Scale::Linear }, y_scale]
}

fn finite(points: &[[f64; 2]]) -> usize {
    points.iter().filter(|point| point[1].is_finite()).count()
}

/// All differences from the reference; nothing where there are none.
fn differences(comparison: &Comparison, compared: &Compared, x_scale: Scale) -> Option<Plot> {
    let known: Vec<(usize, &Difference)> = compared
        .differences
        .iter()
        .enumerate()
        .filter_map(|(place, difference)| Some((place, difference.as_ref()?)))
        .collect();
    let is_relative = known.first()?.1.is_relative;
    let range = range(known.iter().map(|(_, difference)| *difference));
    // At every place: an axis of decades has no room for the first, at time 0.
    let zero = over_places(compared, &vec![0.0; compared.places.len()]);
    let zero = Curve::new("", zero, Stroke::Dashed, Ink::Text);
    let mut curves = vec![zero];
    for (place, difference) in known {
        let (stroke, ink) = look(comparison, place);
        let points = over_places(compared, &difference.values);
        let errors = difference.errors.clone();
        curves.push(Curve { errors, reach: difference.threshold, ..Curve::new("", points, stroke, ink) });
        let parting = difference.parts_at.map(|x| range.map(|y| [x, y]).to_vec());
        curves.extend(parting.map(|points| Curve::new("", points, Stroke::Faint, ink)));
    }
    let from = format!("difference from {}", reference(comparison));
    let y_label =
        if is_relative { format!("relative {from}") } else { with_own_unit(comparison, compared, &from) };
    Some(Plot {
        title: String::new(),
        x_label: labelled(comparison, &compared.abscissa),
        y_label,
        x_scale,
        curves,
        ranges: [None, Some(range)],
        low: true,
        ..Plot::default()
    })
}

fn with_own_unit(comparison: &Comparison, compared: &Compared, name: &str) -> String {
    super::with_unit(comparison, name, compared.ordinate.unit)
}

/// Zero, all values and one standard error about each, with some room.
fn range<'a>(differences: impl Iterator<Item = &'a Difference>) -> [f64; 2] {
    let (mut lower, mut upper) = (0.0_f64, 0.0_f64);
    for difference in differences {
        for (value, error) in difference.values.iter().zip(&difference.errors) {
            let error = if error.is_finite() { *error } else { 0.0 };
            if value.is_finite() {
                (lower, upper) = (lower.min(value - error), upper.max(value + error));
            }
        }
    }
    let room = if upper > lower { 0.08 * (upper - lower) } else { 1.0 };
    [lower - room, upper + room]
}
