//! The tables of a run folder.

use std::fmt::Write as _;
use std::path::Path;

use super::folder::{PROFILES, SERIES};
use super::recorder::Recorded;
use super::{RunError, write_text};
use crate::observe::measure::{Column, Dimension, Profile};
use crate::scenario::model::{Scenario, Units};
use crate::space::Vector;

/// Writes `series.csv` and `profiles/<measure>.csv`.
pub(super) fn write_tables<V: Vector>(
    folder: &Path,
    scenario: &Scenario<V>,
    recorded: &Recorded,
) -> Result<(), RunError> {
    let rows = recorded.series.iter().map(Vec::as_slice);
    write_text(&folder.join(SERIES), &table(&recorded.columns, &scenario.units, rows))?;
    let mut names: Vec<&str> = recorded.profiles.iter().map(|profile| profile.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    if names.is_empty() {
        return Ok(());
    }
    let place = folder.join(PROFILES);
    std::fs::create_dir_all(&place).map_err(|source| RunError::Write { path: place.clone(), source })?;
    for name in names {
        let same: Vec<&Profile> = recorded.profiles.iter().filter(|profile| profile.name == name).collect();
        write_text(&place.join(format!("{name}.csv")), &profile_table(&same, &scenario.units))?;
    }
    Ok(())
}

/// All profiles of one name below each other, with their times in the first column.
pub(crate) fn profile_table(profiles: &[&Profile], units: &Units) -> String {
    let time = Column { name: "time".to_owned(), unit: Dimension { time: 1, ..Dimension::default() } };
    let columns: Vec<Column> = std::iter::once(time).chain(profiles[0].columns.iter().cloned()).collect();
    let rows: Vec<Vec<f64>> = profiles
        .iter()
        .flat_map(|profile| {
            let length = profile.values.first().map_or(0, Vec::len);
            (0..length).map(|row| {
                std::iter::once(profile.time).chain(profile.values.iter().map(|column| column[row])).collect()
            })
        })
        .collect();
    table(&columns, units, rows.iter().map(Vec::as_slice))
}

/// A header line `name [unit]`, then one line per row; numbers in the shortest form that reads back
/// to the same bits, nothing where there is no number.
pub(crate) fn table<'a>(columns: &[Column], units: &Units, rows: impl Iterator<Item = &'a [f64]>) -> String {
    let header: Vec<String> =
        columns.iter().map(|column| format!("{} [{}]", column.name, unit_name(column.unit, units))).collect();
    let mut text = header.join(",") + "\n";
    for row in rows {
        for (k, value) in row.iter().enumerate() {
            let comma = if k > 0 { "," } else { "" };
            let written = match value.is_nan() {
                true => write!(text, "{comma}"),
                false => write!(text, "{comma}{value:?}"),
            };
            written.expect("a string takes all text");
        }
        text.push('\n');
    }
    text
}

/// A unit such as `kg·m^2/s^2` or `kg/(m·s^2)` in the scenario's names, `1` for a pure number.
pub(crate) fn unit_name(dimension: Dimension, units: &Units) -> String {
    let powers =
        [(&units.mass, dimension.mass), (&units.length, dimension.length), (&units.time, dimension.time)];
    let side = |sign: i8| {
        let factors: Vec<String> = powers
            .iter()
            .filter(|(_, power)| power.signum() == sign)
            .map(|(name, power)| match power.abs() {
                1 => (*name).clone(),
                power => format!("{name}^{power}"),
            })
            .collect();
        match (factors.len(), sign) {
            // Without brackets, kg/m·s^2 reads as kg·s^2/m.
            (2.., -1) => format!("({})", factors.join("·")),
            _ => factors.join("·"),
        }
    };
    match (side(1), side(-1)) {
        (above, below) if below.is_empty() => {
            if above.is_empty() {
                "1".to_owned()
            } else {
                above
            }
        }
        (above, below) if above.is_empty() => format!("1/{below}"),
        (above, below) => format!("{above}/{below}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_read_as_a_physicist_writes_them() {
        let units = Units { length: "m".into(), mass: "kg".into(), time: "s".into() };
        let name = |mass, length, time| unit_name(Dimension { mass, length, time }, &units);
        assert_eq!(name(0, 0, 0), "1");
        assert_eq!(name(1, 2, -2), "kg·m^2/s^2");
        assert_eq!(name(0, 0, -1), "1/s");
        assert_eq!(name(1, -1, -2), "kg/(m·s^2)");
        assert_eq!(name(0, -1, -1), "1/(m·s)");
    }

    #[test]
    fn what_is_not_defined_stays_empty() {
        let units = Units { length: "d".into(), mass: "m".into(), time: "t".into() };
        let columns = [
            Column { name: "a".into(), unit: Dimension::default() },
            Column { name: "b".into(), unit: Dimension::default() },
        ];
        let text = table(&columns, &units, [[0.1, f64::NAN].as_slice()].into_iter());
        assert_eq!(text, "a [1],b [1]\n0.1,\n");
    }
}
