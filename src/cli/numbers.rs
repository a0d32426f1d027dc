//! Numbers in arguments, refused in words rather than by the names of Rust's types.

use std::ops::RangeInclusive;
use whiskmap::input::Quantity;

/// A length in millimetres, or with a unit.
pub fn length(text: &str) -> Result<f64, String> {
    Quantity::LengthMm.parse(text)
}

/// An angle in degrees, or with a unit.
pub fn angle(text: &str) -> Result<f64, String> {
    Quantity::AngleDeg.parse(text)
}

/// A parser of whole numbers within `range`.
pub fn whole(range: RangeInclusive<u32>) -> impl Fn(&str) -> Result<u32, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|number| range.contains(number));
        number.ok_or_else(|| {
            let (least, most) = (range.start(), range.end());
            format!("must be a whole number between {least} and {most}")
        })
    }
}
