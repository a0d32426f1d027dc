//! Title, legend and colour bar.

use super::Error;
use super::axis;
use super::canvas::{Anchor, Area, Canvas, text_width};
use super::palette::{Fill, INK};
use super::shading::{Scale, Shading};

/// Font sizes.
pub(super) const TITLE: f64 = 36.0;
pub(super) const LABEL: f64 = 27.0;
pub(super) const TICK: f64 = 23.0;
pub(super) const NAME: f64 = 21.0;

/// From one line of the legend to the next.
pub(super) const LINE: f64 = 38.0;
/// Width of a swatch, and from one swatch's text to the next swatch.
const SWATCH: f64 = 36.0;
const GAP: f64 = 26.0;

/// What stands before a name.
enum Mark {
    Swatch(Fill),
    Line,
}

/// Title and legend, laid out for a width.
pub(super) struct Heading {
    title: String,
    title_size: f64,
    /// Line of the legend, offset along it, mark and name.
    entries: Vec<(usize, f64, Mark, String)>,
    /// Height of it all, with the room below.
    pub(super) height: f64,
}

impl Heading {
    /// Decides where everything goes.
    pub(super) fn plan(title: &str, shading: &Shading, width: f64) -> Result<Self, Error> {
        let mut marks: Vec<(Mark, String)> = match shading {
            Shading::Names(names) => {
                let present = names.present.iter();
                present
                    .map(|(name, fill)| (Mark::Swatch(*fill), name.clone()))
                    .collect()
            }
            Shading::Scale(scale) if scale.blanks => {
                vec![(Mark::Swatch(Fill::BLANK), "no contact".to_owned())]
            }
            Shading::Scale(_) => Vec::new(),
        };
        if let Shading::Names(names) = shading
            && names.boundary
        {
            marks.push((Mark::Line, "detachment boundary".to_owned()));
        }
        let mut widths = Vec::new();
        for (_, name) in &marks {
            widths.push(SWATCH + 12.0 + text_width(name, NAME)?);
        }
        let (places, lines) = flow(&widths, width);
        let entries = places
            .into_iter()
            .zip(marks)
            .map(|((line, offset), (mark, name))| (line, offset, mark, name))
            .collect();
        let (title, title_size) = fitted(title, TITLE, width)?;
        Ok(Self {
            title,
            title_size,
            entries,
            height: 92.0 + LINE * lines as f64,
        })
    }

    /// Draws it with its left end at `left` and its top at the top of the picture.
    pub(super) fn draw(&self, canvas: &mut Canvas, left: f64) -> Result<(), Error> {
        canvas.text(&self.title, [left, 46.0], self.title_size, Anchor::Left)?;
        for (line, offset, mark, name) in &self.entries {
            let (x, y) = (left + offset, 98.0 + LINE * *line as f64);
            match mark {
                Mark::Swatch(fill) => {
                    let swatch = Area {
                        left: x,
                        top: y - 11.0,
                        width: SWATCH,
                        height: 22.0,
                    };
                    canvas.paint(swatch, |_, _| *fill);
                    canvas.frame(swatch, 1.0);
                }
                Mark::Line => canvas.line([x, y], [x + SWATCH, y], 3.0, INK, 1.0),
            }
            canvas.text(name, [x + SWATCH + 12.0, y], NAME, Anchor::Left)?;
        }
        Ok(())
    }
}

/// Line and offset of things of these widths, one after the other, and the number of lines.
pub(super) fn flow(widths: &[f64], room: f64) -> (Vec<(usize, f64)>, usize) {
    let mut places = Vec::new();
    let (mut line, mut offset) = (0, 0.0);
    for width in widths {
        if offset > 0.0 && offset + width > room {
            (line, offset) = (line + 1, 0.0);
        }
        places.push((line, offset));
        offset += width + GAP;
    }
    (places, if widths.is_empty() { 0 } else { line + 1 })
}

/// A text in the largest size that fits, at most `largest`, cut if even the smallest one does not.
pub(super) fn fitted(text: &str, largest: f64, width: f64) -> Result<(String, f64), Error> {
    let size = largest * (width / text_width(text, largest)?.max(1.0)).clamp(0.6, 1.0);
    let mut shown = text.to_owned();
    while text_width(&shown, size)? > width + 1.0 {
        let kept = shown.chars().count().saturating_sub(2);
        shown = shown.chars().take(kept).chain(['\u{2026}']).collect();
    }
    Ok((shown, size))
}

/// Room that [`bar`] takes to the right of the picture's body.
pub(super) const BAR_ROOM: f64 = 190.0;

/// The colour bar to the right of `body`.
pub(super) fn bar(canvas: &mut Canvas, body: Area, scale: &Scale) -> Result<(), Error> {
    let Some([low, high]) = scale.range else {
        return Ok(());
    };
    let height = body.height.min(900.0);
    let bar = Area {
        left: body.right() + 36.0,
        top: body.top + 0.5 * (body.height - height),
        width: 30.0,
        height,
    };
    canvas.paint(bar, |_, up| scale.fill(low + up * (high - low)));
    canvas.frame(bar, 1.5);
    let ticks = scale.ticks((height / 60.0).clamp(4.0, 8.0));
    for (tick, label) in ticks.iter().zip(axis::labels(&ticks)) {
        let [_, y] = bar.point(0.0, (tick - low) / (high - low));
        canvas.line([bar.right(), y], [bar.right() + 7.0, y], 1.5, INK, 1.0);
        canvas.text(&label, [bar.right() + 13.0, y], TICK, Anchor::Left)?;
    }
    let middle = [body.right() + BAR_ROOM - 24.0, bar.top + 0.5 * bar.height];
    canvas.text(&scale.label, middle, LABEL, Anchor::Upwards)
}
