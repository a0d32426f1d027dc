//! The stored map: a multi-part EXR file that is enough to make the map again.

/// The channels of the part `state`, in the order of [`Panel::state`].
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
    /// [`crate::classify::Regime`] codes.
    pub regime: Vec<u32>,
    /// [`crate::classify::Status`] codes.
    pub status: Vec<u32>,
    /// One vector per name in [`STATE_CHANNELS`]; NaN where there is no contact.
    pub state: [Vec<f32>; STATE_CHANNELS.len()],
    /// Distance of the solution's pole centre from the wanted one, relative to the whisker's length; NaN
    /// where there is no contact.
    pub residual: Vec<f32>,
    /// Push angle left until detachment; NaN where there is no contact.
    pub margin_deg: Vec<f32>,
    /// Newton steps taken, engine and refinement together.
    pub newton_steps: Vec<u32>,
}
