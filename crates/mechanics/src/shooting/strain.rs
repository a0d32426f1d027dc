//! Bending strain at the surface of a deflected whisker, `r |kappa - kappa_rest| = r |M| / (E I)`, and its maximum.
//!
//! Between the ends of an integration step, the lever of the force is the quintic polynomial with their positions, tangents and
//! curvatures. Steps are of 8th order, so that the polynomial is as accurate as they are with half their length.

use super::{Planar, Section, StepObserver};
use crate::numerics::{LaneNumbers, Lanes, illinois};
use crate::rod::{Rest, Rod, arclength};
use glam::DVec2;

/// Largest bending strain of a state, and the arclength at which it is. A [`Batch`](super::batch::Batch) computes it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PeakStrain {
    /// Arclength from the base to the largest bending strain, in whisker lengths. Without a load it is the limit for small loads.
    pub arclength: f64,
    /// Largest bending strain at the whisker's surface, in base radii over whisker lengths.
    pub strain: f64,
}

/// Numbers of a point of a trajectory, in the frame of the contact: arclength from the base, lever of the force and unit tangent, in whisker
/// lengths.
type NodeNumbers<T> = [T; 4];

/// Points at which the integration steps of trajectories end, in lanes, from the contact to the base.
#[derive(Clone, Debug)]
pub struct StepNodes<T>(Vec<NodeNumbers<T>>);

impl<T> Default for StepNodes<T> {
    fn default() -> Self {
        Self(Vec::with_capacity(STEPS))
    }
}

/// Number of steps for which there is room without another allocation.
const STEPS: usize = 64;

impl<T: Lanes> StepObserver<T> for StepNodes<T> {
    #[inline(always)]
    fn take(&mut self, section: &Section<T>, &[cos, sin, lever, ..]: &Planar<T>) {
        self.0.push([section.arclength, lever, cos, sin]);
    }
}

impl<T: Lanes> StepNodes<T> {
    /// Returns the numbers of the points, `[point]`, each in all lanes.
    #[inline(always)]
    pub(super) fn unpacked(&self) -> Vec<NodeNumbers<LaneNumbers>> {
        let mut unpacked = Vec::with_capacity(self.0.len());
        for [s, lever, cos, sin] in &self.0 {
            unpacked.push([s.unpack(), lever.unpack(), cos.unpack(), sin.unpack()]);
        }
        unpacked
    }
}

/// Point of a trajectory, see [`NodeNumbers`].
#[derive(Clone, Copy)]
struct StrainNode {
    arclength: f64,
    lever: f64,
    tangent: DVec2,
}

/// Slope of the strain at a point that counts as the maximum, in parts of the steeper slope at the ends of its step.
const FLAT: f64 = 1e-12;

impl PeakStrain {
    /// Finds the largest bending strain of `rod` with the contact at `tau` under `load`, from the `nodes` of its trajectory in the order of the
    /// integration. In a lane that waits for others, nodes are repeated, or lie beyond the contact; these are left out.
    pub(super) fn along(
        rod: &Rod,
        tau: f64,
        load: f64,
        nodes: impl Iterator<Item = NodeNumbers<f64>>,
    ) -> Self {
        let mut last = StrainNode {
            arclength: arclength(rod, tau),
            lever: 0.0,
            tangent: rod.contact_tangent(),
        };
        let mut path = vec![last];
        for [arclength, lever, cos, sin] in nodes {
            if arclength < last.arclength {
                last = StrainNode { arclength, lever, tangent: DVec2::new(cos, sin) };
                path.push(last);
            }
        }
        // Under a force of 1, the moment is the lever. Of equal strains, that nearest to the base counts.
        let (mut best, mut at) = ((last.arclength, 0.0), path.len() - 1);
        for (i, node) in path.iter().enumerate().rev() {
            let strain = bending_strain(rod, node.arclength, node.lever);
            if strain > best.1 {
                (best, at) = ((node.arclength, strain), i);
            }
        }
        let force = load * rod.radius(tau).powi(2);
        let rest = Rest::new(rod);
        let ends = &path[at.saturating_sub(1)..(at + 2).min(path.len())];
        for pair in ends.windows(2).rev() {
            let [to, from] = [&pair[0], &pair[1]];
            let lever = Lever::new([from, to], |node| {
                rest.curvature(node.arclength) - force * node.lever / rod.stiffness(node.arclength)
            });
            let growth = |s: f64| lever.growth(rod, s);
            let ends = [from, to].map(|node| [node.arclength, growth(node.arclength)]);
            let [[_, rising], [_, falling]] = ends;
            if rising > 0.0 && falling < 0.0 {
                let flat = FLAT * rising.max(-falling);
                let Some(top) = illinois(ends, flat, |s| Some(growth(s))) else {
                    continue;
                };
                let s = top.x;
                let peak = bending_strain(rod, s, lever.at(s)[0]);
                if peak > best.1 {
                    best = (s, peak);
                }
            }
        }
        let (arclength, of_unit_force) = best;
        Self { arclength, strain: force.abs() * of_unit_force }
    }
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
    /// The lever between two nodes, the first one nearer to the base. `curvature` gives the whisker's curvature at a node.
    fn new([from, to]: [&StrainNode; 2], curvature: impl Fn(&StrainNode) -> f64) -> Self {
        let width = to.arclength - from.arclength;
        // Lever and its derivatives, by the part of the interval.
        let ends = [from, to].map(|node| {
            let turn = -node.tangent.y * curvature(node);
            [node.lever, width * node.tangent.x, width * width * turn]
        });
        let [[a0, a1, twice], [x, slope, bend]] = ends;
        let a2 = 0.5 * twice;
        let (x, slope, bend) = (x - a0 - a1 - a2, slope - a1 - twice, bend - twice);
        let a3 = 10.0 * x - 4.0 * slope + 0.5 * bend;
        let a4 = -15.0 * x + 7.0 * slope - bend;
        let a5 = 6.0 * x - 3.0 * slope + 0.5 * bend;
        Self { from: from.arclength, width, coefficients: [a0, a1, a2, a3, a4, a5] }
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
