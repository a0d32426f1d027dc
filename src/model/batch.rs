//! Thousands of trajectories in `f64`: lanes of the widest SIMD unit that the machine has, on all cores.
//!
//! The integrator is generic and inlined whole into three functions compiled for AVX-512, for AVX2 with FMA,
//! and for the target's baseline; which one runs is decided once per call from the processor's features.
//! Results do not depend on the number of threads: every trajectory is computed by itself.

use super::integrator::{Integrator, Resolution, Scales, integrate};
use super::landing::{Curved, Full, Landing};
use super::order::{First, FirstAndEnergy, Order, Second};
use super::rhs::{
    Bent, Even, Graded, Intrinsic, Material, Planar, RodSystem, Section, State, Straight,
};
#[cfg(not(target_arch = "x86_64"))]
use super::simd::plain::Plain as Baseline;
#[cfg(target_arch = "x86_64")]
use super::simd::x86::{Avx2, Avx512, Sse2 as Baseline};
use super::simd::{Lanes, WIDTH};
use super::{Effects, Rod, Start, arclength};
use rayon::prelude::*;
use std::fmt;

/// One trajectory: from the contact at `tau` under `load = f/radius^2` to the base.
#[derive(Clone, Copy, Debug)]
pub struct Launch {
    /// The rod.
    pub rod: Rod,
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
}

/// What a batch computes per trajectory, and the derivatives it carries for that.
pub trait Kind<const N: usize>: Order<N> + 'static {
    /// The answer.
    type Answer: Copy + Send;

    /// The answer from the final state.
    fn answer(rod: &Rod, start: &Start, state: &Planar<f64>, sens: &[f64; N]) -> Self::Answer;
}

impl Kind<6> for First {
    type Answer = Landing;
    fn answer(rod: &Rod, start: &Start, state: &Planar<f64>, sens: &[f64; 6]) -> Landing {
        Landing::new(rod, start, state, sens)
    }
}

impl Kind<7> for FirstAndEnergy {
    type Answer = Full;
    fn answer(rod: &Rod, start: &Start, state: &Planar<f64>, sens: &[f64; 7]) -> Full {
        Full::new(rod, start, state, sens)
    }
}

impl Kind<15> for Second {
    type Answer = Curved;
    fn answer(rod: &Rod, start: &Start, state: &Planar<f64>, sens: &[f64; 15]) -> Curved {
        Curved::new(rod, start, state, sens)
    }
}

/// How a batch integrates.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// The effects of every rod in the batch.
    pub effects: Effects,
    /// How finely.
    pub resolution: Resolution,
}

/// Blocks per piece of work that one thread takes: long enough to hide the hand-over, short enough to share. A batch
/// that is one piece stays on the thread that asks for it.
const BLOCKS_PER_TASK: usize = 16;

/// Computes `K` for every launch with the integrator `M`, on all threads of the current pool.
#[must_use]
pub fn land<M: Integrator, K: Kind<N>, const N: usize>(
    method: Method,
    launches: &[Launch],
) -> Vec<K::Answer> {
    let unit = Unit::detect();
    let steps: Vec<u32> = launches
        .iter()
        .map(|l| method.resolution.steps(&l.rod, l.tau))
        .collect();
    // Lanes step together, so only trajectories of equally many steps share a block: company changes nothing.
    let mut order: Vec<usize> = (0..launches.len()).collect();
    order.sort_by_key(|&i| steps[i]);
    let blocks: Vec<&[usize]> = order
        .chunk_by(|&i, &j| steps[i] == steps[j])
        .flat_map(|equal| equal.chunks(WIDTH))
        .collect();
    let run = |block: &&[usize]| {
        let lane = |i: usize| launches[block[i.min(block.len() - 1)]];
        let lanes: [Launch; WIDTH] = std::array::from_fn(lane);
        unit.block::<M, K, N>(method.effects, steps[block[0]], &lanes)
    };
    let landed: Vec<[K::Answer; WIDTH]> = if blocks.len() <= BLOCKS_PER_TASK {
        blocks.iter().map(run).collect()
    } else {
        let tasks = blocks.par_iter().with_min_len(BLOCKS_PER_TASK);
        tasks.map(run).collect()
    };
    let mut places = vec![(0, 0); launches.len()];
    for (b, block) in blocks.iter().enumerate() {
        for (lane, &i) in block.iter().enumerate() {
            places[i] = (b, lane);
        }
    }
    places
        .into_iter()
        .map(|(b, lane)| landed[b][lane])
        .collect()
}

/// A SIMD unit.
#[derive(Clone, Copy, Debug)]
pub enum Unit {
    /// AVX-512.
    #[cfg(target_arch = "x86_64")]
    Avx512,
    /// AVX2 with FMA.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// What every processor of this architecture has.
    Baseline,
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => "AVX-512",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => "AVX2",
            Self::Baseline => "baseline SIMD",
        })
    }
}

impl Unit {
    /// The widest unit of this processor.
    #[must_use]
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl")
            {
                return Self::Avx512;
            }
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                return Self::Avx2;
            }
        }
        Self::Baseline
    }

    #[allow(
        unsafe_code,
        reason = "a function compiled for a SIMD unit may be called where `detect` has found that unit"
    )]
    fn block<M: Integrator, K: Kind<N>, const N: usize>(
        self,
        effects: Effects,
        steps: u32,
        launches: &[Launch; WIDTH],
    ) -> [K::Answer; WIDTH] {
        match self {
            #[cfg(target_arch = "x86_64")]
            // SAFETY: `detect` has seen every feature that the function enables.
            Self::Avx512 => unsafe { avx512::<M, K, N>(effects, steps, launches) },
            #[cfg(target_arch = "x86_64")]
            // SAFETY: as above.
            Self::Avx2 => unsafe { avx2::<M, K, N>(effects, steps, launches) },
            Self::Baseline => by_effects::<M, K, Baseline, N>(effects, steps, launches),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,fma")]
fn avx512<M: Integrator, K: Kind<N>, const N: usize>(
    effects: Effects,
    steps: u32,
    launches: &[Launch; WIDTH],
) -> [K::Answer; WIDTH] {
    by_effects::<M, K, Avx512, N>(effects, steps, launches)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn avx2<M: Integrator, K: Kind<N>, const N: usize>(
    effects: Effects,
    steps: u32,
    launches: &[Launch; WIDTH],
) -> [K::Answer; WIDTH] {
    by_effects::<M, K, Avx2, N>(effects, steps, launches)
}

/// One specialised kernel per set of effects.
#[inline(always)]
fn by_effects<M: Integrator, K: Kind<N>, T: Lanes, const N: usize>(
    effects: Effects,
    steps: u32,
    launches: &[Launch; WIDTH],
) -> [K::Answer; WIDTH] {
    if effects.curvature {
        by_stiffness::<M, K, T, Bent<_>, N>(effects, steps, launches)
    } else {
        by_stiffness::<M, K, T, Straight, N>(effects, steps, launches)
    }
}

/// The same for a rest shape.
#[inline(always)]
fn by_stiffness<M: Integrator, K: Kind<N>, T: Lanes, I: Gather<T>, const N: usize>(
    effects: Effects,
    steps: u32,
    launches: &[Launch; WIDTH],
) -> [K::Answer; WIDTH] {
    match (effects.taper, effects.gradient) {
        (false, false) => block::<M, K, T, I, Even, false, N>(steps, launches),
        (true, false) => block::<M, K, T, I, Even, true, N>(steps, launches),
        (false, true) => block::<M, K, T, I, Graded<_>, false, N>(steps, launches),
        (true, true) => block::<M, K, T, I, Graded<_>, true, N>(steps, launches),
    }
}

/// A material that can be gathered from the rods of a block, with the arclengths of the contacts if it needs them.
trait GatherMaterial<T: Lanes>: Material<T> {
    fn gather(launches: &[Launch; WIDTH]) -> (Self, T);
}

impl<T: Lanes> GatherMaterial<T> for Even {
    #[inline(always)]
    fn gather(_: &[Launch; WIDTH]) -> (Self, T) {
        (Self, T::of(0.0))
    }
}

impl<T: Lanes> GatherMaterial<T> for Graded<T> {
    #[inline(always)]
    fn gather(launches: &[Launch; WIDTH]) -> (Self, T) {
        let gradient = T::pack(launches.map(|launch| launch.rod.gradient));
        let at = T::pack(launches.map(|launch| arclength(&launch.rod, launch.tau)));
        (Self { gradient }, at)
    }
}

/// A rest shape that can be gathered from the rods of a block.
trait Gather<T: Lanes>: Intrinsic<T> {
    fn gather(rods: &[Rod; WIDTH], starts: &[Start; WIDTH]) -> (Self, Self::State);
}

impl<T: Lanes> Gather<T> for Straight {
    #[inline(always)]
    fn gather(_: &[Rod; WIDTH], _: &[Start; WIDTH]) -> (Self, ()) {
        (Self, ())
    }
}

impl<T: Lanes> Gather<T> for Bent<T> {
    #[inline(always)]
    fn gather(rods: &[Rod; WIDTH], starts: &[Start; WIDTH]) -> (Self, [T; 2]) {
        let twice_bend = T::pack(rods.map(|rod| 2.0 * rod.bend));
        let cos = T::pack(starts.map(|start| start.cos));
        let sin = T::pack(starts.map(|start| start.sin));
        (Self { twice_bend }, [cos, sin])
    }
}

/// Integrates `WIDTH` trajectories in step.
#[inline(always)]
fn block<M, K, T, I, C, const TAPER: bool, const N: usize>(
    steps: u32,
    launches: &[Launch; WIDTH],
) -> [K::Answer; WIDTH]
where
    M: Integrator,
    K: Kind<N>,
    T: Lanes,
    I: Gather<T>,
    C: GatherMaterial<T>,
{
    let rods = launches.map(|launch| launch.rod);
    let starts = launches.map(|launch| Start::new(&launch.rod, launch.tau, launch.load));
    let at_start: [[f64; N]; WIDTH] = std::array::from_fn(|i| K::start(&rods[i], &starts[i]));

    let h = T::pack(starts.map(|start| start.tau / f64::from(steps)));
    let one = T::of(1.0);
    let (material, arclength) = C::gather(launches);
    let (scales, rho) = if TAPER {
        let taper = T::pack(rods.map(|rod| rod.taper));
        let rho = T::pack(starts.map(|start| start.radius));
        (Scales::tapered::<M>(taper, h), rho)
    } else {
        (Scales::cylinder::<M>(h), one)
    };
    let from = Section {
        rho,
        inverse_cube: one / (rho * rho * rho),
        arclength,
    };
    let (intrinsic, rest) = I::gather(&rods, &starts);
    let force = T::pack(starts.map(|start| start.force));
    let system = RodSystem {
        force,
        intrinsic,
        material,
    };
    let zero = T::of(0.0);
    let mut sens = [zero; N];
    for (n, lane) in sens.iter_mut().enumerate() {
        *lane = T::pack(at_start.map(|values| values[n]));
    }
    let c = T::pack(starts.map(|start| start.tangent.x));
    let s = T::pack(starts.map(|start| start.tangent.y));
    let state: State<_, I, N> = (rest, ([c, s, zero, zero], sens));
    let (_, (rod, sens)) = integrate::<M, _, I, C, K, N>(&system, &scales, from, h, steps, state);
    let (rod, sens) = (rod.map(T::unpack), sens.map(T::unpack));
    std::array::from_fn(|i| {
        K::answer(
            &rods[i],
            &starts[i],
            &rod.map(|x| x[i]),
            &sens.map(|x| x[i]),
        )
    })
}
