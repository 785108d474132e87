//! Reads typed values out of a TOML tree and collects every mistake on the way.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use toml_edit::{Item, TableLike, Value};

use super::bound::Bound;
use super::error::{Mistake, Place};
use super::locate::Locator;
use super::path::KeyPath;
use super::schema;
use super::suggest::{did_you_mean, nearest};
use crate::number::exact;
use crate::space::Vector;

/// Collects mistakes with their places.
#[derive(Debug)]
pub(super) struct Reader {
    locator: Locator,
    /// Where relative paths of the file start.
    folder: PathBuf,
    mistakes: RefCell<Vec<Mistake>>,
    /// Keys that misspelt ones probably stand for: not to be called missing as well.
    misspelt: RefCell<Vec<KeyPath>>,
}

impl Reader {
    /// A reader of the file that `locator` knows, which stands in `folder`.
    pub(super) fn new(locator: Locator, folder: &Path) -> Self {
        Reader {
            locator,
            folder: folder.to_owned(),
            mistakes: RefCell::default(),
            misspelt: RefCell::default(),
        }
    }

    /// The file that `written` at `path` means: seen from the scenario's folder, or, where an option of the command
    /// line says it, from where the user stands.
    fn file(&self, path: &KeyPath, written: &str) -> PathBuf {
        match self.locator.place(path) {
            Place::Option { .. } => PathBuf::from(written),
            _ => self.folder.join(written),
        }
    }

    /// Notes a mistake at `path`.
    pub(super) fn mistake(&self, path: &KeyPath, message: impl Into<String>) {
        let place = self.locator.place(path);
        let mistake = Mistake { place, key: path.to_string(), message: message.into() };
        self.mistakes.borrow_mut().push(mistake);
    }

    /// Notes that `path` is missing, unless it is there under a misspelt name.
    fn missing(&self, path: &KeyPath, message: String) {
        if !self.misspelt.borrow().iter().any(|misspelt| misspelt.holds(path)) {
            self.mistake(path, message);
        }
    }

    pub(super) fn into_mistakes(self) -> Vec<Mistake> {
        self.mistakes.into_inner()
    }
}

/// What was found under a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Found<T> {
    /// Nothing.
    Missing,
    /// Something wrong, which has been noted.
    Wrong,
    /// A value of the right kind within its bounds.
    Value(T),
}

impl<T> Found<T> {
    /// The value, or `default` where there is none; `None` when it is wrong.
    pub(super) fn or(self, default: T) -> Option<T> {
        match self {
            Found::Missing => Some(default),
            Found::Wrong => None,
            Found::Value(value) => Some(value),
        }
    }

    /// `Some(None)` where there is none; `None` when it is wrong.
    pub(super) fn optional(self) -> Option<Option<T>> {
        match self {
            Found::Missing => Some(None),
            Found::Wrong => None,
            Found::Value(value) => Some(Some(value)),
        }
    }

    /// The value; its absence is noted with a `remedy`.
    pub(super) fn required(self, section: &Section<'_>, key: &str, remedy: &str) -> Option<T> {
        if matches!(self, Found::Missing) {
            section.missing(key, format!("is missing; {remedy}"));
        }
        match self {
            Found::Value(value) => Some(value),
            _ => None,
        }
    }

    pub(super) fn map<U>(self, f: impl FnOnce(T) -> U) -> Found<U> {
        match self {
            Found::Missing => Found::Missing,
            Found::Wrong => Found::Wrong,
            Found::Value(value) => Found::Value(f(value)),
        }
    }
}

/// A table that is being read; without content where the file lacks it.
#[derive(Clone)]
pub(super) struct Section<'a> {
    reader: &'a Reader,
    path: KeyPath,
    table: Option<&'a dyn TableLike>,
}

impl<'a> Section<'a> {
    /// The root of a file.
    pub(super) fn root(reader: &'a Reader, table: &'a dyn TableLike, keys: &[&str]) -> Self {
        let section = Section { reader, path: KeyPath::default(), table: Some(table) };
        section.refuse_unknown(keys);
        // Said before anything is missed: a key of the head below a table belongs to that table.
        let below = schema::ROOT[..4].iter().filter(|key| section.holds_below(key));
        reader.misspelt.borrow_mut().extend(below.map(|key| KeyPath::of([*key])));
        section
    }

    /// Whether one of its tables has `key`.
    pub(super) fn holds_below(&self, key: &str) -> bool {
        let mut items = self.table.into_iter().flat_map(|table| table.iter());
        items.any(|(_, item)| item.as_table_like().is_some_and(|table| table.contains_key(key)))
    }

    /// The table under `key`, which may hold `keys`; without content when it is missing or not a table.
    pub(super) fn section(&self, key: &str, keys: &[&str]) -> Section<'a> {
        let table = self.item(key).and_then(|item| {
            let table = item.as_table_like();
            if table.is_none() {
                self.mistake(key, format!("must be a table, not {}; write [{}]", kind(item), self.at(key)));
            }
            table
        });
        let section = Section { reader: self.reader, path: self.at(key), table };
        section.refuse_unknown(keys);
        section
    }

    /// The tables of the list under `key`, each of which may hold `keys`.
    pub(super) fn tables(&self, key: &str, keys: &[&str]) -> Found<Vec<Section<'a>>> {
        let tables: Option<Vec<&'a dyn TableLike>> = match self.item(key) {
            None => return Found::Missing,
            Some(Item::ArrayOfTables(list)) => Some(list.iter().map(|table| table as _).collect()),
            Some(item) => item.as_array().and_then(|list| {
                list.iter().map(|value| value.as_inline_table().map(|table| table as _)).collect()
            }),
        };
        let Some(tables) = tables.filter(|tables| !tables.is_empty()) else {
            return self
                .wrong(key, format!("must be a list of tables; write [[{}]] above each", self.at(key)));
        };
        let path = self.at(key);
        let sections = tables.into_iter().enumerate().map(|(index, table)| {
            let section = Section { reader: self.reader, path: path.element(index), table: Some(table) };
            section.refuse_unknown(keys);
            section
        });
        Found::Value(sections.collect())
    }

    /// The item under `key`.
    pub(super) fn item(&self, key: &str) -> Option<&'a Item> {
        self.table?.get(key).filter(|item| !item.is_none())
    }

    pub(super) fn has(&self, key: &str) -> bool {
        self.item(key).is_some()
    }

    /// Whether the file has this table.
    pub(super) fn exists(&self) -> bool {
        self.table.is_some()
    }

    /// The full path of `key`, which may lead through further tables.
    pub(super) fn at(&self, key: &str) -> KeyPath {
        key.split('.').fold(self.path.clone(), |path, name| path.join(name))
    }

    /// The file that the text `written` under `key` means.
    pub(super) fn file(&self, key: &str, written: &str) -> PathBuf {
        self.reader.file(&self.at(key), written)
    }

    /// Notes a mistake at `key`.
    pub(super) fn mistake(&self, key: &str, message: impl Into<String>) {
        self.reader.mistake(&self.at(key), message);
    }

    /// Notes that `key` is missing; `message` says what to write.
    pub(super) fn missing(&self, key: &str, message: impl Into<String>) {
        self.reader.missing(&self.at(key), message.into());
    }

    /// Notes a mistake at the table itself.
    pub(super) fn mistake_here(&self, message: impl Into<String>) {
        self.reader.mistake(&self.path, message);
    }

    fn wrong<T>(&self, key: &str, message: String) -> Found<T> {
        self.mistake(key, message);
        Found::Wrong
    }

    /// Keys of this table that are not among `keys`.
    fn refuse_unknown(&self, keys: &[&str]) {
        for (key, _) in self.table.into_iter().flat_map(|table| table.iter()) {
            if keys.contains(&key) {
                continue;
            }
            let message = format!("is not a known key{}", self.where_it_belongs(key, keys));
            self.reader.mistake(&self.path.join(key), message);
        }
    }

    /// Where to put a key that is not known here.
    fn where_it_belongs(&self, key: &str, keys: &[&str]) -> String {
        let here = self.path.to_string();
        if key.contains("friction") {
            return schema::NO_FRICTION.to_owned();
        }
        if let Some(meant) = nearest(key, keys.iter().copied()) {
            self.reader.misspelt.borrow_mut().push(self.path.join(meant));
            return format!("; did you mean `{meant}`?");
        }
        if !here.is_empty() && schema::ROOT[..4].contains(&key) {
            return format!("; `{key}` belongs at the top of the file, above the first [table]");
        }
        if keys.contains(&"wall") && schema::WALL.contains(&key) {
            return format!("; a wall of this kind has none: it has {}", keys.join(" and "));
        }
        match schema::TABLES.iter().find(|(table, keys)| *table != here && keys.contains(&key)) {
            Some((table, _)) => format!("; `{key}` belongs into [{table}]"),
            None => format!("; known here: {}", keys.join(", ")),
        }
    }

    /// A finite number within `bound`.
    pub(super) fn number(&self, key: &str, bound: Bound) -> Found<f64> {
        match self.item(key) {
            None => Found::Missing,
            Some(item) => match number_of(item) {
                Ok(value) => match bound.refusal(value) {
                    None => Found::Value(value),
                    Some(refusal) => self.wrong(key, refusal),
                },
                Err(problem) => self.wrong(key, problem),
            },
        }
    }

    /// A whole number from `low` to `high`.
    pub(super) fn whole(&self, key: &str, low: u64, high: u64) -> Found<u64> {
        let Some(item) = self.item(key) else { return Found::Missing };
        if let Some(value) = item.as_float().filter(|value| value.is_finite()) {
            let remedy = if value.fract() == 0.0 && value.abs() < 9e15 {
                format!("write {value:.0}")
            } else {
                "write it without point or exponent".to_owned()
            };
            return self.wrong(key, format!("{} must be a whole number; {remedy}", exact(value)));
        }
        let Some(value) = item.as_integer() else {
            return self.wrong(key, format!("must be a whole number, not {}", kind(item)));
        };
        match u64::try_from(value) {
            Ok(value) if (low..=high).contains(&value) => Found::Value(value),
            _ => {
                self.wrong(key, format!("{value} is out of bounds; give a whole number from {low} to {high}"))
            }
        }
    }

    /// A text; `example` is shown when it is something else.
    pub(super) fn text(&self, key: &str, example: &str) -> Found<&'a str> {
        match self.item(key) {
            None => Found::Missing,
            Some(item) => match item.as_str() {
                Some(text) => Found::Value(text),
                None => self.wrong(key, format!("must be a text, not {}; write {example}", kind(item))),
            },
        }
    }

    /// One of several named values.
    pub(super) fn choice<T: Copy>(&self, key: &str, names: &[(&str, T)]) -> Found<T> {
        let known = || names.iter().map(|(name, _)| *name);
        let list = known().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
        let Some(item) = self.item(key) else { return Found::Missing };
        let Some(text) = item.as_str() else {
            return self.wrong(key, format!("must be one of {list}, not {}", kind(item)));
        };
        match names.iter().find(|(name, _)| *name == text) {
            Some((_, value)) => Found::Value(*value),
            None => self.wrong(
                key,
                format!(
                    "\"{text}\" is not known; {}",
                    did_you_mean(text, known(), &format!("choose one of {list}"))
                ),
            ),
        }
    }

    /// A vector: one finite number within `bound` for every axis.
    pub(super) fn vector<V: Vector>(&self, key: &str, bound: Bound) -> Found<V> {
        self.numbers(key, V::DIMENSION, bound).map(|values| V::from_fn(|axis| values[axis]))
    }

    /// At least one finite number within `bound`, any number of them.
    pub(super) fn list(&self, key: &str, bound: Bound) -> Found<Vec<f64>> {
        let Some(item) = self.item(key) else { return Found::Missing };
        match item.as_array().map(toml_edit::Array::len) {
            None => self.wrong(key, format!("must be a list of numbers, not {}", kind(item))),
            Some(0) => self.wrong(key, "is empty; give at least one number".to_owned()),
            Some(length) => self.numbers(key, length, bound),
        }
    }

    /// `length` finite numbers within `bound`.
    pub(super) fn numbers(&self, key: &str, length: usize, bound: Bound) -> Found<Vec<f64>> {
        let Some(item) = self.item(key) else { return Found::Missing };
        let Some(array) = item.as_array() else {
            return self.wrong(key, format!("must be a list of {length} numbers, not {}", kind(item)));
        };
        let mut values = Vec::new();
        for (index, value) in array.iter().enumerate() {
            let refusal = number_of_value(value).and_then(|number| {
                values.push(number);
                bound.refusal(number).map_or(Ok(()), Err)
            });
            if let Err(message) = refusal {
                self.reader.mistake(&self.at(key).element(index), message);
                values.clear();
                break;
            }
        }
        if array.len() != length {
            let axes = if length == 1 { "number" } else { "numbers" };
            return self
                .wrong(key, format!("has {} entries; this dimension asks for {length} {axes}", array.len()));
        }
        if values.len() == length { Found::Value(values) } else { Found::Wrong }
    }
}

/// The finite number that `item` holds, or what is wrong with it.
pub(super) fn number_of(item: &Item) -> Result<f64, String> {
    match item.as_value() {
        Some(value) => number_of_value(value),
        None => Err(format!("must be a number, not {}", kind(item))),
    }
}

fn number_of_value(value: &Value) -> Result<f64, String> {
    match value {
        Value::Integer(value) => Ok(*value.value() as f64),
        Value::Float(value) if value.value().is_finite() => Ok(*value.value()),
        Value::Float(value) => Err(format!("{} is not a finite number; give a finite one", value.value())),
        Value::String(text) if text.value().parse::<f64>().is_ok() => {
            Err(format!("must be a number, not the text \"{0}\"; write {0} without quotes", text.value()))
        }
        other => Err(format!("must be a number, not {}", kind_of_value(other))),
    }
}

/// What an item is, for messages.
pub(super) fn kind(item: &Item) -> String {
    match item {
        Item::Value(value) => kind_of_value(value),
        Item::ArrayOfTables(_) => "a list of tables".to_owned(),
        Item::Table(_) => "a table".to_owned(),
        Item::None => "nothing".to_owned(),
    }
}

fn kind_of_value(value: &Value) -> String {
    match value {
        Value::String(text) => format!("the text \"{}\"", text.value().escape_debug()),
        Value::Integer(value) => format!("the number {}", value.value()),
        Value::Float(value) => format!("the number {}", exact(*value.value())),
        Value::Boolean(value) => format!("{}", value.value()),
        Value::Datetime(_) => "a date".to_owned(),
        Value::Array(_) => "a list".to_owned(),
        Value::InlineTable(_) => "a table".to_owned(),
    }
}
