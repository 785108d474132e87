//! `sweep.csv`: one row for every run.

use serde_json::Value;

use super::plan::Plan;
use super::runs::Row;

/// The table: varied keys, engine, replica, seed and status of each run, then every key of the summaries.
pub(super) fn table(plan: &Plan, rows: &[Row]) -> String {
    let keys = summary_keys(rows);
    let head = ["case"].into_iter().chain(plan.paths());
    let head = head.chain(["engine", "replica", "seed", "status", "error"]).map(str::to_owned);
    let mut table = line(head.chain(keys.iter().cloned()));
    for (case, row) in plan.cases.iter().zip(rows) {
        let mut cells = vec![case.name.clone()];
        cells.extend(plan.settings(case).map(|(_, value)| value.to_owned()));
        cells.push(case.scenario.engine().name().to_owned());
        cells.push(case.replica.to_string());
        cells.push(case.scenario.seed().to_string());
        cells.push(row.ended.word().to_owned());
        cells.push(row.ended.error().replace('\n', " "));
        cells.extend(keys.iter().map(|key| row.summary.get(key).map(text).unwrap_or_default()));
        table += &line(cells.into_iter());
    }
    table
}

/// Keys of all summaries in the order in which they appear, without those that every row has anyhow.
fn summary_keys(rows: &[Row]) -> Vec<String> {
    let mut keys: Vec<String> = Vec::new();
    for key in rows.iter().flat_map(|row| row.summary.keys()) {
        if !["engine", "seed"].contains(&key.as_str()) && !keys.contains(key) {
            keys.push(key.clone());
        }
    }
    keys
}

fn text(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// A line of comma-separated values; those that hold a comma or a quotation mark are quoted (RFC 4180).
fn line(cells: impl Iterator<Item = String>) -> String {
    let quoted = |cell: String| match cell.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", cell.replace('"', "\"\"")),
        false => cell,
    };
    cells.map(quoted).collect::<Vec<_>>().join(",") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_with_commas_are_quoted() {
        assert_eq!(
            line(["a", "[1, 2]", "\"x\""].map(str::to_owned).into_iter()),
            "a,\"[1, 2]\",\"\"\"x\"\"\"\n"
        );
    }
}
