//! Stored runs, each named by its log or its folder, as entries of a comparison.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use toml_edit::{DocumentMut, Item, Table};

use super::assemble::{Entry, Head, Replica};
use crate::record::LOG;
use crate::record::contents::RunLog;
use crate::record::error::LogError;
use crate::record::reader::read_log;
use crate::record::summary::{SummaryError, failure, summary_beside};
use crate::scenario::{Overrides, parse};

/// What logs must have in common: key of the metadata, and its name in a message.
const SHARED: [(&str, &str); 5] = [
    ("scenario", "scenario"),
    ("dimension", "dimension"),
    ("unit_length", "unit of length"),
    ("unit_mass", "unit of mass"),
    ("unit_time", "unit of time"),
];

/// Why logs cannot be compared.
#[derive(Debug, thiserror::Error)]
pub enum LogsError {
    /// Nothing to compare with.
    #[error("{} alone has nothing to be compared with; name two or more logs or run folders, or a scenario", .0.display())]
    Alone(PathBuf),
    /// A scenario among logs.
    #[error("{} is neither a log nor a run folder; compare takes one scenario, or two or more logs or run folders", .0.display())]
    NotALog(PathBuf),
    /// A log cannot be read.
    #[error(transparent)]
    Log(#[from] LogError),
    /// A summary beside a log is broken.
    #[error("{0}; take it away, and the log is compared without figures")]
    Summary(#[from] SummaryError),
    /// A log without a proper seed.
    #[error(
        "{}: the seed in its metadata is `{found}`, no whole number from 0 to 18446744073709551615; copy the log again from \
         where it came from", path.display()
    )]
    Seed {
        /// The log.
        path: PathBuf,
        /// What stands there.
        found: String,
    },
    /// Logs that do not belong together.
    #[error("{}: its {what} is `{own}`, and that of {} is `{other}`; compare runs of one scenario", path.display(), first.display())]
    Unlike {
        /// The log.
        path: PathBuf,
        /// The first log.
        first: PathBuf,
        /// What differs.
        what: &'static str,
        /// Its own.
        own: String,
        /// That of the first log.
        other: String,
    },
}

/// Reads the runs at `paths`. The scenarios' values may differ where their name, dimension and units do not;
/// each value that does becomes a remark.
pub fn read(paths: &[PathBuf]) -> Result<(Head, Vec<Entry>), LogsError> {
    if let [path] = paths {
        return Err(LogsError::Alone(path.clone()));
    }
    let mut entries: Vec<Entry> = Vec::new();
    for path in paths {
        let entry = entry(path)?;
        if let Some(first) = entries.first() {
            check_alike([&paths[0], path], [&first.runs[0].log, &entry.runs[0].log])?;
        }
        entries.push(entry);
    }
    let is_new = |k: usize| entries[..k].iter().all(|other| other.engine != entries[k].engine);
    if (0..entries.len()).all(is_new) {
        entries.iter_mut().for_each(|one| one.label.clone_from(&one.engine));
    }
    let mut head = Head { replicas: 1, ..Head::default() };
    if let Some(first) = entries.first() {
        let log = &first.runs[0].log;
        head.scenario_text.clone_from(&log.scenario);
        head.seed = seed(&paths[0], log)?;
        head.remarks = entries[1..].iter().flat_map(|other| unlike(first, other)).collect();
    }
    for (path, entry) in paths.iter().zip(&entries) {
        head.remarks.extend(unread(path, &entry.runs[0].log));
        let cut_off = entry.runs[0].log.cut_off.as_ref();
        head.remarks.extend(cut_off.map(|missing| format!("{}: {missing}", path.display())));
    }
    Ok((head, entries))
}

/// The seed that the log at `path` names.
fn seed(path: &Path, log: &RunLog) -> Result<u64, LogsError> {
    let found = log.metadata.get("seed").map_or("", String::as_str);
    found.parse().map_err(|_| LogsError::Seed { path: path.to_owned(), found: found.to_owned() })
}

fn entry(path: &Path) -> Result<Entry, LogsError> {
    let file = log_of(path)?;
    let log = read_log(&file)?;
    let engine = log.metadata.get("engine").cloned().unwrap_or_default();
    // A log of another version may hold a scenario that this one does not take: see `unread`.
    let diameter = parse("log", &log.scenario, &Overrides::default()).map_or(1.0, |one| one.diameter());
    let summary = summary_beside(&file)?;
    let folder = path.display().to_string();
    let failure = summary.as_ref().and_then(failure).map(failed);
    // Figures of a run that has no end are not those of its scenario.
    let summary = summary.filter(|_| failure.is_none());
    let run = Replica { number: 1, folder: folder.clone(), log, summary };
    let failures = failure.into_iter().collect();
    Ok(Entry { label: folder, engine, runs: vec![run], failures, was_alone: true, diameter })
}

/// What is compared of a run that failed, and `why` it did.
fn failed(why: &str) -> String {
    let why = why.lines().next().unwrap_or_default();
    format!("the run failed ({why}); its recordings are compared as far as they go, its figures are not")
}

/// A remark where the scenario of a log cannot be read: its grains are then drawn with a diameter that nobody gave.
fn unread(path: &Path, log: &RunLog) -> Option<String> {
    let error = parse("log", &log.scenario, &Overrides::default()).err()?;
    let mistakes = error.to_string().replace('\n', " ");
    Some(format!(
        "{}: its scenario cannot be read ({}), so that its grains are drawn with a diameter of 1.",
        path.display(),
        mistakes.trim()
    ))
}

/// The log that `path` means: itself, or the one of a run folder.
fn log_of(path: &Path) -> Result<PathBuf, LogsError> {
    if path.extension().is_some_and(|ending| ending == "toml") {
        return Err(LogsError::NotALog(path.to_owned()));
    }
    let inside = path.join(LOG);
    match (path.is_dir(), inside.is_file()) {
        (false, _) => Ok(path.to_owned()),
        (true, true) => Ok(inside),
        (true, false) => Err(LogsError::NotALog(path.to_owned())),
    }
}

fn check_alike(paths: [&PathBuf; 2], logs: [&RunLog; 2]) -> Result<(), LogsError> {
    for (key, what) in SHARED {
        let [other, own] = logs.map(|log| log.metadata.get(key).cloned().unwrap_or_default());
        if own != other {
            let [first, path] = paths.map(Clone::clone);
            return Err(LogsError::Unlike { path, first, what, own, other });
        }
    }
    Ok(())
}

/// A remark for every value of the scenario that two runs do not share, but for the engine's own.
fn unlike(first: &Entry, other: &Entry) -> Vec<String> {
    let [of_first, of_other] = [first, other].map(|entry| values(&entry.runs[0].log.scenario));
    let mut keys: Vec<&String> = of_first.keys().chain(of_other.keys()).collect();
    keys.sort();
    keys.dedup();
    let told = |value: Option<&String>| value.map_or_else(|| "not given".to_owned(), Clone::clone);
    let differing = keys.into_iter().filter(|key| of_first.get(*key) != of_other.get(*key));
    differing
        .map(|key| {
            let [a, b] = [of_first.get(key), of_other.get(key)].map(told);
            format!("{key} is {a} in {}, {b} in {}.", first.label, other.label)
        })
        .collect()
}

/// Every value of a scenario by its path; nothing of a text that is no TOML.
fn values(scenario: &str) -> BTreeMap<String, String> {
    let mut all = BTreeMap::new();
    if let Ok(document) = scenario.parse::<DocumentMut>() {
        gather("", document.as_table(), &mut all);
    }
    all
}

fn gather(path: &str, table: &Table, all: &mut BTreeMap<String, String>) {
    for (key, item) in table {
        let key = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        match item {
            Item::Table(inner) => gather(&key, inner, all),
            Item::Value(value) => {
                // Comments and blanks around a value are not part of it.
                let bare = value.clone().decorated("", "").to_string();
                all.insert(key, bare);
            }
            Item::ArrayOfTables(tables) => {
                tables.iter().enumerate().for_each(|(k, inner)| gather(&format!("{key}[{k}]"), inner, all));
            }
            Item::None => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(label: &str, scenario: &str) -> Entry {
        let log = RunLog { scenario: scenario.to_owned(), ..RunLog::default() };
        Entry { label: label.into(), runs: vec![Replica { log, ..Replica::default() }], ..Entry::default() }
    }

    #[test]
    fn a_restitution_that_differs_is_told() {
        let a = entry("a", "[particles]\nrestitution = 0.9 # as in the thesis\ncount = 7\n");
        let b = entry("b", "[particles]\ncount=7\nrestitution=0.898\nmass = 1.0");
        let told = unlike(&a, &b);
        assert_eq!(
            told,
            ["particles.mass is not given in a, 1.0 in b.", "particles.restitution is 0.9 in a, 0.898 in b."]
        );
        assert_eq!(unlike(&a, &a), Vec::<String>::new());
    }

    #[test]
    fn a_seed_that_is_none_is_refused() {
        let log = |seed: &str| RunLog {
            metadata: BTreeMap::from([("seed".to_owned(), seed.to_owned())]),
            ..RunLog::default()
        };
        assert_eq!(seed(Path::new("a"), &log("18446744073709551615")).unwrap(), u64::MAX);
        for wrong in ["", "-1", "7.0", "18446744073709551616"] {
            let error = seed(Path::new("a"), &log(wrong)).unwrap_err().to_string();
            assert!(error.starts_with(&format!("a: the seed in its metadata is `{wrong}`")), "{error}");
        }
    }

    #[test]
    fn logs_of_other_scenarios_are_refused_with_what_differs() {
        let log = |dimension: &str| RunLog {
            metadata: BTreeMap::from([("dimension".to_owned(), dimension.to_owned())]),
            ..RunLog::default()
        };
        let paths = [&PathBuf::from("a"), &PathBuf::from("b")];
        let error = check_alike(paths, [&log("2"), &log("3")]).unwrap_err().to_string();
        assert_eq!(error, "b: its dimension is `3`, and that of a is `2`; compare runs of one scenario");
        assert!(check_alike(paths, [&log("2"), &log("2")]).is_ok());
    }
}
