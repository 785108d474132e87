//! Contestants that made the same runs, as HSMC and CBA do where no cell is ever full.

use super::assemble::{Entry, Replica};

/// Numbers of one run that differ by a smaller share differ by rounding: sums depend on the order of grains in memory.
/// Trajectories that part in anything else are farther apart within a few collisions.
const ROUNDING: f64 = 1e-12;

/// A sentence for each group of contestants whose series are the same but for rounding.
pub(super) fn remarks(entries: &[Entry]) -> Vec<String> {
    let is_first = |k: &usize| !(0..*k).any(|earlier| are_same(&entries[earlier], &entries[*k]));
    let groups = (0..entries.len()).filter(is_first).map(|first| {
        let same = entries[first..].iter().filter(|entry| are_same(&entries[first], entry));
        same.collect::<Vec<&Entry>>()
    });
    groups.filter_map(|group| sentence(&group)).collect()
}

fn sentence(group: &[&Entry]) -> Option<String> {
    let [earlier @ .., last] = group else { return None };
    let hashes =
        |entry: &Entry| entry.runs.iter().map(|run| run.log.state_hashes.clone()).collect::<Vec<_>>();
    let are_bits = earlier.iter().all(|entry| hashes(entry) == hashes(last));
    let how = match are_bits {
        true => "bit for bit (equal state hashes at every recording)",
        false => "but for rounding (every number of their series is equal to 12 digits)",
    };
    let labels: Vec<&str> = earlier.iter().map(|entry| entry.label.as_str()).collect();
    (!labels.is_empty()).then(|| {
        format!(
            "{} and {} made the same runs, {how}: what is said of one holds for the other.",
            labels.join(", "),
            last.label
        )
    })
}

/// Whether all replicas of two contestants, of which there is one at least, have the same series.
fn are_same(one: &Entry, other: &Entry) -> bool {
    !one.runs.is_empty()
        && one.runs.len() == other.runs.len()
        && one.runs.iter().zip(&other.runs).all(|(a, b)| a.number == b.number && has_same_series(a, b))
}

/// Series of more than one recording, equal but for rounding.
fn has_same_series(a: &Replica, b: &Replica) -> bool {
    a.log.columns == b.log.columns
        && a.log.columns.len() > 1
        && a.log.series.len() > 1
        && a.log.series.len() == b.log.series.len()
        && (0..a.log.columns.len()).all(|column| is_same_column(a, b, column))
}

/// Whether all values of a column are equal, by their largest magnitude, or are both no numbers.
fn is_same_column(a: &Replica, b: &Replica, column: usize) -> bool {
    let values = |run: &Replica| -> Vec<f64> {
        run.log.series.iter().map(|row| row.get(column).copied().unwrap_or(f64::NAN)).collect()
    };
    let (a, b) = (values(a), values(b));
    let size = a.iter().filter(|value| value.is_finite()).fold(0.0, |most: f64, value| most.max(value.abs()));
    a.iter().zip(&b).all(|(a, b)| (a.is_nan() && b.is_nan()) || (a - b).abs() <= ROUNDING * size)
}
