//! The units of one whisker.

use std::f64::consts::FRAC_PI_4;

/// The units of one whisker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Of lengths: the whisker's own.
    pub length_mm: f64,
    /// Of forces: `E I_base/L^2`.
    pub force_un: f64,
    /// Of moments and, in nJ, of energies: `E I_base/L`.
    pub moment_nnm: f64,
}

impl Units {
    /// The units of a whisker of this length, base radius and modulus at the base.
    #[must_use]
    pub fn new(length_mm: f64, base_radius_um: f64, youngs_modulus_gpa: f64) -> Self {
        let stiffness = youngs_modulus_gpa * 1e9 * FRAC_PI_4 * (base_radius_um * 1e-6).powi(4);
        let length = length_mm * 1e-3;
        Self {
            length_mm,
            force_un: stiffness / (length * length) * 1e6,
            moment_nnm: stiffness / length * 1e9,
        }
    }
}
