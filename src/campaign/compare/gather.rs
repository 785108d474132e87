//! From runs to a comparison: which logs belong to which engine, and what became of the runs that have none.

use std::path::Path;

use super::CompareError;
use super::plan::Plan;
use super::runs::Run;
use crate::comparison::model::Comparison;
use crate::comparison::{Entry, Head, Replica, assemble};
use crate::record::LOG;
use crate::record::reader::read_log;

/// The comparison of the runs of `plan` that came to their end, in `folder`; with their costs where each ran `alone`.
pub(super) fn of_runs(
    plan: &Plan,
    runs: &[Run],
    folder: &Path,
    alone: bool,
) -> Result<Comparison, CompareError> {
    let mut entries = Vec::new();
    for (place, engine) in plan.engines().enumerate() {
        let own = || runs.iter().filter(move |run| run.contestant == place);
        let mut entry = Entry {
            label: engine.name().to_owned(),
            engine: engine.name().to_owned(),
            runs: Vec::new(),
            failures: own().filter_map(Run::failure).collect(),
            was_alone: alone,
            diameter: plan.diameter(),
        };
        for (run, summary) in own().filter_map(|run| Some((run, run.summary()?))) {
            let mut log = read_log(&folder.join(&run.folder).join(LOG))?;
            if !entry.runs.is_empty() {
                // Pictures are shown of the first alone.
                (log.frames, log.fields) = (Vec::new(), Vec::new());
            }
            let (number, folder) = (run.replica, run.folder.clone());
            entry.runs.push(Replica { number, folder, log, summary: Some(summary.clone()) });
        }
        entries.push(entry);
    }
    let head = Head {
        scenario_text: plan.source_text().to_owned(),
        seed: plan.seed(),
        replicas: plan.replicas(),
        remarks: Vec::new(),
    };
    Ok(assemble(head, entries))
}
