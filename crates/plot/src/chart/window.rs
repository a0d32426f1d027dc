//! The window of a plot: the ranges that its two axes show.

use super::{Disc, Plot};
use crate::frame::ticks::fraction;
use crate::picture::Area;

/// Room beside the data, as a fraction of their extent.
const MARGIN: f64 = 0.04;
/// Numbers beyond this are not drawn: their differences would overflow.
const HUGE: f64 = 1e300;
/// Numbers below this are shown as zero: their differences would lose digits.
const TINY: f64 = 1e-290;
/// Numbers that differ by less, relative to the largest, are shown as equal.
const EQUAL: f64 = 1e-9;

/// The ranges of both axes of a plot, in data units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    pub x: [f64; 2],
    pub y: [f64; 2],
    /// Largest magnitude of the data on each axis, in data units: `[x, y]`. Equal axes share the larger one.
    pub largest: [f64; 2],
}

impl Window {
    /// Chooses ranges that show all contents of a plot, for a body of `pixels` `[width, height]`.
    pub fn of(plot: &Plot, pixels: [f64; 2]) -> Self {
        let mut extents = [0, 1].map(|axis| extent(plot, axis));
        extents[0] = plot.x_range.unwrap_or(extents[0]);
        extents[1] = plot.y_range.unwrap_or(extents[1]);
        let [x, y] = if plot.equal_axes {
            equal_units(extents, pixels)
        } else {
            [0, 1].map(|axis| widened(extents[axis], plot.logarithmic[axis]))
        };
        let mut largest = extents.map(magnitude);
        if plot.equal_axes {
            largest = [largest[0].max(largest[1]); 2];
        }
        Self { x, y, largest }
    }

    /// Creates a square window around the point `[x, y]` with half the side `half`, all in data units.
    pub fn square(&self, [x, y]: [f64; 2], half: f64) -> Self {
        Self { x: [x - half, x + half], y: [y - half, y + half], largest: self.largest }
    }

    /// Converts a point `[x, y]` in data units to pixels of the picture, which shows the window in `body`.
    pub fn place(&self, body: Area, [x, y]: [f64; 2]) -> [f64; 2] {
        body.point(fraction(self.x, x), fraction(self.y, y))
    }

    /// Converts a length along the coarser axis from data units to pixels.
    pub fn pixels(&self, body: Area, length: f64) -> f64 {
        let across = body.width / (self.x[1] - self.x[0]);
        let upwards = body.height / (self.y[1] - self.y[0]);
        length * across.min(upwards)
    }

    /// Returns true if both ranges are wide enough to be drawn.
    pub fn is_open(&self) -> bool {
        let size = magnitude(self.x).max(magnitude(self.y));
        size <= HUGE && self.x[1] - self.x[0] > EQUAL * size.max(TINY)
    }

    pub fn holds(&self, [x, y]: [f64; 2]) -> bool {
        let inside = |[low, high]: [f64; 2], at: f64| (low..=high).contains(&at);
        inside(self.x, x) && inside(self.y, y)
    }

    pub fn holds_disc(&self, disc: &Disc) -> bool {
        corners(disc).into_iter().all(|corner| self.holds(corner))
    }

    /// Returns the parts of a polyline inside the window, in data units: points `[x, y]` as `[part][point]`.
    pub fn clipped(&self, points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
        let mut parts: Vec<Vec<[f64; 2]>> = Vec::new();
        for pair in points.windows(2) {
            let Some([from, to]) = self.within([pair[0], pair[1]]) else {
                continue;
            };
            match parts.last_mut() {
                Some(part) if part.last() == Some(&from) => part.push(to),
                _ => parts.push(vec![from, to]),
            }
        }
        parts
    }

    /// The part of a segment inside the window (Liang and Barsky 1984).
    fn within(&self, [from, to]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
        let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
        for (axis, [low, high]) in [self.x, self.y].into_iter().enumerate() {
            let step = to[axis] - from[axis];
            let ends = [low, high].map(|end| (end - from[axis]) / step);
            if step == 0.0 {
                if !(low..=high).contains(&from[axis]) {
                    return None;
                }
            } else {
                enters = enters.max(ends[0].min(ends[1]));
                leaves = leaves.min(ends[0].max(ends[1]));
            }
        }
        let at = |part: f64| match part {
            0.0 => from,
            1.0 => to,
            _ => [0, 1].map(|axis| part.mul_add(to[axis] - from[axis], from[axis])),
        };
        (enters < leaves).then(|| [at(enters), at(leaves)])
    }
}

/// Returns true if a point `[x, y]` in data units can be drawn: finite and at most 1e300.
pub fn drawable(point: [f64; 2]) -> bool {
    point.iter().all(|at| at.abs() <= HUGE)
}

/// Returns true if the points of both edges of a band can be drawn.
pub fn drawable_span(edges: [[f64; 2]; 2]) -> bool {
    edges.into_iter().all(drawable)
}

/// The lower left and the upper right corner of the square around a disc.
fn corners(disc: &Disc) -> [[f64; 2]; 2] {
    [-disc.radius, disc.radius].map(|radius| disc.centre.map(|at| at + radius))
}

/// Returns true if the centre and the radius of a disc can be drawn.
pub fn drawable_disc(disc: &Disc) -> bool {
    corners(disc).into_iter().all(drawable)
}

/// The smallest and the largest drawable number along an axis; 0 and 1 if there is none.
fn extent(plot: &Plot, axis: usize) -> [f64; 2] {
    let lines = plot.lines.iter().chain(&plot.bars);
    let lines = lines.flat_map(|line| &line.points).copied();
    let bands = plot.bands.iter().flat_map(|band| &band.points);
    let bands = bands.copied().filter(|point| drawable_span(*point));
    let edges = bands.flatten();
    let dots = plot.dots.iter().map(|dot| dot.at);
    let discs = plot.discs.iter().filter(|disc| drawable_disc(disc));
    let notes = plot.notes.iter();
    let notes = notes.flat_map(|note| std::iter::once(note.at).chain(note.to));
    let within = |[_, y]: [f64; 2]| match plot.y_range {
        Some([low, high]) => (low..=high).contains(&y),
        None => true,
    };
    let drawn = lines
        .chain(edges)
        .chain(dots)
        .chain(notes)
        .filter(|point| drawable(*point) && within(*point))
        .chain(discs.flat_map(corners));
    let extent = drawn.fold(None, |extent: Option<[f64; 2]>, point| {
        let [low, high] = extent.unwrap_or([point[axis]; 2]);
        Some([low.min(point[axis]), high.max(point[axis])])
    });
    extent.unwrap_or([0.0, 1.0])
}

/// The largest magnitude in a range.
fn magnitude([low, high]: [f64; 2]) -> f64 {
    low.abs().max(high.abs())
}

/// Half the range of an axis all of whose values are equal, given their magnitude.
fn room(size: f64) -> f64 {
    if size < TINY { 1.0 } else { 0.1 * size }
}

/// Widens a range, which is never empty afterwards. Equal decimal logarithms get a decade on each side.
fn widened([low, high]: [f64; 2], logarithmic: bool) -> [f64; 2] {
    let size = magnitude([low, high]);
    let (size, least) = match logarithmic {
        true => (1.0, 1.0),
        false => (size, room(size)),
    };
    let margin = match size < TINY || high - low < EQUAL * size {
        true => least,
        false => MARGIN * (high - low),
    };
    [low - margin, high + margin]
}

/// Widens the ranges so that a data unit has the same length on both axes.
fn equal_units(extents: [[f64; 2]; 2], pixels: [f64; 2]) -> [[f64; 2]; 2] {
    let needed = |axis: usize| {
        let [low, high] = extents[axis];
        (high - low) * (1.0 + 2.0 * MARGIN) / pixels[axis]
    };
    let size = magnitude(extents[0]).max(magnitude(extents[1]));
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
