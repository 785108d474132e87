//! Tables that a scenario names by their files. They are read with the scenario and written into its text, so that
//! a log, which holds that text, needs no other file.
//!
//! A file is a CSV: a line with the names of the columns, then one point a line; columns that nobody asks for,
//! empty lines and lines that begin with `#` are passed over.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use toml_edit::{Array, DocumentMut, Item, TableLike, Value};

use super::bound::Bound;
use super::locate::Change;
use super::path::KeyPath;
use crate::number::exact;

/// A law that is given by points: in lists of the scenario, or in columns of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve {
    /// The table that holds the lists, or names the file.
    names: &'static [&'static str],
    /// Name and bound of what runs along x, and of what along y.
    pub(super) columns: [(&'static str, Bound); 2],
}

/// c of p(b) ∝ 1/(1 − c b²) in the course of a run.
pub(super) const IMPACT_PARAMETER: Curve = Curve {
    names: &["engine", "impact_parameter"],
    columns: [
        ("collisions_per_particle", Bound::NOT_NEGATIVE),
        ("c", Bound::within(-1000.0, 0.999_999, "a number below 1 (from -1000 to 0.999999)")),
    ],
};
/// p(ν) of entering a cell.
pub(super) const ENTRY_PROBABILITY: Curve = Curve {
    names: &["engine", "hsmc", "entry_probability"],
    columns: [
        ("volume_fraction", Bound::within(0.0, 10.0, "a volume fraction from 0 on (at most 10)")),
        ("probability", Bound::SHARE),
    ],
};
/// The longest file that is read [bytes].
const LARGEST: u64 = 1 << 20;
/// The name of the key that holds a path.
const TABLE: &str = "table";

/// Writes the numbers of every named file into `document` in place of its name. Paths count from `folder`, that of
/// the scenario; those of the command line, which are among the `changes`, from where the program runs.
/// Returns whether there were any, and what could not be read.
pub(super) fn inline(
    document: &mut DocumentMut,
    folder: &Path,
    changes: &[Change],
) -> (bool, Vec<(KeyPath, String)>) {
    let (mut inlined, mut mistakes) = (false, Vec::new());
    for Curve { names, columns } in [IMPACT_PARAMETER, ENTRY_PROBABILITY] {
        let Some(table) = find(document.as_table_mut(), names) else { continue };
        // Other keys beside it are a contradiction, which the reader tells.
        let (Some(item), 1) = (table.get(TABLE), table.len()) else { continue };
        let key = KeyPath::of(names.iter().copied()).join(TABLE);
        let is_option = changes.iter().any(|change| change.path.holds(&key));
        let content = match item.as_str() {
            None => Err("must be the path of a CSV file, such as \"table.csv\"".to_owned()),
            Some("") => Err("is empty; give the path of a CSV file".to_owned()),
            Some(path) => read(&if is_option { PathBuf::from(path) } else { folder.join(path) }, columns),
        };
        match content {
            Err(message) => mistakes.push((key, message)),
            Ok(lists) => {
                table.remove(TABLE);
                for ((column, _), numbers) in columns.into_iter().zip(lists) {
                    table.insert(column, Item::Value(Value::Array(numbers.into_iter().collect::<Array>())));
                }
                inlined = true;
            }
        }
    }
    (inlined, mistakes)
}

/// The table at `names`.
fn find<'a>(root: &'a mut dyn TableLike, names: &[&str]) -> Option<&'a mut dyn TableLike> {
    names.iter().try_fold(root, |table, name| table.get_mut(name)?.as_table_like_mut())
}

/// Both columns of the file at `path`.
fn read(path: &Path, columns: [(&str, Bound); 2]) -> Result<[Vec<f64>; 2], String> {
    let name = path.display();
    let unread = |error: std::io::Error| format!("{name} cannot be read: {error}");
    let file = fs::File::open(path)
        .map_err(|error| format!("{}; `grainflow calibrate` writes such a table", unread(error)))?;
    let mut bytes = Vec::new();
    // Whatever it is, no more of it is read than a table can have.
    file.take(LARGEST + 1).read_to_end(&mut bytes).map_err(unread)?;
    if bytes.len() as u64 > LARGEST {
        return Err(format!("{name} is larger than 1 MiB; a table is a short text"));
    }
    let text = String::from_utf8(bytes).map_err(|_| {
        format!("{name} is not UTF-8 text; a table is a CSV, lines of numbers below a line of names")
    })?;
    points(&text, columns).map_err(|message| format!("{name}{message}"))
}

/// Both columns of `text`; a message begins with the line it concerns.
fn points(text: &str, columns: [(&str, Bound); 2]) -> Result<[Vec<f64>; 2], String> {
    let is_content = |line: &str| !line.trim().is_empty() && !line.trim().starts_with('#');
    let mut lines = text.lines().enumerate().filter(|(_, line)| is_content(line));
    let header: Vec<&str> = lines.next().map_or_else(Vec::new, |(_, line)| cells(line));
    let place = |(column, _): (&str, Bound)| {
        header.iter().position(|name| *name == column).ok_or_else(|| {
            format!(": has no column `{column}`; begin with the line `{},{}`", columns[0].0, columns[1].0)
        })
    };
    let places = [place(columns[0])?, place(columns[1])?];
    let mut lists = [Vec::new(), Vec::new()];
    for (number, line) in lines {
        let cells = cells(line);
        for ((list, place), (column, bound)) in lists.iter_mut().zip(places).zip(columns) {
            let value = value(cells.get(place).copied().unwrap_or_default(), bound);
            list.push(value.map_err(|problem| format!(":{}: column `{column}`: {problem}", number + 1))?);
        }
        if let [.., left, right] = lists[0][..]
            && left >= right
        {
            let (left, right) = (exact(left), exact(right));
            let (line, column) = (number + 1, columns[0].0);
            return Err(format!(
                ":{line}: column `{column}`: must rise, but {right} follows {left}; sort the lines"
            ));
        }
    }
    if lists[0].is_empty() {
        return Err(": holds no points; give at least one line of numbers".to_owned());
    }
    Ok(lists)
}

/// The number in a cell.
fn value(cell: &str, bound: Bound) -> Result<f64, String> {
    let value: f64 =
        cell.parse().map_err(|_| format!("must be a number, not \"{}\"; mend it", cell.escape_debug()))?;
    bound.refusal(value).map_or(Ok(value), Err)
}

/// The cells of a line; a name may carry its unit in brackets.
fn cells(line: &str) -> Vec<&str> {
    line.split(',').map(|cell| cell.split('[').next().unwrap_or_default().trim().trim_matches('"')).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        points(text, IMPACT_PARAMETER.columns).unwrap_err()
    }

    #[test]
    fn columns_are_found_by_their_names() {
        let text = "# measured\n\nc,standard_error,collisions_per_particle [1]\n-0.5,0.1,0\n 0.25 ,,7.5\n";
        let [places, values] = points(text, IMPACT_PARAMETER.columns).unwrap();
        assert_eq!((places, values), (vec![0.0, 7.5], vec![-0.5, 0.25]));
    }

    #[test]
    fn wrong_files_are_told_by_line_and_column() {
        let head = "collisions_per_particle,c\n";
        let of = |lines: &str| message(&format!("{head}{lines}"));
        assert_eq!(
            of("0,0.1\n1,1.5\n"),
            ":3: column `c`: 1.5 is out of bounds; give a number below 1 (from -1000 to 0.999999)"
        );
        assert_eq!(of("0,none\n"), ":2: column `c`: must be a number, not \"none\"; mend it");
        assert_eq!(of("0\n"), ":2: column `c`: must be a number, not \"\"; mend it");
        assert_eq!(
            of("0,NaN\n"),
            ":2: column `c`: NaN is out of bounds; give a number below 1 (from -1000 to 0.999999)"
        );
        assert_eq!(
            of("2,0.1\n2,0.2\n"),
            ":3: column `collisions_per_particle`: must rise, but 2 follows 2; sort the lines"
        );
        assert_eq!(of(""), ": holds no points; give at least one line of numbers");
        assert_eq!(
            message("time,c\n0,1\n"),
            ": has no column `collisions_per_particle`; begin with the line `collisions_per_particle,c`"
        );
        assert!(message("").contains("has no column"));
    }
}
