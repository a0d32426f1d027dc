//! Charts: curves over axes that fit them, one plot or several, as PNG or SVG.
//!
//! A chart is plain data. One drawing code gives both formats: [`sheet`] decides where everything goes, [`plot`] draws
//! it on a [`surface::Surface`].
//!
//! Invariant: every finite point of the data lies inside the frame of its plot; nothing is clipped.

mod dashes;
mod heading;
mod plot;
mod sheet;
mod surface;
mod svg;
mod ticks;
mod window;

use super::Error;
use super::canvas::{Canvas, whole};
use sheet::Sheet;
use std::io::Write;
use std::path::Path;
use svg::Svg;

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
    /// Across and up, in data units. A point that is not finite, or beyond 1e300, breaks the line.
    pub points: Vec<[f64; 2]>,
    /// Its colour.
    pub ink: Ink,
    /// Solid or dashed.
    pub stroke: Stroke,
    /// Its name in the legend, where equal names stand once; without one it is not in the legend.
    pub name: Option<String>,
}

/// A point that stands out, such as a fold.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dot {
    /// Across and up, in data units; not drawn unless finite.
    pub at: [f64; 2],
    /// Its colour.
    pub ink: Ink,
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
    /// Drawn in this order, over the discs.
    pub lines: Vec<Line>,
    /// Drawn over the lines.
    pub dots: Vec<Dot>,
    /// Drawn first.
    pub discs: Vec<Disc>,
    /// A unit has the same length across and upwards.
    pub equal_axes: bool,
}

/// Plots in rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// May be empty.
    pub title: String,
    /// From left to right, then downwards.
    pub plots: Vec<Plot>,
    /// How many plots stand in a row, at least one.
    pub columns: usize,
}

/// What a chart is saved as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChartFormat {
    /// Pixels.
    Png,
    /// SVG 1.1.
    Svg,
}

impl ChartFormat {
    /// The format that the ending of a file's name stands for, in capitals or not.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "png" => Some(Self::Png),
            "svg" => Some(Self::Svg),
            _ => None,
        }
    }
}

impl Chart {
    /// Draws the chart into a file, which appears whole or not at all.
    ///
    /// # Errors
    ///
    /// The file cannot be written, or the built-in font cannot draw a text.
    pub fn save(&self, out: &Path, format: ChartFormat) -> Result<(), Error> {
        match format {
            ChartFormat::Png => {
                let sheet = Sheet::plan(self)?;
                let mut canvas = Canvas::new(sheet.size[0], sheet.size[1]);
                sheet.draw(&mut canvas)?;
                canvas.save(out)
            }
            ChartFormat::Svg => {
                let svg = self.svg()?;
                whole(out, |file| file.write_all(svg.as_bytes()))
            }
        }
    }

    /// The chart as an SVG document; equal charts give equal documents.
    ///
    /// # Errors
    ///
    /// The built-in font cannot measure a text.
    pub fn svg(&self) -> Result<String, Error> {
        let sheet = Sheet::plan(self)?;
        let mut svg = Svg::new(sheet.size);
        sheet.draw(&mut svg)?;
        Ok(svg.finish())
    }
}
