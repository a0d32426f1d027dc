//! Charts: curves over axes that fit them, one plot or several.
//!
//! Invariant: every finite point of the data lies inside the frame of its plot. Nothing is clipped except in insets, which show a
//! part once more.

mod chart_layout;
mod plot_layout;
mod viewport;
mod window;

use crate::picture::Picture;

/// The colour of a line or a dot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ink {
    /// Black.
    #[default]
    Black,
    /// Blue, for a second kind of data.
    Blue,
    /// Grey, for what stays in the background.
    Grey,
}

/// Whether a line is solid or dashed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stroke {
    /// Without gaps.
    #[default]
    Solid,
    /// Equal dashes along the whole line, however many points it has.
    Dashed,
}

/// A curve through points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Line {
    /// Points `[x, y]` in data units. A point that is not finite, or beyond 1e300, breaks the line; a point between two breaks is
    /// drawn as a small dot.
    pub points: Vec<[f64; 2]>,
    /// Colour of the line.
    pub ink: Ink,
    /// Solid or dashed.
    pub stroke: Stroke,
    /// Name in the legend, which shows equal names once; a line without a name is not in the legend.
    pub name: Option<String>,
}

impl Line {
    /// A line without a name.
    #[must_use]
    pub const fn new(points: Vec<[f64; 2]>, ink: Ink, stroke: Stroke) -> Self {
        Self {
            points,
            ink,
            stroke,
            name: None,
        }
    }

    /// Sets the name in the legend.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }
}

/// A point that stands out, such as a maximum.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dot {
    /// Point `[x, y]` in data units; not drawn unless finite.
    pub at: [f64; 2],
    /// Colour of the dot.
    pub ink: Ink,
    /// Whether only the rim is inked.
    pub open: bool,
    /// Name in the legend, as in [`Line::name`].
    pub name: Option<String>,
}

/// A circular body of known size, for plots with [`Plot::equal_axes`]. On other axes its size is right along the coarser axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Disc {
    /// Centre `[x, y]` in data units; not drawn unless finite.
    pub centre: [f64; 2],
    /// Radius in data units; a disc is drawn with at least 3 pixels.
    pub radius: f64,
    /// Whether the disc is dark grey instead of light grey.
    pub dark: bool,
}

/// A text above a point, an arrow from the point, or an arrow with a text at its beginning.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Note {
    /// Point `[x, y]` in data units; not drawn unless finite.
    pub at: [f64; 2],
    /// Text; may be empty.
    pub text: String,
    /// End of the arrow in data units; `None` for a text alone.
    pub to: Option<[f64; 2]>,
    /// Colour of the arrow.
    pub ink: Ink,
}

impl Note {
    /// A text above a point.
    #[must_use]
    pub fn text(at: [f64; 2], text: impl Into<String>) -> Self {
        Self {
            at,
            text: text.into(),
            ..Self::default()
        }
    }

    /// An arrow between two points, with a text at its beginning.
    #[must_use]
    pub fn arrow(from: [f64; 2], to: [f64; 2], text: impl Into<String>, ink: Ink) -> Self {
        Self {
            to: Some(to),
            ink,
            ..Self::text(from, text)
        }
    }
}

/// A square of a plot on equal axes, drawn a second time and larger. It shows the plot's lines, and the discs that lie inside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inset {
    /// Centre `[x, y]` of the square in data units.
    pub centre: [f64; 2],
    /// Half the side of the square in data units; nothing is drawn unless it is more than 0.
    pub half: f64,
    /// Centre of the larger square, as fractions of the plot's body from the left and from below.
    pub place: [f64; 2],
    /// Lines that are drawn in the inset only.
    pub lines: Vec<Line>,
    /// Notes that are drawn in the inset only.
    pub notes: Vec<Note>,
}

/// How dark a band is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shade {
    /// For the wider of two bands.
    #[default]
    Light,
    /// For the narrower of two bands.
    Dark,
}

/// The area between two curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Band {
    /// Points `[x, y_of_one_curve, y_of_the_other]` in data units. A point that is not finite, or beyond 1e300, breaks the band.
    pub points: Vec<[f64; 3]>,
    /// How dark the band is.
    pub shade: Shade,
    /// Name in the legend, as in [`Line::name`].
    pub name: Option<String>,
}

/// Curves over one pair of axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    /// Letter of the plot in a chart, such as `A`.
    pub letter: Option<String>,
    /// Title; may be empty.
    pub title: String,
    /// Label of the horizontal axis, with its unit.
    pub x_label: String,
    /// Label of the upright axis, with its unit.
    pub y_label: String,
    /// Bands, drawn first.
    pub bands: Vec<Band>,
    /// Lines, drawn over bands and discs.
    pub lines: Vec<Line>,
    /// Dots, drawn over the lines.
    pub dots: Vec<Dot>,
    /// Discs, drawn over the bands.
    pub discs: Vec<Disc>,
    /// Notes, drawn last.
    pub notes: Vec<Note>,
    /// A part of the plot, enlarged.
    pub inset: Option<Inset>,
    /// Whether a data unit has the same length on both axes.
    pub equal_axes: bool,
    /// Whether both axes are logarithmic. Numbers that are not positive are not drawn, and neither are discs and insets.
    pub logarithmic: bool,
    /// Whether frame, ticks and labels are left out.
    pub bare: bool,
}

impl Plot {
    /// Replaces all numbers by their decimal logarithms, NaN where there is none.
    fn logarithms(&self) -> Self {
        let logarithm = |x: f64| if x > 0.0 { x.log10() } else { f64::NAN };
        let mut plot = Self {
            discs: Vec::new(),
            inset: None,
            equal_axes: false,
            ..self.clone()
        };
        for point in plot.bands.iter_mut().flat_map(|band| &mut band.points) {
            *point = point.map(logarithm);
        }
        for point in plot.lines.iter_mut().flat_map(|line| &mut line.points) {
            *point = point.map(logarithm);
        }
        for dot in &mut plot.dots {
            dot.at = dot.at.map(logarithm);
        }
        for note in &mut plot.notes {
            note.at = note.at.map(logarithm);
            note.to = note.to.map(|to| to.map(logarithm));
        }
        plot
    }
}

/// Plots in rows, below a title and a caption.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// Title; may be empty.
    pub title: String,
    /// Lines of text below the title.
    pub caption: Vec<String>,
    /// Plots from left to right, then downwards.
    pub plots: Vec<Plot>,
    /// Plots per row; 0 counts as 1.
    pub columns: usize,
}

impl Chart {
    /// A chart of one plot.
    #[must_use]
    pub fn single(title: impl Into<String>, plot: Plot) -> Self {
        Self {
            title: title.into(),
            plots: vec![plot],
            ..Self::default()
        }
    }

    /// Lays the chart out; equal charts give equal pictures.
    #[must_use]
    pub fn picture(&self) -> Picture {
        chart_layout::ChartLayout::plan(self).draw()
    }
}
