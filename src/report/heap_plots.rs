//! A heap: how its surface grows, whether it keeps its shape, and the form it ends with.

use super::evidence::{Evidence, points, spread, values};
use super::fit::{Line, line, two_terms};
use super::plot::{Curve, Ink, Plot, Stroke};
use crate::number::number;
use crate::observe::measure::{Dimension, Profile};

/// Name of the profile of every recording.
pub(super) const PROFILE: &str = "heap-surface";
/// Stages of growth that are drawn.
const STAGES: usize = 8;

/// All plots of the heap.
pub(super) fn plots(evidence: &Evidence<'_>) -> Vec<Plot> {
    let surfaces = evidence.profiles(PROFILE);
    let grown: Vec<&Profile> = surfaces.into_iter().filter(|s| top(s).is_some()).collect();
    let Some(last) = grown.last() else {
        return Vec::new();
    };
    let surface = Surface::of(last);
    let mut plots = vec![growth(evidence, &grown, surface.apex)];
    plots.extend(collapse(evidence, &grown, surface.apex));
    plots.push(final_form(evidence, &surface));
    plots
}

/// The largest height, if anything stands.
fn top(surface: &Profile) -> Option<f64> {
    let heights = values(surface, "height", 1).iter().copied().filter(|h| h.is_finite());
    Some(heights.fold(0.0, f64::max)).filter(|h| *h > 0.0)
}

fn surface_points(surface: &Profile) -> Vec<[f64; 2]> {
    points(values(surface, "position", 0), values(surface, "height", 1))
}

/// h(x) at some times, from the first to the last.
fn growth(evidence: &Evidence<'_>, grown: &[&Profile], apex: f64) -> Plot {
    let shown = spread(grown, STAGES);
    let last = shown[shown.len() - 1];
    Plot {
        title: "Growth of the heap".to_owned(),
        x_label: evidence.setup.length_label("position x"),
        y_label: evidence.setup.length_label("height h"),
        curves: staged(&shown, |surface| around_body(surface_points(surface), apex)),
        ordered: Some(ends(&shown, last)),
        wide: true,
        same_units: true,
        caption: "Both axes have the same scale.".to_owned(),
        ..Plot::default()
    }
}

fn ends(shown: &[&Profile], last: &Profile) -> [String; 2] {
    [format!("t = {}", number(shown[0].time, 3)), format!("t = {}", number(last.time, 3))]
}

/// One curve per stage, coloured in order.
fn staged(shown: &[&Profile], points: impl Fn(&Profile) -> Vec<[f64; 2]>) -> Vec<Curve> {
    let share = |index: usize| if shown.len() > 1 { index as f64 / (shown.len() - 1) as f64 } else { 1.0 };
    let curve =
        |(index, s): (usize, &&Profile)| Curve::new("", points(s), Stroke::Line, Ink::Ordered(share(index)));
    shown.iter().enumerate().map(curve).collect()
}

/// The same with both axes over √t: a heap that keeps its shape falls on one curve.
fn collapse(evidence: &Evidence<'_>, grown: &[&Profile], apex: f64) -> Option<Plot> {
    // After the last grain the heap does not grow, and √t means nothing.
    let end = evidence.setup.source().map_or(f64::INFINITY, |[count, rate]| count / rate * 1.001);
    let pouring: Vec<&Profile> = grown.iter().copied().filter(|s| s.time > 0.0 && s.time <= end).collect();
    if pouring.len() < 3 {
        return None;
    }
    let shown = spread(&pouring, STAGES);
    let rescaled = |surface: &Profile| {
        let root = surface.time.sqrt();
        let near = around_body(surface_points(surface), apex);
        near.into_iter().map(|[x, h]| [(x - apex) / root, h / root]).collect()
    };
    let unit = evidence.setup.unit(Dimension { length: 1, ..Dimension::default() });
    let time = evidence.setup.unit(Dimension { time: 1, ..Dimension::default() });
    Some(Plot {
        title: "The same, over √t".to_owned(),
        x_label: format!("(x − x₀)/√t [{unit}/√({time})]"),
        y_label: format!("h/√t [{unit}/√({time})]"),
        curves: staged(&shown, rescaled),
        ordered: Some(ends(&shown, shown[shown.len() - 1])),
        caption: "While grains are poured: a heap that keeps its shape falls on one curve (Müller 2001, figs. 3.24–3.32).".to_owned(),
        ..Plot::default()
    })
}

/// A surface with the lines and the tail that are fitted to it.
struct Surface {
    points: Vec<[f64; 2]>,
    /// Where the flanks meet, else the highest place.
    apex: f64,
    /// Left and right, bins of 20 … 80 % of the height.
    flanks: [Option<Line>; 2],
    /// h_m, 1/m, l/r̃ of x = (h_m − h)/m + (l/r̃) ln(h_m/h).
    tail: Option<[f64; 3]>,
}

impl Surface {
    fn of(profile: &Profile) -> Self {
        let points = surface_points(profile);
        let highest = points.iter().copied().max_by(|a, b| a[1].total_cmp(&b[1])).unwrap_or([0.0; 2]);
        let flank = |side: f64| {
            let within = |p: &&[f64; 2]| {
                (p[0] - highest[0]) * side > 0.0 && p[1] >= 0.2 * highest[1] && p[1] <= 0.8 * highest[1]
            };
            line(&points.iter().filter(within).copied().collect::<Vec<_>>())
        };
        let flanks = [flank(-1.0), flank(1.0)];
        let (apex, peak) = match flanks {
            [Some(left), Some(right)] if left.slope > right.slope => {
                let x = (right.intercept - left.intercept) / (left.slope - right.slope);
                (x, left.at(x).max(highest[1]))
            }
            _ => (highest[0], highest[1]),
        };
        let rows: Vec<[f64; 3]> = body(&points, highest[0])
            .iter()
            .filter(|p| p[1] < peak)
            .map(|p| [peak - p[1], (peak / p[1]).ln(), (p[0] - apex).abs()])
            .collect();
        let tail = if rows.len() < 6 { None } else { two_terms(&rows).map(|[a, b]| [peak, a, b]) };
        Self { points, apex, flanks, tail: tail.filter(|t| t[1] > 0.0 && t[2] >= 0.0) }
    }

    /// Both sides of the fitted tail, from the lowest height that stands to the top.
    fn tail_curve(&self, [peak, inverse_slope, length]: [f64; 3]) -> Vec<[f64; 2]> {
        let lowest = body(&self.points, self.apex).iter().map(|p| p[1]).fold(peak, f64::min);
        let place = |height: f64| inverse_slope * (peak - height) + length * (peak / height).ln();
        let heights = (0..=200).map(|k| lowest * (peak / lowest).powf(f64::from(k) / 200.0));
        let right: Vec<[f64; 2]> = heights.map(|h| [self.apex + place(h), h]).collect();
        let left = right.iter().map(|p| [2.0 * self.apex - p[0], p[1]]);
        left.chain(right.iter().rev().copied()).collect()
    }
}

/// The part that hangs together around `apex`: single grains that rolled away do not belong to the heap.
fn body(points: &[[f64; 2]], apex: f64) -> &[[f64; 2]] {
    let centre = points.partition_point(|p| p[0] < apex).min(points.len().saturating_sub(1));
    let stands = |point: &[f64; 2]| point[1] > 0.0;
    let first = points[..centre].iter().rposition(|p| !stands(p)).map_or(0, |gap| gap + 1);
    let after = points[centre..].iter().position(|p| !stands(p)).map_or(points.len(), |gap| centre + gap);
    &points[first..after.max(first)]
}

/// The stretch that holds the heap, with a little of the floor on both sides.
fn around_body(points: Vec<[f64; 2]>, apex: f64) -> Vec<[f64; 2]> {
    let body = body(&points, apex);
    let (Some(first), Some(last)) = (body.first(), body.last()) else {
        return points;
    };
    let room = 0.15 * (last[0] - first[0]);
    let ends = [first[0] - room, last[0] + room];
    points.into_iter().filter(|p| p[0] >= ends[0] && p[0] <= ends[1]).collect()
}

/// The last surface, its flanks and its tail.
fn final_form(evidence: &Evidence<'_>, surface: &Surface) -> Plot {
    let mut curves = vec![Curve::new(
        "surface",
        around_body(surface.points.clone(), surface.apex),
        Stroke::Dots,
        Ink::Series(0),
    )];
    let highest = surface.points.iter().map(|p| p[1]).fold(0.0, f64::max);
    let slopes: Vec<f64> = surface.flanks.iter().flatten().map(|l| l.slope.abs()).collect();
    let mean = slopes.iter().sum::<f64>() / slopes.len().max(1) as f64;
    for (index, flank) in surface.flanks.iter().flatten().enumerate() {
        let at = |height: f64| [(height - flank.intercept) / flank.slope, height];
        let name = if index == 0 { format!("flanks, slope {}", number(mean, 3)) } else { String::new() };
        curves.push(Curve::new(
            name,
            vec![at(0.1 * highest), at(0.9 * highest)],
            Stroke::Line,
            Ink::Series(1),
        ));
    }
    let mut caption = "Flanks: straight lines through 20 … 80 % of the height.".to_owned();
    if let Some(tail) = surface.tail {
        curves.push(Curve::new("logarithmic tail", surface.tail_curve(tail), Stroke::Dashed, Ink::Text));
        caption.push_str(&format!(
            " Tail: x = (h_m − h)/m + (l/r̃) ln(h_m/h) (Müller 2001, eq. 3.17) with h_m = {}, m = {}, l/r̃ = {}.",
            number(tail[0], 3),
            number(1.0 / tail[1], 3),
            number(tail[2], 3)
        ));
    }
    Plot {
        title: "Form of the heap at the end".to_owned(),
        x_label: evidence.setup.length_label("position x"),
        y_label: evidence.setup.length_label("height h"),
        curves,
        caption,
        ..Plot::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::measure::Column;

    #[test]
    fn flanks_and_tail_are_found() {
        // A surface that is the law itself: h_m = 30, m = 0.5, l/r̃ = 8.
        let place = |h: f64| (30.0 - h) / 0.5 + 8.0 * (30.0 / h).ln();
        let height_at = |x: f64| {
            let (mut low, mut high) = (1e-9, 30.0);
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                if place(middle) > x { low = middle } else { high = middle }
            }
            0.5 * (low + high)
        };
        let xs: Vec<f64> = (0..100).map(|k| f64::from(k) * 2.0 + 1.0).collect();
        let heights = xs.iter().map(|x| height_at((x - 100.0).abs())).collect();
        let column = |name: &str| Column { name: name.to_owned(), unit: Dimension::default() };
        let profile = Profile {
            name: PROFILE.to_owned(),
            time: 1.0,
            columns: vec![column("position"), column("height")],
            values: vec![xs, heights],
        };
        let surface = Surface::of(&profile);
        assert!((surface.apex - 100.0).abs() < 0.1);
        let [Some(left), Some(right)] = surface.flanks else { panic!("two flanks") };
        assert!((left.slope + right.slope).abs() < 0.01 && left.slope > 0.3 && left.slope < 0.5);
        let [peak, inverse_slope, length] = surface.tail.unwrap();
        assert!((peak - 30.0).abs() < 1.0, "{peak}");
        assert!((1.0 / inverse_slope - 0.5).abs() < 0.03, "{inverse_slope}");
        assert!((length - 8.0).abs() < 1.0, "{length}");
    }
}
