//! Smooth radii: a polynomial through measured rows, whose degree cross-validation chooses.

use super::error::SceneFault;
use crate::least_squares::smallest_degree;
use crate::quantile::median;

/// Key of the smoothing of measured radii in a scene file.
pub(super) const SMOOTH_KEY: &str = "whisker.profile.smooth";

/// Fewest rows from which cross-validation chooses a degree, as for traced points.
const FEWEST: usize = 8;

/// Largest degree of the radius as a polynomial of the arclength, equal to the largest degree of the curvature of traced shapes.
const MOST_DEGREE: usize = 6;

/// Squared error over the squared radius at the base that counts as 0: rows of an exact polynomial.
const EXACT: f64 = 1e-24;

/// Fewest rows whose scatter is estimated: fewer do not tell errors from shape.
const FEWEST_SCATTERED: usize = 12;

/// Ratio of the standard deviation to the median size of normally distributed numbers.
const SD_OF_MEDIAN: f64 = 1.4826;

/// Measured radii of a whisker, smoothed: a polynomial of the arclength that is fitted to the rows by least squares.
///
/// Cross-validation chooses the degree from 0 (a cylinder) to 6. For each degree, the polynomial through all other rows predicts each row.
/// The chosen degree is the smallest whose mean squared error exceeds the least one by at most the standard error of the difference.
#[derive(Clone, Debug, PartialEq)]
pub struct SmoothRadii {
    /// Rows with the smoothed radii, `[row][arclength, radius]`, in mm and um.
    pub rows: Vec<[f64; 2]>,
    /// Degree of the radius as a polynomial of the arclength.
    pub degree: usize,
    /// Root mean square of the measured less the smoothed radii, in um.
    pub rms_um: f64,
    /// Orthonormal values of polynomials of growing degree at the rows, `[degree][row]`.
    basis: Vec<Vec<f64>>,
}

/// Measured rows of a scene.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MeasuredRadii {
    /// Rows as they are given: `[row][arclength, radius]`, in millimetres and micrometres.
    pub rows: Vec<[f64; 2]>,
    /// True if a polynomial through the rows gives the radii of the whisker.
    pub smooth: bool,
}

impl MeasuredRadii {
    /// Returns the polynomial through the rows, which replaces their radii; `None` without smoothing.
    ///
    /// # Errors
    /// If there are too few rows.
    pub fn smoothed(&self) -> Result<Option<SmoothRadii>, SceneFault> {
        let fit = self.smooth.then(|| SmoothRadii::fit(&self.rows));
        fit.transpose()
    }
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

/// Orthonormal values at `places` of polynomials of the degrees from 0 to `most`, `[degree][place]` (Forsythe, J. SIAM 5, 74, 1957).
fn orthonormal(places: &[f64], most: usize) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for _ in 0..=most {
        let mut next: Vec<f64> = match basis.last() {
            Some(last) => last.iter().zip(places).map(|(value, x)| value * x).collect(),
            None => vec![1.0; places.len()],
        };
        // Twice is enough: the second pass removes what rounding leaves.
        for _ in 0..2 {
            for polynomial in &basis {
                let part = dot(polynomial, &next);
                next.iter_mut().zip(polynomial).for_each(|(x, value)| *x -= part * value);
            }
        }
        let length = dot(&next, &next).sqrt();
        next.iter_mut().for_each(|x| *x /= length);
        basis.push(next);
    }
    basis
}

impl SmoothRadii {
    /// Fits a polynomial to `rows` whose arclengths grow.
    ///
    /// # Errors
    /// If there are fewer than 8 rows.
    pub(super) fn fit(rows: &[[f64; 2]]) -> Result<Self, SceneFault> {
        if rows.len() < FEWEST {
            let must = format!(
                "needs at least {FEWEST} rows to choose the degree by cross-validation, has {}",
                rows.len()
            );
            return Err(SceneFault::of_value(SMOOTH_KEY, "true".to_owned(), must));
        }
        let (from, to) = (rows[0][0], rows[rows.len() - 1][0]);
        let places: Vec<f64> =
            rows.iter().map(|[s, _]| 2.0 * (s - from) / (to - from) - 1.0).collect();
        let radii: Vec<f64> = rows.iter().map(|[_, radius]| *radius).collect();
        let mut basis = orthonormal(&places, MOST_DEGREE.min(rows.len() - 3));
        let mut residuals = radii.clone();
        let mut leverages = vec![0.0; rows.len()];
        // Residuals and squared errors of each row by the polynomial through all others, `[degree][row]`. A leverage is the part of the row's
        // own radius in its fit (Hastie et al., The Elements of Statistical Learning, 2009, equation 7.64).
        let mut left = Vec::new();
        let mut squares = Vec::new();
        for polynomial in &basis {
            let part = dot(polynomial, &residuals);
            let sums = residuals.iter_mut().zip(&mut leverages);
            for ((residual, leverage), value) in sums.zip(polynomial) {
                *residual -= part * value;
                *leverage += value * value;
            }
            let errors = residuals.iter().zip(&leverages);
            squares
                .push(errors.map(|(residual, part)| (residual / (1.0 - part)).powi(2)).collect());
            left.push(residuals.clone());
        }
        let degree = smallest_degree(&squares, EXACT * radii[0] * radii[0]);
        let residuals = left.swap_remove(degree);
        basis.truncate(degree + 1);
        let smooth = rows.iter().zip(&residuals);
        Ok(Self {
            rows: smooth.map(|([s, radius], residual)| [*s, radius - residual]).collect(),
            degree,
            rms_um: (dot(&residuals, &residuals) / rows.len() as f64).sqrt(),
            basis,
        })
    }

    /// Returns the derivatives of all smoothed radii by the measured radius of `row`, `[row]`, at a fixed degree.
    #[must_use]
    pub fn by_measured(&self, row: usize) -> Vec<f64> {
        let by = |other| {
            let polynomials = self.basis.iter();
            let products = polynomials.map(|polynomial| polynomial[row] * polynomial[other]);
            products.sum()
        };
        (0..self.rows.len()).map(by).collect()
    }
}

/// Returns the standard deviation of the radii of `rows` that their neighbours do not explain; `None` for fewer than 12 rows.
///
/// Each second difference, of a radius from the line through its neighbours, is divided by its standard deviation for errors of size 1. The
/// median of their sizes does not depend on a few steps of the whisker. A curved profile has second differences without errors, but these
/// change little from row to row. So their differences count if they are smaller.
pub(super) fn scatter(rows: &[[f64; 2]]) -> Option<f64> {
    if rows.len() < FEWEST_SCATTERED {
        return None;
    }
    let bends = rows.windows(3).map(|rows| {
        let [[a, before], [b, radius], [c, after]] = [rows[0], rows[1], rows[2]];
        let part = (b - a) / (c - a);
        let bend = radius - (1.0 - part) * before - part * after;
        // A scale that is 1 for equal distances, where the standard deviation is sqrt(3/2).
        bend * (1.5 / (1.0 + part * part + (1.0 - part) * (1.0 - part))).sqrt()
    });
    let bends: Vec<f64> = bends.collect();
    let second = median(bends.iter().map(|bend| bend.abs())) / 1.5_f64.sqrt();
    // (-1/2, 1, -1/2) less the same one row later is (-1/2, 3/2, -3/2, 1/2): the sum of the squares is 5.
    let changes = bends.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let third = median(changes) / 5_f64.sqrt();
    Some(SD_OF_MEDIAN * second.min(third))
}
