//! Values of slices: channels, panels, and the codes that occur.

use super::MapSlice;
use crate::map::Panel;
use crate::plan::{Channels, STATE_CHANNELS};
use crate::store::{ChannelValues, MapSource, NOT_COMPUTED, StoreError};
use std::collections::{BTreeMap, BTreeSet};

impl MapSlice {
    /// Reads a channel of a whisker of the slice: `[distance][push_angle]`. `whisker` is an index in the slice, whose first sweep axis
    /// varies fastest.
    ///
    /// # Errors
    /// There is no such channel or whisker, or it is missing or damaged.
    pub fn read_panel(&self, channel: &str, whisker: usize) -> Result<ChannelValues, StoreError> {
        let panels = self.part.grid.whisker_count();
        if whisker >= panels {
            return Err(StoreError::NoSuchPanel { index: whisker, panels });
        }
        if self.is_blank(self.in_whole(whisker)) {
            let cells = self.part.rows.len() * self.part.columns.len();
            return Ok(match self.source.names(channel) {
                Some(_) => ChannelValues::U32(vec![NOT_COMPUTED.into(); cells]),
                None => ChannelValues::F32(vec![f32::NAN; cells]),
            });
        }
        let width = self.source.grid().push_angle_deg.len();
        let rows = self.part.rows.iter();
        let cells =
            rows.flat_map(|row| self.part.columns.iter().map(move |column| row * width + column));
        let samples = self.source.read_panel(channel, self.in_whole(whisker))?;
        Ok(match samples {
            ChannelValues::F32(values) => {
                ChannelValues::F32(cells.map(|cell| values[cell]).collect())
            }
            ChannelValues::U32(codes) => {
                ChannelValues::U32(cells.map(|cell| codes[cell]).collect())
            }
        })
    }

    /// Reads the `channels` of a whisker of the slice; all other channels are as in [`Panel::unresolved`]. `whisker` is an index in the
    /// slice, whose first sweep axis varies fastest.
    ///
    /// # Errors
    /// An error of [`MapSlice::read_panel`].
    pub fn panel(&self, channels: Channels, whisker: usize) -> Result<Panel, StoreError> {
        let mut panel = Panel::unresolved(self.part.rows.len() * self.part.columns.len(), channels);
        for name in channels.names() {
            let state = STATE_CHANNELS.iter().position(|channel| *channel == name);
            match (self.read_panel(name, whisker)?, name, state) {
                (ChannelValues::U32(codes), "regime", _) => panel.regime = codes,
                (ChannelValues::U32(codes), "status", _) => panel.status = codes,
                (ChannelValues::U32(counts), ..) => panel.newton_steps = counts,
                (ChannelValues::F32(values), _, Some(place)) => panel.state[place] = values,
                (ChannelValues::F32(values), "margin_deg", _) => panel.margin_deg = values,
                (ChannelValues::F32(values), "residual", _) => panel.residual = values,
                (ChannelValues::F32(values), "peak_strain", _) => panel.peak_strain = values,
                (ChannelValues::F32(values), ..) => {
                    if let Some(derivative) = panel.push_derivative_mut(name) {
                        *derivative = values;
                    }
                }
            }
        }
        Ok(panel)
    }

    /// Returns the names of the codes of `regime` or `status` in the slice, by code, with the name of cells that are not computed. `None`
    /// for other channels.
    #[must_use]
    pub fn names(&self, channel: &str) -> Option<BTreeMap<u32, String>> {
        let mut names = self.source.names(channel)?;
        names.insert(NOT_COMPUTED.into(), "not computed".to_owned());
        Some(names)
    }

    /// Returns the codes of a channel that occur in the slice.
    ///
    /// # Errors
    /// An error of [`MapSlice::read_panel`].
    pub fn codes(&self, channel: &str) -> Result<BTreeSet<u32>, StoreError> {
        // The header of a whole map has the counts.
        if let (MapSource::Exr(map), []) = (&self.source, &*self.part.chosen) {
            return Ok(map.codes(channel));
        }
        let mut codes = BTreeSet::new();
        for whisker in 0..self.part.grid.whisker_count() {
            if let ChannelValues::U32(whisker_codes) = self.read_panel(channel, whisker)? {
                codes.extend(whisker_codes);
            }
        }
        Ok(codes)
    }
}
