//! Which figures the summaries of a sweep will hold, known before anything runs.

use crate::engine::report::Totals;
use crate::matter::gas::Gas;
use crate::observe::measure::Snapshot;
use crate::observe::measures;
use crate::scenario::did_you_mean;
use crate::scenario::model::{AnyScenario, Scenario};
use crate::simulation::figures::{is_of_every_run, numbers};
use crate::space::Vector;

/// Numbers of every summary that one may want to plot, for messages.
const USUAL: [&str; 4] = ["temperature", "collisions_per_particle", "simulated_time", "wall_seconds"];

/// The figures that the measures of `scenario` conclude with: what they say of an empty box.
pub(super) fn own_figures(scenario: &AnyScenario) -> Vec<String> {
    match scenario {
        AnyScenario::Two(scenario) => concluded(scenario),
        AnyScenario::Three(scenario) => concluded(scenario),
    }
}

fn concluded<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let gas = Gas::empty(scenario.grid(), scenario.grain);
    let totals = Totals::default();
    let snapshot = Snapshot::new(&gas, &totals);
    let measures = measures(&scenario.setting(), scenario.record.measures.as_deref());
    let figures = measures.iter().flat_map(|measure| measure.conclusion(&snapshot, 0.0).1);
    figures.map(|figure| figure.name).filter(|name| !is_of_every_run(name)).collect()
}

/// Says what is wrong where one of the figures `wished` is neither among the scenarios' `own` nor in every summary.
pub(super) fn check(wished: &[String], own: &[String]) -> Result<(), String> {
    let known = |name: &str| own.iter().any(|own| own == name) || numbers().any(|key| key == name);
    let Some(stranger) = wished.iter().find(|name| !known(name)) else { return Ok(()) };
    let every: Vec<&str> = numbers().collect();
    let remedy = format!(
        "this scenario has {}, and every run the numbers of its summary.json, such as {}",
        own.join(", "),
        USUAL.join(", ")
    );
    let names = own.iter().map(String::as_str).chain(every);
    let remedy = did_you_mean(stranger, names, &remedy);
    Err(format!("--figure '{stranger}': no figure of these runs has this name; {remedy}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{Overrides, load};

    #[test]
    fn an_empty_box_names_the_figures_of_a_run() {
        let own = |name: &str| own_figures(&load(name, &Overrides::default()).unwrap());
        for (scenario, figure) in [
            ("shear", "wall_shear_stress"),
            ("pipe", "spectrum_slope"),
            ("pipe", "flow_rate"),
            ("heap", "heap_slope"),
            ("sedimentation", "centre_of_mass_height"),
            ("hard-spheres", "compressibility_factor"),
        ] {
            assert!(own(scenario).iter().any(|own| own == figure), "{scenario}: {:?}", own(scenario));
        }
    }

    #[test]
    fn a_stranger_is_refused_with_what_was_meant() {
        let own = ["heap_slope".to_owned()];
        assert_eq!(check(&["heap_slope".to_owned(), "temperature".to_owned()], &own), Ok(()));
        assert!(check(&["heap_slop".to_owned()], &own).unwrap_err().contains("did you mean `heap_slope`?"));
        assert!(check(&["slope".to_owned()], &own).unwrap_err().ends_with("did you mean `heap_slope`?"));
    }
}
