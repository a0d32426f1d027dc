//! Heat maps: cells over two axes, in one panel or a contact sheet of panels.
//!
//! Invariant: a pixel has the colour of the cell that it lies in. Nothing is smoothed.

pub mod cell_axis;
pub mod colour_scale;
mod layout;
mod panels;
pub mod summary;

use crate::frame::heading::LegendEntry;
use crate::frame::regions::Region;
use crate::frame::ticks;
use crate::picture::palette::{Fill, INK, WHITE};
use crate::picture::size::{PictureSize, SizeError};
use crate::picture::{Area, Pen, Picture};
use cell_axis::CellAxis;
use colour_scale::ColourScale;
use layout::HeatMapLayout;
use std::collections::BTreeMap;

/// A heat map: numbers or codes in the cells of one panel, or of many panels side by side.
///
/// ```
/// use whiskmap_plot::{CellAxis, ColourScale, HeatMap, PanelCells, PictureFormat, PictureSize, ScaleOptions, Shading, SizeError,
///     ValueSummary};
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
///     regions: None,
/// };
/// let cells = PanelCells { values, ..PanelCells::default() };
/// let picture = heat_map.picture(PictureSize::Width(800), |_| Ok::<_, SizeError>(cells.clone()))?;
/// assert_eq!(picture.pixels()[0], 800);
/// assert!(String::from_utf8(picture.encode(PictureFormat::Svg)?)?.contains(">Twelve cells</text>"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct HeatMap {
    /// Title of the heat map; may be empty.
    pub title: String,
    /// Horizontal axis of each panel of the heat map. A white line marks the value 0.
    pub x: CellAxis,
    /// Vertical axis of each panel of the heat map.
    pub y: CellAxis,
    /// Axes `[x, y]` along which the panels of the heat map differ: between columns and between rows. `None` for a single value. With one
    /// axis, panels fill rows from the upper left, each with its value above it.
    pub panel_axes: [Option<PanelAxis>; 2],
    /// Colouring of the cells of the heat map: by codes, or by a colour scale.
    pub shading: Shading,
    /// Legend of the heat map, `[entry]`; the entries of a [`ColourScale`] come before it.
    pub legend: Vec<LegendEntry>,
    /// Regions of the heat map left and right of 0: `[left, right]`; `None` for no regions.
    pub regions: Option<[Region; 2]>,
}

/// An axis along which the panels of a heat map differ.
#[derive(Clone, Debug, PartialEq)]
pub struct PanelAxis {
    /// Name of the panel axis, with its unit.
    pub label: String,
    /// Texts on the panel axis: one for each column of panels from the left, or for each row from below.
    pub texts: Vec<String>,
}

impl PanelAxis {
    /// Creates the axis of panels that differ in a number. Values are in the unit of `label`.
    #[must_use]
    pub fn of_values(label: String, values: &[f64]) -> Self {
        let texts = ticks::labels(values);
        Self { label, texts }
    }
}

/// The contents of one panel of a heat map: values, hatching and curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PanelCells {
    /// Values or codes of the panel's cells, row by row, `[y][x]`. Cells without a finite value are blank on a colour scale.
    pub values: Vec<f64>,
    /// Hatching of the panel's cells, `[y][x]`: true for a hatched cell. Empty if no cell is hatched.
    pub hatched: Vec<bool>,
    /// Black curves over the panel's cells, through points `[x, y]` in the units of the axes: `[curve][point]`.
    pub curves: Vec<Vec<[f64; 2]>>,
}

/// Colouring of the cells of a heat map: codes or quantities.
#[derive(Clone, Debug)]
pub enum Shading {
    /// Cells contain codes: whole numbers from 0, each with its fill.
    Codes {
        /// Fill of each code of a heat map.
        fills: BTreeMap<u32, Fill>,
        /// Fill of cells whose value has no fill of its own.
        other: Fill,
    },
    /// Cells contain quantities, coloured by a scale with a colour bar.
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
    /// Lays the heat map out as a picture of this size. `panel` returns the contents of panel `y * count of x + x`; panels are drawn one by one.
    ///
    /// # Errors
    /// The size on paper is too small, or an error of `panel`.
    pub fn picture<E: From<SizeError>>(
        &self,
        size: PictureSize,
        panel: impl FnMut(usize) -> Result<PanelCells, E>,
    ) -> Result<Picture, E> {
        HeatMapLayout::plan(self, size)?.draw(panel)
    }

    /// Notes on the axes of the panels of a contact sheet.
    fn notes(&self) -> Vec<String> {
        let above = match &self.panel_axes {
            [Some(axis), None] | [None, Some(axis)] => {
                Some(format!("above each panel: {}", axis.label))
            }
            _ => None,
        };
        let across = format!("each panel, to the right: {}", self.x.summary());
        let upwards = format!("each panel, upwards: {}", self.y.summary());
        let regions = self.regions.iter().map(|[left, right]| {
            format!("each panel, left of 0: {}; right: {}", left.name, right.name)
        });
        let inside = [across, upwards].into_iter().chain(regions);
        above.into_iter().chain(inside).collect()
    }

    /// Draws a panel into `area` with curves of the given width.
    fn draw_panel(&self, picture: &mut Picture, area: Area, panel: &PanelCells, width: f64) {
        let columns = self.x.count();
        picture.raster(area, |across, up| {
            let cell = self.y.cell(up) * columns + self.x.cell(across);
            let fill = self.shading.fill(panel.values.get(cell).copied().unwrap_or(f64::NAN));
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
