//! How far points determine parameters: their covariance from the Jacobian of the residuals.

use nalgebra::{DMatrix, DVector};

/// Singular values over the largest, and columns over the longest, that are taken for none: the differences that the
/// Jacobian is made of are not exact enough to tell.
const FAINT: f64 = 1e-6;

/// The part of a direction that is not determined, of 1, that a parameter may have and still be determined.
const PART: f64 = 1e-3;

/// Variances and covariances of parameters, for residuals of variance 1.
pub(super) struct Covariance {
    matrix: DMatrix<f64>,
    /// How many directions are determined.
    pub rank: usize,
    is_determined: Vec<bool>,
}

impl Covariance {
    /// From the singular values of the `jacobian`, whose columns are brought to length 1 first. A parameter is determined
    /// if it takes no part in a direction along which the residuals stay as they are.
    pub fn new(jacobian: &DMatrix<f64>) -> Self {
        let count = jacobian.ncols();
        let lengths: Vec<f64> = jacobian.column_iter().map(|own| own.norm()).collect();
        let longest = lengths.iter().copied().fold(0.0, f64::max);
        let scales = lengths.iter().map(|length| match length / longest {
            part if part > FAINT => 1.0 / length,
            _ => 0.0,
        });
        let scales = DMatrix::from_diagonal(&DVector::from_iterator(count, scales));
        let decomposed = (jacobian * &scales).svd(false, true);
        let largest = decomposed.singular_values.max();
        let mut matrix = DMatrix::zeros(count, count);
        let mut free = vec![0.0; count];
        let mut rank = 0;
        let directions = decomposed.v_t.iter().flat_map(DMatrix::row_iter);
        for (direction, value) in directions.zip(&decomposed.singular_values) {
            if *value > FAINT * largest {
                let step = &scales * direction.transpose() / *value;
                matrix += &step * step.transpose();
                rank += 1;
            } else {
                for (free, part) in free.iter_mut().zip(direction.iter()) {
                    *free += part * part;
                }
            }
        }
        Self {
            matrix,
            rank,
            is_determined: free.iter().map(|free| free.sqrt() < PART).collect(),
        }
    }

    /// Square root of the variance of parameter `i`; `None` if it is not determined.
    pub fn deviation(&self, i: usize) -> Option<f64> {
        self.is_determined[i].then(|| self.matrix[(i, i)].sqrt())
    }

    /// Correlation of two parameters, between -1 and 1; `None` if one is not determined.
    pub fn correlation(&self, i: usize, j: usize) -> Option<f64> {
        let deviations = self.deviation(i)? * self.deviation(j)?;
        Some((self.matrix[(i, j)] / deviations).clamp(-1.0, 1.0))
    }
}
