//! Which laws of theory hold for a scenario, and what they say: the one place for their conditions, which pages of runs and
//! of comparisons share.

use crate::law::homogeneous_cooling::HomogeneousCooling;
use crate::law::kinetic_theory::{
    bagnold_coefficient, collision_frequency, compressibility_factor, displaced_compressibility_factor,
    mean_free_path,
};
use crate::law::restitution::{Constant, RestitutionLaw};
use crate::observe::layout::{self, Shear};
use crate::scenario::model::{AnyScenario, EngineKind, Scenario, Transfer};
use crate::space::Vector;

/// What collisions of an engine are, as far as laws of a fluid depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Contacts {
    /// Plain DSMC: a gas of points, g = 1, whose collisions carry no momentum over a distance.
    OfPoints,
    /// A displacement by d along the change of momentum: it carries d m r vₙ where grains in contact carry
    /// d m (1 + r) vₙ/2, that is 2r in place of 1 + r.
    Displaced,
    /// Grains in contact, or a displacement that carries as much.
    OfGrains,
}

impl Contacts {
    /// Those of the engine called `engine`, with this transfer of momentum.
    pub(crate) fn of(engine: &str, transfer: Transfer) -> Self {
        let is = |kind: EngineKind| engine == kind.name();
        if is(EngineKind::Dsmc) {
            Contacts::OfPoints
        } else if transfer == Transfer::MomentumChange && (is(EngineKind::Cba) || is(EngineKind::Hsmc)) {
            Contacts::Displaced
        } else {
            Contacts::OfGrains
        }
    }
}

/// The laws of one scenario.
pub(crate) struct Laws<'a, V> {
    scenario: &'a Scenario<V>,
    /// Contacts of all engines in question; those of grains where engines differ.
    contacts: Contacts,
    /// Whether every impact parameter of the cross-section is alike; where engines differ, of the one that decides itself.
    is_chaotic: bool,
    /// Whether some engines follow other impact parameters, and others do not.
    are_some_glancing: bool,
    /// ν.
    volume_fraction: f64,
}

impl<'a, V: Vector> Laws<'a, V> {
    /// Those of the scenario with its own engine.
    pub(crate) fn of(scenario: &'a Scenario<V>) -> Self {
        Self::with(scenario, &[scenario.engine.kind.name()])
    }

    /// Those of the scenario with each of `engines`.
    pub(crate) fn with(scenario: &'a Scenario<V>, engines: &[&str]) -> Self {
        let contacts = |engine: &&str| Contacts::of(engine, scenario.engine.transfer);
        let first = engines.first().map_or(Contacts::OfGrains, contacts);
        let is_shared = engines.iter().all(|engine| contacts(engine) == first);
        // The event-driven engine has impact parameters of its own.
        let obeys = |engine: &&str| *engine != EngineKind::EventDriven.name();
        let table = scenario.engine.impact_law.table();
        let is_given = table.is_some_and(|table| table.points().any(|[_, c]| c != 0.0));
        Laws {
            scenario,
            contacts: if is_shared { first } else { Contacts::OfGrains },
            is_chaotic: !(is_given && engines.iter().all(obeys)),
            are_some_glancing: is_given && engines.iter().any(obeys) && !engines.iter().all(obeys),
            volume_fraction: scenario.volume_fraction(),
        }
    }

    /// What collisions are.
    pub(crate) fn contacts(&self) -> Contacts {
        self.contacts
    }

    /// Whether some engines follow impact parameters that the scenario gives, and others do not.
    pub(crate) fn are_some_glancing(&self) -> bool {
        self.are_some_glancing
    }

    /// r of smooth grains of one kind and constant restitution.
    fn smooth_restitution(&self) -> Option<f64> {
        let RestitutionLaw::Constant(Constant(restitution)) = self.scenario.restitution else { return None };
        let is_plain = self.scenario.roughness.is_none() && self.scenario.species.is_empty();
        is_plain.then_some(restitution)
    }

    /// Whether nothing acts on the grains from outside, wherever they are.
    fn is_free(&self) -> bool {
        self.scenario.gravity == V::ZERO
            && self.scenario.source.is_none()
            && self.scenario.boundary.is_fully_periodic()
    }

    /// r of a homogeneous gas: periodic, without force and source, of smooth grains of one kind and constant
    /// restitution.
    pub(crate) fn homogeneous_restitution(&self) -> Option<f64> {
        self.smooth_restitution().filter(|_| self.is_free() && self.volume_fraction > 0.0)
    }

    /// Why a gas that is left to itself has no laws here, as the subject of a sentence; `None` where it has them, and where nobody
    /// would expect them.
    pub(crate) fn obstacle(&self) -> Option<&'static str> {
        let scenario = self.scenario;
        let obstacles = [
            (!scenario.species.is_empty(), "grains of several kinds"),
            (scenario.roughness.is_some(), "rough grains"),
            (
                !matches!(scenario.restitution, RestitutionLaw::Constant(_)),
                "a restitution that is no constant",
            ),
            (!self.is_chaotic, "an engine.impact_parameter other than molecular chaos"),
        ];
        obstacles.into_iter().find(|(stands, _)| self.is_free() && *stands).map(|(_, words)| words)
    }

    /// g(ν); 1 of points.
    fn correlation(&self) -> f64 {
        match self.contacts {
            Contacts::OfPoints => 1.0,
            Contacts::Displaced | Contacts::OfGrains => V::contact_correlation(self.volume_fraction),
        }
    }

    /// The law of a gas that cools from `temperature` on.
    pub(crate) fn cooling(&self, temperature: f64) -> Option<HomogeneousCooling> {
        let restitution = self.homogeneous_restitution().filter(|r| (0.0..1.0).contains(r))?;
        let (grain, nu) = (self.scenario.grain, self.volume_fraction);
        (self.is_chaotic && temperature > 0.0)
            .then(|| HomogeneousCooling::of::<V>(grain, nu, temperature, restitution, self.correlation()))
    }

    /// Collisions per grain and time of a gas that keeps its `temperature`. Who collides how often does not depend on where.
    pub(crate) fn elastic_frequency(&self, temperature: f64) -> Option<f64> {
        self.homogeneous_restitution().filter(|r| *r >= 1.0)?;
        let (grain, nu) = (self.scenario.grain, self.volume_fraction);
        Some(collision_frequency::<V>(grain, nu, temperature, self.correlation()))
    }

    /// Mean speed over collision frequency of a Maxwell gas.
    pub(crate) fn mean_free_path(&self) -> Option<f64> {
        self.homogeneous_restitution()?;
        let path = mean_free_path::<V>(self.scenario.grain, self.volume_fraction);
        Some(path * V::contact_correlation(self.volume_fraction) / self.correlation())
    }

    /// PV/NT of a homogeneous fluid below freezing, and where that is from.
    pub(crate) fn equation_of_state(&self) -> Option<(f64, String)> {
        let restitution = self.homogeneous_restitution()?;
        let nu = self.volume_fraction;
        if self.contacts == Contacts::OfPoints {
            return Some((1.0, "ideal gas: plain dsmc carries no momentum through collisions".to_owned()));
        }
        if nu >= V::FREEZING || !self.is_chaotic {
            return None;
        }
        // At r = 1 both are one.
        if self.contacts == Contacts::Displaced && restitution < 1.0 {
            let source = "1 + 2r 2^(D−2) ν g(ν) of a homogeneous fluid: Enskog theory (Miller 2004, eq. 4.44) has 1 + r in \
                          place of 2r, but a displacement along the change of momentum carries 2r; transfer = \"corrected\" \
                          carries 1 + r";
            return Some((displaced_compressibility_factor::<V>(nu, restitution), source.to_owned()));
        }
        let source = "1 + (1 + r) 2^(D−2) ν g(ν) of a homogeneous fluid (Miller 2004, eq. 4.44)";
        Some((compressibility_factor::<V>(nu, restitution), source.to_owned()))
    }

    /// Walls that move past each other, with nothing else that drives the grains: the flow between them is a straight line.
    pub(crate) fn shear(&self) -> Option<Shear<V>> {
        let is_alone = self.scenario.gravity == V::ZERO && self.scenario.source.is_none();
        layout::shear(&self.scenario.setting()).filter(|_| is_alone)
    }

    /// Bagnold's coefficient: stress in units of m γ̇² d^{2−D} of uniform shear without slip.
    pub(crate) fn bagnold_coefficient(&self) -> Option<f64> {
        self.shear()?;
        let restitution = self.smooth_restitution().filter(|r| *r < 1.0 && self.is_chaotic)?;
        let nu = self.volume_fraction;
        (nu > 0.0 && nu < V::FREEZING).then(|| bagnold_coefficient::<V>(nu, restitution))
    }
}

/// [`Laws::cooling`] of a scenario with its own engine.
pub(crate) fn cooling(scenario: &AnyScenario, temperature: f64) -> Option<HomogeneousCooling> {
    match scenario {
        AnyScenario::Two(scenario) => Laws::of(scenario).cooling(temperature),
        AnyScenario::Three(scenario) => Laws::of(scenario).cooling(temperature),
    }
}

/// [`Laws::equation_of_state`] of a scenario with its own engine.
pub(crate) fn equation_of_state(scenario: &AnyScenario) -> Option<(f64, String)> {
    match scenario {
        AnyScenario::Two(scenario) => Laws::of(scenario).equation_of_state(),
        AnyScenario::Three(scenario) => Laws::of(scenario).equation_of_state(),
    }
}

/// [`Laws::bagnold_coefficient`] of a scenario with its own engine.
pub(crate) fn bagnold(scenario: &AnyScenario) -> Option<f64> {
    match scenario {
        AnyScenario::Two(scenario) => Laws::of(scenario).bagnold_coefficient(),
        AnyScenario::Three(scenario) => Laws::of(scenario).bagnold_coefficient(),
    }
}

/// [`Laws::obstacle`] of a scenario with its own engine.
pub(crate) fn obstacle(scenario: &AnyScenario) -> Option<&'static str> {
    match scenario {
        AnyScenario::Two(scenario) => Laws::of(scenario).obstacle(),
        AnyScenario::Three(scenario) => Laws::of(scenario).obstacle(),
    }
}
