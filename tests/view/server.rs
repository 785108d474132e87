//! The server among bad clients, the page as a file, the program.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, TcpStream};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use std::time::{Duration, Instant};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use grainflow::record::reader::read_log;
use grainflow::view::{Limits, Server, ViewedLog, export, wake};

use super::signal::send;
use super::{GRAINS, RECORDINGS, get, sample, word};

/// A server that runs until it is dropped.
struct Running {
    port: u16,
    path: String,
    stop: Arc<AtomicBool>,
    thread: Option<std::thread::JoinHandle<()>>,
    _folder: tempfile::TempDir,
}

impl Running {
    fn start(limits: Limits) -> Self {
        let (folder, path) = sample(None);
        let server = Server::bind(vec![ViewedLog::open(&path).unwrap()], 0, limits).unwrap();
        let (port, address) = (server.port(), server.address());
        let path = address.strip_prefix(&format!("http://127.0.0.1:{port}")).unwrap().to_owned();
        let stop = Arc::new(AtomicBool::new(false));
        let own = Arc::clone(&stop);
        let thread = Some(std::thread::spawn(move || server.run(&own)));
        Running { port, path, stop, thread, _folder: folder }
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect((Ipv4Addr::LOCALHOST, self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        stream
    }

    fn request(&self) -> Vec<u8> {
        get(&self.path, &format!("127.0.0.1:{}", self.port))
    }

    /// The whole answer to `request`.
    fn ask(&self, request: &[u8]) -> String {
        let mut stream = self.connect();
        // The server may have heard enough before all is said.
        let _ = stream.write_all(request);
        answer(&mut stream)
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.stop.store(true, SeqCst);
        wake(self.port);
        self.thread.take().unwrap().join().unwrap();
    }
}

fn answer(stream: &mut TcpStream) -> String {
    let mut bytes = Vec::new();
    let _ = stream.read_to_end(&mut bytes);
    String::from_utf8_lossy(&bytes).into_owned()
}

#[test]
fn two_clients_and_slow_ones_do_not_hinder_each_other() {
    let limits = Limits { request_seconds: 1.5, answer_seconds: 1.0, ..Limits::default() };
    let server = Running::start(limits);
    let begun = Instant::now();
    let request = server.request();
    // One says half of what it wants, one nothing, one says all and does not fetch the answer, one drips.
    let mut half = server.connect();
    half.write_all(&request[..20]).unwrap();
    let mut silent = server.connect();
    let mut deaf = server.connect();
    deaf.write_all(&request).unwrap();
    let mut drip = server.connect();
    let dripping = std::thread::spawn(move || {
        while drip.write_all(b"G").is_ok() && begun.elapsed() < Duration::from_secs(10) {
            std::thread::sleep(Duration::from_millis(100));
        }
        begun.elapsed()
    });
    let [mut first, mut second] = [server.connect(), server.connect()];
    first.write_all(&request).unwrap();
    second.write_all(&request).unwrap();
    for stream in [&mut second, &mut first] {
        assert!(answer(stream).starts_with("HTTP/1.1 200"));
    }
    assert!(begun.elapsed() < Duration::from_secs(1), "{:?}", begun.elapsed());
    for slow in [&mut half, &mut silent] {
        assert!(answer(slow).starts_with("HTTP/1.1 408"));
    }
    assert!(dripping.join().unwrap() < Duration::from_secs(8));
    assert!(server.ask(&request).starts_with("HTTP/1.1 200"));
}

#[test]
fn long_and_many_requests_are_turned_away_and_others_served() {
    let server = Running::start(Limits { connections: 4, ..Limits::default() });
    let long = format!("GET /{} HTTP/1.1\r\n", "x".repeat(1_000_000));
    assert!(server.ask(long.as_bytes()).starts_with("HTTP/1.1 431"));
    let [a, b, c, d] = [(); 4].map(|()| server.connect());
    // The connections are taken in order: the fifth comes when there are four.
    assert!(answer(&mut server.connect()).starts_with("HTTP/1.1 503"));
    drop([a, b, c, d]);
    for attempt in 0.. {
        let answer = server.ask(&server.request());
        if answer.starts_with("HTTP/1.1 200") {
            break;
        }
        assert!(attempt < 100, "{answer}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// The numbers that an exported page says it holds, and the bytes of its frames.
fn embedded(page: &str) -> (serde_json::Value, Vec<u8>) {
    let between = |start: &str| page.split_once(start).unwrap().1.split_once("</script>").unwrap().0;
    let about = serde_json::from_str(between("<script type=\"application/json\" id=\"about\">")).unwrap();
    (about, STANDARD.decode(between("<script type=\"text/plain\" id=\"data-0\">")).unwrap())
}

#[test]
fn an_exported_page_holds_frames_and_replaces_nothing_unasked() {
    let (folder, path) = sample(None);
    let page = folder.path().join("page.html");
    let logs = [ViewedLog::open(&path).unwrap()];
    let kept = export(&logs, &page, false).unwrap();
    assert_eq!((kept[0].frames, kept[0].points), (RECORDINGS, GRAINS as usize));
    let text = fs::read_to_string(&page).unwrap();
    let (about, bytes) = embedded(&text);
    assert_eq!(about["logs"][0]["times"].as_array().unwrap().len(), RECORDINGS);
    assert!(about["logs"][0]["remarks"][0].as_str().unwrap().contains("all 12 frames"));
    // The first frame is empty; the second begins behind its head and its row.
    let second = 56 + 24;
    assert_eq!([0, 4, 8, 12].map(|at| word(&bytes, second + at)), [GRAINS, 3, 3, 2]);
    let coarse = |at: usize| f64::from(u16::from_le_bytes([bytes[at], bytes[at + 1]])) / 65535.0;
    let frames = read_log(&path).unwrap().frames;
    let place = 40.0 * coarse(second + 80 + 4 * 77);
    assert!((place - f64::from(frames[1].positions[77][0])).abs() < 40.0 / 65535.0);
    assert!(
        text.contains("Content-Security-Policy") && !text.contains("http://") && !text.contains("https://")
    );
    assert!(export(&logs, &page, false).unwrap_err().to_string().contains("--force"));
    assert_eq!(fs::read_to_string(&page).unwrap(), text);
    fs::write(&page, "old").unwrap();
    export(&logs, &page, true).unwrap();
    assert_eq!(fs::read_to_string(&page).unwrap(), text);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

fn grainflow(arguments: &[&str]) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("grainflow"));
    command.arg("view").args(arguments).stdin(Stdio::null());
    command
}

#[test]
fn the_program_prints_its_address_and_ends_with_ctrl_c() {
    let (folder, _path) = sample(None);
    let mut child =
        grainflow(&["--no-browser", folder.path().to_str().unwrap()]).stdout(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let line = lines.next().unwrap().unwrap();
    let address = line.strip_prefix("open http://127.0.0.1:").unwrap();
    let (port, path) = address.split_once('/').unwrap();
    let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, port.parse().unwrap())).unwrap();
    stream.write_all(&get(&format!("/{path}"), &format!("127.0.0.1:{port}"))).unwrap();
    assert!(answer(&mut stream).starts_with("HTTP/1.1 200"));
    send("-INT", &child);
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

#[test]
fn bad_input_is_told_and_nothing_written() {
    let (folder, path) = sample(None);
    let page = folder.path().join("page.html");
    let [path, page] = [path.to_str().unwrap(), page.to_str().unwrap()];
    let nowhere = folder.path().join("nowhere");
    fs::create_dir(&nowhere).unwrap();
    for (arguments, word) in [
        (vec!["--no-browser", "missing.mcap"], "missing.mcap"),
        (vec!["--no-browser", nowhere.to_str().unwrap()], "log.mcap"),
        (vec!["--export", page, "missing.mcap"], "missing.mcap"),
        (vec!["--force", path], "--export"),
        (vec![path, path, path], "unexpected"),
        (vec!["--port", "0", path], "--port"),
    ] {
        let output = grainflow(&arguments).output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        assert!(error.contains(word), "{arguments:?}: {error}");
    }
    assert!(!Path::new(page).exists());
    let output = grainflow(&["--export", page, path, path]).output().unwrap();
    assert!(output.status.success());
    assert!(String::from_utf8(output.stdout).unwrap().contains("This page holds all 12 frames"));
}
