//! `whiskmap`: where does a tapered, curved whisker pushed against a pole stay in contact, where does it
//! slip off, and where is it pulled off?
//!
//! The mechanics are those of Hires, Pammer, Svoboda and Golomb (2013), "Tapered whiskers are required for
//! active tactile sensation", eLife 2:e01350. `ARCHITECTURE.md` names the rooms and the way data takes
//! through them.
//!
//! ```
//! use whiskmap::scene::Scene;
//! use whiskmap::{Options, trace::DetachmentKind};
//!
//! let scene = Scene::parse(include_str!("../scenes/cone.toml"), "cone.toml")?;
//! let ends = whiskmap::curve(&scene.to_builder().distance_mm([10.0, 19.5]).build()?, Options::default())?;
//! let kinds: Vec<DetachmentKind> = ends.iter().map(|(_, end)| end.kind).collect();
//! assert_eq!(kinds[2..], [DetachmentKind::SlipOff, DetachmentKind::PullOff]); // CB, near and far
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`map`](fn@map), [`for_each_panel`], [`curve`], [`branch`], [`shape`] and [`fit`](fn@fit) answer in memory; the modules are what they are made of. Features, all on by
//! default: `cli` is the command `whiskmap`, `fit` least squares, `gpu` the compute shaders, `render` the pictures.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod accuracy;
#[cfg(feature = "gpu")]
pub mod bench;
pub mod classify;
pub mod design;
pub mod engine;
#[cfg(feature = "fit")]
pub mod fit;
mod front;
pub mod input;
pub mod map;
pub mod measured;
mod newton;
#[cfg(feature = "render")]
#[allow(
    clippy::disallowed_methods,
    reason = "pictures and comparisons need not have the same bits on every machine"
)]
pub mod paper;
pub mod plan;
pub mod refine;
#[cfg(feature = "render")]
#[allow(
    clippy::disallowed_methods,
    reason = "pictures and comparisons need not have the same bits on every machine"
)]
pub mod render;
pub mod scene;
pub mod sheet;
pub mod store;
pub mod trace;
pub mod uncertainty;

#[cfg(feature = "fit")]
pub use front::fit;
pub use front::{Error, Map, Options, branch, curve, for_each_panel, map, shape};
pub use whiskmap_mechanics::{numerics, rod, shooting};

/// README's code compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
