//! What takes moments and makes files of them.

use std::fs::File;
use std::io::{self, BufWriter, Write};

use super::moment::Moment;

/// A format at work.
pub(super) trait Sink {
    /// Writes one moment.
    fn add(&mut self, moment: &Moment) -> io::Result<()>;
    /// Writes what comes last, and everything onto the disk.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

/// A sink that writes all moments below each other, as text.
pub(super) struct TextSink<F> {
    file: BufWriter<File>,
    write: F,
}

impl<F: FnMut(&mut dyn Write, &Moment) -> io::Result<()>> TextSink<F> {
    /// Writes to `file` what `write` makes of each moment.
    pub(super) fn new(file: File, write: F) -> Self {
        TextSink { file: BufWriter::new(file), write }
    }
}

impl<F: FnMut(&mut dyn Write, &Moment) -> io::Result<()>> Sink for TextSink<F> {
    fn add(&mut self, moment: &Moment) -> io::Result<()> {
        (self.write)(&mut self.file, moment)
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        finish(self.file)
    }
}

/// Hands everything over to the disk.
pub(super) fn finish(mut file: BufWriter<File>) -> io::Result<()> {
    file.flush()?;
    file.get_ref().sync_all()
}
