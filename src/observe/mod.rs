//! Observation: one measure a file, each reads the gas and the totals and changes neither.

pub mod centre_of_mass;
pub mod density_contrast;
pub mod density_profile;
pub mod energy;
pub mod flow;
pub mod heap;
pub mod measure;
pub mod moments;
pub mod pressure;
pub mod spectrum;
pub mod velocity_profile;
pub mod wall_stress;

mod layout;
mod packing;
mod samples;
mod slices;
#[cfg(test)]
mod testing;
mod units;

use crate::scenario::model::Scenario;
use crate::space::Vector;
use measure::Measure;

/// The names of all measures, in the order in which [`measures`] gives those that apply.
pub const NAMES: [&str; 10] = [
    "energy",
    "density-profile",
    "velocity-profile",
    "wall-stress",
    "pressure",
    "flow",
    "density-contrast",
    "spectrum",
    "heap",
    "centre-of-mass",
];

/// All measures that apply to `scenario`, always in the same order.
pub fn measures<V: Vector>(scenario: &Scenario<V>) -> Vec<Box<dyn Measure<V>>> {
    let applying: [Option<Box<dyn Measure<V>>>; 10] = [
        Some(Box::new(energy::Energy::new(scenario))),
        Some(Box::new(density_profile::DensityProfile::new(scenario))),
        boxed(velocity_profile::VelocityProfile::new(scenario)),
        boxed(wall_stress::WallStress::new(scenario)),
        boxed(pressure::Pressure::new(scenario)),
        boxed(flow::Flow::new(scenario)),
        boxed(density_contrast::DensityContrast::new(scenario)),
        boxed(spectrum::Spectrum::new(scenario)),
        boxed(heap::Heap::new(scenario)),
        boxed(centre_of_mass::CentreOfMass::new(scenario)),
    ];
    applying.into_iter().flatten().collect()
}

fn boxed<V: Vector>(measure: Option<impl Measure<V> + 'static>) -> Option<Box<dyn Measure<V>>> {
    measure.map(|measure| Box::new(measure) as Box<dyn Measure<V>>)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::boundary::Face;
    use crate::observe::testing::{Bed, rough, scenario_of, show, smooth};
    use glam::{DVec2, DVec3};

    fn names<V: Vector>(bed: &Bed<V>) -> Vec<&'static str> {
        let names: Vec<&str> = measures(&bed.scenario).iter().map(|measure| measure.name()).collect();
        let places: Vec<usize> =
            names.iter().map(|name| NAMES.iter().position(|n| n == name).unwrap()).collect();
        assert!(places.is_sorted());
        names
    }

    #[test]
    fn every_kind_of_scenario_has_its_measures() {
        let mut bed = scenario_of(DVec2::splat(8.0), [4, 4, 1]);
        assert_eq!(names(&bed), ["energy", "density-profile", "pressure"]);
        bed.walls(1, rough(DVec2::ZERO), rough(DVec2::X));
        assert_eq!(names(&bed), ["energy", "density-profile", "velocity-profile", "wall-stress"]);
        let mut pipe = scenario_of(DVec3::splat(8.0), [4, 4, 4]);
        pipe.walls(0, smooth(), smooth());
        pipe.scenario.gravity = DVec3::new(0.0, 0.0, -1.0);
        let expected = ["energy", "density-profile", "wall-stress", "flow", "density-contrast", "spectrum"];
        assert_eq!(names(&pipe), expected);
        pipe.walls(0, Face::Open, Face::Open);
        pipe.walls(2, smooth(), Face::Open);
        assert_eq!(names(&pipe), ["energy", "density-profile", "wall-stress", "heap", "centre-of-mass"]);
    }

    #[test]
    fn every_figure_and_column_is_named_once() {
        let mut bed = scenario_of(DVec2::splat(8.0), [4, 4, 1]);
        bed.walls(1, rough(-DVec2::X), rough(DVec2::X));
        bed.scenario.gravity = DVec2::new(0.5, -1.0);
        let states = bed.random_states(5, 30);
        let mut seen = std::collections::BTreeSet::new();
        for mut measure in measures(&bed.scenario) {
            for column in measure.columns() {
                assert!(seen.insert(format!("column {}", column.name)), "{}", column.name);
            }
            for state in &states {
                show(&mut *measure, state);
            }
            let (gas, totals) = &states[4];
            for figure in measure.conclusion(&measure::Snapshot { gas, totals }, 0.0).1 {
                assert!(seen.insert(format!("figure {}", figure.name)), "{}", figure.name);
            }
        }
        assert!(seen.contains("figure flow_rate") && seen.contains("figure centre_of_mass_height"));
    }
}
