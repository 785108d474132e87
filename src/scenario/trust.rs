//! Where an engine is known to be wrong, and by how much: what was measured beside exact dynamics and soft spheres.
//! docs/hsmc.md, “How far it can be trusted”, has the tables with the commands that repeat them.

mod driven;

use super::bound::rounded;
use super::cost;
use super::estimate;
use super::model::{AnyScenario, EngineKind, Scenario, Transfer};
use crate::law::boundary::{Face, WallKind};
use crate::law::kinetic_theory::{
    compressibility_factor, displaced_compressibility_factor, mean_free_path, optical_depth, shear_threshold,
};
use crate::law::restitution::{Constant, RestitutionLaw};
use crate::space::Vector;

/// Gases cluster in the course of so many of Haff's times.
const HAFF_TIMES: f64 = 5.0;
/// Cells of more mean free paths than this widen what forms in a gas that clusters; docs/comparison.md has figures.
const LONG_CELL: f64 = 1.5;
/// A gas is dilute, for that, below this volume fraction: in denser ones smaller cells help less.
const DILUTE: f64 = 0.2;
/// A pressure that is wrong by less than this share is stated beside the figure only.
const PRESSURE_WORTH_A_WARNING: f64 = 0.05;

/// Something that an engine is known to get wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Doubt {
    /// In a few words, for lists and beside figures.
    pub brief: String,
    /// What is known, with numbers and what does better.
    pub sentence: String,
    /// Beginnings of the names of the figures that it concerns.
    pub figures: &'static [&'static str],
    /// Whether it is worth a warning before the run.
    pub is_warning: bool,
}

impl Doubt {
    /// Whether it concerns the figure called `name`.
    pub fn concerns(&self, name: &str) -> bool {
        self.figures.iter().any(|beginning| name.starts_with(beginning))
    }
}

/// All that is known against the engine of `scenario`, the gravest first.
pub fn doubts(scenario: &AnyScenario) -> Vec<Doubt> {
    match scenario {
        AnyScenario::Two(scenario) => doubts_in_space(scenario),
        AnyScenario::Three(scenario) => doubts_in_space(scenario),
    }
}

/// The same in the space of `V`.
pub(super) fn doubts_in_space<V: Vector>(scenario: &Scenario<V>) -> Vec<Doubt> {
    if scenario.engine.kind.is_event_driven() {
        return Vec::new();
    }
    [at_rest(scenario), driven::stress(scenario), clusters(scenario), pressure(scenario)]
        .into_iter()
        .flatten()
        .collect()
}

/// Matter under gravity onto a wall.
fn at_rest<V: Vector>(scenario: &Scenario<V>) -> Option<Doubt> {
    if !cost::settles(scenario) {
        return None;
    }
    if scenario.engine.kind == EngineKind::Hsmc {
        return Some(hybrid_at_rest(scenario));
    }
    is_shaken(scenario).then(|| {
        let name = scenario.engine.kind.name();
        Doubt {
            brief: format!("{name} makes shaken beds too low, by up to half"),
            sentence: format!(
                "{name} makes shaken beds too low: 42 to 63 % where 50 disks were shaken at 1 to 4 √(gd), at the default step; \
                 at time_step = {{ fixed = 0.02 d over the speed of the wall }} it was 4 to 53 %"
            ),
            figures: &["centre_of_mass", "wall_normal_stress"],
            is_warning: true,
        }
    })
}

/// Whether the face onto which gravity pulls vibrates.
fn is_shaken<V: Vector>(scenario: &Scenario<V>) -> bool {
    (0..V::DIMENSION).filter(|&axis| scenario.gravity[axis] != 0.0).any(|axis| {
        let side = usize::from(scenario.gravity[axis] > 0.0);
        let face = scenario.boundary.faces(axis).map(|faces| faces[side]);
        matches!(face, Some(Face::Wall(wall)) if matches!(wall.kind, WallKind::Vibrating { .. }))
    })
}

/// Whether gravity pulls along a periodic axis besides: matter flows down a slope.
fn is_tilted<V: Vector>(scenario: &Scenario<V>) -> bool {
    (0..V::DIMENSION).any(|axis| scenario.gravity[axis] != 0.0 && scenario.boundary.is_periodic(axis))
}

/// HSMC under gravity: measured in two and three dimensions; docs/hsmc.md has the commands.
fn hybrid_at_rest<V: Vector>(scenario: &Scenario<V>) -> Doubt {
    let is_heap = scenario.source.is_some() || !is_closed_sideways(scenario);
    let (brief, measured, figures): (_, _, &'static [&'static str]) = if is_tilted(scenario) {
        (
            "hsmc freezes flows down a slope",
            "hsmc freezes flows down a slope: 1000 disks at 25 degrees move at 0.094 √(gd), and at 12.8 in exact dynamics",
            &["flow_", "collision_frequency", "mean_free", "wall_", "centre_of_mass", "density_contrast"],
        )
    } else if is_shaken(scenario) {
        (
            "hsmc gets the height of shaken beds wrong, by up to 40 %",
            "hsmc gets shaken beds wrong: 50 disks 34 to 42 % too low, 2000 spheres 19 % too high at 3 √(gd) and 20 % too low \
             at 9 √(gd)",
            &["centre_of_mass", "collision_frequency", "mean_free", "wall_normal_stress"],
        )
    } else if is_heap {
        (
            "hsmc makes heaps too steep, the more the larger they are",
            "hsmc makes heaps too steep, with the wrong trend: slopes of 0.45 at 600 disks and 0.60 at 1500 where exact \
             dynamics and soft spheres have 0.37 and 0.20; they also rise with dissipation where true ones fall",
            &["heap_", "centre_of_mass", "wall_normal_stress"],
        )
    } else {
        (
            "hsmc lets beds sink after they should rest",
            "hsmc lets beds sink after they should rest: the centre of mass of 100 disks comes to lie 23 % below that of exact \
             dynamics and soft spheres",
            &["centre_of_mass", "wall_normal_stress"],
        )
    };
    Doubt { brief: brief.to_owned(), sentence: measured.to_owned(), figures, is_warning: true }
}

/// Whether nothing can leave across gravity.
fn is_closed_sideways<V: Vector>(scenario: &Scenario<V>) -> bool {
    (0..V::DIMENSION)
        .filter(|&axis| scenario.gravity[axis] == 0.0)
        .all(|axis| scenario.boundary.faces(axis).is_none_or(|faces| !faces.contains(&Face::Open)))
}

/// A gas that nothing feeds, for so long that it clusters.
fn clusters<V: Vector>(scenario: &Scenario<V>) -> Option<Doubt> {
    let is_long = estimate::cooled(scenario).is_some_and(|cooled| cooled > HAFF_TIMES.ln_1p());
    let (restitution, nu) = (scenario.restitution.typical(), scenario.volume_fraction());
    let longest = scenario.size.components().into_iter().fold(0.0, f64::max);
    let depth = optical_depth(nu, longest, scenario.mean_grain().diameter);
    let is_unstable = 1.0 - restitution * restitution > shear_threshold::<V>(depth);
    (estimate::cools(scenario) && scenario.source.is_none() && is_long && is_unstable).then(|| {
        let name = scenario.engine.kind.name();
        Doubt {
            brief: format!("once the gas clusters, {name} loses energy too fast, by half and more in the end"),
            sentence: format!(
                "once the gas clusters, {name} loses energy too fast and makes structures too wide: after 140 collisions per \
                 particle at r = 0.85 half of the energy of exact dynamics is left at ν = 0.05, a third at ν = 0.245{}",
                nearer(scenario)
            ),
            figures: &["density_variance", "volume_fraction_q", "sonine", "alpha_"],
            is_warning: true,
        }
    })
}

/// What comes nearer to exact dynamics in a dilute gas of long cells.
fn nearer<V: Vector>(scenario: &Scenario<V>) -> String {
    let longest = scenario.grid().side().components().into_iter().fold(0.0, f64::max);
    let path = mean_free_path::<V>(scenario.mean_grain(), scenario.volume_fraction());
    if scenario.volume_fraction() >= DILUTE || longest <= LONG_CELL * path {
        return String::new();
    }
    format!(
        "; cells of {} are longer than the mean free path {}: cells near it, with enskog_factor = \"smoothed\" where they hold few \
         grains, come nearer",
        rounded(longest),
        rounded(path)
    )
}

/// The transfer of momentum that carries 2r in place of 1 + r.
fn pressure<V: Vector>(scenario: &Scenario<V>) -> Option<Doubt> {
    let RestitutionLaw::Constant(Constant(restitution)) = scenario.restitution else { return None };
    let is_displaced =
        scenario.engine.kind != EngineKind::Dsmc && scenario.engine.transfer == Transfer::MomentumChange;
    let nu = super::check::volume_fraction_of(scenario, cost::final_grains(scenario));
    if !is_displaced || restitution >= 1.0 || cost::settles(scenario) || nu <= 0.0 || nu >= V::FREEZING {
        return None;
    }
    let found = displaced_compressibility_factor::<V>(nu, restitution);
    let exact = compressibility_factor::<V>(nu, restitution);
    let share = 1.0 - found / exact;
    let percent = rounded_percent(share);
    Some(Doubt {
        brief: format!("transfer = \"momentum-change\" makes the pressure {percent} % too low"),
        sentence: format!(
            "transfer = \"momentum-change\", the default, makes the pressure {percent} % too low: PV/NT = {} at ν = {} and r = {}, \
             and {} in Enskog theory, which transfer = \"corrected\" obeys",
            rounded(found),
            rounded(nu),
            rounded(restitution),
            rounded(exact)
        ),
        figures: &["pressure", "compressibility_factor", "wall_normal_stress"],
        is_warning: share > PRESSURE_WORTH_A_WARNING,
    })
}

/// A share in per cent, with two digits.
fn rounded_percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent < 9.95 { format!("{percent:.1}") } else { format!("{percent:.0}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{Overrides, load};

    fn known(name: &str, sets: &[&str]) -> Vec<Doubt> {
        let sets = sets.iter().map(ToString::to_string).collect();
        let overrides = Overrides { sets, ..Default::default() };
        doubts(&load(name, &overrides).unwrap_or_else(|error| panic!("{error}")))
    }

    fn briefly(name: &str, sets: &[&str]) -> String {
        known(name, sets).into_iter().map(|doubt| doubt.brief).collect::<Vec<_>>().join("\n")
    }

    const SHAKEN: &str = "boundary.y.lower={wall='vibrating',amplitude=1e-4,frequency=100}";

    #[test]
    fn hsmc_under_gravity_is_doubted_for_what_it_gets_wrong_there() {
        assert!(briefly("heap", &[]).contains("heaps too steep"));
        assert!(briefly("sedimentation", &[]).contains("beds sink"));
        assert!(briefly("sedimentation", &[SHAKEN]).contains("shaken beds"));
        let slope = ["gravity=[4,-9]", "boundary.x=periodic"];
        assert!(briefly("sedimentation", &slope).contains("freezes flows"));
        // A pipe has no floor.
        assert!(!briefly("pipe", &[]).contains("slope") && !briefly("pipe", &[]).contains("bed"));
    }

    #[test]
    fn point_engines_are_doubted_in_shaken_beds() {
        for kind in ["engine.kind=dsmc", "engine.kind=cba"] {
            let cells = "engine.cell_size=2e-3";
            assert!(briefly("sedimentation", &[kind, cells, SHAKEN]).contains("shaken beds too low"));
            assert!(!briefly("sedimentation", &[kind, cells]).contains("shaken"));
        }
    }

    #[test]
    fn exact_dynamics_is_not_doubted() {
        for name in ["heap", "sedimentation", "shear", "pipe", "clustering", "correlations"] {
            assert_eq!(known(name, &["engine.kind=event-driven"]), [], "{name}");
        }
    }

    #[test]
    fn a_pressure_that_the_transfer_spoils_is_doubted_by_its_share() {
        // 1 + 2r ν g beside 1 + (1 + r) ν g at ν = 0.25, r = 0.9: 1.7125 and 1.7521.
        let short = "run={collisions_per_particle=2}";
        let doubts = known("cooling", &[short]);
        let [doubt] = &doubts[..] else { panic!("{doubts:?}") };
        assert!(doubt.brief.contains("2.3 % too low") && !doubt.is_warning, "{doubt:?}");
        assert!(doubt.concerns("pressure") && doubt.concerns("compressibility_factor"));
        assert!(!doubt.concerns("collision_frequency"));
        let low = known("cooling", &[short, "particles.restitution=0.3"]);
        assert!(low.iter().any(|doubt| doubt.brief.contains("momentum-change") && doubt.is_warning));
        for exact in ["particles.restitution=1", "engine.transfer=corrected", "engine.kind=dsmc"] {
            assert_eq!(known("cooling", &[short, exact]), [], "{exact}");
        }
    }

    #[test]
    fn cells_of_a_driven_flow_are_doubted_by_what_they_cost() {
        let sentence = |sets: &[&str]| known("shear", sets)[0].sentence.clone();
        assert!(sentence(&[]).contains("multiply the viscosity by 1.104"), "{}", sentence(&[]));
        let long = sentence(&["engine.cell_size=10"]);
        assert!(long.contains("by 2.66") && long.contains("engine.cell_size = 2.45 would"), "{long}");
        // At ν = 0.4 the mean free path is 0.3 d, and no cell is as short.
        let dense = sentence(&["particles.volume_fraction=0.4"]);
        assert!(dense.contains("take event-driven"), "{dense}");
    }

    #[test]
    fn gases_are_doubted_once_they_cluster_and_not_before() {
        assert!(briefly("clustering", &[]).contains("once the gas clusters, cba"));
        assert!(briefly("correlations", &[]).contains("once the gas clusters, hsmc"));
        // At r = 0.98 the same gas agrees with exact dynamics within 1 % to the end.
        assert!(!briefly("correlations", &["particles.restitution=0.98"]).contains("clusters"));
        // A box too small for a shear mode.
        let small = ["particles.count=30", "domain.size=[10,10]"];
        assert!(!briefly("cooling", &small).contains("clusters"));
    }
}
