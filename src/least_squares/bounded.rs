//! Least squares inside limits.

use super::{Svd, dot, minimise, norm};

/// Residual where a problem has none, so large that no step goes there.
const REFUSED: f64 = 1e100;

/// Least singular value over the largest, and least column over the longest, that counts: the steps of least squares and measured
/// values are not more exact.
pub const FAINT: f64 = 1e-6;

/// Residuals as a function of parameters with limits.
pub trait BoundedProblem {
    /// Residuals at some parameters, `[residual]`, alone or with what else the Jacobian there needs.
    type Place: AsRef<[f64]>;

    /// Number of residuals.
    fn count(&self) -> usize;

    /// Returns the residuals at the parameters `x`; `None` where there are none.
    fn residuals(&self, x: &[f64]) -> Option<Self::Place>;

    /// Returns the columns of the Jacobian at `x`, where the residuals are `place`: `[parameter][residual]`.
    fn jacobian(&self, x: &[f64], place: &Self::Place) -> Option<Vec<Vec<f64>>>;

    /// Returns the range `[least, greatest]` of each parameter with the others as in `x`: `[parameter]`.
    fn ranges(&self, x: &[f64]) -> Vec<[f64; 2]>;
}

/// Place of a search.
enum SearchPlace<P> {
    Known(P),
    /// The problem has no residuals there, but for [`REFUSED`] ones: `[residual]`.
    Refused(Vec<f64>),
}

impl<P: AsRef<[f64]>> AsRef<[f64]> for SearchPlace<P> {
    fn as_ref(&self) -> &[f64] {
        match self {
            Self::Known(place) => place.as_ref(),
            Self::Refused(residuals) => residuals,
        }
    }
}

/// Returns the parameters at the minimum of the sum of squares to which a search from `start` leads, and the sum there.
///
/// Beyond a limit the residuals are continued as they are at the limit. Limits depend on the other parameters, and one that was
/// met may be left again: while the sum shrinks, the iteration starts again from where it has ended. Parameters on which no residual
/// depends stay, and so do parameters together along a direction on which none depends: rounding of the residuals would decide where they end.
///
/// # Errors
/// The reason why the iteration ends before it converges; `no_jacobian` if a Jacobian is missing.
pub fn search<P: AsRef<[f64]>>(
    problem: &impl BoundedProblem<Place = P>,
    start: &[f64],
    tolerance: f64,
    no_jacobian: &'static str,
) -> Result<(Vec<f64>, f64), &'static str> {
    let (mut best, mut least) = (start.to_vec(), f64::INFINITY);
    loop {
        let ranges = problem.ranges(&best);
        let inside = |x: &[f64]| -> Vec<f64> {
            let pairs = x.iter().zip(&ranges);
            pairs.map(|(x, [least, most])| x.clamp(*least, *most)).collect()
        };
        let residuals = |x: &[f64]| {
            let refused = || SearchPlace::Refused(vec![REFUSED; problem.count()]);
            problem.residuals(&inside(x)).map_or_else(refused, SearchPlace::Known)
        };
        // The columns of parameters that are beyond a limit, or would go there, are 0.
        let jacobian = |x: &[f64], place: &SearchPlace<P>| {
            let columns = match place {
                SearchPlace::Known(place) => problem.jacobian(&inside(x), place),
                SearchPlace::Refused(_) => None,
            };
            let mut columns = columns.ok_or(no_jacobian)?;
            clear_faint(&mut columns);
            for ((column, [least, most]), x) in columns.iter_mut().zip(&ranges).zip(x) {
                let growth = dot(column, place.as_ref());
                let is_held = x < least
                    || x > most
                    || x == least && growth > 0.0
                    || x == most && growth < 0.0;
                if is_held {
                    column.fill(0.0);
                }
            }
            clear_faint_directions(&mut columns);
            Ok(columns)
        };
        let (end, sum) = minimise(residuals, jacobian, best.clone(), tolerance)?;
        let end = inside(&end);
        let is_at_limit = end.iter().zip(&ranges).any(|(x, range)| range.contains(x));
        let is_better = sum < least * (1.0 - tolerance);
        if is_better {
            (best, least) = (end, sum);
        }
        if !(is_better && is_at_limit) {
            return Ok((best, least));
        }
    }
}

/// Clears the columns that are so short that rounding may have made them.
fn clear_faint(columns: &mut [Vec<f64>]) {
    let longest = columns.iter().map(|column| norm(column)).fold(0.0, f64::max);
    for column in columns {
        if norm(column) <= FAINT * longest {
            column.fill(0.0);
        }
    }
}

/// Takes from the columns what they change along directions of parameters so faint that rounding may have made it. Parameters are scaled by the
/// lengths of their columns.
fn clear_faint_directions(columns: &mut [Vec<f64>]) {
    let lengths: Vec<f64> = columns.iter().map(|column| norm(column)).collect();
    let known: Vec<usize> = (0..columns.len()).filter(|i| lengths[*i] > 0.0).collect();
    let unit = |i: &usize| {
        let column = columns[*i].iter();
        column.map(|entry| entry / lengths[*i]).collect()
    };
    let svd = Svd::new(known.iter().map(unit).collect());
    let largest = svd.largest();
    let faint = svd.values().filter(|(value, ..)| *value <= FAINT * largest);
    for (_, direction, image) in faint {
        for (part, i) in direction.iter().zip(&known) {
            let pairs = columns[*i].iter_mut().zip(image);
            pairs.for_each(|(entry, change)| *entry -= part * change * lengths[*i]);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    /// Two parameters of which the residuals know the sum alone, and another one, with the rounding of trajectories.
    struct Sum;

    impl BoundedProblem for Sum {
        type Place = Vec<f64>;

        fn count(&self) -> usize {
            8
        }

        fn residuals(&self, x: &[f64]) -> Option<Vec<f64>> {
            let rounding = |i: usize| 1e-13 * libm::sin(1e9 * (x[0] - 2.0 * x[1]) + i as f64);
            let residual = |i: usize| {
                let slope = 1.0 + i as f64;
                slope * (x[0] + x[1] - 4.0) + libm::sin(slope) * (x[2] - 1.0) + rounding(i)
            };
            Some((0..self.count()).map(residual).collect())
        }

        fn jacobian(&self, x: &[f64], _: &Vec<f64>) -> Option<Vec<Vec<f64>>> {
            let rounding = |i: usize| 1e-12 * libm::cos(1e9 * x[0] + i as f64);
            let by_sum = |i: usize| 1.0 + i as f64;
            let other = |i: usize| libm::sin(1.0 + i as f64);
            let all = 0..self.count();
            Some(vec![
                all.clone().map(by_sum).collect(),
                all.clone().map(|i| by_sum(i) + rounding(i)).collect(),
                all.map(other).collect(),
            ])
        }

        fn ranges(&self, _: &[f64]) -> Vec<[f64; 2]> {
            vec![[-100.0, 100.0]; 3]
        }
    }

    /// Parameters whose sum alone counts move by equal amounts, and rounding does not move them.
    #[test]
    fn parameters_stay_along_a_direction_without_change() {
        let (end, sum) = search(&Sum, &[1.0, 2.0, 0.0], 1e-12, "").unwrap();
        let off = end.iter().zip([1.5, 2.5, 1.0]).map(|(x, known)| (x - known).abs());
        assert!(off.fold(0.0, f64::max) < 1e-9 && sum < 1e-20, "{end:?} {sum:e}");
    }
}
