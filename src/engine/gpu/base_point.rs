//! Base points and starts of steps in the layout of the shaders.

use super::Precision;
use crate::engine::{BasePoint, MOST_TRAJECTORY_STEPS, POWERS};
use crate::numerics::Real;
use crate::rod::{CURVATURE_TERMS, Rest, Rod, arclength};
use crate::shooting::StateDerivative;
use crate::shooting::batch::StepStart;
use bytemuck::{Pod, Zeroable};
use std::mem::offset_of;

/// Powers of a row's polynomials in the shaders, from the first on, in whole quads.
const ROW_POWERS: usize = POWERS.next_multiple_of(4);

/// Powers of the Jacobian's polynomials in the shaders: the last Newton step needs five digits.
const JACOBIAN_POWERS: usize = 8;

const _: () = assert!(
    MOST_TRAJECTORY_STEPS as usize <= Precision::F64.most_steps(),
    "a dispatch has room for every trajectory"
);

const _: () = assert!(
    CURVATURE_TERMS == 7,
    "shaders/intrinsic.wgsl writes them out"
);

const _: () = assert!(
    POWERS == 12 && JACOBIAN_POWERS == 8,
    "shaders/row.wgsl writes them out"
);

/// Scalar type of the shaders: `f32` or `f64`.
pub trait Scalar: Real + Pod + Into<f64> {}

impl<T: Real + Pod + Into<f64>> Scalar for T {}

/// Returns `number` as the sum of two numbers `[high, low]`: rounded to the shaders' scalar, and the rounded remainder.
pub fn halves<T: Scalar>(number: f64) -> [T; 2] {
    let high = T::of(number);
    [high, T::of(number - high.into())]
}

/// Start of an integration step, in the layout of the shaders' `StepStart`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
pub struct GpuStart<T> {
    pub place: [T; 4],
    pub tangents: [T; 4],
}

impl<T: Scalar> From<&StepStart> for GpuStart<T> {
    fn from(start: &StepStart) -> Self {
        let StepStart { tangent, rest, .. } = start;
        Self {
            place: [start.radius, start.arclength, start.bent, start.across].map(T::of),
            tangents: [tangent.x, tangent.y, rest.x, rest.y].map(T::of),
        }
    }
}

/// Base point in quads of numbers, in the order in which the shaders read them.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
pub struct GpuBasePoint<T> {
    /// `tau`, load, radius, arclength.
    contact: [T; 4],
    /// Taper, bend, and the two numbers of an Euler spiral.
    rod: [T; 4],
    /// Coefficients of the powers of `s - 1/2` of a polynomial curvature: `[power]`, and 0.
    curvature: [T; 8],
    /// The pole's centre from the base, and the base from the contact.
    positions: [T; 4],
    /// Tangent at the base, its rotation by bending, and twice the energy over the force.
    base: [T; 4],
    /// cos and sin of the contact's tangent at rest, `tau` from the contact to the tip, and the load per unit of the row parameter.
    rest: [T; 4],
    /// Derivatives of `(theta, X, Y)` at the base and of the energy by `tau`.
    by_tau: [T; 4],
    /// Derivatives of `(theta, X, Y)` at the base and of the energy by load.
    by_load: [T; 4],
    /// Push angle of the base point as two numbers (radians), number of steps, and index of the first step.
    pub push: [T; 4],
    /// Taylor polynomials in the change of the row parameter: changes of the push angle, of `tau`, and of the direction of the resting
    /// whisker's point at the distance of the contact.
    push_by_w: [T; ROW_POWERS],
    tau_by_w: [T; ROW_POWERS],
    resting_by_w: [T; ROW_POWERS],
    /// Taylor polynomial of the derivatives of `(ln D, phi)` by `tau` and by load: four numbers for each power.
    jacobian: [[T; 4]; JACOBIAN_POWERS],
}

/// Name and position of each field of a base point in the shaders, in quads of numbers. The last pair is the number of quads.
pub const QUADS: [(&str, usize); 14] = {
    macro_rules! quads {
        ($($name:literal $member:ident)+) => {
            [
                $(($name, offset_of!(GpuBasePoint<f32>, $member) / size_of::<[f32; 4]>()),)+
                ("BASE_POINT_QUADS", size_of::<GpuBasePoint<f32>>() / size_of::<[f32; 4]>()),
            ]
        };
    }
    quads!(
        "CONTACT" contact "ROD" rod "POWERS_AT_REST" curvature "POSITIONS" positions "BASE" base "REST" rest "BY_TAU" by_tau "BY_LOAD" by_load "PUSH" push
        "PUSH_BY_W" push_by_w "TAU_BY_W" tau_by_w "RESTING_BY_W" resting_by_w "JACOBIAN" jacobian
    )
};

impl<T: Scalar> GpuBasePoint<T> {
    pub fn new(rod: &Rod, base: &BasePoint, first_step: u32) -> Self {
        let BasePoint {
            tau, load, state, ..
        } = base;
        let s = arclength(rod, *tau);
        let full = &state.full;
        let numbers =
            |by: &StateDerivative| [by.angle, by.position.x, by.position.y, by.energy].map(T::of);
        let powers = |i: usize| {
            std::array::from_fn(|power| {
                let term = base.row.get(power + 1);
                term.map_or(T::of(0.0), |term| T::of(term[i]))
            })
        };
        let to_pole = rod.to_pole() - full.position;
        let energy = match full.force {
            0.0 => 0.0,
            force => 2.0 * full.energy / force,
        };
        let rest = Rest::parabola_tangent(rod, s);
        let [k0, k1] = rod.spiral.unwrap_or_default();
        let mut curvature = [T::of(0.0); 8];
        let polynomial = rod.polynomial.iter().flat_map(|own| own.centred());
        for (own, term) in curvature.iter_mut().zip(polynomial) {
            *own = T::of(*term);
        }
        let [high, low] = halves(base.push);
        let steps = [base.trajectory.steps, first_step].map(|count| T::of(count.into()));
        Self {
            contact: [*tau, *load, rod.radius(*tau), s].map(T::of),
            rod: [rod.taper, rod.bend, k0, k1].map(T::of),
            curvature,
            positions: [to_pole.x, to_pole.y, full.position.x, full.position.y].map(T::of),
            base: [full.tangent.x, full.tangent.y, base.trajectory.bent, energy].map(T::of),
            rest: [rest.x, rest.y, rod.tau_tip() - tau, base.load_per_w].map(T::of),
            by_tau: numbers(&state.by_tau),
            by_load: numbers(&state.by_load),
            push: [high, low, steps[0], steps[1]],
            push_by_w: powers(0),
            tau_by_w: powers(1),
            resting_by_w: powers(2),
            jacobian: std::array::from_fn(|power| {
                std::array::from_fn(|i| T::of(base.row[power][3 + i]))
            }),
        }
    }
}
