//! Options of the pictures of maps.

use crate::store::MapSlice;
use whiskmap_plot::PictureSize;

/// Options of the picture of a map: channel, scale of its values, and size.
#[derive(Clone, Copy, Debug, Default)]
pub struct MapOptions<'a> {
    /// Name of the drawn channel. `None` draws the regimes, with the detachment boundary over them.
    pub channel: Option<&'a str>,
    /// True if the scale of the map's values is logarithmic: values at or below 0 are blank; without a range, a colour bar starts at the
    /// 1st percentile of the positive values. `None` for a logarithmic colour scale of loads and energies that span more than two decades,
    /// and linear ones otherwise. On a logarithmic scale, a moment is shown by its size.
    pub log: Option<bool>,
    /// Ends `[low, high]` of the colour bar, in the channel's unit; values beyond them take the colours of the ends. `None` for the
    /// extent of the values.
    pub range: Option<[f64; 2]>,
    /// True if the picture has no title.
    pub without_title: bool,
    /// Size of the picture.
    pub size: PictureSize,
}

impl MapOptions<'_> {
    /// Returns the title of the picture of a map; empty without one.
    pub(super) fn title(&self, map: &MapSlice) -> String {
        match self.without_title {
            true => String::new(),
            false => map.title(),
        }
    }
}
