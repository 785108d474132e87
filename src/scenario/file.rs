//! Gets the text of a scenario: from a file, or from the built-in ones.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::builtin;
use super::error::ScenarioError;
use super::suggest::did_you_mean;

/// The longest file that is read as a scenario.
const LARGEST: u64 = 1 << 20;

/// A scenario's text, before anybody has understood it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fetched {
    /// The file's stem, or the built-in name.
    pub(super) name: String,
    /// What it says.
    pub(super) text: String,
    /// Where its relative paths start: beside the file; for a built-in one, where the user stands.
    pub(super) folder: PathBuf,
}

/// The scenario that `source` names: a file, or a built-in one.
pub(super) fn fetch(source: &str) -> Result<Fetched, ScenarioError> {
    let path = Path::new(source);
    if !path.is_file()
        && let Some(text) = builtin::text(source)
    {
        return Ok(Fetched { name: source.to_owned(), text: text.to_owned(), folder: PathBuf::new() });
    }
    let wrong = |message: String| ScenarioError::of_file(source, message);
    if path.is_dir() {
        return Err(wrong("is a directory, not a scenario; name a file in it".to_owned()));
    }
    let file = File::open(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => wrong(missing(source)),
        _ => wrong(format!("cannot be read: {error}")),
    })?;
    let mut bytes = Vec::new();
    file.take(LARGEST + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| wrong(format!("cannot be read: {error}")))?;
    if bytes.len() as u64 > LARGEST {
        return Err(wrong("is larger than 1 MiB; a scenario is a short TOML text".to_owned()));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        wrong(format!("is not UTF-8 text (byte {at}); a scenario is a TOML text"))
    })?;
    Ok(Fetched { name: stem(path), text, folder: folder_of(path) })
}

/// The folder of the file that `path` names; of a link, that of the file to which it leads in the end. What leads to no
/// file, such as a pipe, has none but its own.
fn folder_of(path: &Path) -> PathBuf {
    let target = if path.is_symlink() { path.canonicalize().ok() } else { None };
    target.as_deref().unwrap_or(path).parent().unwrap_or(Path::new("")).to_owned()
}

fn missing(source: &str) -> String {
    let names = || builtin::list().iter().map(|(name, _)| *name);
    let stem =
        Path::new(source).file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let list = format!("built in are {}", names().collect::<Vec<_>>().join(", "));
    format!("is neither a file nor a built-in scenario; {}", did_you_mean(&stem, names(), &list))
}

/// The file's name without its ending; never empty and never a path of its own.
fn stem(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    if stem.trim_matches('.').is_empty() { "scenario".to_owned() } else { stem }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(source: &str) -> String {
        fetch(source).unwrap_err().to_string()
    }

    #[test]
    fn what_is_not_a_scenario_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
        assert!(message(&path("")).contains("is a directory"));
        assert!(message(&path("none.toml")).contains("neither a file nor a built-in"));
        assert!(message("sheer").contains("did you mean `shear`?"));
        std::fs::write(path("binary"), [0xff, 0xfe, 0x00]).unwrap();
        assert!(message(&path("binary")).contains("not UTF-8"));
        std::fs::write(path("large"), vec![b'#'; (LARGEST + 1) as usize]).unwrap();
        assert!(message(&path("large")).contains("larger than 1 MiB"));
    }

    #[cfg(unix)]
    #[test]
    fn relative_paths_start_beside_the_file_and_not_beside_a_link_to_it() {
        use std::os::unix::fs::symlink;
        let place = tempfile::tempdir().unwrap();
        let root = place.path().canonicalize().unwrap();
        std::fs::create_dir_all(root.join("real")).unwrap();
        std::fs::create_dir_all(root.join("links")).unwrap();
        std::fs::write(root.join("real/a.toml"), "").unwrap();
        symlink("../real/a.toml", root.join("links/b.toml")).unwrap();
        symlink("b.toml", root.join("links/c.toml")).unwrap();
        for link in ["links/b.toml", "links/c.toml"] {
            let fetched = fetch(&root.join(link).to_string_lossy()).unwrap();
            assert_eq!(fetched.folder, root.join("real"), "{link}");
            // The run is called by the name that was given.
            assert_eq!(fetched.name, stem(Path::new(link)));
        }
    }

    #[test]
    fn a_name_is_the_stem() {
        assert_eq!(stem(Path::new("a/b.c.toml")), "b.c");
        assert_eq!(stem(Path::new("a/...toml")), "scenario");
        assert_eq!(fetch("shear").unwrap().name, "shear");
    }
}
