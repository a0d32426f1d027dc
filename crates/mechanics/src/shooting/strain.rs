//! Bending strain at the surface of a deflected whisker, `r |kappa - kappa_rest| = r |M| / (E I)`, and its maximum.
//!
//! Between neighbouring samples of a trajectory, the lever of the force is the quintic polynomial with their positions, tangents and
//! curvatures. Samples are as dense as integration steps of 8th order, so that the polynomial is as accurate as they are.

use super::Resolution;
use super::shape::{RodPoint, profile};
use crate::numerics::Bracket;
use crate::rod::{Rod, arclength};

/// Largest bending strain of a state, and the arclength at which it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeakStrain {
    /// Arclength from the base to the largest bending strain, in whisker lengths. Without a load it is the limit for small loads.
    pub arclength: f64,
    /// Largest bending strain at the whisker's surface, in base radii over whisker lengths.
    pub strain: f64,
}

impl PeakStrain {
    /// Finds the largest bending strain of `rod` with the contact at `tau` under `load`.
    #[must_use]
    pub fn new(rod: &Rod, tau: f64, load: f64, resolution: Resolution) -> Self {
        let points = profile(
            rod,
            tau,
            load,
            resolution,
            &samples(rod, tau, load, resolution),
        );
        // Under a force of 1, the moment is the lever.
        let strain = |point: &RodPoint| bending_strain(rod, point.arclength, point.position.x);
        let mut best = (points[0].arclength, 0.0);
        let mut at = 0;
        for (i, point) in points.iter().enumerate() {
            if strain(point) > best.1 {
                (best, at) = ((point.arclength, strain(point)), i);
            }
        }
        let ends = &points[at.saturating_sub(1)..(at + 2).min(points.len())];
        for pair in ends.windows(2) {
            let lever = Lever::new(&pair[0], &pair[1]);
            let growth = |s: f64| lever.growth(rod, s);
            let [from, to] = [0, 1].map(|end: usize| pair[end].arclength);
            if growth(from) > 0.0 && growth(to) < 0.0 {
                let bracket = Bracket {
                    below: to,
                    above: from,
                };
                let s = bracket.bisect(growth);
                let peak = bending_strain(rod, s, lever.at(s)[0]);
                if peak > best.1 {
                    best = (s, peak);
                }
            }
        }
        let (arclength, of_unit_force) = best;
        let force = load * rod.radius(tau).powi(2);
        Self {
            arclength,
            strain: force.abs() * of_unit_force,
        }
    }
}

/// Arclengths from the base to the contact, in whisker lengths, `[sample]`: as many as the integrator takes steps, evenly spaced in `tau`
/// along the cone or along each piece of a profile.
fn samples(rod: &Rod, tau: f64, load: f64, resolution: Resolution) -> Vec<f64> {
    let mut at = Vec::new();
    let mut part = |from: f64, to: f64, steps: u32| {
        let step = (to - from) / f64::from(steps);
        at.extend((0..steps).map(|i| arclength(rod, from + step * f64::from(i))));
    };
    let contact = arclength(rod, tau);
    match &rod.profile {
        None => part(0.0, tau, resolution.steps(rod, tau, load)),
        Some(profile) => {
            let last = rod.piece(contact);
            let steps = resolution.of_pieces(rod, tau, load);
            for (k, piece) in profile.pieces[..=last].iter().enumerate() {
                let to = match k == last {
                    true => tau,
                    false => profile.pieces[k + 1].tau,
                };
                part(piece.tau, to, steps.of(profile, k));
            }
        }
    }
    at.push(contact);
    at
}

/// Returns the bending strain at the surface of `rod` at the arclength `s` under a bending moment in `E I_base/L_w`. It is in base radii
/// over whisker lengths.
#[must_use]
pub fn bending_strain(rod: &Rod, s: f64, moment: f64) -> f64 {
    // At the tip of a perfect cone the stiffness is 0, too: the whisker keeps its rest shape there.
    if moment == 0.0 {
        return 0.0;
    }
    let [radius, _] = radius(rod, s);
    radius * moment.abs() / rod.stiffness(s)
}

/// Radius at the arclength `s` and its derivative, over the base radius.
fn radius(rod: &Rod, s: f64) -> [f64; 2] {
    match &rod.profile {
        Some(profile) => {
            let piece = &profile.pieces[profile.piece(s)];
            [piece.radius(s), piece.slope(s)]
        }
        None => [1.0 - rod.taper * s, -rod.taper],
    }
}

/// Lever of the force between two points of a trajectory: a quintic polynomial of the arclength.
struct Lever {
    from: f64,
    width: f64,
    coefficients: [f64; 6],
}

impl Lever {
    fn new(from: &RodPoint, to: &RodPoint) -> Self {
        let width = to.arclength - from.arclength;
        // Lever and its derivatives, by the part of the interval.
        let ends = [from, to].map(|point| {
            let turn = -point.tangent.y * point.curvature;
            [
                point.position.x,
                width * point.tangent.x,
                width * width * turn,
            ]
        });
        let [[a0, a1, twice], [x, slope, bend]] = ends;
        let a2 = 0.5 * twice;
        let (x, slope, bend) = (x - a0 - a1 - a2, slope - a1 - twice, bend - twice);
        let a3 = 10.0 * x - 4.0 * slope + 0.5 * bend;
        let a4 = -15.0 * x + 7.0 * slope - bend;
        let a5 = 6.0 * x - 3.0 * slope + 0.5 * bend;
        Self {
            from: from.arclength,
            width,
            coefficients: [a0, a1, a2, a3, a4, a5],
        }
    }

    /// The lever and its derivative at the arclength `s`.
    fn at(&self, s: f64) -> [f64; 2] {
        let t = (s - self.from) / self.width;
        let horner = |[value, slope]: [f64; 2], a: &f64| [value * t + a, slope * t + value];
        let [value, slope] = self.coefficients.iter().rev().fold([0.0; 2], horner);
        [value, slope / self.width]
    }

    /// A number with the sign of the derivative of the strain `|x| / (rho^3 m)` at the arclength `s`. `rho` is the radius, `m` the modulus.
    fn growth(&self, rod: &Rod, s: f64) -> f64 {
        let [x, slope] = self.at(s);
        let [rho, fall] = radius(rod, s);
        let m = rod.modulus(s);
        x.signum() * (slope * rho * m - x * (3.0 * fall * m + rho * rod.gradient))
    }
}
