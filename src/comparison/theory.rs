//! What theory says beside what was compared: which law of `law` belongs to which curve and figure of a scenario.

use super::laws::{Contacts, Laws};
use super::model::{Compared, ComparedFigure, Comparison, TheoryCurve};
use super::stability::remarks;
use crate::law::homogeneous_cooling::HomogeneousCooling;
use crate::law::kinetic_theory::{chaotic_impact_density, maxwell_density};
use crate::number::plain;
use crate::scenario::model::{AnyScenario, InitialVelocities, Scenario};
use crate::scenario::{Overrides, parse};
use crate::space::Vector;

/// Adds to every curve and figure what theory says of it, and remarks on what to expect of a gas that cools.
///
/// The scenario is read from the text that the comparison carries; one that cannot be read has no theory, which is said.
pub fn add(comparison: &mut Comparison) {
    match parse(&comparison.scenario, &comparison.scenario_text, &Overrides::default()) {
        Ok(AnyScenario::Two(scenario)) => Theory::of(&scenario, comparison).add(comparison),
        Ok(AnyScenario::Three(scenario)) => Theory::of(&scenario, comparison).add(comparison),
        Err(_) if comparison.scenario_text.is_empty() => {}
        Err(error) => {
            comparison.remarks.push(format!("Theory is not shown: the scenario cannot be read ({error})."))
        }
    }
}

/// What is known of a scenario.
struct Theory<'a, V> {
    scenario: &'a Scenario<V>,
    /// What holds for it.
    laws: Laws<'a, V>,
    /// T₀ [energy].
    temperature: Option<f64>,
    /// What to say of rates where plain DSMC follows another law.
    exception: String,
    /// What to say of pressures where engines follow another law than the one that is shown.
    other_pressures: String,
}

impl<'a, V: Vector> Theory<'a, V> {
    fn of(scenario: &'a Scenario<V>, comparison: &Comparison) -> Self {
        let engines: Vec<&str> = comparison.contestants.iter().map(|one| one.engine.as_str()).collect();
        let laws = Laws::with(scenario, &engines);
        let has = |contacts: Contacts| {
            engines.iter().any(|engine| Contacts::of(engine, scenario.engine.transfer) == contacts)
        };
        let (of_points, displaced) = (has(Contacts::OfPoints), has(Contacts::Displaced));
        let mut exception = match laws.contacts() {
            Contacts::OfPoints => "; g = 1, a gas of points".to_owned(),
            _ if of_points => {
                let factor = plain(V::contact_correlation(scenario.volume_fraction()), 3);
                format!(
                    "; dsmc, of points, has g = 1: {factor} times fewer collisions per time at one temperature"
                )
            }
            _ => String::new(),
        };
        let unlike = if laws.are_some_glancing() {
            "; engines that follow engine.impact_parameter differ"
        } else {
            ""
        };
        exception += unlike;
        let mut other_pressures = unlike.to_owned();
        if laws.contacts() == Contacts::OfGrains {
            let is_inelastic = laws.homogeneous_restitution().is_some_and(|r| r < 1.0);
            if displaced && is_inelastic {
                other_pressures +=
                    "; cba and hsmc carry 2r in place of 1 + r unless transfer = \"corrected\"";
            }
            if of_points {
                other_pressures += "; dsmc, of points, has 1";
            }
        }
        Theory {
            scenario,
            laws,
            temperature: initial_temperature(scenario, comparison).filter(|temperature| *temperature > 0.0),
            exception,
            other_pressures,
        }
    }

    fn add(&self, comparison: &mut Comparison) {
        for compared in &mut comparison.series {
            compared.theory = self.of_series(compared).into_iter().collect();
        }
        for compared in &mut comparison.profiles {
            compared.theory = self.of_profile(compared).into_iter().collect();
        }
        for figure in &mut comparison.figures {
            figure.theory = self.of_figure(figure);
        }
        if let Some(restitution) = self.laws.homogeneous_restitution().filter(|r| *r < 1.0) {
            comparison.remarks.extend(remarks(self.scenario, restitution));
        }
        if let Some(obstacle) = self.laws.obstacle() {
            comparison
                .remarks
                .push(format!("Theory of a homogeneous gas is not shown: it does not know {obstacle}."));
        }
    }

    /// The law of a gas that cools.
    fn cooling(&self) -> Option<HomogeneousCooling> {
        self.laws.cooling(self.temperature?)
    }

    fn of_series(&self, compared: &Compared) -> Option<TheoryCurve> {
        let curve = |name: &str, source: String, value: &dyn Fn(f64) -> f64| {
            let values = compared.places.iter().map(|place| value(*place)).collect();
            Some(TheoryCurve { name: name.to_owned(), source, values })
        };
        let column = compared.ordinate.name.as_str();
        if column == "compressibility_factor" {
            let (value, source) = self.equation_of_state()?;
            return curve("Enskog", source, &|_| value);
        }
        let is_in_time = match compared.abscissa.name.as_str() {
            "time" => true,
            "collisions_per_particle" => false,
            _ => return None,
        };
        if let Some(frequency) = self.elastic_frequency().filter(|_| column == "collision_frequency") {
            return curve("Enskog", self.frequency_source(), &|_| frequency);
        }
        let law = self.cooling()?;
        let temperature =
            |place: f64| if is_in_time { law.at_time(place) } else { law.after_collisions(place) };
        // T = 2E/(D N).
        let energies = 0.5 * V::DIMENSION as f64 * f64::from(self.scenario.count);
        let name = if is_in_time { "Haff’s law" } else { "homogeneous cooling" };
        match column {
            "temperature" | "granular_temperature" => {
                curve(name, self.cooling_source(&law, is_in_time), &temperature)
            }
            "kinetic_energy" => {
                curve(name, self.cooling_source(&law, is_in_time), &|place| energies * temperature(place))
            }
            "collisions_per_particle" if is_in_time => {
                let source = format!("where T falls as {}", self.cooling_source(&law, true));
                curve("(2/γ) ln(1 + t/t₀)", source, &|time| law.collisions_until(time))
            }
            "collision_frequency" if is_in_time => {
                let source = format!("where T falls as {}", self.cooling_source(&law, true));
                curve("Enskog, cooling by Haff’s law", source, &|time| law.collision_frequency(time))
            }
            _ => None,
        }
    }

    fn cooling_source(&self, law: &HomogeneousCooling, is_in_time: bool) -> String {
        if is_in_time {
            format!(
                "T₀ (1 + t/t₀)⁻² with t₀ = {} (Haff 1983; Enskog frequency; Sonine correction of van Noije and Ernst \
                 1998), while the gas is homogeneous{}",
                plain(law.time, 3),
                self.exception
            )
        } else {
            // The rate of collisions cancels.
            format!(
                "T₀ exp(−γτ) with γ = {} per collision (van Noije and Ernst 1998), while the gas is homogeneous; the \
                 same for every engine",
                plain(law.per_collision, 3)
            )
        }
    }

    fn frequency_source(&self) -> String {
        format!("D 2^(D−1) ν g √(T/m)/(√π d/2) of a Maxwell gas (Miller 2004, 4.33){}", self.exception)
    }

    /// Collisions per grain and time of a gas that does not cool.
    fn elastic_frequency(&self) -> Option<f64> {
        self.laws.elastic_frequency(self.temperature?)
    }

    /// PV/NT of hard grains.
    fn equation_of_state(&self) -> Option<(f64, String)> {
        let (value, source) = self.laws.equation_of_state()?;
        Some((value, format!("{source}{}", self.other_pressures)))
    }

    fn of_profile(&self, compared: &Compared) -> Option<TheoryCurve> {
        let shear = self.laws.shear();
        let height = |axis: usize| self.scenario.size[axis];
        let (name, source, value): (&str, &str, Box<dyn Fn(f64) -> f64>) =
            match (compared.name.as_str(), compared.ordinate.name.as_str()) {
                ("velocity-profile", "velocity") => {
                    let shear = shear?;
                    let slope = shear.speed / height(shear.axis);
                    let line = move |place: f64| shear.lower + slope * place;
                    ("no slip", "a straight line from wall to wall (Müller 2001, 3.3)", Box::new(line))
                }
                ("velocity-distribution" | "velocity-distribution-mean", "probability_density") => {
                    ("Maxwell", "one component, in thermal velocities", Box::new(maxwell_density))
                }
                ("impact-parameter", "probability_density") => (
                    "molecular chaos",
                    "every place of the cross-section alike (Müller 2001, 3.6.1)",
                    Box::new(chaotic_impact_density::<V>),
                ),
                _ => return None,
            };
        let values = compared.places.iter().map(|place| value(*place)).collect();
        Some(TheoryCurve { name: name.to_owned(), source: source.to_owned(), values })
    }

    fn of_figure(&self, figure: &ComparedFigure) -> Option<(f64, String)> {
        let frequency =
            |value: &dyn Fn(f64) -> f64| Some((value(self.elastic_frequency()?), self.frequency_source()));
        match figure.name.as_str() {
            "compressibility_factor" => self.equation_of_state(),
            "collision_frequency" => frequency(&|frequency| frequency),
            "mean_free_time" => frequency(&|frequency| 1.0 / frequency),
            "mean_free_path" => {
                let source =
                    format!("mean speed over collision frequency of a Maxwell gas{}", self.exception);
                Some((self.laws.mean_free_path()?, source))
            }
            "impact_c" => Some((0.0, "molecular chaos".to_owned())),
            "velocity_profile_slope" => {
                let linear = "a straight line from wall to wall (Müller 2001, 3.3)";
                self.laws.shear().map(|_| (1.0, linear.to_owned()))
            }
            "wall_shear_stress" => self.bagnold_stress(),
            _ => None,
        }
    }

    /// Bagnold's law between walls that move past each other, without slip.
    fn bagnold_stress(&self) -> Option<(f64, String)> {
        let (scenario, shear) = (self.scenario, self.laws.shear()?);
        let coefficient = self.laws.bagnold_coefficient()?;
        let rate = shear.speed / scenario.size[shear.axis];
        let unit = scenario.grain.mass * rate * rate * scenario.grain.diameter.powi(2 - V::DIMENSION as i32);
        let source = format!(
            "Bagnold’s law, {} m (v/H)² d^(2−D), of Navier–Stokes–Enskog theory: uniform shear without slip",
            plain(coefficient, 3)
        );
        Some((coefficient * unit, source))
    }
}

/// As the reference has it at the start, else as the scenario asks for.
fn initial_temperature<V: Vector>(scenario: &Scenario<V>, comparison: &Comparison) -> Option<f64> {
    let measured = comparison.series.iter().find_map(|compared| {
        let is_it = compared.ordinate.name == "temperature" && compared.places.first() == Some(&0.0);
        let curves = compared.curves.get(comparison.reference).into_iter().chain(&compared.curves);
        let mut firsts = curves.flatten().filter_map(|curve| curve.values.first().copied());
        firsts.find(|value| is_it && value.is_finite())
    });
    let asked = match scenario.initial.velocities {
        InitialVelocities::Maxwell(temperature) => Some(temperature),
        InitialVelocities::Uniform(width) => Some(scenario.grain.mass * width * width / 3.0),
        InitialVelocities::Rest => None,
    };
    measured.or(asked)
}
