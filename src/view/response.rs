//! Answers, with the headers that keep others out.

/// An answer to a request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Response {
    /// Status of HTTP.
    pub status: u16,
    /// Kind of the body.
    pub kind: &'static str,
    /// The policy of a page, nothing for data.
    pub policy: Option<String>,
    /// What is sent.
    pub body: Vec<u8>,
}

impl Response {
    /// Bytes that the page lays arrays over.
    pub(super) fn data(body: Vec<u8>) -> Self {
        Response { status: 200, kind: "application/octet-stream", policy: None, body }
    }

    /// JSON.
    pub(super) fn json(text: &str) -> Self {
        Response { status: 200, kind: "application/json", policy: None, body: text.as_bytes().to_vec() }
    }

    /// A page that may do what `policy` says.
    pub(super) fn page(text: &str, policy: &str) -> Self {
        let policy = Some(policy.to_owned());
        Response { status: 200, kind: "text/html; charset=utf-8", policy, body: text.as_bytes().to_vec() }
    }

    /// No, and why.
    pub(super) fn refusal(status: u16, reason: &str) -> Self {
        let body = format!("{reason}\n").into_bytes();
        Response { status, kind: "text/plain; charset=utf-8", policy: None, body }
    }

    /// The answer as it goes over the line; the connection ends with it.
    pub fn bytes(&self) -> Vec<u8> {
        let policy = self.policy.as_deref().unwrap_or("default-src 'none'; frame-ancestors 'none'");
        let allow = if self.status == 405 { "Allow: GET\r\n" } else { "" };
        let head = format!(
            "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\n\
             Cache-Control: no-store\r\nContent-Security-Policy: {policy}\r\nCross-Origin-Opener-Policy: same-origin\r\n\
             Cross-Origin-Resource-Policy: same-origin\r\nReferrer-Policy: no-referrer\r\n\
             X-Content-Type-Options: nosniff\r\nX-Frame-Options: DENY\r\n{allow}\r\n",
            self.status,
            self.reason(),
            self.kind,
            self.body.len(),
        );
        let mut bytes = head.into_bytes();
        bytes.extend_from_slice(&self.body);
        bytes
    }

    fn reason(&self) -> &'static str {
        match self.status {
            200 => "OK",
            400 => "Bad Request",
            403 => "Forbidden",
            404 => "Not Found",
            405 => "Method Not Allowed",
            408 => "Request Timeout",
            431 => "Request Header Fields Too Large",
            503 => "Service Unavailable",
            _ => "Internal Server Error",
        }
    }
}
