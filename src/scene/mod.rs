//! A scene: what to simulate, read from TOML and checked. An accepted scene is valid everywhere after.

/// A whisker at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Whisker {
    /// Arclength from base to tip.
    pub length_mm: f64,
    /// Radius at the base.
    pub base_radius_um: f64,
    /// Radius at the tip; 0 is a perfect cone.
    pub tip_radius_um: f64,
    /// Young's modulus; it scales forces, moments and energies, never an angle.
    pub youngs_modulus_gpa: f64,
    /// Intrinsic curvature, `None` for a straight whisker.
    pub curvature: Option<Curvature>,
}

/// The undeflected shape `y = A (x - vertex)^2` with the base at `x = 0` (paper, Eq. 7).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curvature {
    /// `A`.
    pub parabola_per_mm: f64,
    /// Where the vertex lies.
    pub vertex_mm: f64,
}

/// The axes of the sweep; every list is strictly increasing and not empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Rotation of the base since first touch: negative CF, positive CB.
    pub push_angle_deg: Vec<f64>,
    /// Distance from the base to the contact at first touch.
    pub distance_mm: Vec<f64>,
    /// `1 - tip/base radius`, in place of the whisker's own.
    pub taper: Option<Vec<f64>>,
    /// Parabola coefficient `A`, in place of the whisker's own.
    pub curvature_per_mm: Option<Vec<f64>>,
}

/// A checked scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// One line for people.
    pub title: String,
    /// The whisker; taper and curvature axes replace its own values.
    pub whisker: Whisker,
    /// Radius of the pole; 0 is a point contact.
    pub pole_radius_mm: f64,
    /// The sweep.
    pub grid: Grid,
    /// Stem of the output files.
    pub name: String,
    /// The file as it was read.
    pub text: String,
}
