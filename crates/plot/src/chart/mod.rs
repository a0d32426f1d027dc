//! Charts: curves over axes that fit them, in one plot or several.
//!
//! Invariant: every finite point of the data lies inside the frame of its plot. Nothing is clipped except in insets, which enlarge a part
//! of a plot, and beyond a given [`Plot::y_range`].

mod chart_layout;
mod plot_layout;
mod viewport;
mod window;

use crate::frame::regions::Region;
use crate::picture::Picture;
use crate::picture::palette::{BLUE, GREY, INK, Rgb, SERIES};
use crate::picture::size::{PictureSize, SizeError};

/// The colour of a line, a dot or an arrow of a chart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ink {
    /// Black ink.
    #[default]
    Black,
    /// Blue ink, for a second kind of data.
    Blue,
    /// Grey ink, for lines in the background.
    Grey,
    /// The ink of a series among several, counted from 0; after seven inks they repeat.
    Series(usize),
}

impl Ink {
    /// Returns the sRGB colour of the ink.
    #[must_use]
    pub const fn rgb(self) -> Rgb {
        match self {
            Self::Black => INK,
            Self::Blue => BLUE,
            Self::Grey => GREY,
            Self::Series(index) => SERIES[index % SERIES.len()],
        }
    }
}

/// The dash pattern of a line of a chart: solid or dashed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stroke {
    /// A line without gaps.
    #[default]
    Solid,
    /// A line of equal dashes; their length does not depend on the spacing of its points.
    Dashed,
}

/// A line of a plot: a curve through points, with colour, stroke and name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Line {
    /// Points `[x, y]` of the line, in data units. A point that is not finite, or beyond 1e300, breaks the line; a point between two
    /// breaks is drawn as a small dot.
    pub points: Vec<[f64; 2]>,
    /// Colour of the line.
    pub ink: Ink,
    /// Dash pattern of the line: solid or dashed.
    pub stroke: Stroke,
    /// Name of the line in the legend, which shows equal names once. `None` keeps the line out of the legend.
    pub name: Option<String>,
}

impl Line {
    /// Creates a line through `points` `[x, y]`, in data units, without a name.
    #[must_use]
    pub const fn new(points: Vec<[f64; 2]>, ink: Ink, stroke: Stroke) -> Self {
        Self {
            points,
            ink,
            stroke,
            name: None,
        }
    }

    /// Sets the name of the line in the legend.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }
}

/// A dot of a plot: one marked point, such as a maximum.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dot {
    /// Position `[x, y]` of the dot, in data units; a dot is not drawn unless both are finite.
    pub at: [f64; 2],
    /// Colour of the dot.
    pub ink: Ink,
    /// True if the dot is an empty ring, false if it is filled.
    pub open: bool,
    /// Name of the dot in the legend, which shows equal names once. `None` keeps the dot out of the legend.
    pub name: Option<String>,
}

/// A circular body of known size, for plots with [`Plot::equal_axes`]. On other axes its size is correct along the coarser axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Disc {
    /// Centre `[x, y]` of the disc, in data units; a disc is not drawn unless both are finite.
    pub centre: [f64; 2],
    /// Radius of the disc, in data units; a disc is drawn with at least 3 pixels.
    pub radius: f64,
    /// True if the disc is dark grey, false if it is light grey.
    pub dark: bool,
}

/// A note in a plot: a text above a point, an arrow from the point, or an arrow with a text at its start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Note {
    /// Point `[x, y]` of the note, in data units; a note is not drawn unless both are finite.
    pub at: [f64; 2],
    /// Text of the note; may be empty.
    pub text: String,
    /// End `[x, y]` of the note's arrow, in data units; `None` for a text alone.
    pub to: Option<[f64; 2]>,
    /// Colour of the note's arrow.
    pub ink: Ink,
}

impl Note {
    /// Creates a note with a text above the point `at` `[x, y]`, in data units.
    #[must_use]
    pub fn text(at: [f64; 2], text: impl Into<String>) -> Self {
        Self {
            at,
            text: text.into(),
            ..Self::default()
        }
    }

    /// Creates a note with an arrow between two points `[x, y]`, in data units, and a text at the arrow's start.
    #[must_use]
    pub fn arrow(from: [f64; 2], to: [f64; 2], text: impl Into<String>, ink: Ink) -> Self {
        Self {
            to: Some(to),
            ink,
            ..Self::text(from, text)
        }
    }
}

/// An enlarged square of a plot on equal axes. It shows the plot's lines in the square, and the discs that lie inside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inset {
    /// Centre `[x, y]` of the enlarged square, in data units.
    pub centre: [f64; 2],
    /// Half the side of the square that an inset enlarges, in data units; nothing is drawn unless it is positive.
    pub half: f64,
    /// Centre of the inset in the plot, as fractions `[x, y]` of the plot's width from the left and its height from below.
    pub place: [f64; 2],
    /// Lines that are drawn in the inset only, in data units.
    pub lines: Vec<Line>,
    /// Notes that are drawn in the inset only, in data units.
    pub notes: Vec<Note>,
}

/// The grey of a band of a plot: light or dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shade {
    /// Light grey, for the wider of two bands.
    #[default]
    Light,
    /// Dark grey, for the narrower of two bands.
    Dark,
}

/// A band of a plot: the shaded area between two curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Band {
    /// Points of the band, each `[x, y]` on one curve and `[x, y]` on the other, in data units. Points that are not finite, or beyond
    /// 1e300, break the band.
    pub points: Vec<[[f64; 2]; 2]>,
    /// Grey of the band: light or dark.
    pub shade: Shade,
    /// Name of the band in the legend, which shows equal names once. `None` keeps the band out of the legend.
    pub name: Option<String>,
}

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
    /// Axes of the plot that are logarithmic, `[x, y]`. On these, numbers that are not positive are not drawn; if any is logarithmic,
    /// neither are discs and insets.
    pub logarithmic: [bool; 2],
    /// Names of the numbers 0, 1, 2, ... on the plot's vertical axis, `[number]`, in place of ticks; empty for ticks.
    pub y_names: Vec<String>,
    /// True if the plot is drawn without frame, ticks and labels.
    pub bare: bool,
}

impl Plot {
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
            y_range: self.y_range.map(|range| range.map(|end| on(1, end))),
            ..self.clone()
        };
        for point in plot.bands.iter_mut().flat_map(|band| &mut band.points) {
            *point = point.map(logarithm);
        }
        for point in plot
            .lines
            .iter_mut()
            .chain(&mut plot.bars)
            .flat_map(|line| &mut line.points)
        {
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
        Self {
            title: title.into(),
            plots: vec![plot],
            ..Self::default()
        }
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
