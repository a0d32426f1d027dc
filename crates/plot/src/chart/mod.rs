//! Charts: curves over axes that fit them, in one plot or several.
//!
//! Invariant: every finite point of the data lies inside the frame of its plot. Nothing is clipped except in insets, which enlarge a part
//! of a plot, and beyond a given [`Plot::y_range`].

mod chart_layout;
mod contents;
mod plot_layout;
mod viewport;
mod window;

pub use contents::{Band, Disc, Dot, Ink, Inset, Line, Note, Shade, Stroke};

use crate::frame::regions::Region;
use crate::picture::Picture;
use crate::picture::size::{PictureSize, SizeError};

/// A plot: lines, bands, dots, discs and notes over one pair of axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    /// Letter of the plot in a chart, such as `A`; `None` for no letter.
    pub letter: Option<String>,
    /// Title of the plot; may be empty.
    pub title: String,
    /// Label of the plot's horizontal axis, with its unit.
    pub x_label: String,
    /// Label of the plot's vertical axis, with its unit.
    pub y_label: String,
    /// Bands of the plot, drawn first.
    pub bands: Vec<Band>,
    /// Lines of the plot, drawn over bands and discs.
    pub lines: Vec<Line>,
    /// Dots of the plot, drawn over its lines.
    pub dots: Vec<Dot>,
    /// Lines drawn over the dots with a white rim, such as error bars; they have no legend.
    pub bars: Vec<Line>,
    /// Discs of the plot, drawn over its bands.
    pub discs: Vec<Disc>,
    /// Notes of the plot, drawn last.
    pub notes: Vec<Note>,
    /// Enlarged square of the plot; `None` for no inset.
    pub inset: Option<Inset>,
    /// True if a data unit has the same length on both axes of the plot.
    pub equal_axes: bool,
    /// Regions of the plot left and right of 0, which a line separates: `[left, right]`; `None` for no regions.
    pub regions: Option<[Region; 2]>,
    /// Range `[low, high]` of the plot's vertical axis, in data units: lines and bands are clipped to it, and other contents beyond it
    /// are not drawn. `None` for the extent of all contents.
    pub y_range: Option<[f64; 2]>,
    /// Range `[left, right]` of the plot's horizontal axis, in data units; `None` for the extent of all contents. Lines beyond it are drawn.
    pub x_range: Option<[f64; 2]>,
    /// True if a plot below has the numbers and the label of the horizontal axis, which both share.
    pub is_above: bool,
    /// Axes of the plot that are logarithmic, `[x, y]`. On these, numbers that are not positive are not drawn; if any is logarithmic,
    /// neither are discs and insets.
    pub logarithmic: [bool; 2],
    /// Names of the numbers 0, 1, 2, ... on the plot's vertical axis, `[number]`, in place of ticks; empty for ticks.
    pub y_names: Vec<String>,
    /// True if the plot is drawn without frame, ticks and labels.
    pub bare: bool,
}

impl Plot {
    /// Returns true if the plot has neither bands nor discs, dots, notes or points of lines.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        let has_points = self.lines.iter().any(|line| !line.points.is_empty());
        let others = [self.bands.len(), self.discs.len(), self.dots.len(), self.notes.len()];
        !has_points && others == [0; 4]
    }

    /// Replaces all numbers on logarithmic axes by their decimal logarithms, NaN where there is none.
    fn logarithms(&self) -> Self {
        let on = |axis: usize, value: f64| match self.logarithmic[axis] {
            false => value,
            true if value > 0.0 => value.log10(),
            true => f64::NAN,
        };
        let logarithm = |[x, y]: [f64; 2]| [on(0, x), on(1, y)];
        let mut plot = Self {
            discs: Vec::new(),
            inset: None,
            equal_axes: false,
            x_range: self.x_range.map(|range| range.map(|end| on(0, end))),
            y_range: self.y_range.map(|range| range.map(|end| on(1, end))),
            ..self.clone()
        };
        for point in plot.bands.iter_mut().flat_map(|band| &mut band.points) {
            *point = point.map(logarithm);
        }
        for point in plot.lines.iter_mut().chain(&mut plot.bars).flat_map(|line| &mut line.points) {
            *point = logarithm(*point);
        }
        for dot in &mut plot.dots {
            dot.at = logarithm(dot.at);
        }
        for note in &mut plot.notes {
            note.at = logarithm(note.at);
            note.to = note.to.map(logarithm);
        }
        plot
    }
}

/// A chart: plots in rows below a title and a caption.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// Title of the chart; may be empty.
    pub title: String,
    /// Caption of the chart, `[line]`: lines of text below the title.
    pub caption: Vec<String>,
    /// Plots of the chart, from left to right, then downwards, `[plot]`.
    pub plots: Vec<Plot>,
    /// Number of plots in a row of the chart; 0 counts as 1.
    pub columns: usize,
}

impl Chart {
    /// Creates a chart of one plot.
    #[must_use]
    pub fn single(title: impl Into<String>, plot: Plot) -> Self {
        Self { title: title.into(), plots: vec![plot], ..Self::default() }
    }

    /// Lays the chart out as a picture of this size; equal charts give equal pictures.
    ///
    /// # Errors
    /// The size on paper is too small.
    pub fn picture(&self, size: PictureSize) -> Result<Picture, SizeError> {
        Ok(chart_layout::ChartLayout::plan(self, size)?.draw())
    }

    /// The number of plots in a row.
    fn columns(&self) -> usize {
        self.columns.clamp(1, self.plots.len().max(1))
    }
}
