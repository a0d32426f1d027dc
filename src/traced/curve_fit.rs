//! Least squares of distances of points from a curve of polynomial curvature, and the choice of the degree.
//!
//! The unknowns are the coefficients of the curvature, the angle of the tangent at the base, and the distance of the base from the
//! first point, across the curve. The base is the foot of the first point, and the tip is the foot of the last point. The curve is fitted
//! by Levenberg and Marquardt's method; the foot of each point follows the curve.

use super::curve::{CurvePose, CurveTable, CurveTerms, Foot};
use crate::least_squares::{minimise, smallest_degree};
use glam::DVec2;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::rod::CURVATURE_TERMS;

/// Largest degree of the curvature of a fitted curve, as a polynomial of the arclength.
pub const MOST_DEGREE: usize = CURVATURE_TERMS - 1;

/// Folds of the cross-validation: the share of the points that each fit leaves out, a common choice.
const FOLDS: usize = 10;

/// Most points of the cross-validation, which takes four fifths of the time; 5000 take 1.5 s.
const MOST_VALIDATED: usize = 5000;

/// Relative change of the sum of squares, and of the unknowns, below which the iteration ends.
const TOLERANCE: f64 = 1e-13;

/// Squared distance, in units of the squared length, that counts as 0: points from an exact curve.
pub const EXACT: f64 = 1e-24;

/// Number of points along which the length is estimated before the first fit: noise hardly lengthens so coarse a line.
const COARSE: usize = 16;

/// Curve fitted through points, in the unit of the points, with the distances of the points.
#[derive(Clone)]
pub struct CurveFit {
    /// Length of the fitted curve from base to tip, in the unit of the points.
    pub length: f64,
    /// Base (in the unit of the points), angle at the base and curvature of the fitted curve.
    pub pose: CurvePose,
    /// Signed distances of the points from the fitted curve, `[point]`, in the unit of the points.
    pub distances: Vec<f64>,
    /// Unknowns of the curve, in units of `length`.
    unknowns: Vec<f64>,
}

/// Curve during a fit, with the feet of the points that it is fitted to.
struct FittedCurve<'a> {
    table: CurveTable<'a>,
    feet: Vec<Foot>,
    /// Distances of the points from the curve, in units of its length.
    distances: Vec<f64>,
}

impl AsRef<[f64]> for FittedCurve<'_> {
    fn as_ref(&self) -> &[f64] {
        &self.distances
    }
}

/// Points to which curves are fitted.
pub struct TracedPoints<'a> {
    points: &'a [DVec2],
    terms: CurveTerms,
    /// Flag that cancels: if true, fits end with an error.
    cancel: &'a AtomicBool,
}

impl<'a> TracedPoints<'a> {
    /// Prepares fits to `points`, from base to tip, at least two. They end when `cancel` becomes true.
    pub fn new(points: &'a [DVec2], cancel: &'a AtomicBool) -> Self {
        Self { points, terms: CurveTerms::new(), cancel }
    }

    /// Table of the curve with these `unknowns`, in units of `length`, from the first point.
    fn table(&self, unknowns: &[f64]) -> CurveTable<'_> {
        let mut legendre = [0.0; CURVATURE_TERMS];
        legendre[..unknowns.len() - 2].copy_from_slice(&unknowns[2..]);
        let (sin, cos) = libm::sincos(unknowns[0]);
        let base = -unknowns[1] * DVec2::new(-sin, cos);
        let pose = CurvePose { base, angle: unknowns[0], legendre };
        CurveTable::new(&self.terms, pose)
    }

    /// Feet of some points on a curve, in units of `length`.
    fn feet(&self, table: &CurveTable<'_>, length: f64, some: &[usize]) -> Vec<Foot> {
        let mut near = 0.0;
        let foot = |index: &usize| {
            let point = (self.points[*index] - self.points[0]) / length;
            let foot = table.foot(point, near);
            near = foot.place;
            foot
        };
        some.iter().map(foot).collect()
    }

    /// Minimises the squares of the distances of some points from `start` on.
    fn minimum(
        &self,
        start: Vec<f64>,
        length: f64,
        some: &[usize],
    ) -> Result<Vec<f64>, &'static str> {
        let curve = |unknowns: &[f64]| {
            let table = self.table(unknowns);
            let feet = self.feet(&table, length, some);
            let distances = feet.iter().map(|foot| foot.distance).collect();
            FittedCurve { table, feet, distances }
        };
        let jacobian = |unknowns: &[f64], curve: &FittedCurve| {
            if self.cancel.load(Ordering::Relaxed) {
                return Err("cancelled");
            }
            let (sin, cos) = libm::sincos(unknowns[0]);
            let (tangent, normal) = (DVec2::new(cos, sin), DVec2::new(-sin, cos));
            let base = -unknowns[1] * normal;
            let mut columns = vec![Vec::with_capacity(some.len()); unknowns.len()];
            for foot in &curve.feet {
                let turned = unknowns[1] * tangent + (foot.point - base).perp();
                columns[0].push(-foot.normal.dot(turned));
                columns[1].push(foot.normal.dot(normal));
                let by = curve.table.distance_by(foot);
                for (column, by) in columns[2..].iter_mut().zip(by) {
                    column.push(by);
                }
            }
            Ok(columns)
        };
        minimise(curve, jacobian, start, TOLERANCE).map(|(unknowns, _)| unknowns)
    }

    /// Fits curves with curvatures of each degree up to `most`: `[degree]`. Each starts from the one before, the first one from a line.
    ///
    /// # Errors
    /// If an iteration does not converge.
    pub fn curves(&self, most: usize) -> Result<Vec<CurveFit>, &'static str> {
        let all: Vec<usize> = (0..self.points.len()).collect();
        let last = self.points.len() - 1;
        let coarse: Vec<DVec2> = (0..=COARSE).map(|i| self.points[last * i / COARSE]).collect();
        let mut length: f64 = coarse.windows(2).map(|w| w[0].distance(w[1])).sum();
        let chord = self.points[last] - self.points[0];
        let mut unknowns = vec![libm::atan2(chord.y, chord.x), 0.0];
        let mut curves = Vec::new();
        for _ in 0..=most {
            unknowns.push(0.0);
            unknowns = self.minimum(unknowns, length, &all)?;
            let table = self.table(&unknowns);
            let feet = self.feet(&table, length, &all);
            let end = feet[last].place;
            let distances = feet.iter().map(|foot| length * foot.distance).collect();
            // The curve is the same in units of its own length.
            let mut part = table.part(end);
            let count = unknowns.len() - 2;
            part[count..].fill(0.0);
            unknowns[2..].copy_from_slice(&part[..count]);
            unknowns[1] /= end;
            length *= end;
            let (sin, cos) = libm::sincos(unknowns[0]);
            curves.push(CurveFit {
                length,
                pose: CurvePose {
                    base: self.points[0] - length * unknowns[1] * DVec2::new(-sin, cos),
                    angle: unknowns[0],
                    legendre: part,
                },
                distances,
                unknowns: unknowns.clone(),
            });
        }
        Ok(curves)
    }

    /// Returns the degree of the best of `curves`, by cross-validation. A tenth of the points is left out at a time, every tenth point. Of
    /// more than [`MOST_VALIDATED`] points, every k-th is used.
    ///
    /// The smallest degree is chosen whose distances of the points that are left out are as good as the least ones ([`smallest_degree`]).
    ///
    /// # Errors
    /// If an iteration does not converge.
    pub fn choose(&self, curves: &[CurveFit]) -> Result<usize, &'static str> {
        Ok(smallest_degree(&self.all_left_out(curves)?, EXACT))
    }

    /// Returns the squared distances of the points of the cross-validation from the curves fitted without them, `[degree][point]`, in units of
    /// the squared length of each curve.
    ///
    /// # Errors
    /// If an iteration does not converge.
    pub fn all_left_out(&self, curves: &[CurveFit]) -> Result<Vec<Vec<f64>>, &'static str> {
        curves.iter().map(|curve| self.left_out(curve)).collect()
    }

    /// Squared distances of the points of the cross-validation from the curves fitted without them, `[point]`, in units of the squared length.
    fn left_out(&self, curve: &CurveFit) -> Result<Vec<f64>, &'static str> {
        let step = self.points.len().div_ceil(MOST_VALIDATED);
        let mut squares = vec![0.0; self.points.len().div_ceil(step)];
        for fold in 0..FOLDS {
            let is_out = |index: &usize| index / step % FOLDS == fold;
            let used = (0..self.points.len()).step_by(step);
            let (out, others): (Vec<usize>, Vec<usize>) = used.partition(is_out);
            if out.is_empty() {
                continue;
            }
            let start = curve.unknowns.clone();
            let unknowns = self.minimum(start, curve.length, &others)?;
            let table = self.table(&unknowns);
            for (index, foot) in out.iter().zip(self.feet(&table, curve.length, &out)) {
                squares[*index / step] = foot.distance * foot.distance;
            }
        }
        Ok(squares)
    }
}
