//! The heading above a plot or a heat map: letter, title and legend.

use crate::picture::font;
use crate::picture::palette::{Fill, INK, Rgb, WHITE};
use crate::picture::text::{FittedText, SMALLEST, TextBlock, fitted};
use crate::picture::{Anchor, Area, DASHES, Pen, Picture};

/// Font size of titles, in pixels.
pub const TITLE: f64 = 31.0;
/// Font size of axis labels, in pixels.
pub const LABEL: f64 = 23.0;
/// Font size of tick labels, in pixels.
pub const TICK: f64 = 20.0;
/// Font size of names in a legend, in pixels.
pub const NAME: f64 = SMALLEST;

/// Size `[width, height]` of the body of a single plot or heat map, in pixels.
pub const ALONE: [f64; 2] = [1280.0, 880.0];
/// Least space `[left, right]` beside the body of a single plot or heat map, in pixels.
pub const SIDES: [f64; 2] = [136.0, 48.0];
/// Height of the space for a picture's title of one line, in pixels.
pub const HEAD_ROOM: f64 = 74.0;
/// Distance of the title's middle from the top of a picture, in pixels.
pub const TITLE_LINE: f64 = 46.0;

/// Width of the lines of charts, in pixels.
pub const LINE: f64 = 3.0;
/// Radius of the dots of charts, in pixels.
pub const DOT: f64 = 8.0;
/// Height of letter and a title of one line.
const HEAD: f64 = 46.0;
/// Distance between lines of the legend, in pixels.
const LEGEND_LINE: f64 = 38.0;
/// Space below the legend, in pixels.
const BELOW: f64 = 18.0;
/// Space between a symbol and its name, in pixels.
const GAP: f64 = 12.0;
/// Space between a name and the next symbol, in pixels.
const NEXT: f64 = 26.0;
/// Distance of the letter from the left end of the plot's space, in pixels.
const LETTER: f64 = 18.0;

/// The symbol before a name in a legend, such as a line or a swatch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LegendSymbol {
    Swatch(Fill),
    Line(Pen),
    Dot(Rgb),
    /// An empty ring, the symbol of an open dot.
    Ring(Pen),
}

impl LegendSymbol {
    const fn width(self) -> f64 {
        match self {
            Self::Swatch(_) => 36.0,
            Self::Line(_) => 3.0 * DASHES[0] + 2.0 * DASHES[1],
            Self::Dot(_) | Self::Ring(_) => 2.0 * DOT,
        }
    }

    /// Draws the symbol to the right of a point.
    fn draw(self, picture: &mut Picture, [x, y]: [f64; 2]) {
        match self {
            Self::Swatch(fill) => {
                let swatch = Area::new([x, y - 11.0], [self.width(), 22.0]);
                picture.raster(swatch, |_, _| fill);
                picture.frame(swatch, 1.0);
            }
            Self::Line(pen) => picture.polyline(&[[x, y], [x + self.width(), y]], pen),
            Self::Dot(colour) => picture.circle([x + DOT, y], DOT, colour, None),
            Self::Ring(pen) => {
                picture.circle([x + DOT, y], DOT - 0.5 * pen.width, WHITE, Some(pen))
            }
        }
    }
}

/// An entry of a heat map's legend: a symbol and its name.
#[derive(Clone, Debug, PartialEq)]
pub struct LegendEntry {
    pub(crate) symbol: LegendSymbol,
    pub(crate) name: String,
}

impl LegendEntry {
    /// Creates a legend entry for cells with this fill.
    #[must_use]
    pub fn swatch(fill: Fill, name: impl Into<String>) -> Self {
        Self::new(LegendSymbol::Swatch(fill), name)
    }

    /// Creates a legend entry for the black curves of a heat map.
    #[must_use]
    pub fn curve(name: impl Into<String>) -> Self {
        Self::new(LegendSymbol::Line(Pen::solid(LINE, INK)), name)
    }

    pub(crate) fn new(symbol: LegendSymbol, name: impl Into<String>) -> Self {
        let name = name.into();
        Self { symbol, name }
    }
}

/// Letter, title and legend of a plot or a heat map, laid out for a width.
pub struct Heading {
    letter: FittedText,
    title: TextBlock,
    /// Each entry with its line and its offset along the line.
    entries: Vec<(LegendEntry, usize, f64)>,
    /// Height of letter and title.
    head: f64,
    /// Height of the heading including the space below it, in pixels.
    pub height: f64,
}

impl Heading {
    /// Lays the heading out above a body of this width with `left` pixels of space to its left. Letter and title may be empty.
    pub fn plan(
        [letter, title]: [&str; 2],
        legend: Vec<LegendEntry>,
        [left, width]: [f64; 2],
    ) -> Self {
        let mut entries = Vec::new();
        let (mut lines, mut end) = (0, f64::INFINITY);
        for LegendEntry { symbol, name } in legend {
            let before = symbol.width() + GAP;
            let (name, _) = fitted(&name, NAME, width - before);
            let reach = before + font::width(&name, NAME);
            if end + reach > width {
                (lines, end) = (lines + 1, 0.0);
            }
            entries.push((LegendEntry { symbol, name }, lines - 1, end));
            end += reach + NEXT;
        }
        let bare = letter.is_empty() && title.is_empty();
        let title = TextBlock::new(title, LABEL, width);
        let head = if bare {
            0.0
        } else {
            HEAD + title.below_first()
        };
        Self {
            letter: fitted(letter, TITLE, left - 2.0 * LETTER),
            title,
            entries,
            head,
            height: head + LEGEND_LINE * lines as f64 + BELOW,
        }
    }

    /// Draws the heading from `top` downwards, above a body that begins at `body_left` with `left` pixels of space to its left.
    pub fn draw(&self, picture: &mut Picture, [body_left, top]: [f64; 2], left: f64) {
        let middle = top + 0.5 * HEAD;
        let beside = body_left - left + LETTER;
        picture.fitted(&self.letter, [beside, middle], Anchor::Left);
        picture.block(&self.title, [body_left, middle], Anchor::Left);
        for (LegendEntry { symbol, name }, line, offset) in &self.entries {
            let x = body_left + offset;
            let y = middle + self.head + LEGEND_LINE * *line as f64;
            symbol.draw(picture, [x, y]);
            let name_left = x + symbol.width() + GAP;
            picture.text(name, [name_left, y], NAME, Anchor::Left);
        }
    }
}
