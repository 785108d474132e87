//! Every wrong file in `tests/scenario_errors/` carries the message that it must produce.

use std::fs;
use std::path::Path;

use grainflow::scenario::{Overrides, load};

#[test]
fn wrong_files_produce_the_messages_they_carry() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenario_errors");
    let mut failures = Vec::new();
    let mut files = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let text = fs::read_to_string(&path).unwrap();
        let expected: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("# expect: ")).collect();
        let name = path.to_string_lossy();
        assert!(!expected.is_empty(), "{name} expects nothing");
        files += 1;
        match load(&name, &Overrides::default()) {
            Ok(_) => failures.push(format!("{name} was accepted")),
            Err(error) => {
                let message = error.to_string();
                let missing = expected.iter().filter(|line| !message.contains(**line));
                failures.extend(missing.map(|line| format!("expected: {line}\nfound: {message}\n")));
                // One fault, one line: a mistake must not drag others behind it.
                if error.mistakes.len() != expected.len() {
                    failures.push(format!(
                        "{} mistakes in place of {}:\n{message}\n",
                        error.mistakes.len(),
                        expected.len()
                    ));
                }
            }
        }
    }
    assert!(files >= 30, "only {files} wrong files");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
