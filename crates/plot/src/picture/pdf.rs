//! Encoding of pictures as PDF documents of one page. Text is drawn as outlines of the built-in font, so that it looks the same
//! everywhere; rasters are images.

use super::font::{self, CAPITALS};
use super::palette::{INK, Rgb, WHITE};
use super::size::POINTS;
use super::{Anchor, DASHES, Pen, Picture, Primitive};
use ab_glyph::{OutlineCurve, Point, point};
use miniz_oxide::deflate::compress_to_vec_zlib;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Filter, Name, Pdf, Rect, Ref};

/// Level of compression, from 0 to 10.
const LEVEL: u8 = 6;
/// Distance of the handles of a quarter of a circle from its ends, in radii.
const QUARTER: f64 = 0.552_284_75;

/// Returns the bytes of a PDF document that shows the picture; equal pictures give equal bytes.
pub fn document(picture: &Picture) -> Vec<u8> {
    let [catalog, pages, page, contents] = [1, 2, 3, 4].map(Ref::new);
    let [width, height] = picture.size.map(|length| (length * POINTS) as f32);
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(pages);
    pdf.pages(pages).kids([page]).count(1);
    let mut content = Content::new();
    fill(&mut content, WHITE);
    content.rect(0.0, 0.0, width, height).fill_nonzero();
    // Units of the picture, y downwards.
    content.transform([POINTS as f32, 0.0, 0.0, -(POINTS as f32), 0.0, height]);
    content.set_line_cap(LineCapStyle::RoundCap);
    content.set_line_join(LineJoinStyle::RoundJoin);
    let mut images = Vec::new();
    for primitive in &picture.primitives {
        if let Primitive::Raster(corner, size, pixels) = primitive {
            let name = format!("R{}", images.len());
            place_image(&mut content, picture, (*corner, *size), &name);
            images.push((name, Ref::new(5 + images.len() as i32), *size, pixels));
        } else {
            draw(&mut content, primitive);
        }
    }
    let mut written = pdf.page(page);
    written.parent(pages).contents(contents);
    written.media_box(Rect::new(0.0, 0.0, width, height));
    let mut resources = written.resources();
    let mut names = resources.x_objects();
    for (name, id, ..) in &images {
        names.pair(Name(name.as_bytes()), *id);
    }
    drop(names);
    drop(resources);
    drop(written);
    let packed = compress_to_vec_zlib(&content.finish(), LEVEL);
    pdf.stream(contents, &packed).filter(Filter::FlateDecode);
    for (_, id, [width, height], pixels) in images {
        let packed = compress_to_vec_zlib(pixels.as_flattened(), LEVEL);
        let mut image = pdf.image_xobject(id, &packed);
        image.filter(Filter::FlateDecode);
        image.width(width as i32).height(height as i32);
        image.color_space().device_rgb();
        image.bits_per_component(8);
    }
    pdf.finish()
}

fn draw(content: &mut Content, primitive: &Primitive) {
    match primitive {
        Primitive::Polyline(points, pen) => {
            set_pen(content, *pen);
            path(content, points);
            content.stroke();
        }
        Primitive::Polygon(corners, colour) => {
            fill(content, *colour);
            path(content, corners);
            content.close_path().fill_even_odd();
        }
        Primitive::Circle(centre, radius, colour, outline) => {
            fill(content, *colour);
            circle(content, *centre, *radius);
            match outline {
                Some(pen) => {
                    set_pen(content, *pen);
                    content.fill_nonzero_and_stroke();
                }
                None => {
                    content.fill_nonzero();
                }
            }
        }
        Primitive::Text(text, at, size, anchor) => words(content, text, *at, *size, *anchor),
        Primitive::Raster(..) => {}
    }
}

/// Places an image, whose first row is its upper one, at its pixels.
fn place_image(
    content: &mut Content,
    picture: &Picture,
    (corner, size): ([usize; 2], [usize; 2]),
    name: &str,
) {
    let units = |pixels: usize| (pixels as f64 / picture.scale) as f32;
    let ([x, y], [width, height]) = (corner.map(units), size.map(units));
    content.save_state();
    content.transform([width, 0.0, 0.0, -height, x, y + height]);
    content.x_object(Name(name.as_bytes()));
    content.restore_state();
}

fn words(content: &mut Content, text: &str, [x, y]: [f64; 2], size: f64, anchor: Anchor) {
    let (width, descent) = (font::width(text, size), 0.5 * CAPITALS * size);
    let start = match anchor {
        Anchor::Left => 0.0,
        Anchor::Centre | Anchor::Upwards => -0.5 * width,
        Anchor::Right => -width,
    };
    // The axis along the text and the axis down from it.
    let (along, down) = match anchor {
        Anchor::Upwards => ([0.0, -1.0], [1.0, 0.0]),
        _ => ([1.0, 0.0], [0.0, 1.0]),
    };
    fill(content, INK);
    for glyph in font::curves(text, size) {
        let place = |point: Point| {
            let right = start + glyph.at[0] + glyph.unit * f64::from(point.x);
            let below = descent + glyph.at[1] - glyph.unit * f64::from(point.y);
            let place = |axis: usize| right * along[axis] + below * down[axis];
            [(x + place(0)) as f32, (y + place(1)) as f32]
        };
        outline(content, &glyph.outline.curves, place);
        content.fill_nonzero();
    }
}

/// Appends the closed curves of a glyph to the path.
fn outline(content: &mut Content, curves: &[OutlineCurve], place: impl Fn(Point) -> [f32; 2]) {
    let mut end = None;
    for curve in curves {
        let (first, handles, last) = match *curve {
            OutlineCurve::Line(from, to) => (from, None, to),
            OutlineCurve::Quad(from, handle, to) => {
                let part = |end: f32, handle: f32| end + (handle - end) * (2.0 / 3.0);
                let toward = |end: Point| point(part(end.x, handle.x), part(end.y, handle.y));
                (from, Some([toward(from), toward(to)]), to)
            }
            OutlineCurve::Cubic(from, one, other, to) => (from, Some([one, other]), to),
        };
        if end != Some(first) {
            let [x, y] = place(first);
            content.move_to(x, y);
        }
        let [x, y] = place(last);
        match handles.map(|handles| handles.map(&place)) {
            Some([one, other]) => content.cubic_to(one[0], one[1], other[0], other[1], x, y),
            None => content.line_to(x, y),
        };
        end = Some(last);
    }
}

/// Appends a polyline to the path; a single point becomes a line of length 0, which has round ends.
fn path(content: &mut Content, points: &[[f64; 2]]) {
    for (i, at) in points.iter().enumerate() {
        let [x, y] = at.map(|at| at as f32);
        if i == 0 {
            content.move_to(x, y);
        }
        if i > 0 || points.len() == 1 {
            content.line_to(x, y);
        }
    }
}

fn circle(content: &mut Content, centre: [f64; 2], radius: f64) {
    let at = |x: f64, y: f64| [x, y].map(|part| part * radius);
    let point = |[x, y]: [f64; 2]| [(centre[0] + x) as f32, (centre[1] + y) as f32];
    let [x, y] = point(at(1.0, 0.0));
    content.move_to(x, y);
    for [x, y] in [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]] {
        // From (x, y) by a quarter to (-y, x).
        let one = point(at(x - QUARTER * y, y + QUARTER * x));
        let other = point(at(QUARTER.mul_add(x, -y), QUARTER.mul_add(y, x)));
        let end = point(at(-y, x));
        content.cubic_to(one[0], one[1], other[0], other[1], end[0], end[1]);
    }
    content.close_path();
}

fn set_pen(content: &mut Content, pen: Pen) {
    let [red, green, blue] = parts(pen.colour);
    content.set_stroke_rgb(red, green, blue);
    content.set_line_width(pen.width as f32);
    let dashes = DASHES.map(|length| length as f32);
    content.set_dash_pattern(if pen.dashed { &dashes[..] } else { &[] }.iter().copied(), 0.0);
}

fn fill(content: &mut Content, colour: Rgb) {
    let [red, green, blue] = parts(colour);
    content.set_fill_rgb(red, green, blue);
}

/// Red, green and blue from 0 to 1.
fn parts(colour: Rgb) -> [f32; 3] {
    colour.map(|part| f32::from(part) / 255.0)
}
