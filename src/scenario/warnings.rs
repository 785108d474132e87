//! What may spoil a run that is not wrong.

mod method;
mod motion;
mod resolution;
mod resources;

use super::check::spoken;
use super::collapse;
use super::exact;
use super::model::Scenario;
use super::trust;
use crate::machine::Machine;
use crate::space::Vector;

/// Everything that may spoil `scenario` on `machine`.
pub(super) fn warnings<V: Vector>(scenario: &Scenario<V>, machine: Machine) -> Vec<String> {
    let groups = [
        method::engine(scenario),
        known(scenario),
        resolution::cells(scenario),
        resolution::gradients(scenario),
        method::gravity(scenario),
        motion::dead(scenario).into_iter().collect(),
        motion::pouring(scenario).into_iter().collect(),
        collapse::warning(scenario).into_iter().collect(),
        resolution::time_step(scenario),
        resolution::capped_step(scenario),
        resources::recordings(scenario),
        method::fields(scenario),
        method::measures(scenario).into_iter().collect(),
        resources::patience(scenario),
        resources::memory(scenario, machine),
        resources::disk(scenario, machine),
    ];
    groups.into_iter().flatten().collect()
}

/// What is known against the engine, where it is worth a warning.
fn known<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let doubts = trust::doubts_in_space(scenario).into_iter();
    let mut known: Vec<String> =
        doubts.filter(|doubt| doubt.is_warning).map(|doubt| doubt.sentence).collect();
    if !known.is_empty() {
        known.extend(exact_instead(scenario));
    }
    known
}

/// Exact dynamics in place of an engine that is known to be wrong here.
fn exact_instead<V: Vector>(scenario: &Scenario<V>) -> Option<String> {
    let proposal = exact::proposal(scenario).filter(exact::Proposal::is_worth_it)?;
    let long = if proposal.is_as_fast { ", about as long" } else { "" };
    let took = spoken(proposal.seconds.most);
    Some(format!("exact dynamics takes up to {took}{long}: {}", proposal.options()))
}

#[cfg(test)]
mod tests {
    use crate::machine::Machine;
    use crate::scenario::check::{check, check_on};
    use crate::scenario::model::AnyScenario;
    use crate::scenario::{Overrides, load};

    fn scenario(name: &str, sets: &[&str]) -> AnyScenario {
        let sets = sets.iter().map(ToString::to_string).collect();
        load(name, &Overrides { sets, ..Default::default() }).unwrap_or_else(|error| panic!("{error}"))
    }

    fn warned(name: &str, sets: &[&str]) -> String {
        check(&scenario(name, sets)).warnings.join("\n")
    }

    #[test]
    fn what_may_spoil_the_result_is_said() {
        assert!(!warned("shear", &["engine.kind=dsmc"]).contains("as points"));
        assert!(warned("cooling", &["engine.kind=dsmc"]).contains("as points"));
        assert!(warned("cooling", &["engine.kind=cba", "engine.cell_size=3"]).contains("below 5"));
        assert!(warned("shear", &["engine.cell_size=8"]).contains("cells of 8 are 3.4"));
        assert!(warned("heap", &["boundary.y.lower=open"]).contains("boundary.y.lower"));
        for quiet in ["hard-spheres", "simic-cooling"] {
            assert_eq!(warned(quiet, &[]), "", "{quiet}");
        }
        assert_eq!(warned("cooling", &["run={collisions_per_particle=5}", "record.frames=10"]), "");
    }

    #[test]
    fn long_cells_of_a_dilute_gas_that_clusters_are_said() {
        let dilute = ["particles.volume_fraction=0.05", "engine.cell_size=16"];
        let long = ["particles.restitution=0.8", "run={collisions_per_particle=100}"];
        let said = warned("cooling", &[dilute, long].concat());
        // 1/(2 √2 n d χ) with n = 0.05/(π/4) and χ = (1 − 7ν/16)/(1 − ν)².
        assert!(
            said.contains("cells of 14.77 are longer than the mean free path 5.124: cells near it"),
            "{said}"
        );
        let short = warned("cooling", &[&dilute[..], &long[..], &["engine.cell_size=5"]].concat());
        assert!(short.contains("once the gas clusters") && !short.contains("mean free path"), "{short}");
        let others = ["run={collisions_per_particle=2}", "particles.restitution=1"];
        for other in others {
            let sets = [&dilute[..], &long[..], &[other]].concat();
            assert!(!warned("cooling", &sets).contains("once the gas clusters"), "{other}");
        }
        assert!(!warned("cooling", &long).contains("longer than the mean free path"));
    }

    #[test]
    fn an_engine_that_is_known_to_be_wrong_is_named_with_what_does_better() {
        let said = warned("heap", &["source.count=600"]);
        assert!(said.contains("hsmc makes heaps too steep"), "{said}");
        assert!(said.contains("exact dynamics takes up to"), "{said}");
        assert!(
            said.contains(
                "--set 'engine.event_driven.collapse={ elastic_below = 0.3, contact_time = 1e-5 }'"
            ),
            "{said}"
        );
        // Beyond some 10⁵ grains nothing is proposed.
        assert!(!warned("heap", &["source.count=200000"]).contains("exact dynamics takes"));
        assert!(!warned("heap", &["engine.kind=event-driven"]).contains("too steep"));
    }

    #[test]
    fn advice_on_cells_is_one_advice() {
        // Few grains per cell call for larger cells, walls that move for smaller ones: between these only one is said.
        for sets in [&[][..], &["engine.cell_size=8"], &["engine.cell_size=2"]] {
            let said = warned("shear", sets);
            assert!(!said.contains("enlarge engine.cell_size"), "{said}");
            assert!(said.contains("makes the stress of driven flows too high"), "{said}");
        }
        assert!(
            warned("cooling", &["engine.kind=cba", "engine.cell_size=3"])
                .contains("enlarge engine.cell_size")
        );
    }

    #[test]
    fn grains_at_rest_that_all_fall_alike_are_said() {
        let fall = ["initial.velocities=rest", "boundary.x=periodic"];
        assert!(warned("pipe", &fall).contains("none ever collides"), "{}", warned("pipe", &fall));
        assert!(!warned("pipe", &[]).contains("none ever collides"));
    }

    #[test]
    fn a_vibrating_wall_that_may_reach_nothing_is_said() {
        let shaken = |amplitude: &str| {
            let wall = format!(
                "boundary.y={{lower={{wall='vibrating',amplitude={amplitude},frequency=1}},upper='open'}}"
            );
            warned("shear", &["initial.velocities=rest", "run={time=10}", &wall])
        };
        // 2037 grains over a height of 40: 0.05 of them within 10⁻³.
        assert!(shaken("1e-3").contains("about 0.0509"), "{}", shaken("1e-3"));
        assert!(!shaken("0.2").contains("nothing ever moves"));
    }

    #[test]
    fn a_source_faster_than_its_spout_is_said_before_the_run() {
        // From rest a disk falls by its diameter in √2.
        let fast = ["source.rate=8", "engine.kind=event-driven"];
        let said = warned("heap", &fast);
        assert!(said.contains("lets out about 0.7071;"), "{said}");
        assert!(said.contains("A source.rate of 0.707 or less"), "{said}");
        let thrown = [&fast[..], &["source.velocity=[0,-20]"]].concat();
        for quiet in [&["engine.kind=event-driven"][..], &["source.rate=8"], &thrown[..]] {
            assert!(!warned("heap", quiet).contains("cannot pour"), "{quiet:?}");
        }
    }

    #[test]
    fn measures_that_the_scenario_does_not_have_are_said() {
        let said = warned("cooling", &["record.measures=[\"heap\", \"energy\"]"]);
        assert!(said.contains("record.measures names heap, for which"), "{said}");
        assert!(!warned("heap", &["record.measures=[\"heap\"]"]).contains("record.measures"));
    }

    #[test]
    fn points_under_gravity_pile_up() {
        for kind in ["dsmc", "cba"] {
            let kind = format!("engine.kind={kind}");
            assert!(warned("heap", &[&kind]).contains("beyond any possible density"));
            assert!(warned("sedimentation", &[&kind]).contains("no excluded volume"));
            assert!(!warned("pipe", &[&kind]).contains("no excluded volume"));
        }
    }

    #[test]
    fn a_fixed_step_that_a_fall_makes_too_long_is_foreseen() {
        // √(2 · 9.81 · 0.04) = 0.886: 0.002/0.886 = 2.26e-3.
        let warning = warned("sedimentation", &["engine.time_step.fixed=3e-3"]);
        assert!(warning.contains("falls freely comes to move at 0.8859"), "{warning}");
        assert!(warning.contains("engine.time_step.fixed = 0.0022"), "{warning}");
        assert!(!warned("sedimentation", &["engine.time_step.fixed=2e-3"]).contains("fixed step"));
        // The spout of a heap is low; its box is not.
        let filled = ["particles.count=10", "engine.time_step.fixed=0.15"];
        assert!(warned("heap", &filled).contains("17.89"), "{}", warned("heap", &filled));
        // The tail of a Maxwellian at the start.
        let tail = ["engine.time_step.fixed=1", "engine.cell_size=2.5"];
        assert!(warned("shear", &tail).contains("the fastest grain of the start"));
    }

    #[test]
    fn cells_that_start_too_full_are_allowed_and_said() {
        let full = ["particles.volume_fraction=0.9", "initial.velocities={maxwell=1}"];
        let warning = warned("cooling", &full);
        assert!(warning.contains("cells start above their capacity: they admit nobody"), "{warning}");
        let share = ["particles.volume_fraction=0.8", "initial.positions=lattice"];
        assert!(!warned("cooling", &share).contains("above their capacity"));
    }

    #[test]
    fn recordings_beyond_reason_are_said() {
        let often = warned("heap", &["record.every=1e-9"]);
        assert!(often.contains("of about 64000 steps: every step will be recorded"), "{often}");
        assert!(!often.contains("TB"), "{often}");
        let all = ["record.points=all", "record.frames=4000", "particles.count=100000"];
        let large = warned("clustering", &all);
        assert!(large.contains("record.frames asks for 4001 recordings of about 527 steps"), "{large}");
        let even = ["record.points=all", "record.frames=4000", "record.spacing=even", "run={steps=5000}"];
        let large = warned("clustering", &even);
        assert!(large.contains("the log takes about 11"), "{large}");
    }

    #[test]
    fn memory_and_disk_are_compared_with_what_is_free() {
        let clustering = scenario("clustering", &["run.time=20", "record.frames=100"]);
        let warnings = |memory, disk| check_on(&clustering, Machine { memory, disk }).warnings;
        assert!(warnings(Some(16_000_000_000), Some(16_000_000_000)).is_empty());
        let said = warnings(Some(50_000_000), None);
        assert!(said.len() == 1 && said[0].contains("50.0 MB are free"), "{said:?}");
        let said = warnings(None, Some(2_000_000));
        assert!(said.len() == 1 && said[0].contains("the disk has room for 2.0 MB"), "{said:?}");
    }

    #[test]
    fn a_step_that_is_capped_throughout_is_said() {
        let dilute = ["particles.volume_fraction=0.002", "engine.cell_size=5"];
        let said = warned("cooling", &dilute);
        assert!(said.contains("the step is capped throughout") && said.contains("crossing = 0.5"), "{said}");
        assert!(!warned("cooling", &["engine.time_step={crossing=0.5}"]).contains("capped"));
        assert!(
            !warned("cooling", &[&dilute[..], &["engine.kind=event-driven"]].concat()).contains("capped")
        );
    }

    #[test]
    fn too_few_cells_for_a_gradient_are_said() {
        assert!(
            warned("shear", &["engine.cell_size=8"]).contains("5 cells along y: what a moving wall makes")
        );
        assert!(!warned("shear", &[]).contains("cells along"));
        let flat = ["domain.size[1]=0.012", "particles.count=5"];
        assert!(warned("sedimentation", &flat).contains("6 cells along y: what gravity makes"));
    }

    #[test]
    fn runs_that_nobody_waits_for_are_said() {
        assert!(warned("heap", &["engine.time_step.fixed=1e-9"]).contains("days on one core; fewer grains"));
        assert!(!warned("heap-full", &[]).contains("on one core"));
    }
}
