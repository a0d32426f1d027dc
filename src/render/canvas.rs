//! A bitmap with text and lines, drawn at twice its size and averaged.

use super::Error;
use super::brush::Cover;
use super::palette::{Fill, INK, Rgb, WHITE};
use crate::store::Output;
use plotters::backend::BitMapBackend;
use plotters::prelude::{DrawingBackend, FontStyle, FontTransform, IntoFont, TextStyle};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{RGBColor, register_font};
use std::path::Path;

/// Drawn pixels per pixel of the picture, in each direction.
const SCALE: usize = 2;

/// An em of DejaVu Sans in font sizes: here a size is the height from ascent to descent, 1.164 ems.
pub(super) const EM: f64 = 1.0 / 1.164;
/// The height of its capitals in font sizes, 0.729 ems.
pub(super) const CAPITALS: f64 = 0.626;

/// The colour of text.
const PEN: RGBColor = RGBColor(INK[0], INK[1], INK[2]);

/// A rectangle of the picture, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Area {
    pub(super) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// The point at fractions `x` from the left and `y` from the bottom.
    pub(super) fn point(&self, x: f64, y: f64) -> [f64; 2] {
        [self.left + x * self.width, self.bottom() - y * self.height]
    }
}

/// Where a text stands relative to its point; its capitals are centred on the point across the line of writing.
#[derive(Clone, Copy, Debug)]
pub(super) enum Anchor {
    Left,
    Centre,
    Right,
    /// Centred, running upwards.
    Upwards,
}

/// A picture in the making.
#[derive(Debug)]
pub(super) struct Canvas {
    width: usize,
    height: usize,
    /// Rows of red, green, blue, [`SCALE`] times as wide and as high as the picture.
    pixels: Vec<u8>,
}

impl Canvas {
    /// An empty white picture.
    pub(super) fn new(width: f64, height: f64) -> Self {
        let [width, height] = [width, height].map(|length| length.ceil() as usize);
        let pixels = vec![WHITE[0]; 3 * width * height * SCALE * SCALE];
        Self {
            width,
            height,
            pixels,
        }
    }

    /// Fills an area; `fill` is asked for each drawn pixel, by its fractions from the left and the bottom.
    pub(super) fn paint(&mut self, area: Area, fill: impl Fn(f64, f64) -> Fill) {
        let edge = |at: f64| (at * SCALE as f64).round().max(0.0) as usize;
        let (left, top) = (edge(area.left), edge(area.top));
        let right = edge(area.right()).min(self.width * SCALE);
        let bottom = edge(area.bottom()).min(self.height * SCALE);
        for y in top..bottom {
            for x in left..right {
                let across = (x - left) as f64 + 0.5;
                let up = (bottom - y) as f64 - 0.5;
                let fill = fill(across / (right - left) as f64, up / (bottom - top) as f64);
                *self.pixel(x, y) = fill.at(x, y);
            }
        }
    }

    /// A straight line with round ends.
    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], width: f64, ink: Rgb, alpha: f64) {
        self.stroke(&[from, to], width, ink, alpha);
    }

    /// A polyline with round ends and corners; a single point is a disc. No pixel is inked twice, so that many short
    /// segments look like one long one.
    pub(super) fn stroke(&mut self, points: &[[f64; 2]], width: f64, ink: Rgb, alpha: f64) {
        let scale = SCALE as f64;
        let points: Vec<_> = points
            .iter()
            .map(|point| point.map(|at| at * scale))
            .collect();
        let limit = [self.width * SCALE, self.height * SCALE];
        let cover = Cover::new(&points, width * scale / 2.0, limit);
        for (x, y, part) in cover.pixels() {
            let part = part * alpha;
            for (channel, ink) in self.pixel(x, y).iter_mut().zip(ink) {
                let mixed = f64::from(*channel) * (1.0 - part) + f64::from(ink) * part;
                *channel = mixed.round() as u8;
            }
        }
    }

    /// The outline of an area.
    pub(super) fn frame(&mut self, area: Area, width: f64) {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)];
        for pair in corners.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|(x, y)| area.point(x, y));
            self.line(from, to, width, INK, 1.0);
        }
    }

    /// Writes `text` at `at`.
    pub(super) fn text(
        &mut self,
        text: &str,
        at: [f64; 2],
        size: f64,
        anchor: Anchor,
    ) -> Result<(), Error> {
        let size = size * SCALE as f64;
        let [x, y] = at.map(|at| at * SCALE as f64);
        // plotters puts the baseline half a font size below the top.
        let centring = size * (CAPITALS / 2.0 - 0.5);
        let (horizontal, turn, x, y) = match anchor {
            Anchor::Left => (HPos::Left, FontTransform::None, x, y + centring),
            Anchor::Centre => (HPos::Center, FontTransform::None, x, y + centring),
            Anchor::Right => (HPos::Right, FontTransform::None, x, y + centring),
            Anchor::Upwards => (HPos::Center, FontTransform::Rotate270, x + centring, y),
        };
        let style = style(text, size, horizontal, turn)?;
        let size = (self.width * SCALE, self.height * SCALE);
        BitMapBackend::with_buffer(&mut self.pixels, (size.0 as u32, size.1 as u32))
            .draw_text(text, &style, (x.round() as i32, y.round() as i32))
            .map_err(|cause| unwritten(text, cause))
    }

    /// Encodes the picture into the file `out`.
    pub(super) fn save(&self, out: &Path) -> Result<(), Error> {
        whole(out, |file| {
            let mut encoder = png::Encoder::new(file, self.width as u32, self.height as u32);
            encoder.set_color(png::ColorType::Rgb);
            encoder.set_compression(png::Compression::Fast);
            encoder.set_adaptive_filter(png::AdaptiveFilterType::Adaptive);
            let mut writer = encoder.write_header()?;
            writer.write_image_data(&self.averaged())?;
            Ok(writer.finish()?)
        })
    }

    fn pixel(&mut self, x: usize, y: usize) -> &mut [u8; 3] {
        let place = y * self.width * SCALE + x;
        &mut self.pixels.as_chunks_mut().0[place]
    }

    /// The picture in its own size.
    fn averaged(&self) -> Vec<u8> {
        let line = 3 * self.width * SCALE;
        let sample = |x: usize, y: usize, channel: usize| -> u8 {
            let corner = y * SCALE * line + 3 * x * SCALE + channel;
            let block = (0..SCALE * SCALE).map(|i| corner + i / SCALE * line + 3 * (i % SCALE));
            let sum: usize = block.map(|place| usize::from(self.pixels[place])).sum();
            ((sum + SCALE * SCALE / 2) / (SCALE * SCALE)) as u8
        };
        let places = 0..3 * self.width * self.height;
        places
            .map(|i| sample(i / 3 % self.width, i / 3 / self.width, i % 3))
            .collect()
    }
}

/// Has `write` fill the file `out`, whole or not at all.
pub(super) fn whole(
    out: &Path,
    write: impl FnOnce(&mut Output) -> std::io::Result<()>,
) -> Result<(), Error> {
    let written = Output::create(out).and_then(|mut output| {
        write(&mut output)?;
        output.finish()
    });
    written.map_err(|cause| Error::Write {
        path: out.to_owned(),
        cause,
    })
}

/// How far a text of this size reaches along its line.
pub(super) fn text_width(text: &str, size: f64) -> Result<f64, Error> {
    let style = style(text, size, HPos::Left, FontTransform::None)?;
    let box_of = style.font.box_size(text);
    box_of
        .map(|(width, _)| f64::from(width))
        .map_err(|cause| unwritten(text, cause))
}

fn style<'a>(
    text: &str,
    size: f64,
    horizontal: HPos,
    turn: FontTransform,
) -> Result<TextStyle<'a>, Error> {
    // Registering again replaces the font by itself.
    register_font(
        "sans-serif",
        FontStyle::Normal,
        include_bytes!("font/DejaVuSans.ttf"),
    )
    .map_err(|_| unwritten(text, "the built-in font is unreadable"))?;
    let style = TextStyle::from(("sans-serif", size).into_font().transform(turn));
    Ok(style.color(&PEN).pos(Pos::new(horizontal, VPos::Top)))
}

fn unwritten(text: &str, cause: impl ToString) -> Error {
    Error::Font {
        text: text.to_owned(),
        cause: cause.to_string(),
    }
}
