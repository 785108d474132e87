//! Options that pick a part of a log.

use clap::Args;

use crate::replay::selection::Selection;

/// A part of a log.
#[derive(Args, Debug)]
pub(super) struct Span {
    /// Begin at this simulated time
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    from: Option<f64>,

    /// End at this simulated time
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    to: Option<f64>,

    /// Take the first of these and then every N-th
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..), allow_negative_numbers = true)]
    every: u32,
}

impl Span {
    /// The selection, or what is wrong with it.
    pub(super) fn selection(&self) -> Result<Selection, String> {
        for (option, time) in [("--from", self.from), ("--to", self.to)] {
            if let Some(time) = time.filter(|time| !time.is_finite()) {
                return Err(format!("{option} {time}: a time has to be finite; leave it out for everything"));
            }
        }
        let everything = Selection::default();
        let selection = Selection {
            from: self.from.unwrap_or(everything.from),
            to: self.to.unwrap_or(everything.to),
            every: self.every,
        };
        if selection.from > selection.to {
            return Err(format!(
                "--from {}: lies after --to {}; exchange them",
                selection.from, selection.to
            ));
        }
        Ok(selection)
    }

    /// Whether it picks anything less than everything.
    pub(super) fn is_given(&self) -> bool {
        self.from.is_some() || self.to.is_some() || self.every > 1
    }
}
