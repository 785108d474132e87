//! What theory and the literature say about the figures of a run, with sources: the one place for such numbers.

use super::energy_plots::Haff;
use super::evidence::Evidence;
use super::number::{number, with_error};
use crate::comparison::laws;
use crate::scenario::model::EngineKind;

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
    /// Outside, by less than two standard errors.
    Borderline,
    /// Outside.
    Differs,
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

impl Reference {
    /// How the figure stands to its reference.
    pub(super) fn agreement(&self) -> Agreement {
        let [lower, upper] = self.expected.range();
        let distance = (lower - self.measured).max(self.measured - upper);
        match self.standard_error {
            _ if distance <= 0.0 => Agreement::Holds,
            Some(error) if distance <= 2.0 * error => Agreement::Borderline,
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
            (Agreement::Borderline, _) => "agrees within two standard errors".to_owned(),
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
        with_error(self.measured, self.standard_error)
    }
}

/// Slopes of heaps of one size as this program makes them.
struct Heaps {
    /// How many were made.
    heaps: u32,
    /// Their mean slope.
    mean: f64,
    /// Standard deviation of a single one.
    scatter: f64,
}

impl Heaps {
    /// Where one more is expected: three standard deviations of its difference from the mean of the others.
    fn range(&self) -> [f64; 2] {
        let error = 3.0 * self.scatter * (1.0 + 1.0 / f64::from(self.heaps)).sqrt();
        [self.mean - error, self.mean + error]
    }
}

/// Grains of a heap of the scenario `heap` at r = 0.9, and its slopes (docs/sweeps.md, `tests/physics_scenarios`).
const HEAPS: [(f64, Heaps); 2] = [
    (1500.0, Heaps { heaps: 7, mean: 0.610, scatter: 0.022 }),
    (3000.0, Heaps { heaps: 4, mean: 0.681, scatter: 0.016 }),
];

/// Every figure of the run that something is known about.
pub(super) fn references(evidence: &Evidence<'_>) -> Vec<Reference> {
    [
        momentum(evidence),
        cooling_time(evidence),
        equation_of_state(evidence),
        velocity_profile_slope(evidence),
        bagnold_stress(evidence),
        wave_contrast(evidence),
        heap_slope(evidence),
        sedimentation(evidence),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// What the references are.
pub(super) const REMARK: &str = "References are closed forms, published figures, trials of the same algorithm and what this program \
    gave before, as each row says; trials and figures hold for the parameters named there.";

impl Evidence<'_> {
    fn compare(&self, figure: &str, factor: f64, expected: Expected, source: &str) -> Option<Reference> {
        Some(Reference {
            figure: figure.to_owned(),
            measured: self.figure(figure)? * factor,
            standard_error: self.standard_error(figure).map(|error| error * factor),
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

/// What this program itself made of the scenario `heap`: a change of it shows, an error that was always there does not.
fn heap_slope(evidence: &Evidence<'_>) -> Option<Reference> {
    let setup = evidence.setup;
    let known = setup.known.as_ref()?;
    let [count, rate] = known.source?;
    let is_known = known.runs_with(EngineKind::Hsmc)
        && known.is_plain(0.9)
        && setup.dimension == 2
        && known.has_cells_of(2.0)
        && (rate - 0.5).abs() < 1e-9;
    let (_, own) = HEAPS.iter().find(|(grains, _)| is_known && (count - grains).abs() < 0.5)?;
    let [lower, upper] = own.range();
    let source = format!(
        "Regression: {} heaps of {count} grains that this program made gave {} on average with a scatter of {}; a single one \
         is expected within three standard deviations, {} … {}. It is no figure of the literature: Müller 2001, fig. 3.27 \
         (N = 30 500), shows slopes without numbers, and exact dynamics of smooth disks makes flatter heaps",
        own.heaps,
        number(own.mean, 3),
        number(own.scatter, 2),
        number(lower, 3),
        number(upper, 3),
    );
    evidence.compare("heap_slope", 1.0, Expected::Between(lower, upper), &source)
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
        Reference { figure: String::new(), measured, standard_error, expected, source: String::new() }
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
}
