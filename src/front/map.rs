//! Regime maps, computed in memory.

use super::{Error, MapEngine, Options, accuracy};
use crate::accuracy::{cheaper, excess_deg, spectral};
use crate::classify::Regime;
#[cfg(feature = "gpu")]
use crate::engine::gpu::Gpu;
use crate::engine::{Engine, EngineError, Precision};
use crate::map::{self as stages, Panel, Summary};
use crate::plan::{Channel, Plan};
use crate::scene::{Grid, Scene};
use std::ops::ControlFlow;

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

/// Computes the regime map of `scene`, every cell with its state, on all cores.
///
/// ```
/// use whiskmap::{Channel, Options, Regime, scene::Scene};
///
/// let scene = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?.thinned(32, 1);
/// let map = whiskmap::map(&scene, Options::default())?;
/// assert_eq!(map.count(Regime::Unresolved), 0);
/// assert_eq!(map.regime(0, 16, 16), Some(Regime::Contact));
/// assert!(map.value(Channel::Force, 0, 16, 16).is_some_and(|force| force > 0.0));
/// assert_eq!(map.channel(0, Channel::Force).map(<[f32]>::len), Some(map.shape().iter().product()));
/// assert!(map.cells().all(|cell| cell.regime != Regime::Unresolved));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the panels of all whiskers take more than [`MEMORY_LIMIT`](crate::plan::MEMORY_LIMIT): use [`for_each_panel`] then.
/// When the tolerance cannot be kept, or there is no GPU although one is required.
pub fn map(scene: &Scene, options: Options) -> Result<Map, Error> {
    let plan = Plan::in_memory(scene)?;
    let mut panels = Vec::with_capacity(plan.whiskers);
    let summary = run(scene, plan, options, |_, panel| {
        panels.push(panel);
        Ok::<(), Error>(())
    })?;
    Ok(Map {
        grid: scene.grid.clone(),
        panels,
        summary,
    })
}

/// Computes the regime map of `scene`, and passes one [`Panel`] at a time to `each`, with the index of its whisker.
///
/// Panels come in the order of [`SceneData::whiskers`](crate::scene::SceneData::whiskers), while the next ones are computed. Memory does not
/// grow with the number of whiskers. The first error of `each` ends the run.
///
/// ```
/// use whiskmap::{Options, Regime, scene::Scene};
///
/// let scene = Scene::parse(include_str!("../../scenes/morphology.toml"), "morphology.toml")?.thinned(8, 2);
/// let mut contacts = Vec::new();
/// whiskmap::for_each_panel(&scene, Options::default(), |whisker, panel| {
///     assert_eq!(whisker, contacts.len());
///     contacts.push(panel.regimes().filter(|regime| *regime == Regime::Contact).count());
///     Ok::<(), whiskmap::Error>(())
/// })?;
/// assert_eq!(contacts.len(), scene.whisker_count());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When one panel takes more than [`MEMORY_LIMIT`](crate::plan::MEMORY_LIMIT), the tolerance cannot be kept, or there is no GPU where
/// one is required; and any error of `each`.
pub fn for_each_panel<E: From<Error> + Send>(
    scene: &Scene,
    options: Options,
    each: impl FnMut(usize, Panel) -> Result<(), E> + Send,
) -> Result<Summary, E> {
    let plan = Plan::new(scene).map_err(Error::from)?;
    run(scene, plan, options, each)
}

/// Runs `plan` with the steps and the engine of `options`.
fn run<E: From<Error> + Send>(
    scene: &Scene,
    mut plan: Plan,
    options: Options,
    mut each: impl FnMut(usize, Panel) -> Result<(), E> + Send,
) -> Result<Summary, E> {
    let accuracy = accuracy(scene, &options, &plan.sides)?;
    if let Some(accuracy) = &accuracy {
        plan.method.resolution = accuracy.resolution;
    }
    if let Some(channels) = options.channels {
        plan.channels = channels;
    }
    let left_deg = options.tolerance_deg.zip(accuracy);
    let left_deg = left_deg.map(|(tolerance_deg, accuracy)| accuracy.left_deg(tolerance_deg));
    let mut engine: Option<Box<dyn Engine>> = match options.engine {
        MapEngine::Cpu => None,
        MapEngine::Spectral => Some(Box::new(spectral(scene, left_deg))),
        MapEngine::Auto => cheaper(scene, &plan, left_deg).map(|own| Box::new(own) as _),
        MapEngine::Gpu(precision) => Some(open(precision).map_err(Error::from)?),
    };
    let residual_bound = engine.as_ref().map(|engine| engine.residual_bound());
    let excess = residual_bound.and_then(|bound| excess_deg(scene, bound, left_deg));
    if let (Some(excess), Some(tolerance_deg), Some(left)) =
        (excess, options.tolerance_deg, left_deg)
    {
        let least = tolerance_deg - left + excess;
        return Err(Error::Tolerance {
            tolerance_deg,
            least,
        }
        .into());
    }
    let engine = engine.as_mut().map(|engine| &mut **engine as _);
    let (mut done, all) = (0, plan.cells);
    let mut on_progress = |cells| {
        done += cells;
        if let Some(on_progress) = &options.on_progress {
            on_progress(done, all);
        }
        match options.is_cancelled() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    };
    let mut whiskers = 0..plan.whiskers;
    let mut keep = |panels: &mut Vec<Panel>| {
        let mut numbered = panels.drain(..).zip(&mut whiskers);
        numbered.try_for_each(|(panel, whisker)| each(whisker, panel))
    };
    let summary = stages::run(scene, &plan, engine, &mut on_progress, &mut keep)?;
    match summary.is_cancelled {
        true => Err(Error::Cancelled.into()),
        false => Ok(summary),
    }
}

/// Opens the preferred GPU.
#[cfg(feature = "gpu")]
fn open(precision: Precision) -> Result<Box<dyn Engine>, EngineError> {
    Gpu::open(None, precision).map(|gpu| Box::new(gpu) as _)
}

#[cfg(not(feature = "gpu"))]
fn open(_: Precision) -> Result<Box<dyn Engine>, EngineError> {
    let without = "this build is without the feature `gpu`";
    Err(EngineError::NoAdapter(without.to_owned()))
}
