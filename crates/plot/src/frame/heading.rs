//! The heading above a plot or a heat map: letter, title and legend.

use super::spacing::Spacing;
use crate::picture::font;
use crate::picture::palette::{Fill, INK, Rgb, WHITE};
use crate::picture::text::{FittedText, SMALLEST, TextBlock, fitted};
use crate::picture::{Anchor, Area, Pen, Picture};

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

/// Width of the lines of charts, in pixels.
pub const LINE: f64 = 3.0;
/// Radius of the dots of charts, in pixels.
pub const DOT: f64 = 8.0;
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
    const fn width(self, spacing: &Spacing) -> f64 {
        match self {
            Self::Swatch(_) => spacing.swatch,
            Self::Line(_) => spacing.symbol,
            Self::Dot(_) | Self::Ring(_) => 2.0 * DOT,
        }
    }

    /// Draws the symbol of this width to the right of a point.
    fn draw(self, picture: &mut Picture, [x, y]: [f64; 2], width: f64) {
        match self {
            Self::Swatch(fill) => {
                let swatch = Area::new([x, y - 11.0], [width, 22.0]);
                picture.raster(swatch, |_, _| fill);
                picture.frame(swatch, 1.0);
            }
            Self::Line(pen) => picture.polyline(&[[x, y], [x + width, y]], pen),
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
    /// Distance of the title from the left end of the body, to the left.
    before_title: f64,
    /// Distance of the legend from the left end of the body, to the left.
    before: f64,
    /// Each entry with its line and its offset along the line.
    entries: Vec<(LegendEntry, usize, f64)>,
    /// Height of letter and title.
    head: f64,
    spacing: Spacing,
    /// Height of the heading including the space below it, in pixels.
    pub height: f64,
}

impl Heading {
    /// Lays the heading out above a body with `[left, width, right]`: its width and the space beside it. Letter and title may be empty.
    pub fn plan(
        [letter, title]: [&str; 2],
        legend: Vec<LegendEntry>,
        body: [f64; 3],
        spacing: Spacing,
    ) -> Self {
        let [before, room] = spacing.head_span(body);
        let mut entries = Vec::new();
        let (mut lines, mut end) = (0, f64::INFINITY);
        for LegendEntry { symbol, name } in legend {
            let to_name = symbol.width(&spacing) + spacing.gap;
            let (name, _) = fitted(&name, NAME, room - to_name);
            let reach = to_name + font::width(&name, NAME);
            if end + reach > room {
                (lines, end) = (lines + 1, 0.0);
            }
            entries.push((LegendEntry { symbol, name }, lines - 1, end));
            end += reach + spacing.next;
        }
        // A letter is to the left of the title.
        let before_title = if letter.is_empty() { before } else { 0.0 };
        let bare = letter.is_empty() && title.is_empty();
        let title = TextBlock::new(title, LABEL, room - before + before_title);
        let head = if bare { 0.0 } else { spacing.head + title.below_first() };
        Self {
            letter: fitted(letter, TITLE, body[0] - 2.0 * LETTER),
            title,
            before_title,
            before,
            entries,
            head,
            height: head + spacing.legend_line * lines as f64 + spacing.below_legend,
            spacing,
        }
    }

    /// Draws the heading from `top` downwards, above a body that begins at `body_left` with `left` pixels of space to its left.
    pub fn draw(&self, picture: &mut Picture, [body_left, top]: [f64; 2], left: f64) {
        let spacing = &self.spacing;
        let middle = top + 0.5 * spacing.head;
        let beside = body_left - left + LETTER;
        picture.fitted(&self.letter, [beside, middle], Anchor::Left);
        let title = [body_left - self.before_title, middle];
        picture.block(&self.title, title, Anchor::Left);
        let first = middle + self.head;
        for (LegendEntry { symbol, name }, line, offset) in &self.entries {
            let x = body_left - self.before + offset;
            let y = first + spacing.legend_line * *line as f64;
            let width = symbol.width(spacing);
            symbol.draw(picture, [x, y], width);
            let name_left = x + width + spacing.gap;
            picture.text(name, [name_left, y], NAME, Anchor::Left);
        }
    }
}
