//! Pictures of stored maps: the regimes, or any channel.

use super::boundary::stretches;
use super::marks::MapMarks;
use super::{MapOptions, RenderError, labels, row};
use crate::classify::{Regime, Status};
use crate::scene::{SweepAxis, SweepVariable};
use crate::store::{ChannelValues, MapSlice, NOT_COMPUTED};
use std::collections::{BTreeMap, BTreeSet};
use whiskmap_plot::{
    CellAxis, ColourScale, Fill, HeatMap, LegendEntry, PanelAxis, PanelCells, Picture, Rgb,
    ScaleOptions, Shading, ValueSummary,
};

/// Draws a map: codes with a legend, quantities with a colour bar. A map of several whiskers becomes a contact sheet with the first
/// sweep axis to the right and the second upwards. Quantities at one distance, or at one push angle, become a line chart. All maps show the detachment boundary if
/// their margins are stored.
///
/// # Errors
/// The map has more than two sweep axes, lacks the channel, or is damaged. Or the channel cannot have the requested colour scale, or the
/// size on paper is too small.
pub fn map(map: &MapSlice, options: &MapOptions<'_>) -> Result<Picture, RenderError> {
    let grid = map.grid();
    if grid.sweep.len() > 2 {
        return Err(RenderError::TooManyAxes(grid.sweep_names()));
    }
    let channel = options.channel.unwrap_or("regime");
    let is_straight = map.is_straight()?;
    if row::is_row(map) && map.names(channel).is_none() {
        return row::chart(map, channel, is_straight, options);
    }
    let without_whisker = match channel {
        "regime" => without_whisker(map)?,
        _ => BTreeSet::new(),
    };
    let (shading, mut legend) = match map.names(channel) {
        Some(names) => codes(map, channel, names, &without_whisker, options)?,
        None => (quantities(map, channel, options)?, Vec::new()),
    };
    let is_log = matches!(&shading, Shading::Quantities(scale) if scale.is_log());
    let has_sizes = is_log && is_moment(channel);
    let marks = MapMarks::new(map, channel)?;
    if let Some(name) = marks.name() {
        legend.push(LegendEntry::swatch(Fill::BLANK.hatched(), name));
    }
    let has_boundary = has_boundary(map)?;
    if has_boundary {
        legend.push(LegendEntry::curve("detachment boundary"));
    }
    let heat_map = HeatMap {
        title: options.title(map),
        x: CellAxis::new(labels::PUSH_ANGLE, &grid.push_angle_deg),
        y: CellAxis::new(labels::DISTANCE, &grid.distance_mm),
        panel_axes: grid.atlas().map(|axis| axis.map(panel_axis)),
        shading,
        legend,
        regions: Some(labels::regions(is_straight)),
    };
    heat_map.picture(options.size, |index| {
        if without_whisker.contains(&index) {
            let count = grid.panel_cells();
            return Ok(PanelCells {
                values: vec![f64::from(NOT_COMPUTED); count],
                hatched: vec![true; count],
                ..PanelCells::default()
            });
        }
        let values = map.read_panel(channel, index)?;
        let mut cells = PanelCells {
            values: shown(&values, has_sizes).collect(),
            hatched: marks.hatched(map, index)?,
            ..PanelCells::default()
        };
        if has_boundary {
            cells.curves = stretches(grid, &map.read_panel("margin_deg", index)?);
        }
        Ok(cells)
    })
}

fn panel_axis(axis: &SweepAxis) -> PanelAxis {
    let label = labels::variable(&axis.variable);
    match axis.variable {
        SweepVariable::Parameter(_) => PanelAxis::of_values(label, &axis.values),
        SweepVariable::Whisker(_) => {
            PanelAxis { label, texts: axis.coordinates().map(|name| name.to_string()).collect() }
        }
    }
}

/// Returns the panels of rows of a table without a whisker.
fn without_whisker(map: &MapSlice) -> Result<BTreeSet<usize>, RenderError> {
    let axes = map.grid().sweep.iter();
    let mut variables = axes.map(|axis| &axis.variable);
    let has_table = variables.any(|variable| matches!(variable, SweepVariable::Whisker(_)));
    let mut panels = BTreeSet::new();
    if has_table && map.channels().contains(&"status") {
        for index in 0..map.layout().panels() {
            if let ChannelValues::U32(codes) = map.read_panel("status", index)?
                && codes.first() == Some(&Status::NoWhisker.code())
            {
                panels.insert(index);
            }
        }
    }
    Ok(panels)
}

/// The fills of a channel of codes, and the legend of the codes that occur. Panels without a whisker have their own entry.
fn codes(
    map: &MapSlice,
    channel: &str,
    names: BTreeMap<u32, String>,
    without_whisker: &BTreeSet<usize>,
    options: &MapOptions<'_>,
) -> Result<(Shading, Vec<LegendEntry>), RenderError> {
    if options.log.is_some() || options.range.is_some() {
        return Err(RenderError::Codes(channel.to_owned()));
    }
    let fill = |(place, &code): (usize, &u32)| match channel {
        _ if code == u32::from(NOT_COMPUTED) => (code, Fill::BLANK),
        "regime" => (code, regime_fill(code)),
        _ => (code, Fill::qualitative(place)),
    };
    let fills: BTreeMap<u32, Fill> = names.keys().enumerate().map(fill).collect();
    let mut codes = BTreeSet::new();
    if without_whisker.is_empty() {
        codes = map.codes(channel)?;
    } else {
        let panels = 0..map.layout().panels();
        for index in panels.filter(|index| !without_whisker.contains(index)) {
            if let ChannelValues::U32(panel_codes) = map.read_panel(channel, index)? {
                codes.extend(panel_codes);
            }
        }
    }
    let present = names.into_iter().filter(|(code, _)| codes.contains(code));
    let entry = |(code, name)| LegendEntry::swatch(fills[&code], name);
    let mut legend: Vec<LegendEntry> = present.map(entry).collect();
    if !without_whisker.is_empty() {
        let fill = Fill::BLANK.hatched();
        legend.push(LegendEntry::swatch(fill, "no whisker"));
    }
    let other = regime_fill(Regime::Unresolved.code());
    Ok((Shading::Codes { fills, other }, legend))
}

/// Returns true if any panel shows a stretch of the detachment boundary.
fn has_boundary(map: &MapSlice) -> Result<bool, RenderError> {
    if !map.channels().contains(&"margin_deg") {
        return Ok(false);
    }
    for index in 0..map.layout().panels() {
        if !stretches(map.grid(), &map.read_panel("margin_deg", index)?).is_empty() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Returns the fill of a regime's code; an unknown code looks unresolved. Regimes that occur side by side differ by 20 in lightness (CIE L*): 96, 74,
/// 53 and 31. They and unresolved stay apart for people who lack one of the three cones.
pub fn regime_fill(code: u32) -> Fill {
    const CONTACT: Rgb = [0x83, 0xc4, 0xa4];
    let known = Regime::ALL.into_iter().find(|known| known.code() == code);
    match known.unwrap_or(Regime::Unresolved) {
        Regime::OutOfReach => Fill::plain([0xf2, 0xf3, 0xf4]),
        Regime::Contact => Fill::plain(CONTACT),
        Regime::SlipOff => Fill::plain([0xc8, 0x60, 0x2a]),
        Regime::PullOff => Fill::plain([0x22, 0x47, 0x8a]),
        Regime::Unreachable => Fill::striped([0xd3, 0xec, 0xdf], CONTACT),
        Regime::Unresolved => Fill::plain([0xf0, 0xe4, 0x42]),
    }
}

/// The colour scale of a channel of quantities, common to all panels.
fn quantities(
    map: &MapSlice,
    channel: &str,
    options: &MapOptions<'_>,
) -> Result<Shading, RenderError> {
    // Both sides of a moment share the scale of its size, unless the ends of the colour bar have signs.
    let is_positive = options.range.is_none_or(|[low, _]| low > 0.0);
    if is_moment(channel) && options.log != Some(false) && is_positive {
        let sizes = scaled(map, channel, options, true)?;
        if matches!(&sizes, Shading::Quantities(scale) if scale.is_log()) {
            return Ok(sizes);
        }
    }
    scaled(map, channel, options, false)
}

/// Returns true for a moment, which has the sign of its side.
fn is_moment(channel: &str) -> bool {
    channel.ends_with("_nnm")
}

/// Yields the values of a channel, or their sizes.
fn shown(values: &ChannelValues, has_sizes: bool) -> impl Iterator<Item = f64> + '_ {
    let shown = move |value: f64| if has_sizes { value.abs() } else { value };
    values.values().map(shown)
}

/// The colour scale of a channel of quantities, or of their sizes.
fn scaled(
    map: &MapSlice,
    channel: &str,
    options: &MapOptions<'_>,
    has_sizes: bool,
) -> Result<Shading, RenderError> {
    let mut summary = ValueSummary::default();
    let mut whole = false;
    for index in 0..map.layout().panels() {
        let samples = map.read_panel(channel, index)?;
        whole |= matches!(samples, ChannelValues::U32(_));
        summary.extend(shown(&samples, has_sizes));
    }
    let size = if has_sizes { "size of the " } else { "" };
    let scale = ScaleOptions {
        label: format!("{size}{}", labels::channel(channel)),
        blank: if map.has_blanks() {
            "no contact, or not computed".to_owned()
        } else {
            "no contact".to_owned()
        },
        log: options.log.or((!labels::is_load(channel)).then_some(false)),
        range: options.range,
        whole,
    };
    let scale = ColourScale::new(&summary, scale)
        .map_err(|cause| RenderError::Scale { channel: channel.to_owned(), cause })?;
    Ok(Shading::Quantities(scale))
}
