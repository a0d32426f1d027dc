//! The built-in font, DejaVu Sans. A font size is the height of an em in units of the picture.
//!
//! In a text, `_{...}` is a subscript: `θ_{p}`.

use ab_glyph::{Font, FontRef, Outline, OutlinedGlyph, PxScale, PxScaleFont, ScaleFont, point};
use std::sync::LazyLock;

/// Height of capital letters of the built-in font, in ems.
pub const CAPITALS: f64 = 0.729;
/// Size of subscripts, and their drop below the baseline, as fractions of the font size.
const SUBSCRIPT: [f64; 2] = [0.7, 0.18];

#[allow(clippy::expect_used, reason = "the font file is a part of the crate")]
static FONT: LazyLock<FontRef<'static>> = LazyLock::new(|| {
    FontRef::try_from_slice(include_bytes!("../../fonts/DejaVuSans.ttf")).expect("DejaVu Sans")
});

/// The font with an em of this many pixels.
fn sized(size: f64) -> PxScaleFont<&'static FontRef<'static>> {
    // A scale is the height from descent to ascent.
    let ems = FONT.height_unscaled() / FONT.units_per_em().unwrap_or(1.0);
    FONT.as_scaled(PxScale::from(size as f32 * ems))
}

/// A stretch of a text on one baseline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run<'a> {
    pub text: &'a str,
    /// Font size of the run, in the picture's units.
    pub size: f64,
    /// Drop of the run's baseline below the text's baseline, in the picture's units.
    pub drop: f64,
}

/// Returns the runs of a text of font size `size`, `[run]`: between and inside its subscripts. A subscript without an end is plain text.
pub fn runs(text: &str, size: f64) -> Vec<Run<'_>> {
    let plain = |text| Run { text, size, drop: 0.0 };
    let mut runs = Vec::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("_{")
        && let Some((text, next)) = after.split_once('}')
    {
        let [part, drop] = SUBSCRIPT.map(|part| part * size);
        runs.extend([plain(before), Run { text, size: part, drop }]);
        rest = next;
    }
    runs.push(plain(rest));
    runs.retain(|run| !run.text.is_empty());
    runs
}

/// Returns the width of a text of font size `size`, both in the picture's units.
pub fn width(text: &str, size: f64) -> f64 {
    let of_run = |run: Run<'_>| {
        let font = sized(run.size);
        let advances = run.text.chars().map(|c| font.h_advance(font.glyph_id(c)));
        advances.map(f64::from).sum::<f64>()
    };
    runs(text, size).into_iter().map(of_run).sum()
}

/// Calls `draw` with the font, the character and the place of each glyph of a text. The text begins at the origin, with y downwards.
fn each_glyph(
    text: &str,
    size: f64,
    mut draw: impl FnMut(PxScaleFont<&'static FontRef<'static>>, char, [f32; 2]),
) {
    let mut x = 0.0;
    for run in runs(text, size) {
        let font = sized(run.size);
        for c in run.text.chars() {
            draw(font, c, [x, run.drop as f32]);
            x += font.h_advance(font.glyph_id(c));
        }
    }
}

/// Returns the outlines of a text of font size `size`, in pixels: `[glyph]`. The text begins at the origin, with y downwards from its baseline.
pub fn outlines(text: &str, size: f64) -> Vec<OutlinedGlyph> {
    let mut outlines = Vec::new();
    each_glyph(text, size, |font, c, [x, y]| {
        let glyph = font.glyph_id(c).with_scale_and_position(font.scale(), point(x, y));
        outlines.extend(font.outline_glyph(glyph));
    });
    outlines
}

/// The curves of a glyph in units of the font, y upwards, with the size of that unit and the place `[x, y]` of the glyph's origin.
pub struct GlyphCurves {
    pub outline: Outline,
    pub unit: f64,
    pub at: [f64; 2],
}

/// Returns the curves of a text of font size `size`, `[glyph]`. The text begins at the origin, with y downwards from its baseline, in the unit of
/// `size`.
pub fn curves(text: &str, size: f64) -> Vec<GlyphCurves> {
    let mut curves = Vec::new();
    each_glyph(text, size, |font, c, at| {
        let unit = f64::from(font.scale().y / FONT.height_unscaled());
        let at = at.map(f64::from);
        let outline = FONT.outline(font.glyph_id(c));
        curves.extend(outline.map(|outline| GlyphCurves { outline, unit, at }));
    });
    curves
}

/// Returns the characters of a text that the built-in font lacks, each once, in their order. A PNG or PDF shows them as boxes.
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
    fn subscripts_are_smaller_and_lower() {
        let texts = |text: &'static str| -> Vec<(&str, f64)> {
            let runs = runs(text, 10.0).into_iter();
            runs.map(|run| (run.text, run.size)).collect()
        };
        assert_eq!(
            texts("\u{3b8}_{obj} (deg)"),
            [("\u{3b8}", 10.0), ("obj", 7.0), (" (deg)", 10.0)]
        );
        for plain in ["tip_radius_um", "a_{b", "{p}", ""] {
            assert!(texts(plain).iter().all(|(text, size)| *text == plain && *size == 10.0));
        }
        assert!(runs("a_{b}", 10.0)[1].drop > 1.0);
        let typeset = width("\u{3b8}_{p}", 10.0);
        assert!(typeset < width("\u{3b8}p", 10.0) && typeset > width("\u{3b8}", 10.0));
    }
}
