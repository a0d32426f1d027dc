//! The detachment curve of one whisker as a plot.

use whiskmap::render::{CurveAxis, Ends, Plot, Stroke, curves};
use whiskmap::rod::Side;
use whiskmap::scene::{Scene, Swept};
use whiskmap::shooting::Resolution;
use whiskmap::trace::{self, Detachment};

/// The detachment curve of the scene's whisker.
pub fn own_curve(scene: &Scene, resolution: Resolution, axes: [CurveAxis; 2]) -> Plot {
    let Swept { whisker, pole, .. } = scene.first_whisker();
    let distances = &scene.grid.distance_mm;
    let of_side = |side| trace::curve_at(resolution, &whisker, &pole, side, distances);
    let ends: Vec<Detachment> = Side::BOTH.into_iter().flat_map(of_side).collect();
    theory(&ends, axes)
}

/// Computed ends of one whisker as a plot.
pub fn theory(rows: &[Detachment], axes: [CurveAxis; 2]) -> Plot {
    let ends = Ends {
        rows,
        stroke: Stroke::Solid,
        name: "",
    };
    curves("", &[ends], axes)
}

/// What a plot shows across and upwards.
pub const AXES: [CurveAxis; 2] = [
    CurveAxis {
        label: "distance at first touch (mm)",
        value: |end| Some(end.distance_mm),
    },
    CurveAxis {
        label: "push angle at detachment (deg)   CF < 0 < CB",
        value: |end| end.push_angle_deg,
    },
];

/// The chord angle in place of the push angle.
pub const CHORD: CurveAxis = CurveAxis {
    label: "chord angle at detachment (deg)   CF < 0 < CB",
    value: |end| end.push_chord_deg,
};
