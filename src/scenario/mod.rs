//! What a run is made of: a checked scenario. Only this module makes one,
//! so a `Scenario` that nobody has changed since is checked.

mod bound;
pub mod builtin;
mod calibration_file;
mod cells;
pub mod check;
mod collapse;
mod consistency;
mod cost;
pub mod error;
mod estimate;
mod exact;
mod file;
pub mod geometry;
pub mod initial;
pub mod kinds;
mod locate;
pub mod model;
mod overrides;
mod pace;
mod path;
pub mod pauses;
mod read;
mod reader;
mod schema;
mod suggest;
mod tables;
mod thinning;
pub mod trust;
mod walls;
mod warnings;

use std::path::Path;

use toml_edit::{Document, TomlError};

pub use error::ScenarioError;
use error::{Mistake, Place};
use file::Fetched;
use locate::{Locator, line_of};
use model::AnyScenario;
pub use overrides::Overrides;
use reader::{Reader, Section};
pub use schema::MEASURES;
pub use suggest::did_you_mean;

/// The scenario that `source` names, a file or a built-in one, with `overrides`.
pub fn load(source: &str, overrides: &Overrides) -> Result<AnyScenario, ScenarioError> {
    let Fetched { name, text, folder } = file::fetch(source)?;
    parse_as(source, &folder, &name, &text, overrides)
}

/// The scenario called `name` that `text` describes, with `overrides`. Relative paths start where the user stands.
pub fn parse(name: &str, text: &str, overrides: &Overrides) -> Result<AnyScenario, ScenarioError> {
    parse_in(Path::new(""), name, text, overrides)
}

/// The same for a text that stands, or will stand, in a file of `folder`, from which its relative paths start.
pub fn parse_in(
    folder: &Path,
    name: &str,
    text: &str,
    overrides: &Overrides,
) -> Result<AnyScenario, ScenarioError> {
    parse_as(name, folder, name, text, overrides)
}

fn parse_as(
    file: &str,
    folder: &Path,
    name: &str,
    text: &str,
    overrides: &Overrides,
) -> Result<AnyScenario, ScenarioError> {
    let read = |overrides: &Overrides| read_as(file, folder, name, text, overrides);
    read(overrides).map_err(|error| blamed(error, overrides, read))
}

/// A mistake that goes when one option is left out, and leaves no other behind, is that option's: the line of the file where it
/// stands is right without it.
fn blamed(
    mut error: ScenarioError,
    overrides: &Overrides,
    read: impl Fn(&Overrides) -> Result<AnyScenario, ScenarioError>,
) -> ScenarioError {
    for (place, others) in overrides.each_left_out() {
        let left = read(&others).err().map_or_else(Vec::new, |error| error.mistakes);
        if left.len() >= error.mistakes.len() || !left.iter().all(|mistake| error.mistakes.contains(mistake))
        {
            continue;
        }
        for mistake in error.mistakes.iter_mut().filter(|mistake| !left.contains(mistake)) {
            if !matches!(mistake.place, Place::Option { .. }) {
                mistake.place = place.clone();
            }
        }
    }
    ScenarioError::sorted(&error.file, error.mistakes)
}

fn read_as(
    file: &str,
    folder: &Path,
    name: &str,
    text: &str,
    overrides: &Overrides,
) -> Result<AnyScenario, ScenarioError> {
    let original = document(file, text)?;
    if original.as_table().is_empty() && overrides.sets.is_empty() {
        let message = "holds no scenario; `grainflow scenarios show shear` prints one to start from";
        return Err(ScenarioError::of_file(file, message.to_owned()));
    }
    let mut changed = original.clone().into_mut();
    let (changes, mut mistakes) = overrides.apply(&mut changed);
    let (inlined, unreadable) = calibration_file::inline(&mut changed, folder, &changes);
    // Without a change the text stays as it was written, byte for byte.
    let source_text = if changes.is_empty() && !inlined { text.to_owned() } else { changed.to_string() };
    let reader = Reader::new(Locator::new(original, changes), folder);
    unreadable.into_iter().for_each(|(path, message)| reader.mistake(&path, message));
    let root = Section::root(&reader, changed.as_table(), schema::ROOT);
    let scenario = if tables::head::dimension(&root) == 3 {
        read::read(&root, name, source_text).map(AnyScenario::Three)
    } else {
        read::read(&root, name, source_text).map(AnyScenario::Two)
    };
    mistakes.extend(reader.into_mistakes());
    match scenario {
        Some(scenario) if mistakes.is_empty() => Ok(scenario),
        _ => {
            debug_assert!(!mistakes.is_empty(), "a scenario that cannot be made has a mistake");
            Err(ScenarioError::sorted(file, mistakes))
        }
    }
}

/// The spanned tree of `text`.
fn document(file: &str, text: &str) -> Result<Document<String>, ScenarioError> {
    Document::parse(text.to_owned()).map_err(|error: TomlError| {
        let place =
            error.span().map_or(Place::File, |span| Place::Line(line_of(text.as_bytes(), span.start)));
        let problem = error.message().replace('\n', ", ");
        let range =
            if problem.contains("overflow") { " (whole numbers end at 9223372036854775807)" } else { "" };
        let message = format!("is not TOML: {problem}{range}; mend this first");
        let mistake = Mistake { place, key: String::new(), message };
        ScenarioError { file: file.to_owned(), mistakes: vec![mistake] }
    })
}

#[cfg(test)]
mod tests;
