//! Engines that should agree are reported as agreeing, and a small difference of the restitution as one.
//!
//! The logarithm of the energy of N grains walks by γ √(2τ/N) until τ collisions per particle, γ = (1 − r²)/2 (van Noije
//! and Ernst 1998, without the Sonine correction), beside γτ by which it falls.

use serde_json::Value;

use super::place::{Place, code, error, text};

/// A gas like that of `cooling`, of 300² disks: until τ = 20 its energy walks by 0.002, and r = 0.898 in place of 0.900
/// takes 0.036 away.
const GAS: [&str; 14] = [
    "--set",
    "domain.size=[531.7361552716548, 531.7361552716548]",
    "--set",
    "particles.count=90000",
    "--set",
    "initial.equilibrate=3.0",
    "--set",
    "run.collisions_per_particle=20.0",
    "--set",
    "record.spacing='even'",
    "--set",
    "record.frames=100",
    "--set",
    "record.measures=['energy']",
];
/// Ten thousand of them, and the box in which they fill a quarter.
const FEW: [&str; 4] =
    ["--set", "particles.count=10000", "--set", "domain.size=[177.2453850905516, 177.2453850905516]"];
/// A box in which they fill a fiftieth.
const DILUTE: [&str; 4] =
    ["--set", "particles.count=10000", "--set", "domain.size=[626.6570686577501, 626.6570686577501]"];

/// The series `name` over `abscissa` of the second contestant, or of the first where that is the other.
fn difference(found: &Value, name: &str, abscissa: &str) -> Value {
    let series = found["series"].as_array().unwrap().iter();
    let one = series.clone().find(|one| one["name"] == name && one["abscissa"]["name"] == abscissa).unwrap();
    one["differences"].as_array().unwrap().iter().find(|one| !one.is_null()).unwrap().clone()
}

impl Place {
    fn run(&self, out: &str, more: &[&str]) {
        let output = self.grainflow(&[&["run", "cooling", "--quiet", "--out", out], &GAS[..], more].concat());
        assert_eq!(code(&output), 0, "{}", error(&output));
    }

    /// What `comparison.json` holds, and what was said.
    fn compared(&self, arguments: &[&str]) -> (Value, String) {
        let output = self.grainflow(&[&["compare", "--force", "--out", "compared"], arguments].concat());
        assert_eq!(code(&output), 0, "{}", error(&output));
        let json = std::fs::read_to_string(self.path("compared/comparison.json")).unwrap();
        (serde_json::from_str(&json).unwrap(), text(&output))
    }
}

const QUANTITIES: [(&str, &str); 5] = [
    ("kinetic_energy", "time"),
    ("kinetic_energy", "collisions_per_particle"),
    ("temperature", "time"),
    ("temperature", "collisions_per_particle"),
    ("collisions_per_particle", "time"),
];

fn assert_agree(found: &Value) {
    for (name, abscissa) in QUANTITIES {
        let difference = difference(found, name, abscissa);
        assert_eq!(difference["verdict"], "agrees", "{name}: {}", difference["sentence"]);
        assert_eq!(difference["basis"], "growth", "{name}: {}", difference["sentence"]);
    }
}

#[test]
fn restitutions_of_0_900_and_0_898_are_told_apart() {
    let place = Place::with(&[]);
    for (out, restitution, seed) in [("a", "0.9", "1"), ("b", "0.898", "2")] {
        place.run(out, &["--seed", seed, "--set", &format!("particles.restitution={restitution}")]);
    }
    let (found, said) = place.compared(&["a", "b"]);
    let cooled = difference(&found, "temperature", "collisions_per_particle");
    println!("{}", cooled["sentence"]);
    assert_eq!((&cooled["verdict"], &cooled["basis"]), (&Value::from("differs"), &Value::from("growth")));
    let last = |key: &str| cooled[key].as_array().unwrap().last().unwrap().as_f64().unwrap();
    let (value, error) = (last("values"), last("errors"));
    // 0.0944 and 0.0962 per collision, 20 of them; √2 · 0.0944 √(40/90000) = 0.0028, doubled in square.
    assert!((0.0028..0.0056).contains(&error), "{error}");
    assert!((value + 0.0357).abs() < 4.0 * error && -value > 6.0 * error, "{value} ± {error}");
    let sentence = cooled["sentence"].as_str().unwrap();
    assert!(
        sentence.starts_with("b: cools faster than a, temperature ")
            && sentence.contains("standard errors, beyond")
    );
    let parts = cooled["parts_at"].as_f64().unwrap();
    assert!(parts > 0.1 && parts < 15.0, "{parts}");
    assert!(sentence.contains("; apart from collisions per particle "), "{sentence}");
    assert!(said.contains("particles.restitution is 0.9 in a, 0.898 in b."), "{said}");
    assert!(said.contains("Correlation times of b minus a: "), "{said}");
}

#[test]
fn the_same_under_two_seeds_agrees() {
    let place = Place::with(&[]);
    for (out, seed) in [("a", "1"), ("b", "2")] {
        place.run(out, &[&["--engine", "event-driven", "--seed", seed], &FEW[..]].concat());
    }
    let (found, said) = place.compared(&["a", "b"]);
    assert_agree(&found);
    assert!(said.contains("Each engine ran once. Errors of a series come from blocks"), "{said}");
}

#[test]
fn engines_agree_in_a_dilute_gas() {
    let place = Place::with(&[]);
    // From the same grains, with exact dynamics as the reference.
    let engines = ["cooling", "--engines", "hsmc,cba,event-driven", "--replicas", "4"];
    let (found, _) = place.compared(&[&engines[..], &GAS[..], &DILUTE].concat());
    assert_agree(&found);
    // One log of each, from other grains: with the same, these two would be the same to the bit.
    place.run("a", &[&["--engine", "hsmc", "--seed", "1"], &DILUTE[..]].concat());
    place.run("b", &[&["--engine", "cba", "--seed", "2"], &DILUTE[..]].concat());
    assert_agree(&place.compared(&["a", "b"]).0);
}
