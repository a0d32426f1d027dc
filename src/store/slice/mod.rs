//! Slices: parts of a map in which the values of some axes are fixed.

mod part;
mod values;

pub use part::GridPart;

use super::at::{AxisValue, InvalidAxisValue, readable, titled};
use super::{AtlasLayout, MapSource, StoreError, StoredMap};
use crate::scene::{Coordinate, Grid, Scene};
use std::ops::Range;

/// Slice: a part of a map, stored or computed, that is read panel by panel.
#[derive(Debug)]
pub struct MapSlice {
    source: MapSource,
    part: GridPart,
    /// Whiskers of the whole that read as not computed, as ranges in order.
    blank: Vec<Range<usize>>,
}

impl MapSlice {
    /// Creates the slice of `source` at the values nearest to those `wanted`, which must be values of the axes if `exact`.
    ///
    /// # Errors
    /// An axis is unknown or given twice, ends more than half a step before the value, or does not have it although `exact`.
    pub fn new(
        source: MapSource,
        wanted: &[AxisValue],
        exact: bool,
    ) -> Result<Self, InvalidAxisValue> {
        let part = GridPart::new(source.grid(), wanted, exact)?;
        Ok(Self::of_part(source, part))
    }

    /// Creates the slice of `source` that is a `part` of its grid.
    #[must_use]
    pub const fn of_part(source: MapSource, part: GridPart) -> Self {
        let blank = Vec::new();
        Self { source, part, blank }
    }

    /// Creates the slice that is the whole of `source`.
    #[must_use]
    pub fn whole(source: MapSource) -> Self {
        let part = GridPart::whole(source.grid());
        Self::of_part(source, part)
    }

    /// Fixes the sweep axes that have one value. The title does not name them.
    pub fn fix_single_axes(&mut self) {
        for (fixed, axis) in self.part.fixed.iter_mut().zip(&self.source.grid().sweep) {
            if axis.values.len() == 1 {
                *fixed = Some(0);
            }
        }
        self.part.grid.sweep.retain(|axis| axis.values.len() > 1);
    }

    /// Lets unfinished blocks of a store be read: their codes are [`NOT_COMPUTED`](super::NOT_COMPUTED), all other values are NaN. Returns
    /// the number of such panels of the slice.
    ///
    /// # Errors
    /// The file system refuses to look for a file.
    pub fn blank_missing(&mut self) -> Result<usize, StoreError> {
        self.blank = self.source.missing()?;
        if self.blank.is_empty() {
            return Ok(0);
        }
        let panels = 0..self.part.grid.whisker_count();
        let is_blank = |whisker: &usize| self.is_blank(self.in_whole(*whisker));
        let count = panels.filter(is_blank).count();
        if count == 0 {
            self.blank.clear();
        }
        Ok(count)
    }

    /// Returns true if panels of the slice read as not computed, see [`MapSlice::blank_missing`].
    #[must_use]
    pub fn has_blanks(&self) -> bool {
        !self.blank.is_empty()
    }

    /// Returns true if whisker `index` of the whole reads as not computed.
    fn is_blank(&self, index: usize) -> bool {
        let place = self.blank.partition_point(|range| range.end <= index);
        let range = self.blank.get(place);
        range.is_some_and(|range| range.contains(&index))
    }

    /// Returns the whole map of the slice.
    #[must_use]
    pub fn source(&self) -> &MapSource {
        &self.source
    }

    /// Returns the axes of the slice. A fixed sweep axis is absent; a fixed axis of the panels has one value.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.part.grid
    }

    /// Returns the numbers of panels and cells of the slice, which has at most two sweep axes.
    #[must_use]
    pub fn layout(&self) -> AtlasLayout {
        AtlasLayout::of(&self.part.grid)
    }

    /// Returns names and values of the fixed axes of the slice, `[axis]`, each in the unit of its axis.
    #[must_use]
    pub fn chosen(&self) -> &[(&'static str, Coordinate)] {
        &self.part.chosen
    }

    /// Returns names of the fixed axes of the slice, and their values as text to six digits.
    pub fn readable(&self) -> impl Iterator<Item = (&'static str, String)> + '_ {
        readable(&self.part.chosen)
    }

    /// Returns the title of the scene with the fixed values, one line.
    #[must_use]
    pub fn title(&self) -> String {
        titled(self.source.title(), &self.part.chosen)
    }

    /// Returns the names of all channels of the slice, `[channel]`.
    #[must_use]
    pub fn channels(&self) -> Vec<&'static str> {
        self.source.channels()
    }

    /// Returns true if all whiskers of the whole map or store are straight; false if this version cannot read the scene.
    ///
    /// # Errors
    /// The map or store has no scene.
    pub fn is_straight(&self) -> Result<bool, StoreError> {
        let scene = self.scene()?;
        Ok(scene.is_some_and(|scene| scene.is_straight()))
    }

    /// Returns the yield strain of the whisker of each panel of the slice: `[panel]`, `None` where it is not known. Empty if no whisker of the
    /// map or store has one, or if this version cannot read the scene.
    ///
    /// # Errors
    /// The map or store has no scene.
    pub fn yield_strains(&self) -> Result<Vec<Option<f64>>, StoreError> {
        let Some(scene) = self.scene()?.filter(|scene| scene.has_yield_strain()) else {
            return Ok(Vec::new());
        };
        let panels = 0..self.part.grid.whisker_count();
        let strain = |panel| scene.whisker(self.in_whole(panel)).ok()?.whisker.yield_strain;
        Ok(panels.map(strain).collect())
    }

    /// The scene of the map or store; `None` if this version cannot read it.
    fn scene(&self) -> Result<Option<Scene>, StoreError> {
        Ok(self.source.scene()?.ok())
    }

    /// Returns the indices of the slice's whiskers in the slice, in the order in which its last axis varies fastest.
    pub fn whiskers(&self) -> impl Iterator<Item = usize> + '_ {
        let sizes = self.part.grid.sweep.iter().map(|axis| axis.values.len());
        let sizes: Vec<usize> = sizes.collect();
        (0..self.part.grid.whisker_count()).map(move |place| {
            let (mut rest, mut stride) = (place, self.part.grid.whisker_count());
            let axes = sizes.iter().rev().map(|size| {
                stride /= size;
                let at = rest % size;
                rest /= size;
                at * stride
            });
            axes.sum()
        })
    }

    /// Returns names and values of all sweep axes of the whole map or store, for a whisker of the slice, `[axis]`.
    #[must_use]
    pub fn place(&self, whisker: usize) -> Vec<(&'static str, Coordinate)> {
        let place = self.source.grid().place(self.in_whole(whisker));
        place.coordinates().collect()
    }

    /// Returns the sizes of the axes of the slice that are not fixed, `[axis]`: the sweep axes, then distance and push angle.
    #[must_use]
    pub fn shape(&self) -> Vec<usize> {
        let sweep = self.part.grid.sweep.iter().map(|axis| axis.values.len());
        let inside =
            [("distance_mm", self.part.rows.len()), ("push_angle_deg", self.part.columns.len())];
        let is_left = |name: &str| self.part.chosen.iter().all(|(chosen, _)| *chosen != name);
        let inside = inside.into_iter().filter(|(name, _)| is_left(name));
        sweep.chain(inside.map(|(_, size)| size)).collect()
    }

    /// Index in the whole sweep of a whisker of the part.
    fn in_whole(&self, whisker: usize) -> usize {
        let mut left = self.part.grid.indices(whisker).into_iter();
        let (mut index, mut stride) = (0, 1);
        for (axis, fixed) in self.source.grid().sweep.iter().zip(&self.part.fixed) {
            let at = fixed.or_else(|| left.next()).unwrap_or_default();
            index += at * stride;
            stride *= axis.values.len();
        }
        index
    }
}

/// The whole map.
impl From<StoredMap> for MapSlice {
    fn from(map: StoredMap) -> Self {
        Self::whole(MapSource::Exr(Box::new(map)))
    }
}
