//! Measured radii: a smooth curve through the rows of a table that rises or falls only where the rows do.
//!
//! Cubic pieces with the slopes of F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5, 300 (1984) join the rows. The
//! curve and its first derivative are continuous. Trajectories are integrated piece by piece: no step crosses a row, where
//! the second derivative jumps.

use crate::numerics::gauss::QUADRATURE;
use crate::numerics::{Dual, Real, Scalar};
use crate::rod::Demands;
use crate::rod::piece_weights::PieceWeights;
use crate::rod::rod::{arclength_at, pointed, tau_at, tau_derivative};
use std::sync::Arc;

/// A piece of a measured profile: the radius as a cubic polynomial of the arclength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Arclength at the start of the piece, in whisker lengths.
    pub from: f64,
    /// Coordinate `tau` at the start of the piece, dimensionless, on the cone from the first row to the last.
    pub tau: f64,
    /// Coefficients `[c0, c1, c2, c3]` of the radius over the base radius, as the polynomial `c0 + x (c1 + x (c2 + x c3))` with `x = s - from`.
    pub cubic: [f64; 4],
}

impl Piece {
    /// Returns the radius over the base radius at arclength `s`, in whisker lengths, on one piece.
    #[must_use]
    pub fn radius(&self, s: f64) -> f64 {
        let x = s - self.from;
        let [c0, c1, c2, c3] = self.cubic;
        x.mul_add(x.mul_add(x.mul_add(c3, c2), c1), c0)
    }

    /// Returns the derivative of the radius over the base radius by the arclength, at arclength `s`. Arclengths are in whisker lengths.
    #[must_use]
    pub fn slope(&self, s: f64) -> f64 {
        let x = s - self.from;
        let [_, c1, c2, c3] = self.cubic;
        x.mul_add(x.mul_add(3.0 * c3, 2.0 * c2), c1)
    }
}

/// Measured radii along a whisker, over the base radius, by arclength in whisker lengths.
#[derive(Clone, Debug, PartialEq)]
pub struct RadiusProfile {
    /// Pieces of the profile, from the base on, `[piece]`. The last one lies beyond the last row, with the slope of the cone from the
    /// first row to the last.
    pub pieces: Vec<Piece>,
    /// Upper bounds of the change of `ln radius` over each piece, `[piece]`: its steepest slope by `tau` times its length.
    pub changes: Vec<f64>,
    /// Lengths of the pieces in whisker lengths, `[piece]`.
    pub widths: Vec<f64>,
    /// Demands of the pieces of the profile on integration steps.
    pub demands: Demands,
    /// Taper of the cone from the first row to the last, dimensionless.
    pub(super) taper: f64,
    /// Collocation integrals of the pieces, tabulated at their first use.
    pub(super) weights: PieceWeights,
    /// Number of parts, along `tau`, in the quadrature of each piece.
    parts: Vec<u32>,
    /// Integrals of `radius^-4` and of `s radius^-4` from the base to each piece.
    compliances: Vec<[f64; 2]>,
}

/// Samples of the slope per piece. `|radius'|/radius` peaks at a thin end of a piece: where the radius falls to a thousandth,
/// the peak takes a fiftieth of the piece.
const SLOPE_SAMPLES: u32 = 256;

impl RadiusProfile {
    /// Creates the profile through `rows` of `[arclength, radius]`: the real arclength in whisker lengths, and the radius over the base
    /// radius. `stretch` is the real arclength over the arclength in the plane of contact, at least 1.
    #[must_use]
    pub fn new(rows: &[[f64; 2]], stretch: f64) -> Self {
        let rows: Vec<[f64; 2]> = rows.iter().map(|[s, r]| [s / stretch, *r]).collect();
        let mut widths: Vec<f64> = rows.windows(2).map(|w| w[1][0] - w[0][0]).collect();
        let [end, last] = rows[rows.len() - 1];
        let taper = (1.0 - last) / end;
        let cubics = cubics(&rows).into_iter().zip(&rows);
        let piece = |(cubic, [from, _]): ([f64; 4], &[f64; 2])| Piece {
            from: *from,
            tau: tau_at(taper, *from),
            cubic,
        };
        let mut pieces: Vec<Piece> = cubics.map(piece).collect();
        let whole = pointed(taper);
        pieces.push(Piece { from: end, tau: tau_at(taper, end), cubic: [last, -taper, 0.0, 0.0] });
        widths.push((whole - end).max(0.0));
        let (mut changes, mut parts) = (Vec::new(), Vec::new());
        for (piece, width) in pieces.iter().zip(&widths) {
            let length = tau_at(taper, piece.from + width) - piece.tau;
            let steepest = (0..=SLOPE_SAMPLES)
                .map(|i| piece.from + width * f64::from(i) / f64::from(SLOPE_SAMPLES))
                .map(|s| (1.0 - taper * s) * (piece.slope(s) / piece.radius(s)).abs())
                .fold(0.0, f64::max);
            // The coordinate `tau` of a step follows the cone, too.
            changes.push(length * steepest.max(taper));
            parts.push((length * steepest).ceil().max(1.0) as u32);
        }
        let weights = PieceWeights::new(pieces.len());
        let mut profile = Self {
            pieces,
            changes,
            widths,
            demands: Demands::default(),
            taper,
            weights,
            parts,
            compliances: vec![[0.0; 2]],
        };
        for k in 1..profile.pieces.len() {
            let next = profile.up_to(k - 1, profile.pieces[k].from);
            profile.compliances.push(next);
        }
        profile.demands = Demands::new(&profile, taper.recip());
        profile
    }

    /// Returns the derivatives of the profile's taper and of its pieces, `[piece]`, by a variable that changes the `rows` and the `stretch`
    /// of [`RadiusProfile::new`]. The numbers of rows and stretch are dual.
    #[must_use]
    pub fn derivative(rows: &[[Dual<f64>; 2]], stretch: Dual<f64>) -> (f64, Arc<[Piece]>) {
        let rows: Vec<[Dual<f64>; 2]> = rows.iter().map(|[s, r]| [*s / stretch, *r]).collect();
        let [end, last] = rows[rows.len() - 1];
        let taper = (Dual::of(1.0) - last) / end;
        let mut all = cubics(&rows);
        all.push([last, -taper, Dual::of(0.0), Dual::of(0.0)]);
        let piece = |(cubic, [from, _]): ([Dual<f64>; 4], &[Dual<f64>; 2])| Piece {
            from: from.derivative,
            tau: tau_derivative(taper, *from),
            cubic: cubic.map(|coefficient| coefficient.derivative),
        };
        let pieces = all.into_iter().zip(&rows).map(piece).collect();
        (taper.derivative, pieces)
    }

    /// Returns the dimensionless compliance at arclength `s`, in whisker lengths: the rotation there by a small unit load. It is the integral of
    /// `(s-x) radius(x)^-4` from the base to `s`, within a few percent.
    #[must_use]
    pub fn compliance(&self, s: f64) -> f64 {
        let k = self.piece(s);
        let [flat, lever] = self.up_to(k, s);
        s * flat - lever
    }

    /// Returns the share of each piece in the compliance at arclength `s`, in whisker lengths: `[piece]`, from the base on. The sum is 1.
    pub(super) fn shares_at(&self, s: f64) -> impl Iterator<Item = f64> {
        let last = self.piece(s);
        let [flat, lever] = self.up_to(last, s);
        let whole = s * flat - lever;
        let turn = move |k: usize| {
            let from = self.compliances[k];
            let to = if k == last { [flat, lever] } else { self.compliances[k + 1] };
            s * (to[0] - from[0]) - (to[1] - from[1])
        };
        (0..=last).map(move |k| turn(k) / whole)
    }

    /// Integrals of `radius^-4` and of `s radius^-4` from the base to `s` on the piece `k`, by quadrature over `tau`.
    fn up_to(&self, k: usize, s: f64) -> [f64; 2] {
        let piece = &self.pieces[k];
        let from = piece.tau;
        let width = (tau_at(self.taper, s) - from) / f64::from(self.parts[k]);
        let nodes = (0..self.parts[k]).flat_map(|part| {
            QUADRATURE.map(|[node, weight]| (width.mul_add(f64::from(part) + node, from), weight))
        });
        nodes.fold(self.compliances[k], |[flat, lever], (tau, weight)| {
            let scale = libm::exp(-self.taper * tau);
            let here = arclength_at(self.taper, tau);
            let part = weight * width * scale / piece.radius(here).powi(4);
            [flat + part, lever + part * here]
        })
    }

    /// Returns the index of the piece on which the arclength `s`, in whisker lengths, lies. A row belongs to the piece that it ends.
    #[must_use]
    pub fn piece(&self, s: f64) -> usize {
        self.pieces.partition_point(|piece| piece.from < s).saturating_sub(1)
    }

    /// Returns the radius of the profile at arclength `s`, in whisker lengths, over the base radius.
    #[must_use]
    pub fn radius(&self, s: f64) -> f64 {
        self.pieces[self.piece(s)].radius(s)
    }
}

/// Cubic coefficients of the piece after each of `rows` of arclength and radius but the last: `[piece][power]`.
fn cubics<T: Scalar>(rows: &[[T; 2]]) -> Vec<[T; 4]> {
    let pairs = || rows.windows(2);
    let widths: Vec<T> = pairs().map(|w| w[1][0] - w[0][0]).collect();
    let rises = pairs().map(|w| w[1][1] - w[0][1]);
    let secants: Vec<T> = rises.zip(&widths).map(|(rise, h)| rise / *h).collect();
    let slopes = slopes(&widths, &secants);
    let cubic = |i: usize| {
        let (h, secant, [d0, d1]) = (widths[i], secants[i], [slopes[i], slopes[i + 1]]);
        let c2 = (T::of(3.0) * secant - T::of(2.0) * d0 - d1) / h;
        let c3 = (d0 + d1 - T::of(2.0) * secant) / (h * h);
        [rows[i][1], d0, c2, c3]
    };
    (0..widths.len()).map(cubic).collect()
}

/// Slopes at the rows: the harmonic mean of neighbouring secants of one sign, weighted by the widths; 0 at an extremum; at
/// both ends the slope of a parabola, limited so that the curve stays monotone. A secant of 0 is on the border between two cases: the
/// derivative of the slope is the mean of both.
fn slopes<T: Scalar>(widths: &[T], secants: &[T]) -> Vec<T> {
    let n = widths.len();
    if n == 1 {
        return vec![secants[0]; 2];
    }
    let (two, is_level) = (T::of(2.0), |secant: T| secant.value() == 0.0);
    let end = |at: usize, next: usize| {
        let (h0, h1, d0, d1) = (widths[at], widths[next], secants[at], secants[next]);
        let slope = ((two * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
        if is_level(d0) && !is_level(d1) {
            T::of(1.5) * d0
        } else if (slope * d0).value() <= 0.0 {
            T::of(0.0)
        } else if (d0 * d1).value() <= 0.0 && slope.value().abs() > 3.0 * d0.value().abs() {
            T::of(3.0) * d0
        } else {
            slope
        }
    };
    let mut slopes = vec![end(0, 1)];
    slopes.extend((1..n).map(|i| {
        let (before, after) = (secants[i - 1], secants[i]);
        let w1 = two * widths[i] + widths[i - 1];
        let w2 = widths[i] + two * widths[i - 1];
        let level = |secant: T, w: T| T::of(0.5) * (w1 + w2) / w * secant;
        match [before, after].map(is_level) {
            [true, false] => level(before, w1),
            [false, true] => level(after, w2),
            _ if (before * after).value() <= 0.0 => T::of(0.0),
            _ => (w1 + w2) / (w1 / before + w2 / after),
        }
    }));
    slopes.push(end(n - 1, n - 2));
    slopes
}
