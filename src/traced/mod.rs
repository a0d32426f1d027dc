//! Traced shapes: smooth curves of polynomial curvature through the points of a resting whisker.
//!
//! The curve minimises the squares of the points' distances from it (`curve_fit`). Its base is the foot of the first point, its tip that
//! of the last point. The whisker's frame has its origin at the base, and the tangent there as its first axis: position and angle of the
//! points do not matter. The curvature is a polynomial of the arclength over the length, so a whisker of another length has the same
//! shape at another scale.

mod curve;
mod curve_fit;

use crate::least_squares::smallest_degree;
pub(crate) use curve::unit;
pub use curve_fit::MOST_DEGREE;
use curve_fit::{CurveFit, EXACT, TracedPoints};
use glam::DVec2;
use rayon::prelude::*;
use std::sync::atomic::AtomicBool;
use whiskmap_mechanics::rod::{CURVATURE_TERMS, CurvaturePolynomial};

/// Points more than the degree that a fit needs: three for length and pose, and one to have a distance left.
const MORE_POINTS: usize = 4;

/// Most points of a fit. It takes 3 s, and a whisker needs far fewer.
const MOST_POINTS: usize = 50_000;

/// Fewest points from which cross-validation chooses a degree.
const FEWEST_POINTS: usize = 8;

/// Largest coordinate of a point, in millimetres.
const FARTHEST_MM: f64 = 1e6;

/// Largest fall of the distance from the first point, over the largest distance: noise, not a fold.
const LARGEST_FALL: f64 = 0.02;

/// Largest root mean square of the points' distances, over the length: points beyond it are no whisker.
pub(crate) const LARGEST_RMS: f64 = 0.02;

/// Largest difference of coefficients that two machines may fit, in radians.
const SAME_FIT: f64 = 1e-6;

/// Shape of a resting whisker, fitted to points that were traced along it.
///
/// ```
/// use whiskmap::traced::TracedShape;
///
/// // A quarter of a circle of radius 10 mm.
/// let point = |i: u32| {
///     let angle = f64::from(i) * 0.5 * std::f64::consts::PI / 30.0;
///     [10.0 * angle.sin(), 10.0 * (1.0 - angle.cos())]
/// };
/// let points: Vec<[f64; 2]> = (0..=30).map(point).collect();
/// let shape = TracedShape::fit(points, None)?;
/// assert_eq!(shape.degree, 0);
/// assert!((shape.length_mm - 15.707_963).abs() < 1e-6 && shape.rms_mm < 1e-9);
/// # Ok::<(), whiskmap::traced::TracedError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TracedShape {
    /// Points from base to tip, as given: `[point][x, y]`, in millimetres.
    pub points_mm: Vec<[f64; 2]>,
    /// Degree of the curvature as a polynomial of the arclength.
    pub degree: usize,
    /// True if cross-validation chose the degree.
    pub is_degree_chosen: bool,
    /// Curvature at rest over the whisker's length.
    pub curvature: CurvaturePolynomial,
    /// Length of the curve from base to tip, in millimetres.
    pub length_mm: f64,
    /// Root mean square of the distances of the points from the curve, in millimetres.
    pub rms_mm: f64,
    /// Largest distance of a point from the curve, in millimetres.
    pub farthest_mm: f64,
    /// Base of the whisker in the frame of the points, `[x, y]`, in millimetres.
    pub base_mm: [f64; 2],
    /// Angle of the tangent at the base in the frame of the points, in radians.
    pub base_angle: f64,
}

/// Error of traced points: what is wrong, what is allowed, and with which point.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{must}", point.map_or_else(String::new, |point| format!("points[{point}]: ")))]
pub struct TracedError {
    /// Index of the point; `None` if all points together are wrong.
    pub point: Option<usize>,
    /// Message: what is wrong, and what is allowed.
    pub must: String,
}

impl TracedError {
    fn at(point: usize, must: impl Into<String>) -> Self {
        let must = must.into();
        Self { point: Some(point), must }
    }

    fn whole(must: impl Into<String>) -> Self {
        let must = must.into();
        Self { point: None, must }
    }
}

impl TracedShape {
    /// Fits a curve to points from base to tip, `[point][x, y]` in millimetres. Its curvature has the given degree, at most
    /// [`MOST_DEGREE`]. Without one, cross-validation chooses the degree.
    ///
    /// # Errors
    /// If there are too few points or more than 50,000, one is no number, repeats the one before it or folds back toward the base, or the points lie off
    /// every such curve.
    pub fn fit(points_mm: Vec<[f64; 2]>, degree: Option<usize>) -> Result<Self, TracedError> {
        Self::fit_until(points_mm, degree, &AtomicBool::new(false))
    }

    /// Fits a curve as [`TracedShape::fit`] does, until `cancel` becomes true.
    ///
    /// # Errors
    /// As [`TracedShape::fit`], and after a cancellation.
    pub fn fit_until(
        points_mm: Vec<[f64; 2]>,
        degree: Option<usize>,
        cancel: &AtomicBool,
    ) -> Result<Self, TracedError> {
        let most = most_degree(points_mm.len(), degree)?;
        let reach = check(&points_mm)?;
        let points: Vec<DVec2> = points_mm.iter().map(|point| (*point).into()).collect();
        let traced = TracedPoints::new(&points, cancel);
        let failed = |why| {
            TracedError::whole(format!(
                "must lie along a smooth curve: the fit to it does not converge ({why})"
            ))
        };
        let mut curves = traced.curves(most).map_err(failed)?;
        let chosen = match degree {
            Some(degree) => degree,
            None => traced.choose(&curves).map_err(failed)?,
        };
        let CurveFit { length, pose, distances, .. } = curves.swap_remove(chosen);
        let squares = distances.iter().map(|distance| distance * distance).sum::<f64>();
        let rms_mm = (squares / distances.len() as f64).sqrt();
        // A length of NaN is not long enough either.
        let is_whisker = rms_mm <= LARGEST_RMS * length && length >= (1.0 - LARGEST_FALL) * reach;
        if !is_whisker {
            let must = format!(
                "must lie along a smooth curve: their rms distance from the curve of degree {chosen} is {rms_mm:.3e} mm, more than {} \
                 of its length {length:.6} mm",
                LARGEST_RMS
            );
            return Err(TracedError::whole(must));
        }
        Ok(Self {
            points_mm,
            degree: chosen,
            is_degree_chosen: degree.is_none(),
            curvature: CurvaturePolynomial::new(pose.legendre),
            length_mm: length,
            rms_mm,
            farthest_mm: distances.iter().fold(0.0, |most, distance| distance.abs().max(most)),
            base_mm: pose.base.into(),
            base_angle: pose.angle,
        })
    }

    /// Replaces the fitted coefficients of the curvature by the coefficients of an equal fit on another machine, `[degree]`, in radians.
    ///
    /// # Errors
    /// If the number of coefficients is wrong, or one differs from the fit to the points by more than 1e-6 radians.
    pub fn with_coefficients(mut self, coefficients: &[f64]) -> Result<Self, TracedError> {
        let fitted = &self.coefficients();
        let is_same = fitted.len() == coefficients.len()
            && fitted
                .iter()
                .zip(coefficients)
                .all(|(fitted, other)| (fitted - other).abs() <= SAME_FIT);
        if !is_same {
            let must = format!(
                "must be left out, or be the coefficients of the fit to the points ({fitted:?})"
            );
            return Err(TracedError::whole(must));
        }
        let mut legendre = [0.0; CURVATURE_TERMS];
        legendre[..coefficients.len()].copy_from_slice(coefficients);
        self.curvature = CurvaturePolynomial::new(legendre);
        Ok(self)
    }

    /// Returns the coefficients of the curvature over the length, `[degree]`, in radians, of Legendre polynomials of `2 s/L - 1`.
    #[must_use]
    pub fn coefficients(&self) -> Vec<f64> {
        self.curvature.legendre()[..=self.degree].to_vec()
    }

    /// Returns the points in the frame of the base of a whisker of this length, where the base's tangent is the first axis:
    /// `[point][x, y]`, in millimetres.
    #[must_use]
    pub fn points_at_rest_mm(&self, length_mm: f64) -> Vec<[f64; 2]> {
        let (sin, cos) = libm::sincos(self.base_angle);
        let (base, scale) = (DVec2::from(self.base_mm), length_mm / self.length_mm);
        let back = scale * DVec2::new(cos, -sin);
        let points = self.points_mm.iter();
        points.map(|point| back.rotate(DVec2::from(*point) - base).into()).collect()
    }
}

/// Returns the degree of the curvature for all of several shapes, `[shape][point][x, y]` from base to tip, by cross-validation of all of their
/// points together; `None` if none of them has a curve. All have at least 8 points.
pub(crate) fn common_degree(shapes: &[Vec<[f64; 2]>], cancel: &AtomicBool) -> Option<usize> {
    let squares = shapes.par_iter().filter_map(|points_mm| {
        let most = most_degree(points_mm.len(), None).ok()?;
        check(points_mm).ok()?;
        let points: Vec<DVec2> = points_mm.iter().map(|point| (*point).into()).collect();
        let traced = TracedPoints::new(&points, cancel);
        traced.all_left_out(&traced.curves(most).ok()?).ok()
    });
    let squares: Vec<Vec<Vec<f64>>> = squares.collect();
    let most = squares.iter().map(Vec::len).min()?;
    let pooled =
        |degree: usize| squares.iter().flat_map(|by_degree| by_degree[degree].clone()).collect();
    let pooled: Vec<Vec<f64>> = (0..most).map(pooled).collect();
    Some(smallest_degree(&pooled, EXACT))
}

/// Returns the largest degree of the curves to fit to `count` points.
fn most_degree(count: usize, degree: Option<usize>) -> Result<usize, TracedError> {
    if count > MOST_POINTS {
        let must = format!(
            "must be at most {MOST_POINTS} points, are {count}: leave out points, such as all but every {}th",
            count.div_ceil(MOST_POINTS).next_multiple_of(10)
        );
        return Err(TracedError::whole(must));
    }
    let needed = match degree {
        Some(degree) if degree > MOST_DEGREE => {
            let must = format!("must have a degree from 0 to {MOST_DEGREE}, is {degree}");
            return Err(TracedError::whole(must));
        }
        Some(degree) => degree + MORE_POINTS,
        None => FEWEST_POINTS,
    };
    if count < needed {
        let why = degree.map_or_else(
            || "to choose the degree by cross-validation".to_owned(),
            |degree| format!("for the degree {degree}"),
        );
        let must = format!("must be at least {needed} points {why}, are {count}");
        return Err(TracedError::whole(must));
    }
    // A fold of the cross-validation leaves out a tenth.
    let kept = count - count.div_ceil(10);
    Ok(degree.unwrap_or_else(|| (kept - MORE_POINTS).min(MOST_DEGREE)))
}

/// Checks each point, and returns the largest distance from the first one, in millimetres.
fn check(points_mm: &[[f64; 2]]) -> Result<f64, TracedError> {
    let far = |[x, y]: [f64; 2]| libm::hypot(x - points_mm[0][0], y - points_mm[0][1]);
    let largest = points_mm.iter().fold(0.0, |most: f64, point| most.max(far(*point)));
    let mut reach = 0.0_f64;
    for (i, &[x, y]) in points_mm.iter().enumerate() {
        let is_near = |coordinate: f64| coordinate.abs() <= FARTHEST_MM;
        if !(is_near(x) && is_near(y)) {
            return Err(TracedError::at(
                i,
                format!("x_mm and y_mm must be numbers between -1e6 and 1e6, are {x:e} and {y:e}"),
            ));
        }
        if i > 0 && points_mm[i - 1] == [x, y] {
            let must = format!("must differ from the point before it ({x}, {y})");
            return Err(TracedError::at(i, must));
        }
        let distance = far([x, y]);
        let noise = LARGEST_FALL * largest;
        if distance < reach - noise {
            let must = format!(
                "must not fold back: it is {distance:.4} mm from the first point, a point before it {reach:.4} mm; \
                 at most {noise:.4} mm, {LARGEST_FALL} of the largest distance, is taken for noise"
            );
            return Err(TracedError::at(i, must));
        }
        reach = reach.max(distance);
    }
    Ok(reach)
}
