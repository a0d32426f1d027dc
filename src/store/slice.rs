//! A part of a map or a store: what is left of its axes where a value is chosen on some of them.

use super::at::{At, check_near, nearest, with_unit};
use super::{Channels, Error, Layout, Panel, STATE_CHANNELS, Samples, Stored, StoredMap};
use crate::input::did_you_mean;
use crate::scene::{Grid, Scene, digits};
use std::collections::{BTreeMap, BTreeSet};

/// A value that cannot be chosen.
#[derive(Debug, thiserror::Error)]
#[error("{axis}: {why}")]
pub struct NoChoice {
    axis: String,
    why: String,
}

/// A part of a map or a store, which is read panel by panel, no more than is asked for.
#[derive(Debug)]
pub struct Slice {
    stored: Stored,
    grid: Grid,
    /// The rows and columns taken of each panel.
    rows: Vec<usize>,
    columns: Vec<usize>,
    chosen: Vec<(&'static str, f64)>,
    /// The place chosen on each axis of the whole sweep.
    fixed: Vec<Option<usize>>,
}

impl Slice {
    /// The part of `stored` at the values nearest to those wanted or, if they must be `exact`, at these alone.
    ///
    /// # Errors
    ///
    /// If an axis is unknown or there twice, does not have the value exactly, or ends more than half a step before it.
    pub fn new(stored: Stored, wanted: &[At], exact: bool) -> Result<Self, NoChoice> {
        let mut slice = Self::whole(stored);
        for at in wanted {
            slice.choose(at, exact).map_err(|why| NoChoice {
                axis: at.axis.clone(),
                why,
            })?;
        }
        Ok(slice)
    }

    fn whole(stored: Stored) -> Self {
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

    fn choose(&mut self, at: &At, exact: bool) -> Result<(), String> {
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

    /// The whole that this is a part of.
    #[must_use]
    pub fn stored(&self) -> &Stored {
        &self.stored
    }

    /// What is left of the axes: a chosen one of the sweep is gone, one of the panels has its value alone.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The panels that are left, which have at most two sweep axes.
    #[must_use]
    pub fn layout(&self) -> Layout {
        Layout::of(&self.grid)
    }

    /// The values chosen, by the names of their axes.
    #[must_use]
    pub fn chosen(&self) -> &[(&'static str, f64)] {
        &self.chosen
    }

    /// The same, to four digits, for people.
    pub fn readable(&self) -> impl Iterator<Item = (&'static str, String)> + '_ {
        self.chosen.iter().map(|(name, value)| {
            let rounded = format!("{value:.3e}").parse().unwrap_or(*value);
            (*name, digits(rounded))
        })
    }

    /// One line for people, with the values chosen.
    #[must_use]
    pub fn title(&self) -> String {
        let chosen = self.readable();
        let chosen = chosen.map(|(name, value)| format!(", {name} = {value}"));
        std::iter::once(self.stored.title().to_owned())
            .chain(chosen)
            .collect()
    }

    /// The names of all channels.
    #[must_use]
    pub fn channels(&self) -> Vec<&'static str> {
        self.stored.channels()
    }

    /// Whether any whisker of the slice has friction with its pole. A scene that this version cannot read counts as having it.
    ///
    /// # Errors
    ///
    /// The map or store has no scene.
    pub fn has_friction(&self) -> Result<bool, Error> {
        let text = self.stored.attribute("scene")?;
        let scene = Scene::parse(text.as_str().unwrap_or_default(), "the scene of the map");
        let mut chosen = self.chosen.iter();
        Ok(match chosen.find(|(name, _)| *name == "friction") {
            Some((_, friction)) => *friction != 0.0,
            None => scene.map_or(true, |scene| scene.has_friction()),
        })
    }

    /// The whiskers that are left, with the last axis varying fastest.
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

    /// The values of a whisker of the slice on all axes of the whole sweep.
    #[must_use]
    pub fn place(&self, whisker: usize) -> Vec<(&'static str, f64)> {
        let place = self.stored.grid().place(self.in_whole(whisker));
        let values = place.values();
        values
            .map(|(parameter, value)| (parameter.axis(), value))
            .collect()
    }

    /// Sizes of the axes that are left: those of the sweep, then distance and push angle.
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

    /// A channel of one whisker of the slice: `[distance][push angle]`.
    ///
    /// # Errors
    ///
    /// There is no such channel or whisker, or it is missing or damaged.
    pub fn read_panel(&self, channel: &str, whisker: usize) -> Result<Samples, Error> {
        let panels = self.grid.whisker_count();
        if whisker >= panels {
            return Err(Error::NoSuchPanel {
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
            Samples::F32(values) => Samples::F32(cells.map(|cell| values[cell]).collect()),
            Samples::U32(codes) => Samples::U32(cells.map(|cell| codes[cell]).collect()),
        })
    }

    /// The `channels` of one whisker of the slice; the others are those of a whisker without an answer.
    ///
    /// # Errors
    ///
    /// Those of [`Slice::read_panel`].
    pub fn panel(&self, channels: Channels, whisker: usize) -> Result<Panel, Error> {
        let mut panel = Panel::unresolved(self.rows.len() * self.columns.len(), channels);
        for name in channels.names() {
            let state = STATE_CHANNELS.iter().position(|own| *own == name);
            match (self.read_panel(name, whisker)?, name, state) {
                (Samples::U32(codes), "regime", _) => panel.regime = codes,
                (Samples::U32(codes), "status", _) => panel.status = codes,
                (Samples::U32(counts), ..) => panel.newton_steps = counts,
                (Samples::F32(values), _, Some(place)) => panel.state[place] = values,
                (Samples::F32(values), "margin_deg", _) => panel.margin_deg = values,
                (Samples::F32(values), ..) => panel.residual = values,
            }
        }
        Ok(panel)
    }

    /// The names of the codes of a channel that is made of codes.
    #[must_use]
    pub fn names(&self, channel: &str) -> Option<BTreeMap<u32, String>> {
        self.stored.names(channel)
    }

    /// The codes of a channel that occur.
    ///
    /// # Errors
    ///
    /// Those of [`Slice::read_panel`].
    pub fn codes(&self, channel: &str) -> Result<BTreeSet<u32>, Error> {
        // The header of a whole map has counted them.
        if let (Stored::Exr(map), []) = (&self.stored, &*self.chosen) {
            return Ok(map.codes(channel));
        }
        let mut codes = BTreeSet::new();
        for whisker in 0..self.grid.whisker_count() {
            if let Samples::U32(own) = self.read_panel(channel, whisker)? {
                codes.extend(own);
            }
        }
        Ok(codes)
    }

    /// The index in the whole sweep of a whisker of the slice.
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

/// All of a map.
impl From<StoredMap> for Slice {
    fn from(map: StoredMap) -> Self {
        Self::whole(Stored::Exr(Box::new(map)))
    }
}
