//! What a chart is made of: plain data.

/// The colour of a line or a dot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ink {
    /// Stable states, and slip-off.
    #[default]
    Black,
    /// Pull-off.
    Blue,
    /// The rest shape, and whatever else stays behind.
    Grey,
}

/// The way in which a line is drawn.
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
    /// Across and up, in data units. A point that is not finite, or beyond 1e300, breaks the line; one without a
    /// neighbour is a small dot.
    pub points: Vec<[f64; 2]>,
    /// Its colour.
    pub ink: Ink,
    /// Solid or dashed.
    pub stroke: Stroke,
    /// Its name in the legend, where equal names stand once; without one it is not in the legend.
    pub name: Option<String>,
}

impl Line {
    /// A line with a name.
    #[must_use]
    pub fn new(points: Vec<[f64; 2]>, ink: Ink, stroke: Stroke, name: impl Into<String>) -> Self {
        let name = Some(name.into());
        Self {
            points,
            ink,
            stroke,
            name,
        }
    }
}

/// A point that stands out, such as a fold.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dot {
    /// Across and up, in data units; not drawn unless finite.
    pub at: [f64; 2],
    /// Its colour.
    pub ink: Ink,
    /// Only its rim is inked.
    pub open: bool,
    /// Its name in the legend, as that of a [`Line`].
    pub name: Option<String>,
}

/// A body of known size, such as a pole, meant for [`Plot::equal_axes`]: on other axes its size is right along the
/// coarser one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Disc {
    /// Across and up, in data units; not drawn unless finite.
    pub centre: [f64; 2],
    /// In data units; small ones are drawn with 3 pixels.
    pub radius: f64,
    /// Darker than others.
    pub dark: bool,
}

/// A text above a point, an arrow that begins there, or an arrow with a text at its beginning.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Note {
    /// Across and up, in data units; not drawn unless finite.
    pub at: [f64; 2],
    /// May be empty.
    pub text: String,
    /// Where the arrow ends, if there is one.
    pub to: Option<[f64; 2]>,
    /// Colour of the arrow.
    pub ink: Ink,
}

/// A square of a plot on equal axes, drawn once more and larger: its lines, and the discs that lie inside it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inset {
    /// Centre of the square, in data units.
    pub centre: [f64; 2],
    /// Half its side, in data units; nothing is drawn unless it is more than 0.
    pub half: f64,
    /// Where the centre of the larger square stands, as fractions of the body from the left and from below.
    pub place: [f64; 2],
    /// Lines of the inset alone.
    pub lines: Vec<Line>,
    /// Notes of the inset alone.
    pub notes: Vec<Note>,
}

/// How dark an area is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shade {
    /// For the wider of two areas.
    #[default]
    Light,
    /// For the one inside.
    Dark,
}

/// The area between two curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Band {
    /// Across, and up from the one to the other curve, in data units. A point that cannot be drawn breaks the band.
    pub points: Vec<[f64; 3]>,
    /// How dark it is.
    pub shade: Shade,
    /// Its name in the legend, as that of a [`Line`].
    pub name: Option<String>,
}

/// Curves over one pair of axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    /// What the plot is called by, such as `A`.
    pub letter: Option<String>,
    /// May be empty.
    pub title: String,
    /// What is shown across, with its unit.
    pub x_label: String,
    /// What is shown upwards, with its unit.
    pub y_label: String,
    /// Drawn before anything else, in this order.
    pub bands: Vec<Band>,
    /// Drawn in this order, over the discs.
    pub lines: Vec<Line>,
    /// Drawn over the lines.
    pub dots: Vec<Dot>,
    /// Drawn below the lines.
    pub discs: Vec<Disc>,
    /// Drawn last.
    pub notes: Vec<Note>,
    /// A part of the plot, enlarged.
    pub inset: Option<Inset>,
    /// A unit has the same length across and upwards.
    pub equal_axes: bool,
    /// Both axes are logarithmic. What is not positive is not drawn, nor are discs and insets, which have a size.
    pub logarithmic: bool,
    /// Without frame, ticks and labels: a drawing.
    pub bare: bool,
}

impl Plot {
    /// The decimal logarithms of everything, NaN where there is none.
    pub(super) fn logarithms(&self) -> Self {
        let logarithm = |x: f64| if x > 0.0 { x.log10() } else { f64::NAN };
        let mut plot = Self {
            discs: Vec::new(),
            inset: None,
            equal_axes: false,
            ..self.clone()
        };
        for band in &mut plot.bands {
            for point in &mut band.points {
                *point = point.map(logarithm);
            }
        }
        for line in &mut plot.lines {
            for point in &mut line.points {
                *point = point.map(logarithm);
            }
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

/// Plots in rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// May be empty.
    pub title: String,
    /// Lines of text below the title.
    pub caption: Vec<String>,
    /// From left to right, then downwards.
    pub plots: Vec<Plot>,
    /// How many plots stand in a row, at least one.
    pub columns: usize,
}
