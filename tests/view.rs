//! Logs in the browser: frames by the index, who is let in, what becomes of bad requests, the page as a file.
#![expect(clippy::unwrap_used, reason = "functions that tests call stop the test like the tests themselves")]

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use std::time::{Duration, Instant};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec2;
use grainflow::matter::columns::Columns;
use grainflow::observe::measure::{Column, Dimension};
use grainflow::record::contents::Walls;
use grainflow::record::error::LogError;
use grainflow::record::frame::frame;
use grainflow::record::index::LogIndex;
use grainflow::record::reader::read_log;
use grainflow::record::recover::recover;
use grainflow::record::time_scale::time_scale;
use grainflow::record::writer::{LogHeader, LogWriter, Recording};
use grainflow::view::{Limits, Response, Server, Site, ViewedLog, export, wake};
use proptest::prelude::*;

const RECORDINGS: usize = 12;
const GRAINS: u32 = 150;
const PORT: u16 = 4000;

fn header() -> LogHeader {
    let sides = [["periodic", "periodic"], ["wall", "open"], ["", ""]];
    let column =
        |name: &str, time| Column { name: name.to_owned(), unit: Dimension { time, ..Dimension::default() } };
    LogHeader {
        metadata: [("version", "0.1.0"), ("engine", "hsmc")]
            .map(|(a, b)| (a.to_owned(), b.to_owned()))
            .into(),
        scenario: "title = \"</script><b>Sample\"\ndimension = 2\n".to_owned(),
        columns: vec![column("time", 1), column("kinetic_energy", 0), column("collisions_per_particle", 0)],
        walls: Some(Walls {
            lower: [0.0; 3],
            upper: [40.0, 20.0, 0.0],
            sides: sides.map(|axis| axis.map(str::to_owned)),
        }),
        start: 0.0,
        time_scale: time_scale(1.2, 0.1),
    }
}

fn grains(count: u32, time: f64) -> Columns<DVec2> {
    let mut columns = Columns::default();
    for id in 0..count {
        let place = f64::from(id);
        columns.positions.push(DVec2::new((place * 0.37 + time).rem_euclid(40.0), (place * 0.61) % 20.0));
        columns.velocities.push(DVec2::new(place.sin(), place.cos()));
        columns.ids.push(id);
    }
    columns
}

/// Writes a log of `recordings` with `points` of the grains in a frame; the first one is of an empty box.
fn write_log(path: &Path, recordings: usize, points: Option<usize>) {
    let mut log = LogWriter::create(path, &header()).unwrap();
    for index in 0..recordings {
        let time = 0.1 * index as f64;
        let picture = frame(time, &grains(if index == 0 { 0 } else { GRAINS }, time), points);
        let row = [time, 100.0 - time, 2.0 * time];
        let hash = format!("{index:064x}");
        log.recording(&Recording { values: &row, state_hash: &hash, profiles: &[], frame: &picture })
            .unwrap();
    }
    log.finish().unwrap();
}

/// A folder with a log.
fn sample(points: Option<usize>) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    write_log(&path, RECORDINGS, points);
    (folder, path)
}

/// Asserts that the index of the log at `path` gives what reading all of it gives.
fn assert_same(path: &Path) -> LogIndex {
    let (whole, index) = (read_log(path).unwrap(), LogIndex::open(path).unwrap());
    assert_eq!((index.frames(), index.recordings()), (whole.frames.len(), whole.series.len()));
    // Backwards: no frame needs those before it.
    for number in (0..whole.frames.len()).rev() {
        let moment = index.moment(number).unwrap().unwrap();
        assert_eq!(moment.frame, whole.frames[number]);
        assert_eq!(moment.row, whole.series[index.recording_of(number).unwrap()]);
        assert!((index.frame_time(number).unwrap() - moment.frame.time).abs() < 1e-8);
    }
    for (number, row) in whole.series.iter().enumerate() {
        assert_eq!(index.row(number).unwrap().as_ref(), Some(row));
    }
    assert_eq!(index.moment(whole.frames.len()).unwrap(), None);
    let head = index.head();
    assert_eq!((&head.metadata, &head.scenario), (&whole.metadata, &whole.scenario));
    assert_eq!((&head.columns, &head.walls), (&whole.columns, &whole.walls));
    assert_eq!(head.cut_off.is_some(), whole.cut_off.is_some());
    index
}

#[test]
fn frames_by_the_index_are_those_of_the_whole_log() {
    for points in [None, Some(100)] {
        let (_folder, path) = sample(points);
        let index = assert_same(&path);
        assert!(!index.was_made());
    }
}

#[test]
fn a_log_that_is_cut_off_is_shown_as_far_as_it_goes() {
    let (folder, path) = sample(None);
    let bytes = fs::read(&path).unwrap();
    let short = folder.path().join("short.mcap");
    for length in (0..bytes.len()).step_by(997).chain([bytes.len() - 1]) {
        fs::write(&short, &bytes[..length]).unwrap();
        if read_log(&short).is_err() {
            assert!(LogIndex::open(&short).is_err(), "{length}");
            continue;
        }
        let index = assert_same(&short);
        assert!(index.was_made());
        let sentence = index.head().cut_off.clone().unwrap();
        assert!(sentence.contains(&format!("cut off after {length} bytes")), "{sentence}");
    }
}

#[test]
fn wrong_bytes_are_found_out_where_they_are_looked_at() {
    let (folder, path) = sample(None);
    let mut bytes = fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x40;
    fs::write(&path, &bytes).unwrap();
    let index = LogIndex::open(&path).unwrap();
    let moments: Vec<_> = (0..RECORDINGS).map(|number| index.moment(number)).collect();
    let bad = moments.iter().filter(|moment| matches!(moment, Err(LogError::Damaged { .. }))).count();
    assert_eq!((bad, moments.iter().filter(|moment| moment.is_ok()).count()), (1, RECORDINGS - 1));
    // What is sound in it has an index again, with one frame less.
    let clean = folder.path().join("clean.mcap");
    recover(&path, &clean).unwrap();
    assert_eq!(assert_same(&clean).frames(), RECORDINGS - 1);
}

#[test]
fn other_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    assert!(matches!(LogIndex::open(&path), Err(LogError::Read { .. })));
    fs::write(&path, "").unwrap();
    assert!(matches!(LogIndex::open(&path), Err(LogError::Empty { .. })));
    fs::write(&path, "no log at all").unwrap();
    assert!(matches!(LogIndex::open(&path), Err(LogError::NotMcap { .. })));
}

/// A site of the log at `path`, and its token.
fn site(path: &Path) -> (Site, String) {
    let site = Site::new(vec![ViewedLog::open(path).unwrap()], PORT).unwrap();
    let token = site.address().split_once("token=").unwrap().1.to_owned();
    (site, token)
}

fn get(target: &str, host: &str) -> Vec<u8> {
    format!("GET {target} HTTP/1.1\r\nHost: {host}\r\n\r\n").into_bytes()
}

fn text(response: &Response) -> String {
    String::from_utf8_lossy(&response.body).into_owned()
}

#[test]
fn only_those_with_the_token_and_a_local_name_are_let_in() {
    let (_folder, path) = sample(None);
    let (site, token) = site(&path);
    assert_eq!(token.len(), 48);
    let (_, other) = self::site(&path);
    assert_ne!(token, other);
    let local = "127.0.0.1:4000";
    let page = format!("/?token={token}");
    assert_eq!(site.respond(&get(&page, local)).status, 200);
    assert_eq!(site.respond(&get(&page, "localhost:4000")).status, 200);
    let refused = |request: &[u8], status: u16| {
        let response = site.respond(request);
        assert_eq!(response.status, status, "{}", String::from_utf8_lossy(request));
        assert!(!text(&response).contains(&token));
    };
    for host in ["evil.example:4000", "127.0.0.1:4001", "127.0.0.1", "", "127.0.0.1:4000.evil.example"] {
        refused(&get(&page, host), 403);
    }
    refused(format!("GET {page} HTTP/1.1\r\n\r\n").as_bytes(), 403);
    refused(format!("GET {page} HTTP/1.1\r\nHost: {local}\r\nHost: evil.example\r\n\r\n").as_bytes(), 403);
    let shorter = &token[..47];
    let wrong = token.replace(&token[..1], if &token[..1] == "0" { "1" } else { "0" });
    for query in
        ["", "?token=", &format!("?token={shorter}"), &format!("?token={wrong}"), &format!("?Token={token}")]
    {
        for place in ["/", "/about", "/frame", "/series", "/nowhere"] {
            refused(&get(&format!("{place}{query}"), local), 403);
        }
    }
    for place in ["/log.mcap", "/../log.mcap", "/..%2f..%2fetc/passwd", "/etc/passwd", "//", "/about/"] {
        refused(&get(&format!("{place}?token={token}"), local), 404);
    }
    for query in ["log=1", "number=12", "number=99999999"] {
        refused(&get(&format!("/frame?token={token}&{query}"), local), 404);
    }
    for query in ["number=x", "number=-1", "number=", "number=99999999999999999999999", "colour=../../etc"] {
        refused(&get(&format!("/frame?token={token}&{query}"), local), 400);
    }
    refused(format!("POST {page} HTTP/1.1\r\nHost: {local}\r\n\r\n").as_bytes(), 405);
    refused(format!("GET http://{local}{page} HTTP/1.1\r\nHost: {local}\r\n\r\n").as_bytes(), 400);
    refused(format!("GET {page} HTTP/1.1\r\nHost: {local}\r\n").as_bytes(), 400);
    refused(b"\x16\x03\x01\x02\x00\x01", 400);
    let many = "X: y\r\n".repeat(100);
    refused(format!("GET {page} HTTP/1.1\r\nHost: {local}\r\n{many}\r\n").as_bytes(), 431);
}

#[test]
fn answers_are_for_the_page_alone() {
    let (_folder, path) = sample(None);
    let (site, token) = site(&path);
    for place in ["/", "/about", "/frame", "/series", "/nowhere"] {
        let response = site.respond(&get(&format!("{place}?token={token}"), "127.0.0.1:4000"));
        let bytes = response.bytes();
        let end = bytes.windows(4).position(|four| four == b"\r\n\r\n").unwrap();
        let head = String::from_utf8(bytes[..end].to_vec()).unwrap().to_lowercase();
        assert!(!head.contains("access-control"), "{head}");
        for line in [
            "default-src 'none'",
            "frame-ancestors 'none'",
            "nosniff",
            "no-store",
            "no-referrer",
            "same-origin",
        ] {
            assert!(head.contains(line), "{place}: {line}");
        }
        assert!(!head.contains("unsafe-inline") && !head.contains("unsafe-eval"));
    }
    let page = text(&site.respond(&get(&format!("/?token={token}"), "127.0.0.1:4000")));
    // The title of the scenario is text, whatever it says, and the page does not hold the token.
    assert!(page.contains("&lt;/script&gt;&lt;b&gt;Sample") && !page.contains("<b>Sample"));
    assert!(!page.contains(&token));
}

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

fn float(bytes: &[u8], at: usize) -> f64 {
    f64::from_le_bytes(bytes[at..at + 8].try_into().unwrap())
}

#[test]
fn a_frame_comes_as_it_is_in_the_log() {
    let (_folder, path) = sample(None);
    let (site, token) = site(&path);
    let log = read_log(&path).unwrap();
    let ask = |query: &str| {
        let response = site.respond(&get(&format!("/frame?token={token}&{query}"), "127.0.0.1:4000"));
        assert_eq!(response.status, 200, "{}", text(&response));
        response.body
    };
    let body = ask("log=0&number=7&colour=speed");
    let frame = &log.frames[7];
    assert_eq!([0, 4, 8, 12].map(|at| word(&body, at)), [GRAINS, 3, 0, 2]);
    assert_eq!(
        [16, 24, 40, 48].map(|at| float(&body, at)),
        [frame.time, 150.0, frame.time, log.series[7][1]]
    );
    for (point, position) in frame.positions.iter().enumerate() {
        assert_eq!(word(&body, 64 + 8 * point), position[0].to_bits());
        assert_eq!(word(&body, 68 + 8 * point), position[1].to_bits());
    }
    assert_eq!(body.len(), 64 + 150 * 12);
    for colour in ["density", "clusters"] {
        let body = ask(&format!("number=7&colour={colour}"));
        assert_eq!((word(&body, 8), body.len()), (1, 64 + 150 * 16), "{colour}");
    }
    let empty = ask("number=0");
    assert_eq!((word(&empty, 0), empty.len()), (0, 64));
    let rows =
        site.respond(&get(&format!("/series?token={token}&from=1&step=4&count=2"), "127.0.0.1:4000")).body;
    assert_eq!([0, 24].map(|at| float(&rows, at)), [log.series[1][0], log.series[5][0]]);
    assert_eq!(rows.len(), 48);
}

#[test]
fn a_thinned_log_has_no_clusters_and_says_why() {
    let (_folder, path) = sample(Some(100));
    let (site, token) = site(&path);
    let about = site.respond(&get(&format!("/about?token={token}"), "127.0.0.1:4000"));
    let about: serde_json::Value = serde_json::from_slice(&about.body).unwrap();
    let log = &about["logs"][0];
    assert!(log["without"]["clusters"].as_str().unwrap().contains("part of the grains"));
    assert!(log["notes"][0].as_str().unwrap().contains("100 of 150"));
    assert!(log["without"]["density"].is_null());
    let frame =
        site.respond(&get(&format!("/frame?token={token}&number=3&colour=clusters"), "127.0.0.1:4000"));
    assert_eq!(word(&frame.body, 8), 0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn no_request_stops_the_handler(bytes in proptest::collection::vec(any::<u8>(), 0..400), at in 0_usize..200, byte: u8) {
        thread_local! {
            static SITE: (tempfile::TempDir, Site, String) = {
                let (folder, path) = sample(None);
                let (site, token) = site(&path);
                (folder, site, token)
            };
        }
        SITE.with(|(_, site, token)| {
            // Nobody guesses the token.
            assert!(site.respond(&bytes).status >= 400);
            let mut request = get(&format!("/frame?token={token}&log=0&number=3&colour=density"), "127.0.0.1:4000");
            let at = at % request.len();
            request[at] = byte;
            let status = site.respond(&request).status;
            assert!([200, 400, 403, 404, 405].contains(&status), "{status}");
        });
    }

    #[test]
    fn no_damage_stops_the_index(place in 0.0..1.0_f64, byte: u8, length in 0.0..1.3_f64) {
        let (_folder, path) = sample(None);
        let mut bytes = fs::read(&path).unwrap();
        let at = (place * (bytes.len() - 1) as f64) as usize;
        bytes[at] = byte;
        bytes.truncate((length * bytes.len() as f64) as usize);
        fs::write(&path, &bytes).unwrap();
        if let Ok(index) = LogIndex::open(&path) {
            for number in 0..index.frames() {
                let _ = index.moment(number);
            }
        }
    }
}

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
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
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

/// Two gigabytes of frames that no compression makes smaller.
#[test]
#[ignore = "writes 2 GB; cargo test --release --test view -- --ignored --nocapture"]
fn a_large_log_is_opened_and_scrubbed_in_less_than_a_second() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    let mut log = LogWriter::create(&path, &header()).unwrap();
    let (recordings, points) = (6000_u64, 20_000_u64);
    // A linear congruential generator: any bits will do.
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for index in 0..recordings {
        let time = 1e-3 * index as f64;
        let mut columns = Columns::default();
        for id in 0..points {
            columns.positions.push(DVec2::new(40.0 * random(), 20.0 * random()));
            columns.velocities.push(DVec2::new(random(), random()));
            columns.ids.push(id as u32);
        }
        let picture = frame(time, &columns, None);
        let row = [time, random(), time];
        let hash = format!("{index:064x}");
        log.recording(&Recording { values: &row, state_hash: &hash, profiles: &[], frame: &picture })
            .unwrap();
    }
    log.finish().unwrap();
    let length = fs::metadata(&path).unwrap().len();
    let begun = Instant::now();
    let log = ViewedLog::open(&path).unwrap();
    println!(
        "{:.2} GB, {recordings} frames: opened in {:.3} s",
        length as f64 * 1e-9,
        begun.elapsed().as_secs_f64()
    );
    let site = Site::new(vec![log], PORT).unwrap();
    let token = site.address().split_once("token=").unwrap().1.to_owned();
    let mut longest = Duration::ZERO;
    for colour in ["speed", "density", "clusters"] {
        let mut slowest = Duration::ZERO;
        for number in (0..40).map(|k| k * 1571 % recordings) {
            let begun = Instant::now();
            let query = format!("/frame?token={token}&number={number}&colour={colour}");
            assert_eq!(site.respond(&get(&query, "127.0.0.1:4000")).status, 200);
            slowest = slowest.max(begun.elapsed());
        }
        println!("slowest of 40 frames here and there, coloured by {colour}: {:.3} s", slowest.as_secs_f64());
        longest = longest.max(slowest);
    }
    assert!(longest < Duration::from_secs(1));
    cut_off_again(&path, length);
}

/// How long it takes without an index.
fn cut_off_again(path: &Path, length: u64) {
    fs::OpenOptions::new().write(true).open(path).unwrap().set_len(length - 1000).unwrap();
    let begun = Instant::now();
    assert!(LogIndex::open(path).unwrap().was_made());
    println!("cut off: read once in {:.1} s", begun.elapsed().as_secs_f64());
}
