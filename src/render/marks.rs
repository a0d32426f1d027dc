//! Marks of states whose contact does not slide toward the tip, and of states beyond the yield strain.

use super::RenderError;
use crate::classify::Status;
use crate::plan::{Channel, STATE_CHANNELS};
use crate::store::{ChannelValues, MapSlice};

/// Name in legends of states whose contact does not slide toward the tip.
const MARKED: &str = "slides to base, or sticks";

/// Name in legends of states beyond the yield strain.
pub const YIELDING: &str = "beyond the yield strain";

/// Returns true if the states in `channel` include some whose contact does not slide toward the tip.
fn has_marks(map: &MapSlice, channel: &str) -> Result<bool, RenderError> {
    let is_marked = STATE_CHANNELS.contains(&channel) && map.channels().contains(&"status");
    Ok(is_marked && map.codes("status")?.into_iter().any(|code| status(code).is_some()))
}

/// Mark of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellMark {
    /// The contact does not slide toward the tip.
    Status(Status),
    /// The largest strain exceeds the yield strain.
    Yields,
}

/// Marked cells of a map, and their name in its legend.
pub struct MapMarks {
    /// True if states whose contact does not slide toward the tip are marked.
    has_marks: bool,
    /// Yield strain of each panel beyond which its states are marked: `[panel]`, empty if there are none.
    yield_strains: Vec<Option<f64>>,
}

impl MapMarks {
    /// Finds the marks that occur in a picture of `channel`.
    pub fn new(map: &MapSlice, channel: &str) -> Result<Self, RenderError> {
        let mut marks = Self { has_marks: has_marks(map, channel)?, yield_strains: Vec::new() };
        if !map.channels().contains(&Channel::PeakStrain.name()) {
            return Ok(marks);
        }
        let yield_strains = map.yield_strains()?;
        for (index, most) in yield_strains.iter().enumerate() {
            if let Some(most) = *most
                && beyond(map, most, index)?.contains(&true)
            {
                marks.yield_strains = yield_strains;
                break;
            }
        }
        Ok(marks)
    }

    /// Returns the name of the marks in a legend; `None` without marks.
    pub fn name(&self) -> Option<String> {
        match (self.has_marks, self.yield_strains.is_empty()) {
            (true, false) => Some(format!("{MARKED}, or {YIELDING}")),
            (true, true) => Some(MARKED.to_owned()),
            (false, false) => Some(YIELDING.to_owned()),
            (false, true) => None,
        }
    }

    /// Returns the mark of each cell of a panel, `[distance][push_angle]`; nothing without marks. A cell with both marks has the mark of its status.
    pub fn of_panel(
        &self,
        map: &MapSlice,
        index: usize,
    ) -> Result<Vec<Option<CellMark>>, RenderError> {
        let mut marks = Vec::new();
        if let Some(most) = self.yield_strains.get(index).copied().flatten() {
            let beyond = beyond(map, most, index)?.into_iter();
            marks.extend(beyond.map(|yields| yields.then_some(CellMark::Yields)));
        }
        if self.has_marks
            && let ChannelValues::U32(codes) = map.read_panel("status", index)?
        {
            marks.resize(codes.len(), None);
            for (mark, code) in marks.iter_mut().zip(codes) {
                *mark = status(code).map(CellMark::Status).or(*mark);
            }
        }
        Ok(marks)
    }

    /// Returns true for each hatched cell of a panel, `[distance][push_angle]`; nothing without marks.
    pub fn hatched(&self, map: &MapSlice, index: usize) -> Result<Vec<bool>, RenderError> {
        let marks = self.of_panel(map, index)?;
        Ok(marks.iter().map(Option::is_some).collect())
    }
}

/// Returns true for each cell of a panel with a strain of more than `most`, `[distance][push_angle]`.
fn beyond(map: &MapSlice, most: f64, index: usize) -> Result<Vec<bool>, RenderError> {
    let strains = map.read_panel(Channel::PeakStrain.name(), index)?;
    Ok(strains.values().map(|strain| strain > most).collect())
}

/// Returns the status with this code if it marks a state whose contact does not slide toward the tip.
fn status(code: u32) -> Option<Status> {
    let mut marks = Status::NOT_TOWARD_TIP.into_iter();
    marks.find(|status| status.code() == code)
}
