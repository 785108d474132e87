//! What the command line changes in a scenario, applied to its text.

use toml_edit::{Array, DocumentMut, InlineTable, Item, Table, TableLike, Value};

use super::error::{Mistake, Place};
use super::locate::Change;
use super::path::KeyPath;
use super::schema::{EITHER_OR, WITHOUT_A_LOG};

/// What the command line changes in a scenario.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Overrides {
    /// `--set` options, `key.path=value` each; a value that is not TOML is a text,
    /// `key[n]` is component n of a vector, counted from 0.
    pub sets: Vec<String>,
    /// `--engine`: replaces `engine.kind`.
    pub engine: Option<String>,
    /// `--seed`: replaces `seed`.
    pub seed: Option<u64>,
}

/// One value to be set.
struct Setting {
    names: Vec<String>,
    component: Option<usize>,
    value: Value,
}

/// How to name the `--set` of this place.
fn set_name(order: usize, text: &str) -> String {
    format!("--set #{} '{text}'", order + 1)
}

impl Overrides {
    /// The place of each `--set`, and all options but that one.
    pub(super) fn each_left_out(&self) -> impl Iterator<Item = (Place, Overrides)> {
        self.sets.iter().enumerate().map(|(order, text)| {
            let mut others = self.clone();
            others.sets.remove(order);
            (Place::Option { order, name: set_name(order, text) }, others)
        })
    }

    /// Changes `document`; returns what was changed and which options are wrong.
    pub(super) fn apply(&self, document: &mut DocumentMut) -> (Vec<Change>, Vec<Mistake>) {
        let (mut changes, mut mistakes) = (Vec::new(), Vec::new());
        for (order, (name, setting)) in self.settings().into_iter().enumerate() {
            let place = Place::Option { order, name };
            match setting.and_then(|setting| setting.apply(document)) {
                Ok(path) => changes.push(Change { path, place }),
                Err(message) => mistakes.push(Mistake { place, key: String::new(), message }),
            }
        }
        (changes, mistakes)
    }

    /// The options by name, in the order in which they apply, with what they ask for.
    fn settings(&self) -> Vec<(String, Result<Setting, String>)> {
        let mut settings: Vec<_> =
            self.sets.iter().enumerate().map(|(k, text)| (set_name(k, text), Setting::parse(text))).collect();
        if let Some(engine) = &self.engine {
            let names = vec!["engine".to_owned(), "kind".to_owned()];
            let setting = Setting { names, component: None, value: engine.as_str().into() };
            settings.push((format!("--engine '{engine}'"), Ok(setting)));
        }
        if let Some(seed) = self.seed {
            let value =
                i64::try_from(seed).map_err(|_| format!("is too large; give a seed from 0 to {}", i64::MAX));
            let setting =
                |value: i64| Setting { names: vec!["seed".to_owned()], component: None, value: value.into() };
            settings.push((format!("--seed {seed}"), value.map(setting)));
        }
        settings
    }
}

impl Setting {
    fn parse(text: &str) -> Result<Self, String> {
        let (path, value) = text.split_once('=').ok_or("has no `=`; write key.path=value")?;
        let (path, component) = split_component(path.trim())?;
        let names: Vec<String> = path.split('.').map(|name| name.trim().to_owned()).collect();
        let is_bare = |name: &String| {
            !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
        };
        if !names.iter().all(is_bare) {
            return Err(format!("`{path}` is not a key; write names joined by dots, such as engine.kind"));
        }
        let value = value.trim();
        let mut value = value.parse::<Value>().unwrap_or_else(|_| value.into());
        value.decor_mut().clear();
        Ok(Setting { names, component, value })
    }

    /// Sets the value and returns its path.
    fn apply(self, document: &mut DocumentMut) -> Result<KeyPath, String> {
        let (key, tables) = self.names.split_last().ok_or("has no key; write key.path=value")?;
        let mut table: &mut dyn TableLike = document.as_table_mut();
        for (depth, name) in tables.iter().enumerate() {
            table = enter(table, name, depth)?;
        }
        let path = KeyPath::of(self.names.clone());
        if let Some(index) = self.component {
            let array = table.get_mut(key).and_then(Item::as_array_mut);
            let array = array
                .ok_or_else(|| format!("the scenario has no list `{path}`; set it as a whole: {path}=[…]"))?;
            set_component(array, index, self.value)?;
            return Ok(path.element(index));
        }
        remove_alternatives(table, &tables.join("."), key);
        let starts_from_log = names_a_log(&self.names, &self.value);
        match table.get_mut(key) {
            Some(Item::Value(old)) => {
                let decor = old.decor().clone();
                *old = self.value;
                *old.decor_mut() = decor;
            }
            _ => {
                table.insert(key, Item::Value(self.value));
            }
        }
        if starts_from_log
            && let Some(initial) = document.get_mut("initial").and_then(Item::as_table_like_mut)
        {
            for key in WITHOUT_A_LOG {
                initial.remove(key);
            }
        }
        Ok(path)
    }
}

/// Whether a value set at `names` makes the run start from a log.
fn names_a_log(names: &[String], value: &Value) -> bool {
    match names.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["initial", "positions"] => value.as_inline_table().is_some_and(|table| table.contains_key("log")),
        ["initial", "positions", "log"] => true,
        _ => false,
    }
}

/// `size[1]` is component 1 of `size`.
fn split_component(path: &str) -> Result<(&str, Option<usize>), String> {
    let Some((name, rest)) = path.split_once('[') else { return Ok((path, None)) };
    let index = rest.strip_suffix(']').and_then(|digits| digits.trim().parse().ok());
    match index {
        Some(index) => Ok((name.trim_end(), Some(index))),
        None if rest.contains("].") => Err(format!(
            "`{path}`: one value of a list of tables cannot be set alone; set the list, as in {name}=[{{ … }}, {{ … }}]"
        )),
        None => Err(format!("`{path}` is not a component; write {name}[0] for the first")),
    }
}

fn set_component(array: &mut Array, index: usize, value: Value) -> Result<(), String> {
    let length = array.len();
    let old = array
        .get_mut(index)
        .ok_or_else(|| format!("there is no component {index}; the list has {length}, counted from 0"))?;
    let decor = old.decor().clone();
    *old = value;
    *old.decor_mut() = decor;
    Ok(())
}

/// The table `name` inside `table`; made where there is none, in place of any value of another kind.
fn enter<'a>(
    table: &'a mut dyn TableLike,
    name: &str,
    depth: usize,
) -> Result<&'a mut dyn TableLike, String> {
    if table.get(name).is_none_or(|item| !item.is_table_like()) {
        let fresh = if depth == 0 {
            Item::Table(Table::new())
        } else {
            Item::Value(Value::InlineTable(InlineTable::new()))
        };
        table.insert(name, fresh);
    }
    table
        .get_mut(name)
        .and_then(Item::as_table_like_mut)
        .ok_or_else(|| format!("`{name}` is not a table; set it as a whole"))
}

/// Removes the keys that `key` of `table_name` stands in place of.
fn remove_alternatives(table: &mut dyn TableLike, table_name: &str, key: &str) {
    for (_, groups) in EITHER_OR.iter().filter(|(name, _)| *name == table_name) {
        if !groups.iter().any(|group| group.contains(&key)) {
            continue;
        }
        for other in groups.iter().filter(|group| !group.contains(&key)).copied().flatten() {
            table.remove(other);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(text: &str, sets: &[&str]) -> String {
        let mut document: DocumentMut = text.parse().unwrap();
        let overrides =
            Overrides { sets: sets.iter().map(ToString::to_string).collect(), ..Default::default() };
        let (_, mistakes) = overrides.apply(&mut document);
        assert_eq!(mistakes, []);
        document.to_string()
    }

    fn wrong(set: &str) -> String {
        let overrides = Overrides { sets: vec![set.to_owned()], ..Default::default() };
        overrides.apply(&mut "size = [1.0]".parse().unwrap()).1.remove(0).message
    }

    #[test]
    fn comments_stay() {
        assert_eq!(after("# a\nseed = 1 # b\n", &["seed=2"]), "# a\nseed = 2 # b\n");
    }

    #[test]
    fn a_value_that_is_not_toml_is_a_text() {
        assert_eq!(after("", &["title=two words"]), "title = \"two words\"\n");
    }

    #[test]
    fn a_component_is_counted_from_zero() {
        assert_eq!(
            after("[domain]\nsize = [1, 2]\n", &["domain.size[1]=7.5"]),
            "[domain]\nsize = [1, 7.5]\n"
        );
        assert!(wrong("size[1]=2").contains("no component 1"));
        assert!(wrong("sizes[0]=2").contains("no list `sizes`"));
    }

    #[test]
    fn one_key_of_a_group_replaces_the_group() {
        let text = "[particles]\ncount = 5\n[record]\nframes = 3\nspacing = \"log\"\n";
        let expected = "[particles]\nvolume_fraction = 0.2\n[record]\nevery = 0.5\n";
        assert_eq!(after(text, &["particles.volume_fraction=0.2", "record.every=0.5"]), expected);
        let text = "[engine]\ntime_step = { fixed = 0.1 }\n";
        let expected = "[engine]\ntime_step = { crossing = 0.2 }\n";
        assert_eq!(after(text, &["engine.time_step.crossing=0.2"]).replace("  ", " "), expected);
        assert_eq!(
            after("[initial]\nvelocities = \"rest\"\n", &["initial.velocities.maxwell=2"]).replace(' ', ""),
            "[initial]\nvelocities={maxwell=2}\n"
        );
    }

    #[test]
    fn a_start_from_a_log_replaces_the_start_of_a_gas() {
        let text = "[initial]\npositions = \"random\"\nvelocities = { maxwell = 1 }\nequilibrate = 10\n";
        for set in ["initial.positions={log='a.mcap'}", "initial.positions.log=a.mcap"] {
            let left = after(text, &[set]);
            assert!(
                left.contains("a.mcap") && !left.contains("velocities") && !left.contains("equi"),
                "{left}"
            );
        }
        assert!(after(text, &["initial.positions=lattice"]).contains("equilibrate = 10"));
    }

    #[test]
    fn missing_tables_are_made() {
        assert_eq!(after("seed = 1\n", &["run.time=3"]), "seed = 1\n\n[run]\ntime = 3\n");
    }

    #[test]
    fn wrong_options_say_what_to_write() {
        assert!(wrong("nothing").contains("key.path=value"));
        assert!(wrong("a..b=1").contains("not a key"));
        assert!(wrong("a[x]=1").contains("a[0]"));
    }
}
