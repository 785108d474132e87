//! `comparison.csv`: one line per quantity, place and contestant.

use super::json::word;
use super::model::{Compared, ComparedFigure, Comparison, Difference};

/// Names of the columns.
pub const HEADER: &str = "kind,name,time,abscissa,place,contestant,value,standard_error,is_relative,difference,\
                          difference_error,standard_errors,verdict";

/// The text of `comparison.csv`; what is not known stays empty.
pub fn csv(comparison: &Comparison) -> String {
    let mut text = format!("{HEADER}\n");
    let labels: Vec<String> = comparison.contestants.iter().map(|one| quoted(&one.label)).collect();
    for (kind, all) in [("series", &comparison.series), ("profile", &comparison.profiles)] {
        all.iter().for_each(|compared| curves(&mut text, kind, compared, &labels));
    }
    comparison.figures.iter().for_each(|one| figure(&mut text, one, &labels));
    text
}

fn curves(text: &mut String, kind: &str, compared: &Compared, labels: &[String]) {
    let name = match compared.name == compared.ordinate.name {
        true => compared.name.clone(),
        false => format!("{}/{}", compared.name, compared.ordinate.name),
    };
    let time = compared.time.map_or_else(String::new, number);
    for ((label, curve), difference) in labels.iter().zip(&compared.curves).zip(&compared.differences) {
        let Some(curve) = curve else { continue };
        for (k, place) in compared.places.iter().enumerate() {
            let start =
                [kind, &quoted(&name), &time, &compared.abscissa.name, &number(*place), label].join(",");
            let values = [number(curve.values[k]), number(curve.errors[k])].join(",");
            *text += &format!("{start},{values},{}\n", told(difference.as_ref(), k));
        }
    }
}

fn figure(text: &mut String, figure: &ComparedFigure, labels: &[String]) {
    for ((label, value), difference) in labels.iter().zip(&figure.values).zip(&figure.differences) {
        let Some(value) = value else { continue };
        let error = value.standard_error.map_or_else(String::new, number);
        let start = format!("figure,{},,,,{label},{},{error}", quoted(&figure.name), number(value.value));
        *text += &format!("{start},{}\n", told(difference.as_ref(), 0));
    }
}

/// The columns of a difference.
fn told(difference: Option<&Difference>, place: usize) -> String {
    let Some(difference) = difference else { return ",,,,".to_owned() };
    let (value, error) = (difference.values[place], difference.errors[place]);
    let standard_errors = if value == 0.0 && error == 0.0 { 0.0 } else { value / error };
    let numbers = [value, error, standard_errors].map(number).join(",");
    format!("{},{numbers},{}", difference.is_relative, word(difference.verdict))
}

/// The shortest text that reads back to the same bits; nothing where there is no number.
fn number(value: f64) -> String {
    if value.is_nan() { String::new() } else { format!("{value:?}") }
}

/// A text that may hold a comma.
fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}
