//! Slices: parts of a map or a store in which the values of some axes are fixed.

mod values;

use super::at::{AxisValue, ChosenValues, InvalidAxisValue, readable, select, titled};
use super::{AtlasLayout, MapSource, StoreError, StoredMap};
use crate::scene::{Grid, Scene};
use std::ops::Range;

/// Slice: a part of a map or a store, read panel by panel.
#[derive(Debug)]
pub struct MapSlice {
    stored: MapSource,
    grid: Grid,
    /// Selected rows and columns of each panel.
    rows: Vec<usize>,
    columns: Vec<usize>,
    chosen: ChosenValues,
    /// Selected index of each sweep axis of the whole.
    fixed: Vec<Option<usize>>,
    /// Whiskers of the whole that read as not computed, as ranges in order.
    blank: Vec<Range<usize>>,
}

impl MapSlice {
    /// Creates the slice of `stored` at the values nearest to those `wanted`, which must be values of the axes if `exact`.
    ///
    /// # Errors
    /// An axis is unknown or given twice, ends more than half a step before the value, or does not have it although `exact`.
    pub fn new(
        stored: MapSource,
        wanted: &[AxisValue],
        exact: bool,
    ) -> Result<Self, InvalidAxisValue> {
        let mut slice = Self::whole(stored);
        for at in wanted {
            let chosen = slice.choose(at, exact);
            chosen.map_err(|why| InvalidAxisValue::new(at, why))?;
        }
        Ok(slice)
    }

    /// Creates the slice that is the whole of `stored`.
    #[must_use]
    pub fn whole(stored: MapSource) -> Self {
        let grid = stored.grid().clone();
        Self {
            rows: (0..grid.distance_mm.len()).collect(),
            columns: (0..grid.push_angle_deg.len()).collect(),
            chosen: Vec::new(),
            fixed: vec![None; grid.sweep.len()],
            blank: Vec::new(),
            grid,
            stored,
        }
    }

    fn choose(&mut self, at: &AxisValue, exact: bool) -> Result<(), String> {
        let whole = self.stored.grid();
        let sweep = whole.sweep.iter();
        let sweep = sweep.map(|axis| (axis.parameter.axis(), &*axis.values));
        let inside = [
            ("distance_mm", &*whole.distance_mm),
            ("push_angle_deg", &*whole.push_angle_deg),
        ];
        let axes: Vec<_> = sweep.chain(inside).collect();
        let (axis, index) = select(&axes, &self.chosen, at, exact)?;
        let (name, value) = (axes[axis].0, axes[axis].1[index]);
        self.chosen.push((name, value));
        match name {
            "distance_mm" => {
                self.rows = vec![index];
                self.grid.distance_mm = vec![value];
            }
            "push_angle_deg" => {
                self.columns = vec![index];
                self.grid.push_angle_deg = vec![value];
            }
            _ => {
                self.fixed[axis] = Some(index);
                let sweep = &mut self.grid.sweep;
                sweep.retain(|axis| axis.parameter.axis() != name);
            }
        }
        Ok(())
    }

    /// Fixes the sweep axes that have one value. The title does not name them.
    pub fn fix_single_axes(&mut self) {
        for (fixed, axis) in self.fixed.iter_mut().zip(&self.stored.grid().sweep) {
            if axis.values.len() == 1 {
                *fixed = Some(0);
            }
        }
        self.grid.sweep.retain(|axis| axis.values.len() > 1);
    }

    /// Lets unfinished blocks of a store be read: their codes are [`NOT_COMPUTED`](super::NOT_COMPUTED), all other values are NaN. Returns
    /// the number of such panels of the slice.
    ///
    /// # Errors
    /// The file system refuses to look for a file.
    pub fn blank_missing(&mut self) -> Result<usize, StoreError> {
        self.blank = self.stored.missing()?;
        let panels = 0..self.grid.whisker_count();
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

    /// Returns the whole map or store of the slice.
    #[must_use]
    pub fn stored(&self) -> &MapSource {
        &self.stored
    }

    /// Returns the axes of the slice. A fixed sweep axis is absent; a fixed axis of the panels has one value.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Returns the numbers of panels and cells of the slice, which has at most two sweep axes.
    #[must_use]
    pub fn layout(&self) -> AtlasLayout {
        AtlasLayout::of(&self.grid)
    }

    /// Returns names and values of the fixed axes of the slice, `[axis]`, each in the unit of its axis.
    #[must_use]
    pub fn chosen(&self) -> &[(&'static str, f64)] {
        &self.chosen
    }

    /// Returns names of the fixed axes of the slice, and their values as text to four digits.
    pub fn readable(&self) -> impl Iterator<Item = (&'static str, String)> + '_ {
        readable(&self.chosen)
    }

    /// Returns the title of the scene with the fixed values, one line.
    #[must_use]
    pub fn title(&self) -> String {
        titled(self.stored.title(), &self.chosen)
    }

    /// Returns the names of all channels of the slice, `[channel]`.
    #[must_use]
    pub fn channels(&self) -> Vec<&'static str> {
        self.stored.channels()
    }

    /// Returns true if all whiskers of the whole map or store are straight; false if this version cannot read the scene.
    ///
    /// # Errors
    /// The map or store has no scene.
    pub fn is_straight(&self) -> Result<bool, StoreError> {
        let scene = self.scene()?;
        Ok(scene.is_some_and(|scene| scene.is_straight()))
    }

    /// The scene of the map or store; `None` if this version cannot read it.
    fn scene(&self) -> Result<Option<Scene>, StoreError> {
        Ok(self.stored.scene()?.ok())
    }

    /// Returns the indices of the slice's whiskers in the slice, in the order in which its last axis varies fastest.
    pub fn whiskers(&self) -> impl Iterator<Item = usize> + '_ {
        let sizes = self.grid.sweep.iter().map(|axis| axis.values.len());
        let sizes: Vec<usize> = sizes.collect();
        (0..self.grid.whisker_count()).map(move |place| {
            let (mut rest, mut stride) = (place, self.grid.whisker_count());
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
    pub fn place(&self, whisker: usize) -> Vec<(&'static str, f64)> {
        let place = self.stored.grid().place(self.in_whole(whisker));
        let values = place.values();
        values
            .map(|(parameter, value)| (parameter.axis(), value))
            .collect()
    }

    /// Returns the sizes of the axes of the slice that are not fixed, `[axis]`: the sweep axes, then distance and push angle.
    #[must_use]
    pub fn shape(&self) -> Vec<usize> {
        let sweep = self.grid.sweep.iter().map(|axis| axis.values.len());
        let inside = [
            ("distance_mm", self.rows.len()),
            ("push_angle_deg", self.columns.len()),
        ];
        let is_left = |name: &str| self.chosen.iter().all(|(chosen, _)| *chosen != name);
        let inside = inside.into_iter().filter(|(name, _)| is_left(name));
        sweep.chain(inside.map(|(_, size)| size)).collect()
    }

    /// Index in the whole sweep of a whisker of the part.
    fn in_whole(&self, whisker: usize) -> usize {
        let mut left = self.grid.indices(whisker).into_iter();
        let (mut index, mut stride) = (0, 1);
        for (axis, fixed) in self.stored.grid().sweep.iter().zip(&self.fixed) {
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
