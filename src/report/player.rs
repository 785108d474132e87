//! The player: frames thinned, quantised and packed into the page, beside the script that draws them.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::json;

use super::colour::ColourMap;
use super::escape::{escape, escape_json};
use super::scene::{Scene, speed};
use super::setup::Setup;
use crate::number::number;
use crate::record::contents::Frame;
use crate::scenario::kinds::Kinds;

/// Frames beyond these are left out, evenly.
const MOST_FRAMES: usize = 200;
/// Fewer frames than these do not move.
const FEWEST_FRAMES: usize = 50;
/// Grains beyond these are left out, the same ones in every frame.
const MOST_POINTS: usize = 20_000;
/// Places and speeds take no more than about this, so that a page stays below 12 MB [byte].
const MOST_BYTES: usize = 7_200_000;
/// The script of the player.
const SCRIPT: &str = include_str!("player.js");

/// The frames that the page shows: first and last, and others evenly between, as many as the page can hold.
pub(super) fn chosen(frames: &[Frame]) -> Vec<&Frame> {
    // Two bytes per place, one per speed (and one per species, which is no matter), with the third place where there is one.
    let is_deep = frames.iter().any(|f| f.positions.iter().any(|p| p[2] != 0.0));
    let bytes = if is_deep { 7 } else { 5 };
    let total: usize = frames.iter().map(|f| bytes * f.positions.len().min(MOST_POINTS)).sum();
    let affordable = (frames.len() * MOST_BYTES).checked_div(total).unwrap_or(MOST_FRAMES);
    let count = affordable.clamp(FEWEST_FRAMES, MOST_FRAMES);
    if frames.len() <= count {
        return frames.iter().collect();
    }
    let last = frames.len() - 1;
    (0..count).map(|k| &frames[k * last / (count - 1)]).collect()
}

/// The player of `frames`, which are those of `scene`; empty when there is nothing to play.
pub(super) fn html(frames: &[&Frame], scene: &Scene, setup: &Setup) -> String {
    let most = frames.iter().map(|f| f.positions.len()).max().unwrap_or(0);
    if most == 0 {
        return String::new();
    }
    let share = share_shown(most);
    let packed: Vec<Packed> = frames
        .iter()
        .zip(&scene.speeds)
        .map(|(frame, fastest)| Packed::of(frame, scene, &setup.kinds, *fastest, share))
        .collect();
    let mut bytes = Vec::new();
    // All positions first: two-byte numbers must begin at even places.
    packed.iter().for_each(|p| p.places.iter().for_each(|q| bytes.extend_from_slice(&q.to_le_bytes())));
    packed.iter().for_each(|p| bytes.extend_from_slice(&p.speeds));
    let are_told = setup.kinds.are_told();
    if are_told {
        packed.iter().for_each(|p| bytes.extend_from_slice(&p.species));
    }
    let colours: Vec<String> = (0..64).map(|k| ColourMap::Speed.hexadecimal(f64::from(k) / 63.0)).collect();
    let parameters = json!({
        "times": frames.iter().map(|f| f.time).collect::<Vec<f64>>(),
        "counts": packed.iter().map(|p| p.speeds.len()).collect::<Vec<usize>>(),
        "grains": frames.iter().map(|f| f.grains.max(f.positions.len() as u64)).collect::<Vec<u64>>(),
        "speeds": scene.speeds,
        "window": scene.window,
        "sides": scene.sides,
        "deep": scene.is_deep,
        "turned": scene.is_turned,
        "diameter": setup.diameter,
        "diameters": are_told.then(|| setup.kinds.diameters().collect::<Vec<f64>>()),
        "colours": colours,
        "units": { "time": if setup.units[2] == "time" { "" } else { &setup.units[2] }, "speed": setup.with_unit("", crate::observe::measure::Dimension { mass: 0, length: 1, time: -1 }) },
    });
    let hint = if scene.is_deep { " Drag, or the arrow keys with Shift, turn the box." } else { "" };
    // The canvas of about 1000 pixels has a margin of 7 around the box.
    let aspect = if scene.is_deep { 1.5 } else { 1000.0 / (986.0 / scene.aspect() + 14.0) };
    format!(
        include_str!("player.html"),
        aspect = aspect.clamp(0.4, 20.0),
        last = frames.len() - 1,
        gradient = ColourMap::Speed.gradient(),
        caption = escape(&format!("{}{hint}", caption(frames, share, scene))),
        parameters = escape_json(&parameters.to_string()),
        data = STANDARD.encode(bytes),
        script = SCRIPT,
    )
}

/// What the player leaves out, and how it colours.
fn caption(frames: &[&Frame], share: f64, scene: &Scene) -> String {
    let thinned = frames.iter().any(|f| f.grains > f.positions.len() as u64);
    let shown = match thinned {
        _ if share < 1.0 => format!("{} % of the recorded grains are shown", number(100.0 * share, 2)),
        true => "The box looks emptier than it is: only part of the grains is recorded and shown".to_owned(),
        false => "Every grain is shown".to_owned(),
    };
    let is_shared = scene.speeds.windows(2).all(|pair| pair[0] == pair[1]);
    let colours = if is_shared {
        "one scale of colours for all times"
    } else {
        "each time has its own scale of colours"
    };
    format!("{shown}, at {} times; {colours}, which ends where the fastest 2 % begin.", frames.len())
}

/// A frame in two-byte places, one-byte speeds and species.
struct Packed {
    places: Vec<u16>,
    speeds: Vec<u8>,
    species: Vec<u8>,
}

impl Packed {
    fn of(frame: &Frame, scene: &Scene, kinds: &Kinds, fastest: f64, share: f64) -> Self {
        let mut packed = Self { places: Vec::new(), speeds: Vec::new(), species: Vec::new() };
        let axes = if scene.is_deep { 3 } else { 2 };
        for index in chosen_grains(frame, share) {
            for axis in 0..axes {
                let [lower, upper] = scene.window[axis];
                let share = (f64::from(frame.positions[index][axis]) - lower) / (upper - lower);
                packed.places.push((share.clamp(0.0, 1.0) * 65535.0).round() as u16);
            }
            let velocity = frame.velocities.get(index).copied().unwrap_or_default();
            packed.species.push(frame.ids.get(index).map_or(0, |id| kinds.species_of(*id)));
            packed.speeds.push((255.0 * speed(velocity) / fastest).clamp(0.0, 255.0).round() as u8);
        }
        packed
    }
}

/// The share of grains to show when there are `most` in a frame, with room for the luck of the draw.
fn share_shown(most: usize) -> f64 {
    if most <= MOST_POINTS { 1.0 } else { 0.96 * MOST_POINTS as f64 / most as f64 }
}

/// The same grains in every frame as far as they have identities, never more than the page can hold.
fn chosen_grains(frame: &Frame, share: f64) -> Vec<usize> {
    let threshold = (share * 4_294_967_296.0) as u64;
    // A grain's number says where it started, so neighbours are told apart by mixing its bits.
    let mixed = |id: u32| u64::from((id ^ (id >> 15)).wrapping_mul(0x9e37_79b1));
    let is_chosen =
        |index: &usize| mixed(frame.ids.get(*index).copied().unwrap_or(*index as u32)) < threshold;
    let chosen: Vec<usize> = (0..frame.positions.len()).filter(is_chosen).collect();
    let surplus = chosen.len().div_ceil(MOST_POINTS).max(1);
    chosen.into_iter().step_by(surplus).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::contents::RunLog;
    use serde_json::Map;

    fn frame(count: usize) -> Frame {
        Frame {
            grains: count as u64,
            positions: (0..count).map(|k| [k as f32, 0.5, 0.0]).collect(),
            velocities: vec![[1.0, 0.0, 0.0]; count],
            ids: (0..count as u32).collect(),
            ..Frame::default()
        }
    }

    #[test]
    fn first_and_last_frame_are_kept() {
        let frames: Vec<Frame> =
            (0..1001).map(|k| Frame { time: f64::from(k), ..Frame::default() }).collect();
        let chosen = chosen(&frames);
        assert_eq!((chosen.len(), chosen[0].time, chosen[199].time), (200, 0.0, 1000.0));
    }

    #[test]
    fn many_grains_cost_frames_and_not_grains() {
        let frames = vec![frame(20_000); 200];
        let count = chosen(&frames).len();
        assert!((FEWEST_FRAMES..100).contains(&count), "{count}");
        assert!(count * 5 * 20_000 <= MOST_BYTES);
    }

    #[test]
    fn grains_are_thinned_to_what_a_page_holds() {
        for count in [4999, 20_000, 20_001, 100_000] {
            let kept = chosen_grains(&frame(count), share_shown(count)).len();
            assert!((18_000..=MOST_POINTS).contains(&kept) || kept == count, "{count}: {kept}");
        }
    }

    #[test]
    fn a_page_without_grains_has_no_player() {
        let setup = Setup::of(&RunLog::default(), &Map::new());
        let empty = frame(0);
        let scene = Scene::of(&[&empty], None, 1.0, false);
        assert_eq!(html(&[&empty], &scene, &setup), "");
        let some = frame(3);
        let scene = Scene::of(&[&some], None, 1.0, false);
        assert!(html(&[&some], &scene, &setup).contains("<canvas"));
    }
}
