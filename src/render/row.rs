//! Line charts of maps with one row: a channel over the push angle.

use super::{MapOptions, RenderError, labels};
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
    let mut lines = Vec::new();
    let mut names = vec![String::new()];
    if let [axis] = &*grid.sweep {
        let name = |value: &f64| format!("{} = {value}", labels::parameter(axis.parameter));
        names = axis.values.iter().map(name).collect();
    }
    for (index, name) in names.iter().enumerate() {
        let values = map.read_panel(channel, index)?;
        let points = grid.push_angle_deg.iter().copied().zip(values.values());
        let points = points.map(|(angle, value)| [angle, value]).collect();
        let ink = match names.len() {
            1 => Ink::Black,
            _ => Ink::Series(index),
        };
        lines.push(Line::new(points, ink, Stroke::Solid).named(name));
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
    Ok(Chart::single(map.title(), plot).picture(options.size)?)
}
