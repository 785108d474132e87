//! A log played in the terminal, at the pace that was asked for.

use std::io::{self, IsTerminal, Write, stdout};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::Ordering::Relaxed;

use console::Term;

use super::{Exit, bad_input};
use crate::cli::complain;
use crate::cli::run::{STOP, prepare};
use crate::number::plain;
use crate::record::contents::{Frame, Walls};
use crate::record::overview::overview;
use crate::record::walk::each_frame;
use crate::replay::selection::Selection;
use crate::replay::text_picture::{Canvas, Colours};
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
    film.switch(BEGIN);
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
    film.switch(END);
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
        screen: Screen::of(|name| std::env::var(name).ok()),
        watch: Stopwatch::default(),
        last: String::new(),
        failure: None,
    };
    Ok((film, begin))
}

/// What a terminal is able to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Screen {
    colours: Colours,
    /// Whether text can be put anywhere: a terminal without that is a printer.
    has_places: bool,
}

impl Screen {
    /// As the environment says: `variable` gives the value of TERM, COLORTERM and NO_COLOR.
    fn of(variable: impl Fn(&str) -> Option<String>) -> Self {
        let term = variable("TERM").unwrap_or_default();
        let is_printer = term.is_empty() || term == "dumb";
        let true_colour =
            ["truecolor", "24bit"].contains(&variable("COLORTERM").unwrap_or_default().as_str());
        let colours = match term.as_str() {
            _ if is_printer || variable("NO_COLOR").is_some_and(|value| !value.is_empty()) => Colours::Plain,
            _ if true_colour => Colours::True,
            term if MONOCHROME.iter().any(|name| term.starts_with(name)) => Colours::Plain,
            term if term.ends_with("-direct") => Colours::True,
            term if term.contains("256color") => Colours::TwoHundred,
            _ => Colours::Eight,
        };
        Screen { colours, has_places: !is_printer }
    }
}

/// Beginnings of names of terminals without colours.
const MONOCHROME: [&str; 5] = ["vt1", "vt2", "vt3", "vt4", "vt5"];

/// What is on the screen.
struct Film {
    walls: Walls,
    diameter: f64,
    screen: Screen,
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
        let canvas = Canvas::new(&self.walls, usize::from(columns), room, self.screen.colours);
        let mut lines = canvas.draw(frame, self.diameter);
        lines.push(format!("t = {}, {} grains", plain(frame.time, 6), frame.grains));
        if !self.screen.has_places {
            // Each picture below the last one, of which nothing remains to be shown at the end.
            self.show(&(lines.join("\n") + "\n"));
            return;
        }
        let next = format!("{CLEAR_LINE}\r\n");
        self.show(&format!("{HOME}{}{CLEAR_LINE}{CLEAR_BELOW}", lines.join(&next)));
        self.last = lines.join("\n") + "\n";
    }

    /// Goes to the other screen of the terminal, or back, where it has one.
    fn switch(&mut self, to: &str) {
        if self.screen.has_places {
            self.show(to);
        }
    }

    fn show(&mut self, text: &str) {
        let mut out = stdout().lock();
        if let Err(failure) = out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
            self.failure.get_or_insert(failure);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_gets_no_more_than_it_says_it_has() {
        let screen = |term: &str, colorterm: &str, no_color: &str| {
            let screen = Screen::of(|name| {
                let value = match name {
                    "TERM" => term,
                    "COLORTERM" => colorterm,
                    _ => no_color,
                };
                (!value.is_empty()).then(|| value.to_owned())
            });
            (screen.colours, screen.has_places)
        };
        assert_eq!(screen("dumb", "", ""), (Colours::Plain, false));
        assert_eq!(screen("dumb", "truecolor", ""), (Colours::Plain, false));
        assert_eq!(screen("", "", ""), (Colours::Plain, false));
        assert_eq!(screen("vt100", "", ""), (Colours::Plain, true));
        assert_eq!(screen("linux", "", ""), (Colours::Eight, true));
        assert_eq!(screen("xterm", "", ""), (Colours::Eight, true));
        assert_eq!(screen("xterm-256color", "", ""), (Colours::TwoHundred, true));
        assert_eq!(screen("xterm-256color", "truecolor", ""), (Colours::True, true));
        assert_eq!(screen("xterm-256color", "24bit", "1"), (Colours::Plain, true));
    }
}
