//! The coordinate `u` along the whisker, in which contact nodes are evenly spaced, and polynomials from node to node.

use whiskmap_mechanics::numerics::Bracket;
use whiskmap_mechanics::numerics::newton_form::Polynomial;
use whiskmap_mechanics::rod::{Rod, arclength};

/// Returns the coordinate `u = ln tau + tau` of a contact, dimensionless. Toward the base the sheet depends on the contact through its
/// logarithm, because everything scales; toward a slender tip it depends on `tau`. Where the modulus falls toward the tip, its logarithm
/// is subtracted: continued beyond the tip, the modulus would become 0.
pub fn u_of(rod: &Rod, tau: f64) -> f64 {
    let softening =
        if rod.gradient < 0.0 { libm::log(rod.modulus(arclength(rod, tau))) } else { 0.0 };
    libm::log(tau) + tau - softening
}

/// Returns the derivative `du/dln tau` of the contact coordinate `u` at `tau`, dimensionless.
pub fn slope_of_u(rod: &Rod, tau: f64) -> f64 {
    let mut slope = 1.0 + tau;
    if rod.gradient < 0.0 {
        let s = arclength(rod, tau);
        slope -= rod.gradient * rod.radius(tau) * tau / rod.modulus(s);
    }
    slope
}

/// Relative step in `tau` at which the iteration stops. The remaining error is its square.
const LAST_TAU_STEP: f64 = 1e-9;

/// Returns `tau` of a contact with the coordinate `u` (the inverse of [`u_of`]), by Newton's method for `ln tau` from `near`.
pub fn tau_of(rod: &Rod, u: f64, near: f64) -> f64 {
    let softening = (-rod.gradient).max(0.0);
    let end = if softening > rod.taper { rod.tau(1.0 / softening) } else { f64::INFINITY };
    let most = if u < 1.0 { libm::exp(u) } else { u };
    // The bracketed function is `u - u_of(tau)`, which falls with `tau`.
    let bracket = Bracket { below: most.min(end), above: 0.0 };
    let start = if near < bracket.below { near } else { bracket.middle() };
    let newton = |tau| {
        let miss = u - u_of(rod, tau);
        (miss, tau * libm::exp(miss / slope_of_u(rod, tau)))
    };
    bracket.newton(start, |tau| LAST_TAU_STEP * tau, newton).x
}

/// Number of contact nodes through which a [`Hermite`] polynomial passes.
pub const STENCIL: usize = 6;

/// Number of terms of a [`Hermite`] polynomial: a value and a slope for each node.
pub const TERMS: usize = 2 * STENCIL;

/// Polynomial of a function of the contact between contact nodes. Its variable is the number of nodes, whole or fractional, from the
/// first node of a stencil.
pub type Hermite = Polynomial<TERMS>;
