//! What a sweep came to: the input of its page, of its JSON and of the last words on the terminal.

use crate::number::figure_text;
use crate::statistics::Trend;

/// All that a page of a sweep shows.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepReport {
    /// The scenario's title.
    pub title: String,
    /// The scenario's name.
    pub scenario: String,
    /// What varies, in a sentence.
    pub variation: String,
    /// What figures are plotted against.
    pub abscissa: Abscissa,
    /// Figures, each with a curve for every line of the grid.
    pub figures: Vec<SweepFigure>,
    /// Every run.
    pub cases: Vec<SweepCase>,
    /// Whether somebody stopped the sweep before its end.
    pub interrupted: bool,
    /// The scenario of the first run as TOML text.
    pub scenario_text: String,
    /// The version that wrote it.
    pub version: String,
}

/// What figures are plotted against.
#[derive(Clone, Debug, PartialEq)]
pub struct Abscissa {
    /// Name of the key.
    pub name: String,
    /// Texts of the values.
    pub values: Vec<String>,
    /// The same as numbers; 1, 2, 3 … where they are none.
    pub places: Vec<f64>,
    /// Whether the values are numbers.
    pub is_numeric: bool,
}

/// A figure of the summaries.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepFigure {
    /// Its name in the summary.
    pub name: String,
    /// Its unit, as `kg/(m·s^2)`; empty for a pure number.
    pub unit: String,
    /// One for every combination of the other varied keys and engines.
    pub curves: Vec<FigureCurve>,
}

/// A figure against the abscissa, everything else being equal.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureCurve {
    /// What is equal; empty where there is nothing else.
    pub name: String,
    /// Points that have a value, in the order of the abscissa.
    pub points: Vec<MeanPoint>,
    /// The power law through those that are steady, where both are positive and the abscissa spans a decade.
    pub power_law: Option<PowerLaw>,
}

/// A mean over replicas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanPoint {
    /// Place on the abscissa.
    pub x: f64,
    /// The mean.
    pub value: f64,
    /// Its standard error: from the scatter of replicas, of one run alone what that states.
    pub standard_error: Option<f64>,
    /// Whether its series is steady in the runs; `None` where none of them tested it.
    pub trend: Option<Trend>,
    /// Runs that it is made of.
    pub runs: usize,
}

/// y = prefactor · x^exponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// The exponent.
    pub exponent: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// y at x = 1.
    pub prefactor: f64,
    /// Largest distance of a point from the law, relative to the law.
    pub largest_deviation: f64,
    /// Points it goes through.
    pub points: usize,
}

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepCase {
    /// The name of its folder.
    pub name: String,
    /// `done`, `kept`, `failed`, `interrupted` or `not run`.
    pub status: &'static str,
    /// Why it failed; empty where it did not.
    pub error: String,
    /// Whether its folder has a page.
    pub has_page: bool,
}

impl MeanPoint {
    /// Whether no run says that it is not steady.
    pub fn is_steady(&self) -> bool {
        self.trend.is_none_or(Trend::is_steady)
    }

    /// Its value and error as text, or that it is not steady.
    pub fn text(&self) -> String {
        figure_text(self.value, self.standard_error, self.trend)
    }
}

impl SweepFigure {
    /// `title` with the unit in brackets.
    pub fn labelled(&self, title: &str) -> String {
        if self.unit.is_empty() { title.to_owned() } else { format!("{title} [{}]", self.unit) }
    }
}

impl FigureCurve {
    /// How many of its points are not steady: fits leave them out.
    pub fn not_steady(&self) -> usize {
        self.points.iter().filter(|point| !point.is_steady()).count()
    }
}

impl Abscissa {
    /// Whether all values are positive and span at least a decade.
    pub fn is_logarithmic(&self) -> bool {
        self.is_numeric && spans_a_decade(self.places.iter().copied())
    }
}

/// Whether numbers are positive and the largest is at least ten times the least.
pub(super) fn spans_a_decade(numbers: impl Iterator<Item = f64>) -> bool {
    let (least, most) =
        numbers.fold((f64::INFINITY, 0.0_f64), |(least, most), x| (least.min(x), most.max(x)));
    // Ends such as 0.07 and 0.7 are no decade in binary.
    least > 0.0 && most.is_finite() && most >= least * (10.0 - 1e-9)
}
