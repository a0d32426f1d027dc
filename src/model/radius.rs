//! Measured radii: a smooth curve through the rows of a table that rises or falls only where the rows do.
//!
//! Cubic pieces between the rows with the slopes of F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5, 300
//! (1984): continuous with the first derivative. A trajectory is integrated piece by piece, so that no step crosses a
//! row, where the second derivative jumps, and a Runge-Kutta method keeps its order.

use std::sync::{Mutex, PoisonError};

/// A cubic piece of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Arclength where it begins, in whisker lengths.
    pub from: f64,
    /// `radius = c0 + x (c1 + x (c2 + x c3))` with `x = s - from`, over the base radius.
    pub cubic: [f64; 4],
}

impl Piece {
    /// A cone.
    #[must_use]
    pub fn cone(taper: f64) -> Self {
        Self {
            from: 0.0,
            cubic: [1.0, -taper, 0.0, 0.0],
        }
    }

    /// Radius at arclength `s` over that at the base.
    #[must_use]
    pub fn radius(&self, s: f64) -> f64 {
        let x = s - self.from;
        let [c0, c1, c2, c3] = self.cubic;
        x.mul_add(x.mul_add(x.mul_add(c3, c2), c1), c0)
    }

    fn slope(&self, s: f64) -> f64 {
        let x = s - self.from;
        let [_, c1, c2, c3] = self.cubic;
        x.mul_add(x.mul_add(3.0 * c3, 2.0 * c2), c1)
    }
}

/// Radii along a whisker, over that at the base, by arclength in whisker lengths.
#[derive(Clone, Debug, PartialEq)]
pub struct RadiusProfile {
    /// From the base on; the last one continues beyond the last row, as the cone from the first row to the last does.
    pub pieces: Vec<Piece>,
    /// The largest change of `ln radius` over a piece, and the longest piece, both along `tau`.
    pub change: [f64; 2],
}

/// Every profile in use. A process reads few scenes, and trajectories by the million want to share one without counting.
static KNOWN: Mutex<Vec<&'static RadiusProfile>> = Mutex::new(Vec::new());

/// Places per piece at which its slope is looked at.
const LOOKS: u32 = 16;

impl RadiusProfile {
    /// The profile through `rows` of arclength and radius, as fractions of the whisker's, of a whisker whose real
    /// arclength is `stretch` times the one in the plane of contact. Equal profiles are one and stay until the end.
    #[must_use]
    pub fn of(rows: &[[f64; 2]], stretch: f64) -> &'static Self {
        let rows: Vec<[f64; 2]> = rows.iter().map(|[s, r]| [s / stretch, *r]).collect();
        let profile = Self::through(&rows);
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(equal) = known.iter().find(|other| ***other == profile) {
            return equal;
        }
        let leaked: &'static Self = Box::leak(Box::new(profile));
        known.push(leaked);
        leaked
    }

    fn through(rows: &[[f64; 2]]) -> Self {
        let widths: Vec<f64> = rows.windows(2).map(|w| w[1][0] - w[0][0]).collect();
        let secants: Vec<f64> = rows
            .windows(2)
            .zip(&widths)
            .map(|(w, width)| (w[1][1] - w[0][1]) / width)
            .collect();
        let slopes = slopes(&widths, &secants);
        let mut pieces: Vec<Piece> = (0..widths.len())
            .map(|i| {
                let (h, secant, [d0, d1]) = (widths[i], secants[i], [slopes[i], slopes[i + 1]]);
                let c2 = (3.0 * secant - 2.0 * d0 - d1) / h;
                let c3 = (d0 + d1 - 2.0 * secant) / (h * h);
                Piece {
                    from: rows[i][0],
                    cubic: [rows[i][1], d0, c2, c3],
                }
            })
            .collect();
        let [end, last] = rows[rows.len() - 1];
        let taper = (1.0 - last) / end;
        let tau = |s: f64| {
            if taper == 0.0 {
                s
            } else {
                -(-taper * s).ln_1p() / taper
            }
        };
        let mut change = [0.0_f64; 2];
        for (piece, width) in pieces.iter().zip(&widths) {
            let length = tau(piece.from + width) - tau(piece.from);
            let steepest = (0..=LOOKS)
                .map(|i| piece.from + width * f64::from(i) / f64::from(LOOKS))
                .map(|s| (1.0 - taper * s) * (piece.slope(s) / piece.radius(s)).abs())
                .fold(0.0, f64::max);
            change = [change[0].max(length * steepest), change[1].max(length)];
        }
        pieces.push(Piece {
            from: end,
            cubic: [last, -taper, 0.0, 0.0],
        });
        Self { pieces, change }
    }

    /// Index of the piece on which arclength `s` lies; a row belongs to the piece that it ends.
    #[must_use]
    pub fn piece(&self, s: f64) -> usize {
        self.pieces
            .partition_point(|piece| piece.from < s)
            .saturating_sub(1)
    }

    /// Radius at arclength `s` over that at the base.
    #[must_use]
    pub fn radius(&self, s: f64) -> f64 {
        self.pieces[self.piece(s)].radius(s)
    }
}

/// Slopes at the rows. Between secants of one sign their harmonic mean, weighted by the widths; 0 at an extremum; at
/// the ends that of a parabola, kept monotone.
fn slopes(widths: &[f64], secants: &[f64]) -> Vec<f64> {
    let n = widths.len();
    if n == 1 {
        return vec![secants[0]; 2];
    }
    let end = |h0: f64, h1: f64, d0: f64, d1: f64| {
        let slope = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
        if slope * d0 <= 0.0 {
            0.0
        } else if d0 * d1 <= 0.0 && slope.abs() > 3.0 * d0.abs() {
            3.0 * d0
        } else {
            slope
        }
    };
    let mut slopes = vec![end(widths[0], widths[1], secants[0], secants[1])];
    slopes.extend((1..n).map(|i| {
        let (before, after) = (secants[i - 1], secants[i]);
        if before * after <= 0.0 {
            return 0.0;
        }
        let (w1, w2) = (
            2.0 * widths[i] + widths[i - 1],
            widths[i] + 2.0 * widths[i - 1],
        );
        (w1 + w2) / (w1 / before + w2 / after)
    }));
    slopes.push(end(
        widths[n - 1],
        widths[n - 2],
        secants[n - 1],
        secants[n - 2],
    ));
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: [[f64; 2]; 6] = [
        [0.0, 1.0],
        [0.1, 0.93],
        [0.3, 0.9],
        [0.5, 0.9],
        [0.8, 0.2],
        [1.0, 0.05],
    ];

    #[test]
    fn it_goes_through_the_rows_smoothly_and_falls_where_they_do() {
        let profile = RadiusProfile::through(&ROWS);
        for [s, radius] in ROWS {
            assert!((profile.radius(s) - radius).abs() < 1e-15, "{s}");
        }
        for pair in profile.pieces[..ROWS.len() - 1].windows(2) {
            let row = pair[1].from;
            assert!(
                (pair[0].slope(row) - pair[1].slope(row)).abs() < 1e-13,
                "{row}"
            );
        }
        let radii: Vec<f64> = (0..=1000)
            .map(|i| profile.radius(f64::from(i) / 1000.0))
            .collect();
        assert!(radii.is_sorted_by(|a, b| a >= b));
    }

    #[test]
    fn a_linear_table_is_the_cone() {
        let rows = [0.0, 0.2, 0.7, 1.0].map(|s| [s, 1.0 - 0.9 * s]);
        let profile = RadiusProfile::through(&rows);
        for s in [0.0, 0.1, 0.2, 0.5, 0.9, 1.0, 1.05] {
            assert!((profile.radius(s) - (1.0 - 0.9 * s)).abs() < 1e-15, "{s}");
        }
    }

    #[test]
    fn equal_profiles_are_one() {
        let (one, other) = (RadiusProfile::of(&ROWS, 1.0), RadiusProfile::of(&ROWS, 1.0));
        assert!(std::ptr::eq(one, other));
        assert!(!std::ptr::eq(one, RadiusProfile::of(&ROWS, 1.03)));
    }
}
