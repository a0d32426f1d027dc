//! Physical units of one whisker's dimensionless numbers.

use std::f64::consts::FRAC_PI_4;

/// Physical units in which the quantities of one whisker are 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Unit of length in millimetres: the whisker's length `L`.
    pub length_mm: f64,
    /// Unit of force in micronewtons: `E I_base/L^2`.
    pub force_un: f64,
    /// Unit of moment in nanonewton metres, and of energy in nanojoules: `E I_base/L`.
    pub moment_nnm: f64,
    /// Unit of bending strain: the base radius over the whisker's length, dimensionless.
    pub strain: f64,
}

impl Units {
    /// Returns the units of a whisker with this length, base radius and Young's modulus at the base.
    #[must_use]
    pub fn new(length_mm: f64, base_radius_um: f64, youngs_modulus_gpa: f64) -> Self {
        let stiffness = youngs_modulus_gpa * 1e9 * FRAC_PI_4 * (base_radius_um * 1e-6).powi(4);
        let length = length_mm * 1e-3;
        Self {
            length_mm,
            force_un: stiffness / (length * length) * 1e6,
            moment_nnm: stiffness / length * 1e9,
            strain: base_radius_um * 1e-3 / length_mm,
        }
    }
}
