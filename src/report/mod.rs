//! Pictures and pages: what a log and its summary look like to a reader.

mod axis;
pub mod calibration;
mod camera;
pub(crate) mod colour;
mod comparison;
mod curve;
mod energy_plots;
pub(crate) mod escape;
mod evidence;
mod figures;
mod fit;
mod header;
mod heap_plots;
mod other_plots;
mod page;
mod parameters;
mod picture;
mod plain_text;
mod player;
mod plot;
mod raster;
mod reference;
pub(crate) mod scene;
pub(crate) mod setup;
mod shear_plots;
mod sweep;
mod sweep_model;
mod unit;
mod wave_plots;

use serde_json::{Map, Value};

pub use camera::Camera;
pub use colour::field_colour;
pub use comparison::judgement::{Judgement, judgements};
pub use picture::grains_png;
pub use sweep_model::{Abscissa, FigureCurve, MeanPoint, PowerLaw, SweepCase, SweepFigure, SweepReport};

use crate::comparison::model::Comparison;
use crate::record::contents::RunLog;

/// `report.html` of a run: one page that needs no network, with its parameters, plots, theory beside what was
/// measured, pictures of the grains, and a player of the frames.
///
/// It looks at the log and at the summary alone, so a report can be made again from a stored run.
pub fn render(log: &RunLog, summary: &Map<String, Value>) -> String {
    page::page(log, summary)
}

/// `sweep.html`: figures of many runs against what was varied, one page that needs no network.
pub fn render_sweep(sweep: &SweepReport) -> String {
    sweep::page(sweep)
}

/// `comparison.html`: several engines side by side, one page that needs no network. Verdicts first, then costs, curves
/// with their errors and differences, pictures of the same times beside one another, figures, and how it was made.
pub fn render_comparison(compared: &Comparison) -> String {
    comparison::page(compared)
}
