//! The shooting map: from the contact's `tau` and `load = f/rho^2` to the pole's distance `D` and direction `phi` in the base's frame,
//! with derivatives.

use glam::DVec2;

/// Longest Newton step of the shooting map, relative to the contact's arclength `s` and to the load plus `1/s^2`. The latter is the
/// load's scale on the sheet.
pub const LONGEST_STEP: f64 = 0.25;

/// Shortens a Newton `step` in `(tau, load)` as a whole to [`LONGEST_STEP`]. Returns it with its length before, relative to `s` and
/// `|load| + 1/s^2`.
#[must_use]
pub fn limited(step: DVec2, s: f64, load: f64) -> (DVec2, f64) {
    let length = (step.x.abs() / s).max(step.y.abs() / (load.abs() + 1.0 / (s * s)));
    (step * (LONGEST_STEP / length).min(1.0), length)
}

/// The quotient `a/b` of complex numbers.
fn over(a: DVec2, b: DVec2) -> DVec2 {
    DVec2::new(b.x, -b.y).rotate(a) / b.length_squared()
}

/// Shooting map at one contact and load: position of the pole in whisker lengths, and its first derivatives by contact and load.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShootingMap {
    /// Centre of the pole in the frame of the base, in whisker lengths.
    pub pole: DVec2,
    /// Derivative `d(ln D, phi)/dtau` at fixed load; `phi` in radians.
    pub by_tau: DVec2,
    /// Derivative `d(ln D, phi)/dload` at fixed `tau`; `phi` in radians.
    pub by_load: DVec2,
}

impl ShootingMap {
    /// Returns the Jacobian determinant `det d(ln D, phi)/d(tau, load)`: 0 at a fold.
    #[must_use]
    pub fn det(&self) -> f64 {
        self.by_tau.perp_dot(self.by_load)
    }

    /// Returns true if the state is stable, or at a fold but for rounding: the determinant is not less than -1e-7 of its scale.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.det() > -1e-7 * self.by_tau.length() * self.by_load.length()
    }

    /// Returns the step `(tau, load)` that cancels `residual = ln P_wanted/P` to first order.
    #[must_use]
    pub fn solve(&self, residual: DVec2) -> DVec2 {
        DVec2::new(residual.perp_dot(self.by_load), self.by_tau.perp_dot(residual)) / self.det()
    }

    /// Returns Newton's step `(tau, load)` toward the pole's centre `wanted`, in whisker lengths in the frame of the base. It is
    /// [`limited`]. The iterate has its contact at arclength `s`, in whisker lengths, under the `load = f/rho^2`.
    #[must_use]
    pub fn newton_step(&self, wanted: DVec2, s: f64, load: f64) -> DVec2 {
        limited(self.solve(self.residual(wanted)), s, load).0
    }

    /// Returns the residual `P_wanted/P - 1` as a complex number, dimensionless. Its length is the pole's distance from the point
    /// `wanted`, relative to `D`. `wanted` is in whisker lengths in the frame of the base.
    #[must_use]
    pub fn residual(&self, wanted: DVec2) -> DVec2 {
        over(wanted - self.pole, self.pole)
    }
}

/// A state of the whisker: pole, pose of the base, force and energy. The frame's origin is the contact; its second axis is
/// along the force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FullState {
    /// Pole of the state, and its first derivatives by contact and load.
    pub map: ShootingMap,
    /// Unit tangent of the base in the frame of the contact.
    pub tangent: DVec2,
    /// Position of the base in the frame of the contact, in whisker lengths.
    pub position: DVec2,
    /// Signed force at the contact, with the sign of the load, in `E I_base/L_w^2`.
    pub force: f64,
    /// Bending energy of the state, in `E I_base/L_w`.
    pub energy: f64,
}

/// A state of the whisker without derivatives, in the frame of [`FullState`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlainState {
    /// Centre of the pole in the frame of the base, in whisker lengths.
    pub pole: DVec2,
    /// Unit tangent of the base in the frame of the contact.
    pub tangent: DVec2,
    /// Position of the base in the frame of the contact, in whisker lengths.
    pub position: DVec2,
    /// Signed force at the contact, with the sign of the load, in `E I_base/L_w^2`.
    pub force: f64,
    /// Bending energy of the state, in `E I_base/L_w`.
    pub energy: f64,
}

impl FullState {
    /// Returns the state without derivatives.
    #[must_use]
    pub const fn plain(&self) -> PlainState {
        PlainState {
            pole: self.map.pole,
            tangent: self.tangent,
            position: self.position,
            force: self.force,
            energy: self.energy,
        }
    }
}

/// Derivative of a [`FullState`] by a variable, such as a coordinate of the sheet: `tau` at fixed load, or the load `f/rho^2` at fixed
/// `tau`. Each field has the unit of the state's value per unit of the variable.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StateDerivative {
    /// Derivative of the angle of the base's tangent, in radians per unit of the variable.
    pub angle: f64,
    /// Derivative of the position of the base in the frame of the contact, in whisker lengths per unit of the variable.
    pub position: DVec2,
    /// Derivative of the signed force at the contact, in `E I_base/L_w^2` per unit of the variable.
    pub force: f64,
    /// Derivative of the bending energy of the state, in `E I_base/L_w` per unit of the variable.
    pub energy: f64,
}

impl StateDerivative {
    /// Returns `self + h other`: the derivative along a sum of two variables.
    #[must_use]
    pub fn plus(&self, h: f64, other: &Self) -> Self {
        Self {
            angle: self.angle + h * other.angle,
            position: self.position + h * other.position,
            force: self.force + h * other.force,
            energy: self.energy + h * other.energy,
        }
    }
}

/// A state with its first derivatives by the contact coordinate `tau` and by the load `f/rho^2`, in the frame of [`FullState`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FirstVariation {
    /// State of the whisker at `(tau, load)`.
    pub full: FullState,
    /// Derivative of the state by the contact's `tau` at fixed load.
    pub by_tau: StateDerivative,
    /// Derivative of the state by the load `f/rho^2` at fixed `tau`.
    pub by_load: StateDerivative,
}

impl FirstVariation {
    /// Returns the state after a `step` in `(tau, load)`, extrapolated to first order.
    #[must_use]
    pub fn extrapolated(&self, step: DVec2) -> FullState {
        let (full, tau, load) = (self.full, self.by_tau, self.by_load);
        let map = full.map;
        let ln_pole = map.by_tau * step.x + map.by_load * step.y;
        let angle = tau.angle * step.x + load.angle * step.y;
        FullState {
            map: ShootingMap { pole: map.pole + ln_pole.rotate(map.pole), ..map },
            tangent: full.tangent + angle * full.tangent.perp(),
            position: full.position + tau.position * step.x + load.position * step.y,
            force: full.force + tau.force * step.x + load.force * step.y,
            energy: full.energy + tau.energy * step.x + load.energy * step.y,
        }
    }
}

/// A shooting map with the second derivatives of `(ln D, phi)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SecondVariation {
    /// Pole of the state, and the first derivatives of `(ln D, phi)` by contact and load.
    pub map: ShootingMap,
    /// Second derivative of `(ln D, phi)` by `tau`; `phi` in radians.
    pub by_tau_tau: DVec2,
    /// Mixed derivative of `(ln D, phi)` by `tau` and load; `phi` in radians.
    pub by_tau_load: DVec2,
    /// Second derivative of `(ln D, phi)` by the load; `phi` in radians.
    pub by_load_load: DVec2,
}

impl SecondVariation {
    /// Returns the variation after a `step` in `(tau, load)`: the pole to second order, its first derivatives to first order, the second derivatives
    /// unchanged.
    #[must_use]
    pub fn extrapolated(&self, step: DVec2) -> Self {
        let ShootingMap { pole, by_tau, by_load } = self.map;
        let turned_tau = self.by_tau_tau * step.x + self.by_tau_load * step.y;
        let turned_load = self.by_tau_load * step.x + self.by_load_load * step.y;
        let [tau, load] = [by_tau + 0.5 * turned_tau, by_load + 0.5 * turned_load];
        let ln_pole = tau * step.x + load * step.y;
        Self {
            map: ShootingMap {
                pole: (DVec2::from_angle(ln_pole.y) * libm::exp(ln_pole.x)).rotate(pole),
                by_tau: by_tau + turned_tau,
                by_load: by_load + turned_load,
            },
            ..*self
        }
    }

    /// Returns the gradient of the Jacobian determinant [`ShootingMap::det`] by `(tau, load)`.
    #[must_use]
    pub fn det_gradient(&self) -> DVec2 {
        let ShootingMap { by_tau, by_load, .. } = self.map;
        DVec2::new(
            self.by_tau_tau.perp_dot(by_load) + by_tau.perp_dot(self.by_tau_load),
            self.by_tau_load.perp_dot(by_load) + by_tau.perp_dot(self.by_load_load),
        )
    }
}
