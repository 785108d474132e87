//! `comparison.csv`: every value of a comparison in a line of its own, for tables.

use std::fmt::Write;

use super::model::{Compared, ComparedFigure, Comparison, Difference};
use crate::statistics::Trend;

/// The columns, in order.
pub const HEADER: &str =
    "kind,name,time,place,contestant,value,standard_error,difference,difference_error,verdict,steady";

/// The file's text: a line per place and contestant of every series and profile, and one per contestant of a figure.
///
/// Numbers are in the shortest form that reads back to the same bits; a field is empty where there is nothing.
pub fn text(comparison: &Comparison) -> String {
    let mut table = Table { text: format!("{HEADER}\n"), comparison };
    comparison.series.iter().for_each(|compared| table.add("series", compared));
    comparison.profiles.iter().for_each(|compared| table.add("profile", compared));
    comparison.figures.iter().for_each(|figure| table.add_figure(figure));
    table.text
}

struct Table<'a> {
    text: String,
    comparison: &'a Comparison,
}

impl Table<'_> {
    /// The curves of all contestants that have one, then those of theory, which has no errors.
    fn add(&mut self, kind: &str, compared: &Compared) {
        let name = names(compared);
        for (contestant, curve) in compared.curves.iter().enumerate() {
            let Some(curve) = curve else { continue };
            let difference = compared.differences.get(contestant).and_then(Option::as_ref);
            for (k, place) in compared.places.iter().enumerate() {
                let at = |values: &[f64]| values.get(k).copied();
                let values = [at(&curve.values), at(&curve.errors)];
                let against = difference.map(|of| [at(&of.values), at(&of.errors)]).unwrap_or_default();
                let head = [kind.to_owned(), name.clone(), number(compared.time), number(Some(*place))];
                self.line(head, &self.label(contestant), values, against, difference, None);
            }
            if let Some((difference, all)) = difference.and_then(|of| Some((of, of.overall?))) {
                let head = [format!("{kind} as a whole"), name.clone(), number(compared.time), String::new()];
                let against = [Some(all.value), Some(all.error)];
                self.line(head, &self.label(contestant), [None; 2], against, Some(difference), None);
            }
        }
        for theory in &compared.theory {
            let label = format!("theory: {}", theory.name);
            for (place, value) in compared.places.iter().zip(&theory.values) {
                let head = [kind.to_owned(), name.clone(), number(compared.time), number(Some(*place))];
                self.line(head, &label, [Some(*value), None], [None; 2], None, None);
            }
        }
    }

    fn add_figure(&mut self, figure: &ComparedFigure) {
        let head = || ["figure".to_owned(), figure.name.clone(), String::new(), String::new()];
        for (contestant, estimate) in figure.values.iter().enumerate() {
            let Some(estimate) = estimate else { continue };
            let difference = figure.differences.get(contestant).and_then(Option::as_ref);
            let first = |values: &[f64]| values.first().copied();
            let against = difference.map(|of| [first(&of.values), first(&of.errors)]).unwrap_or_default();
            let values = [Some(estimate.value), estimate.standard_error];
            let trend = figure.trends.get(contestant).copied().flatten();
            self.line(head(), &self.label(contestant), values, against, difference, trend);
        }
        if let Some((value, _)) = &figure.theory {
            self.line(head(), "theory", [Some(*value), None], [None; 2], None, None);
        }
    }

    fn label(&self, contestant: usize) -> String {
        self.comparison.contestants.get(contestant).map_or_else(String::new, |one| one.label.clone())
    }

    fn line(
        &mut self,
        [kind, name, time, place]: [String; 4],
        contestant: &str,
        [value, error]: [Option<f64>; 2],
        [difference, difference_error]: [Option<f64>; 2],
        judged: Option<&Difference>,
        trend: Option<Trend>,
    ) {
        let verdict = judged.map_or("", |difference| difference.verdict.name());
        let steady = trend.map_or("", |trend| if trend.is_steady() { "true" } else { "false" });
        let [name, contestant] = [quoted(&name), quoted(contestant)];
        let [value, error, difference, difference_error] =
            [value, error, difference, difference_error].map(number);
        let _ = writeln!(
            self.text,
            "{kind},{name},{time},{place},{contestant},{value},{error},{difference},{difference_error},{verdict},{steady}"
        );
    }
}

/// The name, with the ordinate where that is another one, and with the abscissa where that is not time nor a place.
fn names(compared: &Compared) -> String {
    let mut name = compared.name.clone();
    if compared.ordinate.name != compared.name {
        name += &format!(": {}", compared.ordinate.name);
    }
    if compared.time.is_none() && compared.abscissa.name == "collisions_per_particle" {
        name += " against collisions_per_particle";
    }
    name
}

/// Nothing for what is not a number.
fn number(value: Option<f64>) -> String {
    value.filter(|value| !value.is_nan()).map_or_else(String::new, |value| format!("{value:?}"))
}

/// As RFC 4180 has it.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::text;
    use crate::comparison::testing::made_up;

    #[test]
    fn every_place_of_every_contestant_has_a_line() {
        let expected =
            "kind,name,time,place,contestant,value,standard_error,difference,difference_error,verdict,steady
series,temperature,,0.0,\"hsmc, again\",1.0,0.0,0.0,0.0,differs,
series,temperature,,0.5,\"hsmc, again\",0.1,,,,differs,
series as a whole,temperature,,,\"hsmc, again\",,,0.25,0.0625,differs,
series,temperature,,0.0,event-driven,1.0,0.0,,,,
series,temperature,,0.5,event-driven,,,,,,
series,temperature,,0.0,theory: Haff’s law,1.0,,,,,
series,temperature,,0.5,theory: Haff’s law,0.125,,,,,
profile,density-profile: volume_fraction,2.5,0.0,\"hsmc, again\",1.0,0.0,0.0,0.0,differs,
profile,density-profile: volume_fraction,2.5,0.5,\"hsmc, again\",0.1,,,,differs,
profile as a whole,density-profile: volume_fraction,2.5,,\"hsmc, again\",,,0.25,0.0625,differs,
profile,density-profile: volume_fraction,2.5,0.0,event-driven,1.0,0.0,,,,
profile,density-profile: volume_fraction,2.5,0.5,event-driven,,,,,,
figure,pressure,,,\"hsmc, again\",1.25,0.5,0.25,0.75,differs,false
figure,pressure,,,theory,1.5,,,,,
";
        assert_eq!(text(&made_up()), expected);
    }

    #[test]
    fn a_series_over_collisions_is_told_apart() {
        let mut comparison = made_up();
        comparison.series[0].abscissa.name = "collisions_per_particle".to_owned();
        assert!(text(&comparison).contains("\nseries,temperature against collisions_per_particle,,0.0,"));
    }
}
