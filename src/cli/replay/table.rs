//! The measures of a log as tables.

use std::collections::BTreeMap;
use std::path::Path;

use super::{Failure, TableOptions, Work, write_file};
use crate::cli::{Exit, print_text};
use crate::export::target::Target;
use crate::observe::NAMES;
use crate::record::contents::RunLog;
use crate::record::reader::read_tables;
use crate::replay::compute::{Basis, Computed, compute, stored_measures};
use crate::replay::scenario_of;
use crate::replay::tables::{Tables, tables_of};
use crate::scenario::did_you_mean;

impl Work<'_> {
    /// Prints or writes what `options` ask for.
    pub(super) fn tables(&self, options: &TableOptions) -> Result<Exit, Failure> {
        let log = read_tables(self.log)?;
        if let Some(missing) = &log.cut_off {
            eprintln!("note: {missing}");
        }
        let metadata = log.metadata.clone();
        let tables = self.wanted(log, options)?;
        if self.is_part && tables.series.is_empty() && tables.profiles.is_empty() {
            let words = self.selection.words();
            return Err(Failure::Input(format!("there is no recording {words}")));
        }
        if let Some(file) = &options.series {
            write_file(file, &tables.series_text(&metadata), self.force, "--series")?;
        }
        let profiles = tables.profile_texts(&metadata);
        if let Some(folder) = &options.profiles {
            if profiles.is_empty() {
                let words = self.selection.words();
                return Err(Failure::Input(format!("--profiles: there is no profile {words}")));
            }
            write_folder(folder, &profiles, self.force)?;
        }
        if options.series.is_some() || options.profiles.is_some() {
            return Ok(Exit::Done);
        }
        Ok(print_text(&match options.measures {
            Some(_) => all_tables(&tables, &metadata),
            None => tables.series_text(&metadata),
        }))
    }

    /// The tables of the log, or those of measures that were asked for by name.
    fn wanted(&self, log: RunLog, options: &TableOptions) -> Result<Tables, Failure> {
        let Some(names) = &options.measures else { return Ok(tables_of(log, self.selection)) };
        check_names(names)?;
        let scenario = scenario_of(self.log, &log.metadata, &log.scenario)
            .map_err(|unknown| Failure::Input(unknown.to_string()))?;
        let stored = stored_measures(&scenario);
        let is_stored = |name: &String| stored.iter().any(|one| one.0 == name.as_str());
        let missing: Vec<&String> = names.iter().filter(|name| !is_stored(name)).collect();
        match (missing.first(), names.iter().find(|name| is_stored(name))) {
            (None, _) if options.source.is_none() => {
                let columns: Vec<String> = stored
                    .iter()
                    .filter(|one| names.iter().any(|name| name == one.0))
                    .flat_map(|one| one.1.iter().map(|column| column.name.clone()))
                    .collect();
                let mut tables = tables_of(log, self.selection);
                tables.narrow(|name| columns.iter().any(|column| column == name), names);
                Ok(tables)
            }
            (Some(missing), Some(there)) if options.source.is_none() => Err(Failure::Input(format!(
                "--measures: `{there}` stands in the log at every recording, and `{missing}` has to be computed; \
                 ask for them one after the other, or name --source to compute both"
            ))),
            _ => {
                let basis = options.source.map(super::Source::basis);
                let computed = compute(self.log, names, self.selection, basis)?;
                eprintln!("note: {}", told(names, &computed));
                Ok(computed.tables)
            }
        }
    }
}

fn check_names(names: &[String]) -> Result<(), Failure> {
    match names.iter().find(|name| !NAMES.contains(&name.as_str())) {
        Some(name) => {
            let remedy = format!("there are {}", NAMES.join(", "));
            let remedy = did_you_mean(name, NAMES, &remedy);
            Err(Failure::Input(format!("--measures: there is no measure `{name}`; {remedy}")))
        }
        None => Ok(()),
    }
}

/// How measures were computed, in a sentence.
fn told(names: &[String], computed: &Computed) -> String {
    let looks = computed.looks;
    let basis = match (computed.basis, looks) {
        (Basis::States, 1) => "one saved state, at full precision".to_owned(),
        (Basis::States, _) => format!("{looks} saved states, at full precision"),
        (Basis::Frames, 1) => "one frame, at single precision".to_owned(),
        (Basis::Frames, _) => format!("{looks} frames, at single precision"),
    };
    format!("{} computed from {basis}", names.join(", "))
}

/// The series, if it has more than times, and every kind of profile, each with its name above where there are several.
fn all_tables(tables: &Tables, metadata: &BTreeMap<String, String>) -> String {
    let mut all: Vec<(String, String)> = Vec::new();
    if tables.columns.len() > 1 {
        all.push(("series".to_owned(), tables.series_text(metadata)));
    }
    all.extend(tables.profile_texts(metadata));
    match &all[..] {
        [(_, only)] => only.clone(),
        several => {
            let titled = several.iter().map(|(name, text)| format!("# {name}\n{text}"));
            titled.collect::<Vec<_>>().join("\n")
        }
    }
}

fn write_folder(folder: &Path, profiles: &BTreeMap<String, String>, force: bool) -> Result<(), Failure> {
    let target = Target::folder(folder, force, &["csv"], "--profiles")?;
    for (name, text) in profiles {
        let place = target.working().join(format!("{name}.csv"));
        std::fs::write(place, text).map_err(|source| target.failed(source))?;
    }
    println!("wrote {}", target.settle()?.display());
    Ok(())
}
