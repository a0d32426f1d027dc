//! A scene: what to simulate, read from TOML and checked. An accepted scene is valid everywhere after.
//!
//! Text (`checked`) becomes tables (`file`, `axis`, `rows`), tables become a [`Setup`] (`check`, `sweep`, `limits`), and
//! whatever is refused becomes one message that points into the text (`error`). Only what was checked is a [`Scene`].

mod axis;
mod check;
mod checked;
mod deviations;
mod error;
mod file;
mod grid;
mod limits;
mod mechanics;
mod parameter;
mod profile;
mod rows;
mod setup;
mod shape;
mod source;
mod sweep;
mod varied;
mod warnings;
mod whisker;

pub(crate) use grid::NEAREST;

pub use check::LONGEST_TITLE;
pub use checked::Scene;
pub use deviations::Deviations;
pub use error::SceneError;
pub use grid::{Grid, Place, SweepAxis};
pub use limits::digits;
pub use parameter::Parameter;
pub use setup::Setup;
pub use whisker::{Curvature, EulerSpiral, Pole, Swept, Whisker};
