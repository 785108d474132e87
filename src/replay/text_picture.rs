//! The density of the grains, drawn with characters of a terminal.
//!
//! With colours a character shows two fields above each other (`▀`), each in the colour of its volume fraction; without
//! them eight dots (braille), each dark where there is a grain. How many colours there are is up to the terminal.

use crate::record::contents::{Frame, Walls, within_rounding};
use crate::report::field_colour;

/// The colours of a terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    /// None.
    Plain,
    /// The eight of ECMA-48, whose shades are the terminal's own.
    Eight,
    /// Those and a cube of six shades of each of red, green and blue (xterm).
    TwoHundred,
    /// 24 bits.
    True,
}

/// Shades of the cube of colours.
const SHADES: [u8; 6] = [0, 95, 135, 175, 215, 255];

impl Colours {
    /// The parameters that make `rgb`, or what comes nearest, the colour of characters, or of the ground behind them.
    fn parameters(self, rgb: [u8; 3], is_ground: bool) -> String {
        let base = if is_ground { 40 } else { 30 };
        match self {
            Colours::Plain => "0".to_owned(),
            Colours::Eight => {
                let bit = |k: usize| u8::from(rgb[k] >= 128) << k;
                (base + bit(0) + bit(1) + bit(2)).to_string()
            }
            Colours::TwoHundred => {
                let nearest = |value: u8| (0..6).min_by_key(|&k| SHADES[k].abs_diff(value)).unwrap_or(0);
                let [r, g, b] = rgb.map(nearest);
                format!("{};5;{}", base + 8, 16 + 36 * r + 6 * g + b)
            }
            Colours::True => {
                let [r, g, b] = rgb;
                format!("{};2;{r};{g};{b}", base + 8)
            }
        }
    }
}

/// A part of the plane that is drawn: seen along z in 2D, along y in 3D.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Canvas {
    /// Characters in a line, at most.
    pub columns: usize,
    /// Lines, at most.
    pub lines: usize,
    /// The colours that may be used.
    pub colours: Colours,
    /// Lower and upper ends of what is shown, across and up [length].
    window: [[f64; 2]; 2],
    /// The axis that points up.
    up: usize,
}

/// Back to the terminal's own colours.
const PLAIN: &str = "\x1b[0m";

impl Canvas {
    /// A view of the box `walls` in at most `columns` characters and `lines`.
    pub fn new(walls: &Walls, columns: usize, lines: usize, colours: Colours) -> Self {
        let up = if walls.sides[2][0].is_empty() { 1 } else { 2 };
        let window = [0, up].map(|axis| [walls.lower[axis], walls.upper[axis]]);
        let [width, height] = window.map(|ends| ends[1] - ends[0]);
        // Half a line is as high as a character is wide.
        let (columns, halves) = (columns.max(1) as f64, 2.0 * lines.max(1) as f64);
        let scale = (columns / width).min(halves / height);
        Canvas {
            columns: (width * scale).round().clamp(1.0, columns) as usize,
            lines: (0.5 * height * scale).ceil().clamp(1.0, 0.5 * halves) as usize,
            colours,
            window,
            up,
        }
    }

    /// `frame` as lines of text, the upper one first. `diameter` [length] makes fractions of counts.
    pub fn draw(&self, frame: &Frame, diameter: f64) -> Vec<String> {
        if self.colours == Colours::Plain { self.dots(frame) } else { self.blocks(frame, diameter) }
    }

    /// Grains in each of `fine` fields, `[row][column]`, the upper row first.
    fn counts(&self, frame: &Frame, fine: [usize; 2]) -> Vec<Vec<u32>> {
        let mut counts = vec![vec![0; fine[0]]; fine[1]];
        for position in &frame.positions {
            let share = |along: usize, axis: usize| {
                let [lower, upper] = self.window[along];
                let place = within_rounding(f64::from(position[axis]), lower, upper);
                (place - lower) / (upper - lower)
            };
            let [across, up] = [share(0, 0), share(1, self.up)];
            if (0.0..=1.0).contains(&across) && (0.0..=1.0).contains(&up) {
                let column = ((across * fine[0] as f64) as usize).min(fine[0] - 1);
                let row = (((1.0 - up) * fine[1] as f64) as usize).min(fine[1] - 1);
                counts[row][column] += 1;
            }
        }
        counts
    }

    /// Two fields in a character, coloured by the share of the plane that their grains cover.
    fn blocks(&self, frame: &Frame, diameter: f64) -> Vec<String> {
        let fine = [self.columns, 2 * self.lines];
        let counts = self.counts(frame, fine);
        let area: f64 =
            self.window.iter().zip(fine).map(|(ends, fields)| (ends[1] - ends[0]) / fields as f64).product();
        let stands_for = frame.grains as f64 / frame.positions.len().max(1) as f64;
        let covers = stands_for * std::f64::consts::FRAC_PI_4 * diameter * diameter / area;
        let mut lines = Vec::with_capacity(self.lines);
        for pair in counts.chunks_exact(2) {
            let mut line = String::new();
            let mut last = None;
            for (&above, &below) in pair[0].iter().zip(&pair[1]) {
                let colours = [above, below].map(|count| field_colour(self.share(f64::from(count) * covers)));
                if last != Some(colours) {
                    let [above, below] = [0, 1].map(|k| self.colours.parameters(colours[k], k == 1));
                    line += &format!("\x1b[{above}m\x1b[{below}m");
                    last = Some(colours);
                }
                line.push('▀');
            }
            lines.push(line + PLAIN);
        }
        lines
    }

    /// The share of a field that is covered: `covers` in a plane; in space, where grains stand behind each other, as much as
    /// those that stand anywhere leave uncovered.
    fn share(&self, covers: f64) -> f64 {
        if self.up == 1 { covers } else { 1.0 - (-covers).exp() }
    }

    /// Eight dots in a character.
    fn dots(&self, frame: &Frame) -> Vec<String> {
        // Bits of the dots of a braille character, by row and column.
        const BITS: [[u32; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
        let counts = self.counts(frame, [2 * self.columns, 4 * self.lines]);
        let character = |rows: &[Vec<u32>], column: usize| {
            let mut bits = 0;
            for (row, bit) in rows.iter().zip(BITS) {
                for side in 0..2 {
                    bits |= if row[2 * column + side] > 0 { bit[side] } else { 0 };
                }
            }
            char::from_u32(0x2800 + bits).expect("braille has all of these characters")
        };
        counts
            .chunks_exact(4)
            .map(|rows| (0..self.columns).map(|column| character(rows, column)).collect())
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walls(width: f64, height: f64) -> Walls {
        let side = || ["wall", "wall"].map(str::to_owned);
        Walls { lower: [0.0; 3], upper: [width, height, 0.0], sides: [side(), side(), Default::default()] }
    }

    fn frame(positions: &[[f32; 3]]) -> Frame {
        Frame { grains: positions.len() as u64, positions: positions.to_vec(), ..Frame::default() }
    }

    #[test]
    fn the_picture_fits_and_keeps_the_shape_of_the_box() {
        let size = |width, height| {
            let canvas = Canvas::new(&walls(width, height), 80, 20, Colours::Plain);
            (canvas.columns, canvas.lines)
        };
        assert_eq!(size(40.0, 20.0), (80, 20));
        assert_eq!(size(400.0, 20.0), (80, 2));
        assert_eq!(size(10.0, 40.0), (10, 20));
    }

    #[test]
    fn dots_stand_where_grains_are() {
        let canvas = Canvas::new(&walls(4.0, 4.0), 2, 1, Colours::Plain);
        assert_eq!((canvas.columns, canvas.lines), (2, 1));
        let low_left = frame(&[[0.1, 0.1, 0.0]]);
        assert_eq!(canvas.draw(&low_left, 1.0), ["\u{2840}\u{2800}"]);
        let high_right = frame(&[[3.9, 3.9, 0.0], [9.0, 1.0, 0.0]]);
        assert_eq!(canvas.draw(&high_right, 1.0), ["\u{2800}\u{2808}"]);
    }

    #[test]
    fn a_grain_on_a_wall_is_drawn_though_its_place_is_rounded_out() {
        let canvas = Canvas::new(&walls(0.6, 0.6), 2, 1, Colours::Plain);
        assert_eq!(canvas.draw(&frame(&[[0.6, 0.6, 0.0]]), 0.05), ["\u{2800}\u{2808}"]);
    }

    #[test]
    fn colours_tell_the_share_that_is_covered() {
        let canvas = Canvas::new(&walls(2.0, 2.0), 2, 1, Colours::True);
        let lines = canvas.draw(&frame(&[[0.5, 1.5, 0.0]]), 1.0);
        let colour = |share: f64| field_colour(share).map(|part| part.to_string()).join(";");
        let full = colour(std::f64::consts::FRAC_PI_4);
        assert!(lines[0].starts_with(&format!("\x1b[38;2;{full}m\x1b[48;2;{}m▀", colour(0.0))), "{lines:?}");
        assert_eq!(lines[0].matches('▀').count(), 2);
        assert!(lines[0].ends_with(PLAIN));
    }

    #[test]
    fn terminals_of_few_colours_get_the_nearest_of_theirs() {
        let [yellow, violet] = [[253, 231, 37], [68, 1, 84]];
        assert_eq!(Colours::Eight.parameters(yellow, false), "33");
        assert_eq!(Colours::Eight.parameters(violet, true), "40");
        // 16 + 36·5 + 6·4 + 0 and 16 + 36·1 + 0 + 1.
        assert_eq!(Colours::TwoHundred.parameters(yellow, true), "48;5;220");
        assert_eq!(Colours::TwoHundred.parameters(violet, false), "38;5;53");
        for colours in [Colours::Eight, Colours::TwoHundred] {
            let canvas = Canvas::new(&walls(2.0, 2.0), 2, 1, colours);
            assert!(!canvas.draw(&frame(&[[0.5, 1.5, 0.0]]), 1.0)[0].contains(";2;"), "{colours:?}");
        }
    }
}
