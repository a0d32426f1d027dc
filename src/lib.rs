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
//!     let own = scene.to_builder().set(Parameter::Taper, taper).distance_mm([15.66]).build()?;
//!     for (_, end) in whiskmap::curve(&own, Options::default())? {
//!         println!("{taper} {:?} {:?} {:?}", end.side, end.kind, end.push_angle_deg);
//!     }
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`map`](fn@map), [`for_each_panel`], [`curve`], [`branch`], [`shape`] and [`fit`](fn@fit) compute in memory, and [`lazy_map`] computes
//! whiskers when they are read; the modules below are the topics around them. All features are on by default: `cli` is the command `whiskmap`, `fit` least squares, `gpu` the compute shaders,
//! `render` the pictures, `zarr` the stores that many processes fill. `ndarray`, which is off by default, adds views of channels as
//! arrays.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

// The command line uses the library by the same paths as every other program.
#[cfg(feature = "cli")]
extern crate self as whiskmap;

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
pub mod uncertainty;
pub mod whisk;

/// The command line: `main` of the program and of the Python package.
#[cfg(feature = "cli")]
#[allow(
    clippy::disallowed_methods,
    reason = "messages and pictures need not have the same bits on every machine"
)]
#[doc(hidden)]
pub mod cli;

// Internals, public for the command, the tests and the benches.
#[doc(hidden)]
pub mod accuracy;
#[cfg(feature = "gpu")]
#[doc(hidden)]
pub mod bench;
#[doc(hidden)]
pub mod classify;
#[doc(hidden)]
pub mod engine;
#[doc(hidden)]
pub mod friction;
mod front;
#[doc(hidden)]
pub mod input;
mod least_squares;
#[doc(hidden)]
pub mod map;
mod newton;
#[cfg(feature = "render")]
#[allow(
    clippy::disallowed_methods,
    reason = "pictures and comparisons need not have the same bits on every machine"
)]
#[doc(hidden)]
pub mod paper;
#[doc(hidden)]
pub mod plan;
#[doc(hidden)]
pub mod refine;
#[doc(hidden)]
pub mod sheet;
mod stopwatch;
#[doc(hidden)]
pub mod terminal;
#[doc(hidden)]
pub use whiskmap_mechanics::{numerics, rod, shooting};

pub use classify::{Regime, Status};
pub use engine::Precision;
#[cfg(feature = "fit")]
pub use front::fit;
pub use front::{
    Error, Map, MapCell, MapEngine, Options, branch, curve, for_each_panel, lazy_map, map, shape,
};
pub use map::{Panel, Summary};
pub use plan::{Channel, Channels};
pub use rod::Side;

/// README's code compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
