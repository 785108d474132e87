//! Who is let in, and what they get.

use grainflow::record::frame::frame;
use grainflow::record::index::LogIndex;
use grainflow::record::reader::read_log;
use grainflow::record::state::SavedState;
use grainflow::record::writer::{LogHeader, LogWriter, Recording};
use grainflow::view::{Site, ViewedLog, export};
use proptest::prelude::*;

use super::{GRAINS, RECORDINGS, float, get, grains, header, sample, site, text, word};

#[test]
fn only_those_with_the_token_and_a_local_name_are_let_in() {
    let (_folder, path) = sample(None);
    let (site, token) = site(&path);
    assert_eq!(token.len(), 48);
    let (_, other) = super::site(&path);
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

#[test]
fn a_damaged_frame_is_told_and_the_others_are_shown() {
    let (_folder, path) = sample(None);
    let mut bytes = std::fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x40;
    std::fs::write(&path, &bytes).unwrap();
    let (site, token) = site(&path);
    let ask = |place: &str| site.respond(&get(&format!("/{place}token={token}"), "127.0.0.1:4000"));
    let answers: Vec<_> = (0..RECORDINGS).map(|number| ask(&format!("frame?number={number}&"))).collect();
    let bad: Vec<usize> = (0..RECORDINGS).filter(|&number| answers[number].status != 200).collect();
    assert_eq!(bad.len(), 1);
    assert!(text(&answers[bad[0]]).contains("damaged near byte"));
    let rows = ask("series?").body;
    assert_eq!(rows.len(), RECORDINGS * 24);
    let lost: Vec<usize> = (0..RECORDINGS).filter(|row| float(&rows, 24 * row).is_nan()).collect();
    assert_eq!(lost, bad);
    // A page of its own has the others, too.
    let page = path.with_extension("html");
    let kept = export(&[ViewedLog::open(&path).unwrap()], &page, false).unwrap();
    assert_eq!((kept[0].frames, kept[0].damaged), (RECORDINGS - 1, 1));
    assert!(
        kept[0].sentence().contains("11 of 12 frames") && kept[0].sentence().contains("One frame is damaged")
    );
    assert!(std::fs::read_to_string(&page).unwrap().contains("One frame is damaged"));
}

#[test]
fn grains_of_a_mixture_have_their_own_diameters() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    let scenario = "[particles]\nspecies = [{ diameter = 1, mass = 1 }, { diameter = 1.5, mass = 2 }]\n";
    let mut log = LogWriter::create(&path, &LogHeader { scenario: scenario.to_owned(), ..header() }).unwrap();
    let mut columns = grains(9, 0.0);
    let picture = frame(0.0, &columns, None);
    let hash = "0".repeat(64);
    let row = [0.0, 1.0, 0.0];
    log.recording(&Recording {
        values: &row,
        state_hash: &hash,
        grains: picture.grains,
        profiles: &[],
        frame: Some(&picture),
        fields: &[],
    })
    .unwrap();
    columns.ids.reverse();
    columns.species = Some(vec![0, 0, 1, 0, 0, 0, 0, 0, 0]);
    let columns = std::borrow::Cow::Owned(columns);
    log.state(&SavedState { columns, next_id: 9, ..Default::default() }).unwrap();
    log.finish().unwrap();
    let species = LogIndex::open(&path).unwrap().species().unwrap();
    assert_eq!(species, (0..9).map(|id| (id, u8::from(id == 6))).collect::<Vec<_>>());
    let (site, token) = site(&path);
    let body = site.respond(&get(&format!("/frame?token={token}&colour=clusters"), "127.0.0.1:4000")).body;
    assert_eq!([0, 8].map(|at| word(&body, at)), [9, 3]);
    let diameters: Vec<f32> = (0..9).map(|k| f32::from_bits(word(&body, 64 + 9 * 16 + 4 * k))).collect();
    assert_eq!(diameters, [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.5, 1.0, 1.0]);
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
}
