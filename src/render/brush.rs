//! How much of each pixel a stroke covers.

/// A stroke's share of the pixels in its bounding box.
#[derive(Debug)]
pub(super) struct Cover {
    left: usize,
    top: usize,
    width: usize,
    /// Row by row, from 0 for untouched to 1 for covered.
    parts: Vec<f64>,
}

impl Cover {
    /// A polyline through `points` with round ends and corners, as far as it lies on a picture of size `limit`. A
    /// single point is a disc.
    pub(super) fn new(points: &[[f64; 2]], radius: f64, limit: [usize; 2]) -> Self {
        let [across, down] = [0, 1].map(|axis| reach(points, axis, radius, limit[axis]));
        let mut cover = Self {
            left: across.start,
            top: down.start,
            width: across.len(),
            parts: vec![0.0; across.len() * down.len()],
        };
        if let [only] = points {
            cover.segment([*only, *only], radius, limit);
        }
        for pair in points.windows(2) {
            cover.segment([pair[0], pair[1]], radius, limit);
        }
        cover
    }

    /// Column, row and share of every pixel that is touched.
    pub(super) fn pixels(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        let touched = self
            .parts
            .iter()
            .enumerate()
            .filter(|(_, part)| **part > 0.0);
        touched.map(|(place, part)| {
            let (row, column) = (place / self.width, place % self.width);
            (self.left + column, self.top + row, *part)
        })
    }

    /// Covers what is nearer to a segment than `radius`; a pixel that several segments touch counts once.
    fn segment(&mut self, ends: [[f64; 2]; 2], radius: f64, limit: [usize; 2]) {
        for y in reach(&ends, 1, radius, limit[1]) {
            for x in reach(&ends, 0, radius, limit[0]) {
                let away = distance([x as f64 + 0.5, y as f64 + 0.5], ends);
                let part = (radius + 0.5 - away).clamp(0.0, 1.0);
                let place = (y - self.top) * self.width + x - self.left;
                self.parts[place] = self.parts[place].max(part);
            }
        }
    }
}

/// The pixels along one axis that a stroke through `points` can touch.
fn reach(points: &[[f64; 2]], axis: usize, radius: f64, limit: usize) -> std::ops::Range<usize> {
    let along = points.iter().map(|point| point[axis]);
    let low = along.clone().fold(f64::INFINITY, f64::min) - radius - 1.0;
    let high = along.fold(f64::NEG_INFINITY, f64::max) + radius + 2.0;
    let edge = |at: f64| at.clamp(0.0, limit as f64) as usize;
    edge(low)..edge(high)
}

/// From a point to a segment.
fn distance(point: [f64; 2], [from, to]: [[f64; 2]; 2]) -> f64 {
    let along = [to[0] - from[0], to[1] - from[1]];
    let away = [point[0] - from[0], point[1] - from[1]];
    let length = along[0] * along[0] + along[1] * along[1];
    let dot = along[0] * away[0] + along[1] * away[1];
    let nearest = if length > 0.0 {
        (dot / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (away[0] - nearest * along[0]).hypot(away[1] - nearest * along[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_short_segments_cover_as_much_as_a_long_one() {
        let ends = [[3.2, 4.7], [33.1, 17.9]];
        let at =
            |part: f64| [0, 1].map(|axis| ends[0][axis] + part * (ends[1][axis] - ends[0][axis]));
        let short: Vec<_> = (0..=400).map(|step| at(f64::from(step) / 400.0)).collect();
        let [one, many] = [&ends[..], &short].map(|points| Cover::new(points, 3.0, [40, 20]));
        assert_eq!(one.parts.len(), many.parts.len());
        for (one, many) in one.parts.iter().zip(&many.parts) {
            assert!((one - many).abs() < 1e-3, "{one} and {many}");
        }
    }

    #[test]
    fn what_lies_outside_of_the_picture_is_not_covered() {
        let count = |points: &[[f64; 2]]| Cover::new(points, 2.0, [10, 10]).pixels().count();
        assert_eq!(count(&[[-50.0, 5.0], [-40.0, 5.0]]), 0);
        assert_eq!(count(&[[50.0, 5.0]]), 0);
        assert_eq!(count(&[]), 0);
        assert_eq!(count(&[[-50.0, 5.0], [50.0, 5.0]]), 10 * 4);
    }
}
