//! Options `--size` and `--dpi`: the size of a picture on paper.

use super::arguments::whole;
use clap::Args;
use whiskmap::input::Quantity;
use whiskmap::render::{PictureSize, PrintSize};

/// Largest side of a PNG in pixels.
const MOST_PIXELS: f64 = 10_000.0;

#[derive(Debug, Args)]
pub struct SizeArgs {
    /// Set the width, or width and height, on paper, such as 85mm or 180x120mm; all text has at least 7 pt
    #[arg(long, value_name = "W[xH]", value_parser = sides)]
    size: Option<Sides>,
    /// Set the pixels per inch of a PNG, and of the cells of a map in every format
    #[arg(long, value_name = "DPI", default_value = "300", requires = "size", value_parser = whole(50..=2400))]
    dpi: u32,
}

/// Width and perhaps height in mm.
#[derive(Clone, Copy, Debug)]
struct Sides {
    width_mm: f64,
    height_mm: Option<f64>,
}

impl SizeArgs {
    /// Returns the size on paper, or the natural size; refuses more pixels than a PNG can have here.
    pub fn picture(&self) -> Result<PictureSize, String> {
        let Some(Sides { width_mm, height_mm }) = self.size else {
            return Ok(PictureSize::Natural);
        };
        let dpi = f64::from(self.dpi);
        let pixels = width_mm.max(height_mm.unwrap_or_default()) / 25.4 * dpi;
        if pixels > MOST_PIXELS {
            return Err(format!(
                "--dpi {dpi}: gives {pixels:.0} pixels along the longer side; must give at most {MOST_PIXELS}"
            ));
        }
        Ok(PictureSize::Print(PrintSize { width_mm, height_mm, dpi }))
    }
}

/// Parses `85mm`, `85x60mm` or `8.5cmx6cm`. A side without a unit has the unit of the other one, or mm.
fn sides(text: &str) -> Result<Sides, String> {
    let (width, height) = match text.split_once('x') {
        Some((width, height)) => (width, Some(height)),
        None => (text, None),
    };
    let is_number = |text: &str| text.trim().ends_with(|c: char| c.is_ascii_digit() || c == '.');
    let unit = height
        .unwrap_or_default()
        .trim_start_matches(|c: char| c.is_ascii_digit() || c == '.' || c == ' ');
    let width = match is_number(width) {
        true => format!("{width}{unit}"),
        false => width.to_owned(),
    };
    let parse = |side: &str| match Quantity::LengthMm.parse(side) {
        Ok(length) if (10.0..=2000.0).contains(&length) => Ok(length),
        Ok(length) => Err(format!("{length} mm: must be between 10 mm and 2000 mm")),
        Err(_) => Err("must be a width, or width x height, such as 85mm or 180x120mm".to_owned()),
    };
    Ok(Sides { width_mm: parse(&width)?, height_mm: height.map(parse).transpose()? })
}

#[cfg(test)]
mod tests {
    use super::sides;

    #[test]
    fn a_size_has_one_or_two_lengths() {
        for (text, width, height) in [
            ("85mm", 85.0, None),
            ("85", 85.0, None),
            ("85x60mm", 85.0, Some(60.0)),
            ("8.5cmx60mm", 85.0, Some(60.0)),
            ("8.5x6cm", 85.0, Some(60.0)),
            ("85x60", 85.0, Some(60.0)),
        ] {
            let sides = sides(text).map(|sides| (sides.width_mm, sides.height_mm));
            assert_eq!(sides, Ok((width, height)), "{text}");
        }
        for text in
            ["", "x", "85x", "x60mm", "85pt", "-85mm", "1e9mm", "9mm", "85mmx", "NaN", "85x60x3mm"]
        {
            assert!(sides(text).is_err(), "{text}");
        }
    }
}
