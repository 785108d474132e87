//! What the server has to say: a function from the head of a request to an answer.

use serde_json::json;

use super::colouring::Colouring;
use super::error::ViewError;
use super::log::ViewedLog;
use super::packing::packed;
use super::page;
use super::request::Request;
use super::response::Response;
use crate::record::error::LogError;
use crate::stopwatch::Stopwatch;

/// Rows of a series in one answer.
const MOST_ROWS: usize = 512;
/// An answer with rows is not made to wait longer than this [s].
const MOST_SECONDS: f64 = 0.2;
/// Random bytes of a token.
const TOKEN_BYTES: usize = 24;

/// The pages and data of the logs that are shown.
#[derive(Debug)]
pub struct Site {
    logs: Vec<ViewedLog>,
    token: String,
    port: u16,
    page: String,
    policy: String,
    about: String,
}

impl Site {
    /// The site of `logs`, reached by `port` with a token that nobody can guess.
    pub fn new(logs: Vec<ViewedLog>, port: u16) -> Result<Self, ViewError> {
        let mut random = [0; TOKEN_BYTES];
        getrandom::fill(&mut random).map_err(ViewError::Entropy)?;
        let token = random.iter().map(|byte| format!("{byte:02x}")).collect();
        let parts: Vec<_> =
            logs.iter().map(|log| log.about(&(0..log.index().frames()).collect::<Vec<_>>())).collect();
        let about = json!({ "colours": page::colours(), "logs": parts }).to_string();
        let text = page::html(&logs, &page::Contents::Served);
        Ok(Site { page: text, policy: page::policy(true), about, logs, token, port })
    }

    /// The address of the page, with its token.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/?token={}", self.port, self.token)
    }

    /// The answer to a request whose head is `bytes`, whatever they are.
    pub fn respond(&self, bytes: &[u8]) -> Response {
        let answer =
            Request::admitted(bytes, self.port, &self.token).and_then(|request| match request.path {
                "/" => Ok(Response::page(&self.page, &self.policy)),
                "/about" => Ok(Response::json(&self.about)),
                "/frame" => self.frame(&request),
                "/series" => self.series(&request),
                _ => Err(Response::refusal(404, "there is nothing here")),
            });
        answer.unwrap_or_else(|refusal| refusal)
    }

    /// A frame: `log`, `number`, `colour`.
    fn frame(&self, request: &Request<'_>) -> Result<Response, Response> {
        let log = self.log(request)?;
        let number = request.number("number", 0)?;
        let colouring = Colouring::of(request.value("colour").unwrap_or("speed"));
        let colouring = colouring.ok_or_else(|| Response::refusal(400, "there is no such colour"))?;
        let moment = log.index().moment(number).map_err(|error| failure(&error))?;
        let moment = moment.ok_or_else(|| Response::refusal(404, "the log has no such frame"))?;
        Ok(Response::data(packed(log, &moment, colouring)))
    }

    /// Rows of the series: `log`, `from`, every `step`-th, `count`; fewer where they take long. float64, little-endian,
    /// `[row][column]`; NaN where a row is damaged.
    fn series(&self, request: &Request<'_>) -> Result<Response, Response> {
        let log = self.log(request)?;
        let (from, step) = (request.number("from", 0)?, request.number("step", 1)?.max(1));
        let count = request.number("count", MOST_ROWS)?.min(MOST_ROWS);
        let watch = Stopwatch::default();
        let mut bytes = Vec::new();
        for number in (from..log.index().recordings()).step_by(step).take(count) {
            let Some(row) = log.row(number).map_err(|error| failure(&error))? else { break };
            row.iter().for_each(|value| bytes.extend_from_slice(&value.to_le_bytes()));
            if watch.seconds() > MOST_SECONDS {
                break;
            }
        }
        Ok(Response::data(bytes))
    }

    fn log(&self, request: &Request<'_>) -> Result<&ViewedLog, Response> {
        let number = request.number("log", 0)?;
        self.logs.get(number).ok_or_else(|| Response::refusal(404, "there is no such log"))
    }
}

/// The log is not what it was when it was opened.
fn failure(error: &LogError) -> Response {
    Response::refusal(500, &error.to_string())
}
