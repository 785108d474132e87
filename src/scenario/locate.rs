//! Where a key stands: a line of the file as the user wrote it, or an option of the command line.

use toml_edit::{Document, Item, TableLike};

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
        let mut place = Node::Item(self.document.as_item());
        let mut start = None;
        for name in names {
            let (next_start, next) = step(place, name)?;
            start = next_start.or(start);
            place = next;
        }
        let text = self.document.raw().as_bytes();
        start.map(|start| line_of(text, start))
    }
}

/// The line that byte `start` of `text` is on, counted from 1.
pub(super) fn line_of(text: &[u8], start: usize) -> usize {
    1 + text[..start.min(text.len())].iter().filter(|&&byte| byte == b'\n').count()
}

/// A place in the tree.
#[derive(Clone, Copy)]
enum Node<'a> {
    Item(&'a Item),
    /// An element of a list of tables.
    Table(&'a dyn TableLike),
}

/// What is called `name` inside `node`, and where it begins: a key, or an element `[n]` of a list of tables.
fn step<'a>(node: Node<'a>, name: &str) -> Option<(Option<usize>, Node<'a>)> {
    let table = match node {
        Node::Table(table) => table,
        Node::Item(item) => match name.strip_prefix('[') {
            Some(rest) => return element(item, rest.strip_suffix(']')?.parse().ok()?),
            None => item.as_table_like()?,
        },
    };
    let (key, next) = table.get_key_value(name)?;
    let start = key.span().or_else(|| next.span()).map(|span| span.start);
    Some((start, Node::Item(next)))
}

/// Table `index` of a list of tables, and where it begins.
fn element(item: &Item, index: usize) -> Option<(Option<usize>, Node<'_>)> {
    if let Some(table) = item.as_array_of_tables().and_then(|list| list.get(index)) {
        return Some((table.span().map(|span| span.start), Node::Table(table)));
    }
    let table = item.as_array()?.get(index)?.as_inline_table()?;
    Some((table.span().map(|span| span.start), Node::Table(table)))
}
