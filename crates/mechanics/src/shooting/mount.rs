//! The mount of the base: a clamp, or a torsion spring that turns by its compliance times the moment at the base.
//!
//! The spring is the limit of a short and soft piece of the rod. So the equations of the rod add the spring's turn to all angles and
//! their derivatives. Their consequences hold behind the spring: the symplectic product of the derivatives, and the energy, which
//! contains the spring's energy. The frame of the base is then the frame of the mount, which a push turns.

use crate::numerics::{Real, Vector};
use crate::shooting::contact::direction;
use crate::shooting::{Carried, Planar, Sensitivity};

/// Returns the state of the rod, and the derivatives that a trajectory carries, behind a mount of this `compliance`, from the state and derivatives at
/// the base. The signed `force` acts at the contact, in `E I_base/L_w^2`.
#[inline(always)]
pub fn in_mount<T: Real, S: Sensitivity<T>>(
    compliance: T,
    force: T,
    [c, s, x, y, bent]: Planar<T>,
    (angles, (levers, sums)): Carried<T, S>,
) -> (Planar<T>, Carried<T, S>) {
    let turn = compliance * force * x;
    let [cos, sin] = direction(turn);
    let turned = [c * cos - s * sin, c.mul_add(sin, s * cos), x, y, bent + turn];
    let angles = angles.plus(compliance, S::moments(force, x, levers));
    (turned, (angles, (levers, sums)))
}
