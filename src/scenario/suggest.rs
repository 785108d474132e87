//! "Did you mean": the known name nearest to a misspelt one.

/// The candidate nearest to `name`, if one is near enough to be meant.
pub(super) fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = name.to_lowercase().replace('_', "-");
    let length = name.chars().count();
    candidates
        .into_iter()
        .map(|candidate| (distance(&name, &candidate.to_lowercase().replace('_', "-")), candidate))
        .filter(|&(distance, candidate)| distance <= 1 + length.max(candidate.chars().count()) / 4)
        .filter(|&(distance, candidate)| distance < candidate.chars().count())
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// Candidates that are named when a word stands in several of them.
const MOST_MEANT: usize = 6;

/// `did you mean …?` where a candidate is near, or where the name is a part of some; the `remedy` where none is: one ending,
/// never both.
pub fn did_you_mean<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>, remedy: &str) -> String {
    let candidates: Vec<&str> = candidates.into_iter().collect();
    let near = || nearest(name, candidates.iter().copied());
    match &holding(name, &candidates)[..] {
        [] => near().map_or_else(|| remedy.to_owned(), |meant| format!("did you mean `{meant}`?")),
        [one] => format!("did you mean `{one}`?"),
        [first @ .., last] => {
            let first: Vec<String> = first.iter().map(|name| format!("`{name}`")).collect();
            format!("did you mean {} or `{last}`?", first.join(", "))
        }
    }
}

/// The first candidates of which `name` is a word, or several words in a row: `slope` of `heap_slope`.
fn holding<'a>(name: &str, candidates: &[&'a str]) -> Vec<&'a str> {
    let padded = |name: &str| format!("-{}-", name.to_lowercase().replace('_', "-"));
    let part = padded(name);
    let holds = |candidate: &&&str| name.chars().count() > 1 && padded(candidate).contains(&part);
    candidates.iter().filter(holds).take(MOST_MEANT).copied().collect()
}

/// Edits that turn `a` into `b`: insert, delete, replace, swap neighbours (Damerau 1964).
fn distance(a: &str, b: &str) -> usize {
    let a: Vec<char> = a.chars().collect();
    let b: Vec<char> = b.chars().collect();
    let mut rows: Vec<Vec<usize>> = vec![(0..=b.len()).collect()];
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let replaced = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = replaced.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(rows[i - 2][j - 2] + 1);
            }
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_finds_its_name_and_a_stranger_none() {
        let names = ["restitution", "diameter", "mass", "count"];
        assert_eq!(nearest("restituton", names), Some("restitution"));
        assert_eq!(nearest("Diamter", names), Some("diameter"));
        assert_eq!(nearest("conut", names), Some("count"));
        assert_eq!(nearest("viscosity", names), None);
        assert_eq!(nearest("x", ["y"]), None);
    }

    #[test]
    fn a_word_finds_the_names_that_hold_it() {
        let names = ["heap_slope", "spectrum_slope", "wall_normal_stress", "heap_slope_left"];
        let meant = |name: &str| did_you_mean(name, names, "none");
        assert_eq!(meant("slope"), "did you mean `heap_slope`, `spectrum_slope` or `heap_slope_left`?");
        assert_eq!(meant("normal-stress"), "did you mean `wall_normal_stress`?");
        assert_eq!(meant("heap_slop"), "did you mean `heap_slope`?");
        assert_eq!(meant("ope"), "none");
    }
}
