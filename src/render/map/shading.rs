//! What colour a value gets, and what the reader of the picture is told about it.

use super::boundary;
use super::options::MapOptions;
use super::scale::Scale;
use crate::render::error::Error;
use crate::render::heading::Sample;
use crate::render::palette::{self, Fill, INK};
use crate::render::picture::Pen;
use crate::store::Slice;
use std::collections::BTreeMap;

/// How the values of a channel are shown.
#[derive(Debug)]
pub(super) enum Shading {
    /// Codes that have names.
    Names {
        /// Of every code.
        fills: BTreeMap<u32, Fill>,
        /// What occurs in the map.
        present: Vec<(Sample, String)>,
        /// The detachment boundary is drawn over them, and there is one.
        boundary: bool,
    },
    /// Quantities.
    Scale(Scale),
}

impl Shading {
    /// Decides from the whole map, so that the panels of an atlas can be compared.
    pub(super) fn of(map: &Slice, channel: &str, options: &MapOptions<'_>) -> Result<Self, Error> {
        let Some(names) = map.names(channel) else {
            return Ok(Self::Scale(Scale::of(map, channel, options)?));
        };
        if options.log || options.range.is_some() {
            return Err(Error::Scale(format!(
                "a colour scale of `{channel}`: it is made of codes; choose a channel of quantities, such as force_un"
            )));
        }
        let fills: BTreeMap<u32, Fill> = names
            .keys()
            .enumerate()
            .map(|(place, &code)| match channel {
                "regime" => (code, palette::regime(code)),
                _ => (code, palette::qualitative(place)),
            })
            .collect();
        let codes = map.codes(channel)?;
        let present = names.into_iter().filter(|(code, _)| codes.contains(code));
        let mut present: Vec<_> = present
            .map(|(code, name)| (Sample::Swatch(fills[&code]), name))
            .collect();
        let boundary = channel == "regime" && has_boundary(map)?;
        if boundary {
            let line = Sample::Line(Pen::solid(3.0, INK));
            present.push((line, "detachment boundary".to_owned()));
        }
        Ok(Self::Names {
            fills,
            present,
            boundary,
        })
    }

    /// The fill of a cell.
    pub(super) fn fill(&self, value: f64) -> Fill {
        match self {
            // Codes are stored as u32, so the conversion is exact.
            Self::Names { fills, .. } => {
                let fill = fills.get(&(value as u32)).copied();
                fill.unwrap_or(palette::regime(u32::MAX))
            }
            Self::Scale(scale) => scale.fill(value),
        }
    }

    /// The legend.
    pub(super) fn samples(&self) -> Vec<(Sample, String)> {
        match self {
            Self::Names { present, .. } => present.clone(),
            Self::Scale(scale) => {
                let legend = scale.legend.iter().cloned();
                legend
                    .map(|(fill, name)| (Sample::Swatch(fill), name))
                    .collect()
            }
        }
    }
}

/// Whether any panel shows a stretch of the detachment boundary, which takes the margins.
fn has_boundary(map: &Slice) -> Result<bool, Error> {
    if !map.channels().contains(&"margin_deg") {
        return Ok(false);
    }
    for index in 0..map.layout().panels() {
        let margin_deg = map.read_panel("margin_deg", index)?;
        if !boundary::stretches(map.grid(), &margin_deg).is_empty() {
            return Ok(true);
        }
    }
    Ok(false)
}
