//! What is wrong is told before anything runs.

use super::place::{Place, code, error};
use super::stage::{GAS, HEAP};
use std::fs;

#[test]
fn an_engine_that_lacks_something_is_refused_with_one_that_has_it() {
    let place = Place::with(&[("gas.toml", GAS)]);
    let rough = ["compare", "gas.toml", "--set", "particles.tangential_restitution=0.5", "--engines"];
    let said = place.refused(&[&rough[..], &["event-driven,hsmc,cba"]].concat());
    assert!(said.contains("hsmc knows smooth grains only") && said.contains("cba knows smooth"), "{said}");
    assert!(said.contains("an engine that has it: event-driven"), "{said}");
    let steps = ["compare", "gas.toml", "--set", "run={ steps = 10 }", "--engines", "hsmc,event-driven"];
    assert!(place.refused(&steps).contains("event-driven has no steps"));
}

#[test]
fn mistakes_are_told_by_the_name_of_their_option() {
    let place = Place::with(&[("gas.toml", GAS), ("heap.toml", HEAP)]);
    let refused = |more: &[&str]| place.refused(&[&["compare", "gas.toml"], more].concat());
    let said = refused(&["--engines", "hsmc,dsmcc", "--set", "run.time=-1"]);
    assert!(said.contains("--engines 'dsmcc'") && said.contains("--set #1 'run.time=-1'"), "{said}");
    assert!(refused(&["--engines", "hsmc"]).contains("`hsmc` alone has nothing to be compared with"));
    assert!(refused(&["--engines", "hsmc,cba,hsmc"]).contains("names `hsmc` twice"));
    assert!(refused(&["--engines", "hsmc,,cba"]).contains("--engines ''"));
    let said = refused(&["--measures", "energy,presure"]);
    assert!(
        said.contains("--measures energy,presure: ") && said.contains("did you mean `pressure`?"),
        "{said}"
    );
    assert!(refused(&["--replicas", "0"]).contains("--replicas"));
    assert!(refused(&["--jobs", "0"]).contains("--jobs"));
    assert!(refused(&["--seed", "-1"]).contains("--seed"));
    assert!(place.refused(&["compare"]).contains("SCENARIO"));
    assert!(place.refused(&["compare", "shaer"]).contains("did you mean `shear`?"));
    // All replicas would begin alike.
    let said = refused(&["--replicas", "3", "--set", "initial.positions.log=a.mcap"]);
    assert!(said.contains("--replicas 3: the scenario starts from a log"), "{said}");
    let said = refused(&["--set", "initial.positions.log=a.mcap"]);
    assert!(said.contains("cannot read the log a.mcap"), "{said}");
    // The lattice has room for points, not for grains.
    let lattice =
        ["--engines", "dsmc,cba", "--set", "initial.positions=lattice", "--set", "domain.size=[30.0, 1.5]"];
    let narrow = [
        &lattice[..],
        &[
            "--set",
            "engine.cell_size=1.5",
            "--set",
            "boundary.y.lower={wall='smooth'}",
            "--set",
            "boundary.y.upper={wall='smooth'}",
            "--set",
            "particles.count=35",
        ],
    ]
    .concat();
    let said = refused(&narrow);
    assert!(said.contains("event-driven dynamics makes the initial states"), "{said}");
}

#[test]
fn an_old_comparison_stays_unless_a_new_one_is_complete() {
    let place = Place::with(&[("gas.toml", GAS)]);
    let quick =
        ["compare", "gas.toml", "--replicas", "1", "--set", "run.time=0.5", "--out", "kept", "--quiet"];
    assert_eq!(code(&place.grainflow(&quick)), 0);
    let page = || fs::read_to_string(place.path("kept/comparison.html")).unwrap();
    let old = page();
    let output = place.grainflow(&quick);
    assert_eq!(code(&output), 2);
    assert!(error(&output).contains("kept already holds something") && error(&output).contains("--force"));
    assert!(page() == old);
    let forced = [&quick[..], &["--force", "--seed", "5"]].concat();
    let output = place.grainflow(&forced);
    assert_eq!((code(&output), error(&output)), (0, String::new()), "quiet is silent");
    assert!(page() != old);
    assert_eq!(fs::read_dir(place.path("")).unwrap().count(), 2, "the scenario and the comparison");
}
