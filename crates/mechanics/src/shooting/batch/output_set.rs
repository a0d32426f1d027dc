//! Sets of outputs that a batch computes for each trajectory, in lanes.

use super::block::Block;
use super::block_key::BlockKey;
use super::gather::Conditions;
use super::kernel::Trajectories;
use super::pole::{Complex, PoleCentre, spread};
use super::{FEW_KERNELS, InitialCondition};
use crate::numerics::{Lanes, SimdTask, Unit, WIDTH};
use crate::shooting::contact::Contact;
use crate::shooting::sensitivity::{
    Arrival, BaseDerivatives, Energetic, GeneralFirst, GeneralSecond, SecondBaseDerivatives,
    SensitivitySet, SimilarFirst, SimilarSecond, Triple,
};
use crate::shooting::{
    FirstVariation, FullState, NoSensitivity, PeakStrain, PlainState, SecondVariation, ShootingMap,
    StateDerivative, StepNodes, StepObserver,
};
use glam::DVec2;

/// A set of outputs that a batch computes for each trajectory: the derivatives to carry, and the outputs from their values at the base.
pub trait OutputSet: Copy + Default + Send + 'static {
    /// The output set whose kernels compute this set on processors without a SIMD unit. There, few kernels matter more than fast ones:
    /// each takes long to compile.
    type OnOneLane: OutputSet + Into<Self>;

    /// Derivatives that trajectories carry for this output set on any rod.
    type General<T: Lanes>: SensitivitySet<T>;
    /// Derivatives that trajectories carry for this output set on straight cones and cylinders with a constant modulus.
    type Similar<T: Lanes>: SensitivitySet<T, AtBase = <Self::General<T> as SensitivitySet<T>>::AtBase>;

    /// Observer of the trajectories; `()` if the outputs depend on their ends alone.
    type Observer<T: Lanes>: StepObserver<T> + Default;

    /// Returns the outputs of each lane. `pole` is the vector from the contact to the pole's centre. The initial conditions come with the
    /// observer of the trajectories from them.
    fn outputs<T: Lanes>(
        arrival: &Arrival<T>,
        pole: [T; 2],
        at_base: <Self::General<T> as SensitivitySet<T>>::AtBase,
        observed: (&Conditions, Self::Observer<T>),
    ) -> [Self; WIDTH];

    /// Runs `Trajectories::new(key, block)` on a SIMD `unit` and returns the outputs, `[lane]`. Each output set implements it, so that its kernels
    /// are compiled in this crate and not wherever a batch is integrated.
    #[doc(hidden)]
    fn shoot(unit: Unit, key: BlockKey, block: &Block) -> [Self; WIDTH];
}

impl From<FirstVariation> for ShootingMap {
    fn from(variation: FirstVariation) -> Self {
        variation.full.map
    }
}

impl From<FirstVariation> for PlainState {
    fn from(variation: FirstVariation) -> Self {
        variation.full.plain()
    }
}

impl OutputSet for PlainState {
    type OnOneLane = FirstVariation;
    type General<T: Lanes> = Energetic<NoSensitivity>;
    type Similar<T: Lanes> = Energetic<NoSensitivity>;
    type Observer<T: Lanes> = ();

    #[inline(always)]
    fn outputs<T: Lanes>(
        arrival: &Arrival<T>,
        pole: [T; 2],
        ((), energy): ((), T),
        _: (&Conditions, ()),
    ) -> [Self; WIDTH] {
        let Complex { re, im } = PoleCentre::new(arrival, pole).pole;
        let [cos, sin, x, y, _] = arrival.rod;
        let numbers = [re, im, cos, sin, x, y, arrival.contact.force, energy];
        spread(numbers, |_, [pole_x, pole_y, cos, sin, x, y, force, energy]| Self {
            pole: DVec2::new(pole_x, pole_y),
            tangent: DVec2::new(cos, sin),
            position: DVec2::new(x, y),
            force,
            energy,
        })
    }

    #[inline(never)]
    fn shoot(unit: Unit, key: BlockKey, block: &Block) -> [Self; WIDTH] {
        unit.run(Trajectories::new(key, block))
    }
}

impl OutputSet for ShootingMap {
    type OnOneLane = FirstVariation;
    type General<T: Lanes> = GeneralFirst;
    type Similar<T: Lanes> = SimilarFirst;
    type Observer<T: Lanes> = ();

    #[inline(always)]
    fn outputs<T: Lanes>(
        arrival: &Arrival<T>,
        pole: [T; 2],
        first: BaseDerivatives<T>,
        _: (&Conditions, ()),
    ) -> [Self; WIDTH] {
        PoleCentre::new(arrival, pole).maps(&first)
    }

    #[inline(never)]
    fn shoot(unit: Unit, key: BlockKey, block: &Block) -> [Self; WIDTH] {
        unit.run(Trajectories::new(key, block))
    }
}

impl OutputSet for FirstVariation {
    type OnOneLane = Self;
    type General<T: Lanes> = Energetic<GeneralFirst>;
    type Similar<T: Lanes> = Energetic<SimilarFirst>;
    type Observer<T: Lanes> = ();

    #[inline(always)]
    fn outputs<T: Lanes>(
        arrival: &Arrival<T>,
        pole: [T; 2],
        (first, energy): (BaseDerivatives<T>, T),
        _: (&Conditions, ()),
    ) -> [FirstVariation; WIDTH] {
        let maps = PoleCentre::new(arrival, pole).maps(&first);
        let [cos, sin, x, y, _] = arrival.rod;
        let Contact { radius, force, tangent: [_, slant], .. } = arrival.contact;
        // The work along the change: of the moment at the base by its rotation, and of the force by its displacement.
        let work = |[theta, _, y]: Triple<T>| force * x.mul_add(theta, -y);
        let [theta_tau, x_tau, y_tau] = first.by_tau;
        let [theta_load, x_load, y_load] = first.by_load;
        let force_tau = T::of(-2.0) * arrival.taper * force;
        let force_load = radius * radius;
        let work_tau = work(first.by_tau) - force * radius * slant;
        let work_load = work(first.by_load);
        let numbers = [
            cos, sin, x, y, force, energy, theta_tau, x_tau, y_tau, force_tau, work_tau,
            theta_load, x_load, y_load, force_load, work_load,
        ];
        spread(numbers, |lane, [cos, sin, x, y, force, energy, changes @ ..]| {
            let change = |i: usize| StateDerivative {
                angle: changes[i],
                position: DVec2::new(changes[i + 1], changes[i + 2]),
                force: changes[i + 3],
                energy: changes[i + 4],
            };
            FirstVariation {
                full: FullState {
                    map: maps[lane],
                    tangent: DVec2::new(cos, sin),
                    position: DVec2::new(x, y),
                    force,
                    energy,
                },
                by_tau: change(0),
                by_load: change(5),
            }
        })
    }

    #[inline(never)]
    fn shoot(unit: Unit, key: BlockKey, block: &Block) -> [Self; WIDTH] {
        unit.run(Trajectories::new(key, block))
    }
}

impl OutputSet for SecondVariation {
    type OnOneLane = Self;
    type General<T: Lanes> = GeneralSecond;
    type Similar<T: Lanes> = SimilarSecond;
    type Observer<T: Lanes> = ();

    #[inline(always)]
    fn outputs<T: Lanes>(
        arrival: &Arrival<T>,
        pole: [T; 2],
        second: SecondBaseDerivatives<T>,
        _: (&Conditions, ()),
    ) -> [SecondVariation; WIDTH] {
        let centre = PoleCentre::new(arrival, pole);
        let maps = centre.maps(&second.first);
        let by_tau = centre.moved(second.first.by_tau);
        let by_load = centre.moved(second.first.by_load);
        let tau2 = centre.ln_pole_by_twice(second.by_tau_tau, by_tau, by_tau);
        let mixed = centre.ln_pole_by_twice(second.by_tau_load, by_tau, by_load);
        let load2 = centre.ln_pole_by_twice(second.by_load_load, by_load, by_load);
        let numbers = [tau2.re, tau2.im, mixed.re, mixed.im, load2.re, load2.im];
        spread(numbers, |lane, [a, b, c, d, e, g]| SecondVariation {
            map: maps[lane],
            by_tau_tau: DVec2::new(a, b),
            by_tau_load: DVec2::new(c, d),
            by_load_load: DVec2::new(e, g),
        })
    }

    #[inline(never)]
    fn shoot(unit: Unit, key: BlockKey, block: &Block) -> [Self; WIDTH] {
        unit.run(Trajectories::new(key, block))
    }
}

impl OutputSet for PeakStrain {
    type OnOneLane = Self;
    type General<T: Lanes> = NoSensitivity;
    type Similar<T: Lanes> = NoSensitivity;
    type Observer<T: Lanes> = StepNodes<T>;

    #[inline(always)]
    fn outputs<T: Lanes>(
        _: &Arrival<T>,
        _: [T; 2],
        (): (),
        (conditions, nodes): (&Conditions, StepNodes<T>),
    ) -> [Self; WIDTH] {
        let nodes = nodes.unpacked();
        let mut peaks = [Self::default(); WIDTH];
        for (lane, peak) in peaks[..T::LANES].iter_mut().enumerate() {
            let InitialCondition { rod, tau, load } = conditions[lane];
            let nodes = nodes.iter().map(|numbers| numbers.map(|lanes| lanes[lane]));
            *peak = Self::along(rod, *tau, *load, nodes);
        }
        peaks
    }

    #[inline(never)]
    fn shoot(unit: Unit, key: BlockKey, block: &Block) -> [Self; WIDTH] {
        let trajectories = Trajectories::new(key, block);
        if const { FEW_KERNELS } {
            return trajectories.run::<f64>();
        }
        unit.run(trajectories)
    }
}
