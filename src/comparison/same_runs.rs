//! Contestants that made the same runs, as HSMC and CBA do where no cell is ever full.

use super::assemble::{Entry, Replica};

/// A sentence for each group of contestants whose series are the same to the last bit.
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
        false => "but for the last digits of positions (every number of their series is equal)",
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

/// Series of more than one recording, equal in every bit.
fn has_same_series(a: &Replica, b: &Replica) -> bool {
    let bits = |run: &Replica| -> Vec<u64> { run.log.series.iter().flatten().map(|x| x.to_bits()).collect() };
    a.log.columns == b.log.columns
        && a.log.columns.len() > 1
        && a.log.series.len() > 1
        && a.log.series.len() == b.log.series.len()
        && bits(a) == bits(b)
}
