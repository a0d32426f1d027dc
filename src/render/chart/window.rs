//! Which stretches of the numbers the axes of a plot show.

use super::{Disc, Plot};
use crate::render::canvas::Area;

/// Room beside the data, as a part of their extent.
const MARGIN: f64 = 0.04;
/// Numbers beyond this are not drawn: their differences would overflow.
const HUGE: f64 = 1e300;
/// Numbers below this are shown as zero: their differences would lose digits.
const TINY: f64 = 1e-290;
/// Numbers that differ by less, relative to the largest, are shown as equal.
const EQUAL: f64 = 1e-9;

/// Ends of both axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Window {
    pub(super) x: [f64; 2],
    pub(super) y: [f64; 2],
}

impl Window {
    /// Everything in a plot, for a body of this width and height.
    pub(super) fn of(plot: &Plot, size: [f64; 2]) -> Self {
        let extents = [0, 1].map(|axis| extent(plot, axis));
        let [x, y] = if plot.equal_axes {
            alike(extents, size)
        } else {
            extents.map(widened)
        };
        Self { x, y }
    }

    /// Where a point lies on the picture.
    pub(super) fn place(&self, body: Area, [x, y]: [f64; 2]) -> [f64; 2] {
        body.point(fraction(self.x, x), fraction(self.y, y))
    }

    /// How many pixels a length takes along the coarser axis.
    pub(super) fn pixels(&self, body: Area, length: f64) -> f64 {
        let across = body.width / (self.x[1] - self.x[0]);
        let upwards = body.height / (self.y[1] - self.y[0]);
        length * across.min(upwards)
    }
}

/// Whether a point is drawn at all.
pub(super) fn drawable(point: [f64; 2]) -> bool {
    point.iter().all(|at| at.abs() <= HUGE)
}

/// Where a disc ends to the left and below, and to the right and above.
fn corners(disc: &Disc) -> [[f64; 2]; 2] {
    [-disc.radius, disc.radius].map(|radius| disc.centre.map(|at| at + radius))
}

/// Whether a disc is drawn at all.
pub(super) fn drawable_disc(disc: &Disc) -> bool {
    corners(disc).into_iter().all(drawable)
}

/// How far along a range a value lies.
pub(super) fn fraction([low, high]: [f64; 2], value: f64) -> f64 {
    (value - low) / (high - low)
}

/// The least and the greatest of what is drawn along an axis; 0 and 1 if nothing is.
fn extent(plot: &Plot, axis: usize) -> [f64; 2] {
    let lines = plot
        .lines
        .iter()
        .flat_map(|line| line.points.iter().copied());
    let dots = plot.dots.iter().map(|dot| dot.at);
    let discs = plot.discs.iter().filter(|disc| drawable_disc(disc));
    let drawn = lines
        .chain(dots)
        .filter(|point| drawable(*point))
        .chain(discs.flat_map(corners));
    let extent = drawn.fold(None, |extent: Option<[f64; 2]>, point| {
        let [low, high] = extent.unwrap_or([point[axis]; 2]);
        Some([low.min(point[axis]), high.max(point[axis])])
    });
    extent.unwrap_or([0.0, 1.0])
}

fn size([low, high]: [f64; 2]) -> f64 {
    low.abs().max(high.abs())
}

/// Half the extent of an axis all of whose values are equal, and this large.
fn room(size: f64) -> f64 {
    if size < TINY { 1.0 } else { 0.1 * size }
}

/// A range with room beside it, never empty.
fn widened([low, high]: [f64; 2]) -> [f64; 2] {
    let size = size([low, high]);
    if size < TINY || high - low < EQUAL * size {
        [low - room(size), high + room(size)]
    } else {
        let margin = MARGIN * (high - low);
        [low - margin, high + margin]
    }
}

/// Ranges with room beside them in which a unit has the same number of pixels.
fn alike(extents: [[f64; 2]; 2], pixels: [f64; 2]) -> [[f64; 2]; 2] {
    let needed = |axis: usize| {
        let [low, high] = extents[axis];
        (high - low) * (1.0 + 2.0 * MARGIN) / pixels[axis]
    };
    let size = size(extents[0]).max(size(extents[1]));
    let least = pixels[0].min(pixels[1]);
    let mut unit = needed(0).max(needed(1));
    if size < TINY || unit * least < EQUAL * size {
        unit = 2.0 * room(size) / least;
    }
    [0, 1].map(|axis| {
        let [low, high] = extents[axis];
        let (middle, half) = (0.5 * low + 0.5 * high, 0.5 * unit * pixels[axis]);
        [middle - half, middle + half]
    })
}

#[cfg(test)]
mod tests {
    use super::super::Line;
    use super::*;

    fn plot(points: &[[f64; 2]], equal_axes: bool) -> Plot {
        let points = points.to_vec();
        let line = Line {
            points,
            ..Line::default()
        };
        Plot {
            lines: vec![line],
            equal_axes,
            ..Plot::default()
        }
    }

    fn close(range: [f64; 2], expected: [f64; 2]) {
        let near = |(at, expected): (f64, f64)| (at - expected).abs() < 1e-12;
        assert!(
            range.into_iter().zip(expected).all(near),
            "{range:?} is not {expected:?}"
        );
    }

    #[test]
    fn data_have_room_beside_them() {
        let window = Window::of(
            &plot(&[[0.0, 10.0], [f64::NAN, 99.0], [100.0, 20.0]], false),
            [4.0, 2.0],
        );
        close(window.x, [-4.0, 104.0]);
        close(window.y, [9.6, 20.4]);
    }

    #[test]
    fn equal_axes_have_one_scale_and_discs_count() {
        let mut plot = plot(&[[0.0, 0.0], [100.0, 0.0]], true);
        plot.discs = vec![Disc {
            centre: [50.0, 30.0],
            radius: 20.0,
        }];
        let window = Window::of(&plot, [1000.0, 500.0]);
        close(window.x, [-4.0, 104.0]);
        close(window.y, [-2.0, 52.0]);
        plot.discs[0].radius = 70.0;
        close(
            Window::of(&plot, [1000.0, 500.0]).y,
            [30.0 - 75.6, 30.0 + 75.6],
        );
    }

    #[test]
    fn every_range_can_be_divided_by() {
        let values = [
            0.0,
            1.0,
            -1.0,
            1e-320,
            1e-295,
            1e300,
            -1e300,
            1.0 + 1e-15,
            5e9,
            f64::MAX,
            f64::INFINITY,
        ];
        for equal in [false, true] {
            for (one, other) in values
                .iter()
                .flat_map(|one| values.map(|other| (*one, other)))
            {
                let Window { x, y } =
                    Window::of(&plot(&[[one, other], [other, 3.0]], equal), [1280.0, 880.0]);
                for range in [x, y] {
                    let span = range[1] - range[0];
                    assert!(span.is_finite() && span > 1e-10 * size(range), "{range:?}");
                }
            }
        }
    }
}
