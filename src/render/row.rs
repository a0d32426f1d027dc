//! Line charts of maps with one distance or one push angle: a channel over the other one.

use super::marks::{CellMark, MapMarks, YIELDING};
use super::{MapOptions, RenderError, labels};
use crate::classify::Status;
use crate::scene::Coordinate;
use crate::store::MapSlice;
use whiskmap_plot::{Chart, Ink, Line, Picture, Plot, Stroke};

/// Maximum number of whiskers in a line chart. More lines would share colours.
const MOST_LINES: usize = 7;

/// Returns true if a slice is drawn as a line chart: few whiskers at one distance and several push angles, or at one push angle and several distances.
pub fn is_row(map: &MapSlice) -> bool {
    let grid = map.grid();
    let whiskers = 1..=MOST_LINES;
    (grid.distance_mm.len() == 1) != (grid.push_angle_deg.len() == 1)
        && grid.sweep.len() <= 1
        && whiskers.contains(&map.layout().panels())
}

/// Draws a channel of quantities of a slice of one distance or one push angle, with one line for each whisker.
pub fn chart(
    map: &MapSlice,
    channel: &str,
    is_straight: bool,
    options: &MapOptions<'_>,
) -> Result<Picture, RenderError> {
    let grid = map.grid();
    let is_of_push = grid.distance_mm.len() == 1;
    let x = if is_of_push { &grid.push_angle_deg } else { &grid.distance_mm };
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
        for (points, mark) in parts(x, &values, &marks) {
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
    let (name, title) = match is_of_push {
        true => ("distance_mm", format!("distance at first touch: {} mm", grid.distance_mm[0])),
        false => ("push_angle_deg", format!("push angle: {} deg", grid.push_angle_deg[0])),
    };
    let is_named = map.readable().any(|(chosen, _)| chosen == name);
    let plot = Plot {
        // The title of a slice has the selected value.
        title: if is_named { String::new() } else { title },
        x_label: if is_of_push { labels::PUSH_ANGLE } else { labels::DISTANCE }.to_owned(),
        y_label: labels::channel(channel),
        lines,
        regions: is_of_push.then(|| labels::regions(is_straight)),
        y_range: options.range,
        logarithmic: [false, options.log == Some(true)],
        ..Plot::default()
    };
    Ok(Chart::single(options.title(map), plot).picture(options.size)?)
}

/// Part of a line, and the mark of its states.
type RowPart = (Vec<[f64; 2]>, Option<CellMark>);

/// Returns the parts of a row of `values` at `x`, each of one mark. CF and CB have separate parts of push angles, because no line between them
/// would pass through first touch. Parts of one side share an end.
fn parts(x: &[f64], values: &[f64], marks: &[Option<CellMark>]) -> Vec<RowPart> {
    let mark = |i: usize| marks.get(i).copied().flatten();
    let mut parts: Vec<RowPart> = Vec::new();
    for (i, (at, value)) in x.iter().zip(values).enumerate() {
        let point = [*at, *value];
        let crosses = i > 0 && x[i - 1] < 0.0 && *at > 0.0;
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
