//! Encoding of pictures as SVG documents with native lines, circles and text. Rasters are embedded as PNG.

use super::bitmap;
use super::font::{CAPITALS, runs};
use super::palette::{INK, Rgb, WHITE};
use super::size::MM;
use super::{Anchor, DASHES, EncodeError, Pen, Picture, Primitive};
use base64::prelude::{BASE64_STANDARD, Engine};
use png::Compression;

pub fn document(picture: &Picture) -> Result<String, EncodeError> {
    let [width, height] = match picture.is_print {
        true => picture.size.map(|length| number(length * MM) + "mm"),
        false => picture.pixels().map(|pixels| pixels.to_string()),
    };
    let ([across, down], white) = (picture.size.map(number), colour(WHITE));
    let mut document = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" version=\"1.1\" \
         width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {across} {down}\" xml:space=\"preserve\">\n\
         <rect width=\"{across}\" height=\"{down}\" fill=\"{white}\"/>\n"
    );
    for primitive in &picture.primitives {
        document += &match primitive {
            Primitive::Polyline(points, pen) => polyline(points, *pen),
            Primitive::Polygon(corners, fill) => {
                let (corners, fill) = (places(corners), colour(*fill));
                format!("<polygon points=\"{corners}\" fill=\"{fill}\"/>\n")
            }
            Primitive::Circle(centre, radius, fill, outline) => {
                let ([x, y], radius) = (centre.map(number), number(*radius));
                let (fill, outline) = (colour(*fill), outline.map(stroke).unwrap_or_default());
                format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"{fill}\"{outline}/>\n")
            }
            Primitive::Text(text, at, size, anchor) => words(text, *at, *size, *anchor),
            Primitive::Raster(corner, size, pixels) => {
                let units = |pixels: usize| number(pixels as f64 / picture.scale);
                let ([x, y], [width, height]) = (corner.map(units), size.map(units));
                let png = BASE64_STANDARD.encode(bitmap::encode(
                    *size,
                    pixels,
                    Compression::Balanced,
                    None,
                )?);
                format!(
                    "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" \
                     style=\"image-rendering:pixelated\" xlink:href=\"data:image/png;base64,{png}\"/>\n"
                )
            }
        };
    }
    Ok(document + "</svg>\n")
}

fn polyline(points: &[[f64; 2]], pen: Pen) -> String {
    let dashes = if pen.dashed {
        let [dash, gap] = DASHES.map(number);
        format!(" stroke-dasharray=\"{dash} {gap}\"")
    } else {
        String::new()
    };
    format!(
        "<polyline points=\"{}\" fill=\"none\"{} stroke-linecap=\"round\" stroke-linejoin=\"round\"{dashes}/>\n",
        places(points),
        stroke(pen),
    )
}

/// The value of the attribute `points`.
fn places(points: &[[f64; 2]]) -> String {
    let places = points.iter().map(|at| at.map(number).join(","));
    places.collect::<Vec<_>>().join(" ")
}

fn words(text: &str, at: [f64; 2], size: f64, anchor: Anchor) -> String {
    let [x, y] = at.map(number);
    let (side, turn) = match anchor {
        Anchor::Left => ("start", String::new()),
        Anchor::Centre => ("middle", String::new()),
        Anchor::Right => ("end", String::new()),
        Anchor::Upwards => ("middle", format!(" transform=\"rotate(-90 {x} {y})\"")),
    };
    let mut drop = 0.0;
    let spans = runs(text, size).into_iter().map(|run| {
        let words = escaped(run.text);
        let step = run.drop - std::mem::replace(&mut drop, run.drop);
        match (run.drop, step) {
            (0.0, 0.0) => words,
            (0.0, up) => format!("<tspan dy=\"{}\">{words}</tspan>", number(up)),
            (_, down) => format!(
                "<tspan font-size=\"{}\" dy=\"{}\">{words}</tspan>",
                number(run.size),
                number(down)
            ),
        }
    });
    let words: String = spans.collect();
    let (baseline, size) = (number(at[1] + 0.5 * CAPITALS * size), number(size));
    format!(
        "<text x=\"{x}\" y=\"{baseline}\" font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"{size}\" \
         text-anchor=\"{side}\" fill=\"{}\"{turn}>{words}</text>\n",
        colour(INK),
    )
}

/// The attributes of a stroke.
fn stroke(pen: Pen) -> String {
    let (colour, width) = (colour(pen.colour), number(pen.width));
    format!(" stroke=\"{colour}\" stroke-width=\"{width}\"")
}

fn colour([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Writes a number with at most two decimals.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0" } else { text }.to_owned()
}

/// Escapes a text; the two characters that XML does not allow become U+FFFD.
fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    let text = text.replace('>', "&gt;").replace('"', "&quot;");
    text.replace(['\u{fffe}', '\u{ffff}'], "\u{fffd}")
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_are_short() {
        let values = [1.0, -0.001, 100.0, -2.346, 0.5, 0.0];
        let texts = ["1", "0", "100", "-2.35", "0.5", "0"];
        assert_eq!(values.map(number), texts.map(str::to_owned));
    }
}
