//! A log played in the terminal, at the pace that was asked for.

use std::io::{self, IsTerminal, Write, stdout};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::Ordering::Relaxed;

use console::Term;

use super::{Exit, bad_input};
use crate::cli::complain;
use crate::cli::run::{STOP, prepare};
use crate::record::contents::{Frame, Walls};
use crate::record::overview::overview;
use crate::record::walk::each_frame;
use crate::replay::selection::Selection;
use crate::replay::text_picture::Canvas;
use crate::replay::{scenario_of, walls_of};
use crate::stopwatch::Stopwatch;

/// The other screen of the terminal, without a cursor; and back.
const BEGIN: &str = "\x1b[?1049h\x1b[?25l";
const END: &str = "\x1b[?25h\x1b[?1049l";
/// The upper left corner; the rest of a line, and of the screen, is cleared.
const HOME: &str = "\x1b[H";
const CLEAR_LINE: &str = "\x1b[K";
const CLEAR_BELOW: &str = "\x1b[J";
/// Seconds that one is shown the clock at a time, so that Ctrl-C is heard.
const PATIENCE: f64 = 0.1;

pub(super) fn play(log: &Path, selection: Selection, speed: f64) -> Exit {
    let (mut film, begin) = match film_of(log, selection, speed) {
        Ok(film) => film,
        Err(mistake) => return bad_input(&mistake),
    };
    if let Err(error) = prepare(None) {
        complain(&error);
        return Exit::RunFailed;
    }
    let mut picker = selection.picker();
    film.show(BEGIN);
    let read = each_frame(log, &mut |_, frame| {
        if picker.takes(frame.time) {
            film.wait((frame.time - begin) / speed);
            film.draw(&frame);
        }
        match STOP.load(Relaxed) || film.failure.is_some() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    });
    film.show(END);
    // The last picture stays on the usual screen.
    let last = std::mem::take(&mut film.last);
    film.show(&last);
    match (read, film.failure) {
        (Err(error), _) => bad_input(&error.to_string()),
        (Ok(()), Some(failure)) if failure.kind() != io::ErrorKind::BrokenPipe => {
            complain(&format!("cannot write to the terminal: {failure}"));
            Exit::RunFailed
        }
        _ if STOP.load(Relaxed) => Exit::Interrupted,
        _ => Exit::Done,
    }
}

/// The film of `log` before its first picture, and when that was taken [time]; or what is wrong.
fn film_of(log: &Path, selection: Selection, speed: f64) -> Result<(Film, f64), String> {
    if !(speed.is_finite() && speed > 0.0) {
        return Err(format!("--speed {speed}: has to be above 0, in simulated time for a second"));
    }
    if !stdout().is_terminal() {
        return Err(
            "--speed: standard output is no terminal to play in; --frames DIR writes pictures, and without \
                    either the series is printed"
                .to_owned(),
        );
    }
    let found = overview(log).map_err(|error| error.to_string())?;
    let scenario =
        scenario_of(log, &found.metadata, &found.scenario).map_err(|unknown| unknown.to_string())?;
    let begin = found.times.iter().copied().find(|&time| selection.spans(time));
    let begin = begin.ok_or_else(|| format!("{} has no frame {}", log.display(), selection.words()))?;
    let film = Film {
        walls: walls_of(&scenario),
        diameter: scenario.diameter(),
        is_coloured: std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty()),
        watch: Stopwatch::default(),
        last: String::new(),
        failure: None,
    };
    Ok((film, begin))
}

/// What is on the screen.
struct Film {
    walls: Walls,
    diameter: f64,
    is_coloured: bool,
    watch: Stopwatch,
    /// The last picture, as lines.
    last: String,
    failure: Option<io::Error>,
}

impl Film {
    /// Waits until so many seconds have gone by since the beginning, or somebody has had enough.
    fn wait(&self, seconds: f64) {
        while self.watch.seconds() < seconds && !STOP.load(Relaxed) {
            self.watch.sleep_until(seconds.min(self.watch.seconds() + PATIENCE));
        }
    }

    /// Draws `frame` as large as the terminal is now, with a line about it below.
    fn draw(&mut self, frame: &Frame) {
        let (lines, columns) = Term::stdout().size();
        let room = usize::from(lines).saturating_sub(2).max(1);
        let canvas = Canvas::new(&self.walls, usize::from(columns), room, self.is_coloured);
        let mut lines = canvas.draw(frame, self.diameter);
        lines.push(format!("t = {:.4}, {} grains", frame.time, frame.grains));
        let next = format!("{CLEAR_LINE}\r\n");
        self.show(&format!("{HOME}{}{CLEAR_LINE}{CLEAR_BELOW}", lines.join(&next)));
        self.last = lines.join("\n") + "\n";
    }

    fn show(&mut self, text: &str) {
        let mut out = stdout().lock();
        if let Err(failure) = out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
            self.failure.get_or_insert(failure);
        }
    }
}
