//! What is wrong with a scenario: every mistake at once.

use std::borrow::Cow;
use std::fmt;

/// All mistakes of one scenario, in the order of its lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScenarioError {
    /// The file as it was named, or the built-in name.
    pub file: String,
    /// At least one.
    pub mistakes: Vec<Mistake>,
}

/// Names of options and keys are shown up to this length, and messages up to that [characters].
const LONGEST_NAME: usize = 240;
const LONGEST_MESSAGE: usize = 900;

/// One mistake, with what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// Where it stands.
    pub place: Place,
    /// The key with its tables, such as `engine.hsmc.sweeps`; empty where no key is concerned.
    pub key: String,
    /// What is wrong, and the remedy.
    pub message: String,
}

/// Where a mistake stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// On this line of the file, counted from 1.
    Line(usize),
    /// Nowhere: something is missing, or the file as a whole is wrong.
    File,
    /// In an option of the command line.
    Option {
        /// Which one, in the order in which options apply, counted from 0.
        order: usize,
        /// How to name it, such as `--set #2 'run.time=-1'`.
        name: String,
    },
}

impl ScenarioError {
    /// One mistake that concerns the file as a whole.
    pub(super) fn of_file(file: &str, message: String) -> Self {
        let mistake = Mistake { place: Place::File, key: String::new(), message };
        ScenarioError { file: file.to_owned(), mistakes: vec![mistake] }
    }

    /// Mistakes in the order of a reader: the file as a whole, its lines, the options by number.
    pub(super) fn sorted(file: &str, mut mistakes: Vec<Mistake>) -> Self {
        mistakes.sort_by_key(|mistake| match mistake.place {
            Place::File => (0, 0),
            Place::Line(line) => (1, line),
            Place::Option { order, .. } => (2, order),
        });
        mistakes.dedup();
        ScenarioError { file: file.to_owned(), mistakes }
    }
}

impl fmt::Display for ScenarioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, mistake) in self.mistakes.iter().enumerate() {
            if k > 0 {
                writeln!(f)?;
            }
            match &mistake.place {
                Place::Line(line) => write!(f, "{}:{line}: ", self.file)?,
                Place::File => write!(f, "{}: ", self.file)?,
                Place::Option { name, .. } => write!(f, "{}: ", shortened(name, LONGEST_NAME))?,
            }
            if !mistake.key.is_empty() {
                write!(f, "{}: ", shortened(&mistake.key, LONGEST_NAME))?;
            }
            write!(f, "{}", shortened(&mistake.message, LONGEST_MESSAGE))?;
        }
        Ok(())
    }
}

impl std::error::Error for ScenarioError {}

/// `text` in at most so many characters: of a longer one the middle, which somebody pasted, is left out.
fn shortened(text: &str, most: usize) -> Cow<'_, str> {
    let length = text.chars().count();
    if length <= most {
        return text.into();
    }
    let start: String = text.chars().take(2 * most / 3).collect();
    let end: String = text.chars().skip(length - most / 3).collect();
    format!("{start} … {end}").into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_pasted_is_not_repeated_in_full() {
        let mistake = Mistake {
            place: Place::Option { order: 0, name: format!("--set #1 'seed={}'", "é".repeat(3000)) },
            key: "seed".to_owned(),
            message: format!("\"{}\" is no number; give one", "9".repeat(3000)),
        };
        let said = ScenarioError::sorted("a.toml", vec![mistake]).to_string();
        assert!(said.chars().count() < 1500, "{said}");
        assert!(said.starts_with("--set #1 'seed=éé") && said.ends_with("give one"), "{said}");
    }
}
