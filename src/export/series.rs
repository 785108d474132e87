//! A folder with a file for every moment and a collection that gives them their times.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

use super::moment::Moment;
use super::sink::{Sink, finish};
use super::vtk::collection;

/// A sink that writes `<stem>-<number>.<ending>` for every moment, and `<stem>.pvd`.
pub(super) struct SeriesSink<F> {
    folder: PathBuf,
    stem: &'static str,
    ending: &'static str,
    write: F,
    /// Times [time] and names of the files so far.
    files: Vec<(f64, String)>,
}

impl<F: FnMut(&mut dyn Write, &Moment) -> io::Result<()>> SeriesSink<F> {
    /// Writes into `folder` what `write` makes of each moment.
    pub(super) fn new(folder: PathBuf, stem: &'static str, ending: &'static str, write: F) -> Self {
        SeriesSink { folder, stem, ending, write, files: Vec::new() }
    }
}

impl<F: FnMut(&mut dyn Write, &Moment) -> io::Result<()>> Sink for SeriesSink<F> {
    fn add(&mut self, moment: &Moment) -> io::Result<()> {
        let name = format!("{}-{:06}.{}", self.stem, moment.number, self.ending);
        let mut file = BufWriter::new(File::create(self.folder.join(&name))?);
        (self.write)(&mut file, moment)?;
        finish(file)?;
        self.files.push((moment.time, name));
        Ok(())
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        let place = self.folder.join(format!("{}.pvd", self.stem));
        let mut file = BufWriter::new(File::create(place)?);
        collection(&mut file, &self.files)?;
        finish(file)
    }
}
