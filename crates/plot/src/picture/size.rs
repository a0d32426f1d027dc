//! Sizes of pictures: on a screen, in pixels, or on paper.

use super::text::SMALLEST;

/// Font size in print of the smallest text of a picture, in points.
const SMALLEST_PT: f64 = 7.0;
/// Points (1/72 inch) per unit of a picture.
pub const POINTS: f64 = SMALLEST_PT / SMALLEST;
/// Millimetres per unit of a picture in print.
pub const MM: f64 = POINTS * 25.4 / 72.0;
/// Least width and height of the bodies of a picture in print, together, in units.
const LEAST_BODY: f64 = 110.0;

/// The size of a picture: natural, in pixels, or on paper.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PictureSize {
    /// The size at which all text can be read on a screen.
    #[default]
    Natural,
    /// The natural picture, enlarged or reduced to this width in pixels.
    Width(u32),
    /// A size on paper.
    Print(PrintSize),
}

/// The size of a picture on paper, and its resolution. All text has at least 7 pt, subscripts 70 % of that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintSize {
    /// Width of the picture in mm.
    pub width_mm: f64,
    /// Height of the picture in mm; `None` for the height that suits its contents.
    pub height_mm: Option<f64>,
    /// Pixels per inch (25.4 mm) of a PNG, and of the cells of heat maps in every format.
    pub dpi: f64,
}

/// The error of a printed picture that has no room for its contents.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("too small for text of 7 pt; the {side} must be at least {least_mm} mm")]
pub struct SizeError {
    /// Side of the picture that is too short: `width` or `height`.
    pub side: &'static str,
    /// Least length of that side in mm.
    pub least_mm: f64,
}

impl PrintSize {
    /// Returns the width and the height of the picture in units, `None` for a height that suits its contents.
    pub(crate) fn units(self) -> [Option<f64>; 2] {
        [Some(self.width_mm / MM), self.height_mm.map(|mm| mm / MM)]
    }

    /// Returns pixels per unit.
    pub(crate) fn scale(self) -> f64 {
        self.dpi / 25.4 * MM
    }

    /// Returns the size that the bodies have together if the picture has this size, given that a picture of size `whole` has `bodies`, all
    /// in units, `[width, height]`: at least [`LEAST_BODY`], and at least `least_height` high. If the height is free, it is `ratio` times the width.
    pub(crate) fn bodies(
        self,
        whole: [f64; 2],
        bodies: [f64; 2],
        ratio: f64,
        least_height: f64,
    ) -> [f64; 2] {
        let units = self.units();
        let inside = |axis: usize| units[axis].map(|all| all - (whole[axis] - bodies[axis]));
        let width = inside(0).unwrap_or(LEAST_BODY).max(LEAST_BODY);
        let height = inside(1).map(|height| height.max(LEAST_BODY));
        [width, height.unwrap_or(ratio * width).max(least_height)]
    }

    /// Returns the size of a picture of size `whole` with these `bodies`, at least `least_height` high, all in units: this size, and a free height as it
    /// is.
    pub(crate) fn fitted(
        self,
        whole: [f64; 2],
        bodies: [f64; 2],
        least_height: f64,
    ) -> Result<[f64; 2], SizeError> {
        let units = self.units();
        let least = [LEAST_BODY, least_height.max(LEAST_BODY)];
        for (axis, side) in ["width", "height"].into_iter().enumerate() {
            if bodies[axis] <= least[axis] && units[axis].is_some_and(|all| whole[axis] > all) {
                let least_mm = (whole[axis] * MM).ceil();
                return Err(SizeError { side, least_mm });
            }
        }
        Ok([0, 1].map(|axis| units[axis].unwrap_or(whole[axis])))
    }
}
