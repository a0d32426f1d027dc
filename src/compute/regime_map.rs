//! Regime maps in memory.

use crate::classify::Regime;
use crate::map::{Panel, Summary};
use crate::plan::Channel;
use crate::scene::Grid;

/// A regime map in memory: one [`Panel`] for each whisker of the scene.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Map {
    /// Axes of the map: push angles in degrees, distances in mm, and the sweep.
    pub grid: Grid,
    /// Panels of the map, one for each whisker, in the order of [`SceneData::whiskers`](crate::scene::SceneData::whiskers).
    pub panels: Vec<Panel>,
    /// Counts and times of the run that computed the map.
    pub summary: Summary,
}

/// Cell of a [`Map`]: its place and regime.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MapCell {
    /// Index of the cell's whisker in [`Map::panels`].
    pub whisker: usize,
    /// Index of the cell's distance in the grid.
    pub distance: usize,
    /// Index of the cell's push angle in the grid.
    pub push_angle: usize,
    /// Distance of the cell from the base to the contact at first touch, in mm.
    pub distance_mm: f64,
    /// Push angle of the cell since first touch, in degrees; positive concave backward, negative concave forward.
    pub push_angle_deg: f64,
    /// Regime of the cell.
    pub regime: Regime,
}

impl Map {
    /// Returns the shape of a panel: `[number of distances, number of push angles]`.
    #[must_use]
    pub const fn shape(&self) -> [usize; 2] {
        [self.grid.distance_mm.len(), self.grid.push_angle_deg.len()]
    }

    /// Returns the number of cells of the map with this regime.
    #[must_use]
    pub fn count(&self, regime: Regime) -> u64 {
        let place = Regime::ALL.iter().position(|other| *other == regime);
        place.map_or(0, |place| self.summary.regimes[place])
    }

    /// Returns the values of a channel of a whisker, of shape `[distance][push_angle]`, in the channel's unit; NaN without contact.
    /// `None` without such a whisker.
    #[must_use]
    pub fn channel(&self, whisker: usize, channel: Channel) -> Option<&[f32]> {
        Some(self.panels.get(whisker)?.channel(channel))
    }

    /// Returns the values of a channel of a whisker as a view of shape `[distance][push_angle]`, in the channel's unit; NaN without
    /// contact. `None` without such a whisker.
    ///
    /// ```
    /// use whiskmap::{Channel, Options, scene::Scene};
    ///
    /// let scene = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?.thinned(8, 1);
    /// let map = whiskmap::map(&scene, Options::default())?;
    /// let force = map.view(0, Channel::Force).ok_or("no whisker")?;
    /// assert_eq!(force.dim(), (scene.grid.distance_mm.len(), scene.grid.push_angle_deg.len()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[cfg(feature = "ndarray")]
    #[must_use]
    pub fn view(&self, whisker: usize, channel: Channel) -> Option<ndarray::ArrayView2<'_, f32>> {
        ndarray::ArrayView2::from_shape(self.shape(), self.channel(whisker, channel)?).ok()
    }

    /// Returns every cell of the map with its regime: whisker by whisker, distance by distance, by push angle.
    pub fn cells(&self) -> impl Iterator<Item = MapCell> + '_ {
        let [_, width] = self.shape();
        let panels = self.panels.iter().enumerate();
        panels.flat_map(move |(whisker, panel)| {
            panel.regimes().enumerate().map(move |(index, regime)| {
                let (distance, push_angle) = (index / width, index % width);
                MapCell {
                    whisker,
                    distance,
                    push_angle,
                    distance_mm: self.grid.distance_mm[distance],
                    push_angle_deg: self.grid.push_angle_deg[push_angle],
                    regime,
                }
            })
        })
    }

    /// Returns the regime of a whisker at the index of a distance and of a push angle; `None` beyond the axes.
    #[must_use]
    pub fn regime(&self, whisker: usize, distance: usize, push_angle: usize) -> Option<Regime> {
        let index = self.index(distance, push_angle)?;
        self.panels.get(whisker)?.regimes().nth(index)
    }

    /// Returns the value of a channel of a whisker at the index of a distance and of a push angle, in the channel's unit; `None` beyond
    /// the axes and without contact.
    #[must_use]
    pub fn value(
        &self,
        channel: Channel,
        whisker: usize,
        distance: usize,
        push_angle: usize,
    ) -> Option<f32> {
        let index = self.index(distance, push_angle)?;
        let value = self.channel(whisker, channel)?.get(index).copied();
        value.filter(|value| value.is_finite())
    }

    fn index(&self, distance: usize, push_angle: usize) -> Option<usize> {
        let [height, width] = self.shape();
        (distance < height && push_angle < width).then_some(distance * width + push_angle)
    }
}

#[cfg(all(test, feature = "ndarray"))]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use crate::compute::{Options, map};
    use crate::plan::{Channel, Channels};
    use crate::scene::Scene;

    #[test]
    fn views_have_the_values_at_distance_and_push_angle() {
        let scene = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")
            .unwrap()
            .thinned(8, 1)
            .to_builder()
            .distance_mm([5.0, 10.0, 15.0]);
        let map = map(&scene.build().unwrap(), Options::default()).unwrap();
        let [height, width] = map.shape();
        let computed =
            Channel::ALL.into_iter().filter(|channel| Channels::STANDARD.contains(channel.name()));
        for channel in computed {
            let view = map.view(0, channel).unwrap();
            assert_eq!(view.dim(), (height, width));
            for ((distance, push), value) in view.indexed_iter() {
                let known = map.value(channel, 0, distance, push);
                assert_eq!(value.is_finite().then_some(*value), known);
            }
        }
        assert!(map.view(1, Channel::Force).is_none());
    }
}
