//! A sheared gas: its velocity profile beside the straight line.

use super::evidence::{Evidence, points, values};
use super::plot::{Curve, Ink, Plot, Stroke};

/// Name of the profile.
pub(super) const PROFILE: &str = "velocity-profile";

/// The mean velocity against height, the last profile of the run.
pub(super) fn plots(evidence: &Evidence<'_>) -> Vec<Plot> {
    let profiles = evidence.profiles(PROFILE);
    let Some(profile) = profiles.last() else {
        return Vec::new();
    };
    let setup = evidence.setup;
    let (heights, velocities) = (values(profile, "height", 0), values(profile, "velocity", 1));
    let mut measured = Curve::new("measured", points(heights, velocities), Stroke::Dots, Ink::Series(0));
    let has_errors = profile.columns.iter().any(|column| column.name == "standard_error");
    if has_errors {
        measured.errors = values(profile, "standard_error", 2).to_vec();
    }
    let mut plot = Plot {
        title: "Velocity profile".to_owned(),
        x_label: setup.label(&profile.columns[0]),
        y_label: setup.with_unit("mean velocity", profile.columns[1].unit),
        ..Plot::default()
    };
    if let Some(law) = linear_law(evidence) {
        plot.ranges = ranges(&law, &measured.points);
        plot.curves.push(Curve::new("linear law v·y/H", law, Stroke::Dashed, Ink::Text));
        plot.caption =
            "Dashed: the straight line between the velocities of the two walls (Müller 2001, fig. 3.12)."
                .to_owned();
    }
    if has_errors {
        plot.caption.push_str(" Bars: one standard error.");
    }
    plot.curves.push(measured);
    vec![plot]
}

/// From wall to wall, and all velocities on the way with some room.
fn ranges(law: &[[f64; 2]], measured: &[[f64; 2]]) -> [Option<[f64; 2]>; 2] {
    let velocities = law.iter().chain(measured).map(|p| p[1]).filter(|v| v.is_finite());
    let [least, most] = velocities.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, m], v| [l.min(v), m.max(v)]);
    let room = 0.06 * (most - least);
    let is_range = law[0][0] < law[1][0] && room > 0.0;
    [is_range.then(|| [law[0][0], law[1][0]]), is_range.then_some([least - room, most + room])]
}

/// The straight line from wall to wall, where nothing but the walls drives the grains.
fn linear_law(evidence: &Evidence<'_>) -> Option<Vec<[f64; 2]>> {
    let shear = evidence.setup.shear().filter(|shear| shear.is_alone)?;
    Some(vec![[0.0, shear.lower], [shear.height, shear.lower + shear.speed]])
}
