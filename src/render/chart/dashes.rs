//! Dashes along a polyline.

/// The dashes of a polyline: `on` drawn, `off` left out, along the whole of it and around its corners.
pub(super) fn cut(points: &[[f64; 2]], [on, off]: [f64; 2]) -> Vec<Vec<[f64; 2]>> {
    let mut dashes = Vec::new();
    let mut dash: Vec<_> = points.first().copied().into_iter().collect();
    let (mut drawn, mut left) = (true, on);
    for pair in points.windows(2) {
        let [mut from, to] = [pair[0], pair[1]];
        let mut length = (to[0] - from[0]).hypot(to[1] - from[1]);
        while length > left {
            let part = left / length;
            from = [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]));
            length -= left;
            dash.push(from);
            if drawn {
                dashes.push(std::mem::take(&mut dash));
            }
            drawn = !drawn;
            left = if drawn { on } else { off };
        }
        left -= length;
        if drawn {
            dash.push(to);
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

    fn length(dash: &[[f64; 2]]) -> f64 {
        let pairs = dash.windows(2);
        pairs
            .map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]))
            .sum()
    }

    #[test]
    fn dashes_do_not_depend_on_the_number_of_points() {
        for points in [2, 7, 1000] {
            let place = |point: i32| 100.0 * f64::from(point) / f64::from(points - 1);
            let line: Vec<_> = (0..points).map(|point| [place(point), 3.0]).collect();
            let dashes = cut(&line, [8.0, 4.0]);
            assert_eq!(dashes.len(), 9);
            for (count, dash) in dashes.iter().enumerate() {
                assert!((dash[0][0] - 12.0 * count as f64).abs() < 1e-9);
                let expected = if count == 8 { 4.0 } else { 8.0 };
                assert!((length(dash) - expected).abs() < 1e-9, "{dash:?}");
            }
        }
    }

    #[test]
    fn dashes_go_around_corners() {
        let corner = [[0.0, 0.0], [5.0, 0.0], [5.0, 20.0]];
        let expected = [
            vec![[0.0, 0.0], [5.0, 0.0], [5.0, 3.0]],
            vec![[5.0, 7.0], [5.0, 15.0]],
            vec![[5.0, 19.0], [5.0, 20.0]],
        ];
        assert_eq!(cut(&corner, [8.0, 4.0]), expected);
    }
}
