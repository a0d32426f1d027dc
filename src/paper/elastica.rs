//! Elastica: a straight cylinder pushed by a point, in closed form.
//!
//! Seen from the contact, the tangent has turned by `psi` where `psi'^2 = 2 f sin psi`. Lengths are in `1/sqrt(2f)`. The base, at the
//! turning angle `beta`, is at `X = 2 sqrt(sin beta)`, `Y = int sqrt(sin)` and the arclength `s = int 1/sqrt(sin)`. With `u = sqrt(sin
//! psi)` both integrals are lemniscatic, here in Carlson's symmetric forms (B. C. Carlson, "Numerical computation of real or complex
//! elliptic integrals", Numer. Algorithms 10, 1995).

use std::f64::consts::{FRAC_PI_2, PI};
use whiskmap_mechanics::numerics::Bracket;

/// State of a straight cylinder pushed by a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastica {
    /// Rotation of the cylinder's base since first touch, in radians.
    pub push: f64,
    /// Arclength of the contact over its distance from the base, dimensionless.
    pub arc_over_distance: f64,
    /// Load `F d^2/(E I)`, dimensionless; `d` is the distance of the contact from the base.
    pub load: f64,
    /// `dpush/dbeta`: 0 at the fold.
    slope: f64,
}

/// Returns the state of a straight cylinder in which the tangent turns by `beta` (radians, between 0 and pi) from base to contact.
#[must_use]
pub fn elastica(beta: f64) -> Elastica {
    let (arc, across) = if beta <= FRAC_PI_2 {
        integrals(beta)
    } else {
        let (half, rest) = (integrals(FRAC_PI_2), integrals(PI - beta));
        (2.0 * half.0 - rest.0, 2.0 * half.1 - rest.1)
    };
    let root = beta.sin().sqrt();
    let along = 2.0 * root;
    let squared = along.mul_add(along, across * across);
    Elastica {
        push: beta - across.atan2(along),
        arc_over_distance: arc / squared.sqrt(),
        load: 0.5 * squared,
        slope: 1.0 - (along * root - across * beta.cos() / root) / squared,
    }
}

/// Returns the state of a straight cylinder with the largest push angle: the saddle-node.
#[must_use]
pub fn fold() -> Elastica {
    let turns = Bracket { below: 0.99 * PI, above: FRAC_PI_2 };
    elastica(turns.bisect(|beta| elastica(beta).slope))
}

/// `int_0^beta 1/sqrt(sin)` and `int_0^beta sqrt(sin)` for `beta` up to a right angle.
fn integrals(beta: f64) -> (f64, f64) {
    let squared = beta.sin();
    let u = squared.sqrt();
    let (x, y) = (1.0 - squared, 1.0 + squared);
    let arc = 2.0 * u * carlson_rf(x, y, 1.0);
    let across = 2.0 / 3.0 * u.powi(3) * carlson_rd(x, y, 1.0);
    (arc, across)
}

/// Rounds of duplication. Each divides the spread of the arguments by 4, down to rounding.
const DUPLICATIONS: usize = 30;

/// `R_F(x, y, z)`: half of `int_0^inf dt/sqrt((t + x)(t + y)(t + z))`.
fn carlson_rf(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    for _ in 0..DUPLICATIONS {
        let shift = duplication(x, y, z);
        (x, y, z) = (0.25 * (x + shift), 0.25 * (y + shift), 0.25 * (z + shift));
    }
    ((x + y + z) / 3.0).sqrt().recip()
}

/// `R_D(x, y, z) = R_J(x, y, z, z)`.
fn carlson_rd(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    let (mut sum, mut power) = (0.0, 1.0);
    for _ in 0..DUPLICATIONS {
        let shift = duplication(x, y, z);
        sum += power / (z.sqrt() * (z + shift));
        power *= 0.25;
        (x, y, z) = (0.25 * (x + shift), 0.25 * (y + shift), 0.25 * (z + shift));
    }
    3.0 * sum + power * ((x + y + 3.0 * z) / 5.0).powf(-1.5)
}

fn duplication(x: f64, y: f64, z: f64) -> f64 {
    let (x, y, z) = (x.sqrt(), y.sqrt(), z.sqrt());
    x * y + y * z + z * x
}
