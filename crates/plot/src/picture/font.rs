//! The built-in font, DejaVu Sans. A font size is the height of an em in pixels.

use ab_glyph::{Font, FontRef, OutlinedGlyph, PxScale, PxScaleFont, ScaleFont, point};
use std::sync::LazyLock;

/// Height of capital letters of the built-in font, in ems.
pub const CAPITALS: f64 = 0.729;

#[allow(clippy::expect_used, reason = "the font file is a part of the crate")]
static FONT: LazyLock<FontRef<'static>> = LazyLock::new(|| {
    FontRef::try_from_slice(include_bytes!("../../fonts/DejaVuSans.ttf")).expect("DejaVu Sans")
});

/// A text cut to its space, and its font size in pixels.
pub type FittedText = (String, f64);

/// The font with an em of this many pixels.
fn sized(size: f64) -> PxScaleFont<&'static FontRef<'static>> {
    // A scale is the height from descent to ascent.
    let ems = FONT.height_unscaled() / FONT.units_per_em().unwrap_or(1.0);
    FONT.as_scaled(PxScale::from(size as f32 * ems))
}

/// Returns the width of a text of font size `size`, in pixels.
pub fn width(text: &str, size: f64) -> f64 {
    let font = sized(size);
    text.chars()
        .map(|c| f64::from(font.h_advance(font.glyph_id(c))))
        .sum()
}

/// Returns the outlines of a text in pixels, `[glyph]`. It begins at the origin, with y downwards from its baseline.
pub fn outlines(text: &str, size: f64) -> Vec<OutlinedGlyph> {
    let font = sized(size);
    let mut x = 0.0;
    let outlines = text.chars().filter_map(|c| {
        let id = font.glyph_id(c);
        let glyph = id.with_scale_and_position(font.scale(), point(x, 0.0));
        x += font.h_advance(id);
        font.outline_glyph(glyph)
    });
    outlines.collect()
}

/// The end of a text that is cut.
const ELLIPSIS: &str = "\u{2026}";

/// Fits a text into `room` pixels: shrinks the font to no less than 0.6 of `largest`, and cuts the text if that does not suffice.
pub fn fitted(text: &str, largest: f64, room: f64) -> FittedText {
    let whole = width(text, largest).max(1.0);
    let size = largest * (room / whole).clamp(0.6, 1.0);
    let most = room + 1.0;
    if whole * size / largest <= most {
        return (text.to_owned(), size);
    }
    let font = sized(size);
    let mut end = width(ELLIPSIS, size);
    let fits = |c: &char| {
        end += f64::from(font.h_advance(font.glyph_id(*c)));
        end <= most
    };
    let kept: String = text.chars().take_while(fits).collect();
    (kept + ELLIPSIS, size)
}

/// Returns the characters of a text that the built-in font lacks, each once, in their order. A PNG shows them as boxes.
#[must_use]
pub fn missing_glyphs(text: &str) -> Vec<char> {
    let mut missing: Vec<char> = Vec::new();
    for c in text.chars().filter(|c| !c.is_control()) {
        if FONT.glyph_id(c).0 == 0 && !missing.contains(&c) {
            missing.push(c);
        }
    }
    missing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_text_is_cut_where_its_room_ends() {
        let (whole, size) = fitted("short", 20.0, 400.0);
        assert_eq!((&*whole, size), ("short", 20.0));
        for text in ["m".repeat(100_000), "i".repeat(500), "\u{9b0d}".repeat(90)] {
            let (cut, size) = fitted(&text, 20.0, 400.0);
            let kept = cut.strip_suffix(ELLIPSIS).unwrap_or_default();
            assert!(size == 12.0 && text.starts_with(kept), "{cut}");
            let one: String = text.chars().take(1).collect();
            let [cut, one] = [&*cut, &*one].map(|text| width(text, size));
            assert!(cut <= 401.0 && cut + one > 401.0, "{cut}");
        }
        assert_eq!(fitted("wide", 20.0, 1.0).0, ELLIPSIS);
    }
}
