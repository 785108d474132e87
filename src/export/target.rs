//! Where an export goes: written under another name beside it, and put in its place when it is complete.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use crate::placing::{PlacingError, beside, put};
use crate::record::is_log;

/// Why a place cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum TargetError {
    /// There is something.
    #[error("{} is there already; choose another place with {option}, or replace it with --force", path.display())]
    Exists {
        /// The place.
        path: PathBuf,
        /// The option that names another one.
        option: &'static str,
    },
    /// There is something that no export has written.
    #[error("{} is there and is no earlier export of this kind, so that it is not replaced; choose another place with {option}", path.display())]
    NotOurs {
        /// The place.
        path: PathBuf,
        /// The option that names another one.
        option: &'static str,
    },
    /// The new one stands in its place, and the old one is not gone.
    #[error("{} is written, but {source}", path.display())]
    Leftover {
        /// The place.
        path: PathBuf,
        /// Where the old one is, and why.
        source: PlacingError,
    },
    /// The system refuses.
    #[error("cannot write {}: {source}; nothing is left of it, and what was there before stands as it was", path.display())]
    Io {
        /// The place.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}

/// A file, or a folder of files, that is being written. What is not [`Target::settle`]d is taken away.
#[derive(Debug)]
pub struct Target {
    working: PathBuf,
    wanted: PathBuf,
    is_settled: bool,
}

impl Target {
    /// A file at `wanted`; an older file is replaced with `force` only, and a log never. `option` names the place on the command line.
    pub fn file(wanted: &Path, force: bool, option: &'static str) -> Result<Self, TargetError> {
        if wanted.is_dir() || (wanted.is_file() && is_log(wanted)) {
            return Err(TargetError::NotOurs { path: wanted.to_owned(), option });
        }
        Self::claim(wanted, force, option)
    }

    /// A folder at `wanted`; an older one is replaced with `force`, and only if all it holds are files that end in one
    /// of `endings`.
    pub fn folder(
        wanted: &Path,
        force: bool,
        endings: &[&str],
        option: &'static str,
    ) -> Result<Self, TargetError> {
        if wanted.is_file() || (force && wanted.is_dir() && !holds_only(wanted, endings)) {
            return Err(TargetError::NotOurs { path: wanted.to_owned(), option });
        }
        let target = Self::claim(wanted, force, option)?;
        fs::create_dir(&target.working).map_err(|source| target.failed(source))?;
        Ok(target)
    }

    fn claim(wanted: &Path, force: bool, option: &'static str) -> Result<Self, TargetError> {
        let is_there = wanted.symlink_metadata().is_ok();
        if is_there && !force {
            return Err(TargetError::Exists { path: wanted.to_owned(), option });
        }
        let target =
            Target { working: beside(wanted, "partial"), wanted: wanted.to_owned(), is_settled: false };
        if let Some(folder) = wanted.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            fs::create_dir_all(folder).map_err(|source| target.failed(source))?;
        }
        Ok(target)
    }

    /// Where to write.
    pub fn working(&self) -> &Path {
        &self.working
    }

    /// The file to write to.
    pub fn create(&self) -> Result<File, TargetError> {
        File::create(&self.working).map_err(|source| self.failed(source))
    }

    /// Puts what was written in its place, and returns that.
    pub fn settle(mut self) -> Result<PathBuf, TargetError> {
        match put(&self.working, &self.wanted) {
            Ok(()) => {}
            Err(PlacingError::Refused(source)) => return Err(self.failed(source)),
            Err(leftover) => {
                self.is_settled = true;
                return Err(TargetError::Leftover { path: self.wanted.clone(), source: leftover });
            }
        }
        self.is_settled = true;
        Ok(self.wanted.clone())
    }

    /// The error of writing here.
    pub fn failed(&self, source: io::Error) -> TargetError {
        TargetError::Io { path: self.wanted.clone(), source }
    }
}

impl Drop for Target {
    fn drop(&mut self) {
        if !self.is_settled {
            // It may not be there yet; and if the system will not have it, a file with another name stays behind.
            let _ = match self.working.is_dir() {
                true => fs::remove_dir_all(&self.working),
                false => fs::remove_file(&self.working),
            };
        }
    }
}

impl TargetError {
    /// Whether the place was ill chosen, rather than the disk full.
    pub fn is_bad_input(&self) -> bool {
        matches!(self, TargetError::Exists { .. } | TargetError::NotOurs { .. })
    }
}

/// Whether `folder` holds nothing but files with these `endings`.
fn holds_only(folder: &Path, endings: &[&str]) -> bool {
    let Ok(mut entries) = fs::read_dir(folder) else { return false };
    entries.all(|entry| {
        entry.is_ok_and(|entry| {
            let path = entry.path();
            path.is_file()
                && path.extension().is_some_and(|ending| endings.iter().any(|wanted| ending == *wanted))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_settled_leaves_nothing() {
        let place = tempfile::tempdir().unwrap();
        let wanted = place.path().join("a.xyz");
        fs::write(&wanted, "old").unwrap();
        assert!(matches!(Target::file(&wanted, false, "--out"), Err(TargetError::Exists { .. })));
        let target = Target::file(&wanted, true, "--out").unwrap();
        fs::write(target.working(), "half").unwrap();
        drop(target);
        assert_eq!(fs::read_to_string(&wanted).unwrap(), "old");
        let target = Target::file(&wanted, true, "--out").unwrap();
        fs::write(target.working(), "new").unwrap();
        target.settle().unwrap();
        assert_eq!(fs::read_to_string(&wanted).unwrap(), "new");
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_log_is_never_replaced() {
        let place = tempfile::tempdir().unwrap();
        let log = place.path().join("log.mcap");
        fs::write(&log, [mcap::MAGIC, b"and more"].concat()).unwrap();
        assert!(matches!(Target::file(&log, true, "--out"), Err(TargetError::NotOurs { .. })));
    }

    #[test]
    fn a_folder_of_other_things_is_never_replaced() {
        let place = tempfile::tempdir().unwrap();
        let wanted = place.path().join("frames");
        fs::create_dir(&wanted).unwrap();
        fs::write(wanted.join("a.vtp"), "old").unwrap();
        assert!(matches!(Target::folder(&wanted, false, &["vtp"], "--out"), Err(TargetError::Exists { .. })));
        let target = Target::folder(&wanted, true, &["vtp"], "--out").unwrap();
        fs::write(target.working().join("b.vtp"), "new").unwrap();
        target.settle().unwrap();
        assert!(wanted.join("b.vtp").is_file() && !wanted.join("a.vtp").exists());
        fs::write(wanted.join("thesis.tex"), "").unwrap();
        let refused = Target::folder(&wanted, true, &["vtp"], "--out");
        assert!(matches!(refused, Err(TargetError::NotOurs { .. })));
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    }
}
