//! A figure: curves or a coloured field between two axes, as SVG, with its legend and caption.

use std::fmt::Write;

use super::axis::{Axis, Scale, Tick};
use super::colour::ColourMap;
pub(super) use super::curve::{Curve, Ink, Stroke};
use super::escape::escape;
use crate::number::number;

/// A coloured field that fills the frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Field {
    /// The picture as a `data:` address; its corners are the corners of the axes.
    pub picture: String,
    /// Ranges of x and y.
    pub extent: [[f64; 2]; 2],
    /// Range of the colours.
    pub colours: [f64; 2],
    /// What the colours mean.
    pub label: String,
}

/// A figure.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plot {
    /// What it shows, in a few words.
    pub title: String,
    /// What a reader should know to judge it; may be empty. Plain text.
    pub caption: String,
    /// Name and unit of the abscissa.
    pub x_label: String,
    /// Name and unit of the ordinate.
    pub y_label: String,
    /// Scale of the abscissa.
    pub x_scale: Scale,
    /// Scale of the ordinate.
    pub y_scale: Scale,
    /// Curves, the first at the bottom.
    pub curves: Vec<Curve>,
    /// A field behind them.
    pub field: Option<Field>,
    /// Names of the two ends of the ordered colours, where they are used.
    pub ordered: Option<[String; 2]>,
    /// Whether it asks for the whole width of the page.
    pub wide: bool,
    /// Whether it is lower than usual, because it stands below another of the same abscissa.
    pub low: bool,
    /// Whether one unit of x is as long as one unit of y.
    pub same_units: bool,
    /// Ends of the linear axes where the points do not set them.
    pub ranges: [Option<[f64; 2]>; 2],
}

impl Default for Plot {
    fn default() -> Self {
        Self {
            title: String::new(),
            caption: String::new(),
            x_label: String::new(),
            y_label: String::new(),
            x_scale: Scale::Linear,
            y_scale: Scale::Linear,
            curves: Vec::new(),
            field: None,
            ordered: None,
            wide: false,
            low: false,
            same_units: false,
            ranges: [None; 2],
        }
    }
}

/// Room around the frame: left, right, top, bottom [pixel].
const MARGIN: [f64; 4] = [58.0, 16.0, 30.0, 46.0];
/// The share of the abscissa that counts as the start.
const START: f64 = 0.15;
/// The frame of a plot: its axes and where they lie [pixel].
pub(super) struct Frame {
    pub x: Axis,
    pub y: Axis,
    pub width: f64,
    pub height: f64,
}

impl Frame {
    /// Where a point lies; nowhere for what is not finite.
    pub(super) fn place(&self, point: [f64; 2]) -> Option<[f64; 2]> {
        let [x, y] = [self.x.share(point[0]), self.y.share(point[1])];
        let place = [MARGIN[0] + x * self.width, MARGIN[2] + (1.0 - y) * self.height];
        place.iter().all(|p| p.is_finite() && p.abs() < 1e6).then_some(place)
    }
}

impl Plot {
    /// The figure as HTML.
    pub(super) fn html(&self) -> String {
        let frame = self.frame();
        let (width, height) = (frame.width + MARGIN[0] + MARGIN[1], frame.height + MARGIN[2] + MARGIN[3]);
        let class = if self.wide { "plot wide" } else { "plot" };
        let mut html = format!("<figure class=\"{class}\">\n");
        if !self.title.is_empty() {
            let _ = writeln!(html, "<h3>{}</h3>", escape(&self.title));
        }
        let _ = writeln!(
            html,
            "<svg viewBox=\"0 0 {width:.0} {height:.0}\" role=\"img\" aria-label=\"{}\">",
            escape(
                format!("{}: {} against {}", self.title, self.y_label, self.x_label).trim_start_matches(": ")
            )
        );
        let clip =
            format!("clip-{:x}", checksum(&format!("{}{}{:?}", self.title, self.y_label, [width, height])));
        let _ = writeln!(
            html,
            "<clipPath id=\"{clip}\"><rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\"/></clipPath>",
            MARGIN[0], MARGIN[2], frame.width, frame.height
        );
        self.write_field(&mut html, &frame);
        self.write_axes(&mut html, &frame);
        let _ = writeln!(html, "<g clip-path=\"url(#{clip})\">");
        for curve in &self.curves {
            curve.draw(&mut html, &frame);
        }
        html.push_str("</g>\n</svg>\n");
        self.write_legend(&mut html);
        if !self.caption.is_empty() {
            let _ = writeln!(html, "<figcaption>{}</figcaption>", escape(&self.caption));
        }
        html.push_str("</figure>\n");
        html
    }

    /// The same with its ordinate made for what comes after a start that would squeeze it, and a note on what is cut.
    pub(super) fn focused(mut self) -> Self {
        if self.y_scale == Scale::Logarithmic || self.x_scale == Scale::Logarithmic {
            return self;
        }
        let Some(points) = self.curves.iter().find(|c| c.stroke == Stroke::Line).map(|c| &c.points) else {
            return self;
        };
        let (Some(first), Some(last)) = (points.first(), points.last()) else {
            return self;
        };
        let start = first[0] + START * (last[0] - first[0]);
        let range = |points: &[[f64; 2]]| {
            points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, m], p| [l.min(p[1]), m.max(p[1])])
        };
        let [lower, upper] = range(&points[points.partition_point(|p| p[0] < start)..]);
        let [least, most] = range(points);
        let later = upper - lower;
        let is_above = most - upper > 2.0 * later && most > 2.0 * upper.abs();
        if !(is_above && later > 0.0 && least >= lower - later) {
            return self;
        }
        let lower = if least >= 0.0 { 0.0 } else { least };
        self.ranges[1] = Some([lower, upper + 0.5 * (upper - lower)]);
        let cut = format!("The start, up to {}, lies above the frame.", number(most, 3));
        self.caption = [self.caption.as_str(), &cut].join(" ").trim().to_owned();
        self
    }

    fn frame(&self) -> Frame {
        // Theory may run far away from what was measured; it does not set the axes.
        let measured = |curve: &&Curve| curve.stroke != Stroke::Dashed || self.curves.len() == 1;
        let values = |axis: usize| {
            let curves = self.curves.iter().filter(measured).flat_map(move |c| c.points.iter());
            let edges = self.field.iter().flat_map(move |f| f.extent[axis]);
            // Bands belong to what is shown; on a logarithmic axis they may be decades deep.
            let has_bands = axis == 1 && self.y_scale == Scale::Linear;
            let bands = self.curves.iter().filter(move |_| has_bands).flat_map(Curve::band_ends);
            curves.map(move |p| p[axis]).chain(edges).chain(bands)
        };
        let exact = self.field.is_some();
        let given =
            |axis: usize| self.ranges[axis].map(|[lower, upper]| Axis { lower, upper, logarithmic: false });
        // Dots at the very end would be cut.
        let has_dots = self.curves.iter().any(|curve| matches!(curve.stroke, Stroke::Dots | Stroke::Rings));
        let x = given(0).unwrap_or_else(|| Axis::over(values(0), self.x_scale, !has_dots));
        let y = given(1).unwrap_or_else(|| Axis::over(values(1), self.y_scale, exact));
        let outer = if self.wide { 1000.0 } else { 490.0 };
        let width = outer - MARGIN[0] - MARGIN[1];
        let natural = match (self.low, self.wide) {
            (true, _) => 120.0,
            (false, true) => 300.0,
            (false, false) => 264.0,
        };
        let height = if self.same_units {
            (width * (y.upper - y.lower) / (x.upper - x.lower)).clamp(90.0, 420.0)
        } else {
            natural
        };
        Frame { x, y, width, height }
    }

    fn write_field(&self, html: &mut String, frame: &Frame) {
        if let Some(field) = &self.field {
            let _ = writeln!(
                html,
                "<image x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" preserveAspectRatio=\"none\" \
                 style=\"image-rendering:pixelated\" href=\"{}\"/>",
                MARGIN[0], MARGIN[2], frame.width, frame.height, field.picture
            );
        }
    }

    fn write_axes(&self, html: &mut String, frame: &Frame) {
        let [left, _, top, _] = MARGIN;
        let (right, bottom) = (left + frame.width, top + frame.height);
        let (mut grid, mut labels) = (String::new(), String::new());
        let wide = (frame.width / 90.0) as usize;
        for Tick { value, label } in frame.x.ticks(wide) {
            let x = left + frame.x.share(value) * frame.width;
            let length = if label.is_empty() { 3.0 } else { 5.0 };
            let _ = write!(grid, "M{x:.1} {bottom:.1}v{length}");
            if !label.is_empty() {
                let y = bottom + 19.0;
                let _ = writeln!(labels, "<text x=\"{x:.1}\" y=\"{y:.1}\" class=\"mid\">{label}</text>");
            }
        }
        let mut lines = String::new();
        for Tick { value, label } in
            frame.y.ticks((frame.height / if self.low { 32.0 } else { 50.0 }) as usize)
        {
            let y = top + (1.0 - frame.y.share(value)) * frame.height;
            let length = if label.is_empty() { 3.0 } else { 5.0 };
            let _ = write!(grid, "M{left:.1} {y:.1}h-{length}");
            if !label.is_empty() {
                let _ = write!(lines, "M{left:.1} {y:.1}H{right:.1}");
                let (x, y) = (left - 9.0, y + 4.0);
                let _ = writeln!(labels, "<text x=\"{x:.1}\" y=\"{y:.1}\" class=\"end\">{label}</text>");
            }
        }
        if self.field.is_none() {
            let _ = writeln!(html, "<path class=\"grid\" d=\"{lines}\"/>");
        }
        let _ = writeln!(html, "<path class=\"axis\" d=\"M{left} {top}V{bottom:.1}H{right:.1}{grid}\"/>");
        html.push_str(&labels);
        let y = bottom + 39.0;
        let _ = writeln!(
            html,
            "<text x=\"{right:.1}\" y=\"{y:.1}\" class=\"end name\">{}</text>\n\
             <text x=\"8\" y=\"14\" class=\"name\">{}</text>",
            escape(&self.x_label),
            escape(&self.y_label)
        );
    }

    fn write_legend(&self, html: &mut String) {
        // One curve needs no name.
        let named = self.curves.iter().filter(|c| !c.name.is_empty() && self.curves.len() > 1);
        let entries: Vec<String> =
            named.map(|curve| format!("<li>{}{}</li>", curve.sample(), escape(&curve.name))).collect();
        if !entries.is_empty() {
            let _ = writeln!(html, "<ul class=\"legend\">{}</ul>", entries.join(""));
        }
        if let Some([first, last]) = &self.ordered {
            html.push_str(&colour_bar(ColourMap::Field, first, last, ""));
        }
        if let Some(field) = &self.field {
            let [least, most] = field.colours.map(|v| number(v, 3));
            html.push_str(&colour_bar(ColourMap::Field, &least, &most, &field.label));
        }
    }
}

/// A bar that explains a colour map: the text at its two ends and what it means.
pub(super) fn colour_bar(map: ColourMap, first: &str, last: &str, label: &str) -> String {
    format!(
        "<div class=\"colours\"><span>{}</span><i style=\"background:{}\"></i><span>{}</span><em>{}</em></div>\n",
        escape(first),
        map.gradient(),
        escape(last),
        escape(label)
    )
}

/// A number that tells texts apart (FNV-1a), for identifiers inside the page.
fn checksum(text: &str) -> u32 {
    text.bytes().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(points: Vec<[f64; 2]>) -> Plot {
        Plot {
            title: "<b>".to_owned(),
            y_label: "a & b".to_owned(),
            curves: ["x < y", "z"]
                .map(|name| Curve::new(name, points.clone(), Stroke::Line, Ink::Series(0)))
                .to_vec(),
            ..Plot::default()
        }
    }

    #[test]
    fn text_is_escaped_and_numbers_are_finite() {
        let html = plot(vec![[0.0, 1.0], [1.0, f64::NAN], [2.0, f64::INFINITY], [3.0, 4.0]]).html();
        assert!(html.contains("&lt;b&gt;") && html.contains("a &amp; b") && html.contains("x &lt; y"));
        assert!(!html.contains("NaN") && !html.contains("inf"));
    }

    #[test]
    fn a_gap_breaks_the_line() {
        let html = plot(vec![[0.0, 1.0], [1.0, f64::NAN], [2.0, 2.0]]).html();
        let path = html.split("class=\"curve\"").nth(1).unwrap();
        assert_eq!(path.split("\"/>").next().unwrap().matches('M').count(), 2);
    }

    #[test]
    fn a_start_does_not_squeeze_the_rest() {
        let settling = |start: f64| {
            let value = |t: f64| if t < 3.0 { start } else { 1.0 + 0.1 * t.sin() };
            plot((0..100).map(f64::from).map(|t| [t, value(t)]).collect()).focused()
        };
        assert!(settling(50.0).caption.contains("up to 50") && settling(50.0).ranges[1].is_some());
        assert_eq!(settling(1.2).ranges[1], None);
        assert_eq!(settling(0.0).ranges[1], None);
    }

    #[test]
    fn no_data_is_no_panic() {
        assert!(plot(Vec::new()).html().contains("<svg"));
    }
}
