//! Derivatives of a rod's numbers by a variable, which each trajectory in dual numbers starts from.

use crate::rod::Piece;
use std::sync::Arc;

/// Derivative of the numbers of a [`Rod`](crate::rod::Rod) by a variable. Each field has the unit of the rod's field per unit of the
/// variable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RodDerivative {
    /// Derivative of the rod's taper by the variable, dimensionless per unit of the variable.
    pub taper: f64,
    /// Derivative of the dimensionless coefficient of the parabola at rest, per unit of the variable. It may differ from 0 on a straight rod.
    pub bend: f64,
    /// Derivative of the dimensionless slope of the parabola at rest at the base, per unit of the variable.
    pub slope: f64,
    /// Derivative of the signed pole radius, in whisker lengths per unit of the variable.
    pub pole: f64,
    /// Derivative of the gradient of Young's modulus (per whisker length), per unit of the variable.
    pub gradient: f64,
    /// Derivative of the signed friction coefficient, dimensionless per unit of the variable.
    pub friction: f64,
    /// Derivative of the compliance of the mount, in radians for a moment of `E I_base/L_w`, per unit of the variable.
    pub mount: f64,
    /// Derivatives of the coefficients `[k0, k1]` of the Euler spiral at rest, which are in radians per whisker length, per unit of the variable.
    /// They may differ from 0 on a straight rod.
    pub spiral: [f64; 2],
    /// Derivatives of the pieces of the measured profile, `[piece]`, each field by the variable; `None` if the profile does not change.
    pub pieces: Option<Arc<[Piece]>>,
}

impl RodDerivative {
    /// Returns the derivative of the piece `k` of the measured profile, each field by the variable; 0 if the profile does not change.
    #[must_use]
    pub fn piece(&self, k: usize) -> Piece {
        let piece = self.pieces.as_ref().and_then(|pieces| pieces.get(k));
        piece.copied().unwrap_or(Piece { from: 0.0, tau: 0.0, cubic: [0.0; 4] })
    }
}
