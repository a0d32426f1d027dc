//! Line charts of maps with one row: a channel over the push angle.

use super::marks::{CellMark, MapMarks, YIELDING};
use super::{MapOptions, RenderError, labels};
use crate::classify::Status;
use crate::scene::Coordinate;
use crate::store::MapSlice;
use whiskmap_plot::{Chart, Ink, Line, Picture, Plot, Stroke};

/// Maximum number of whiskers in a line chart. More lines would share colours.
const MOST_LINES: usize = 7;

/// Returns true if a slice is drawn as a line chart: one row of few whiskers, with several push angles.
pub fn is_row(map: &MapSlice) -> bool {
    let grid = map.grid();
    let whiskers = 1..=MOST_LINES;
    grid.distance_mm.len() == 1
        && grid.push_angle_deg.len() > 1
        && grid.sweep.len() <= 1
        && whiskers.contains(&map.layout().panels())
}

/// Draws a channel of quantities of a slice of one row, with one line for each whisker.
pub fn chart(
    map: &MapSlice,
    channel: &str,
    is_straight: bool,
    options: &MapOptions<'_>,
) -> Result<Picture, RenderError> {
    let grid = map.grid();
    let marks = MapMarks::new(map, channel)?;
    let mut lines = Vec::new();
    let mut names = vec![String::new()];
    if let [axis] = &*grid.sweep {
        let label = labels::variable(&axis.variable);
        let name = |value: Coordinate| format!("{label} = {value}");
        names = axis.coordinates().map(name).collect();
    }
    for (index, name) in names.iter().enumerate() {
        let values: Vec<f64> = map.read_panel(channel, index)?.values().collect();
        let marks = marks.of_panel(map, index)?;
        let ink = match names.len() {
            1 => Ink::Black,
            count => Ink::of_series(index, count),
        };
        for (points, mark) in parts(&grid.push_angle_deg, &values, &marks) {
            lines.push(match mark {
                None => Line::new(points, ink, Stroke::Solid).named(name),
                Some(CellMark::Yields) => {
                    Line::new(points, Ink::Grey, Stroke::Dashed).named(YIELDING)
                }
                Some(CellMark::Status(Status::TowardBase)) => {
                    Line::new(points, ink, Stroke::Dashed).named("slides to base")
                }
                Some(CellMark::Status(_)) => {
                    Line::new(points, Ink::Grey, Stroke::Solid).named("sticks")
                }
            });
        }
    }
    // The title of a slice has the distance.
    let title = match map.readable().any(|(name, _)| name == "distance_mm") {
        true => String::new(),
        false => format!("distance at first touch: {} mm", grid.distance_mm[0]),
    };
    let plot = Plot {
        title,
        x_label: labels::PUSH_ANGLE.to_owned(),
        y_label: labels::channel(channel),
        lines,
        regions: Some(labels::regions(is_straight)),
        y_range: options.range,
        logarithmic: [false, options.log == Some(true)],
        ..Plot::default()
    };
    Ok(Chart::single(options.title(map), plot).picture(options.size)?)
}

/// Part of a line, and the mark of its states.
type RowPart = (Vec<[f64; 2]>, Option<CellMark>);

/// Returns the parts of a row of `values` at `angles`, each of one mark. CF and CB have separate parts, because no line between them
/// would pass through first touch. Parts of one side share an end.
fn parts(angles: &[f64], values: &[f64], marks: &[Option<CellMark>]) -> Vec<RowPart> {
    let mark = |i: usize| marks.get(i).copied().flatten();
    let mut parts: Vec<RowPart> = Vec::new();
    for (i, (angle, value)) in angles.iter().zip(values).enumerate() {
        let point = [*angle, *value];
        let crosses = i > 0 && angles[i - 1] < 0.0 && *angle > 0.0;
        match parts.last_mut() {
            Some((points, last_mark)) if !crosses && *last_mark == mark(i) => points.push(point),
            Some((points, _)) if !crosses => {
                let shared = points.last().copied();
                parts.push((shared.into_iter().chain([point]).collect(), mark(i)));
            }
            _ => parts.push((vec![point], mark(i))),
        }
    }
    parts
}
