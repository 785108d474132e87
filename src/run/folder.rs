//! The folder of a run: claimed before anything is written, and never at the cost of an older run.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::placing::{PlacingError, beside, put};
use crate::record::LOG;
use crate::record::summary::SUMMARY;

/// Files of a run folder, beside its [`LOG`].
pub const SERIES: &str = "series.csv";
/// The page.
pub const REPORT: &str = "report.html";
/// The folder of the profiles.
pub const PROFILES: &str = "profiles";

/// What tells a folder that `run`, `compare` or `calibrate` has written.
const OWN: [&str; 5] = [LOG, SUMMARY, "comparison.json", "calibration.json", "initial-1"];

/// Why a folder cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// There is something in it.
    #[error("{} already holds something; choose another folder with --out, or replace it with --force", path.display())]
    Exists {
        /// The folder.
        path: PathBuf,
    },
    /// Nothing in it comes from here.
    #[error("{} holds no run, comparison or calibration, so that it is not replaced; choose another folder with --out", path.display())]
    NotOurs {
        /// The folder.
        path: PathBuf,
    },
    /// It holds the folder that the program was started in.
    #[error("{} is the folder that you are in, or holds it, and cannot be replaced; choose another one with --out", path.display())]
    Here {
        /// The folder.
        path: PathBuf,
    },
    /// It is something else.
    #[error("{} is a file, not a folder; choose a folder with --out", path.display())]
    NotAFolder {
        /// The file.
        path: PathBuf,
    },
    /// The run is complete and cannot be put in its place.
    #[error(
        "the run is complete, but cannot take the place of {}, which stands as it was: {source}; it is kept in {}",
        path.display(), working.display()
    )]
    Unsettled {
        /// The folder.
        path: PathBuf,
        /// Where the new run stands.
        working: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The run stands in its place, and the old one is not gone.
    #[error("the run stands in {}, but {source}", path.display())]
    Leftover {
        /// The folder.
        path: PathBuf,
        /// Where the old run is, and why.
        source: PlacingError,
    },
    /// The system refuses.
    #[error("cannot use {} as a run folder: {source}", path.display())]
    Io {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}

impl FolderError {
    /// Whether the folder was ill chosen, rather than the disk full.
    pub fn is_bad_input(&self) -> bool {
        use io::ErrorKind::{AlreadyExists, InvalidFilename, NotADirectory};
        match self {
            FolderError::Exists { .. }
            | FolderError::NotAFolder { .. }
            | FolderError::NotOurs { .. }
            | FolderError::Here { .. } => true,
            FolderError::Io { source, .. } => {
                matches!(source.kind(), AlreadyExists | InvalidFilename | NotADirectory)
            }
            FolderError::Unsettled { .. } | FolderError::Leftover { .. } => false,
        }
    }
}

/// A folder that a run writes to.
#[derive(Debug)]
pub struct RunFolder {
    /// Where files are written now.
    working: PathBuf,
    /// Where they shall stand.
    wanted: PathBuf,
    /// Folders that were made for this, the innermost first.
    made: Vec<PathBuf>,
}

impl RunFolder {
    /// Makes the folder. One that holds something is refused; with `force` the run is written beside it
    /// and takes its place at the end, so that the old run survives a failure.
    pub fn claim(wanted: &Path, force: bool) -> Result<Self, FolderError> {
        // Links stay what they are: the folder that they lead to is the one that is meant.
        let wanted: &Path = &wanted.components().collect::<PathBuf>();
        let found = if wanted.is_symlink() || wanted.file_name().is_none() {
            wanted.canonicalize().ok()
        } else {
            None
        };
        let wanted = found.as_deref().unwrap_or(wanted);
        if wanted.exists() && !wanted.is_dir() {
            return Err(FolderError::NotAFolder { path: wanted.to_owned() });
        }
        let occupied = is_occupied(wanted).map_err(|source| io_error(wanted, source))?;
        if occupied && !force {
            return Err(FolderError::Exists { path: wanted.to_owned() });
        }
        if occupied && is_here(wanted) {
            return Err(FolderError::Here { path: wanted.to_owned() });
        }
        if occupied && !OWN.iter().any(|name| wanted.join(name).exists()) {
            return Err(FolderError::NotOurs { path: wanted.to_owned() });
        }
        let working = if occupied { beside(wanted, "new") } else { wanted.to_owned() };
        let is_new = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
        let made = working.ancestors().take_while(is_new).map(Path::to_owned).collect();
        fs::create_dir_all(&working).map_err(|source| io_error(&working, source))?;
        Ok(RunFolder { working, wanted: wanted.to_owned(), made })
    }

    /// Where to write.
    pub fn path(&self) -> &Path {
        &self.working
    }

    /// Gives the folder up before anything was written to it.
    pub fn abandon(self) {
        // They only go where they are empty; if the system will not have it, an empty folder stays behind.
        for folder in &self.made {
            let _ = fs::remove_dir(folder);
        }
    }

    /// Puts the run in its place, and returns that.
    pub fn settle(self) -> Result<PathBuf, FolderError> {
        if self.working != self.wanted {
            put(&self.working, &self.wanted).map_err(|source| {
                let (path, working) = (self.wanted.clone(), self.working.clone());
                match source {
                    PlacingError::Refused(source) => FolderError::Unsettled { path, working, source },
                    leftover => FolderError::Leftover { path, source: leftover },
                }
            })?;
        }
        Ok(self.wanted)
    }
}

/// Takes away what a run has written to `folder`, and the folder where it holds nothing else.
pub fn take_away_run(folder: &Path) -> io::Result<()> {
    for name in [LOG, SERIES, SUMMARY, REPORT] {
        match fs::remove_file(folder.join(name)) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
    }
    match fs::remove_dir_all(folder.join(PROFILES)) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    match fs::remove_dir(folder) {
        Err(error) if error.kind() != io::ErrorKind::DirectoryNotEmpty => Err(error),
        _ => Ok(()),
    }
}

/// Whether `folder` is the current one, or above it.
fn is_here(folder: &Path) -> bool {
    let here = std::env::current_dir().and_then(fs::canonicalize);
    here.is_ok_and(|here| folder.canonicalize().is_ok_and(|folder| here.starts_with(folder)))
}

fn is_occupied(path: &Path) -> io::Result<bool> {
    match fs::read_dir(path) {
        Ok(mut entries) => Ok(entries.next().is_some()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

fn io_error(path: &Path, source: io::Error) -> FolderError {
    FolderError::Io { path: path.to_owned(), source }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_old_run_is_refused_or_replaced_at_the_end() {
        let place = tempfile::tempdir().unwrap();
        let wanted = place.path().join("run");
        fs::create_dir(&wanted).unwrap();
        fs::write(wanted.join("log.mcap"), "old").unwrap();
        assert!(matches!(RunFolder::claim(&wanted, false), Err(FolderError::Exists { .. })));
        let folder = RunFolder::claim(&wanted, true).unwrap();
        fs::write(folder.path().join("log.mcap"), "new").unwrap();
        assert_eq!(fs::read_to_string(wanted.join("log.mcap")).unwrap(), "old");
        folder.settle().unwrap();
        assert_eq!(fs::read_to_string(wanted.join("log.mcap")).unwrap(), "new");
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    }

    #[test]
    fn what_others_wrote_is_not_replaced_and_links_stay() {
        let place = tempfile::tempdir().unwrap();
        let (wanted, link) = (place.path().join("thesis"), place.path().join("link"));
        fs::create_dir(&wanted).unwrap();
        fs::write(wanted.join("thesis.tex"), "years").unwrap();
        assert!(matches!(RunFolder::claim(&wanted, true), Err(FolderError::NotOurs { .. })));
        fs::write(wanted.join(LOG), "old").unwrap();
        std::os::unix::fs::symlink(&wanted, &link).unwrap();
        let folder = RunFolder::claim(&link, true).unwrap();
        fs::write(folder.path().join(LOG), "new").unwrap();
        folder.settle().unwrap();
        assert!(link.is_symlink());
        assert_eq!(fs::read_to_string(wanted.join(LOG)).unwrap(), "new");
        let here = std::env::current_dir().unwrap();
        assert!(is_here(&here) && !is_here(&wanted));
    }

    #[test]
    fn a_run_goes_and_what_others_put_beside_it_stays() {
        let place = tempfile::tempdir().unwrap();
        let run = place.path().join("run");
        let write = || {
            fs::create_dir_all(run.join(PROFILES)).unwrap();
            fs::write(run.join(LOG), "").unwrap();
            fs::write(run.join(PROFILES).join("a.csv"), "").unwrap();
        };
        write();
        fs::write(run.join("notes.txt"), "mine").unwrap();
        take_away_run(&run).unwrap();
        let left: Vec<_> = fs::read_dir(&run).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, ["notes.txt"]);
        fs::remove_file(run.join("notes.txt")).unwrap();
        write();
        take_away_run(&run).unwrap();
        assert!(!run.exists());
    }

    #[test]
    fn a_folder_that_is_given_up_leaves_nothing_behind_but_what_was_there() {
        let place = tempfile::tempdir().unwrap();
        fs::create_dir(place.path().join("old")).unwrap();
        RunFolder::claim(&place.path().join("old/a/b"), false).unwrap().abandon();
        RunFolder::claim(&place.path().join("old"), false).unwrap().abandon();
        assert!(place.path().join("old").exists() && !place.path().join("old/a").exists());
    }
}
