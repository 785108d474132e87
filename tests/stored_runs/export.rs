//! `grainflow export`: files are complete or not there. What other programs read in them is checked in Python.

use std::fs;

use super::{Place, code, error};

const FORMATS: [&str; 5] = ["lammps", "vtp", "vti", "xyz", "csv"];

#[test]
fn every_format_is_written_beside_the_log() {
    let place = Place::with_run(&[]);
    for format in FORMATS {
        place.obeyed(&["export", "run", "--format", format]);
        let said = place.refused(&["export", "run", "--format", format]);
        assert!(said.contains("is there already") && said.contains("--out"), "{said}");
        place.obeyed(&["export", "run", "--format", format, "--force"]);
    }
    let frames = |text: String, what: &str| text.matches(what).count();
    assert_eq!(frames(place.read("run/log.lammpstrj"), "ITEM: TIMESTEP"), 8);
    assert_eq!(frames(place.read("run/log.xyz"), "Lattice="), 8);
    assert_eq!(place.read("run/log.csv").lines().count(), 1 + 8 * 200);
    assert_eq!(frames(place.read("run/log-vtp/particles.pvd"), "<DataSet"), 8);
    assert_eq!(frames(place.read("run/log-vti/fields.pvd"), "<DataSet"), 8);
    assert_eq!(fs::read_dir(place.path("run/log-vtp")).unwrap().count(), 9);
    let hidden = place.names().into_iter().filter(|name| name.contains("partial")).count();
    assert_eq!(hidden, 0);
}

#[test]
fn a_dump_has_a_box_and_columns() {
    let place = Place::with_run(&[
        "boundary.y.lower={ wall = \"smooth\" }",
        "boundary.y.upper={ wall = \"smooth\" }",
    ]);
    place.obeyed(&["export", "run", "--format", "lammps", "--out", "a.lammpstrj", "--every", "4"]);
    let dump = place.read("a.lammpstrj");
    let lines: Vec<&str> = dump.lines().collect();
    assert_eq!(
        lines[..7],
        ["ITEM: UNITS", "lj", "ITEM: TIME", "0.0", "ITEM: TIMESTEP", "0", "ITEM: NUMBER OF ATOMS"]
    );
    assert_eq!((lines[7], lines[8], lines[11]), ("200", "ITEM: BOX BOUNDS pp ff ff", "-0.5 0.5"));
    assert_eq!(lines[12], "ITEM: ATOMS id type x y z vx vy vz radius");
    assert!(lines[13].starts_with("0 1 ") && lines[13].ends_with(" 0.5"), "{}", lines[13]);
    assert_eq!(dump.matches("ITEM: UNITS").count(), 1);
    assert_eq!(dump.matches("ITEM: TIMESTEP\n4\n").count(), 1);
}

#[test]
fn thinned_frames_are_told_and_states_are_whole() {
    let place = Place::with_run(&["record.points=50"]);
    let output = place.grainflow(&["export", "run", "--format", "xyz", "--out", "a.xyz"]);
    let said = error(&output);
    assert!(said.contains("8 of 8 frames are thinned, to 50 of up to 200 grains"), "{said}");
    assert!(place.read("a.xyz").contains("grains=200 remark=\"thinned: 50 of 200 grains\""));
    let output = place.grainflow(&["export", "run", "--format", "xyz", "--out", "b.xyz", "--states"]);
    assert_eq!((code(&output), error(&output)), (0, String::new()));
    assert!(place.read("b.xyz").starts_with("200\n") && !place.read("b.xyz").contains("thinned"));
}

#[test]
fn species_have_their_radii_in_frames_and_states() {
    let place = Place::new();
    let scenario = "dimension = 2\n[engine]\nkind = \"event-driven\"\n[domain]\nsize = [20.0, 20.0]\n\
        [particles]\ncount = 40\nrestitution = 0.9\ntangential_restitution = 0.2\n\
        [[particles.species]]\ndiameter = 1.0\nmass = 1.0\nshare = 0.5\n\
        [[particles.species]]\ndiameter = 1.5\nmass = 2.0\nshare = 0.5\n\
        [initial]\nvelocities = { maxwell = 1.0 }\n[run]\ncollisions_per_particle = 2.0\n[record]\nframes = 2\n";
    fs::write(place.path("mixture.toml"), scenario).unwrap();
    place.obeyed(&["run", "mixture.toml", "--out", "run", "--quiet"]);
    place.obeyed(&["export", "run", "--format", "csv", "--out", "frames.csv"]);
    place.obeyed(&["export", "run", "--format", "csv", "--out", "states.csv", "--states"]);
    let radius = |line: &str, column: usize| {
        let words: Vec<&str> = line.split(',').collect();
        (words[2].to_owned(), words[3].to_owned(), words[column].to_owned())
    };
    let frames = place.read("frames.csv");
    let last: Vec<_> = frames.lines().rev().take(40).map(|line| radius(line, 10)).collect();
    let states = place.read("states.csv");
    assert!(states.starts_with("frame,time,id,species,x,y,z,vx,vy,vz,radius,wx,wy,wz\n"));
    let exact: Vec<_> = states.lines().rev().take(40).map(|line| radius(line, 10)).collect();
    assert_eq!(last, exact);
    let number = |kind: &str, size: &str| last.iter().filter(|one| one.1 == kind && one.2 == size).count();
    assert_eq!((number("1", "0.5"), number("2", "0.75")), (20, 20));
}

#[test]
fn what_cannot_be_exported_is_told_before_anything_is_written() {
    let place = Place::with_run(&[]);
    let said = |more: &[&str]| place.refused(&[&["export", "run"], more].concat());
    assert!(
        said(&["--format", "csv", "--from", "1e9"]).contains("has no frame from t = 1000000000 to the end")
    );
    assert!(said(&["--format", "csv", "--cell-size", "2"]).contains("belongs to --format vti"));
    assert!(said(&["--format", "vti", "--cell-size", "0"]).contains("above 0"));
    assert!(said(&["--format", "vti", "--cell-size", "1e-6"]).contains("more than 16777216 cells"));
    assert!(said(&["--format", "vtk"]).contains("vtp"));
    assert!(place.refused(&["export", "none", "--format", "csv"]).contains("cannot read the log none"));
    fs::write(place.path("run/notes.txt"), "mine").unwrap();
    assert!(said(&["--format", "vtp", "--out", "run", "--force"]).contains("no earlier export"));
    let log = place.path("run/log.mcap");
    let mut bytes = fs::read(&log).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&log, &bytes).unwrap();
    assert!(said(&["--format", "csv"]).contains("damaged"));
}

#[test]
fn a_full_disk_leaves_no_half_file() {
    let place = Place::with_run(&[]);
    let program = assert_cmd::cargo::cargo_bin!("grainflow").display().to_string();
    let before = place.names();
    for format in FORMATS {
        // In blocks of 512 bytes; the signal that tells is ignored.
        let limit = if format == "vti" { 2 } else { 8 };
        let script =
            format!("trap '' XFSZ; ulimit -f {limit}; exec '{program}' export run --format {format}");
        let output = std::process::Command::new("sh")
            .args(["-c", &script])
            .current_dir(place.path("."))
            .output()
            .unwrap();
        let said = error(&output);
        assert_eq!(code(&output), 1, "{format}: {said}");
        assert!(said.contains("cannot write run/log") && said.contains("nothing is left"), "{said}");
        assert_eq!(place.names(), before, "{format}");
    }
}
