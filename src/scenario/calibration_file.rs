//! Tables that a scenario names by their files. They are read with the scenario and written into its text, so that
//! a log, which holds that text, needs no other file.
//!
//! A file is a CSV (RFC 4180): a line with the names of the columns, then one point a line, with as many cells as there are
//! names; other columns, empty lines, lines that begin with `#` and a byte-order mark are passed over. A cell ends with its line.

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
    // Spreadsheets put a byte-order mark in front.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let is_content = |line: &str| !line.trim().is_empty() && !line.trim().starts_with('#');
    let lines = text.lines().enumerate().filter(|(_, line)| is_content(line));
    let mut lines = lines.map(|(place, line)| (place + 1, line));
    let (header, places) = header(lines.next(), columns)?;
    let mut lists = [Vec::new(), Vec::new()];
    for (number, line) in lines {
        let at_line = |problem: String| format!(":{number}: {problem}");
        let cells = cells(line).map_err(at_line)?;
        if cells.len() != header {
            return Err(at_line(format!(
                "has {} cells below {header} names; numbers have a decimal point and nothing between thousands",
                cells.len()
            )));
        }
        for ((list, place), (column, bound)) in lists.iter_mut().zip(places).zip(columns) {
            let value = value(&cells[place], bound);
            list.push(value.map_err(|problem| at_line(format!("column `{column}`: {problem}")))?);
        }
        if let [.., left, right] = lists[0][..]
            && left >= right
        {
            let (left, right, column) = (exact(left), exact(right), columns[0].0);
            return Err(at_line(format!(
                "column `{column}`: must rise, but {right} follows {left}; sort the lines"
            )));
        }
    }
    if lists[0].is_empty() {
        return Err(": holds no points; give at least one line of numbers".to_owned());
    }
    Ok(lists)
}

/// How many names the first line has, and the places of both columns among them. A name may carry its unit in brackets.
fn header(line: Option<(usize, &str)>, columns: [(&str, Bound); 2]) -> Result<(usize, [usize; 2]), String> {
    let (number, line) = line.unwrap_or_default();
    let names = cells(line).map_err(|problem| format!(":{number}: {problem}"))?;
    if let (1, Some(separator)) = (names.len(), line.chars().find(|c| [';', '\t'].contains(c))) {
        let word = if separator == ';' { "semicolons" } else { "tabs" };
        return Err(format!(
            ":{number}: has {word} between its columns; save it with commas there and a decimal point in the numbers"
        ));
    }
    let name = |cell: &str| cell.split('[').next().unwrap_or_default().trim().to_owned();
    let place = |(column, _): (&str, Bound)| {
        names.iter().position(|cell| name(cell) == column).ok_or_else(|| {
            format!(": has no column `{column}`; begin with the line `{},{}`", columns[0].0, columns[1].0)
        })
    };
    Ok((names.len(), [place(columns[0])?, place(columns[1])?]))
}

/// The number in a cell.
fn value(cell: &str, bound: Bound) -> Result<f64, String> {
    let value: f64 = cell.parse().map_err(|_| {
        let shown = cell.escape_debug();
        match cell.contains(',') {
            true => format!(
                "must be a number, not \"{shown}\"; write a decimal point, and nothing between thousands"
            ),
            false => format!("must be a number, not \"{shown}\"; mend it"),
        }
    })?;
    bound.refusal(value).map_or(Ok(value), Err)
}

/// The cells of a line, without the space around them. One in quotation marks may hold commas, and a quotation mark that
/// stands there twice (RFC 4180).
fn cells(line: &str) -> Result<Vec<String>, String> {
    let (mut cells, mut rest) = (Vec::new(), line);
    loop {
        rest = rest.trim_start();
        let cell = match rest.strip_prefix('"') {
            Some(quoted) => {
                let (cell, behind) = unquoted(quoted)?;
                rest = behind.trim_start();
                cell
            }
            None => {
                let end = rest.find(',').unwrap_or(rest.len());
                let (cell, behind) = rest.split_at(end);
                rest = behind;
                cell.trim_end().to_owned()
            }
        };
        cells.push(cell);
        match rest.strip_prefix(',') {
            Some(next) => rest = next,
            None if rest.is_empty() => return Ok(cells),
            None => return Err("has text behind a quotation mark that closes a cell; mend it".to_owned()),
        }
    }
}

/// The cell that `text` begins with up to its closing quotation mark, and what stands behind that.
fn unquoted(text: &str) -> Result<(String, &str), String> {
    let (mut cell, mut rest) = (String::new(), text);
    loop {
        let end = rest.find('"').ok_or("has a quotation mark that nothing closes; mend it")?;
        cell.push_str(&rest[..end]);
        rest = &rest[end + 1..];
        match rest.strip_prefix('"') {
            Some(behind) => {
                cell.push('"');
                rest = behind;
            }
            None => return Ok((cell, rest)),
        }
    }
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
        assert_eq!(
            of("0\n"),
            ":2: has 1 cells below 2 names; numbers have a decimal point and nothing between thousands"
        );
        assert_eq!(of("0,\n"), ":2: column `c`: must be a number, not \"\"; mend it");
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

    #[test]
    fn commas_inside_numbers_and_other_separators_are_refused_by_line() {
        let thousand = "\"collisions_per_particle\",\"c\"\n0,0.1\n\"1,000\",0.3\n";
        assert_eq!(
            message(thousand),
            ":3: column `collisions_per_particle`: must be a number, not \"1,000\"; write a decimal point, and nothing \
             between thousands"
        );
        let decimal_commas = "collisions_per_particle,c\n0,0,1\n10,0,3\n";
        assert!(message(decimal_commas).starts_with(":2: has 3 cells below 2 names"));
        for (text, word) in [
            ("collisions_per_particle;c\n0;0,1\n", "semicolons"),
            ("collisions_per_particle\tc\n0\t0.1\n", "tabs"),
        ] {
            assert!(message(text).contains(word), "{}", message(text));
        }
        assert!(message("collisions_per_particle,c\n0,0.1 [1]\n").contains("not \"0.1 [1]\""));
        assert!(message("collisions_per_particle,\"c\n").contains(":1: has a quotation mark that nothing"));
        assert!(message("collisions_per_particle,\"c\"d\n").contains(":1: has text behind"));
    }

    #[test]
    fn what_spreadsheets_write_is_read() {
        // A byte-order mark, lines that end in CR LF, quotation marks, an empty column at the end.
        for text in [
            "\u{feff}collisions_per_particle,c\r\n0,0.1\r\n10,0.3\r\n",
            "\u{feff}\"collisions_per_particle\",\"c\"\r\n\"0\", \"0.1\"\r\n\"10\",\"0.3\"\r\n",
            "collisions_per_particle,c,\n0,0.1,\n10,0.3,\n",
            "\"a, with \"\"commas\"\"\",c,collisions_per_particle\n\"1,2\",0.1,0\n\"3,4\",0.3,10\n",
        ] {
            let expected = [vec![0.0, 10.0], vec![0.1, 0.3]];
            assert_eq!(points(text, IMPACT_PARAMETER.columns), Ok(expected), "{text:?}");
        }
    }
}
