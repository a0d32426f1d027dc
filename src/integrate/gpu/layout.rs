//! Rods, shots and hits as bytes: the structs of `shaders/rod.wgsl` and `shaders/shoot.wgsl`.

use super::Precision;
use crate::integrate::{Hit, Outcome, Shot};
use crate::numerics::Real;
use crate::rod::{Piece, Rod};
use bytemuck::{Pod, Zeroable};

/// What buffers hold, for shaders of one precision.
#[derive(Debug)]
pub struct BufferLayout {
    /// Bytes of a shot.
    pub shot: usize,
    /// Bytes of a hit.
    pub hit: usize,
    /// Rods to bytes.
    pub rods: fn(&[Rod]) -> Vec<u8>,
    /// The pieces of a rod's profile to bytes.
    pub pieces: fn(&Rod) -> Vec<u8>,
    /// Shots to bytes.
    pub shots: fn(&[Shot], Steps) -> Vec<u8>,
    /// Hits from bytes, appended.
    pub hits: fn(&[u8], &mut Vec<Hit>),
}

/// In how many steps the trajectories of a shot are integrated; with a profile, steps for every piece.
pub type Steps<'a> = &'a dyn Fn(&Shot) -> u32;

impl BufferLayout {
    /// The layout for shaders of this precision.
    pub const fn of(precision: Precision) -> Self {
        match precision {
            Precision::F32 => Self::with::<f32>(),
            Precision::F64 => Self::with::<f64>(),
        }
    }

    const fn with<T: Scalar>() -> Self {
        Self {
            shot: size_of::<GpuShot<T>>(),
            hit: size_of::<GpuHit<T>>(),
            rods: |rods| bytes(rods.iter().map(GpuRod::<T>::from)),
            pieces: |rod| match &rod.profile {
                Some(profile) => bytes(profile.pieces.iter().map(|p| GpuPiece::<T>::of(rod, p))),
                None => bytes([GpuPiece::<T>::of(rod, &Piece::cone(rod.taper))].into_iter()),
            },
            shots: |shots, steps| bytes(shots.iter().map(|s| GpuShot::<T>::of(s, steps(s)))),
            hits: |bytes, hits| {
                let each = bytes.chunks_exact(size_of::<GpuHit<T>>());
                hits.extend(
                    each.map(|hit| Hit::from(bytemuck::pod_read_unaligned::<GpuHit<T>>(hit))),
                );
            },
        }
    }
}

/// A scalar of the shaders.
trait Scalar: Real + Pod + Into<f64> {}

impl<T: Real + Pod + Into<f64>> Scalar for T {}

fn bytes<P: Pod>(things: impl ExactSizeIterator<Item = P>) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(things.len() * size_of::<P>());
    for thing in things {
        bytes.extend_from_slice(bytemuck::bytes_of(&thing));
    }
    bytes
}

/// The codes that the shaders write, from 0. A kernel that writes nothing leaves zeros, which are no solution.
pub const OUTCOMES: [(&str, Outcome); 3] = [
    ("NOT_FINITE", Outcome::NotFinite),
    ("CONVERGED", Outcome::Converged),
    ("STALLED", Outcome::Stalled),
];

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
struct GpuRod<T> {
    taper: T,
    bend: T,
    slope: T,
    pole: T,
    friction: T,
    gradient: T,
    spiral: [T; 2],
}

impl<T: Scalar> From<&Rod> for GpuRod<T> {
    fn from(rod: &Rod) -> Self {
        Self {
            taper: T::of(rod.taper),
            bend: T::of(rod.bend),
            slope: T::of(rod.slope),
            pole: T::of(rod.pole),
            friction: T::of(rod.friction),
            gradient: T::of(rod.gradient),
            spiral: rod.spiral.unwrap_or_default().map(T::of),
        }
    }
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
struct GpuPiece<T> {
    tau: T,
    begin: T,
    cubic: [T; 4],
}

impl<T: Scalar> GpuPiece<T> {
    fn of(rod: &Rod, piece: &Piece) -> Self {
        Self {
            tau: T::of(rod.tau(piece.from)),
            begin: T::of(piece.from),
            cubic: piece.cubic.map(T::of),
        }
    }
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
struct GpuShot<T> {
    tau: T,
    load: T,
    pole_x: T,
    pole_y: T,
    rod: u32,
    steps: u32,
}

impl<T: Scalar> GpuShot<T> {
    fn of(shot: &Shot, steps: u32) -> Self {
        Self {
            tau: T::of(shot.tau),
            load: T::of(shot.load),
            pole_x: T::of(shot.pole.x),
            pole_y: T::of(shot.pole.y),
            rod: shot.rod,
            steps,
        }
    }
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
struct GpuHit<T> {
    tau: T,
    load: T,
    residual: T,
    steps: u32,
    outcome: u32,
}

impl<T: Scalar> From<GpuHit<T>> for Hit {
    // Whatever the shader says, a number that is not finite is not a solution.
    fn from(hit: GpuHit<T>) -> Self {
        let numbers: [f64; 3] = [hit.tau.into(), hit.load.into(), hit.residual.into()];
        let outcome = OUTCOMES
            .get(hit.outcome as usize)
            .filter(|_| numbers.iter().all(|x| x.is_finite()))
            .map_or(Outcome::NotFinite, |&(_, outcome)| outcome);
        let [tau, load, residual] = numbers;
        Self {
            tau,
            load,
            residual,
            steps: hit.steps,
            outcome,
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::integrate::gpu::shaders;
    use crate::rod::Effects;
    use naga::TypeInner;
    use std::mem::offset_of;

    /// Name, size and members, in the eyes of the shader and of Rust.
    type Struct = (String, usize, Vec<(String, usize)>);

    fn in_shader(precision: Precision) -> Vec<Struct> {
        let effects = Effects {
            profile: true,
            ..Effects::default()
        };
        let text = shaders::shoot(precision, effects);
        let module = naga::front::wgsl::parse_str(&text).unwrap();
        let structs = module.types.iter().filter_map(|(_, found)| {
            let TypeInner::Struct { members, span } = &found.inner else {
                return None;
            };
            let members = members.iter();
            let members = members.map(|m| (m.name.clone().unwrap(), m.offset as usize));
            Some((found.name.clone()?, *span as usize, members.collect()))
        });
        structs.collect()
    }

    macro_rules! in_rust {
        ($type:ident, $name:literal, $($member:ident)+) => {
            (
                $name.to_owned(),
                size_of::<$type<T>>(),
                vec![$((stringify!($member).to_owned(), offset_of!($type<T>, $member))),+],
            )
        };
    }

    fn agrees<T: Scalar>(precision: Precision) {
        let shader = in_shader(precision);
        for rust in [
            in_rust!(GpuRod, "Rod", taper bend slope pole friction gradient spiral),
            in_rust!(GpuPiece, "Piece", tau begin cubic),
            in_rust!(GpuShot, "Shot", tau load pole_x pole_y rod steps),
            in_rust!(GpuHit, "Hit", tau load residual steps outcome),
        ] {
            assert_eq!(shader.iter().find(|s| s.0 == rust.0), Some(&rust));
        }
    }

    #[test]
    fn shaders_and_rust_agree_on_every_offset() {
        agrees::<f32>(Precision::F32);
        agrees::<f64>(Precision::F64);
    }

    #[test]
    fn a_hit_that_is_not_finite_or_not_written_is_no_solution() {
        for (tau, code, outcome) in [
            (1.0, 1, Outcome::Converged),
            (f32::NAN, 1, Outcome::NotFinite),
            (1.0, 9, Outcome::NotFinite),
            (0.0, 0, Outcome::NotFinite),
        ] {
            let hit = GpuHit {
                tau,
                load: 0.0,
                residual: 0.0,
                steps: 0,
                outcome: code,
            };
            let mut hits = Vec::new();
            (BufferLayout::of(Precision::F32).hits)(bytemuck::bytes_of(&hit), &mut hits);
            assert_eq!(hits[0].outcome, outcome);
        }
    }
}
