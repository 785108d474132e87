use glam::DVec2;

use super::model::*;
use super::*;
use crate::law::boundary::{Face, WallKind};
use crate::observe::field::Quantity;

fn with(sets: &[&str]) -> Overrides {
    Overrides { sets: sets.iter().map(ToString::to_string).collect(), ..Default::default() }
}

fn flat(name: &str, sets: &[&str]) -> Scenario<DVec2> {
    match load(name, &with(sets)).unwrap_or_else(|error| panic!("{error}")) {
        AnyScenario::Two(scenario) => scenario,
        AnyScenario::Three(_) => panic!("{name} is flat"),
    }
}

fn message(name: &str, sets: &[&str]) -> String {
    load(name, &with(sets)).unwrap_err().to_string()
}

#[test]
fn every_built_in_scenario_is_right_for_every_engine() {
    for (name, title) in builtin::list() {
        assert!(!title.is_empty());
        for kind in EngineKind::ALL {
            let overrides = Overrides { engine: Some(kind.name().to_owned()), ..Default::default() };
            let scenario = load(name, &overrides).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(scenario.engine(), kind);
        }
    }
}

#[test]
fn the_built_in_scenarios_have_their_numbers() {
    assert_eq!(flat("shear", &[]).count, 2037);
    assert_eq!(flat("pipe", &[]).count, 3871);
    let cooling = flat("cooling", &[]);
    assert!((cooling.volume_fraction() - 0.25).abs() < 1e-12);
    assert!((flat("clustering", &[]).volume_fraction() - 0.25).abs() < 1e-12);
    assert_eq!(flat("sedimentation", &[]).capacity(), Some(4));
    assert_eq!(flat("heap", &[]).engine.hsmc.cell_restitution, 0.9);
    assert_eq!(flat("heap", &["particles.restitution=0.97"]).engine.hsmc.cell_restitution, 0.97);
    assert_eq!(flat("heap-full", &[]).source.unwrap().count, 30_500);
}

#[test]
fn the_source_text_gives_the_same_scenario() {
    let sets = [
        "domain.size[0]=80",
        "particles.count=77",
        "record.every=2.5",
        "title=a # b",
        "boundary.y.upper=\"open\"",
    ];
    let overrides = Overrides { seed: Some(9), engine: Some("cba".to_owned()), ..with(&sets) };
    let changed = load("shear", &overrides).unwrap();
    assert!(changed.source_text().contains("# Bagnold shear flow"));
    assert_eq!(parse("shear", changed.source_text(), &Overrides::default()).unwrap(), changed);
    let AnyScenario::Two(changed) = changed else { panic!("flat") };
    assert_eq!((changed.seed, changed.count, changed.size.x), (9, 77, 80.0));
    assert_eq!((changed.title.as_str(), changed.record.spacing), ("a # b", Spacing::Every(2.5)));
    assert_eq!(changed.boundary.faces(1).unwrap()[1], Face::Open);
}

#[test]
fn without_options_the_text_stays_as_it_is() {
    assert_eq!(Some(flat("pipe", &[]).source_text.as_str()), builtin::text("pipe"));
}

#[test]
fn a_rough_wall_with_a_velocity_follows_the_shear_rule() {
    let restitution = |scenario: &Scenario<DVec2>| {
        scenario.boundary.walls().map(|(_, _, wall)| wall.restitution).collect::<Vec<_>>()
    };
    let shear = flat("shear", &["boundary.y.upper.restitution=0.5"]);
    let covered = 1.0 - (1.0 - 0.9) * shear.volume_fraction();
    assert_eq!(restitution(&shear), [covered, 0.5]);
    assert_eq!(restitution(&flat("heap", &[])), [0.9]);
}

#[test]
fn a_vibrating_wall_extends_the_grid() {
    let lower = "boundary.y.lower={wall='vibrating',amplitude=2,frequency=0.5}";
    let scenario = flat("shear", &[lower]);
    assert_eq!((scenario.grid_origin, scenario.grid_size), (DVec2::new(0.0, -2.0), DVec2::new(400.0, 42.0)));
    assert_eq!(scenario.cells, [160, 17, 1]);
    assert!(matches!(scenario.boundary.walls().next().unwrap().2.kind, WallKind::Vibrating { .. }));
}

#[test]
fn three_dimensions_are_read() {
    let text = "dimension = 3\ngravity = [0, 0, -1]\n[engine]\nkind = 'hsmc'\n[domain]\nsize = [20, 20, 30]\n\
                [boundary]\nz = { lower = { wall = 'rough' }, upper = 'open' }\n[particles]\ncount = 100\n\
                restitution = 0.9\n[run]\ntime = 1\n";
    let AnyScenario::Three(scenario) = parse("deep", text, &Overrides::default()).unwrap() else { panic!() };
    assert_eq!(scenario.cells, [10, 10, 15]);
    assert_eq!(scenario.capacity(), Some(9));
    assert_eq!(scenario.initial.velocities, InitialVelocities::Rest);
    assert_eq!(scenario.engine.hsmc.maximum_volume_fraction, 0.64);
    assert_eq!(scenario.record.spacing, Spacing::Frames(200));
}

#[test]
fn each_kind_of_record_has_its_pace() {
    let usual = flat("clustering", &[]).record;
    assert_eq!((usual.points, usual.frames_every, usual.profiles_every), (Some(20_000), 1, 1));
    assert_eq!((usual.fields, usual.fields_every), (Vec::new(), 1));
    let sets = [
        "record.particles={every_nth=5,points='all'}",
        "record.profiles.every_nth=3",
        "record.fields={names=['bound','density','bound'],every_nth=2}",
    ];
    let plan = flat("clustering", &sets).record;
    assert_eq!((plan.points, plan.frames_every, plan.profiles_every), (None, 5, 3));
    assert_eq!((plan.fields, plan.fields_every), (vec![Quantity::Density, Quantity::Bound], 2));
    let short = flat("clustering", &["record.fields=['velocity']", "record.points=7"]);
    assert_eq!((short.record.points, short.fields().count()), (Some(7), 1));
    // Exact dynamics has no candidates to show.
    let exact = flat("clustering", &["engine.kind=event-driven", "record.fields=['bound','density']"]);
    assert_eq!(exact.fields().collect::<Vec<_>>(), [Quantity::Density]);
}

#[test]
fn all_mistakes_come_at_once_with_their_places() {
    let text = "dimension = 2\n[engine]\nkind = 'hsms'\n[domain]\nsize = [40, -1]\n[particles]\ncount = 1.5\n\
                diamter = 2\nrestitution = 2\n[run]\n";
    let error = parse("bad.toml", text, &with(&["seed=-3", "oops"])).unwrap_err();
    let text = error.to_string();
    for expected in [
        "bad.toml:3: engine.kind: \"hsms\" is not known; did you mean `hsmc`?\n",
        "bad.toml:5: domain.size[1]: -1 is out of bounds",
        "bad.toml:7: particles.count: 1.5 must be a whole number",
        "bad.toml:8: particles.diamter: is not a known key; did you mean `diameter`?",
        "bad.toml:9: particles.restitution: 2 is out of bounds; give a number from 0 to 1",
        "bad.toml:10: run: never ends",
        "--set #1 'seed=-3': seed: -3 is out of bounds",
        "--set #2 'oops': has no `=`",
    ] {
        assert!(text.contains(expected), "{expected} is missing from\n{text}");
    }
}

#[test]
fn options_are_named_in_their_mistakes() {
    assert!(
        message("shear", &["title='x'", "engine.knd=1"]).starts_with("--set #2 'engine.knd=1': engine.knd:")
    );
    assert!(
        message("shear", &["domain.size[1]=0"])
            .starts_with("--set #1 'domain.size[1]=0': domain.size[1]: 0 is")
    );
    let overrides = Overrides { engine: Some("cuba".to_owned()), seed: Some(u64::MAX), ..Default::default() };
    let text = load("shear", &overrides).unwrap_err().to_string();
    assert!(
        text.contains(
            "--engine 'cuba': engine.kind: \"cuba\" is not available in this version; choose one of"
        ),
        "{text}"
    );
    assert!(text.contains("choose one of \"dsmc\", \"cba\", \"hsmc\", \"event-driven\""), "{text}");
    assert!(text.contains("--seed 18446744073709551615: is too large"), "{text}");
    let sets = ["seed=-1", "oops", "run.time=-1", "domain.size[0]=-4", "title=''"];
    let text =
        load("sedimentation", &Overrides { sets: with(&sets).sets, ..overrides }).unwrap_err().to_string();
    let starts: Vec<&str> = text.lines().map(|line| line.split(['\'', ':']).next().unwrap().trim()).collect();
    let numbers = [
        "--set #1",
        "--set #2",
        "--set #3",
        "--set #4",
        "--set #5",
        "--engine",
        "--seed 18446744073709551615",
    ];
    assert_eq!(starts, numbers, "{text}");
}

#[test]
fn numbers_that_are_none_are_refused() {
    for value in ["nan", "inf", "-inf", "1e300"] {
        assert!(load("shear", &with(&[&format!("particles.diameter={value}")])).is_err(), "{value}");
        assert!(load("shear", &with(&[&format!("run.time={value}")])).is_err(), "{value}");
    }
}

#[test]
fn scaling_the_units_changes_no_cell() {
    let base = flat("shear", &[]);
    let small = flat(
        "shear",
        &[
            "particles.diameter=0.0009765625",
            "domain.size=[0.390625, 0.0390625]",
            "engine.cell_size=0.00244140625",
        ],
    );
    assert_eq!((small.cells, small.count), (base.cells, base.count));
}

/// Either a scenario or at least one mistake, whatever stands in the file.
#[test]
fn spoiled_files_never_pass_in_silence() {
    let values =
        ["nan", "-1", "0", "1e39", "'x'", "[]", "[1, 2, 3]", "{}", "{ log = 'a' }", "true", "1979-05-27"];
    for (name, _) in builtin::list() {
        let text = builtin::text(name).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        for (number, line) in lines.iter().enumerate() {
            let Some((key, _)) = line.split_once('=').filter(|_| !line.starts_with('#')) else { continue };
            for value in values.iter().map(|value| format!("{key}= {value}")).chain([String::new()]) {
                let mut spoiled: Vec<&str> = lines.clone();
                spoiled[number] = &value;
                if let Err(error) = parse(name, &spoiled.join("\n"), &Overrides::default()) {
                    assert!(!error.mistakes.is_empty(), "{name}: {value}");
                    assert!(!error.to_string().is_empty());
                }
            }
        }
    }
}

#[test]
fn other_line_ends_and_a_byte_order_mark_are_read() {
    let text = builtin::text("cooling").unwrap();
    for text in [text.replace('\n', "\r\n"), format!("\u{feff}{text}")] {
        let scenario = parse("cooling", &text, &Overrides { seed: Some(3), ..Default::default() }).unwrap();
        assert_eq!(parse("cooling", scenario.source_text(), &Overrides::default()).unwrap(), scenario);
    }
    let wrong = format!("\u{feff}{}", text.replace("dimension = 2", "dimension = 5")).replace('\n', "\r\n");
    let line = 1 + text.lines().position(|line| line.starts_with("dimension")).unwrap();
    let error = parse("cooling", &wrong, &Overrides::default()).unwrap_err().to_string();
    assert!(error.starts_with(&format!("cooling:{line}: dimension: 5")), "{error}");
}

/// The log that a scenario starts from.
fn log_of(scenario: &AnyScenario) -> std::path::PathBuf {
    let AnyScenario::Two(scenario) = scenario else { panic!("the scenario is flat") };
    match &scenario.initial.positions {
        InitialPositions::Log(path) => path.clone(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_log_is_looked_for_beside_the_file_that_names_it() {
    let from_log = load("cooling", &with(&["initial.positions.log=../a/log.mcap"])).unwrap();
    // Whoever types a path means it from where they stand.
    assert_eq!(log_of(&from_log), std::path::Path::new("../a/log.mcap"));
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("mine.toml");
    std::fs::write(&file, from_log.source_text()).unwrap();
    let load = |sets: &[&str]| log_of(&load(file.to_str().unwrap(), &with(sets)).unwrap());
    assert_eq!(load(&["run.time=3"]), place.path().join("../a/log.mcap"));
    for set in ["initial.positions.log=b.mcap", "initial.positions={log='b.mcap'}"] {
        assert_eq!(load(&[set]), std::path::Path::new("b.mcap"));
    }
}

/// What `check` says of `name`, for a mixture of these species in a box.
fn fact(text: &str, name: &str) -> Option<String> {
    let scenario = parse("mixture", text, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    check::check(&scenario).facts.into_iter().find(|(fact, _)| fact == name).map(|(_, value)| value)
}

/// A mixture of a few large and many small disks, and one of light and heavy spheres, with the values that runs have at their start.
#[test]
fn check_knows_how_often_grains_of_a_mixture_collide_and_how_far_they_get() {
    let disks = "dimension = 2\n[engine]\nkind = \"event-driven\"\n[domain]\nsize = [30.0, 30.0]\n\
                 [particles]\ncount = 3000\nrestitution = 1.0\n\
                 [[particles.species]]\ndiameter = 0.1\nmass = 0.0001\nshare = 0.999\n\
                 [[particles.species]]\ndiameter = 10.0\nmass = 1.0\nshare = 0.001\n\
                 [initial]\nvelocities = { maxwell = 1.0 }\n[run]\ncollisions_per_particle = 5.0\n";
    let path = fact(disks, "mean free path").unwrap();
    // 0.686 measured; a grain of mean size and mass would have 0.1855.
    assert!(path.starts_with("0.6889 "), "{path}");
    let spheres = "dimension = 3\n[engine]\nkind = \"event-driven\"\n[domain]\nsize = [40.0, 40.0, 40.0]\n\
                   [[particles.species]]\ndiameter = 1.0\nmass = 1.0\nshare = 0.5\n\
                   [[particles.species]]\ndiameter = 1.0\nmass = 8.0\nshare = 0.5\n\
                   [particles]\nvolume_fraction = 0.1\nrestitution = 0.8\n[initial]\nvelocities = { maxwell = 1.0 }\n\
                   [run]\ncollisions_per_particle = 30.0\n";
    // 1.22 measured over the first collisions, in which it cools already; a mean grain would have 0.83.
    assert!(fact(spheres, "collision frequency").unwrap().starts_with("1.259 "));
    // No formula is one of a packing.
    let dense = spheres.replace("volume_fraction = 0.1", "volume_fraction = 0.55");
    assert_eq!((fact(&dense, "collision frequency"), fact(&dense, "mean free path")), (None, None));
}
