//! Scenes: checked descriptions of whiskers, poles and grids. An accepted scene is valid in all later modules.
//!
//! A [`SceneBuilder`] holds the numbers as they are given. `check` turns it into [`SceneData`], and only checked data becomes a
//! [`Scene`]. `toml` reads builders from files, writes them, and adds the place in the file to what the checks refuse.

mod axis;
mod builder;
mod check;
mod data;
mod deviations;
mod error;
mod grid;
mod limits;
mod parameter;
mod profile;
#[allow(
    clippy::module_inception,
    reason = "the type that this module is named after"
)]
mod scene;
mod shape;
mod smooth;
mod surface;
mod sweep;
mod toml;
mod warnings;
mod whisker;

pub(crate) use grid::NEAREST;

pub use axis::{AxisScale, AxisValues};
pub use builder::{Deviations, FrameDeviations, SceneBuilder};
pub use check::LONGEST_TITLE;
pub use data::SceneData;

pub use error::SceneError;
pub use grid::{Grid, SweepAxis, SweepPlace};
pub use limits::{digits, rounded};
pub use parameter::Parameter;
pub(crate) use parameter::derivative_columns;
pub use scene::Scene;
pub use smooth::SmoothRadii;
pub use surface::Surface;
pub use toml::SceneText;
pub use whisker::{Curvature, EulerSpiral, Pole, SweptWhisker, Whisker};
