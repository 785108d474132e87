//! What theory and the literature say about the figures of a run, with sources: the one place for such numbers.

use super::energy_plots::Haff;
use super::evidence::Evidence;
use crate::comparison::laws;
use crate::number::{NOT_STEADY, figure_text, number};
use crate::scenario::model::EngineKind;
use crate::statistics::Trend;
use crate::statistics::student::threshold;

/// What a figure should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Expected {
    /// Within a range.
    Between(f64, f64),
    /// Below a bound.
    Below(f64),
    /// Above a bound.
    Above(f64),
    /// A value, to a share of itself.
    Near(f64, f64),
}

/// How a figure stands to its reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Agreement {
    /// Within the reference.
    Holds,
    /// Outside, but within the interval that the standard error leaves.
    Borderline,
    /// Outside.
    Differs,
    /// The figure is not steady: its mean is compared with nothing.
    NotSteady,
}

/// A figure beside its reference.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reference {
    /// Name of the figure.
    pub figure: String,
    /// The value of this run.
    pub measured: f64,
    /// Its standard error.
    pub standard_error: Option<f64>,
    /// Degrees of freedom of that error; `None` where it is taken as known.
    pub degrees_of_freedom: Option<f64>,
    /// What its series does, where that was tested.
    pub trend: Option<Trend>,
    /// What it should be.
    pub expected: Expected,
    /// Where that is from.
    pub source: String,
}

impl Expected {
    /// Its ends.
    fn range(self) -> [f64; 2] {
        match self {
            Self::Between(lower, upper) => [lower, upper],
            Self::Below(upper) => [f64::NEG_INFINITY, upper],
            Self::Above(lower) => [lower, f64::INFINITY],
            Self::Near(value, share) => [value - share * value.abs(), value + share * value.abs()],
        }
    }

    /// As text.
    pub(super) fn text(self) -> String {
        match self {
            Self::Between(lower, upper) => format!("{} … {}", number(lower, 3), number(upper, 3)),
            Self::Below(upper) => format!("< {}", number(upper, 3)),
            Self::Above(lower) => format!("> {}", number(lower, 3)),
            Self::Near(value, share) => format!("{} ± {} %", number(value, 4), number(100.0 * share, 2)),
        }
    }
}

/// Degrees of freedom of an error that is taken as known: so many that Student’s t is normal to six digits.
const KNOWN: f64 = 1e6;
/// Probability that a figure lies farther from its true value than its interval reaches.
const OUTSIDE: f64 = 0.05;

impl Reference {
    /// How far the interval of 95 % reaches by Student's t [standard errors].
    fn reach(&self) -> f64 {
        threshold(OUTSIDE, self.degrees_of_freedom.unwrap_or(KNOWN), 1)
    }

    /// How the figure stands to its reference.
    pub(super) fn agreement(&self) -> Agreement {
        let [lower, upper] = self.expected.range();
        let distance = (lower - self.measured).max(self.measured - upper);
        match self.standard_error {
            _ if self.trend.is_some_and(|trend| !trend.is_steady()) => Agreement::NotSteady,
            _ if distance <= 0.0 => Agreement::Holds,
            Some(error) if distance <= self.reach() * error => Agreement::Borderline,
            _ => Agreement::Differs,
        }
    }

    /// The agreement in words.
    pub(super) fn words(&self) -> String {
        let [lower, upper] = self.expected.range();
        let distance = (lower - self.measured).max(self.measured - upper);
        match (self.agreement(), self.standard_error) {
            (Agreement::Holds, _) => match self.expected {
                Expected::Near(value, _) => {
                    format!("agrees ({} %)", number(100.0 * (self.measured / value - 1.0), 2))
                }
                _ => "agrees".to_owned(),
            },
            (Agreement::NotSteady, _) => {
                format!("no verdict: {NOT_STEADY}")
            }
            (Agreement::Borderline, _) => "agrees within its 95 % interval".to_owned(),
            (Agreement::Differs, Some(error)) if error > 0.0 => {
                format!("differs, {} standard errors outside", number(distance / error, 2))
            }
            (Agreement::Differs, _) => match self.expected {
                Expected::Near(value, _) => {
                    format!("differs by {} %", number(100.0 * (self.measured / value - 1.0), 2))
                }
                _ => format!("differs, {} outside", number(distance, 2)),
            },
        }
    }

    /// The measured value as text.
    pub(super) fn measured_text(&self) -> String {
        figure_text(self.measured, self.standard_error, self.trend)
    }
}

/// Every figure of the run that something is known about.
pub(super) fn references(evidence: &Evidence<'_>) -> Vec<Reference> {
    [
        momentum(evidence),
        cooling_time(evidence),
        equation_of_state(evidence),
        velocity_profile_slope(evidence),
        bagnold_stress(evidence),
        wave_contrast(evidence),
        sedimentation(evidence),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// What the references are.
pub(super) const REMARK: &str = "References are closed forms, published figures and an independent trial implementation of the same \
    algorithm, as each row says; trials and figures hold for the parameters named there. No run is held against earlier results of this program.";

impl Evidence<'_> {
    fn compare(&self, figure: &str, factor: f64, expected: Expected, source: &str) -> Option<Reference> {
        Some(Reference {
            figure: figure.to_owned(),
            measured: self.figure(figure)? * factor,
            standard_error: self.standard_error(figure).map(|error| error * factor),
            degrees_of_freedom: self.degrees_of_freedom(figure),
            trend: self.trend(figure),
            expected,
            source: source.to_owned(),
        })
    }
}

fn momentum(evidence: &Evidence<'_>) -> Option<Reference> {
    let source = "Conservation: every collision keeps momentum to rounding";
    evidence.compare("momentum_drift", 1.0, Expected::Below(1e-10), source)
}

/// t₀ of Haff's law; clustering makes a gas leave the law, so only the first 2 t₀ are used.
fn cooling_time(evidence: &Evidence<'_>) -> Option<Reference> {
    let haff = Haff::of(evidence)?;
    let (column, _) = evidence.column("temperature")?;
    let measured = haff.measured_time(&evidence.series(0, column))?;
    Some(Reference {
        figure: "cooling_time t₀ (fit up to 2 t₀)".to_owned(),
        measured,
        standard_error: None,
        degrees_of_freedom: None,
        trend: None,
        expected: Expected::Near(haff.time(), 0.05),
        source: "Haff 1983; Sonine correction of van Noije and Ernst 1998; Enskog factor of Henderson 1975 (2D), Carnahan and Starling 1969 (3D)".to_owned(),
    })
}

/// The fluid branch, where [`laws::equation_of_state`] knows one.
fn equation_of_state(evidence: &Evidence<'_>) -> Option<Reference> {
    let known = evidence.setup.known.as_ref()?;
    let (value, source) = laws::equation_of_state(&known.scenario)?;
    // The local Enskog factor overstates the flux by up to 5 % at ν = 0.3 and ten grains per cell in 3D.
    let share = match evidence.setup.dimension {
        _ if known.runs_with(EngineKind::Dsmc) => 0.02,
        3 => 0.05,
        _ => 0.03,
    };
    evidence.compare("compressibility_factor", 1.0, Expected::Near(value, share), &source)
}

fn velocity_profile_slope(evidence: &Evidence<'_>) -> Option<Reference> {
    evidence.setup.shear().filter(|shear| shear.is_alone)?;
    let source = "Linear profile between moving walls (Müller 2001, fig. 3.12)";
    evidence.compare("velocity_profile_slope", 1.0, Expected::Near(1.0, 0.05), source)
}

/// F·H²/(m v²): the scale-free stress of a gas that is sheared at v/H.
fn bagnold_stress(evidence: &Evidence<'_>) -> Option<Reference> {
    let setup = evidence.setup;
    let (known, shear) = (setup.known.as_ref()?, setup.shear()?);
    let theory = laws::bagnold(&known.scenario)?;
    let is_known = known.is_plain(0.9)
        && setup.dimension == 2
        && setup.volume_fraction.is_some_and(|nu| (nu - 0.1).abs() < 0.005)
        && known.has_cells_of(2.5);
    if !is_known {
        return None;
    }
    let source = format!(
        "Trial implementation with cells of 2.5 d at r = 0.9, ν = 0.1: 2.1 ± 25 %; Navier–Stokes–Enskog theory gives \
         {}. The value depends on the cell size; F ∝ v² is Bagnold’s law (Müller 2001, fig. 3.13)",
        number(theory, 3)
    );
    let factor = (shear.height / shear.speed).powi(2) / known.mass;
    let mut row = evidence.compare("wall_shear_stress", factor, Expected::Near(2.1, 0.25), &source)?;
    row.figure = "wall_shear_stress · H²/(m v²)".to_owned();
    Some(row)
}

/// Waves for strong dissipation, none near r = 1, in a pipe with rough walls.
fn wave_contrast(evidence: &Evidence<'_>) -> Option<Reference> {
    let setup = evidence.setup;
    let known = setup.known.as_ref()?;
    let restitution = known.restitution.filter(|r| known.is_plain(*r))?;
    // Cells of 2 d show no waves at all: the reference holds for the cells and the filling of the trial.
    let is_known = setup.is_pipe()
        && known.source.is_none()
        && setup.dimension == 2
        && setup.volume_fraction.is_some_and(|nu| (nu - 0.38).abs() < 0.02)
        && known.has_cells_of(4.0);
    if !is_known {
        return None;
    }
    let expected = match restitution {
        r if r <= 0.9 => Expected::Above(2.5),
        r if r >= 0.999 => Expected::Below(1.1),
        _ => return None,
    };
    let source = "Waves for r ≤ 0.9, none at r = 0.999: trial implementation, cells of 4 d, ν = 0.38 (after Müller 2001, figs. 3.16–3.23)";
    evidence.compare("contrast_over_poisson", 1.0, expected, source)
}

/// A hundred grains of 1 mm in a box of 2 × 4 cm.
fn sedimentation(evidence: &Evidence<'_>) -> Option<Reference> {
    let setup = evidence.setup;
    let is_near = |value: f64, known: f64| (value / known - 1.0).abs() < 1e-6;
    let known = setup.known.as_ref()?;
    let is_known = setup.has_floor()
        && known.runs_with(EngineKind::Hsmc)
        && known.restitution.is_some_and(|r| known.is_plain(r))
        && is_near(setup.diameter, 0.001)
        && matches!(setup.size[..], [x, y] if is_near(x, 0.02) && is_near(y, 0.04))
        && setup.count.is_some_and(|count| is_near(count, 100.0));
    if !is_known {
        return None;
    }
    let source = "Trial implementation, five seeds; 0.0022 would be hexagonal rest, 0.0016 the floor that four grains per cell set (set-up of Müller 2001, figs. 2.6, 2.7)";
    evidence.compare("centre_of_mass_height", 1.0, Expected::Between(0.0016, 0.0019), source)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(measured: f64, standard_error: Option<f64>, expected: Expected) -> Reference {
        Reference {
            figure: String::new(),
            measured,
            standard_error,
            degrees_of_freedom: None,
            trend: None,
            expected,
            source: String::new(),
        }
    }

    #[test]
    fn agreement_weighs_the_error() {
        let range = Expected::Between(0.45, 0.68);
        assert_eq!(row(0.5, None, range).agreement(), Agreement::Holds);
        assert_eq!(row(0.69, Some(0.01), range).agreement(), Agreement::Borderline);
        assert_eq!(row(0.69, None, range).agreement(), Agreement::Differs);
        assert_eq!(row(0.8, Some(0.01), range).agreement(), Agreement::Differs);
        assert_eq!(row(f64::NAN, None, range).agreement(), Agreement::Differs);
        assert_eq!(row(-2.1, None, Expected::Near(-2.0, 0.1)).agreement(), Agreement::Holds);
        assert!(row(0.8, Some(0.01), range).words().contains("12 standard errors"));
    }

    #[test]
    fn few_degrees_of_freedom_widen_the_interval_and_a_drift_has_none() {
        // 2.5 errors outside; 95 % by Student's t: 1.96 of a known error, 2.78 of four degrees of freedom.
        let at = |freedom: Option<f64>| Reference {
            degrees_of_freedom: freedom,
            ..row(0.705, Some(0.01), Expected::Between(0.45, 0.68))
        };
        assert_eq!(at(None).agreement(), Agreement::Differs);
        assert_eq!(at(Some(4.0)).agreement(), Agreement::Borderline);
        assert!((at(None).reach() - 1.96).abs() < 1e-3 && (at(Some(4.0)).reach() - 2.776).abs() < 1e-3);
        let rising =
            Reference { trend: Some(Trend::Rising), ..row(0.5, Some(0.01), Expected::Between(0.45, 0.68)) };
        assert_eq!(rising.agreement(), Agreement::NotSteady);
        assert_eq!(rising.measured_text(), "not steady (rising, mean 0.5)");
        assert!(!rising.words().contains("agrees"));
    }
}
