//! Plots of detachment curves: the push angle or a load to the right, the distance upward.

use clap::ValueEnum;
use rayon::prelude::*;
use whiskmap::Side;
use whiskmap::mechanics::shooting::Resolution;
use whiskmap::render::{
    CurveAxis, DISTANCE, DrawnCurve, END_CHORD, END_FORCE, END_MOMENT, END_PUSH, Ink, Plot, Stroke,
    curves, regions,
};
use whiskmap::scene::{Coordinate, Scene, SweepVariable, SweptWhisker};
use whiskmap::trace::{self, Detachment};
use whiskmap::uncertainty::EndSpread;

/// Rows between the farthest distance of the grid and the reach of the whisker; push angles grow like a root near the reach.
const AT_TIP: usize = 16;

/// Largest number of whiskers in one plot.
pub const MOST_WHISKERS: usize = 2000;

/// Number of significant digits of values in the legend.
const NAME_DIGITS: usize = 4;

/// Number of values in the legend where not each has a colour of its own.
const NAMED: usize = 5;

/// Returns the title of the plot: that of the scene, and how many rows of the table have no whisker.
pub fn plot_title(scene: &Scene) -> String {
    match scene.refused().count() {
        0 => scene.title.clone(),
        count => format!("{} ({count} of {} rows have no whisker)", scene.title, scene.table.len()),
    }
}

/// Plots the detachment curves of all whiskers of the scene. The colour shows the value on the first sweep axis with several values, or the row of
/// the table. A single curve has the colours of the kinds of detachment.
pub fn scene_curves(scene: &Scene, resolution: Resolution, x: CurveAxis) -> Plot {
    let whiskers: Vec<SweptWhisker> = scene.whiskers().flatten().collect();
    let coordinate = |swept: &SweptWhisker, index| {
        let mut coordinates = swept.place.coordinates();
        coordinates.nth(index).map(|(_, value)| value)
    };
    let axes = scene.grid.sweep.iter();
    let coloured = axes.enumerate().find(|(_, axis)| axis.values.len() > 1).map(|(index, axis)| {
        // A row without a whisker has no curve, so no colour and no name.
        let drawn = whiskers.iter().map(|swept| coordinate(swept, index));
        let drawn: Vec<Option<Coordinate>> = drawn.collect();
        let values = axis.coordinates().map(Some);
        let values = values.filter(|value| drawn.contains(value));
        (index, axis, values.collect::<Vec<_>>())
    });
    let drawn: Vec<(f64, Vec<Detachment>)> =
        whiskers.par_iter().map(|swept| detachments(scene, resolution, swept)).collect();
    let looks = whiskers.iter().map(|swept| {
        let Some((index, axis, values)) = &coloured else {
            return (None, String::new());
        };
        let value = coordinate(swept, *index);
        let place = values.iter().position(|known| *known == value);
        let (place, last) = (place.unwrap_or_default(), values.len() - 1);
        let step = last as f64 / (NAMED - 1) as f64;
        let is_named = |i: usize| (step * i as f64).round() as usize == place;
        let name = match (&axis.variable, value) {
            (SweepVariable::Whisker(_), Some(name)) => name.to_string(),
            (variable, Some(value)) => {
                format!("{} = {}", variable.name(), value.rounded(NAME_DIGITS))
            }
            (_, None) => String::new(),
        };
        let ink = Ink::of_series(place, values.len());
        let is_shown = matches!(ink, Ink::Series(_)) || (0..NAMED).any(is_named);
        (Some(ink), if is_shown { name } else { String::new() })
    });
    let looks: Vec<(Option<Ink>, String)> = looks.collect();
    let all = drawn.iter().zip(&looks);
    let all = all.map(|((reach_mm, rows), (ink, name))| DrawnCurve {
        rows,
        reach_mm: *reach_mm,
        stroke: Stroke::Solid,
        name,
        ink: *ink,
    });
    Plot {
        regions: Some(regions(scene.is_straight())),
        ..curves("", &all.collect::<Vec<_>>(), [x, UPWARD])
    }
}

/// Returns the reach of a whisker in mm, and its detachments on both sides. Where the grid goes as far as the tip, they do so too.
fn detachments(
    scene: &Scene,
    resolution: Resolution,
    swept: &SweptWhisker,
) -> (f64, Vec<Detachment>) {
    let SweptWhisker { whisker, pole, .. } = swept;
    let reach_mm = trace::reach_mm(whisker, pole, Side::Cb);
    let grid = scene.grid.distance_mm.iter().copied();
    let mut distances: Vec<f64> = grid.clone().filter(|distance| *distance < reach_mm).collect();
    if let Some(&last) = distances.last()
        && grid.last() >= Some(reach_mm)
    {
        let near = |step: usize| {
            let left = 1.0 - step as f64 / AT_TIP as f64;
            reach_mm - left * left * (reach_mm - last)
        };
        distances.extend((1..=AT_TIP).map(near));
    }
    let of_side = |side| trace::ends_at(resolution, whisker, pole, side, &distances);
    (reach_mm, Side::BOTH.into_iter().flat_map(of_side).collect())
}

/// Rows between an end of the grid and a measured point beyond it.
const TO_POINT: usize = 16;

/// Returns the distances of a curve that covers the grid and the measured points, in mm, in growing order and each once.
pub fn covering(grid: &[f64], measured_mm: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut distances: Vec<f64> = grid.iter().copied().chain(measured_mm).collect();
    distances.sort_by(f64::total_cmp);
    let (least, most) = (distances[0], distances[distances.len() - 1]);
    for (end, point) in [(grid[0], least), (grid[grid.len() - 1], most)] {
        let steps = if end == point { 0..0 } else { 1..TO_POINT };
        let part = |step: usize| step as f64 / TO_POINT as f64;
        distances.extend(steps.map(|step| end + part(step) * (point - end)));
    }
    distances.sort_by(f64::total_cmp);
    distances.dedup();
    distances
}

/// Columns that a plot can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum CurveColumn {
    /// Push angle at detachment
    PushAngleDeg,
    /// Size of the force at detachment
    ForceUn,
    /// Moment at the base at detachment
    BaseMomentNnm,
}

impl CurveColumn {
    /// Returns the horizontal axis of the column in plots, in the column's unit.
    pub const fn axis(self) -> CurveAxis {
        match self {
            Self::PushAngleDeg => CurveAxis { label: END_PUSH, value: |end| end.push_angle_deg },
            // The sign keeps the sides apart.
            Self::ForceUn => {
                CurveAxis { label: END_FORCE, value: |end| Some(end.side.sign() * end.force_un?) }
            }
            Self::BaseMomentNnm => {
                CurveAxis { label: END_MOMENT, value: |end| end.base_moment_nnm }
            }
        }
    }

    /// Returns a function that reads the percentiles `[5, 25, 75, 95]` of the column from samples, in its unit; `None` without detachments.
    pub const fn percentiles(self) -> fn(&EndSpread) -> [Option<f64>; 4] {
        match self {
            Self::PushAngleDeg => |row| [row.p5_deg, row.p25_deg, row.p75_deg, row.p95_deg],
            Self::ForceUn => |row| {
                let ends = [row.force_p5_un, row.force_p25_un, row.force_p75_un, row.force_p95_un];
                ends.map(|end| Some(row.side.sign() * end?))
            },
            Self::BaseMomentNnm => |row| {
                [
                    row.base_moment_p5_nnm,
                    row.base_moment_p25_nnm,
                    row.base_moment_p75_nnm,
                    row.base_moment_p95_nnm,
                ]
            },
        }
    }
}

/// Vertical axis of a plot.
pub const UPWARD: CurveAxis = CurveAxis { label: DISTANCE, value: |end| Some(end.distance_mm) };

/// Horizontal axis of plots of measured chord angles, in degrees.
pub const CHORD: CurveAxis = CurveAxis { label: END_CHORD, value: |end| end.push_chord_deg };
