//! Requests to the viewer, and a site that answers them.

use grainflow::view::{Site, ViewedLog};

const PORT: u16 = 4000;
/// Stands for the token of the site, which no two have alike.
const TOKEN: &str = "{token}";
const COLOURS: [&str; 3] = ["speed", "density", "clusters"];

/// The site of a log, and who is let in.
pub(crate) struct Door {
    site: Site,
    token: String,
}

impl Door {
    pub(crate) fn to(log: ViewedLog) -> Self {
        let site = Site::new(vec![log], PORT).expect("the system gives random numbers");
        let token = site.address().split_once("token=").expect("the address has a token").1.to_owned();
        Door { site, token }
    }

    /// The status of the answer to `request`, which says `{token}` where the token belongs. An answer is whole and does
    /// not tell the token; who does not know it is refused.
    pub(crate) fn ask(&self, request: &[u8]) -> u16 {
        let knows = contains(request, TOKEN.as_bytes());
        let request = replaced(request, self.token.as_bytes());
        let answer = self.site.respond(&request);
        let bytes = answer.bytes();
        assert!(bytes.starts_with(b"HTTP/1.1 ") && bytes.ends_with(&answer.body), "{}", answer.status);
        assert!(knows || answer.status >= 400, "{} without the token", answer.status);
        assert!(!contains(&bytes, self.token.as_bytes()), "the token is told");
        answer.status
    }

    /// A request that is let in.
    pub(crate) fn request(target: &str) -> Vec<u8> {
        let sign = if target.contains('?') { '&' } else { '?' };
        format!("GET {target}{sign}token={TOKEN} HTTP/1.1\r\nHost: 127.0.0.1:{PORT}\r\nAccept: */*\r\n\r\n")
            .into_bytes()
    }

    pub(crate) fn colour(number: usize) -> &'static str {
        COLOURS[number % COLOURS.len()]
    }
}

/// What browsers ask for, and what they do not.
pub(crate) fn known() -> Vec<Vec<u8>> {
    let frames = COLOURS.map(|colour| format!("/frame?log=0&number=1&colour={colour}"));
    let others = [
        "/",
        "/about",
        "/series?from=0&step=2&count=3",
        "/series?log=0&from=1",
        "/frame",
        "/log.mcap",
        "/../etc/passwd",
    ];
    let targets = frames.into_iter().chain(others.map(str::to_owned));
    let foreign = format!("GET /?token={TOKEN} HTTP/1.1\r\nHost: elsewhere.example\r\n\r\n");
    let posted = format!(
        "POST /frame?token={TOKEN} HTTP/1.1\r\nHost: localhost:{PORT}\r\nContent-Length: 3\r\n\r\nabc"
    );
    targets.map(|target| Door::request(&target)).chain([foreign, posted].map(String::into_bytes)).collect()
}

fn contains(bytes: &[u8], part: &[u8]) -> bool {
    bytes.windows(part.len()).any(|window| window == part)
}

/// `request` with `token` wherever it says so.
fn replaced(request: &[u8], token: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(request.len() + token.len());
    let mut rest = request;
    while let Some(at) = rest.windows(TOKEN.len()).position(|part| part == TOKEN.as_bytes()) {
        bytes.extend_from_slice(&rest[..at]);
        bytes.extend_from_slice(token);
        rest = &rest[at + TOKEN.len()..];
    }
    bytes.extend_from_slice(rest);
    bytes
}
