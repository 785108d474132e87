//! The server: one thread per connection, none of which can hold up the others or end the program.

use core::time::Duration;
use std::io::{ErrorKind, Read, Write};
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};
use std::thread;

use super::error::ViewError;
use super::log::ViewedLog;
use super::response::Response;
use super::site::Site;
use crate::stopwatch::Stopwatch;

/// The head of a request may be this long [byte].
const LONGEST_HEAD: usize = 16_384;
/// Bytes handed over at a time, and read of what nobody wants to know.
const BLOCK: usize = 65_536;

/// What clients may take.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Connections at a time; others are told to come back.
    pub connections: usize,
    /// How long a request may take to arrive [s].
    pub request_seconds: f64,
    /// How long an answer may take to be fetched [s].
    pub answer_seconds: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Limits { connections: 64, request_seconds: 5.0, answer_seconds: 30.0 }
    }
}

/// A server of logs on this machine alone.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    site: Arc<Site>,
    limits: Limits,
    port: u16,
}

impl Server {
    /// Listens on 127.0.0.1 at `port`, or one that is free where it is 0, and will show `logs`.
    pub fn bind(logs: Vec<ViewedLog>, port: u16, limits: Limits) -> Result<Self, ViewError> {
        let failed = |source| ViewError::Listen { port, source };
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(failed)?;
        let port = listener.local_addr().map_err(failed)?.port();
        Ok(Server { listener, site: Arc::new(Site::new(logs, port)?), limits, port })
    }

    /// The address of the page, with its token.
    pub fn address(&self) -> String {
        self.site.address()
    }

    /// Where it listens.
    pub fn port(&self) -> u16 {
        self.port
    }

    /// Serves until `stop` is set and [`wake`] is called.
    pub fn run(&self, stop: &AtomicBool) {
        let open = Arc::new(AtomicUsize::new(0));
        while !stop.load(SeqCst) {
            let Ok((stream, _)) = self.listener.accept() else {
                // Too many files are open: some will be closed.
                thread::sleep(Duration::from_millis(20));
                continue;
            };
            let place = Place::take(&open);
            let (site, limits) = (Arc::clone(&self.site), self.limits);
            if place.number > limits.connections {
                // Short enough for any buffer: nobody waits.
                let _ = send(&stream, &Response::refusal(503, "too many connections"), 0.1);
                continue;
            }
            let serve = move || {
                converse(&stream, &site, limits);
                drop(place);
            };
            // Without a thread the connection is closed, and the browser asks again.
            let _ = thread::Builder::new().name("view".to_owned()).spawn(serve);
        }
    }
}

/// Makes [`Server::run`] at `port` look whether it should stop.
pub fn wake(port: u16) {
    let _ = TcpStream::connect((Ipv4Addr::LOCALHOST, port));
}

/// One of the connections that may be open, until it is dropped.
struct Place {
    open: Arc<AtomicUsize>,
    number: usize,
}

impl Place {
    fn take(open: &Arc<AtomicUsize>) -> Self {
        Place { open: Arc::clone(open), number: open.fetch_add(1, SeqCst) + 1 }
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.open.fetch_sub(1, SeqCst);
    }
}

/// Hears one request and answers it.
fn converse(stream: &TcpStream, site: &Site, limits: Limits) {
    let answer = match head(stream, limits.request_seconds) {
        Ok(Some(head)) => site.respond(&head),
        Ok(None) => Response::refusal(431, "the request is too long"),
        Err(error) if is_late(&error) => Response::refusal(408, "the request took too long"),
        Err(_) => return,
    };
    if send(stream, &answer, limits.answer_seconds).is_err() || stream.shutdown(Shutdown::Write).is_err() {
        return;
    }
    // A connection closed over unread bytes would take the answer with it.
    let watch = Stopwatch::default();
    let mut rest = [0; 4096];
    let mut budget = 16 * BLOCK;
    while budget > 0
        && watch.seconds() < 1.0
        && stream.set_read_timeout(Some(Duration::from_millis(200))).is_ok()
    {
        match (&mut &*stream).read(&mut rest) {
            Ok(count) if count > 0 => budget = budget.saturating_sub(count),
            _ => break,
        }
    }
}

/// The bytes of a request up to the empty line; `None` where they are too many.
fn head(stream: &TcpStream, seconds: f64) -> std::io::Result<Option<Vec<u8>>> {
    let watch = Stopwatch::default();
    let mut bytes = Vec::new();
    let mut block = [0; 4096];
    loop {
        stream.set_read_timeout(Some(left(&watch, seconds)?))?;
        let count = (&mut &*stream).read(&mut block)?;
        if count == 0 {
            // The client has said all: the parser tells whether that is enough.
            return Ok(Some(bytes));
        }
        let known = bytes.len().saturating_sub(3);
        bytes.extend_from_slice(&block[..count]);
        if let Some(end) = bytes[known..].windows(4).position(|four| four == b"\r\n\r\n") {
            bytes.truncate(known + end + 4);
            return Ok((bytes.len() <= LONGEST_HEAD).then_some(bytes));
        }
        if bytes.len() > LONGEST_HEAD {
            return Ok(None);
        }
    }
}

/// Hands over an answer, in no more than `seconds`.
fn send(stream: &TcpStream, answer: &Response, seconds: f64) -> std::io::Result<()> {
    let watch = Stopwatch::default();
    let bytes = answer.bytes();
    let mut rest = bytes.as_slice();
    while !rest.is_empty() {
        stream.set_write_timeout(Some(left(&watch, seconds)?))?;
        match (&mut &*stream).write(&rest[..rest.len().min(BLOCK)]) {
            Ok(0) => return Err(ErrorKind::WriteZero.into()),
            Ok(count) => rest = &rest[count..],
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

/// What is left of `seconds`.
fn left(watch: &Stopwatch, seconds: f64) -> std::io::Result<Duration> {
    let left = seconds - watch.seconds();
    if left > 0.0 { Ok(Duration::from_secs_f64(left.max(0.001))) } else { Err(ErrorKind::TimedOut.into()) }
}

fn is_late(error: &std::io::Error) -> bool {
    matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock)
}
