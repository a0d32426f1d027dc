//! Polygons as pixels: how much of each is covered.

/// Lines that each row of pixels is looked at along.
const LINES: usize = 4;

/// The pixels that the inside of a polygon (even-odd) touches on a picture of size `limit`, each with the part of it that is
/// covered.
pub(super) fn fill(corners: &[[f64; 2]], limit: [usize; 2]) -> Vec<([usize; 2], f64)> {
    let heights = corners.iter().map(|[_, y]| *y);
    let top = heights.clone().fold(f64::INFINITY, f64::min);
    let bottom = heights.fold(f64::NEG_INFINITY, f64::max);
    let [width, height] = limit;
    let row = |at: f64| at.clamp(0.0, height as f64) as usize;
    let mut pixels = Vec::new();
    for y in row(top)..row(bottom.ceil()) {
        let mut parts = vec![0.0; width];
        for line in 0..LINES {
            let at = y as f64 + (line as f64 + 0.5) / LINES as f64;
            for inside in crossings(corners, at).as_chunks().0 {
                cover(&mut parts, *inside);
            }
        }
        let covered = parts
            .into_iter()
            .enumerate()
            .filter(|(_, part)| *part > 0.0);
        pixels.extend(covered.map(|(x, part)| ([x, y], f64::min(part, 1.0))));
    }
    pixels
}

/// Where the sides of a polygon cross a line, from left to right.
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

/// Adds to each pixel of a row what one of its lines has of it between two ends.
fn cover(parts: &mut [f64], [from, to]: [f64; 2]) {
    let end = parts.len() as f64;
    let [from, to] = [from, to].map(|at| at.clamp(0.0, end));
    let first = from as usize;
    let parts = parts[first..]
        .iter_mut()
        .take((to.ceil() as usize).saturating_sub(first));
    for (x, part) in (first..).zip(parts) {
        let covered = to.min((x + 1) as f64) - from.max(x as f64);
        *part += covered / LINES as f64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[[f64; 2]]) -> f64 {
        fill(corners, [20, 20]).iter().map(|(_, part)| part).sum()
    }

    #[test]
    fn as_much_is_covered_as_lies_inside() {
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
