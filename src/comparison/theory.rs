//! What theory says beside what was compared: which law of `law` belongs to which curve and figure of a scenario.

use super::model::{Compared, ComparedFigure, Comparison, Contestant, TheoryCurve};
use super::stability::remarks;
use super::words::rounded;
use crate::law::homogeneous_cooling::HomogeneousCooling;
use crate::law::kinetic_theory::{
    bagnold_coefficient, chaotic_impact_density, collision_frequency, compressibility_factor,
    maxwell_density, mean_free_path,
};
use crate::law::restitution::{Constant, RestitutionLaw};
use crate::observe::layout;
use crate::scenario::model::{AnyScenario, InitialVelocities, Scenario, Transfer};
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
    /// ν.
    volume_fraction: f64,
    /// r of a homogeneous gas: periodic, without force and source, of smooth grains of one kind and constant
    /// restitution.
    restitution: Option<f64>,
    /// T₀ [energy].
    temperature: Option<f64>,
    /// Whether every engine is plain DSMC: a gas of points.
    of_points: bool,
    /// What to say of engines that follow another law.
    exception: String,
}

impl<'a, V: Vector> Theory<'a, V> {
    fn of(scenario: &'a Scenario<V>, comparison: &Comparison) -> Self {
        let volume_fraction = scenario.volume_fraction();
        let enskog = V::contact_correlation(volume_fraction);
        let is_boltzmann = |contestant: &Contestant| contestant.engine == "dsmc";
        let all = comparison.contestants.iter().all(is_boltzmann);
        let some = comparison.contestants.iter().any(is_boltzmann);
        let exception = match (all, some) {
            (false, true) => {
                let factor = rounded(enskog);
                format!(
                    "; dsmc, of points, has g = 1: {factor} times fewer collisions per time at one temperature"
                )
            }
            (true, true) => "; g = 1, a gas of points".to_owned(),
            _ => String::new(),
        };
        Theory {
            scenario,
            volume_fraction,
            restitution: homogeneous_restitution(scenario),
            temperature: initial_temperature(scenario, comparison).filter(|temperature| *temperature > 0.0),
            of_points: all && some,
            exception,
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
        if let Some(restitution) = self.restitution.filter(|r| *r < 1.0 && self.volume_fraction > 0.0) {
            comparison.remarks.extend(remarks(self.scenario, restitution));
        }
    }

    /// g(ν); 1 of points.
    fn correlation(&self) -> f64 {
        if self.of_points { 1.0 } else { V::contact_correlation(self.volume_fraction) }
    }

    /// The law of a gas that cools.
    fn cooling(&self) -> Option<HomogeneousCooling> {
        let restitution = self.restitution.filter(|r| *r < 1.0)?;
        let (grain, nu) = (self.scenario.grain, self.volume_fraction);
        let temperature = self.temperature.filter(|_| nu > 0.0)?;
        Some(HomogeneousCooling::of::<V>(grain, nu, temperature, restitution, self.correlation()))
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
        if column == "collision_frequency" && self.restitution == Some(1.0) {
            let frequency = self.elastic_frequency()?;
            return curve("Enskog", self.frequency_source(), &|_| frequency);
        }
        let law = self.cooling()?;
        let temperature =
            |place: f64| if is_in_time { law.at_time(place) } else { law.after_collisions(place) };
        // T = 2E/(D N).
        let energies = 0.5 * V::DIMENSION as f64 * f64::from(self.scenario.count);
        let name = if is_in_time { "Haff’s law" } else { "homogeneous cooling" };
        match column {
            "temperature" => curve(name, self.cooling_source(&law, is_in_time), &temperature),
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
                rounded(law.time),
                self.exception
            )
        } else {
            // The rate of collisions cancels.
            format!(
                "T₀ exp(−γτ) with γ = {} per collision (van Noije and Ernst 1998), while the gas is homogeneous; the \
                 same for every engine",
                rounded(law.per_collision)
            )
        }
    }

    fn frequency_source(&self) -> String {
        format!("D 2^(D−1) ν g √(T/m)/(√π d/2) of a Maxwell gas (Miller 2004, 4.33){}", self.exception)
    }

    /// Collisions per grain and time of a gas that does not cool.
    fn elastic_frequency(&self) -> Option<f64> {
        self.restitution.filter(|r| *r >= 1.0)?;
        let (grain, nu) = (self.scenario.grain, self.volume_fraction);
        Some(collision_frequency::<V>(grain, nu, self.temperature?, self.correlation()))
    }

    /// PV/NT of hard grains.
    fn equation_of_state(&self) -> Option<(f64, String)> {
        let restitution = self.restitution.filter(|_| self.volume_fraction < V::FREEZING)?;
        if self.of_points {
            return Some((1.0, "ideal gas: plain dsmc carries no momentum through collisions".to_owned()));
        }
        let mut source = "1 + (1 + r) 2^(D−2) ν g(ν) of a homogeneous fluid (Miller 2004, 4.44)".to_owned();
        if restitution < 1.0 && self.scenario.engine.transfer == Transfer::MomentumChange {
            source += "; cba and hsmc carry 2r in place of 1 + r unless transfer = \"corrected\"";
        }
        if !self.exception.is_empty() {
            source += "; dsmc, of points, has 1";
        }
        Some((compressibility_factor::<V>(self.volume_fraction, restitution), source))
    }

    fn of_profile(&self, compared: &Compared) -> Option<TheoryCurve> {
        let shear = layout::shear(&self.scenario.setting()).filter(|_| self.scenario.gravity == V::ZERO);
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
                self.restitution.filter(|_| self.volume_fraction > 0.0)?;
                let path = mean_free_path::<V>(self.scenario.grain, self.volume_fraction);
                let g = V::contact_correlation(self.volume_fraction) / self.correlation();
                Some((
                    path * g,
                    format!("mean speed over collision frequency of a Maxwell gas{}", self.exception),
                ))
            }
            "impact_c" => Some((0.0, "molecular chaos".to_owned())),
            "velocity_profile_slope" => {
                let linear = "a straight line from wall to wall (Müller 2001, 3.3)";
                layout::shear(&self.scenario.setting())
                    .filter(|_| self.scenario.gravity == V::ZERO)
                    .map(|_| (1.0, linear.to_owned()))
            }
            "wall_shear_stress" => self.bagnold_stress(),
            _ => None,
        }
    }

    /// Bagnold's law between walls that move past each other, without slip.
    fn bagnold_stress(&self) -> Option<(f64, String)> {
        let (scenario, nu) = (self.scenario, self.volume_fraction);
        let shear = layout::shear(&scenario.setting())?;
        let restitution = smooth_constant_restitution(scenario).filter(|r| *r < 1.0)?;
        let is_free = scenario.gravity == V::ZERO && scenario.source.is_none();
        if !is_free || nu <= 0.0 || nu >= V::FREEZING {
            return None;
        }
        let rate = shear.speed / scenario.size[shear.axis];
        let unit = scenario.grain.mass * rate * rate * scenario.grain.diameter.powi(2 - V::DIMENSION as i32);
        let coefficient = bagnold_coefficient::<V>(nu, restitution);
        let source = format!(
            "Bagnold’s law, {} m (v/H)² d^(2−D), of Navier–Stokes–Enskog theory: uniform shear without slip",
            rounded(coefficient)
        );
        Some((coefficient * unit, source))
    }
}

/// r of smooth grains of one kind and constant restitution.
fn smooth_constant_restitution<V: Vector>(scenario: &Scenario<V>) -> Option<f64> {
    let RestitutionLaw::Constant(Constant(restitution)) = scenario.restitution else { return None };
    (scenario.roughness.is_none() && scenario.species.is_empty()).then_some(restitution)
}

fn homogeneous_restitution<V: Vector>(scenario: &Scenario<V>) -> Option<f64> {
    let is_free = scenario.gravity == V::ZERO && scenario.source.is_none();
    let is_endless = scenario.boundary.is_fully_periodic();
    smooth_constant_restitution(scenario).filter(|_| is_free && is_endless)
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
