//! Where a key stands: a line of the file as the user wrote it, or an option of the command line.

use toml_edit::{Document, Item};

use super::error::Place;
use super::path::KeyPath;

/// The file as written, and the options that changed it.
#[derive(Debug)]
pub(super) struct Locator {
    document: Document<String>,
    changes: Vec<Change>,
}

/// An option that set a value.
#[derive(Clone, Debug)]
pub(super) struct Change {
    /// What it set.
    pub(super) path: KeyPath,
    /// The option's place.
    pub(super) place: Place,
}

impl Locator {
    /// A locator for `document`, later changed by `changes`.
    pub(super) fn new(document: Document<String>, changes: Vec<Change>) -> Self {
        Locator { document, changes }
    }

    /// Where the value at `path` comes from.
    pub(super) fn place(&self, path: &KeyPath) -> Place {
        let last = |test: &dyn Fn(&Change) -> bool| self.changes.iter().rev().find(|change| test(change));
        if let Some(change) = last(&|change| change.path.holds(path)) {
            return change.place.clone();
        }
        if let Some(line) = self.line(path.names()) {
            return Place::Line(line);
        }
        if let Some(change) = last(&|change| path.holds(&change.path)) {
            return change.place.clone();
        }
        let ancestors = (1..path.names().len()).rev();
        ancestors
            .map(|n| &path.names()[..n])
            .find_map(|names| self.line(names))
            .map_or(Place::File, Place::Line)
    }

    /// The line on which the key at `names` was written.
    fn line(&self, names: &[String]) -> Option<usize> {
        let mut item = self.document.as_item();
        let mut start = None;
        for name in names {
            let (key_start, next) = step(item, name)?;
            start = key_start.or_else(|| next.span().map(|span| span.start)).or(start);
            item = next;
        }
        let text = self.document.raw().as_bytes();
        start.map(|start| line_of(text, start))
    }
}

/// The line that byte `start` of `text` is on, counted from 1.
pub(super) fn line_of(text: &[u8], start: usize) -> usize {
    1 + text[..start.min(text.len())].iter().filter(|&&byte| byte == b'\n').count()
}

/// The item called `name` inside `item`, and where its key begins.
fn step<'a>(item: &'a Item, name: &str) -> Option<(Option<usize>, &'a Item)> {
    let (key, next) = item.as_table_like()?.get_key_value(name)?;
    Some((key.span().map(|span| span.start), next))
}
