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
mod rows;
#[allow(clippy::module_inception, reason = "the type that this module is named after")]
mod scene;
mod shape;
mod smooth;
mod substitutes;
mod surface;
mod sweep;
mod table;
mod toml;
mod warnings;
mod whisker;

pub(crate) use grid::NEAREST;

pub use axis::{AxisScale, AxisValues};
pub use builder::{Deviations, FrameDeviations, SceneBuilder};
pub use check::LONGEST_TITLE;
pub use data::{RefusedWhisker, SceneData, SweptWhisker};

pub use error::SceneError;
pub use grid::{Coordinate, Grid, SweepAxis, SweepPlace, SweepVariable};
pub use limits::{digits, rounded};
pub use parameter::Parameter;
pub(crate) use parameter::derivative_columns;
pub use scene::Scene;
pub(crate) use scene::range_around;
pub use smooth::SmoothRadii;
pub use surface::Surface;
pub use table::{TableWhisker, WhiskerRow};
pub use toml::SceneText;
pub(crate) use warnings::LENGTH_MM;
pub use whisker::{Curvature, EulerSpiral, Pole, Whisker};
