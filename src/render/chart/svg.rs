//! An SVG document with native lines, circles and text.

use super::surface::{DASHES, Pen, Surface};
use crate::render::Error;
use crate::render::canvas::{Anchor, CAPITALS, EM};
use crate::render::palette::{INK, Rgb, WHITE};

/// A document in the making.
#[derive(Debug)]
pub(super) struct Svg {
    text: String,
}

impl Svg {
    /// An empty white document.
    pub(super) fn new(size: [f64; 2]) -> Self {
        let [width, height] = size.map(|length| number(length.ceil()));
        let white = colour(WHITE);
        Self {
            text: format!(
                "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
                 <svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" width=\"{width}\" height=\"{height}\" \
                 viewBox=\"0 0 {width} {height}\" xml:space=\"preserve\">\n\
                 <rect width=\"{width}\" height=\"{height}\" fill=\"{white}\"/>\n"
            ),
        }
    }

    /// The whole document.
    pub(super) fn finish(self) -> String {
        self.text + "</svg>\n"
    }
}

impl Surface for Svg {
    fn polyline(&mut self, points: &[[f64; 2]], pen: Pen) {
        let points: Vec<_> = points
            .iter()
            .map(|[x, y]| format!("{},{}", number(*x), number(*y)))
            .collect();
        let dashes = if pen.dashed {
            let [dash, gap] = DASHES.map(number);
            format!(" stroke-dasharray=\"{dash} {gap}\"")
        } else {
            String::new()
        };
        self.text += &format!(
            "<polyline points=\"{}\" fill=\"none\"{} stroke-linecap=\"round\" stroke-linejoin=\"round\"{dashes}/>\n",
            points.join(" "),
            stroke(pen),
        );
    }

    fn circle(&mut self, centre: [f64; 2], radius: f64, fill: Rgb, outline: Option<Pen>) {
        let ([x, y], radius) = (centre.map(number), number(radius));
        let (fill, outline) = (colour(fill), outline.map(stroke).unwrap_or_default());
        self.text +=
            &format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"{fill}\"{outline}/>\n");
    }

    fn text(&mut self, text: &str, at: [f64; 2], size: f64, anchor: Anchor) -> Result<(), Error> {
        let [x, y] = at.map(number);
        let (side, turn) = match anchor {
            Anchor::Left => ("start", String::new()),
            Anchor::Centre => ("middle", String::new()),
            Anchor::Right => ("end", String::new()),
            Anchor::Upwards => ("middle", format!(" transform=\"rotate(-90 {x} {y})\"")),
        };
        let (baseline, size) = (number(at[1] + 0.5 * CAPITALS * size), number(EM * size));
        self.text += &format!(
            "<text x=\"{x}\" y=\"{baseline}\" font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"{size}\" \
             text-anchor=\"{side}\" fill=\"{}\"{turn}>{}</text>\n",
            colour(INK),
            escaped(text),
        );
        Ok(())
    }
}

/// The attributes of a line.
fn stroke(pen: Pen) -> String {
    format!(
        " stroke=\"{}\" stroke-width=\"{}\"",
        colour(pen.colour),
        number(pen.width)
    )
}

fn colour([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// A number with at most two decimals.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0" } else { text }.to_owned()
}

/// A text between tags; characters that XML does not allow are replaced.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\t' | '\n' | '\r' => escaped.push(' '),
            '\0'..'\u{20}' | '\u{fffe}' | '\u{ffff}' => escaped.push('\u{fffd}'),
            _ => escaped.push(character),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (1.0, "1"),
            (-0.001, "0"),
            (100.0, "100"),
            (-2.346, "-2.35"),
            (0.5, "0.5"),
            (0.0, "0"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn texts_are_escaped() {
        assert_eq!(
            escaped("a<b & \"c\">\u{1}\n\u{2212}"),
            "a&lt;b &amp; &quot;c&quot;&gt;\u{fffd} \u{2212}"
        );
    }
}
