//! A log that is shown: its index, and what the page has to know before the first frame.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::error::ViewError;
use super::packing::MOST_POINTS;
use crate::observe::measure::Dimension;
use crate::record::contents::{Frame, Walls};
use crate::record::error::LogError;
use crate::record::index::LogIndex;
use crate::report::scene::Scene;
use crate::report::setup::Setup;

/// Frames that scales and the window are taken from, evenly over the log.
const SAMPLES: usize = 9;
/// Points beyond these are not worth the wait: fewer frames are looked at.
const MOST_SAMPLED: usize = 2_000_000;

/// A log that is shown.
#[derive(Debug)]
pub struct ViewedLog {
    name: String,
    index: LogIndex,
    setup: Setup,
    scene: Scene,
    /// Whether the speeds of one frame and another differ so much that one scale does not do.
    speeds_vary: bool,
    /// Species by identity, where grains are not alike.
    species: Vec<(u32, u8)>,
    /// Diameters of the species [length].
    sizes: Vec<f64>,
    /// Recorded points and grains of the frame that shows the smallest share of its grains.
    thinnest: Option<(usize, u64)>,
    /// Most points of a frame that was looked at.
    most_points: usize,
}

impl ViewedLog {
    /// Opens the log at `path`, and looks at a few of its frames for scales.
    pub fn open(path: &Path) -> Result<Self, ViewError> {
        let index = LogIndex::open(path)?;
        let head = index.head();
        let setup = Setup::of(head, &Map::new());
        let samples = samples(&index)?;
        let frames: Vec<&Frame> = samples.iter().collect();
        let scene = Scene::of(&frames, head.walls.as_ref(), setup.diameter, false);
        let filled: Vec<&Frame> = samples.iter().filter(|frame| !frame.positions.is_empty()).collect();
        let each = Scene::of(&filled, None, setup.diameter, true).speeds;
        let speeds_vary = each.windows(2).any(|pair| pair[0] != pair[1]);
        let sizes = species_diameters(&head.scenario);
        let species = if sizes.len() > 1 { index.species()? } else { Vec::new() };
        let share = |frame: &&&Frame| frame.positions.len() as f64 / frame.grains.max(1) as f64;
        let thinned = frames.iter().filter(|frame| frame.grains > frame.positions.len() as u64);
        let thinnest = thinned.min_by(|a, b| share(a).total_cmp(&share(b)));
        let thinnest = thinnest.map(|frame| (frame.positions.len(), frame.grains));
        let most_points = frames.iter().map(|frame| frame.positions.len()).max().unwrap_or(0);
        let name = path.display().to_string();
        Ok(ViewedLog { name, setup, scene, speeds_vary, species, sizes, thinnest, most_points, index })
    }

    /// Random access to what it holds.
    pub fn index(&self) -> &LogIndex {
        &self.index
    }

    /// Row `number` of the series, NaN where it is damaged: the page counts these gaps and says so.
    pub(super) fn row(&self, number: usize) -> Result<Option<Vec<f64>>, LogError> {
        match self.index.row(number) {
            Err(LogError::Damaged { .. }) => Ok(Some(vec![f64::NAN; self.index.head().columns.len()])),
            row => row,
        }
    }

    /// Where it is.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    pub(super) fn title(&self) -> &str {
        &self.setup.title
    }

    pub(super) fn version(&self) -> &str {
        self.index.head().metadata.get("version").map_or("", String::as_str)
    }

    /// Most points of a frame that was looked at.
    pub(super) fn most_points(&self) -> usize {
        self.most_points
    }

    pub(super) fn scene(&self) -> &Scene {
        &self.scene
    }

    pub(super) fn walls(&self) -> Option<&Walls> {
        self.index.head().walls.as_ref()
    }

    /// Axes that positions have.
    pub(super) fn axes(&self) -> usize {
        if self.scene.is_deep { 3 } else { 2 }
    }

    /// Whether grains differ in size and it is known which is which.
    pub(super) fn is_mixture(&self) -> bool {
        !self.species.is_empty()
    }

    /// Diameters of the points of `frame` [length].
    pub(super) fn diameters(&self, frame: &Frame) -> Vec<f64> {
        let of = |point: usize| {
            let id = frame.ids.get(point)?;
            let place = self.species.binary_search_by_key(id, |(id, _)| *id).ok()?;
            self.sizes.get(usize::from(self.species[place].1)).copied()
        };
        (0..frame.positions.len()).map(|point| of(point).unwrap_or(self.setup.diameter)).collect()
    }

    /// What the page has to know before the first frame; `frames` of it, by number.
    pub(super) fn about(&self, frames: &[usize]) -> Value {
        let head = self.index.head();
        let columns: Vec<Value> = head
            .columns
            .iter()
            .map(|column| json!({ "name": column.name, "label": self.setup.label(column) }))
            .collect();
        let speed = Dimension { length: 1, time: -1, ..Dimension::default() };
        json!({
            "name": self.name,
            "title": self.setup.title,
            "engine": self.setup.engine,
            "notes": self.notes(),
            "remarks": [],
            "times": frames.iter().map(|&frame| self.index.frame_time(frame)).collect::<Vec<_>>(),
            "recordings": frames.iter().map(|&frame| self.index.recording_of(frame)).collect::<Vec<_>>(),
            "rows": self.index.recordings(),
            "columns": columns,
            "window": self.scene.window,
            "sides": self.scene.sides,
            "deep": self.scene.is_deep,
            "turned": self.scene.is_turned,
            "diameter": self.setup.diameter,
            "gravity": self.setup.gravity,
            "fastest": self.scene.speeds.first().copied().unwrap_or(1.0),
            "own_scale": !self.setup.has_gravity() && self.speeds_vary,
            "units": {
                "time": if self.setup.units[2] == "time" { "" } else { &self.setup.units[2] },
                "length": if self.setup.units[0] == "length" { "" } else { &self.setup.units[0] },
                "speed": self.setup.with_unit("speed", speed),
            },
            "without": { "density": self.without_density(), "clusters": self.without_clusters() },
            "thinned": self.thinnest.is_some(),
        })
    }

    /// What is missing or left out, as sentences.
    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if let Some(cut_off) = &self.index.head().cut_off {
            let mut sentence = cut_off.clone();
            if let Some(first) = sentence.get_mut(0..1) {
                first.make_ascii_uppercase();
            }
            notes.push(format!("{sentence}. It has no index, so it was read once to make one; a run that is still writing it goes on."));
        } else if self.index.was_made() {
            notes.push(
                "The index of the log does not fit what it holds, so the log was read once to make one."
                    .to_owned(),
            );
        }
        if let Some((points, grains)) = self.thinnest {
            notes.push(format!(
                "The log holds only part of the grains (at least once {points} of {grains}): the box looks emptier than it is. \
                 Local densities count every recorded grain for several."
            ));
        }
        if self.most_points > MOST_POINTS {
            notes.push(format!("Of each frame {MOST_POINTS} grains are shown, always the same ones."));
        }
        if self.sizes.len() > 1 && !self.is_mixture() {
            notes.push(
                "Grains differ in size, but no saved state says which is which: all are drawn alike."
                    .to_owned(),
            );
        }
        notes
    }

    /// Why there is no colour by density, if so.
    fn without_density(&self) -> Option<&'static str> {
        self.walls().is_none().then_some("the log does not say how large the box is")
    }

    /// Why there is no colour by clusters, if so.
    fn without_clusters(&self) -> Option<&'static str> {
        if self.thinnest.is_some() {
            return Some("the log holds only part of the grains, so that neighbours are missing");
        }
        if self.sizes.len() > 1 && !self.is_mixture() {
            return Some("it is not known which grain is how large");
        }
        self.without_density()
    }
}

/// A few frames, first and last and others evenly between, as many as are read quickly.
fn samples(index: &LogIndex) -> Result<Vec<Frame>, ViewError> {
    let count = index.frames();
    let mut numbers: Vec<usize> = match count {
        0..=SAMPLES => (0..count).collect(),
        _ => (0..SAMPLES).map(|k| k * (count - 1) / (SAMPLES - 1)).collect(),
    };
    // The last one first: it often has most grains.
    numbers.reverse();
    let (mut samples, mut points) = (Vec::new(), 0);
    for number in numbers {
        if points > MOST_SAMPLED {
            break;
        }
        let moment = match index.moment(number) {
            // Who comes to this frame is told.
            Err(LogError::Damaged { .. }) => None,
            moment => moment?,
        };
        points += moment.as_ref().map_or(0, |moment| moment.frame.positions.len());
        samples.extend(moment.map(|moment| moment.frame));
    }
    Ok(samples)
}

/// Diameters of the species that a scenario names [length].
fn species_diameters(scenario: &str) -> Vec<f64> {
    // A text that does not parse names none.
    let document = scenario.parse::<toml_edit::DocumentMut>().unwrap_or_default();
    let Some(species) = document.get("particles").and_then(|table| table.get("species")) else {
        return Vec::new();
    };
    let number = |item: &toml_edit::Value| item.as_float().or_else(|| item.as_integer().map(|n| n as f64));
    let diameter = |value: Option<&toml_edit::Value>| value.and_then(number).unwrap_or(1.0);
    if let Some(tables) = species.as_array_of_tables() {
        return tables
            .iter()
            .map(|one| diameter(one.get("diameter").and_then(|item| item.as_value())))
            .collect();
    }
    let list = species.as_array().into_iter().flatten();
    list.map(|one| diameter(one.as_inline_table().and_then(|table| table.get("diameter")))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diameters_of_species_are_found_in_either_form() {
        let inline = "[particles]\nspecies = [{ diameter = 1, mass = 1 }, { diameter = 1.4 }]";
        let tables = "[[particles.species]]\ndiameter = 1.0\n[[particles.species]]\ndiameter = 1.4\n";
        assert_eq!(species_diameters(inline), [1.0, 1.4]);
        assert_eq!(species_diameters(tables), [1.0, 1.4]);
        assert!(species_diameters("[particles]\ndiameter = 2").is_empty());
        assert!(species_diameters("= [").is_empty());
    }
}
