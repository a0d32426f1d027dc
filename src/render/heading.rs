//! What stands above a plot or a map: letter, title and legend.

use super::font::{self, Fitted, fitted};
use super::palette::{Fill, Rgb, WHITE};
use super::picture::{Anchor, Area, DASHES, Pen, Picture};

/// Sizes of text.
pub(super) const TITLE: f64 = 31.0;
pub(super) const LABEL: f64 = 23.0;
pub(super) const TICK: f64 = 20.0;
pub(super) const NAME: f64 = 18.0;

/// Size of the body of a plot or a map that stands alone, and the least room to the left and to the right of it.
pub(super) const ALONE: [f64; 2] = [1280.0, 880.0];
pub(super) const SIDES: [f64; 2] = [136.0, 48.0];
/// Height of a picture's title, and the middle of its line.
pub(super) const HEAD_ROOM: f64 = 74.0;
pub(super) const TITLE_LINE: f64 = 46.0;

/// Radius of a dot.
pub(super) const DOT: f64 = 8.0;
/// Height of the line of letter and title.
const HEAD: f64 = 46.0;
/// From one line of the legend to the next.
const LINE: f64 = 38.0;
/// Room below.
const BELOW: f64 = 18.0;
/// Between a sample and its name, and from there to the next sample.
const GAP: f64 = 12.0;
const NEXT: f64 = 26.0;
/// From the left end of the plot's room to the letter.
const LETTER: f64 = 18.0;

/// What stands before a name in the legend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sample {
    Swatch(Fill),
    Line(Pen),
    Dot(Rgb),
    /// The rim of a dot.
    Ring(Pen),
}

impl Sample {
    /// A swatch, three dashes, or a dot.
    const fn width(self) -> f64 {
        match self {
            Self::Swatch(_) => 36.0,
            Self::Line(_) => 3.0 * DASHES[0] + 2.0 * DASHES[1],
            Self::Dot(_) | Self::Ring(_) => 2.0 * DOT,
        }
    }

    /// Draws it to the right of a point.
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

/// Letter, title and legend, laid out for a width.
pub(super) struct Heading {
    letter: Fitted,
    title: Fitted,
    /// Sample and name, with their line and the offset along it.
    entries: Vec<(Sample, String, usize, f64)>,
    /// Of the line of letter and title.
    head: f64,
    /// Height of it all, with the room below.
    pub(super) height: f64,
}

impl Heading {
    /// Decides where everything goes above a body of this width with this much room to the left of it. Letter and
    /// title may be empty.
    pub(super) fn plan(
        [letter, title]: [&str; 2],
        samples: Vec<(Sample, String)>,
        [left, width]: [f64; 2],
    ) -> Self {
        let mut entries = Vec::new();
        let (mut lines, mut end) = (0, f64::INFINITY);
        for (sample, name) in samples {
            let before = sample.width() + GAP;
            let (name, _) = fitted(&name, NAME, width - before);
            let reach = before + font::width(&name, NAME);
            if end + reach > width {
                (lines, end) = (lines + 1, 0.0);
            }
            entries.push((sample, name, lines - 1, end));
            end += reach + NEXT;
        }
        let bare = letter.is_empty() && title.is_empty();
        let head = if bare { 0.0 } else { HEAD };
        Self {
            letter: fitted(letter, TITLE, left - 2.0 * LETTER),
            title: fitted(title, LABEL, width),
            entries,
            head,
            height: head + LINE * lines as f64 + BELOW,
        }
    }

    /// Draws it from `top` downwards, above a body that begins at `body_left`, with `left` pixels of room beside it.
    pub(super) fn draw(&self, picture: &mut Picture, [body_left, top]: [f64; 2], left: f64) {
        let middle = top + 0.5 * HEAD;
        let beside = body_left - left + LETTER;
        picture.fitted(&self.letter, [beside, middle], Anchor::Left);
        picture.fitted(&self.title, [body_left, middle], Anchor::Left);
        for (sample, name, line, offset) in &self.entries {
            let x = body_left + offset;
            let y = middle + self.head + LINE * *line as f64;
            sample.draw(picture, [x, y]);
            let name_left = x + sample.width() + GAP;
            picture.text(name, [name_left, y], NAME, Anchor::Left);
        }
    }
}
