//! Points and tangents of a curve at rest as Taylor series, for many evaluations of one curve.
//!
//! The curve is cut into equal panels. Along each panel the tangent is a series of the place `x` on `[-1, 1]`. With the curvature
//! `kappa`, the tangent `t` turns by `dt/dx = h kappa perp(t)`, where `h` is half the length of a panel: this gives each term from the
//! terms before. The panels are halved until the last two terms of each panel are below rounding.

use crate::rod::CURVATURE_TERMS;
use glam::DVec2;
use std::sync::Arc;

/// Number of terms of the series of a tangent.
const TERMS: usize = 18;

/// Largest size of each of the last two terms: half the rounding of a unit vector.
const LAST_TERMS: f64 = 0.25 * f64::EPSILON;

/// Maximum number of panels. A curvature of degree 6 that reaches 20 radians per whisker length needs 80. By Markov's inequality a
/// curve whose tangent stays within a radian or two of its chord reaches some 300 at most, which needs 15 times as many.
const MOST_PANELS: usize = 4096;

/// Taylor series of a resting curve from its base to its tip.
#[derive(Clone, Debug)]
pub struct ArcSeries(Arc<[ArcPanel]>);

/// Series of one panel, in powers of the place on it.
#[derive(Clone, Copy, Debug)]
struct ArcPanel {
    /// Middle of the panel, in whisker lengths, in the frame of the base.
    middle: DVec2,
    /// Terms `[power]` of the tangent.
    tangent: [DVec2; TERMS],
    /// Terms `[power less 1]` of the point from the middle, in whisker lengths.
    point: [DVec2; TERMS],
}

impl ArcSeries {
    /// Computes the series of a curve that turns by at most `turn` radians. `curvature(s)` returns the Taylor terms of the curvature by
    /// the arclength around `s`, and `angle(s)` the angle of the tangent from the base's tangent.
    pub fn new(
        turn: f64,
        curvature: impl Fn(f64) -> [f64; CURVATURE_TERMS],
        angle: impl Fn(f64) -> f64,
    ) -> Self {
        let mut count = (turn.max(1.0).ceil() as usize).min(MOST_PANELS);
        loop {
            let half = 0.5 / count as f64;
            let mut from = DVec2::ZERO;
            let panels: Arc<[ArcPanel]> = (0..count)
                .map(|panel| {
                    let middle = half * (2 * panel + 1) as f64;
                    let series =
                        ArcPanel::new(half, &curvature(middle), DVec2::from_angle(angle(middle)));
                    let (begin, end) = (series.at(-1.0).0, series.at(1.0).0);
                    let middle = from - begin;
                    from = middle + end;
                    ArcPanel { middle, ..series }
                })
                .collect();
            if panels.iter().all(ArcPanel::is_exact) || 2 * count > MOST_PANELS {
                return Self(panels);
            }
            count *= 2;
        }
    }

    /// Returns point and unit tangent at arclength `s`, at most 1, both in whisker lengths, in the frame of the base.
    pub fn at(&self, s: f64) -> (DVec2, DVec2) {
        let count = self.0.len();
        let place = s * count as f64;
        let panel = (place as usize).min(count - 1);
        self.0[panel].at(2.0 * (place - panel as f64) - 1.0)
    }
}

impl ArcPanel {
    /// Computes the series of a panel of half the length `half`, with its middle at the origin.
    fn new(half: f64, curvature: &[f64; CURVATURE_TERMS], tangent: DVec2) -> Self {
        let mut scale = 1.0;
        let turns = curvature.map(|term| {
            scale *= half;
            scale * term
        });
        let mut tangents = [DVec2::ZERO; TERMS];
        tangents[0] = tangent;
        for power in 1..TERMS {
            let turned = turns.iter().zip(tangents[..power].iter().rev());
            let sum: DVec2 = turned.map(|(turn, before)| *turn * before.perp()).sum();
            tangents[power] = sum / power as f64;
        }
        Self {
            middle: DVec2::ZERO,
            tangent: tangents,
            point: std::array::from_fn(|power| half * tangents[power] / (power + 1) as f64),
        }
    }

    fn is_exact(&self) -> bool {
        let last = &self.tangent[TERMS - 2..];
        last.iter().all(|term| term.length() <= LAST_TERMS)
    }

    /// Point and tangent at the place `x` on the panel, -1 to 1.
    fn at(&self, x: f64) -> (DVec2, DVec2) {
        let [mut point, mut tangent] = [DVec2::ZERO; 2];
        for power in (0..TERMS).rev() {
            tangent = tangent * x + self.tangent[power];
            point = point * x + self.point[power];
        }
        (self.middle + point * x, tangent)
    }
}
