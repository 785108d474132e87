//! `wall-stress`: the momentum that the gas gives to its walls (Müller 2001, section 3.3).

use super::layout;
use super::measure::{Cadence, Column, Figure, Measure, Profile, Snapshot};
use super::samples::{Samples, figure, steady_rate};
use super::setting::Setting;
use super::units::{column, stress};
use crate::law::boundary::WallKind;
use crate::space::Vector;

/// Shear and normal stress on walls: the mean over the walls of one axis, and each wall of every axis by its name.
///
/// * `wall_shear_stress`, `wall_normal_stress`: the mean over the walls of one axis. That is the axis of shear; else, in a
///   pipe, the first with walls beside it; else that of gravity if it has walls; else the first with walls. In a closed box
///   under gravity the mean over floor and ceiling is half the weight where nothing touches the ceiling.
/// * `wall_normal_stress_y_lower` and so on: the momentum per time and area that this wall takes outwards; on a floor the
///   weight above it. It includes what the wall carries while grains rest on it.
/// * `wall_shear_stress_y_lower` and so on, of walls that are rough or statistical: along the way that the walls move past
///   each other, on walls of other axes along gravity, where it points along them.
///
/// The shear stress is taken along the way the walls move or, in a pipe, along gravity; each wall's share is counted
/// positive in the sense that the mean has, so that in a steady state it is the mean of the magnitudes without the bias that
/// magnitudes of noise have.
#[derive(Clone, Debug)]
pub struct WallStress<V> {
    stresses: Vec<Stress<V>>,
    /// Time and every stress·time at the previous recording.
    previous: Vec<f64>,
    /// `[sample][stress·time]`.
    samples: Samples,
}

/// A stress on one wall or on the two of an axis.
#[derive(Clone, Debug)]
struct Stress<V> {
    name: String,
    /// The axis that the walls are normal to.
    axis: usize,
    /// For the lower and upper wall, the direction along which momentum counts, over area and number of walls
    /// [1/length^(D−1)]; `None` where no direction is given.
    along: Option<[V; 2]>,
}

impl<V: Vector> Stress<V> {
    /// The stress summed over time since the start.
    fn accumulated(&self, snapshot: &Snapshot<'_, V>) -> f64 {
        let [lower, upper] = snapshot.totals.counts.wall_momentum[self.axis];
        self.along.map_or(0.0, |[below, above]| lower.dot(below) + upper.dot(above))
    }
}

/// Area of a wall normal to `axis` [length^(D−1)].
fn area<V: Vector>(setting: &Setting<V>, axis: usize) -> f64 {
    setting.size.product() / setting.size[axis]
}

/// The directions outwards through the lower and the upper wall of `axis`.
fn outwards<V: Vector>(axis: usize) -> [V; 2] {
    [V::along(axis, -1.0), V::along(axis, 1.0)]
}

/// The directions along which the shear stress on the walls of `axis` counts, where there are some.
fn tangents<V: Vector>(setting: &Setting<V>, axis: usize) -> Option<[V; 2]> {
    // The lower wall is dragged with the gas, that is along the upper wall, and the other way round.
    if let Some(shear) = layout::shear(setting).filter(|shear| shear.axis == axis) {
        return Some([shear.direction, -shear.direction]);
    }
    let falling = setting.gravity - V::along(axis, setting.gravity[axis]);
    let pull = falling.length();
    (pull > 0.0).then(|| [falling * (1.0 / pull); 2])
}

/// The mean stresses over the walls of the axis that a scenario is about.
fn mean_stresses<V: Vector>(setting: &Setting<V>) -> Option<[Stress<V>; 2]> {
    let shear = layout::shear(setting);
    let pipe = layout::pipe_axis(setting);
    let walls_on = |axis: usize| setting.boundary.walls().filter(|wall| wall.0 == axis).count();
    let axis = match (shear, layout::gravity_axis(setting)) {
        (Some(shear), _) => shear.axis,
        (None, Some(axis)) if pipe.is_none() && walls_on(axis) > 0 => axis,
        _ => setting.boundary.walls().next()?.0,
    };
    let along = shear.map(|shear| [shear.direction, -shear.direction]).or_else(|| {
        let falling = pipe.map(|pipe| V::along(pipe, setting.gravity[pipe].signum()))?;
        Some([falling, falling])
    });
    let weight = 1.0 / (area(setting, axis) * walls_on(axis) as f64);
    let stress = |kind: &str, along: Option<[V; 2]>| Stress {
        name: format!("wall_{kind}_stress"),
        axis,
        along: along.map(|directions| directions.map(|direction| direction * weight)),
    };
    Some([stress("shear", along), stress("normal", Some(outwards(axis)))])
}

/// The stresses on each wall.
fn stresses_by_wall<V: Vector>(setting: &Setting<V>) -> Vec<Stress<V>> {
    let mut stresses = Vec::new();
    for (axis, side, wall) in setting.boundary.walls() {
        let weight = 1.0 / area(setting, axis);
        let mut add = |kind: &str, directions: [V; 2]| {
            let name = format!("wall_{kind}_stress_{}_{}", V::AXIS_NAMES[axis], ["lower", "upper"][side]);
            let mut along = [V::ZERO; 2];
            along[side] = directions[side] * weight;
            stresses.push(Stress { name, axis, along: Some(along) });
        };
        add("normal", outwards(axis));
        let drags = matches!(wall.kind, WallKind::Rough { .. } | WallKind::Statistical { .. });
        if let Some(directions) = tangents(setting, axis).filter(|_| drags) {
            add("shear", directions);
        }
    }
    stresses
}

impl<V: Vector> WallStress<V> {
    /// The measure for `setting`, if it has walls.
    pub fn new(setting: &Setting<V>) -> Option<Self> {
        let mut stresses = Vec::from(mean_stresses(setting)?);
        stresses.extend(stresses_by_wall(setting));
        // Every total is zero at time 0, whether or not anyone looks then.
        let samples = Samples::new(stresses.len()).with(0.0, &vec![0.0; stresses.len()]);
        Some(WallStress { previous: vec![0.0; 1 + stresses.len()], stresses, samples })
    }

    /// The stresses summed over time since the start.
    fn accumulated(&self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        self.stresses.iter().map(|stress| stress.accumulated(snapshot)).collect()
    }
}

impl<V: Vector> Measure<V> for WallStress<V> {
    fn name(&self) -> &'static str {
        "wall-stress"
    }

    fn cadence(&self) -> Cadence {
        Cadence::Spread
    }

    fn sample(&mut self, snapshot: &Snapshot<'_, V>) {
        let stresses = self.accumulated(snapshot);
        self.samples.push(snapshot.gas.time(), &stresses);
    }

    fn columns(&self) -> Vec<Column> {
        self.stresses.iter().map(|one| column(&one.name, stress::<V>())).collect()
    }

    fn values(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        let mut now = vec![snapshot.gas.time()];
        now.extend(self.accumulated(snapshot));
        let before = std::mem::replace(&mut self.previous, now);
        let now = &self.previous;
        // Zero over zero, NaN, for a recording at the time of the previous one.
        let rate = |k: usize| (now[k] - before[k]) / (now[0] - before[0]);
        let stresses = self.stresses.iter().enumerate();
        stresses.map(|(k, one)| if one.along.is_some() { rate(k + 1) } else { f64::NAN }).collect()
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let samples = self.samples.with(snapshot.gas.time(), &self.accumulated(snapshot));
        let rows = samples.since(from);
        let figures =
            self.stresses.iter().enumerate().map(|(k, one)| {
                figure(&one.name, one.along.and_then(|_| steady_rate(&rows, |row| row[k + 1])))
            });
        (Vec::new(), figures.collect())
    }

    fn memory(&self) -> Vec<f64> {
        // Older memories begin with a time, which is never negative.
        let mut memory = vec![-(self.stresses.len() as f64)];
        memory.extend(&self.previous);
        memory.extend(self.samples.memory());
        memory
    }

    fn recall(&mut self, memory: &[f64]) -> bool {
        let [stresses, memory @ ..] = memory else { return false };
        if *stresses != -(self.stresses.len() as f64) {
            return false;
        }
        let Some((previous, samples)) = memory.split_at_checked(self.previous.len()) else { return false };
        let is_one = self.samples.recall(samples);
        if is_one {
            self.previous = previous.to_vec();
        }
        is_one
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::report::Totals;
    use crate::law::boundary::Face;
    use crate::observe::testing::{Bed, State, assert_resumes, figure_of, rough, setting_of, show, smooth};
    use glam::{DVec2, DVec3};

    /// Walls get `lower` and `upper` per time unit, and once twice as much.
    fn pushed<V: Vector>(bed: &Bed<V>, axis: usize, lower: V, upper: V) -> Vec<State<V>> {
        (0..=20)
            .map(|k| {
                let mut totals = Totals::default();
                let time = f64::from(k + i32::from(k > 10));
                totals.counts.wall_momentum[axis] = [lower * time, upper * time];
                (bed.gas(f64::from(k), vec![], vec![]), totals)
            })
            .collect()
    }

    #[test]
    fn stress_is_momentum_over_time_and_area() {
        let mut bed = setting_of(DVec3::new(2.0, 5.0, 8.0), [2, 2, 2]);
        bed.walls(2, rough(DVec3::new(0.0, -1.0, 0.0)), rough(DVec3::new(0.0, 1.0, 0.0)));
        // Area 10; shear (30 + 50)/2, normal (20 + 40)/2.
        let states = pushed(&bed, 2, DVec3::new(7.0, 30.0, -20.0), DVec3::new(0.0, -50.0, 40.0));
        let mut measure = WallStress::new(&bed.setting).unwrap();
        for (k, state) in states.iter().enumerate() {
            let values = show(&mut measure, state);
            let factor = if k == 11 { 2.0 } else { 1.0 };
            if k == 0 {
                assert!(values[0].is_nan());
            } else {
                assert!((values[0] - 4.0 * factor).abs() < 1e-12 && (values[1] - 3.0 * factor).abs() < 1e-12);
            }
        }
        let (shear, error) = figure_of(&mut measure, &states, 10.0, "wall_shear_stress");
        // Ten blocks of one interval, one of them at 8: mean 4.4, s = 4/√10, error 0.4.
        assert!((shear.unwrap() - 4.4).abs() < 1e-12, "{shear:?}");
        assert!((error.unwrap() - 0.4).abs() < 1e-12);
        let (later, _) = figure_of(&mut measure, &states, 11.0, "wall_shear_stress");
        assert!((later.unwrap() - 4.0).abs() < 1e-12);
    }

    #[test]
    fn a_pipe_is_dragged_along_gravity_on_both_sides() {
        let mut bed = setting_of(DVec2::new(6.0, 10.0), [3, 5, 1]);
        bed.walls(0, smooth(), smooth());
        bed.setting.gravity = DVec2::new(0.0, -2.0);
        let states = pushed(&bed, 0, DVec2::new(-10.0, -20.0), DVec2::new(10.0, -40.0));
        let mut measure = WallStress::new(&bed.setting).unwrap();
        let (shear, _) = figure_of(&mut measure, &states, 11.0, "wall_shear_stress");
        let (normal, _) = figure_of(&mut measure, &states, 11.0, "wall_normal_stress");
        assert!((shear.unwrap() - 3.0).abs() < 1e-12);
        assert!((normal.unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_single_floor_bears_all() {
        let mut bed = setting_of(DVec2::new(6.0, 10.0), [3, 5, 1]);
        bed.walls(0, smooth(), smooth());
        bed.walls(1, smooth(), Face::Open);
        bed.setting.gravity = DVec2::new(0.0, -1.0);
        let states = pushed(&bed, 1, DVec2::new(0.0, -12.0), DVec2::ZERO);
        let mut measure = WallStress::new(&bed.setting).unwrap();
        let (normal, _) = figure_of(&mut measure, &states, 11.0, "wall_normal_stress");
        assert!((normal.unwrap() - 2.0).abs() < 1e-12);
        assert_eq!(figure_of(&mut measure, &states, 11.0, "wall_shear_stress"), (None, None));
    }

    #[test]
    fn every_wall_has_its_own_stress() {
        let mut bed = setting_of(DVec3::new(2.0, 5.0, 8.0), [2, 2, 2]);
        bed.walls(2, smooth(), smooth());
        bed.walls(0, rough(DVec3::ZERO), Face::Open);
        bed.setting.gravity = DVec3::new(0.0, 0.0, -1.0);
        let mut states = pushed(&bed, 2, DVec3::new(0.0, 0.0, -40.0), DVec3::new(0.0, 0.0, 10.0));
        for (gas, totals) in &mut states {
            totals.counts.wall_momentum[0][0] = DVec3::new(-120.0, 7.0, -80.0) * gas.time();
        }
        let mut measure = WallStress::new(&bed.setting).unwrap();
        let steady = |measure: &mut WallStress<DVec3>, name: &str| {
            figure_of(measure, &states[..11], 0.0, &format!("wall_{name}")).0.unwrap()
        };
        // Floor and ceiling have an area of 10: the floor carries 4, the ceiling 1, the mean is 2.5.
        assert!((steady(&mut measure, "normal_stress_z_lower") - 4.0).abs() < 1e-12);
        assert!((steady(&mut measure, "normal_stress_z_upper") - 1.0).abs() < 1e-12);
        assert!((steady(&mut measure, "normal_stress") - 2.5).abs() < 1e-12);
        // The rough side of area 40 is pushed outwards and dragged downwards.
        assert!((steady(&mut measure, "normal_stress_x_lower") - 3.0).abs() < 1e-12);
        assert!((steady(&mut measure, "shear_stress_x_lower") - 2.0).abs() < 1e-12);
        let names: Vec<String> = measure.columns().into_iter().map(|column| column.name).collect();
        assert_eq!(names.len(), 6, "{names:?}");
    }

    #[test]
    fn it_resumes() {
        let mut bed = setting_of(DVec2::splat(8.0), [4, 4, 1]);
        bed.walls(1, rough(-DVec2::X), rough(DVec2::X));
        let make = || Box::new(WallStress::new(&bed.setting).unwrap()) as Box<dyn Measure<DVec2>>;
        assert_resumes(make, &bed.random_states(30, 10));
    }
}
