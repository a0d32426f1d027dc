//! Heat maps: cells over two axes, one panel or a contact sheet of panels.
//!
//! Invariant: a pixel has the colour of the cell that it lies in. Nothing is smoothed.

pub mod cell_axis;
pub mod colour_scale;
mod layout;
pub mod summary;

use crate::frame::heading::LegendEntry;
use crate::picture::palette::{Fill, INK, WHITE};
use crate::picture::{Area, Pen, Picture};
use cell_axis::CellAxis;
use colour_scale::ColourScale;
use layout::HeatMapLayout;
use std::collections::BTreeMap;

/// A heat map: numbers or codes in the cells of one panel, or of many panels side by side.
///
/// ```
/// use whiskmap_plot::{CellAxis, ColourScale, HeatMap, PanelCells, PictureFormat, ScaleOptions, Shading, ValueSummary};
///
/// let values: Vec<f64> = (0..12).map(f64::from).collect(); // [y][x]
/// let mut summary = ValueSummary::default();
/// summary.extend(values.iter().copied());
/// let options = ScaleOptions { label: "force (nN)".to_owned(), ..ScaleOptions::default() };
/// let heat_map = HeatMap {
///     title: "Twelve cells".to_owned(),
///     x: CellAxis::new("angle (deg)", &[0.0, 10.0, 20.0, 30.0]),
///     y: CellAxis::new("distance (mm)", &[1.0, 2.0, 3.0]),
///     panel_axes: [None, None],
///     shading: Shading::Quantities(ColourScale::new(&summary, options)?),
///     legend: Vec::new(),
///     width: Some(800),
/// };
/// let cells = PanelCells { values, ..PanelCells::default() };
/// let picture = heat_map.picture(|_| Ok::<_, std::convert::Infallible>(cells.clone()))?;
/// assert_eq!(picture.pixels()[0], 800);
/// assert!(String::from_utf8(picture.encode(PictureFormat::Svg)?)?.contains(">Twelve cells</text>"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct HeatMap {
    /// Title of the picture; may be empty.
    pub title: String,
    /// Horizontal axis of each panel. A white line marks 0.
    pub x: CellAxis,
    /// Upright axis of each panel.
    pub y: CellAxis,
    /// Axes `[x, y]` along which panels differ: from column to column and from row to row; `None` for a single column or row.
    pub panel_axes: [Option<PanelAxis>; 2],
    /// How cells are coloured.
    pub shading: Shading,
    /// Legend; the entries of a [`ColourScale`] come before it.
    pub legend: Vec<LegendEntry>,
    /// Width in pixels; `None` for the width at which all text can be read.
    pub width: Option<u32>,
}

/// An axis along which the panels of a heat map differ.
#[derive(Clone, Debug, PartialEq)]
pub struct PanelAxis {
    /// Name of the axis, with its unit.
    pub label: String,
    /// Values on the axis, in the unit of `label`: one for each column of panels from the left, or for each row from below.
    pub values: Vec<f64>,
}

/// The contents of one panel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PanelCells {
    /// Values or codes, `[y][x]`. Cells without a finite value are blank on a colour scale.
    pub values: Vec<f64>,
    /// Whether each cell is hatched, `[y][x]`; empty for no cell.
    pub hatched: Vec<bool>,
    /// Black curves over the cells, through points `[x, y]` in the units of the axes.
    pub curves: Vec<Vec<[f64; 2]>>,
}

/// How the cells of a heat map are coloured.
#[derive(Clone, Debug)]
pub enum Shading {
    /// Codes: whole numbers from 0.
    Codes {
        /// Fill of each code.
        fills: BTreeMap<u32, Fill>,
        /// Fill of all other values.
        other: Fill,
    },
    /// Quantities, with a colour bar.
    Quantities(ColourScale),
}

impl Shading {
    fn fill(&self, value: f64) -> Fill {
        match self {
            Self::Codes { fills, other } => {
                let code = value as u32;
                let fill = fills.get(&code).filter(|_| f64::from(code) == value);
                *fill.unwrap_or(other)
            }
            Self::Quantities(scale) => scale.fill(value),
        }
    }
}

impl HeatMap {
    /// Lays the heat map out. `panel` returns the contents of panel `row * columns + column`; panels are drawn one by one.
    ///
    /// # Errors
    /// Errors of `panel`.
    pub fn picture<E>(
        &self,
        panel: impl FnMut(usize) -> Result<PanelCells, E>,
    ) -> Result<Picture, E> {
        HeatMapLayout::plan(self).draw(self, panel)
    }

    fn panel_counts(&self) -> [usize; 2] {
        let count = |axis: &Option<PanelAxis>| axis.as_ref().map_or(1, |axis| axis.values.len());
        self.panel_axes.each_ref().map(count)
    }

    /// Draws a panel into `area` with curves of the given width.
    fn draw_panel(&self, picture: &mut Picture, area: Area, panel: &PanelCells, width: f64) {
        let columns = self.x.count();
        picture.raster(area, |across, up| {
            let cell = self.y.cell(up) * columns + self.x.cell(across);
            let fill = self
                .shading
                .fill(panel.values.get(cell).copied().unwrap_or(f64::NAN));
            match panel.hatched.get(cell) {
                Some(true) => fill.hatched(),
                _ => fill,
            }
        });
        let zero = self.x.fraction(0.0);
        if zero > 0.0 && zero < 1.0 {
            let ends = [area.point(zero, 0.0), area.point(zero, 1.0)];
            picture.polyline(&ends, Pen::solid(0.5 * width, WHITE));
        }
        for curve in &panel.curves {
            let place = |[x, y]: &[f64; 2]| area.point(self.x.fraction(*x), self.y.fraction(*y));
            let places: Vec<_> = curve.iter().map(place).collect();
            picture.polyline(&places, Pen::solid(width, INK));
        }
        picture.frame(area, 0.5 * width);
    }
}
