//! Rods, shots and hits as bytes, in the layout of `shaders/rod.wgsl` and `shaders/shoot.wgsl`.

use super::Precision;
use crate::integrate::{Hit, Outcome, Shot};
use crate::rod::{Piece, Rod};
use bytemuck::Pod;

/// Sizes, and the ways in and out.
#[derive(Debug)]
pub struct Layout {
    /// Bytes of a shot.
    pub shot: usize,
    /// Bytes of a hit.
    pub hit: usize,
    /// Rods to bytes.
    pub rods: fn(&[Rod]) -> Vec<u8>,
    /// The pieces of a rod's profile to bytes.
    pub pieces: fn(&[Stretch]) -> Vec<u8>,
    /// Shots to bytes.
    pub shots: fn(&[Task]) -> Vec<u8>,
    /// Hits from bytes.
    pub hits: fn(&[u8], &mut Vec<Hit>),
}

impl Layout {
    /// The layout for shaders of this precision.
    pub fn of(precision: Precision) -> &'static Self {
        match precision {
            Precision::F32 => &single::LAYOUT,
            Precision::F64 => &double::LAYOUT,
        }
    }
}

/// A piece of a profile, and `tau` where it begins.
#[derive(Clone, Copy, Debug)]
pub struct Stretch {
    pub tau: f64,
    pub piece: Piece,
}

/// A shot, and in how many steps its trajectories are integrated; with a profile, steps for every piece.
#[derive(Clone, Copy, Debug)]
pub struct Task {
    pub shot: Shot,
    pub steps: u32,
}

/// The codes that the shaders write.
pub const OUTCOMES: [(&str, Outcome); 3] = [
    ("CONVERGED", Outcome::Converged),
    ("STALLED", Outcome::Stalled),
    ("NOT_FINITE", Outcome::NotFinite),
];

/// Things as bytes, in the shape `P`.
fn write<T, P: Pod + for<'a> From<&'a T>>(things: &[T]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(size_of_val(things));
    for thing in things {
        bytes.extend_from_slice(bytemuck::bytes_of(&P::from(thing)));
    }
    bytes
}

/// Appends things read from bytes in the shape `P`.
fn read<T, P: Pod + Into<T>>(bytes: &[u8], things: &mut Vec<T>) {
    let each = bytes.chunks_exact(size_of::<P>());
    things.extend(each.map(|bytes| bytemuck::pod_read_unaligned::<P>(bytes).into()));
}

macro_rules! layout {
    ($module:ident, $real:ident) => {
        mod $module {
            use super::{Layout, OUTCOMES, read, write};
            use crate::integrate::{self as host, Outcome};
            use crate::rod;
            use bytemuck::{Pod, Zeroable};

            #[derive(Clone, Copy, Pod, Zeroable)]
            #[repr(C)]
            pub struct Rod {
                pub taper: $real,
                pub bend: $real,
                pub slope: $real,
                pub pole: $real,
                pub friction: $real,
                pub gradient: $real,
                pub spiral: [$real; 2],
            }

            #[derive(Clone, Copy, Pod, Zeroable)]
            #[repr(C)]
            pub struct Piece {
                pub tau: $real,
                pub begin: $real,
                pub cubic: [$real; 4],
            }

            #[derive(Clone, Copy, Pod, Zeroable)]
            #[repr(C)]
            pub struct Shot {
                pub tau: $real,
                pub load: $real,
                pub pole_x: $real,
                pub pole_y: $real,
                pub rod: u32,
                pub steps: u32,
            }

            #[derive(Clone, Copy, Pod, Zeroable)]
            #[repr(C)]
            pub struct Hit {
                pub tau: $real,
                pub load: $real,
                pub residual: $real,
                pub steps: u32,
                pub outcome: u32,
            }

            impl From<&rod::Rod> for Rod {
                fn from(rod: &rod::Rod) -> Self {
                    Self {
                        taper: rod.taper as $real,
                        bend: rod.bend as $real,
                        slope: rod.slope as $real,
                        pole: rod.pole as $real,
                        friction: rod.friction as $real,
                        gradient: rod.gradient as $real,
                        spiral: rod.spiral.unwrap_or_default().map(|k| k as $real),
                    }
                }
            }

            impl From<&super::Stretch> for Piece {
                fn from(stretch: &super::Stretch) -> Self {
                    Self {
                        tau: stretch.tau as $real,
                        begin: stretch.piece.from as $real,
                        cubic: stretch.piece.cubic.map(|c| c as $real),
                    }
                }
            }

            impl From<&super::Task> for Shot {
                fn from(super::Task { shot, steps }: &super::Task) -> Self {
                    Self {
                        tau: shot.tau as $real,
                        load: shot.load as $real,
                        pole_x: shot.pole.x as $real,
                        pole_y: shot.pole.y as $real,
                        rod: shot.rod,
                        steps: *steps,
                    }
                }
            }

            impl From<Hit> for host::Hit {
                // Whatever the shader says, a number that is not finite is not a solution.
                fn from(hit: Hit) -> Self {
                    let finite = [hit.tau, hit.load, hit.residual]
                        .iter()
                        .all(|x| x.is_finite());
                    let outcome = OUTCOMES
                        .get(hit.outcome as usize)
                        .filter(|_| finite)
                        .map_or(Outcome::NotFinite, |&(_, outcome)| outcome);
                    Self {
                        tau: hit.tau.into(),
                        load: hit.load.into(),
                        residual: hit.residual.into(),
                        steps: hit.steps,
                        outcome,
                    }
                }
            }

            pub const LAYOUT: Layout = Layout {
                shot: size_of::<Shot>(),
                hit: size_of::<Hit>(),
                rods: write::<_, Rod>,
                pieces: write::<_, Piece>,
                shots: write::<_, Shot>,
                hits: read::<_, Hit>,
            };
        }
    };
}

layout!(single, f32);
layout!(double, f64);

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
        ($type:ty, $name:literal, $($member:ident),+) => {
            (
                $name.to_owned(),
                size_of::<$type>(),
                vec![$((stringify!($member).to_owned(), offset_of!($type, $member))),+],
            )
        };
    }

    macro_rules! agrees {
        ($module:ident, $precision:expr) => {
            let shader = in_shader($precision);
            for rust in [
                in_rust!(
                    $module::Rod,
                    "Rod",
                    taper,
                    bend,
                    slope,
                    pole,
                    friction,
                    gradient,
                    spiral
                ),
                in_rust!($module::Piece, "Piece", tau, begin, cubic),
                in_rust!($module::Shot, "Shot", tau, load, pole_x, pole_y, rod, steps),
                in_rust!($module::Hit, "Hit", tau, load, residual, steps, outcome),
            ] {
                assert_eq!(shader.iter().find(|s| s.0 == rust.0), Some(&rust));
            }
        };
    }

    #[test]
    fn shaders_and_rust_agree_on_every_offset() {
        agrees!(single, Precision::F32);
        agrees!(double, Precision::F64);
    }

    #[test]
    fn a_hit_that_is_not_finite_is_no_solution() {
        for (tau, code, outcome) in [
            (1.0, 0, Outcome::Converged),
            (f32::NAN, 0, Outcome::NotFinite),
            (1.0, 9, Outcome::NotFinite),
        ] {
            let hit = single::Hit {
                tau,
                load: 1.0,
                residual: 0.0,
                steps: 1,
                outcome: code,
            };
            let mut hits = Vec::new();
            (single::LAYOUT.hits)(bytemuck::bytes_of(&hit), &mut hits);
            assert_eq!(hits[0].outcome, outcome);
        }
    }
}
