//! The sizes of clusters in a frame, with the links of the measure `clusters`.

use glam::{DVec2, DVec3};

use super::colouring::Scalars;
use crate::matter::grid::Grid;
use crate::observe::clusters::cluster_sizes;
use crate::record::contents::{Frame, Walls};
use crate::space::Vector;

/// Points in one place beyond which a search for neighbours would take too long, and mean nothing.
const MOST_IN_A_PLACE: usize = 500;

/// The size of the cluster of every point; `None` where the frame does not show every grain, or so many lie upon each other that
/// neighbours mean nothing.
pub(super) fn sizes(frame: &Frame, walls: &Walls, diameters: &[f64]) -> Option<Scalars> {
    let is_whole = frame.grains == frame.positions.len() as u64;
    let is_finite = frame.positions.iter().flatten().all(|x| x.is_finite());
    if !is_whole || !is_finite || frame.positions.is_empty() || is_crowded(frame, diameters) {
        return None;
    }
    let sizes = if walls.sides[2][0].is_empty() {
        sizes_in::<DVec2>(frame, walls, diameters)?
    } else {
        sizes_in::<DVec3>(frame, walls, diameters)?
    };
    let largest = sizes.iter().copied().max().unwrap_or(0);
    Some(Scalars { values: sizes.into_iter().map(|size| size as f32).collect(), detail: f64::from(largest) })
}

fn sizes_in<V: Vector>(frame: &Frame, walls: &Walls, diameters: &[f64]) -> Option<Vec<u32>> {
    let lower = V::from_fn(|axis| walls.lower[axis]);
    let size = V::from_fn(|axis| walls.upper[axis] - walls.lower[axis]);
    let is_box = (0..V::DIMENSION).all(|axis| size[axis] > 0.0 && size[axis].is_finite());
    let shortest = (0..V::DIMENSION).map(|axis| size[axis]).fold(f64::INFINITY, f64::min);
    let longest = (0..V::DIMENSION).map(|axis| size[axis]).fold(0.0, f64::max);
    if !is_box || longest > 1e6 * shortest {
        return None;
    }
    let periodic = [0, 1, 2].map(|axis| walls.sides[axis][0] == "periodic");
    let grid = Grid::new(lower, size, &[1; 3], &periodic);
    let positions: Vec<V> =
        frame.positions.iter().map(|place| V::from_fn(|axis| f64::from(place[axis]))).collect();
    Some(cluster_sizes(&grid, &positions, diameters))
}

/// Whether too many points stand within a diameter of each other: grains without extension that collapsed.
fn is_crowded(frame: &Frame, diameters: &[f64]) -> bool {
    let side = diameters.iter().copied().fold(0.0, f64::max);
    let mut places: Vec<[i64; 3]> = frame
        .positions
        .iter()
        .map(|position| position.map(|x| (f64::from(x) / side).floor() as i64))
        .collect();
    places.sort_unstable();
    places.chunk_by(|a, b| a == b).any(|place| place.len() > MOST_IN_A_PLACE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walls() -> Walls {
        let sides = [["periodic"; 2], ["wall"; 2], [""; 2]].map(|axis| axis.map(str::to_owned));
        Walls { lower: [0.0; 3], upper: [10.0, 10.0, 0.0], sides }
    }

    fn frame(positions: Vec<[f32; 3]>) -> Frame {
        Frame { grains: positions.len() as u64, positions, ..Frame::default() }
    }

    #[test]
    fn a_pair_across_a_periodic_side_is_a_cluster() {
        let pair = frame(vec![[0.3, 2.0, 0.0], [9.4, 2.0, 0.0], [5.0, 5.0, 0.0]]);
        let found = sizes(&pair, &walls(), &[1.0; 3]).unwrap();
        assert_eq!((found.values, found.detail), (vec![2.0, 2.0, 1.0], 2.0));
    }

    #[test]
    fn a_thinned_a_damaged_and_a_collapsed_frame_have_no_clusters() {
        let places = vec![[0.3, 2.0, 0.0], [9.4, 2.0, 0.0]];
        let thinned = Frame { grains: 3, ..frame(places.clone()) };
        assert_eq!(sizes(&thinned, &walls(), &[1.0; 2]), None);
        assert_eq!(sizes(&frame(vec![[f32::NAN, 2.0, 0.0]]), &walls(), &[1.0]), None);
        assert_eq!(sizes(&frame(vec![[1.5; 3]; MOST_IN_A_PLACE + 1]), &walls(), &[1.0; 501]), None);
        let flat = Walls { upper: [10.0, 0.0, 0.0], ..walls() };
        assert_eq!(sizes(&frame(places), &flat, &[1.0; 2]), None);
    }
}
