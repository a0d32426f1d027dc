//! The coordinate `u` along the whisker in which the columns of a sheet are even.

use crate::rod::{Rod, arclength};

/// `ln tau + tau`, and minus the logarithm of the modulus where that falls toward the tip: continued beyond the tip, it
/// would become 0.
pub fn u_of(rod: &Rod, tau: f64) -> f64 {
    let softening = if rod.gradient < 0.0 {
        rod.modulus(arclength(rod, tau)).ln()
    } else {
        0.0
    };
    tau.ln() + tau - softening
}

/// `du/dln tau`.
pub fn slope_of_u(rod: &Rod, tau: f64) -> f64 {
    let mut slope = 1.0 + tau;
    if rod.gradient < 0.0 {
        let s = arclength(rod, tau);
        slope -= rod.gradient * rod.radius(tau) * tau / rod.modulus(s);
    }
    slope
}

/// Inverse of [`u_of`] by Newton's method for `ln tau` from `near`, bisecting where a step would leave the bracket.
pub fn tau_of(rod: &Rod, u: f64, near: f64) -> f64 {
    let softening = (-rod.gradient).max(0.0);
    let end = if softening > rod.taper {
        rod.tau(1.0 / softening)
    } else {
        f64::INFINITY
    };
    let most = if u < 1.0 { u.exp() } else { u };
    let (mut low, mut high) = (0.0, most.min(end));
    let mut tau = if near < high { near } else { 0.5 * high };
    for _ in 0..100 {
        let miss = u_of(rod, tau) - u;
        if miss > 0.0 {
            high = tau;
        } else {
            low = tau;
        }
        let newton = tau * (-miss / slope_of_u(rod, tau)).exp();
        let next = if low < newton && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        // The square of the step is left.
        if (next - tau).abs() <= 1e-9 * tau {
            return next;
        }
        tau = next;
    }
    tau
}
