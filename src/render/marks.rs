//! Marks of states whose contact does not slide toward the tip.

use super::RenderError;
use crate::classify::Status;
use crate::store::{MapSlice, STATE_CHANNELS};

/// Name in legends of states whose contact does not slide toward the tip.
pub const MARKED: &str = "slides to base, or sticks";

/// Returns true if the states in `channel` include some whose contact does not slide toward the tip.
pub fn has_marks(map: &MapSlice, channel: &str) -> Result<bool, RenderError> {
    let is_marked = STATE_CHANNELS.contains(&channel) && map.channels().contains(&"status");
    Ok(is_marked && map.codes("status")?.into_iter().any(is_mark))
}

/// Returns true if the code of a status marks a state whose contact does not slide toward the tip.
pub fn is_mark(code: u32) -> bool {
    let mut marks = Status::NOT_TOWARD_TIP.iter();
    marks.any(|status| status.code() == code)
}
