//! Wrong command lines and files that are none: each is refused with exit code 2, a message that names the option,
//! the value, the bound and the remedy, and nothing is written.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::place::Place;

/// What a shell is given behind the name of the program, and what the message has to contain.
type Refusal = (&'static str, &'static [&'static str]);

const FILES: &[Refusal] = &[
    ("run binary.toml", &["binary.toml: is not UTF-8 text (byte 0); a scenario is a TOML text"]),
    ("check empty.toml", &["empty.toml: holds no scenario; `grainflow scenarios show shear` prints one"]),
    ("check huge.toml", &["is larger than 1 MiB; a scenario is a short TOML text"]),
    ("check /dev/zero", &["is larger than 1 MiB"]),
    ("check folder", &["folder: is a directory, not a scenario; name a file in it"]),
    ("run missing.toml", &["is neither a file nor a built-in scenario; built in are shear, pipe"]),
    ("run sheer", &["did you mean `shear`?"]),
    ("run ''", &["is neither a file nor a built-in scenario"]),
    ("run cooling --set initial.positions.log=noise.mcap", &["noise.mcap is not an MCAP file"]),
    (
        "run cooling --set initial.positions.log=empty.toml",
        &["is empty: the run that should have written it"],
    ),
    ("run cooling --set initial.positions.log=none.mcap", &["cannot read the log none.mcap", "No such file"]),
    (
        "check cooling --set initial.positions.log=none.mcap",
        &["cannot read the log none.mcap", "No such file"],
    ),
    (
        "run cooling --set initial.positions.log=cut.mcap",
        &["cut.mcap holds no complete state, from which grains could be taken"],
    ),
    ("run cooling --out folder --force", &["folder holds no run, comparison or calibration"]),
    ("run cooling --out . --force", &["is the folder that you are in, or holds it"]),
    (
        "run cooling --set engine.impact_parameter.table=binary.toml",
        &["binary.toml is not UTF-8 text; a table is"],
    ),
    ("run cooling --set engine.impact_parameter.table=folder", &["folder cannot be read: Is a directory"]),
    (
        "run cooling --set engine.impact_parameter.table=/dev/zero",
        &["larger than 1 MiB; a table is a short text"],
    ),
    (
        "run cooling --set engine.impact_parameter.table=none",
        &["none cannot be read", "`grainflow calibrate` writes"],
    ),
    (
        "run cooling --set engine.impact_parameter.table=empty.toml",
        &["has no column `collisions_per_particle`"],
    ),
    (
        "compare noise.mcap empty.toml",
        &["noise.mcap is not an MCAP file; a run writes its log as `log.mcap`"],
    ),
    ("compare folder folder", &["folder is neither a log nor a run folder"]),
    ("compare noise.mcap", &["noise.mcap alone has nothing to be compared with"]),
    ("calibrate nowhere", &["nowhere: is neither a file nor a built-in scenario"]),
];

const OPTIONS: &[Refusal] = &[
    ("", &["Usage: grainflow <COMMAND>"]),
    ("rum shear", &["unrecognized subcommand 'rum'", "'run'"]),
    ("run", &["<SCENARIO>"]),
    ("check", &["<SCENARIO>"]),
    ("run shear extra", &["unexpected argument 'extra'"]),
    ("run shear --engin dsmc", &["unexpected argument '--engin'", "'--engine'"]),
    ("run shear --engine hsmcc", &["--engine 'hsmcc'", "did you mean `hsmc`?"]),
    ("run shear --engine ''", &["choose one of \"dsmc\", \"cba\", \"hsmc\", \"event-driven\""]),
    ("run shear --engine dsmc --engine cba", &["--engine", "cannot be used multiple times"]),
    ("run shear --seed 1.5", &["'1.5' for '--seed <N>'"]),
    ("run shear --seed -1", &["'-1' for '--seed <N>'"]),
    ("run shear --seed 9223372036854775808", &["--seed 9223372036854775808", "0 to 9223372036854775807"]),
    ("run shear --seed 1 --seed 2", &["cannot be used multiple times"]),
    ("run shear --threads 0", &["'0' for '--threads <N>': 0 is not in 1..=65535"]),
    ("run shear --threads -2", &["-2 is not in 1..=65535"]),
    ("run shear --threads 70000", &["70000 is not in 1..=65535"]),
    ("run shear --threads two", &["'two' for '--threads <N>'"]),
    ("run shear --out ''", &["a value is required for '--out <DIR>'"]),
    (
        "run shear --seed 2 --set seed=1",
        &["--set #1 'seed=1': seed: is also set by --seed; leave one of them out"],
    ),
    ("check shear --engine dsmc --set engine.kind=cba", &["engine.kind: is also set by --engine"]),
    ("scenarios show", &["<NAME>"]),
    ("scenarios show heep", &["did you mean `heap`?"]),
    ("scenarios sho", &["'show'"]),
    ("calibrate shear --replicas 0", &["0 is not in 1..=10000"]),
    ("compare shear --engines hsmc", &["`hsmc` alone has nothing to be compared with; name two or more"]),
    ("compare shear --engines hsmc,hsmc", &["names `hsmc` twice; name each engine once"]),
    ("compare shear --engines hsmc,hsmcc", &["--engines 'hsmcc'", "did you mean `hsmc`?"]),
    ("compare shear --measures energi", &["--measures energi", "did you mean `energy`?"]),
    (
        "compare noise.mcap noise.mcap --engines cba,hsmc",
        &["--engines: belongs to a scenario", "leave it out"],
    ),
];

const SETS: &[Refusal] = &[
    ("run shear --set", &["a value is required for '--set <KEY=VALUE>'"]),
    ("run shear --set restitution", &["--set #1 'restitution': has no `=`; write key.path=value"]),
    ("run shear --set =3", &["`` is not a key; write names joined by dots, such as engine.kind"]),
    ("run shear --set a..b=3", &["is not a key"]),
    ("run shear --set seed=", &["seed: must be a whole number, not the text \"\""]),
    ("run shear --set 'particles.count=[1'", &["must be a whole number, not the text \"[1\""]),
    ("run shear --set particles.count=5e9", &["5e9 must be a whole number; write 5000000000"]),
    (
        "run shear --set particles.count=5000000000",
        &["out of bounds; give a whole number from 0 to 4000000000"],
    ),
    ("run shear --set particles.count=99999999999999999999", &["particles.count"]),
    ("run shear --set particles.restitution=nan", &["NaN is not a finite number; give a finite one"]),
    ("run shear --set particles.restitution=-inf", &["-inf is not a finite number"]),
    ("run shear --set particles.restitution=1.5", &["1.5 is out of bounds; give a number from 0 to 1"]),
    ("run shear --set particles.restituton=0.5", &["did you mean `restitution`?"]),
    ("run shear --set engin.kind=cba", &["did you mean `engine`?"]),
    ("run shear --set particles.mass=0", &["0 is out of bounds; give a number above 0"]),
    ("run shear --set run.time=-1", &["-1 is out of bounds; give a number above 0"]),
    ("run shear --set 'domain.size[5]=3'", &["there is no component 5; the list has 2, counted from 0"]),
    (
        "run shear --set 'particles.species[0].share=2'",
        &["one value of a list of tables cannot be set alone; set the list, as in particles.species=[{"],
    ),
    (
        "run shear --set boundary.y.lower.wall=smooth",
        &[
            "--set #1",
            "boundary.y.lower.velocity",
            "a wall of this kind has none: it has wall and restitution",
        ],
    ),
    ("run shear --set 'domain.size[-1]=3'", &["is not a component; write domain.size[0] for the first"]),
    ("run shear --set domain=3", &["domain: must be a table, not the number 3; write [domain]"]),
    ("run shear --set dimension=4", &["4 is out of bounds; give 2 (disks) or 3 (spheres)"]),
    ("run shear --set gravity=[0,0,-1]", &["has 3 entries; this dimension asks for 2 numbers"]),
    ("run shear --set record.measures=energy", &["must be a list of names", "write [\"energy\"]"]),
    (
        "run shear --set 'record.measures=[\"energi\"]'",
        &["\"energi\" is not a measure; did you mean `energy`?"],
    ),
    ("run heap --set gravity=[0,0]", &["gravity"]),
    (
        "run cooling --engine cba --set engine.time_step.fixed=1e6",
        &["a grain would collide", "2 times is the most; give at most 1.11"],
    ),
    (
        "run cooling --engine event-driven --set particles.count=1 --set run.steps=5",
        &["event-driven has no steps, so it would never end; give run.time"],
    ),
    (
        "run cooling --set seed=2 --set particles.count=1",
        &[
            "--set #2 'particles.count=1': run.collisions_per_particle: a single grain never collides; give run.time",
        ],
    ),
    ("run heap --set boundary.y.upper=0", &["boundary.y.upper"]),
];

const VARIATIONS: &[Refusal] = &[
    ("sweep shear", &["nothing varies; give --vary key=[a, b, c]"]),
    ("sweep shear --vary x", &["--vary #1 'x': `x` has no `=`; write key=[a, b, c]"]),
    ("sweep shear --vary ''", &["has no `=`"]),
    ("sweep shear --vary ' + '", &["has no `=`"]),
    ("sweep shear --vary 'a='", &["is no list of values; write key=[a, b, c]"]),
    ("sweep shear --vary 'a=[]'", &["`a` has no values"]),
    ("sweep shear --vary 'a=[1,,2]'", &["value 2 of the list is missing"]),
    ("sweep shear --vary 'a=[1,2'", &["--vary #1"]),
    (
        "sweep shear --vary 'particles.restitution=[0.9,1.9]'",
        &["1.9 is out of bounds; give a number from 0 to 1"],
    ),
    ("sweep shear --vary 'particles.restitution=[nan,0.5]'", &["NaN is not a finite number"]),
    ("sweep shear --vary 'particles.restituton=[0.5,0.6]'", &["did you mean `restitution`?"]),
    (
        "sweep shear --vary 'a=[1,1]'",
        &["value 2 is value 1 again (1); leave it out, or repeat with --replicas"],
    ),
    (
        "sweep cooling --vary 'particles.count=[1,2]'",
        &["--vary #1 'particles.count=1': run.collisions_per_particle: a single grain never collides"],
    ),
    ("sweep shear --vary 'a=[0.9,0.90]'", &["value 2 is value 1 again (0.90)"]),
    ("sweep shear --vary 'a=linear(0,1)'", &["(0,1) is no range", "a count from 2 to 1000"]),
    ("sweep shear --vary 'a=linear(0,1,1e9)'", &["a count from 2 to 1000"]),
    ("sweep shear --vary 'a=log(0,1,3)'", &["needs ends of the same sign, not 0; use linear(0,1,3)"]),
    ("sweep shear --vary 'a=[1,2] + b=[1]'", &["keys that move together need equally many"]),
    ("sweep shear --vary 'seed=[1,2]' --vary 'seed=[3,4]'", &["`seed` is varied twice; name each key once"]),
    ("sweep shear --vary 'seed=[1,2]' --seed 3", &["`seed` is also set by --seed; leave one of them out"]),
    ("sweep shear --replicas 0", &["0 is not in 1..=10000"]),
    ("sweep shear --engines hsmc,hsmc", &["engine 2 is `hsmc` again; name each once"]),
    ("sweep shear --engines hsmc,cbaa", &["--engines 'cbaa'", "did you mean `cba`?"]),
    ("sweep shear --replicas 2 --figure heap_slop", &["--figure 'heap_slop'"]),
];

fn assert_refused(refusals: &[Refusal]) {
    let place = Place::new();
    fs::write(place.path("binary.toml"), [0xff, 0xfe, 0]).unwrap();
    fs::write(place.path("empty.toml"), "").unwrap();
    fs::write(place.path("huge.toml"), vec![b'#'; (1 << 20) + 1]).unwrap();
    fs::write(place.path("noise.mcap"), [7; 3000]).unwrap();
    fs::create_dir(place.path("folder")).unwrap();
    fs::write(place.path("folder/notes.txt"), "mine").unwrap();
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/format-1/hsmc-2d.mcap");
    fs::write(place.path("cut.mcap"), &fs::read(golden).unwrap()[..7000]).unwrap();
    let names = || -> BTreeSet<_> {
        fs::read_dir(place.folder()).unwrap().map(|entry| entry.unwrap().file_name()).collect()
    };
    let before = names();
    let mut failures = Vec::new();
    for (arguments, words) in refusals {
        let said = place.shell(&format!("exec timeout 60 \"$G\" {arguments}"));
        let lacking = words.iter().find(|word| !said.error.contains(**word));
        if said.code != Some(2) || !said.text.is_empty() || lacking.is_some() || names() != before {
            failures.push(format!("{arguments}: {said:?} lacks {lacking:?}, leaves {:?}", names()));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn files_that_are_none_are_refused() {
    assert_refused(FILES);
}

#[test]
fn wrong_options_are_refused() {
    assert_refused(OPTIONS);
}

#[test]
fn wrong_values_of_set_are_refused() {
    assert_refused(SETS);
}

#[test]
fn wrong_variations_are_refused() {
    assert_refused(VARIATIONS);
}

/// Nothing that a scenario file is refused for gets in through `--set`: every table and key goes through one reader.
#[test]
fn an_option_is_checked_like_a_file() {
    let place = Place::new();
    let shear = place.grainflow(&["scenarios", "show", "shear"]).text;
    for (key, value) in [("mass", "-1"), ("restitution", "inf"), ("count", "1.5"), ("diameter", "true")] {
        let mut lines: Vec<String> = shear.lines().map(str::to_owned).collect();
        lines.retain(|line| {
            !(line.starts_with(&format!("{key} =")) || key == "count" && line.starts_with("volume_f"))
        });
        let particles = lines.iter().position(|line| line == "[particles]").unwrap();
        lines.insert(particles + 1, format!("{key} = {value}"));
        fs::write(place.path("wrong.toml"), lines.join("\n")).unwrap();
        let after_the_place =
            |error: &str| error.split_once(&format!("particles.{key}: ")).unwrap().1.to_owned();
        let in_file = place.grainflow(&["check", "wrong.toml"]);
        let in_set = place.grainflow(&["check", "shear", "--set", &format!("particles.{key}={value}")]);
        in_file.failed(2, &["wrong.toml:", key]);
        in_set.failed(2, &["--set #1", key]);
        assert_eq!(after_the_place(&in_file.error), after_the_place(&in_set.error));
    }
}
