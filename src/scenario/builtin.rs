//! The scenarios that come with the program.

use super::suggest::did_you_mean;

/// Name, title and text.
const SCENARIOS: &[(&str, &str, &str)] = &[
    ("shear", "Bagnold shear flow between moving walls", include_str!("../../scenarios/shear.toml")),
    ("pipe", "Density waves in a vertical pipe", include_str!("../../scenarios/pipe.toml")),
    ("heap", "A heap poured onto a plane", include_str!("../../scenarios/heap.toml")),
    ("heap-full", "A heap of 30 500 grains", include_str!("../../scenarios/heap-full.toml")),
    ("cooling", "Cooling of a granular gas (Haff's law)", include_str!("../../scenarios/cooling.toml")),
    ("clustering", "Clusters in a freely cooling gas", include_str!("../../scenarios/clustering.toml")),
    ("correlations", "Correlations in a dissipative gas", include_str!("../../scenarios/correlations.toml")),
    ("sedimentation", "A hundred disks settle in a box", include_str!("../../scenarios/sedimentation.toml")),
    (
        "simic-cooling",
        "Cooling between walls, event by event",
        include_str!("../../scenarios/simic-cooling.toml"),
    ),
    (
        "hard-spheres",
        "Pressure of an elastic hard-sphere fluid",
        include_str!("../../scenarios/hard-spheres.toml"),
    ),
];

/// Name and title of each.
const LIST: [(&str, &str); SCENARIOS.len()] = {
    let mut list = [("", ""); SCENARIOS.len()];
    let mut k = 0;
    while k < SCENARIOS.len() {
        list[k] = (SCENARIOS[k].0, SCENARIOS[k].1);
        k += 1;
    }
    list
};

/// Name and title of every built-in scenario.
pub fn list() -> &'static [(&'static str, &'static str)] {
    &LIST
}

/// What to say where `name` is none of them.
pub fn unknown(name: &str) -> String {
    let names: Vec<&str> = SCENARIOS.iter().map(|(name, _, _)| *name).collect();
    let remedy = did_you_mean(name, names.iter().copied(), &format!("there are {}", names.join(", ")));
    format!("there is no built-in scenario `{name}`; {remedy}")
}

/// The text of the built-in scenario called `name`.
pub fn text(name: &str) -> Option<&'static str> {
    SCENARIOS.iter().find(|(known, _, _)| *known == name).map(|(_, _, text)| *text)
}
