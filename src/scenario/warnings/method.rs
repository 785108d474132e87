//! Methods that do not know what the scenario asks of them.

use crate::law::boundary::Face;
use crate::scenario::bound::rounded;
use crate::scenario::cost;
use crate::scenario::model::{EngineKind, Scenario};
use crate::space::Vector;

/// What the engine lacks.
pub(super) fn engine<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let mut warnings = Vec::new();
    let kind = scenario.engine.kind;
    if kind == EngineKind::Dsmc && scenario.volume_fraction() > 0.1 {
        warnings.push(format!(
            "dsmc treats grains as points: at ν = {} it collides {} times too rarely; cba, hsmc and event-driven do not",
            rounded(scenario.volume_fraction()),
            rounded(V::contact_correlation(scenario.volume_fraction()))
        ));
    }
    if matches!(kind, EngineKind::Dsmc | EngineKind::Cba) && cost::settles(scenario) {
        warnings.push(format!(
            "{} has no excluded volume: under gravity grains pile up beyond any possible density; hsmc and \
             event-driven have one",
            kind.name()
        ));
    }
    warnings
}

/// Where gravity takes the grains.
pub(super) fn gravity<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let mut warnings = Vec::new();
    for axis in (0..V::DIMENSION).filter(|&axis| scenario.gravity[axis] != 0.0) {
        let Some(faces) = scenario.boundary.faces(axis) else { continue };
        let (side, name) = if scenario.gravity[axis] < 0.0 { (0, "lower") } else { (1, "upper") };
        if faces[side] == Face::Open {
            let axis = V::AXIS_NAMES[axis];
            warnings.push(format!("gravity pulls grains out of the open face boundary.{axis}.{name}"));
        }
    }
    warnings
}

/// Fields that the engine does not have.
pub(super) fn fields<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let lacking =
        scenario.record.fields.iter().filter(|&&named| scenario.fields().all(|field| field != named));
    let names: Vec<&str> = lacking.map(|field| field.name()).collect();
    let warning = || {
        format!(
            "record.fields names {}, but {} draws no candidate pairs: nothing is recorded of that",
            names.join(" and "),
            scenario.engine.kind.name()
        )
    };
    (!names.is_empty()).then(warning).into_iter().collect()
}

/// Measures that the scenario does not have.
pub(super) fn measures<V: Vector>(scenario: &Scenario<V>) -> Option<String> {
    let wanted = scenario.record.measures.as_deref()?;
    let taken = crate::observe::measures(&scenario.setting(), Some(wanted));
    let lacking = wanted.iter().filter(|name| taken.iter().all(|measure| measure.name() != name.as_str()));
    let names: Vec<&str> = lacking.map(String::as_str).collect();
    (!names.is_empty()).then(|| {
        format!(
            "record.measures names {}, for which the scenario lacks the walls, the gravity or the periodic axis that it needs: \
             nothing is measured of that",
            names.join(" and ")
        )
    })
}
