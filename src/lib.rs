//! Regime maps of a tapered, curved whisker pushed against a pole: where it stays in contact, slips off, or is pulled off.
//!
//! The mechanics are those of Hires, Pammer, Svoboda and Golomb (2013), "Tapered whiskers are required for
//! active tactile sensation", eLife 2:e01350. `ARCHITECTURE.md` names the modules and the order in which data
//! passes them.
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
//! [`curve`] returns pairs of a whisker's place in the sweep and a [`Detachment`](trace::Detachment): first all distances on CF, then those on
//! CB. Values that do not exist are `None`. A loop over tapers:
//!
//! ```
//! use whiskmap::scene::{Parameter, Scene};
//! use whiskmap::Options;
//!
//! let scene = Scene::parse(include_str!("../scenes/cone.toml"), "cone.toml")?;
//! for taper in [0.0, 0.5, 1.0] {
//!     let tapered = scene.to_builder().set(Parameter::Taper, taper).distance_mm([15.66]).build()?;
//!     for (_, end) in whiskmap::curve(&tapered, Options::default())? {
//!         println!("{taper} {:?} {:?} {:?}", end.side, end.kind, end.push_angle_deg);
//!     }
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`map`](fn@map), [`for_each_panel`], [`curve`], [`branch`], [`shape`] and [`fit`](fn@fit) compute in memory, and [`lazy_map`] computes
//! whiskers when they are read. The modules below are the topics around them, and the stages of their computation, such as [`sheet`] and
//! [`engine`]. [`mechanics`] is the crate of rods and trajectories. All features but one are on by default: `fit` is least squares, `gpu` the
//! compute shaders, `render` the pictures, `zarr` the stores that many processes fill. `ndarray` adds views of channels as arrays.
//!
//! The crate `whiskmap-cli` is the program `whiskmap`.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

// Topics for users.
#[cfg(feature = "zarr")]
#[allow(
    clippy::disallowed_methods,
    reason = "pictures and comparisons need not have the same bits on every machine"
)]
pub mod compare;
pub mod design;
#[cfg(feature = "fit")]
pub mod fit;
pub mod force;
pub mod locate;
pub mod measured;
pub mod random;
#[cfg(feature = "render")]
#[allow(
    clippy::disallowed_methods,
    reason = "pictures and comparisons need not have the same bits on every machine"
)]
pub mod render;
pub mod scene;
pub mod sensitivity;
pub mod store;
pub mod texture;
pub mod trace;
pub mod traced;
pub mod tracking;
pub mod uncertainty;
pub mod whisk;
pub mod yields;

// Stages of a computation.
pub mod accuracy;
#[cfg(feature = "gpu")]
pub mod bench;
pub mod classify;
pub mod compute;
pub mod engine;
pub mod friction;
pub mod input;
mod least_squares;
pub mod map;
mod names;
mod newton;
#[cfg(feature = "render")]
#[allow(
    clippy::disallowed_methods,
    reason = "pictures and comparisons need not have the same bits on every machine"
)]
pub mod paper;
pub mod plan;
mod quantile;
pub mod refine;
pub mod sheet;
mod stopwatch;
pub mod terminal;

pub use classify::{Regime, Status};
pub use compute::{
    Error, Map, MapCell, MapEngine, Options, branch, curve, for_each_panel, lazy_map, map, shape,
};
pub use engine::Precision;
#[cfg(feature = "fit")]
pub use fit::fit;
pub use map::{Panel, Summary};
pub use plan::{Channel, Channels};
pub use whiskmap_mechanics as mechanics;
pub use whiskmap_mechanics::rod::Side;

/// README's code compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
