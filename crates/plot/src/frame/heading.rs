//! What stands above a plot or a heat map: letter, title and legend.

use crate::picture::font::{self, FittedText, fitted};
use crate::picture::palette::{Fill, INK, Rgb, WHITE};
use crate::picture::{Anchor, Area, DASHES, Pen, Picture};

/// Font sizes in pixels: of titles, labels, ticks and names in a legend.
pub const TITLE: f64 = 31.0;
pub const LABEL: f64 = 23.0;
pub const TICK: f64 = 20.0;
pub const NAME: f64 = 18.0;

/// Width and height of the body of a plot or a heat map that stands alone, in pixels. Then the least room to its left and right.
pub const ALONE: [f64; 2] = [1280.0, 880.0];
pub const SIDES: [f64; 2] = [136.0, 48.0];
/// Height of a picture's title, and the middle of its line, in pixels.
pub const HEAD_ROOM: f64 = 74.0;
pub const TITLE_LINE: f64 = 46.0;

/// Width of the lines of charts, and radius of their dots, in pixels.
pub const LINE: f64 = 3.0;
pub const DOT: f64 = 8.0;
/// Height of the line of letter and title.
const HEAD: f64 = 46.0;
/// From one line of the legend to the next.
const LEGEND_LINE: f64 = 38.0;
/// Room below the legend.
const BELOW: f64 = 18.0;
/// Between a symbol and its name, and from there to the next symbol.
const GAP: f64 = 12.0;
const NEXT: f64 = 26.0;
/// From the left end of the plot's room to the letter.
const LETTER: f64 = 18.0;

/// What stands before a name in the legend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LegendSymbol {
    Swatch(Fill),
    Line(Pen),
    Dot(Rgb),
    /// The rim of a dot.
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

/// A symbol and its name in the legend of a heat map.
#[derive(Clone, Debug, PartialEq)]
pub struct LegendEntry {
    pub(crate) symbol: LegendSymbol,
    pub(crate) name: String,
}

impl LegendEntry {
    /// An entry for cells with this fill.
    #[must_use]
    pub fn swatch(fill: Fill, name: impl Into<String>) -> Self {
        Self::new(LegendSymbol::Swatch(fill), name)
    }

    /// An entry for the black curves of a heat map.
    #[must_use]
    pub fn curve(name: impl Into<String>) -> Self {
        Self::new(LegendSymbol::Line(Pen::solid(LINE, INK)), name)
    }

    pub(crate) fn new(symbol: LegendSymbol, name: impl Into<String>) -> Self {
        let name = name.into();
        Self { symbol, name }
    }
}

/// Letter, title and legend, laid out for a width.
pub struct Heading {
    letter: FittedText,
    title: FittedText,
    /// Each entry with its line and its offset along the line.
    entries: Vec<(LegendEntry, usize, f64)>,
    /// Height of the line of letter and title.
    head: f64,
    /// Height of the heading with the room below, in pixels.
    pub height: f64,
}

impl Heading {
    /// Lays the heading out above a body of this width with `left` pixels of room beside it. Letter and title may be empty.
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
        let head = if bare { 0.0 } else { HEAD };
        Self {
            letter: fitted(letter, TITLE, left - 2.0 * LETTER),
            title: fitted(title, LABEL, width),
            entries,
            head,
            height: head + LEGEND_LINE * lines as f64 + BELOW,
        }
    }

    /// Draws the heading from `top` downwards, above a body that begins at `body_left` with `left` pixels of room beside it.
    pub fn draw(&self, picture: &mut Picture, [body_left, top]: [f64; 2], left: f64) {
        let middle = top + 0.5 * HEAD;
        let beside = body_left - left + LETTER;
        picture.fitted(&self.letter, [beside, middle], Anchor::Left);
        picture.fitted(&self.title, [body_left, middle], Anchor::Left);
        for (LegendEntry { symbol, name }, line, offset) in &self.entries {
            let x = body_left + offset;
            let y = middle + self.head + LEGEND_LINE * *line as f64;
            symbol.draw(picture, [x, y]);
            let name_left = x + symbol.width() + GAP;
            picture.text(name, [name_left, y], NAME, Anchor::Left);
        }
    }
}
