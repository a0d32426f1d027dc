//! The covariance of parameters, from the Jacobian of the residuals.

use crate::least_squares::{FAINT, Svd, dot, norm};

/// Largest component in directions without a singular value, of 1, of a parameter that is determined.
const PART: f64 = 1e-3;

/// Variances and covariances of parameters, for residuals of variance 1.
pub(super) struct Covariance {
    matrix: Vec<Vec<f64>>,
    /// Number of directions of parameters that the residuals determine.
    pub rank: usize,
    is_determined: Vec<bool>,
}

impl Covariance {
    /// Computes the covariance from the columns of a Jacobian, scaled to length 1, `[parameter][residual]`. A parameter is determined if
    /// it takes no part in a direction along which the residuals stay as they are.
    pub fn new(jacobian: &[Vec<f64>]) -> Self {
        let count = jacobian.len();
        let lengths: Vec<f64> = jacobian.iter().map(|column| norm(column)).collect();
        let longest = lengths.iter().copied().fold(0.0, f64::max);
        let scales = lengths.iter().map(|length| match length / longest {
            part if part > FAINT => 1.0 / length,
            _ => 0.0,
        });
        let scales: Vec<f64> = scales.collect();
        let columns = jacobian
            .iter()
            .zip(&scales)
            .map(|(column, scale)| column.iter().map(|entry| entry * scale).collect());
        let svd = Svd::new(columns.collect());
        let mut matrix = vec![vec![0.0; count]; count];
        let mut free = vec![0.0; count];
        let mut rank = 0;
        for (value, direction, _) in svd.values() {
            if value > FAINT * svd.largest() {
                let step: Vec<f64> = direction
                    .iter()
                    .zip(&scales)
                    .map(|(component, scale)| component * scale / value)
                    .collect();
                for (row, row_step) in matrix.iter_mut().zip(&step) {
                    row.iter_mut()
                        .zip(&step)
                        .for_each(|(sum, column_step)| *sum += row_step * column_step);
                }
                rank += 1;
            } else {
                free.iter_mut().zip(direction).for_each(|(free, part)| *free += part * part);
            }
        }
        Self { matrix, rank, is_determined: free.iter().map(|free| free.sqrt() < PART).collect() }
    }

    /// Returns the product of the covariance with the `gradient` of a sum by the parameters, `[parameter]`: the Gauss-Newton step against it.
    pub fn step(&self, gradient: &[f64]) -> Vec<f64> {
        self.matrix.iter().map(|row| dot(row, gradient)).collect()
    }

    /// Returns the standard deviation of parameter `i` for residuals of variance 1, in the parameter's unit; `None` if it is not determined.
    pub fn deviation(&self, i: usize) -> Option<f64> {
        self.is_determined[i].then(|| self.matrix[i][i].sqrt())
    }

    /// Returns the correlation of two parameters, between -1 and 1; `None` if one is not determined.
    pub fn correlation(&self, i: usize, j: usize) -> Option<f64> {
        if !(self.is_determined[i] && self.is_determined[j]) {
            return None;
        }
        // The root of a square is exact: the correlation of a parameter with itself is 1.
        let deviations = (self.matrix[i][i] * self.matrix[j][j]).sqrt();
        Some((self.matrix[i][j] / deviations).clamp(-1.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn determined(jacobian: &[Vec<f64>]) -> Vec<bool> {
        let covariance = Covariance::new(jacobian);
        let all = 0..jacobian.len();
        all.map(|i| covariance.deviation(i).is_some()).collect()
    }

    /// A short column is like none, and two nearly parallel columns are like one.
    #[test]
    fn a_faint_column_or_direction_is_not_determined() {
        for (size, is_seen) in [(2e-6, true), (0.5e-6, false)] {
            let short = [vec![1.0, 0.0], vec![0.0, size]];
            assert_eq!(determined(&short), [true, is_seen], "{size}");
            // The singular values of two unit vectors are their half sum and half difference.
            let parallel = [vec![1.0, 0.0], vec![1.0, 2.0 * size]];
            assert_eq!(determined(&parallel), [is_seen; 2], "{size}");
        }
    }

    /// The residuals stay as they are if the parameters change by `(part, 1, -1)`.
    #[test]
    fn a_parameter_with_a_part_in_a_free_direction_is_not_determined() {
        for (part, is_determined) in [(2e-3, false), (0.5e-3, true)] {
            let jacobian = [vec![1.0, 0.0], vec![0.0, 1.0], vec![part, 1.0]];
            // The direction is of length 1.41.
            assert_eq!(determined(&jacobian), [is_determined, false, false], "{part}");
        }
    }
}
