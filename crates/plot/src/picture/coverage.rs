//! Coverage of pixels by strokes and polygons, and the dashes of dashed lines.

use super::DASHES;
use glam::DVec2;
use std::ops::Range;

/// The fraction of each pixel that a stroke covers. One buffer serves all strokes of a picture.
pub struct Coverage {
    size: [usize; 2],
    parts: Vec<f32>,
    /// Indices of the parts that are not 0.
    touched: Vec<usize>,
}

impl Coverage {
    /// Creates a coverage buffer for a picture of `size` pixels, `[width, height]`.
    pub fn new(size: [usize; 2]) -> Self {
        Self { size, parts: vec![0.0; size[0] * size[1]], touched: Vec::new() }
    }

    /// Returns the pixels `[x, y]` that a polyline with round ends and corners touches, each once, with the fraction covered. A single
    /// point is a disc.
    pub fn of(
        &mut self,
        points: &[[f64; 2]],
        radius: f64,
    ) -> impl Iterator<Item = ([usize; 2], f64)> {
        let disc = (points.len() == 1).then(|| [points[0]; 2]);
        let segments = points.windows(2).map(|pair| [pair[0], pair[1]]);
        for ends in segments.chain(disc) {
            let [across, down] = [0, 1].map(|axis| reach(ends, axis, radius, self.size[axis]));
            for (x, y) in down.flat_map(|y| across.clone().map(move |x| (x, y))) {
                let away = distance(DVec2::new(x as f64 + 0.5, y as f64 + 0.5), ends);
                let part = (radius + 0.5 - away).clamp(0.0, 1.0) as f32;
                let index = y * self.size[0] + x;
                let most = &mut self.parts[index];
                if part > 0.0 && *most == 0.0 {
                    self.touched.push(index);
                }
                *most = part.max(*most);
            }
        }
        let (width, parts) = (self.size[0], &mut self.parts);
        self.touched.drain(..).map(move |index| {
            let part = std::mem::take(&mut parts[index]);
            ([index % width, index / width], f64::from(part))
        })
    }
}

/// The pixels along one axis that a stroke along a segment can touch.
fn reach([from, to]: [[f64; 2]; 2], axis: usize, radius: f64, limit: usize) -> Range<usize> {
    let edge = |at: f64| at.clamp(0.0, limit as f64) as usize;
    let low = from[axis].min(to[axis]) - radius - 1.0;
    let high = from[axis].max(to[axis]) + radius + 2.0;
    edge(low)..edge(high)
}

/// The distance of a point from a segment.
fn distance(point: DVec2, ends: [[f64; 2]; 2]) -> f64 {
    let [from, to] = ends.map(DVec2::from);
    let (along, away) = (to - from, point - from);
    let nearest = match along.length_squared() {
        0.0 => 0.0,
        length => (along.dot(away) / length).clamp(0.0, 1.0),
    };
    (away - nearest * along).length()
}

/// Cuts a polyline `[x, y]` into dashes `[dash][point]` along its whole length, around its corners. Dashes and gaps have the lengths
/// [`DASHES`], in the unit of `points`; the gaps are left out.
pub fn dashes(points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let [on, off] = DASHES;
    let mut dashes = Vec::new();
    let mut dash: Vec<_> = points.first().copied().into_iter().collect();
    let (mut drawn, mut left) = (true, on);
    for pair in points.windows(2) {
        let [mut from, to] = [pair[0], pair[1]].map(DVec2::from);
        let mut length = from.distance(to);
        while length > left {
            from += left / length * (to - from);
            length -= left;
            dash.push(from.to_array());
            if drawn {
                dashes.push(std::mem::take(&mut dash));
            }
            drawn = !drawn;
            left = if drawn { on } else { off };
        }
        left -= length;
        if drawn {
            dash.push(pair[1]);
        }
    }
    if drawn {
        dashes.push(dash);
    }
    dashes
}

/// Scan lines per row of pixels in [`polygon`].
const SCAN_LINES: usize = 4;

/// Returns the pixels `[x, y]` that the inside of a polygon (even-odd) touches on a picture of `size` pixels, each with the fraction
/// covered.
pub fn polygon(corners: &[[f64; 2]], [width, height]: [usize; 2]) -> Vec<([usize; 2], f64)> {
    let heights = corners.iter().map(|[_, y]| *y);
    let top = heights.clone().fold(f64::INFINITY, f64::min);
    let bottom = heights.fold(f64::NEG_INFINITY, f64::max);
    let row = |at: f64| at.clamp(0.0, height as f64) as usize;
    let mut pixels = Vec::new();
    for y in row(top)..row(bottom.ceil()) {
        let mut parts = vec![0.0; width];
        for line in 0..SCAN_LINES {
            let at = y as f64 + (line as f64 + 0.5) / SCAN_LINES as f64;
            for inside in crossings(corners, at).as_chunks().0 {
                cover(&mut parts, *inside);
            }
        }
        let parts = parts.into_iter().enumerate();
        let covered = parts.filter(|(_, part)| *part > 0.0);
        pixels.extend(covered.map(|(x, part)| ([x, y], f64::min(part, 1.0))));
    }
    pixels
}

/// Points at which the sides of a polygon cross a horizontal line, from left to right.
fn crossings(corners: &[[f64; 2]], at: f64) -> Vec<f64> {
    let next = corners.iter().cycle().skip(1);
    let sides = corners.iter().zip(next);
    let mut crossings: Vec<f64> = sides
        .filter(|([_, from], [_, to])| (*from <= at) != (*to <= at))
        .map(|([x, y], [to_x, to_y])| x + (at - y) / (to_y - y) * (to_x - x))
        .collect();
    crossings.sort_by(f64::total_cmp);
    crossings
}

/// Adds the part of a scan line between two ends to each pixel of a row.
fn cover(parts: &mut [f64], ends: [f64; 2]) {
    let end = parts.len() as f64;
    let [from, to] = ends.map(|at| at.clamp(0.0, end));
    let (first, last) = (from as usize, to.ceil() as usize);
    for (x, part) in parts.iter_mut().enumerate().take(last).skip(first) {
        let covered = to.min((x + 1) as f64) - from.max(x as f64);
        *part += covered / SCAN_LINES as f64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strokes_outside_the_picture_cover_nothing() {
        let mut coverage = Coverage::new([10, 10]);
        let mut count = |points: &[[f64; 2]]| coverage.of(points, 2.0).count();
        assert_eq!(count(&[[-50.0, 5.0], [-40.0, 5.0]]), 0);
        assert_eq!(count(&[[50.0, 5.0]]), 0);
        assert_eq!(count(&[]), 0);
        assert_eq!(count(&[[-50.0, 5.0], [50.0, 5.0]]), 10 * 4);
    }

    #[test]
    fn a_polygon_covers_its_area() {
        let area = |corners: &[[f64; 2]]| -> f64 {
            polygon(corners, [20, 20]).iter().map(|(_, part)| part).sum()
        };
        let square = [[2.25, 3.5], [9.5, 3.5], [9.5, 8.0], [2.25, 8.0]];
        assert!((area(&square) - 7.25 * 4.5).abs() < 1e-12);
        let triangle = [[1.0, 1.0], [17.0, 1.0], [1.0, 17.0]];
        assert!((area(&triangle) - 128.0).abs() < 0.5);
        let beyond = square.map(|[x, y]| [x + 15.0, y + 15.0]);
        assert!((area(&beyond) - 2.75 * 1.5).abs() < 1e-12);
        assert_eq!(area(&square.map(|[x, y]| [x, y - 50.0])), 0.0);
        assert_eq!(area(&[]), 0.0);
        assert_eq!(area(&square[..2]), 0.0);
    }
}
