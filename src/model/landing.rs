//! What a trajectory says when it lands on the base: the pole as the base sees it.
//!
//! With `w` the pole's centre seen from the base in the axes of the contact, and `theta` the base's tangent
//! there, `G = ln w - i theta` (complex) has the real part `ln D` and the imaginary part `phi`, the two
//! coordinates of a whisker in front of a pole. Its derivatives need no trigonometry:
//! `G_i = w_i/w - i theta_i`, `G_ij = w_ij/w - w_i w_j/w^2 - i theta_ij`.
//! The coordinates of the sheet are `tau` of the contact and `load = f/rho^2` there.

use super::{Planar, Rod};
use glam::DVec2;

/// The longest Newton step, relative to the arclength of the contact and to the load (plus 1/s^2, the load's
/// scale on the sheet).
pub const LONGEST_STEP: f64 = 0.25;

/// `step` in `(tau, load)`, shortened as a whole to [`LONGEST_STEP`], and its length before: near a fold the
/// Jacobian is nearly singular, and the full step would leave the sheet.
#[must_use]
pub fn limited(step: DVec2, s: f64, load: f64) -> (DVec2, f64) {
    let length = (step.x.abs() / s).max(step.y.abs() / (load.abs() + 1.0 / (s * s)));
    (step * (LONGEST_STEP / length).min(1.0), length)
}

/// Product of complex numbers.
#[inline(always)]
fn times(a: DVec2, b: DVec2) -> DVec2 {
    a.rotate(b)
}

/// Quotient of complex numbers.
#[inline(always)]
fn over(a: DVec2, b: DVec2) -> DVec2 {
    DVec2::new(b.x, -b.y).rotate(a) / b.length_squared()
}

/// A contact under load.
#[derive(Clone, Copy, Debug)]
pub struct Pressed {
    /// Radius over the base radius.
    pub radius: f64,
    /// The whole force.
    pub force: f64,
}

/// The pole's centre `w` seen from the base, in the axes of the contact.
struct Centre {
    w: DVec2,
    pole: DVec2,
}

impl Centre {
    #[inline(always)]
    fn new(rod: &Rod, [c, s, x, y]: &Planar<f64>) -> Self {
        let w = rod.to_pole() - DVec2::new(*x, *y);
        Self {
            w,
            pole: DVec2::new(*c, -s).rotate(w),
        }
    }

    /// `G_f` and `G_s`.
    #[inline(always)]
    fn first(&self, sens: &[f64]) -> [DVec2; 2] {
        [0, 3]
            .map(|i| over(-DVec2::new(sens[i + 1], sens[i + 2]), self.w) - DVec2::new(0.0, sens[i]))
    }

    #[inline(always)]
    fn landing(&self, rod: &Rod, pressed: Pressed, sens: &[f64]) -> Landing {
        let [f, s] = self.first(sens);
        let rho = pressed.radius;
        Landing {
            pole: self.pole,
            by_tau: rho * s - 2.0 * rod.taper * pressed.force * f,
            by_load: rho * rho * f,
        }
    }
}

/// The base as seen from the contact, in axes whose second one is along the force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Base {
    /// Unit tangent.
    pub tangent: DVec2,
    /// Position.
    pub position: DVec2,
    /// Force at the contact.
    pub force: f64,
}

/// Where the pole is, and how that changes with the contact and the load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing {
    /// Centre of the pole in the frame of the base.
    pub pole: DVec2,
    /// `d(ln D, phi)/dtau` at fixed load.
    pub by_tau: DVec2,
    /// `d(ln D, phi)/dload`.
    pub by_load: DVec2,
}

impl Landing {
    /// `det d(ln D, phi)/d(tau, load)`: 0 at a fold.
    #[must_use]
    pub fn det(&self) -> f64 {
        self.by_tau.perp_dot(self.by_load)
    }

    /// The step `(tau, load)` that cancels `residual = ln P_wanted/P` to first order.
    #[must_use]
    pub fn solve(&self, residual: DVec2) -> DVec2 {
        DVec2::new(
            residual.perp_dot(self.by_load),
            self.by_tau.perp_dot(residual),
        ) / self.det()
    }

    /// Newton's step `(tau, load)` toward `wanted`, [`limited`], from the contact at arclength `s` under `load`.
    #[must_use]
    pub fn newton_step(&self, wanted: DVec2, s: f64, load: f64) -> DVec2 {
        limited(self.solve(self.residual(wanted)), s, load).0
    }

    /// `P_wanted/P - 1`: what Newton's method cancels. Its length is the miss relative to `D`.
    #[must_use]
    pub fn residual(&self, wanted: DVec2) -> DVec2 {
        over(wanted - self.pole, self.pole)
    }

    #[inline(always)]
    pub(super) fn new(rod: &Rod, pressed: Pressed, state: &Planar<f64>, first: &[f64]) -> Self {
        Centre::new(rod, state).landing(rod, pressed, first)
    }
}

/// A state with everything that a map tells about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Full {
    /// Pole and derivatives.
    pub landing: Landing,
    /// The base as seen from the contact, in axes whose second one is along the force.
    pub base: Base,
    /// Bending energy in `E I_base/L_w`.
    pub energy: f64,
}

impl Full {
    #[inline(always)]
    pub(super) fn new(rod: &Rod, pressed: Pressed, state: &Planar<f64>, first: &[f64; 7]) -> Self {
        let [c, s, x, y] = *state;
        Self {
            landing: Landing::new(rod, pressed, state, first),
            base: Base {
                tangent: DVec2::new(c, s),
                position: DVec2::new(x, y),
                force: pressed.force,
            },
            energy: first[6],
        }
    }
}

/// A landing with the second derivatives of `(ln D, phi)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curved {
    /// Pole and first derivatives.
    pub landing: Landing,
    /// Twice by `tau`.
    pub by_tau_tau: DVec2,
    /// By `tau` and load.
    pub by_tau_load: DVec2,
    /// Twice by load.
    pub by_load_load: DVec2,
}

impl Curved {
    /// Gradient of [`Landing::det`] in `(tau, load)`.
    #[must_use]
    pub fn det_gradient(&self) -> DVec2 {
        let Landing {
            by_tau, by_load, ..
        } = self.landing;
        DVec2::new(
            self.by_tau_tau.perp_dot(by_load) + by_tau.perp_dot(self.by_tau_load),
            self.by_tau_load.perp_dot(by_load) + by_tau.perp_dot(self.by_load_load),
        )
    }

    #[inline(always)]
    pub(super) fn new(rod: &Rod, pressed: Pressed, state: &Planar<f64>, sens: &[f64; 15]) -> Self {
        let centre = Centre::new(rod, state);
        let [f, s] = centre.first(sens);
        let second = |i: usize, wa: DVec2, wb: DVec2| {
            let w = -DVec2::new(sens[i + 1], sens[i + 2]);
            over(w, centre.w) - times(wa, wb) - DVec2::new(0.0, sens[i])
        };
        let wf = over(-DVec2::new(sens[1], sens[2]), centre.w);
        let ws = over(-DVec2::new(sens[4], sens[5]), centre.w);
        let (ff, fs, ss) = (second(6, wf, wf), second(9, wf, ws), second(12, ws, ws));
        let (rho, beta) = (pressed.radius, rod.taper);
        let (f_load, f_tau) = (rho * rho, -2.0 * beta * pressed.force);
        Self {
            landing: centre.landing(rod, pressed, sens),
            by_tau_tau: f_tau * f_tau * ff
                + 2.0 * f_tau * rho * fs
                + rho * rho * ss
                + 4.0 * beta * beta * pressed.force * f
                - beta * rho * s,
            by_tau_load: f_load * (f_tau * ff + rho * fs - 2.0 * beta * f),
            by_load_load: f_load * f_load * ff,
        }
    }
}
