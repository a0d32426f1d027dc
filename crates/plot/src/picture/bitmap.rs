//! Encoding of pictures as PNG files.

use super::coverage::{Coverage, dashes, polygon};
use super::font::{self, CAPITALS};
use super::palette::{INK, Rgb, WHITE};
use super::size::MM;
use super::{Anchor, Pen, Picture, Primitive};
use png::{Compression, PixelDimensions, Unit};

/// The pixels of a picture, row by row.
fn draw(picture: &Picture) -> Vec<Rgb> {
    let size = picture.pixels();
    let mut bitmap = Bitmap {
        size,
        scale: picture.scale,
        pixels: vec![WHITE; size[0] * size[1]],
        coverage: Coverage::new(size),
    };
    for primitive in &picture.primitives {
        bitmap.draw(primitive);
    }
    bitmap.pixels
}

/// Encodes a picture as the bytes of a PNG file. Lines on white need no strong compression; cells of a heat map do.
pub fn file(picture: &Picture) -> Result<Vec<u8>, png::EncodingError> {
    let has_cells = |primitive: &Primitive| matches!(primitive, Primitive::Raster(..));
    let compression = match picture.primitives.iter().any(has_cells) {
        true => Compression::Balanced,
        false => Compression::Fastest,
    };
    let per_metre = (picture.scale / MM * 1e3).round() as u32;
    let density = picture.is_print.then_some(per_metre);
    encode(picture.pixels(), &draw(picture), compression, density)
}

/// Encodes the pixels of an image, row by row, as the bytes of a PNG file. The file has the number of pixels per metre if it is known.
pub fn encode(
    [width, height]: [usize; 2],
    pixels: &[Rgb],
    compression: Compression,
    per_metre: Option<u32>,
) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_pixel_dims(per_metre.map(|pixels| PixelDimensions {
        xppu: pixels,
        yppu: pixels,
        unit: Unit::Meter,
    }));
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(compression);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels.as_flattened())?;
    writer.finish()?;
    Ok(file)
}

struct Bitmap {
    size: [usize; 2],
    /// Pixels per unit of the picture.
    scale: f64,
    pixels: Vec<Rgb>,
    coverage: Coverage,
}

impl Bitmap {
    fn draw(&mut self, primitive: &Primitive) {
        match primitive {
            Primitive::Polyline(points, pen) if pen.dashed => {
                for dash in dashes(points) {
                    self.stroke(&dash, pen.width, pen.colour);
                }
            }
            Primitive::Polyline(points, pen) => self.stroke(points, pen.width, pen.colour),
            Primitive::Polygon(corners, fill) => {
                let corners: Vec<_> = corners.iter().map(|at| self.scaled(at)).collect();
                for ([x, y], part) in polygon(&corners, self.size) {
                    self.blend([x as i64, y as i64], *fill, part);
                }
            }
            Primitive::Circle(centre, radius, fill, outline) => {
                let ring = outline.unwrap_or(Pen::solid(0.0, *fill));
                self.stroke(&[*centre], 2.0 * radius + ring.width, ring.colour);
                self.stroke(&[*centre], 2.0 * radius - ring.width, *fill);
            }
            Primitive::Text(text, at, size, anchor) => self.text(text, *at, *size, *anchor),
            Primitive::Raster([left, top], [width, _], pixels) => {
                for (row, pixels) in pixels.chunks_exact(*width).enumerate() {
                    let start = (top + row) * self.size[0] + left;
                    self.pixels[start..start + width].copy_from_slice(pixels);
                }
            }
        }
    }

    /// Draws a polyline; a single point is a disc. Each pixel is inked once, so that short segments look like one long segment.
    fn stroke(&mut self, points: &[[f64; 2]], width: f64, ink: Rgb) {
        let points: Vec<_> = points.iter().map(|at| self.scaled(at)).collect();
        for ([x, y], part) in self.coverage.of(&points, 0.5 * width * self.scale) {
            mix(&mut self.pixels[y * self.size[0] + x], ink, part);
        }
    }

    /// Converts a point of the picture to pixels.
    fn scaled(&self, point: &[f64; 2]) -> [f64; 2] {
        point.map(|at| at * self.scale)
    }

    fn text(&mut self, text: &str, at: [f64; 2], size: f64, anchor: Anchor) {
        let [x, y] = at.map(|at| at * self.scale);
        let size = size * self.scale;
        let (width, descent) = (font::width(text, size), 0.5 * CAPITALS * size);
        let [x, y] = match anchor {
            Anchor::Left => [x, y + descent],
            Anchor::Centre => [x - 0.5 * width, y + descent],
            Anchor::Right => [x - width, y + descent],
            Anchor::Upwards => [x + descent, y + 0.5 * width],
        };
        let [x, y] = [x, y].map(|at| at.round() as i64);
        for glyph in font::outlines(text, size) {
            let corner = glyph.px_bounds().min;
            let (left, top) = (corner.x as i64, corner.y as i64);
            glyph.draw(|along, down, part| {
                let (along, down) = (left + i64::from(along), top + i64::from(down));
                let pixel = match anchor {
                    Anchor::Upwards => [x + down, y - along - 1],
                    _ => [x + along, y + down],
                };
                self.blend(pixel, INK, f64::from(part.min(1.0)));
            });
        }
    }

    /// Mixes a part of ink into a pixel if it lies inside the picture.
    fn blend(&mut self, [x, y]: [i64; 2], ink: Rgb, part: f64) {
        let [width, height] = self.size.map(|length| length as i64);
        if (0..width).contains(&x) && (0..height).contains(&y) {
            mix(&mut self.pixels[(y * width + x) as usize], ink, part);
        }
    }
}

/// Mixes a part of ink into a pixel.
fn mix(pixel: &mut Rgb, ink: Rgb, part: f64) {
    for (channel, ink) in pixel.iter_mut().zip(ink) {
        let mixed = f64::from(*channel) * (1.0 - part) + f64::from(ink) * part;
        *channel = (mixed + 0.5) as u8;
    }
}
