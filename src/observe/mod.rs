//! Observation: one measure a file, each reads the gas and the totals and changes neither.

pub mod centre_of_mass;
pub mod clusters;
pub mod collisions;
pub mod correlations;
pub mod density_contrast;
pub mod density_distribution;
pub mod density_profile;
pub mod energy;
pub mod field;
pub mod flow;
pub mod heap;
pub mod impact_parameter;
pub mod measure;
pub mod moments;
pub mod pair_correlation;
pub mod pressure;
pub mod setting;
pub mod spectrum;
pub mod structure_factor;
pub mod temperature_profile;
pub mod velocity_distribution;
pub mod velocity_profile;
pub mod wall_stress;

mod density_waves;
mod last_look;
pub(crate) mod layout;
pub(crate) mod local_flow;
mod packing;
mod samples;
mod slices;
mod species_temperature;
#[cfg(test)]
mod testing;
mod transform;
pub(crate) mod units;

use crate::space::Vector;
use measure::Measure;
use setting::Setting;

/// The names of all measures, in the order in which [`measures`] gives those that apply.
pub const NAMES: [&str; 19] = [
    "energy",
    "density-profile",
    "velocity-profile",
    "wall-stress",
    "pressure",
    "collisions",
    "impact-parameter",
    "flow",
    "density-contrast",
    "spectrum",
    "heap",
    "centre-of-mass",
    "velocity-distribution",
    "density-distribution",
    "pair-correlation",
    "structure-factor",
    "temperature-profile",
    "correlations",
    "clusters",
];

/// The measures that apply to `setting` and are cheap or among those `named`, always in the same order.
pub fn measures<V: Vector>(setting: &Setting<V>, named: Option<&[String]>) -> Vec<Box<dyn Measure<V>>> {
    let is_named = |name: &str| named.is_some_and(|names| names.iter().any(|n| n == name));
    applying(setting).into_iter().filter(|measure| !measure.is_costly() || is_named(measure.name())).collect()
}

/// All measures that apply to `setting`, always in the same order.
fn applying<V: Vector>(setting: &Setting<V>) -> Vec<Box<dyn Measure<V>>> {
    let applying: [Option<Box<dyn Measure<V>>>; 19] = [
        Some(Box::new(energy::Energy::new(setting))),
        Some(Box::new(density_profile::DensityProfile::new(setting))),
        boxed(velocity_profile::VelocityProfile::new(setting)),
        boxed(wall_stress::WallStress::new(setting)),
        boxed(pressure::Pressure::new(setting)),
        Some(Box::new(collisions::Collisions::new())),
        boxed(impact_parameter::ImpactParameter::new(setting)),
        boxed(flow::Flow::new(setting)),
        boxed(density_contrast::DensityContrast::new(setting)),
        boxed(spectrum::Spectrum::new(setting)),
        boxed(heap::Heap::new(setting)),
        boxed(centre_of_mass::CentreOfMass::new(setting)),
        Some(Box::new(velocity_distribution::VelocityDistribution::new(setting))),
        Some(Box::new(density_distribution::DensityDistribution::new())),
        boxed(pair_correlation::PairCorrelation::new(setting)),
        boxed(structure_factor::StructureFactor::new(setting)),
        Some(Box::new(temperature_profile::TemperatureProfile::new(setting))),
        boxed(correlations::Correlations::new(setting)),
        Some(Box::new(clusters::Clusters::new(setting))),
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
    use crate::observe::testing::{Bed, rough, setting_of, show, smooth};
    use glam::{DVec2, DVec3};

    /// The measures for `bed`, without those of grains and their neighbours, which ask for little.
    fn names<V: Vector>(bed: &Bed<V>) -> Vec<&'static str> {
        let names: Vec<&str> = applying(&bed.setting).iter().map(|measure| measure.name()).collect();
        let places: Vec<usize> =
            names.iter().map(|name| NAMES.iter().position(|n| n == name).unwrap()).collect();
        assert!(places.is_sorted());
        let of_all = ["velocity-distribution", "density-distribution", "pair-correlation"];
        assert!(of_all.iter().all(|name| names.contains(name)));
        let is_periodic = (0..V::DIMENSION).any(|axis| bed.setting.boundary.is_periodic(axis));
        assert_eq!(names.contains(&"structure-factor"), is_periodic);
        names.into_iter().filter(|name| !of_all.contains(name) && *name != "structure-factor").collect()
    }

    #[test]
    fn every_kind_of_scenario_has_its_measures() {
        let mut bed = setting_of(DVec2::splat(8.0), [4, 4, 1]);
        assert_eq!(
            names(&bed),
            [
                "energy",
                "density-profile",
                "pressure",
                "collisions",
                "temperature-profile",
                "correlations",
                "clusters"
            ]
        );
        bed.setting.counts_impacts = true;
        assert_eq!(names(&bed)[3..5], ["collisions", "impact-parameter"]);
        bed.setting.counts_impacts = false;
        bed.walls(1, rough(DVec2::ZERO), rough(DVec2::X));
        assert_eq!(
            names(&bed),
            [
                "energy",
                "density-profile",
                "velocity-profile",
                "wall-stress",
                "collisions",
                "temperature-profile",
                "clusters"
            ]
        );
    }

    #[test]
    fn pipes_and_heaps_have_their_measures() {
        let mut pipe = setting_of(DVec3::splat(8.0), [4, 4, 4]);
        pipe.walls(0, smooth(), smooth());
        pipe.setting.gravity = DVec3::new(0.0, 0.0, -1.0);
        let expected = [
            "energy",
            "density-profile",
            "wall-stress",
            "collisions",
            "flow",
            "density-contrast",
            "spectrum",
            "temperature-profile",
            "clusters",
        ];
        assert_eq!(names(&pipe), expected);
        pipe.walls(0, Face::Open, Face::Open);
        pipe.walls(2, smooth(), Face::Open);
        assert_eq!(
            names(&pipe),
            [
                "energy",
                "density-profile",
                "wall-stress",
                "collisions",
                "heap",
                "centre-of-mass",
                "temperature-profile",
                "clusters"
            ]
        );
    }

    #[test]
    fn costly_measures_are_taken_where_they_are_named() {
        let setting = setting_of(DVec2::splat(8.0), [4, 4, 1]).setting;
        let taken = |named: Option<&[String]>| -> Vec<&str> {
            measures(&setting, named).iter().map(|measure| measure.name()).collect()
        };
        let cheap = taken(None);
        assert!(cheap.contains(&"velocity-distribution") && !cheap.contains(&"pair-correlation"));
        let with = taken(Some(&["pair-correlation".to_owned()]));
        assert!(with.contains(&"pair-correlation") && !with.contains(&"structure-factor"));
        assert_eq!(with.len(), cheap.len() + 1);
    }

    #[test]
    fn every_figure_and_column_is_named_once() {
        let mut bed = setting_of(DVec2::splat(8.0), [4, 4, 1]);
        bed.walls(1, rough(-DVec2::X), rough(DVec2::X));
        bed.setting.gravity = DVec2::new(0.5, -1.0);
        let states = bed.random_states(5, 30);
        let mut seen = std::collections::BTreeSet::new();
        for mut measure in applying(&bed.setting) {
            for column in measure.columns() {
                assert!(seen.insert(format!("column {}", column.name)), "{}", column.name);
            }
            for state in &states {
                show(&mut *measure, state);
            }
            let (gas, totals) = &states[4];
            for figure in measure.conclusion(&measure::Snapshot::new(gas, totals), 0.0).1 {
                assert!(seen.insert(format!("figure {}", figure.name)), "{}", figure.name);
            }
        }
        assert!(seen.contains("figure flow_rate") && seen.contains("figure centre_of_mass_height"));
    }
}
