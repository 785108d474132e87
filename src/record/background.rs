//! Compresses and writes the messages of a log beside the run, one after another in the order in which they come.

use std::fs::File;
use std::io::{BufWriter, Error, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use mcap::records::MessageHeader;

use super::error::LogError;

/// Bundles that may wait while one is written: who brings more waits too, so that memory stays bounded.
const WAITING: usize = 2;

/// What writes the records of a file.
pub(crate) type FileWriter = mcap::Writer<BufWriter<File>>;

/// A message as it goes into the file, but for its compression.
#[derive(Clone, Debug)]
pub(crate) struct Encoded {
    /// Channel, place in its sequence, time.
    pub(crate) header: MessageHeader,
    /// The message.
    pub(crate) data: Vec<u8>,
}

/// Something to be done to the file.
#[derive(Debug)]
enum Order {
    /// Write these messages; then hand everything to the system, where `flush` says so.
    Write { messages: Vec<Encoded>, flush: bool },
    /// Hand everything to the system, and say when it is done.
    Flush(SyncSender<()>),
}

/// A file that is written by a thread of its own. Once something could not be written nothing else is, and everybody
/// who asks is told.
pub(crate) struct Background {
    path: PathBuf,
    orders: Option<SyncSender<Order>>,
    thread: Option<JoinHandle<mcap::McapResult<FileWriter>>>,
}

impl std::fmt::Debug for Background {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Background").field("path", &self.path).finish_non_exhaustive()
    }
}

impl Background {
    /// Starts a thread for what `writer` writes to `path`.
    pub(crate) fn start(path: &Path, writer: FileWriter) -> Result<Self, LogError> {
        let (orders, inbox) = sync_channel(WAITING);
        let thread = std::thread::Builder::new()
            .name("log".to_owned())
            .spawn(move || work(writer, &inbox))
            .map_err(|source| LogError::write(path, source))?;
        Ok(Background { path: path.to_owned(), orders: Some(orders), thread: Some(thread) })
    }

    /// Where the file is.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Gives `messages` to be written, and to be handed to the system where `flush` says so. Waits where too much
    /// waits already.
    pub(crate) fn write(&mut self, messages: Vec<Encoded>, flush: bool) -> Result<(), LogError> {
        self.give(Order::Write { messages, flush })
    }

    /// Waits until everything given so far is handed to the system.
    pub(crate) fn flush(&mut self) -> Result<(), LogError> {
        let (done, wait) = sync_channel(0);
        self.give(Order::Flush(done))?;
        wait.recv().map_err(|_| self.failure())
    }

    /// Whether everything that was tried so far could be written.
    pub(crate) fn check(&mut self) -> Result<(), LogError> {
        match &self.thread {
            Some(thread) if !thread.is_finished() => Ok(()),
            _ => Err(self.failure()),
        }
    }

    /// Ends the file once everything is written: its end and its index, and everything on the disk.
    pub(crate) fn finish(mut self) -> Result<(), LogError> {
        let writer = self.end().unwrap_or_else(|| Err(given_up()));
        let end = |mut writer: FileWriter| {
            writer.finish()?;
            let mut file = writer.into_inner();
            file.flush()?;
            file.get_ref().sync_all()?;
            Ok(())
        };
        writer.and_then(end).map_err(|source| LogError::write(&self.path, source))
    }

    fn give(&mut self, order: Order) -> Result<(), LogError> {
        let given = self.orders.as_ref().is_some_and(|orders| orders.send(order).is_ok());
        if given { Ok(()) } else { Err(self.failure()) }
    }

    /// Why the thread has stopped.
    fn failure(&mut self) -> LogError {
        let source = match self.end() {
            Some(Err(source)) => source,
            Some(Ok(_)) | None => given_up(),
        };
        LogError::write(&self.path, source)
    }

    /// Waits for the thread to finish its work; nothing where that is over.
    fn end(&mut self) -> Option<mcap::McapResult<FileWriter>> {
        self.orders = None;
        let thread = self.thread.take()?;
        Some(thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    }
}

/// Whoever drops a log without its end still gets what it was given, as far as that can be written.
impl Drop for Background {
    fn drop(&mut self) {
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            // There is nobody left to be told of errors: a run that ends well calls `finish`.
            let _ = thread.join();
        }
    }
}

fn given_up() -> mcap::McapError {
    Error::other("it was given up after an earlier error").into()
}

/// Does what is ordered until nobody orders any more, or until something fails.
fn work(mut writer: FileWriter, orders: &Receiver<Order>) -> mcap::McapResult<FileWriter> {
    for order in orders {
        match order {
            Order::Write { messages, flush } => {
                for Encoded { header, data } in messages {
                    writer.write_to_known_channel(&header, &data)?;
                }
                if flush {
                    writer.flush()?;
                }
            }
            Order::Flush(done) => {
                writer.flush()?;
                // Nobody may be waiting any more; the file does not care.
                let _ = done.send(());
            }
        }
    }
    Ok(writer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::writer::options;

    #[test]
    fn once_something_could_not_be_written_everybody_is_told() {
        let file = tempfile::NamedTempFile::new().unwrap();
        // Opened for reading alone: the system takes nothing.
        let closed = File::open(file.path()).unwrap();
        let writer = options().create(BufWriter::new(closed)).unwrap();
        let mut log = Background::start(file.path(), writer).unwrap();
        // A few bundles are taken before it shows; nobody waits for ever.
        let refused = (0..WAITING + 4).filter(|_| log.write(Vec::new(), true).is_err()).count();
        assert!(refused >= 2, "{refused}");
        assert!(log.check().is_err() && log.flush().is_err());
        assert!(log.finish().is_err());
    }

    #[test]
    fn the_first_to_ask_hears_the_reason() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let writer = options().create(BufWriter::new(File::open(file.path()).unwrap())).unwrap();
        let mut log = Background::start(file.path(), writer).unwrap();
        let said = log.flush().unwrap_err().to_string();
        assert!(said.contains("cannot write to the log") && said.contains("os error"), "{said}");
    }
}
