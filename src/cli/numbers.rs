//! Numbers in arguments, refused in words rather than by the names of Rust's types.

use std::ops::RangeInclusive;

/// A number.
pub fn number(text: &str) -> Result<f64, String> {
    text.parse()
        .map_err(|_| "must be a number, such as 15.66".to_owned())
}

/// An angle in degrees, such as `30deg` or `30`.
pub fn degrees(text: &str) -> Option<f64> {
    let number = text.strip_suffix("deg").unwrap_or(text);
    number.trim_end().parse().ok()
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
