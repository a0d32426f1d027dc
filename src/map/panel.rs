//! One whisker's map.

use crate::classify::{Regime, Status};

/// The channels of a state, in the order of [`Panel::state`].
pub const STATE_CHANNELS: [&str; 9] = [
    "arc_length_mm",
    "contact_angle_deg",
    "force_un",
    "base_force_x_un",
    "base_force_y_un",
    "base_moment_nnm",
    "push_chord_deg",
    "contact_distance_mm",
    "energy_nj",
];

/// One whisker's map. Every vector has `distances * push_angles` cells; cell `(row, column)` is at
/// `row * push_angles + column`; row 0 is the first distance, column 0 the first push angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// [`Regime`] codes.
    pub regime: Vec<u32>,
    /// [`Status`] codes.
    pub status: Vec<u32>,
    /// One vector per name in [`STATE_CHANNELS`]; NaN where there is no contact.
    pub state: [Vec<f32>; STATE_CHANNELS.len()],
    /// Distance of the solution's pole centre from the wanted one, relative to the whisker's length; that of
    /// the last state computed where a cell is unresolved, NaN where there is no contact.
    pub residual: Vec<f32>,
    /// Push angle left until detachment; NaN where there is no contact.
    pub margin_deg: Vec<f32>,
    /// Newton steps taken, engine and refinement together.
    pub newton_steps: Vec<u32>,
}

impl Panel {
    /// A panel of so many cells, none of which has an answer.
    #[must_use]
    pub fn unresolved(cells: usize) -> Self {
        Self {
            regime: vec![Regime::Unresolved.code(); cells],
            status: vec![Status::NotConverged.code(); cells],
            state: std::array::from_fn(|_| vec![f32::NAN; cells]),
            residual: vec![f32::NAN; cells],
            margin_deg: vec![f32::NAN; cells],
            newton_steps: vec![0; cells],
        }
    }
}
