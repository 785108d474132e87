//! Exports and pictures have all grains of the run, in the box of the run.

use std::fs;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use grainflow::record::reader::read_log;

use super::Place;

impl Place {
    /// A place with the run folder `run` of a scenario that stands beside these tests.
    pub(super) fn with_scenario(name: &str, sets: &[&str]) -> Self {
        let place = Place::new();
        let scenario = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(name).display().to_string();
        let mut arguments = vec!["run", scenario.as_str(), "--out", "run", "--quiet", "--threads", "1"];
        for set in sets {
            arguments.extend(["--set", set]);
        }
        place.obeyed(&arguments);
        place
    }

    /// The files of an export of `run`, in the order of their times.
    fn exported(&self, format: &str, more: &[&str], ending: &str) -> Vec<String> {
        let out = format!("{format}{}", more.concat());
        self.obeyed(&[&["export", "run", "--format", format, "--out", &out], more].concat());
        let mut files: Vec<PathBuf> = match self.path(&out).is_dir() {
            true => fs::read_dir(self.path(&out)).unwrap().map(|entry| entry.unwrap().path()).collect(),
            false => vec![self.path(&out)],
        };
        files.retain(|file| {
            file.is_file() && (file == &self.path(&out) || file.extension() == Some(ending.as_ref()))
        });
        files.sort();
        files.iter().map(|file| fs::read_to_string(file).unwrap()).collect()
    }
}

/// The numbers of the array `name` in a file of VTK's.
fn array(text: &str, name: &str) -> Vec<f64> {
    let mut lines = text.lines().skip_while(|line| !line.contains(&format!("Name=\"{name}\"")));
    let is_single = lines.next().unwrap().contains("Float32");
    // Behind eight bytes that say how long it is.
    let bytes = &STANDARD.decode(lines.next().unwrap().trim()).unwrap()[8..];
    match is_single {
        true => {
            bytes.chunks_exact(4).map(|four| f32::from_le_bytes(four.try_into().unwrap()).into()).collect()
        }
        false => bytes.chunks_exact(8).map(|eight| f64::from_le_bytes(eight.try_into().unwrap())).collect(),
    }
}

/// The numbers of an attribute of a file of VTK's.
fn attribute(text: &str, name: &str) -> Vec<f64> {
    let start = text.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
    let end = start + text[start..].find('"').unwrap();
    text[start..end].split(' ').map(|word| word.parse().unwrap()).collect()
}

/// The grains that the number density of an image of a plane adds up to.
fn grains_of(image: &str) -> f64 {
    let spacing = attribute(image, "Spacing");
    array(image, "number_density").iter().sum::<f64>() * spacing[0] * spacing[1]
}

#[test]
fn a_grain_that_rests_on_a_wall_is_in_a_cell_though_its_frame_is_rounded_beyond_the_wall() {
    let place = Place::with_scenario("stored_runs/scenarios/edge.toml", &[]);
    let log = read_log(&place.path("run/log.mcap")).unwrap();
    let last = log.frames.last().unwrap();
    assert!(last.positions.iter().all(|position| f64::from(position[1]) > 0.6), "all of them rest on it");
    for more in [&[][..], &["--states"]] {
        for image in place.exported("vti", more, "vti") {
            assert!((grains_of(&image) - 10.0).abs() < 1e-5, "{more:?}: {}", grains_of(&image));
        }
    }
}

#[test]
fn a_shaken_floor_belongs_to_the_box_of_every_export_and_picture() {
    for engine in ["hsmc", "event-driven"] {
        let engine_kind = format!("engine.kind=\"{engine}\"");
        // Without a cure exact dynamics of these grains collapses.
        let cure = "engine.event_driven.collapse={ elastic_below = 0.3 }";
        let sets = [&engine_kind, cure, "run.time=12", "record.frames=25"];
        let place = Place::with_scenario("python/shaken.toml", &sets);
        let log = read_log(&place.path("run/log.mcap")).unwrap();
        let lowest = log.frames.iter().flat_map(|frame| &frame.positions).map(|p| p[1]).fold(0.0, f32::min);
        assert!(lowest < -1.0, "{engine}: grains follow the floor down, to {lowest}");
        let walls = log.walls.unwrap();
        assert_eq!((walls.lower[1], walls.upper[1]), (-3.0, 20.0), "{engine}");
        for image in place.exported("vti", &[], "vti") {
            assert!((grains_of(&image) - 100.0).abs() < 1e-3, "{engine}: {}", grains_of(&image));
            let (origin, spacing) = (attribute(&image, "Origin")[1], attribute(&image, "Spacing")[1]);
            let cells = attribute(&image, "WholeExtent")[3];
            assert_eq!(origin, -3.0);
            assert!((origin + cells * spacing - 20.0).abs() < 1e-12, "{engine}: {cells} of {spacing}");
        }
        let points = place.exported("vtp", &[], "vtp");
        assert!(points.iter().all(|text| array(text, "Points").len() == 300));
        let dump = place.exported("lammps", &[], "").remove(0);
        assert_eq!(dump.matches("\n100\nITEM: BOX BOUNDS pp ff ff\n0.0 20.0\n-3.0 20.0\n").count(), 26);
        let xyz = place.exported("xyz", &[], "").remove(0);
        assert_eq!(
            xyz.matches("Lattice=\"20.0 0.0 0.0 0.0 23.0 0.0 0.0 0.0 1.0\" Origin=\"0.0 -3.0 -0.5\"").count(),
            26
        );
        assert_eq!(place.exported("csv", &[], "").remove(0).lines().count(), 1 + 26 * 100);
    }
}
