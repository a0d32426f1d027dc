//! Plane curves of polynomial curvature, tabulated with their derivatives by the coefficients, and distances of points from them.

use glam::DVec2;
use whiskmap_mechanics::numerics::gauss::QUADRATURE;
use whiskmap_mechanics::rod::{CURVATURE_TERMS, CurvaturePolynomial};

/// Number of knots of the table per curve length. With the interpolation of order 6, errors are at the level of rounding.
const KNOTS_PER_LENGTH: i32 = 200;

/// Distance between neighbouring knots, in curve lengths.
const STEP: f64 = 1.0 / KNOTS_PER_LENGTH as f64;

/// Knots before the base, for points before it in a fold of the cross-validation.
const KNOTS_BEFORE: i32 = 20;

/// Knots from the base on. They go beyond the end, which moves while a curve is fitted.
const KNOTS_AFTER: i32 = 260;

/// Most Newton steps to the foot of a point. They converge quadratically.
const MOST_STEPS: usize = 20;

/// Rotation and curvature of each term at one place: `[term]`.
#[derive(Clone, Copy)]
struct PlaceTerms {
    turns: [f64; CURVATURE_TERMS],
    bends: [f64; CURVATURE_TERMS],
}

/// Rotation and curvature of each Legendre term at all places of the table. They are the same for all curves.
pub struct CurveTerms {
    knots: Vec<PlaceTerms>,
    /// Terms at the quadrature nodes of each panel, `[panel][node]`.
    nodes: Vec<[PlaceTerms; QUADRATURE.len()]>,
    terms: [CurvaturePolynomial; CURVATURE_TERMS],
}

impl CurveTerms {
    /// Computes the rotation and the curvature of each Legendre term at all places of the table.
    pub fn new() -> Self {
        let terms = std::array::from_fn(|term| {
            let mut one = [0.0; CURVATURE_TERMS];
            one[term] = 1.0;
            CurvaturePolynomial::new(one)
        });
        let at = |place: f64| PlaceTerms {
            turns: terms.map(|term| term.angle(place)),
            bends: terms.map(|term| term.at(place)),
        };
        let knot = |k: i32| f64::from(k) * STEP;
        Self {
            knots: (-KNOTS_BEFORE..=KNOTS_AFTER).map(|k| at(knot(k))).collect(),
            nodes: (-KNOTS_BEFORE..KNOTS_AFTER)
                .map(|k| QUADRATURE.map(|[node, _]| at(node.mul_add(STEP, knot(k)))))
                .collect(),
            terms,
        }
    }
}

/// Curve in units of its length, with its base and the angle of its tangent there.
#[derive(Clone, Copy, Debug)]
pub struct CurvePose {
    /// Position of the curve's base, in units of the curve's length.
    pub base: DVec2,
    /// Angle of the tangent at the base, in radians.
    pub angle: f64,
    /// Coefficients of the Legendre polynomials of the curvature, `[degree]`, in radians, see [`CurvaturePolynomial`].
    pub legendre: [f64; CURVATURE_TERMS],
}

/// Knot of a table: point, tangent and curvature, and the derivatives of the point by each coefficient.
#[derive(Clone, Copy)]
struct Knot {
    point: DVec2,
    tangent: DVec2,
    curvature: f64,
    by: [DVec2; CURVATURE_TERMS],
}

/// Foot of a point: the place on the curve that is nearest to it.
#[derive(Clone, Copy, Debug)]
pub struct Foot {
    /// Place of the foot along the curve, in units of the curve's length from the base.
    pub place: f64,
    /// Signed distance of the point from the curve, in units of the curve's length, positive on the left.
    pub distance: f64,
    /// Unit normal of the curve at the foot, to the left.
    pub normal: DVec2,
    /// Position of the foot, in units of the curve's length.
    pub point: DVec2,
}

/// Table of a curve: points, tangents and curvatures at its knots, with derivatives by the coefficients.
pub struct CurveTable<'a> {
    terms: &'a CurveTerms,
    pose: CurvePose,
    curvature: CurvaturePolynomial,
    knots: Vec<Knot>,
}

fn sum(coefficients: &[f64; CURVATURE_TERMS], terms: &[f64; CURVATURE_TERMS]) -> f64 {
    coefficients.iter().zip(terms).map(|(a, b)| a * b).sum()
}

/// Returns the unit vector of an angle in radians, from the same functions on every machine.
pub fn unit(angle: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(angle);
    DVec2::new(cos, sin)
}

impl<'a> CurveTable<'a> {
    /// Integrates the curve of `pose` by Gauss's rule between neighbouring knots.
    pub fn new(terms: &'a CurveTerms, pose: CurvePose) -> Self {
        let mut point = DVec2::ZERO;
        let mut by = [DVec2::ZERO; CURVATURE_TERMS];
        let mut knots = Vec::with_capacity(terms.knots.len());
        for (k, here) in terms.knots.iter().enumerate() {
            knots.push(Knot {
                point,
                tangent: unit(pose.angle + sum(&pose.legendre, &here.turns)),
                curvature: sum(&pose.legendre, &here.bends),
                by,
            });
            let Some(nodes) = terms.nodes.get(k) else {
                break;
            };
            for (node, [_, weight]) in nodes.iter().zip(QUADRATURE) {
                let tangent = unit(pose.angle + sum(&pose.legendre, &node.turns));
                point += weight * STEP * tangent;
                for (by, turn) in by.iter_mut().zip(node.turns) {
                    *by += weight * STEP * turn * tangent.perp();
                }
            }
        }
        let base = knots[KNOTS_BEFORE as usize];
        for knot in &mut knots {
            knot.point += pose.base - base.point;
            for (by, at_base) in knot.by.iter_mut().zip(base.by) {
                *by -= at_base;
            }
        }
        Self { terms, pose, curvature: CurvaturePolynomial::new(pose.legendre), knots }
    }

    /// Index of the panel of a `place`, and the place in it from 0 to 1.
    fn panel(&self, place: f64) -> (usize, f64) {
        let at = place * f64::from(KNOTS_PER_LENGTH) + f64::from(KNOTS_BEFORE);
        let panel = (at.max(0.0) as usize).min(self.knots.len() - 2);
        (panel, at - panel as f64)
    }

    /// Point of the curve at a `place`, by the polynomial of degree 5 with the point, tangent and curvature of both knots.
    fn point(&self, place: f64) -> DVec2 {
        let (panel, x) = self.panel(place);
        let [from, to] = [self.knots[panel], self.knots[panel + 1]];
        let half = |knot: &Knot| 0.5 * STEP * STEP * knot.curvature * knot.tangent.perp();
        let (first, bend) = (STEP * from.tangent, half(&from));
        // What the Taylor polynomial of the first knot misses at the second: of the point, the slope and half the bend.
        let miss = to.point - from.point - first - bend;
        let miss_slope = STEP * to.tangent - first - 2.0 * bend;
        let miss_bend = half(&to) - bend;
        let a = 10.0 * miss - 4.0 * miss_slope + miss_bend;
        let b = -15.0 * miss + 7.0 * miss_slope - 2.0 * miss_bend;
        let c = 6.0 * miss - 3.0 * miss_slope + miss_bend;
        from.point + x * (first + x * (bend + x * (a + x * (b + x * c))))
    }

    /// Returns the derivative of the foot's signed distance by each coefficient at a fixed point, `[degree]`, in units of the curve's length.
    pub fn distance_by(&self, foot: &Foot) -> [f64; CURVATURE_TERMS] {
        let (panel, x) = self.panel(foot.place);
        let [from, to] = [panel, panel + 1].map(|k| (self.knots[k], self.terms.knots[k]));
        std::array::from_fn(|term| {
            // Cubic, with the slopes at both knots.
            let slope =
                |(knot, terms): (Knot, PlaceTerms)| STEP * terms.turns[term] * knot.tangent.perp();
            let (first, last) = (slope(from), slope(to));
            let rise = to.0.by[term] - from.0.by[term];
            let square = 3.0 * rise - 2.0 * first - last;
            let cube = first + last - 2.0 * rise;
            let by = from.0.by[term] + x * (first + x * (square + x * cube));
            -foot.normal.dot(by)
        })
    }

    /// Returns the foot of `point`, searched from the place `near` on. All are in units of the curve's length.
    pub fn foot(&self, point: DVec2, near: f64) -> Foot {
        let far = |k: usize| self.knots[k].point.distance_squared(point);
        let mut nearest = self.panel(near).0;
        while nearest + 1 < self.knots.len() && far(nearest + 1) < far(nearest) {
            nearest += 1;
        }
        while nearest > 0 && far(nearest - 1) < far(nearest) {
            nearest -= 1;
        }
        let place_of =
            |k: usize| (k as f64 - f64::from(KNOTS_BEFORE)) / f64::from(KNOTS_PER_LENGTH);
        let last = self.knots.len() - 1;
        let ends = [nearest.saturating_sub(1), (nearest + 1).min(last)].map(place_of);
        let mut place = place_of(nearest);
        let mut foot = self.foot_at(point, place);
        for _ in 0..MOST_STEPS {
            let along = (point - foot.point).dot(-foot.normal.perp());
            let slowed = 1.0 - foot.distance * self.curvature.at(place);
            let next = (place + along / slowed.max(0.1)).clamp(ends[0], ends[1]);
            let step = (next - place).abs();
            place = next;
            foot = self.foot_at(point, place);
            if step < 4.0 * f64::EPSILON {
                break;
            }
        }
        foot
    }

    fn foot_at(&self, point: DVec2, place: f64) -> Foot {
        let normal = unit(self.pose.angle + self.curvature.angle(place)).perp();
        let foot_point = self.point(place);
        Foot { place, distance: (point - foot_point).dot(normal), normal, point: foot_point }
    }

    /// Returns the coefficients `[degree]` of the part of the curve from its base to the place `end`, in radians, in units of the part's length.
    pub fn part(&self, end: f64) -> [f64; CURVATURE_TERMS] {
        let mut legendre = [0.0; CURVATURE_TERMS];
        for k in 0..KNOTS_PER_LENGTH {
            for [node, weight] in QUADRATURE {
                let place = STEP * (f64::from(k) + node);
                let curvature = end * self.curvature.at(end * place);
                for ((degree, coefficient), term) in
                    legendre.iter_mut().enumerate().zip(self.terms.terms)
                {
                    let norm = (2 * degree + 1) as f64;
                    *coefficient += norm * STEP * weight * curvature * term.at(place);
                }
            }
        }
        legendre
    }
}
