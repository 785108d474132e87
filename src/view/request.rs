//! The head of a request, and who may ask.

use subtle::ConstantTimeEq;

use super::response::Response;

/// Headers that a request may have.
const MOST_HEADERS: usize = 64;

/// What is asked for.
pub(super) struct Request<'a> {
    /// The path, from its slash on.
    pub(super) path: &'a str,
    query: &'a str,
}

impl<'a> Request<'a> {
    /// The request whose head is `bytes`, if it is one that may be answered by the server at `port` with this `token`.
    pub(super) fn admitted(bytes: &'a [u8], port: u16, token: &str) -> Result<Self, Response> {
        let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
        let mut parsed = httparse::Request::new(&mut headers);
        match parsed.parse(bytes) {
            Ok(httparse::Status::Complete(_)) => {}
            Ok(httparse::Status::Partial) => {
                return Err(Response::refusal(400, "the request ends too early"));
            }
            Err(httparse::Error::TooManyHeaders) => {
                return Err(Response::refusal(431, "the request has too many headers"));
            }
            Err(_) => return Err(Response::refusal(400, "this is no HTTP request")),
        }
        let (Some(method), Some(target)) = (parsed.method, parsed.path) else {
            return Err(Response::refusal(400, "this is no HTTP request"));
        };
        // A page from elsewhere whose name was made to mean this machine says its own name here.
        let mut hosts = parsed.headers.iter().filter(|header| header.name.eq_ignore_ascii_case("host"));
        let host = hosts.next().map(|header| header.value);
        if hosts.next().is_some() || !host.is_some_and(|host| is_local(host, port)) {
            return Err(Response::refusal(
                403,
                "only this machine is served, by the address that was printed",
            ));
        }
        if !target.starts_with('/') {
            return Err(Response::refusal(400, "the address does not begin with a slash"));
        }
        let (path, query) = target.split_once('?').unwrap_or((target, ""));
        let request = Request { path, query };
        let given = request.value("token").unwrap_or_default();
        if !bool::from(given.as_bytes().ct_eq(token.as_bytes())) {
            return Err(Response::refusal(403, "the address lacks its token: open the one that was printed"));
        }
        if method != "GET" {
            return Err(Response::refusal(405, "only GET is understood"));
        }
        Ok(request)
    }

    /// What the query says of `key`.
    pub(super) fn value(&self, key: &str) -> Option<&'a str> {
        self.query.split('&').find_map(|pair| {
            let (name, value) = pair.split_once('=')?;
            (name == key).then_some(value)
        })
    }

    /// The whole number that the query says of `key`, or `usual` where it says nothing.
    pub(super) fn number(&self, key: &str, usual: usize) -> Result<usize, Response> {
        match self.value(key) {
            None => Ok(usual),
            Some(text) if !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit()) => {
                text.parse().map_err(|_| Response::refusal(400, "a number is too large"))
            }
            Some(_) => Err(Response::refusal(400, "a number is expected")),
        }
    }
}

/// Whether `host` names this machine and `port`.
fn is_local(host: &[u8], port: u16) -> bool {
    let with_port = |name: &str| format!("{name}:{port}");
    let names = ["127.0.0.1", "localhost"];
    let is = |name: &str| host.eq_ignore_ascii_case(name.as_bytes());
    names.into_iter().any(|name| is(&with_port(name)) || (port == 80 && is(name)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_this_machine_are_local() {
        for host in ["127.0.0.1:4000", "localhost:4000", "LOCALHOST:4000"] {
            assert!(is_local(host.as_bytes(), 4000), "{host}");
        }
        for host in ["", "localhost", "localhost:4001", "evil.example:4000", "127.0.0.1:4000.evil.example"] {
            assert!(!is_local(host.as_bytes(), 4000), "{host}");
        }
        assert!(is_local(b"localhost", 80));
    }
}
