//! Contents of a plot as plain data: lines, dots, discs, notes, insets and bands, with their colours.

use crate::picture::palette::{BLUE, GREY, INK, Rgb, SERIES, sequential};

/// Part of the sequential scale that inks use: its end is too light on white.
const DARK: f64 = 0.85;

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
    /// The ink of one of many ordered lines, by its place among them: dark at 0, light at 255.
    Ordered(u8),
}

impl Ink {
    /// Returns the ink of the series at a `place` among `count` series. Each of up to seven has an ink of its own; more are ordered.
    #[must_use]
    pub const fn of_series(place: usize, count: usize) -> Self {
        match count <= SERIES.len() {
            true => Self::Series(place),
            false => Self::Ordered((255 * place / (count - 1)) as u8),
        }
    }

    /// Returns the sRGB colour of the ink.
    #[must_use]
    pub fn rgb(self) -> Rgb {
        match self {
            Self::Black => INK,
            Self::Blue => BLUE,
            Self::Grey => GREY,
            Self::Series(index) => SERIES[index % SERIES.len()],
            Self::Ordered(place) => sequential(DARK * f64::from(place) / 255.0),
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
        Self { points, ink, stroke, name: None }
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

/// A circular body of known size, for plots with [`Plot::equal_axes`](super::Plot::equal_axes). On other axes its size is correct along
/// the coarser axis.
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
        Self { at, text: text.into(), ..Self::default() }
    }

    /// Creates a note with an arrow between two points `[x, y]`, in data units, and a text at the arrow's start.
    #[must_use]
    pub fn arrow(from: [f64; 2], to: [f64; 2], text: impl Into<String>, ink: Ink) -> Self {
        Self { to: Some(to), ink, ..Self::text(from, text) }
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
    /// 1e300, break the band. A band of one point is drawn as a bar.
    pub points: Vec<[[f64; 2]; 2]>,
    /// Grey of the band: light or dark.
    pub shade: Shade,
    /// Name of the band in the legend, which shows equal names once. `None` keeps the band out of the legend.
    pub name: Option<String>,
}
