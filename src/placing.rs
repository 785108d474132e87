//! Files and folders that take the place of others: written beside it, and put there when they are complete.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::machine::process_number;

/// Why something does not stand in its place, or not alone.
#[derive(Debug, thiserror::Error)]
pub enum PlacingError {
    /// The system refuses: what was there before stands as it was.
    #[error(transparent)]
    Refused(#[from] io::Error),
    /// The new one stands in its place; the old one is not gone.
    #[error("what was there before could not be taken away and stands in {}: {source}", old.display())]
    Leftover {
        /// Where the old one stands now.
        old: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}

/// A name beside `path` that no other process takes; `word` says what stands there.
pub fn beside(path: &Path, word: &str) -> PathBuf {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    path.with_file_name(format!("{name}.{word}-{}", process_number()))
}

/// Puts the file or folder `working` in the place `wanted`, whatever stands there.
pub fn put(working: &Path, wanted: &Path) -> Result<(), PlacingError> {
    if !wanted.is_dir() {
        fs::rename(working, wanted)?;
        return Ok(());
    }
    // A folder does not take the place of one that holds something.
    let old = beside(wanted, "old");
    fs::rename(wanted, &old)?;
    if let Err(error) = fs::rename(working, wanted) {
        fs::rename(&old, wanted)?;
        return Err(error.into());
    }
    fs::remove_dir_all(&old).map_err(|source| PlacingError::Leftover { old, source })
}

/// Writes `bytes` to the file at `path`, whole or not at all.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let working = beside(path, "new");
    let write = || {
        let mut file = File::create(&working)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&working, path)
    };
    let written = write();
    if written.is_err() {
        // What is left of it helps nobody; the first error says why.
        let _ = fs::remove_file(&working);
    }
    written
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let name =
            |entry: io::Result<fs::DirEntry>| entry.unwrap().file_name().to_string_lossy().into_owned();
        fs::read_dir(folder).unwrap().map(name).collect()
    }

    #[test]
    fn what_cannot_be_put_there_leaves_the_old_one() {
        let place = tempfile::tempdir().unwrap();
        let wanted = place.path().join("run");
        fs::create_dir(&wanted).unwrap();
        fs::write(wanted.join("log"), "old").unwrap();
        let missing = place.path().join("missing");
        assert!(matches!(put(&missing, &wanted), Err(PlacingError::Refused(_))));
        assert_eq!(fs::read_to_string(wanted.join("log")).unwrap(), "old");
        assert_eq!(names(place.path()), ["run"]);
    }

    #[test]
    fn a_file_is_written_whole_or_not_at_all() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("a.csv");
        write_whole(&path, b"old").unwrap();
        write_whole(&path, b"new").unwrap();
        assert_eq!(
            (fs::read(&path).unwrap(), names(place.path())),
            (b"new".to_vec(), vec!["a.csv".to_owned()])
        );
        // Nothing takes the place of a folder.
        let folder = place.path().join("folder");
        fs::create_dir(&folder).unwrap();
        assert!(write_whole(&folder, b"new").is_err());
        assert_eq!(names(place.path()).len(), 2);
    }
}
