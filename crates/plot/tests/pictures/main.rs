//! Pictures show the data that they are given, as PNG and as SVG. Frames and lines are read from the SVG document, colours from the
//! pixels.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod axes;
mod bands;
mod documents;
mod drawn;
mod insets;
mod lines;
mod panels;
mod scales;
mod sizes;

use drawn::{Pixels, svg};
use whiskmap_plot::{Chart, PictureSize};

const WHITE: [u8; 3] = [255; 3];
const BLACK: [u8; 3] = [0x22, 0x2b, 0x33];
const BLUE: [u8; 3] = [0x1c, 0x6c, 0xc4];
/// The fill of discs and of cells without a value.
const BLANK: [u8; 3] = [0xdc, 0xdd, 0xde];

/// A chart as SVG and as pixels.
fn both(chart: &Chart) -> (String, Pixels) {
    let picture = chart.picture(PictureSize::Natural).unwrap();
    (svg(&picture), Pixels::of(&picture))
}

/// A quarter of a circle of radius 100 in a thousand pieces.
fn arc() -> Vec<[f64; 2]> {
    let angle = |step: i32| f64::from(step) / 1000.0 * std::f64::consts::FRAC_PI_2;
    (0..=1000).map(|step| [100.0 * angle(step).cos(), 100.0 * angle(step).sin()]).collect()
}
