//! Marks of states whose friction is not the assumed one.

use super::RenderError;
use crate::classify::Status;
use crate::store::{MapSlice, STATE_CHANNELS};

/// Name in legends of states whose friction is not the assumed one.
pub const OFF: &str = "off: friction is not as assumed";

/// Returns true if the states in `channel` include some whose friction is not the assumed one.
pub fn has_marks(map: &MapSlice, channel: &str) -> Result<bool, RenderError> {
    let is_marked = STATE_CHANNELS.contains(&channel) && map.channels().contains(&"status");
    Ok(is_marked && map.codes("status")?.into_iter().any(is_mark))
}

/// Returns true if the code of a status marks a state whose friction is not the assumed one.
pub fn is_mark(code: u32) -> bool {
    Status::MARKS.iter().any(|status| status.code() == code)
}
