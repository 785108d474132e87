//! The rules of the house that no compiler knows: floors, useful absences, sizes, names.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// The floors, lowest first, with their modules in the order of `src/lib.rs`.
const FLOORS: [(&str, &[&str]); 8] = [
    ("mathematics", &["number", "random", "space", "statistics"]),
    ("matter", &["matter"]),
    ("laws", &["law"]),
    ("engines", &["engine"]),
    ("observation", &["observe", "record"]),
    (
        "runs",
        &[
            "comparison",
            "export",
            "machine",
            "placing",
            "replay",
            "report",
            "run",
            "scenario",
            "simulation",
            "stopwatch",
            "view",
        ],
    ),
    ("campaigns", &["campaign"]),
    ("command line", &["cli"]),
];
/// Floors up to this one do no input or output, read no clock and know no serialisation.
const ENGINES: usize = 3;
/// Up to this one, 2D and 3D differ in `space` alone.
const OBSERVATION: usize = 4;

const LONGEST_FILE: usize = 500;
const LONGEST_FUNCTION: usize = 60;

/// A source file: where it stands from the root of the project, and its text.
struct Source {
    path: String,
    text: String,
}

impl Source {
    /// Its lines, numbered from 1, without comments and doc comments.
    fn code(&self) -> impl Iterator<Item = (usize, &str)> {
        self.text.lines().enumerate().filter_map(|(k, line)| {
            let code = match line.find("//") {
                // A `//` behind a quotation mark may be part of an address.
                Some(at) if !line[..at].contains('"') => &line[..at],
                _ => line,
            };
            (!code.trim().is_empty()).then_some((k + 1, code))
        })
    }

    /// The first module of its path inside `src`; nothing for `lib.rs` and `main.rs`.
    fn module(&self) -> Option<&str> {
        let first = self.path.strip_prefix("src/")?.split('/').next()?;
        Some(first.trim_end_matches(".rs")).filter(|module| !["lib", "main"].contains(module))
    }

    fn floor(&self) -> Option<usize> {
        self.module().map(|module| floor_of(module).unwrap_or_else(|| panic!("no floor for {}", self.path)))
    }
}

fn floor_of(module: &str) -> Option<usize> {
    FLOORS.iter().position(|(_, modules)| modules.contains(&module))
}

/// All Rust files below `folder` of the project, in the order of their paths.
fn sources(folder: &str) -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut folders = vec![root.join(folder)];
    let mut paths: Vec<PathBuf> = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                paths.push(path);
            }
        }
    }
    paths.sort();
    assert!(!paths.is_empty());
    let source = |path: PathBuf| Source {
        path: path.strip_prefix(root).unwrap().to_string_lossy().replace('\\', "/"),
        text: fs::read_to_string(&path).unwrap(),
    };
    paths.into_iter().map(source).collect()
}

/// Asserts that `complaint` has nothing to say of any line of code of the given files.
fn assert_none(files: &[Source], rule: &str, complaint: impl Fn(&Source, &str) -> Option<String>) {
    let mut complaints = String::new();
    for file in files {
        for (number, line) in file.code() {
            if let Some(complaint) = complaint(file, line) {
                writeln!(complaints, "{}:{number}: {complaint}: {}", file.path, line.trim()).unwrap();
            }
        }
    }
    assert!(complaints.is_empty(), "{rule}\n{complaints}");
}

/// The word among `words` that stands in `line` with no letter or digit before or behind it.
fn word_in<'a>(line: &str, words: &[&'a str]) -> Option<&'a str> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    words.iter().copied().find(|word| {
        line.match_indices(word).any(|(at, _)| {
            !line[..at].chars().next_back().is_some_and(is_part)
                && !line[at + word.len()..].chars().next().is_some_and(is_part)
        })
    })
}

/// Modules that a line names as `crate::module`.
fn modules_used(line: &str) -> impl Iterator<Item = &str> {
    line.match_indices("crate::").map(|(at, name)| {
        let rest = &line[at + name.len()..];
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        &rest[..end]
    })
}

#[test]
fn a_module_uses_only_its_own_floor_and_those_below() {
    assert_none(&sources("src"), "name modules as crate::module, from lower floors", |file, line| {
        let floor = file.floor()?;
        modules_used(line).find_map(|used| match floor_of(used) {
            Some(other) if other <= floor => None,
            Some(other) => Some(format!("{} use {}", FLOORS[floor].0, FLOORS[other].0)),
            None => Some(format!("`{used}` has no floor; name its module")),
        })
    });
}

#[test]
fn the_floors_are_those_of_the_library() {
    let library = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs")).unwrap();
    let declared: Vec<&str> =
        library.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    let listed: Vec<&str> = FLOORS.iter().flat_map(|(_, modules)| modules.iter().copied()).collect();
    assert_eq!(declared, listed);
}

#[test]
fn the_lower_floors_touch_nothing_outside() {
    let outside = ["fs", "io", "time", "env", "net", "process"].map(|module| format!("std::{module}"));
    assert_none(&sources("src"), "floors up to the engines only compute", |file, line| {
        let found = outside.iter().find(|path| line.contains(path.as_str())).map(String::as_str);
        let found = found.or_else(|| word_in(line, &["serde", "serde_json", "prost", "mcap", "toml_edit"]));
        found.filter(|_| file.floor().is_some_and(|floor| floor <= ENGINES)).map(str::to_owned)
    });
}

#[test]
fn two_and_three_dimensions_differ_in_space_alone() {
    let forks = ["DIMENSION ==", "DIMENSION !=", "DIMENSION <", "DIMENSION >", "dimension == "];
    assert_none(&sources("src"), "what depends on the dimension belongs to space.rs", |file, line| {
        let lower = file.floor().is_some_and(|floor| floor <= OBSERVATION) && file.module() != Some("space");
        forks.iter().find(|fork| lower && line.contains(*fork)).map(|fork| (*fork).to_owned())
    });
}

#[test]
fn only_the_stopwatch_reads_the_clock() {
    assert_none(&sources("src"), "time is asked for in stopwatch.rs alone", |file, line| {
        word_in(line, &["Instant", "SystemTime", "std::time"])
            .filter(|_| file.path != "src/stopwatch.rs")
            .map(str::to_owned)
    });
}

#[test]
fn only_the_command_line_prints() {
    assert_none(&sources("src"), "only src/cli prints", |file, line| {
        word_in(line, &["print!", "println!", "eprint!", "eprintln!", "dbg!"])
            .or_else(|| ["print!(", "println!("].into_iter().find(|call| line.contains(call)))
            .filter(|_| file.module() != Some("cli"))
            .map(str::to_owned)
    });
}

#[test]
fn nothing_depends_on_the_order_of_a_hash() {
    assert_none(&sources("src"), "use BTreeMap, BTreeSet or a sorted list", |_, line| {
        word_in(line, &["HashMap", "HashSet"]).map(str::to_owned)
    });
}

#[test]
fn nothing_is_left_for_later() {
    let files: Vec<Source> = ["src", "tests"].into_iter().flat_map(sources).collect();
    let later = [concat!("TO", "DO"), concat!("FIX", "ME"), concat!("XX", "X")];
    for file in &files {
        for (k, line) in file.text.lines().enumerate() {
            assert_eq!(word_in(line, &later), None, "{}:{}: do it or drop it", file.path, k + 1);
        }
    }
    assert_none(&files, "an ignored test says which command runs it", |_, line| {
        let reason = line.trim().strip_prefix(concat!("#[ign", "ore"))?;
        (!reason.contains("cargo test")).then(|| "no command".to_owned())
    });
}

/// Name of the function below an attribute.
fn function_below<'a>(mut lines: impl Iterator<Item = &'a str>) -> &'a str {
    lines.find_map(|line| line.trim().strip_prefix("fn ")?.split('(').next()).unwrap_or_default()
}

/// Whether a line of `scripts` runs the ignored test `name`: all ignored ones of its `target`, or those with such a name.
fn runs_ignored(scripts: &str, target: &str, name: &str) -> bool {
    let call = format!("{target} -- --ignored");
    scripts.lines().filter_map(|line| Some(line.split_once(&call)?.1)).any(|words| {
        let mut filters = words.split_whitespace().filter(|word| !word.starts_with("--")).peekable();
        filters.peek().is_none() || filters.any(|filter| name.contains(filter))
    })
}

#[test]
fn a_job_runs_every_ignored_test() {
    let place = Path::new(env!("CARGO_MANIFEST_DIR")).join(".ci");
    let scripts = ["run", "full"].map(|name| fs::read_to_string(place.join(name)).unwrap()).concat();
    let mut found = 0;
    for file in ["src", "tests"].into_iter().flat_map(sources) {
        let target = match file.path.strip_prefix("tests/") {
            Some(rest) => format!("--test {}", rest.split(['/', '.']).next().unwrap()),
            None => "--lib".to_owned(),
        };
        let mut lines = file.text.lines();
        while let Some(line) = lines.next() {
            if line.trim().starts_with(concat!("#[ign", "ore")) {
                let name = function_below(lines.clone());
                assert!(
                    runs_ignored(&scripts, &target, name),
                    "{}: {name}: `cargo test --release {target} -- --ignored {name}` belongs in .ci/full or .ci/run",
                    file.path
                );
                found += 1;
            }
        }
    }
    assert!(found > 10, "{found} ignored tests: the counter has lost its way");
}

#[test]
fn files_are_short_and_named_by_their_subject() {
    for file in ["src", "tests"].into_iter().flat_map(sources) {
        let lines = file.text.lines().count();
        assert!(lines <= LONGEST_FILE, "{} has {lines} lines, more than {LONGEST_FILE}", file.path);
        for part in file.path.split(['/', '.', '_']) {
            assert!(
                !["util", "utils", "common", "helper", "helpers", "misc"].contains(&part),
                "{}",
                file.path
            );
        }
    }
}

/// Name, first line and length of every function: from `fn` to the brace in the column where it began.
fn functions(file: &Source) -> Vec<(String, usize, usize)> {
    let lines: Vec<&str> = file.text.lines().collect();
    let indent = |line: &str| line.len() - line.trim_start().len();
    let mut functions = Vec::new();
    for (k, line) in lines.iter().enumerate() {
        let Some(at) = line.find("fn ") else { continue };
        let before = line[..at].trim();
        let words = ["", "pub", "const", "async", "unsafe", "extern"];
        let is_head = before.split_whitespace().all(|word| words.contains(&word) || word.starts_with("pub("))
            || before.starts_with("pub(in ");
        if !is_head || line.trim_end().ends_with(';') {
            continue;
        }
        let name = line[at + 3..].split(['(', '<']).next().unwrap_or_default();
        let end = (k..lines.len()).find(|&end| {
            let closes = lines[end].trim() == "}" && indent(lines[end]) == indent(line);
            let one_line = end == k && line.trim_end().ends_with('}');
            // A declaration without a body ends with a semicolon.
            closes || one_line || (lines[end].trim_end().ends_with(';') && indent(lines[end]) == indent(line))
        });
        functions.push((name.to_owned(), k + 1, end.unwrap_or(lines.len() - 1) - k + 1));
    }
    functions
}

#[test]
fn functions_are_short() {
    let mut found = 0;
    let mut complaints = String::new();
    for file in ["src", "tests"].into_iter().flat_map(sources) {
        for (name, line, length) in functions(&file) {
            found += 1;
            if length > LONGEST_FUNCTION {
                writeln!(complaints, "{}:{line}: {name} has {length} lines", file.path).unwrap();
            }
        }
    }
    assert!(found > 500, "{found} functions: the counter has lost its way");
    assert!(complaints.is_empty(), "functions have at most {LONGEST_FUNCTION} lines\n{complaints}");
}

/// Licences that let a program which is built of such parts be passed on.
const LICENCES: [&str; 8] =
    ["MIT", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "Zlib", "Unlicense", "Unicode-3.0", "0BSD"];

/// Whether one of the choices of every part of a licence expression is among [`LICENCES`].
fn may_be_passed_on(expression: &str) -> bool {
    let expression = expression.replace(['(', ')'], "").replace('/', " OR ");
    expression.split(" AND ").all(|part| part.split(" OR ").any(|choice| LICENCES.contains(&choice.trim())))
}

/// What cargo says when it is called with `arguments` for this project.
fn cargo(arguments: &[&str]) -> String {
    let mut cargo = std::process::Command::new(env!("CARGO"));
    let output = cargo.args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The packages that `Cargo.lock` names and `choice` leaves, as cargo describes them.
fn packages(choice: &[&str]) -> Vec<serde_json::Value> {
    let words = [&["metadata", "--format-version", "1", "--locked"], choice].concat();
    let mut metadata: serde_json::Value = serde_json::from_str(&cargo(&words)).unwrap();
    serde_json::from_value(metadata["packages"].take()).unwrap()
}

/// Asserts that all packages have a licence to be passed on and need no newer compiler than ours does.
fn assert_free_and_old_enough(packages: &[serde_json::Value]) {
    let version = |text: &str| -> Vec<u32> { text.split('.').map(|part| part.parse().unwrap()).collect() };
    let ours = packages.iter().find(|package| package["name"] == "grainflow").unwrap();
    let oldest = version(ours["rust_version"].as_str().unwrap());
    for package in packages {
        let (name, licence) = (&package["name"], package["license"].as_str().unwrap_or_default());
        assert!(may_be_passed_on(licence), "{name} has the licence {licence:?}");
        let needs = package["rust_version"].as_str().map(version);
        assert!(needs.as_ref().is_none_or(|needs| *needs <= oldest), "{name} needs Rust {needs:?}");
    }
}

#[test]
fn a_licence_may_be_chosen_where_there_is_a_choice() {
    assert!(may_be_passed_on("(MIT OR GPL-3.0) AND Unicode-3.0") && may_be_passed_on("Unlicense/MIT"));
    assert!(!may_be_passed_on("MIT AND GPL-3.0") && !may_be_passed_on("LGPL-2.1-or-later"));
}

/// Those of this platform, which a build has downloaded: cargo needs no network for them.
#[test]
fn dependencies_are_free_locked_and_old_enough() {
    let about = cargo(&["--version", "--verbose"]);
    let host = about.lines().find_map(|line| line.strip_prefix("host: ")).unwrap();
    let packages = packages(&["--offline", "--filter-platform", host]);
    assert!(packages.len() > 50);
    assert_free_and_old_enough(&packages);
}

#[test]
#[ignore = "needs the network for crates of other platforms: cargo test --release --test tidy -- --ignored"]
fn dependencies_of_every_platform_are_free_locked_and_old_enough() {
    let lock = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.lock")).unwrap();
    let packages = packages(&[]);
    assert_eq!(packages.len(), lock.lines().filter(|line| *line == "[[package]]").count());
    assert_free_and_old_enough(&packages);
}

#[test]
fn the_rules_see_what_breaks_them() {
    let file = |path: &str, text: &str| Source { path: path.to_owned(), text: text.to_owned() };
    assert_eq!(file("src/law/boundary.rs", "").floor(), Some(2));
    assert_eq!(file("src/stopwatch.rs", "").floor(), Some(5));
    assert_eq!(modules_used("use crate::engine::{A, B}; // crate").collect::<Vec<_>>(), ["engine"]);
    assert_eq!(word_in("let m: HashMap<u8, u8>;", &["HashMap"]), Some("HashMap"));
    assert_eq!(word_in("MyHashMapped", &["HashMap"]), None);
    let script =
        "cargo test --release --test a -- --ignored --nocapture long\ncargo test --test b -- --ignored";
    assert!(runs_ignored(script, "--test a", "a_long_run") && runs_ignored(script, "--test b", "any"));
    assert!(!runs_ignored(script, "--test a", "a_short_run") && !runs_ignored(script, "--lib", "any"));
    let code = file("src/space.rs", "a\n// b\nc // d\n\"http://e\"\n");
    assert_eq!(code.code().collect::<Vec<_>>(), [(1, "a"), (3, "c "), (4, "\"http://e\"")]);
    let text =
        "fn a() {\n    let b = 1;\n}\n\nimpl C {\n    pub(crate) fn d(\n        &self,\n    ) {\n    }\n}\n";
    let expected = [("a".to_owned(), 1, 3), ("d".to_owned(), 6, 4)];
    assert_eq!(functions(&file("src/space.rs", text)), expected);
}
