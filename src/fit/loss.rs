//! Losses of residuals: the squares, and two that grow slower than squares beyond one standard deviation.

use crate::names::names;

/// Loss of a residual `r` in standard deviations of its point, as in scipy's `least_squares` with `f_scale` 1. A fit minimises the sum of the
/// losses.
///
/// ```
/// use whiskmap::fit::FitLoss;
///
/// for loss in [FitLoss::Squares, FitLoss::SoftL1, FitLoss::Huber] {
///     assert!((loss.of(0.01) - 1e-4).abs() < 1e-8);
/// }
/// assert_eq!(FitLoss::Huber.of(10.0), 19.0);
/// assert_eq!(FitLoss::Huber.weight(10.0), 0.1);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum FitLoss {
    /// The square `r^2`: an outlier pulls with all of its distance.
    #[default]
    Squares,
    /// `2 (sqrt(1 + r^2) - 1)`: smooth, and linear far away.
    SoftL1,
    /// Huber's loss: `r^2` up to one standard deviation, then the line `2 |r| - 1`.
    Huber,
}

names!(FitLoss { Squares = "squares", SoftL1 = "soft-l1", Huber = "huber" });

impl FitLoss {
    /// Returns the loss of a residual of `r` standard deviations.
    #[must_use]
    pub fn of(self, r: f64) -> f64 {
        match self {
            Self::Squares => r * r,
            // The difference of the root from 1, without cancellation.
            Self::SoftL1 => 2.0 * r * r / (libm::hypot(1.0, r) + 1.0),
            Self::Huber if r.abs() <= 1.0 => r * r,
            Self::Huber => 2.0 * r.abs() - 1.0,
        }
    }

    /// Returns the weight of a residual of `r` standard deviations: the slope of the loss over the slope of the square, between 0 and 1.
    #[must_use]
    pub fn weight(self, r: f64) -> f64 {
        match self {
            Self::Squares => 1.0,
            Self::SoftL1 => 1.0 / libm::hypot(1.0, r),
            Self::Huber => 1.0 / r.abs().max(1.0),
        }
    }

    /// Returns the derivative of `weight(r) r` by `r`.
    pub(super) fn curvature(self, r: f64) -> f64 {
        match self {
            Self::Squares => 1.0,
            Self::SoftL1 => self.weight(r).powi(3),
            Self::Huber => f64::from(u8::from(r.abs() <= 1.0)),
        }
    }

    /// Returns the signed root of the loss of `r`: the sum of the squares of these is the sum of the losses.
    pub(super) fn root(self, r: f64) -> f64 {
        match self {
            Self::Squares => r,
            _ => r.signum() * self.of(r).sqrt(),
        }
    }

    /// Returns the derivative of [`Self::root`] by `r`, from its value `root`.
    pub(super) fn root_slope(self, root: f64) -> f64 {
        let loss = root * root;
        match self {
            Self::Squares => 1.0,
            // sqrt(1 + r^2) = 1 + loss/2, so that r^2 = loss (1 + loss/4); the slope is weight * r / root.
            Self::SoftL1 => (1.0 + 0.25 * loss).sqrt() / (1.0 + 0.5 * loss),
            Self::Huber => 1.0 / root.abs().max(1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of scipy 1.17.1: `rho(r^2)` and its derivative of the losses `soft_l1` and `huber` in `least_squares`.
    #[test]
    fn losses_are_those_of_scipy() {
        for (r, loss, value, slope) in [
            (0.5, FitLoss::SoftL1, 0.236_067_977_499_789_8, 0.894_427_190_999_915_8),
            (3.0, FitLoss::SoftL1, 4.324_555_320_336_759, 0.316_227_766_016_837_94),
            (0.5, FitLoss::Huber, 0.25, 1.0),
            (3.0, FitLoss::Huber, 5.0, 1.0 / 3.0),
            (3.0, FitLoss::Squares, 9.0, 1.0),
        ] {
            assert!((loss.of(r) - value).abs() < 1e-14, "{loss:?} {r}");
            assert!((loss.weight(r) - slope).abs() < 1e-15, "{loss:?} {r}");
        }
    }

    /// The closed derivatives equal central differences.
    #[test]
    fn slopes_are_those_of_the_roots() {
        for loss in FitLoss::ALL {
            for r in [-20.0, -1.5, -0.3, 1e-3, 0.9, 1.1, 50.0] {
                let step = 1e-6;
                let difference =
                    |of: &dyn Fn(f64) -> f64| (of(r + step) - of(r - step)) / (2.0 * step);
                let slope = loss.root_slope(loss.root(r));
                assert!((slope - difference(&|r| loss.root(r))).abs() < 1e-8, "{loss:?} {r}");
                let pull = difference(&|r| loss.weight(r) * r);
                assert!((loss.curvature(r) - pull).abs() < 1e-8, "{loss:?} {r}");
                // The rounding of the difference grows with the loss: up to 5e-11 of the loss was measured.
                let half = 0.5 * difference(&|r| loss.of(r));
                let most = 1e-9 * (1.0 + loss.of(r));
                assert!((half - loss.weight(r) * r).abs() < most, "{loss:?} {r}");
            }
        }
    }
}
