//! Lines as pixels: how much of each is covered, and where dashes begin and end.

use super::picture::DASHES;
use glam::DVec2;
use std::ops::Range;

/// How much of each pixel a stroke covers. One is enough for all strokes of a picture.
pub(super) struct Coverage {
    size: [usize; 2],
    parts: Vec<f32>,
    /// Indices of the parts that are not 0.
    touched: Vec<usize>,
}

impl Coverage {
    /// For a picture of this many pixels.
    pub(super) fn new(size: [usize; 2]) -> Self {
        Self {
            size,
            parts: vec![0.0; size[0] * size[1]],
            touched: Vec::new(),
        }
    }

    /// The pixels that a polyline with round ends and corners touches, each with the part of it that is covered. A single
    /// point is a disc; a pixel that several segments touch comes once.
    pub(super) fn of(
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

/// From a point to a segment.
fn distance(point: DVec2, ends: [[f64; 2]; 2]) -> f64 {
    let [from, to] = ends.map(DVec2::from);
    let (along, away) = (to - from, point - from);
    let nearest = match along.length_squared() {
        0.0 => 0.0,
        length => (along.dot(away) / length).clamp(0.0, 1.0),
    };
    (away - nearest * along).length()
}

/// The dashes of a polyline, along the whole of it and around its corners.
pub(super) fn dashes(points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_outside_of_the_picture_is_not_covered() {
        let mut coverage = Coverage::new([10, 10]);
        let mut count = |points: &[[f64; 2]]| coverage.of(points, 2.0).count();
        assert_eq!(count(&[[-50.0, 5.0], [-40.0, 5.0]]), 0);
        assert_eq!(count(&[[50.0, 5.0]]), 0);
        assert_eq!(count(&[]), 0);
        assert_eq!(count(&[[-50.0, 5.0], [50.0, 5.0]]), 10 * 4);
    }
}
