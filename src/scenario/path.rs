//! The way to a value: the names of its tables and its key.

use std::fmt;

/// Names from the root to a value; an element of an array is named `[n]`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct KeyPath(Vec<String>);

impl KeyPath {
    /// The path of these names.
    pub(super) fn of(names: impl IntoIterator<Item = impl Into<String>>) -> Self {
        KeyPath(names.into_iter().map(Into::into).collect())
    }

    /// The path of `key` inside this one.
    pub(super) fn join(&self, key: &str) -> Self {
        let mut names = self.0.clone();
        names.push(key.to_owned());
        KeyPath(names)
    }

    /// The path of element `index` inside this one.
    pub(super) fn element(&self, index: usize) -> Self {
        self.join(&format!("[{index}]"))
    }

    /// The names in order.
    pub(super) fn names(&self) -> &[String] {
        &self.0
    }

    /// Whether this path is `other` or leads to it.
    pub(super) fn holds(&self, other: &KeyPath) -> bool {
        other.0.starts_with(&self.0)
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, name) in self.0.iter().enumerate() {
            if k > 0 && !name.starts_with('[') {
                f.write_str(".")?;
            }
            f.write_str(name)?;
        }
        Ok(())
    }
}
