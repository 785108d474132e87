use super::*;
use crate::engine::report::Totals;
use crate::law::boundary::Face;
use crate::observe::testing::{Bed, State, assert_resumes, figure_of, setting_of, show, smooth};
use glam::{DVec2, DVec3};

/// A table with open sides under gravity along `axis`, in cells of side 2.
fn table<V: Vector>(size: V, axis: usize) -> Bed<V> {
    let mut cells = [1; 3];
    (0..V::DIMENSION).for_each(|a| cells[a] = (size[a] / 2.0) as u32);
    let mut bed = setting_of(size, cells);
    bed.setting.gravity = V::along(axis, -1.0);
    bed.walls(0, Face::Open, Face::Open);
    bed.walls(axis, smooth(), Face::Open);
    bed
}

/// Grains on every half height below a roof with the given slopes and a top of 20 at x = 41.
fn roof(bed: &Bed<DVec2>, left: f64, right: f64) -> Vec<DVec2> {
    let mut positions = Vec::new();
    for bin in 0..bed.setting.grid.cells()[0] {
        let x = f64::from(2 * bin + 1);
        let h = 20.0 - if x < 41.0 { left * (41.0 - x) } else { right * (x - 41.0) };
        let below = (0..).map(|k| h - 0.5 * f64::from(k)).take_while(|&y| y > 0.0);
        positions.extend(below.map(|y| DVec2::new(x, y)));
    }
    positions
}

fn at_rest<V: Vector>(bed: &Bed<V>, positions: Vec<V>) -> State<V> {
    let velocities = vec![V::ZERO; positions.len()];
    (bed.gas(1.0, positions, velocities), Totals::default())
}

fn figure_at<V: Vector>(bed: &Bed<V>, positions: Vec<V>, name: &str) -> (Option<f64>, Option<f64>) {
    let mut heap = Heap::new(&bed.setting).unwrap();
    figure_of(&mut heap, &[at_rest(bed, positions)], 0.0, name)
}

#[test]
fn both_flanks_are_found_exactly() {
    let bed = table(DVec2::new(100.0, 60.0), 1);
    let figure = |name| figure_at(&bed, roof(&bed, 0.5, 0.4), name);
    let near = |found: (Option<f64>, Option<f64>), expected: f64| {
        assert!((found.0.unwrap() - expected).abs() < 1e-12, "{found:?}");
        assert!(found.1.unwrap() < 1e-12);
    };
    near(figure("heap_slope_left"), 0.5);
    near(figure("heap_slope_right"), 0.4);
    near(figure("heap_slope"), 0.45);
    assert_eq!(figure("heap_height"), (Some(20.0), None));
}

#[test]
fn only_the_straight_part_counts() {
    let bed = table(DVec2::new(100.0, 60.0), 1);
    // A long thin tail and a blunt top leave the line alone.
    let mut positions = roof(&bed, 0.5, 0.5);
    positions.retain(|p| p.y <= 18.0);
    positions.extend((0..50).map(|k| DVec2::new(f64::from(2 * k + 1), 1.0)));
    let (slope, error) = figure_at(&bed, positions, "heap_slope");
    assert!((slope.unwrap() - 0.5).abs() < 1e-12 && error.unwrap() < 1e-12);
}

#[test]
fn grains_in_flight_do_not_count() {
    let bed = table(DVec2::new(100.0, 60.0), 1);
    let mut positions = roof(&bed, 0.5, 0.5);
    positions.push(DVec2::new(41.0, 55.0));
    positions.push(DVec2::new(1.0, 50.0));
    assert_eq!(figure_at(&bed, positions.clone(), "heap_height").0, Some(20.0));
    // The top fills the cell from 20 to 22: with one cell empty a grain belongs to the heap, with two it flies.
    positions.push(DVec2::new(41.0, 26.5));
    assert_eq!(figure_at(&bed, positions.clone(), "heap_height").0, Some(20.0));
    positions.pop();
    positions.push(DVec2::new(41.0, 25.5));
    assert_eq!(figure_at(&bed, positions, "heap_height").0, Some(25.5));
}

#[test]
fn a_heap_against_a_wall_has_one_flank() {
    let bed = table(DVec2::new(100.0, 60.0), 1);
    let positions: Vec<DVec2> = roof(&bed, 0.5, 0.5).into_iter().filter(|p| p.x >= 41.0).collect();
    assert_eq!(figure_at(&bed, positions.clone(), "heap_slope_left"), (None, None));
    assert!((figure_at(&bed, positions, "heap_slope").0.unwrap() - 0.5).abs() < 1e-12);
    assert_eq!(figure_at(&bed, vec![], "heap_slope"), (None, None));
    assert_eq!(figure_at(&bed, vec![], "heap_height"), (Some(0.0), None));
}

#[test]
fn the_surface_is_a_profile_and_the_slope_a_series() {
    let bed = table(DVec2::new(100.0, 60.0), 1);
    let state = at_rest(&bed, roof(&bed, 0.5, 0.5));
    let mut heap = Heap::new(&bed.setting).unwrap();
    let values = show(&mut heap, &state);
    assert!((values[0] - 0.5).abs() < 1e-12 && values[1] == 20.0);
    let profiles = heap.profiles(&Snapshot::new(&state.0, &state.1));
    assert_eq!(profiles[0].values[0][20], 41.0);
    assert_eq!(profiles[0].values[1][19..22], [19.0, 20.0, 19.0]);
}

#[test]
fn a_cone_is_cut_through_its_top() {
    let bed = table(DVec3::new(80.0, 60.0, 40.0), 2);
    let mut positions = Vec::new();
    for bin in 0..40 * 30 {
        let (x, y) = (f64::from(bin % 40 * 2 + 1), f64::from(bin / 40 * 2 + 1));
        let h = 15.0 - 0.5 * ((x - 31.0).powi(2) + (y - 21.0).powi(2)).sqrt();
        let below = (0..).map(|k| h - 0.5 * f64::from(k)).take_while(|&z| z > 0.0);
        positions.extend(below.map(|z| DVec3::new(x, y, z)));
    }
    // What stands beside the section does not matter.
    positions.extend((0..20).map(|k| DVec3::new(15.0, 51.0, 0.5 * f64::from(k) + 0.5)));
    let (slope, error) = figure_at(&bed, positions, "heap_slope");
    assert!((slope.unwrap() - 0.5).abs() < 1e-12 && error.unwrap() < 1e-12, "{slope:?}");
}

#[test]
fn it_stands_upside_down_too() {
    let mut bed = table(DVec2::new(100.0, 60.0), 1);
    bed.setting.gravity = DVec2::new(0.0, 1.0);
    bed.walls(1, Face::Open, smooth());
    let hanging = roof(&bed, 0.5, 0.4).into_iter().map(|p| DVec2::new(p.x, 60.0 - p.y)).collect();
    assert!((figure_at(&bed, hanging, "heap_slope").0.unwrap() - 0.45).abs() < 1e-12);
}

#[test]
fn it_needs_a_floor_and_a_source_or_an_open_side() {
    let mut bed = table(DVec2::new(10.0, 10.0), 1);
    bed.walls(0, smooth(), smooth());
    assert!(Heap::new(&bed.setting).is_none());
    bed.setting.is_poured = true;
    assert!(Heap::new(&bed.setting).is_some());
    bed.setting.gravity = DVec2::ZERO;
    assert!(Heap::new(&bed.setting).is_none());
}

#[test]
fn it_resumes() {
    let bed = table(DVec2::new(20.0, 20.0), 1);
    assert_resumes(|| Box::new(Heap::new(&bed.setting).unwrap()), &bed.random_states(6, 60));
}
