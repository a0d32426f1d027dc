//! Slices: parts of a map or a store in which the values of some axes are fixed.

use super::at::{AxisValue, check_near, nearest, with_unit};
use super::{
    AtlasLayout, ChannelValues, Channels, MapSource, Panel, STATE_CHANNELS, StoreError, StoredMap,
};
use crate::input::did_you_mean;
use crate::scene::{Grid, Scene, digits};
use std::collections::{BTreeMap, BTreeSet};

/// Error of a selected value that an axis does not have.
#[derive(Debug, thiserror::Error)]
#[error("{axis}: {why}")]
pub struct InvalidAxisValue {
    axis: String,
    why: String,
}

/// Slice: a part of a map or a store, read panel by panel.
#[derive(Debug)]
pub struct MapSlice {
    stored: MapSource,
    grid: Grid,
    /// Selected rows and columns of each panel.
    rows: Vec<usize>,
    columns: Vec<usize>,
    chosen: Vec<(&'static str, f64)>,
    /// Selected index of each sweep axis of the whole.
    fixed: Vec<Option<usize>>,
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
            slice.choose(at, exact).map_err(|why| InvalidAxisValue {
                axis: at.axis.clone(),
                why,
            })?;
        }
        Ok(slice)
    }

    fn whole(stored: MapSource) -> Self {
        let grid = stored.grid().clone();
        Self {
            rows: (0..grid.distance_mm.len()).collect(),
            columns: (0..grid.push_angle_deg.len()).collect(),
            chosen: Vec::new(),
            fixed: vec![None; grid.sweep.len()],
            grid,
            stored,
        }
    }

    fn choose(&mut self, at: &AxisValue, exact: bool) -> Result<(), String> {
        let whole = self.stored.grid();
        let sweep = whole.sweep.iter();
        let sweep = sweep.map(|axis| (axis.parameter.axis(), &axis.values));
        let inside = [
            ("distance_mm", &whole.distance_mm),
            ("push_angle_deg", &whole.push_angle_deg),
        ];
        let axes: Vec<(&'static str, &Vec<f64>)> = sweep.chain(inside).collect();
        let names = || axes.iter().map(|(name, _)| *name).collect::<Vec<_>>();
        let axis = axes.iter().position(|(name, _)| *name == at.axis);
        let unknown = || {
            let hint = did_you_mean(&at.axis, names());
            format!("must be one of the axes, {}{hint}", names().join(", "))
        };
        let axis = axis.ok_or_else(unknown)?;
        let (name, values) = axes[axis];
        let index = nearest(values, at.value);
        let value = values[index];
        if exact && value != at.value {
            let [wanted, value] = [at.value, value].map(|own| with_unit(name, own));
            return Err(format!(
                "{wanted} is no value of the axis; the nearest is {value}"
            ));
        }
        check_near(name, values, at.value)?;
        if self.chosen.iter().any(|(other, _)| *other == name) {
            return Err("is given twice".to_owned());
        }
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

    /// Returns names and values of the fixed axes of the slice, each in the unit of its axis.
    #[must_use]
    pub fn chosen(&self) -> &[(&'static str, f64)] {
        &self.chosen
    }

    /// Returns names of the fixed axes of the slice, and their values as text to four digits.
    pub fn readable(&self) -> impl Iterator<Item = (&'static str, String)> + '_ {
        self.chosen.iter().map(|(name, value)| {
            let rounded = format!("{value:.3e}").parse().unwrap_or(*value);
            (*name, digits(rounded))
        })
    }

    /// Returns the title of the scene with the fixed values, one line.
    #[must_use]
    pub fn title(&self) -> String {
        let chosen = self.readable();
        let chosen = chosen.map(|(name, value)| format!(", {name} = {value}"));
        std::iter::once(self.stored.title().to_owned())
            .chain(chosen)
            .collect()
    }

    /// Returns the names of all channels of the slice, `[channel]`.
    #[must_use]
    pub fn channels(&self) -> Vec<&'static str> {
        self.stored.channels()
    }

    /// Returns true if a whisker of the slice has friction with its pole, or this version cannot read the scene.
    ///
    /// # Errors
    /// The map or store has no scene.
    pub fn has_friction(&self) -> Result<bool, StoreError> {
        let scene = self.scene()?;
        let mut chosen = self.chosen.iter();
        Ok(match chosen.find(|(name, _)| *name == "friction") {
            Some((_, friction)) => *friction != 0.0,
            None => scene.is_none_or(|scene| scene.has_friction()),
        })
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
        let text = self.stored.attribute("scene")?;
        Ok(Scene::parse(text.as_str().unwrap_or_default(), "the scene of the map").ok())
    }

    /// Returns the indices of the slice's whiskers in the whole sweep, with the last axis varying fastest.
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

    /// Reads a channel of a whisker of the slice: `[distance][push_angle]`. `whisker` is an index in the slice, whose first sweep axis
    /// varies fastest.
    ///
    /// # Errors
    /// There is no such channel or whisker, or it is missing or damaged.
    pub fn read_panel(&self, channel: &str, whisker: usize) -> Result<ChannelValues, StoreError> {
        let panels = self.grid.whisker_count();
        if whisker >= panels {
            return Err(StoreError::NoSuchPanel {
                index: whisker,
                panels,
            });
        }
        let width = self.stored.grid().push_angle_deg.len();
        let rows = self.rows.iter();
        let cells =
            rows.flat_map(|row| self.columns.iter().map(move |column| row * width + column));
        let samples = self.stored.read_panel(channel, self.in_whole(whisker))?;
        Ok(match samples {
            ChannelValues::F32(values) => {
                ChannelValues::F32(cells.map(|cell| values[cell]).collect())
            }
            ChannelValues::U32(codes) => {
                ChannelValues::U32(cells.map(|cell| codes[cell]).collect())
            }
        })
    }

    /// Reads the `channels` of a whisker of the slice; all other channels are those of [`Panel::unresolved`]. `whisker` is an index in
    /// the slice, whose first sweep axis varies fastest.
    ///
    /// # Errors
    /// An error of [`MapSlice::read_panel`].
    pub fn panel(&self, channels: Channels, whisker: usize) -> Result<Panel, StoreError> {
        let mut panel = Panel::unresolved(self.rows.len() * self.columns.len(), channels);
        for name in channels.names() {
            let state = STATE_CHANNELS.iter().position(|own| *own == name);
            match (self.read_panel(name, whisker)?, name, state) {
                (ChannelValues::U32(codes), "regime", _) => panel.regime = codes,
                (ChannelValues::U32(codes), "status", _) => panel.status = codes,
                (ChannelValues::U32(counts), ..) => panel.newton_steps = counts,
                (ChannelValues::F32(values), _, Some(place)) => panel.state[place] = values,
                (ChannelValues::F32(values), "margin_deg", _) => panel.margin_deg = values,
                (ChannelValues::F32(values), ..) => panel.residual = values,
            }
        }
        Ok(panel)
    }

    /// Returns the names of the codes of `regime` or `status` in the slice, by code; `None` for other channels.
    #[must_use]
    pub fn names(&self, channel: &str) -> Option<BTreeMap<u32, String>> {
        self.stored.names(channel)
    }

    /// Returns the codes of a channel that occur in the slice.
    ///
    /// # Errors
    /// An error of [`MapSlice::read_panel`].
    pub fn codes(&self, channel: &str) -> Result<BTreeSet<u32>, StoreError> {
        // The header of a whole map has the counts.
        if let (MapSource::Exr(map), []) = (&self.stored, &*self.chosen) {
            return Ok(map.codes(channel));
        }
        let mut codes = BTreeSet::new();
        for whisker in 0..self.grid.whisker_count() {
            if let ChannelValues::U32(own) = self.read_panel(channel, whisker)? {
                codes.extend(own);
            }
        }
        Ok(codes)
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
