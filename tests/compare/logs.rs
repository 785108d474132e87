//! Stored runs side by side.

use super::place::{Place, code, error, text};
use super::stage::{GAS, HEAP};

#[test]
fn logs_and_run_folders_are_compared_as_they_are() {
    let place = Place::with(&[("gas.toml", GAS)]);
    for engine in ["hsmc", "event-driven"] {
        let output = place.grainflow(&["run", "gas.toml", "--engine", engine, "--quiet"]);
        assert_eq!(code(&output), 0, "{}", error(&output));
    }
    let output = place.grainflow(&["compare", "out/gas-hsmc", "out/gas-event-driven/log.mcap"]);
    assert_eq!(code(&output), 0, "{}", error(&output));
    assert!(text(&output).contains("hsmc agrees with event-driven in"), "{}", text(&output));
    super::assert_written(&place.path("out/compare"));
    assert_eq!(
        code(&place.grainflow(&["compare", "out/gas-hsmc", "out/gas-event-driven"])),
        2,
        "it is there already"
    );
}

#[test]
fn what_is_no_log_is_refused() {
    let place = Place::with(&[("gas.toml", GAS), ("heap.toml", HEAP), ("text.mcap", "text")]);
    assert!(place.refused(&["compare", "text.mcap"]).contains("two or more"));
    let said = place.refused(&["compare", "gas.toml", "heap.toml"]);
    assert!(said.contains("gas.toml"), "{said}");
    let said = place.refused(&["compare", "none.mcap", "text.mcap"]);
    assert!(said.contains("none.mcap"), "{said}");
    let said = place.refused(&["compare", "a.mcap", "b.mcap", "--engines", "hsmc,cba"]);
    assert!(said.contains("--engines: belongs to a scenario"), "{said}");
}
