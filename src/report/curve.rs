//! Curves of a plot: how they are drawn, with their errors, and their sample in a legend.

use std::fmt::Write;

use super::colour::ColourMap;
use super::plot::Frame;

/// A curve of more points is thinned to its outline.
const MOST_POINTS: usize = 1200;

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stroke {
    /// A line through the points.
    Line,
    /// A thin line that stays behind the others.
    Faint,
    /// A broken line: theory, a fit.
    Dashed,
    /// A dot at every point.
    Dots,
    /// A ring at every point: what is measured but not to be relied on.
    Rings,
    /// One of several lines that can be told apart without colours: by a pattern of dashes of its own. Its errors are
    /// a band.
    Patterned(usize),
}

/// The colour of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ink {
    /// One of the page's own colours for categories, made for both of its themes.
    Series(usize),
    /// The colour of the text: theory and fits.
    Text,
    /// A place on the colour map of ordered things such as times, 0 … 1.
    Ordered(f64),
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    /// Name for the legend; empty for none.
    pub name: String,
    /// x and y.
    pub points: Vec<[f64; 2]>,
    /// Standard errors of y; empty, or one per point.
    pub errors: Vec<f64>,
    /// Standard errors to either side that a second, paler band covers; 0 for none.
    pub reach: f64,
    /// How it is drawn.
    pub stroke: Stroke,
    /// Its colour.
    pub ink: Ink,
}

impl Curve {
    /// A curve without error bars.
    pub(super) fn new(name: impl Into<String>, points: Vec<[f64; 2]>, stroke: Stroke, ink: Ink) -> Self {
        Self { name: name.into(), points, errors: Vec::new(), reach: 0.0, stroke, ink }
    }

    /// Ends of its band or bars of one standard error, where it has some.
    pub(super) fn band_ends(&self) -> impl Iterator<Item = f64> + Clone + '_ {
        let is_banded = matches!(self.stroke, Stroke::Patterned(_) | Stroke::Dots);
        let known = self.points.iter().zip(&self.errors).filter(move |_| is_banded);
        known.flat_map(|(point, error)| [point[1] - error, point[1] + error])
    }

    /// Writes it into the SVG of `frame`.
    pub(super) fn draw(&self, html: &mut String, frame: &Frame) {
        let colour = colour(self.ink);
        if matches!(self.stroke, Stroke::Patterned(_)) {
            if self.reach > 0.0 {
                write_band(html, self, self.reach, frame, &colour);
            }
            write_band(html, self, 1.0, frame, &colour);
        } else {
            write_errors(html, self, frame, &colour);
        }
        let points = outline(&self.points);
        if let Stroke::Dots | Stroke::Rings = self.stroke {
            let style = match self.stroke {
                Stroke::Dots => format!("fill:{colour}"),
                _ => format!("fill:none;stroke:{colour};stroke-width:1.2"),
            };
            let _ = writeln!(html, "<g style=\"{style}\">");
            for [x, y] in points.iter().filter_map(|p| frame.place(*p)) {
                let _ = write!(html, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.6\"/>");
            }
            html.push_str("</g>\n");
            return;
        }
        let mut path = String::new();
        let mut is_down = false;
        for point in points {
            // A gap in the data is a gap in the line.
            let Some([x, y]) = frame.place(point) else {
                is_down = false;
                continue;
            };
            let _ = write!(path, "{}{x:.1} {y:.1}", if is_down { 'L' } else { 'M' });
            is_down = true;
        }
        let class = match self.stroke {
            Stroke::Dashed => "curve dashed",
            Stroke::Faint => "curve faint",
            Stroke::Patterned(_) => "curve patterned",
            Stroke::Line | Stroke::Dots | Stroke::Rings => "curve",
        };
        let dashes = dashes(self.stroke);
        let _ = writeln!(html, "<path class=\"{class}\" style=\"stroke:{colour}{dashes}\" d=\"{path}\"/>");
    }

    /// A short piece of it, for legends.
    pub(super) fn sample(&self) -> String {
        let colour = colour(self.ink);
        let kind = match self.stroke {
            Stroke::Line | Stroke::Faint => "line",
            Stroke::Dashed => "dashed",
            Stroke::Dots => "dots",
            Stroke::Rings => "rings",
            Stroke::Patterned(_) => {
                let dashes = dashes(self.stroke);
                return format!(
                    "<svg class=\"sample\" viewBox=\"0 0 34 8\" aria-hidden=\"true\"><path class=\"curve patterned\" \
                     style=\"stroke:{colour}{dashes}\" d=\"M1 4H33\"/></svg>"
                );
            }
        };
        format!("<i class=\"{kind}\" style=\"color:{colour}\"></i>")
    }
}

/// Dashes and gaps of patterned lines [pixel]; the first is whole.
const PATTERNS: [&str; 6] = ["", "9 3", "2 2.5", "9 3 2 3", "14 4", "5 2.5 1.5 2.5 1.5 2.5"];

/// The end of a style that makes a pattern.
fn dashes(stroke: Stroke) -> String {
    match stroke {
        Stroke::Patterned(number) if !number.is_multiple_of(PATTERNS.len()) => {
            format!(";stroke-dasharray:{}", PATTERNS[number % PATTERNS.len()])
        }
        _ => String::new(),
    }
}

fn colour(ink: Ink) -> String {
    match ink {
        Ink::Series(index) => format!("var(--series-{})", index % 6),
        Ink::Text => "var(--theory)".to_owned(),
        // The yellow end would be lost on paper.
        Ink::Ordered(share) => {
            let colour = ColourMap::Field.hexadecimal(0.92 * share);
            // Lifted where the page is dark.
            format!("color-mix(in srgb, {colour} var(--keep), white)")
        }
    }
}

/// Error bars of one standard error to either side.
fn write_errors(html: &mut String, curve: &Curve, frame: &Frame, colour: &str) {
    let mut path = String::new();
    for (point, error) in curve.points.iter().zip(&curve.errors) {
        let ends = [-1.0, 1.0].map(|side| frame.place([point[0], point[1] + side * error]));
        if let [Some([x, low]), Some([_, high])] = ends {
            let _ = write!(path, "M{x:.1} {low:.1}V{high:.1}");
        }
    }
    if !path.is_empty() {
        let _ = writeln!(html, "<path class=\"error\" style=\"stroke:{colour}\" d=\"{path}\"/>");
    }
}

/// A band of `reach` standard errors to either side; ends beyond a logarithmic axis lie on its edge.
fn write_band(html: &mut String, curve: &Curve, reach: f64, frame: &Frame, colour: &str) {
    let held = |value: f64| if frame.y.logarithmic { value.max(frame.y.lower * 0.1) } else { value };
    let ends = |point: &[f64; 2], error: f64| -> Option<[[f64; 2]; 2]> {
        let at = |side: f64| frame.place([point[0], held(point[1] + side * reach * error)]);
        Some([at(1.0)?, at(-1.0)?])
    };
    let mut path = String::new();
    let mut piece: Vec<[[f64; 2]; 2]> = Vec::new();
    let mut close = |piece: &mut Vec<[[f64; 2]; 2]>| {
        if piece.len() > 1 {
            let there = piece.iter().map(|[upper, _]| upper);
            let back = piece.iter().rev().map(|[_, lower]| lower);
            for (k, [x, y]) in there.chain(back).enumerate() {
                let _ = write!(path, "{}{x:.1} {y:.1}", if k > 0 { 'L' } else { 'M' });
            }
            path.push('Z');
        }
        piece.clear();
    };
    for (point, &error) in curve.points.iter().zip(&curve.errors) {
        // Where nothing is known of the error, there is a gap.
        match ends(point, error) {
            Some(ends) => piece.push(ends),
            None => close(&mut piece),
        }
    }
    close(&mut piece);
    if !path.is_empty() {
        let class = if reach > 1.0 { "band reach" } else { "band" };
        let _ = writeln!(html, "<path class=\"{class}\" style=\"fill:{colour}\" d=\"{path}\"/>");
    }
}

/// The points, or the least and the most of each stretch where there are too many to see.
fn outline(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    if points.len() <= MOST_POINTS {
        return points.to_vec();
    }
    let stretch = points.len().div_ceil(MOST_POINTS / 2);
    let mut thinned = Vec::with_capacity(MOST_POINTS + 2);
    for part in points.chunks(stretch) {
        let by_height = |a: &usize, b: &usize| part[*a][1].total_cmp(&part[*b][1]);
        let least = (0..part.len()).min_by(by_height).unwrap_or(0);
        let most = (0..part.len()).max_by(by_height).unwrap_or(0);
        thinned.push(part[least.min(most)]);
        if least != most {
            thinned.push(part[least.max(most)]);
        }
    }
    thinned
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::axis::Axis;

    fn frame(logarithmic: bool) -> Frame {
        let lower = if logarithmic { 0.1 } else { 0.0 };
        let axis = Axis { lower, upper: 10.0, logarithmic };
        Frame { x: Axis { logarithmic: false, ..axis }, y: axis, width: 100.0, height: 100.0 }
    }

    fn banded(errors: Vec<f64>) -> Curve {
        let points = (0..errors.len()).map(|k| [k as f64, 1.0]).collect();
        Curve { errors, reach: 3.0, ..Curve::new("a", points, Stroke::Patterned(1), Ink::Text) }
    }

    fn drawn(curve: &Curve, logarithmic: bool) -> String {
        let mut html = String::new();
        curve.draw(&mut html, &frame(logarithmic));
        html
    }

    #[test]
    fn a_band_has_a_gap_where_errors_are_not_known() {
        let html = drawn(&banded(vec![0.5, 0.5, f64::NAN, 0.5, 0.5, 0.5]), false);
        assert_eq!(html.matches('Z').count(), 4, "two pieces, near and far: {html}");
        assert!(html.contains("stroke-dasharray:9 3") && !html.contains("NaN"));
        assert_eq!(drawn(&banded(vec![f64::NAN; 4]), false).matches("band").count(), 0);
    }

    #[test]
    fn a_band_below_a_logarithmic_axis_ends_at_its_edge() {
        let html = drawn(&banded(vec![5.0, 5.0]), true);
        assert!(html.matches('Z').count() == 2 && !html.contains("NaN"), "{html}");
    }

    #[test]
    fn outlines_keep_the_extremes() {
        let mut points: Vec<[f64; 2]> = (0..100_000).map(|k| [f64::from(k), 0.0]).collect();
        points[54_321][1] = 7.0;
        let thinned = outline(&points);
        assert!(thinned.len() <= MOST_POINTS + 2 && thinned.contains(&points[54_321]));
    }
}
