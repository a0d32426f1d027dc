//! Rest shapes and materials of the rods of a block, gathered into lanes.

use crate::numerics::{Lanes, WIDTH};
use crate::rod::{CURVATURE_TERMS, Rod};
use crate::shooting::batch::{FEW_KERNELS, InitialCondition};
use crate::shooting::contact::arc;
use crate::shooting::{
    Bent, Graded, Intrinsic, Material, Polynomial, Resolution, RodSystem, Scales, Section,
    Sensitivity, Spiral, StepObserver, Straight, TrajectoryState, Uniform, integrate,
};

/// Initial conditions of the trajectories of a block, one for each lane: `[lane]`.
pub type Conditions<'a> = [&'a InitialCondition<'a>; WIDTH];

/// Returns one number of each initial condition: `[lane]`. (`map` of an array is not inlined into functions for a SIMD unit.)
#[inline(always)]
pub fn numbers(conditions: &Conditions, number: impl Fn(&InitialCondition) -> f64) -> [f64; WIDTH] {
    let mut numbers = [0.0; WIDTH];
    for (lane, condition) in numbers.iter_mut().zip(conditions) {
        *lane = number(condition);
    }
    numbers
}

/// Returns one number of each initial condition, packed into the lanes of `T`.
#[inline(always)]
pub fn lanes<T: Lanes>(conditions: &Conditions, number: impl Fn(&InitialCondition) -> f64) -> T {
    T::pack(numbers(conditions, number))
}

/// Contacts at which the trajectories of a block start: each field has one number of every trajectory, in lanes.
pub struct Contacts<'a, T> {
    /// Initial conditions of the trajectories, one for each lane.
    pub conditions: &'a Conditions<'a>,
    /// Resolution of the integration from the contacts.
    pub resolution: Resolution,
    /// Number of steps from each contact to its base; 0 along a profile.
    pub steps: u32,
    /// Taper `beta` of the rods in each lane, dimensionless.
    pub taper: T,
    /// Coordinate `tau` of the contacts in each lane, dimensionless.
    pub tau: T,
    /// Scale of the coordinates at the contacts: the cone's radius over the base radius.
    pub radius: T,
    /// Arclength of the contacts from the base, in whisker lengths.
    pub s: T,
    /// Signed forces at the contacts with friction, in `E I_base/L_w^2`.
    pub force: T,
}

/// A material that can be gathered from the rods of a block, with the integration along it.
pub trait GatherMaterial<T: Lanes> {
    /// Returns the bending stiffness at the contacts over the stiffness at the base. `radius` and `s` are the radius and arclength at the contacts.
    fn stiffness(conditions: &Conditions, radius: T, s: T) -> T;

    /// Returns the state of the trajectories at the base, from their `state` at the `contacts`. `ADVANCES` is true for rods that change
    /// along their length. `observer` gets the rods after each step.
    fn to_base<I: Intrinsic<T>, S: Sensitivity<T>, const ADVANCES: bool>(
        contacts: &Contacts<T>,
        intrinsic: I,
        state: TrajectoryState<T, I, S>,
        observer: &mut impl StepObserver<T>,
    ) -> TrajectoryState<T, I, S>;
}

/// The state at the base after `state` at the `contacts`, in steps of equal length.
#[inline(always)]
fn evenly<T: Lanes, I: Intrinsic<T>, C: Material<T>, S: Sensitivity<T>, const ADVANCES: bool>(
    contacts: &Contacts<T>,
    intrinsic: I,
    material: C,
    state: TrajectoryState<T, I, S>,
    observer: &mut impl StepObserver<T>,
) -> TrajectoryState<T, I, S> {
    let one = T::of(1.0);
    let h = contacts.tau / T::of(f64::from(contacts.steps));
    let (scales, rho) = if ADVANCES {
        (Scales::tapered(contacts.taper, h), contacts.radius)
    } else {
        (Scales::cylinder(h), one)
    };
    let section = Section { rho, inverse_cube: one / (rho * rho * rho), arclength: contacts.s };
    let system = RodSystem { force: contacts.force, intrinsic, material };
    integrate::<_, I, C, S>(&system, &scales, section, contacts.steps, state, observer)
}

impl<T: Lanes> GatherMaterial<T> for Uniform {
    #[inline(always)]
    fn stiffness(_: &Conditions, radius: T, _: T) -> T {
        radius * radius * (radius * radius)
    }

    #[inline(always)]
    fn to_base<I: Intrinsic<T>, S: Sensitivity<T>, const ADVANCES: bool>(
        contacts: &Contacts<T>,
        intrinsic: I,
        state: TrajectoryState<T, I, S>,
        observer: &mut impl StepObserver<T>,
    ) -> TrajectoryState<T, I, S> {
        evenly::<T, I, Self, S, ADVANCES>(contacts, intrinsic, Self, state, observer)
    }
}

impl<T: Lanes> GatherMaterial<T> for Graded<T> {
    #[inline(always)]
    fn stiffness(conditions: &Conditions, radius: T, s: T) -> T {
        let gradient: T = lanes(conditions, |condition| condition.rod.gradient);
        radius * radius * (radius * radius) * gradient.mul_add(s, T::of(1.0))
    }

    #[inline(always)]
    fn to_base<I: Intrinsic<T>, S: Sensitivity<T>, const ADVANCES: bool>(
        contacts: &Contacts<T>,
        intrinsic: I,
        state: TrajectoryState<T, I, S>,
        observer: &mut impl StepObserver<T>,
    ) -> TrajectoryState<T, I, S> {
        let gradient = lanes(contacts.conditions, |condition| condition.rod.gradient);
        evenly::<T, I, Self, S, ADVANCES>(contacts, intrinsic, Self { gradient }, state, observer)
    }
}

/// A rest shape that can be gathered from the rods of a block.
pub trait Gather<T: Lanes>: Intrinsic<T> {
    /// Gathers the rest shape of the rods. Returns the shape, its state at the arclengths `s` (whisker lengths), and `[curvature, slope]` there: the
    /// slope is by the arclength.
    fn gather(conditions: &Conditions, s: T) -> (Self, Self::State, [T; 2]);
}

impl<T: Lanes> Gather<T> for Straight {
    #[inline(always)]
    fn gather(_: &Conditions, _: T) -> (Self, (), [T; 2]) {
        (Self, (), [T::of(0.0); 2])
    }
}

impl<T: Lanes> Gather<T> for Bent<T> {
    #[inline(always)]
    fn gather(conditions: &Conditions, s: T) -> (Self, [T; 2], [T; 2]) {
        let bend = lanes(conditions, |condition| condition.rod.bend);
        let is_level = conditions.iter().all(|condition| condition.rod.slope == 0.0);
        let at_base = if is_level {
            T::of(0.0)
        } else {
            arc(lanes(conditions, |condition| condition.rod.slope))
        };
        Self::at(bend, at_base, s)
    }
}

impl<T: Lanes> Gather<T> for Spiral<T> {
    #[inline(always)]
    fn gather(conditions: &Conditions, s: T) -> (Self, (), [T; 2]) {
        let coefficient = |i: usize| {
            move |condition: &InitialCondition| condition.rod.spiral.unwrap_or_default()[i]
        };
        let spiral = Self {
            at_base: lanes(conditions, coefficient(0)),
            slope: lanes(conditions, coefficient(1)),
        };
        let curvature = spiral.at(s);
        (spiral, (), curvature)
    }
}

/// Coefficient of a power of `s - 1/2` in the curvature of a spiral; 0 without a spiral.
#[inline(always)]
fn spiral_power(rod: &Rod, power: usize) -> f64 {
    let [at_base, slope] = rod.spiral.unwrap_or_default();
    match power {
        0 => at_base + 0.5 * slope,
        1 => slope,
        _ => 0.0,
    }
}

impl<T: Lanes> Gather<T> for Polynomial<T> {
    #[inline(always)]
    fn gather(conditions: &Conditions, s: T) -> (Self, (), [T; 2]) {
        let mut centred = [T::of(0.0); CURVATURE_TERMS];
        for (power, coefficient) in centred.iter_mut().enumerate() {
            *coefficient = lanes(conditions, |condition| match &condition.rod.polynomial {
                Some(polynomial) => polynomial.centred()[power],
                None if FEW_KERNELS => spiral_power(condition.rod, power),
                None => 0.0,
            });
        }
        let polynomial = Self { centred };
        let curvature = polynomial.at(s);
        (polynomial, (), curvature)
    }
}
