//! Distances around the body of a picture: generous on a screen, tight on paper, where text is large beside the picture.

use crate::picture::DASHES;
use crate::picture::size::PictureSize;

/// Distances around a plot or a heat map, in units of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spacing {
    /// Height of the space for a picture's title of one line, in units of the picture.
    pub head_room: f64,
    /// Distance of the title's middle from the top of a picture, in the picture's units.
    pub title_line: f64,
    /// Height of letter and title of a plot, of one line, in units of the picture.
    pub head: f64,
    /// Distance between neighbouring lines of the legend, in units of the picture.
    pub legend_line: f64,
    /// Height of the space below the legend, in units of the picture.
    pub below_legend: f64,
    /// Length of the line that is the symbol of lines in a legend, in units of the picture.
    pub symbol: f64,
    /// Width of the swatch that is the symbol of areas in a legend, in units of the picture.
    pub swatch: f64,
    /// Space between a symbol of the legend and its name, in units of the picture.
    pub gap: f64,
    /// Space between a name in the legend and the next symbol, in units of the picture.
    pub next: f64,
    /// Height of the space below a body for ticks and an axis label of one line, in units of the picture.
    pub below: f64,
    /// Distance of the middle of the horizontal axis' label from the frame, in units of the picture.
    pub x_label: f64,
    /// Distance of the middle of the vertical axis' label from the left end of the space beside the body, in units of the picture.
    pub y_label: f64,
    /// Distance of title and legend from the picture's left and right edge, in its units; `None` if they are as wide as the body.
    pub edge: Option<f64>,
}

impl Spacing {
    /// Distances around a plot or a heat map on a screen.
    pub const SCREEN: Self = Self {
        head_room: 74.0,
        title_line: 46.0,
        head: 46.0,
        legend_line: 38.0,
        below_legend: 18.0,
        symbol: 3.0 * DASHES[0] + 2.0 * DASHES[1],
        swatch: 36.0,
        gap: 12.0,
        next: 26.0,
        below: 112.0,
        x_label: 76.0,
        y_label: 34.0,
        edge: None,
    };

    /// Distances on paper.
    const PAPER: Self = Self {
        head_room: 44.0,
        title_line: 24.0,
        head: 34.0,
        legend_line: 27.0,
        below_legend: 8.0,
        symbol: 2.0 * DASHES[0] + DASHES[1],
        swatch: 26.0,
        gap: 7.0,
        next: 16.0,
        below: 80.0,
        x_label: 60.0,
        y_label: 18.0,
        edge: Some(8.0),
    };

    /// Returns the distances around a plot or a heat map in a picture of this size.
    pub fn of(size: PictureSize) -> Self {
        match size {
            PictureSize::Print(_) => Self::PAPER,
            PictureSize::Natural | PictureSize::Width(_) => Self::SCREEN,
        }
    }

    /// Returns `[indent, width]` of title and legend: how far they begin to the left of a body, and their width. The body has this width, with `left`
    /// and `right` units of space beside it.
    pub fn head_span(&self, [left, width, right]: [f64; 3]) -> [f64; 2] {
        match self.edge {
            None => [0.0, width],
            Some(edge) => [left - edge, left + width + right - 2.0 * edge],
        }
    }
}
