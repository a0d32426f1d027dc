//! The front of the library: a scene in, answers in memory out.

use crate::accuracy::cheapest;
use crate::classify::Regime;
#[cfg(feature = "gpu")]
use crate::engine::gpu::Gpu;
use crate::engine::{Engine, EngineError, Precision};
#[cfg(feature = "fit")]
use crate::fit::{self, Fit};
use crate::map::{self as stages, Panel, Summary};
#[cfg(feature = "fit")]
use crate::measured::MeasuredPoints;
use crate::plan::{Channel, Plan, PlanError};
use crate::rod::Side;
#[cfg(feature = "fit")]
use crate::scene::Parameter;
use crate::scene::{Grid, Scene, SweepPlace, SweptWhisker};
use crate::shooting::Resolution;
use crate::trace::{Branch, Detachment, NoState, Shape, curve_at, sides, whiskers_at_once};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Accuracy, engine, progress and cancellation of a computation.
///
/// ```
/// use whiskmap::{Options, Precision};
///
/// let mut options = Options::default();
/// options.tolerance_deg = Some(1e-6);
/// options.gpu = Some(Precision::F32);
/// options.on_progress = Some(std::sync::Arc::new(|done, all| eprintln!("{done} of {all} cells")));
/// ```
#[derive(Clone, Default)]
#[non_exhaustive]
pub struct Options {
    /// Maximum error of push angles, in degrees. Without it the finest steps are taken.
    pub tolerance_deg: Option<f64>,
    /// Solves maps on the preferred GPU in this precision; an error without the feature `gpu`.
    pub gpu: Option<Precision>,
    /// Is called with the number of finished cells and of all cells of a map, on the thread that computes it.
    pub on_progress: Option<Arc<dyn Fn(usize, usize) + Send + Sync>>,
    /// Set it to end a map with [`Error::Cancelled`] after the row batch under way.
    pub cancel: Option<Arc<AtomicBool>>,
}

/// Failure of a computation. A cell without an answer is no error.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The map takes too much memory.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The GPU cannot be opened.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// [`Options::cancel`] was set.
    #[error("cancelled")]
    Cancelled,
    /// The tolerance is below what rounding leaves.
    #[error("tolerance_deg {asked:e}: must be at least {least:e} for this scene")]
    Tolerance {
        /// The tolerance.
        asked: f64,
        /// What the finest steps leave, by the program's own estimate.
        least: f64,
    },
}

/// A regime map in memory: one [`Panel`] for each whisker of the scene.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Map {
    /// The axes.
    pub grid: Grid,
    /// The cells of each whisker, in the order of [`SceneData::whiskers`](crate::scene::SceneData::whiskers).
    pub panels: Vec<Panel>,
    /// Counts and times of the run.
    pub summary: Summary,
}

/// Place and regime of one cell of a [`Map`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MapCell {
    /// Index of the whisker.
    pub whisker: usize,
    /// Index of the distance.
    pub distance: usize,
    /// Index of the push angle.
    pub push_angle: usize,
    /// Distance of the pole at first touch, in mm.
    pub distance_mm: f64,
    /// Push angle since first touch, in degrees; positive concave backward, negative concave forward.
    pub push_angle_deg: f64,
    /// The regime.
    pub regime: Regime,
}

impl Map {
    /// Shape of a whisker's cells: the number of distances and of push angles.
    #[must_use]
    pub const fn shape(&self) -> [usize; 2] {
        [self.grid.distance_mm.len(), self.grid.push_angle_deg.len()]
    }

    /// Number of cells with this regime.
    #[must_use]
    pub fn count(&self, regime: Regime) -> u64 {
        let place = Regime::ALL.iter().position(|other| *other == regime);
        place.map_or(0, |place| self.summary.regimes[place])
    }

    /// The values of a channel of a whisker, row by row, of shape `[distance][push_angle]`; NaN without contact. `None` beyond the
    /// whiskers.
    #[must_use]
    pub fn channel(&self, whisker: usize, channel: Channel) -> Option<&[f32]> {
        Some(self.panels.get(whisker)?.channel(channel))
    }

    /// Every cell with its regime: whisker by whisker, distance by distance, by push angle.
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

    /// The regime of a whisker at the index of a distance and of a push angle; `None` beyond the axes.
    #[must_use]
    pub fn regime(&self, whisker: usize, distance: usize, push_angle: usize) -> Option<Regime> {
        let index = self.index(distance, push_angle)?;
        self.panels.get(whisker)?.regimes().nth(index)
    }

    /// The value of a channel there; `None` beyond the axes and without contact.
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
/// let scene = Scene::parse(include_str!("../scenes/cone.toml"), "cone.toml")?.thinned(32, 1);
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
/// let scene = Scene::parse(include_str!("../scenes/morphology.toml"), "morphology.toml")?.thinned(8, 2);
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
/// one was asked for; and any error of `each`.
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
    plan.method.resolution = resolution(scene, &options, &plan.sides)?;
    let mut engine = options.gpu.map(open).transpose().map_err(Error::from)?;
    let engine = engine.as_mut().map(|engine| &mut **engine as _);
    let (mut done, all) = (0, plan.cells);
    let mut on_progress = |cells| {
        done += cells;
        if let Some(on_progress) = &options.on_progress {
            on_progress(done, all);
        }
        let cancel = options.cancel.as_ref();
        match cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed)) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    };
    let mut whiskers = 0..plan.whiskers;
    let mut keep = |panels: Vec<Panel>| {
        let mut numbered = panels.into_iter().zip(&mut whiskers);
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

/// Computes where every whisker of `scene` detaches: at each distance, CF before CB.
///
/// ```
/// use whiskmap::trace::DetachmentKind;
/// use whiskmap::{Options, scene::Scene};
///
/// let cone = Scene::parse(include_str!("../scenes/cone.toml"), "cone.toml")?;
/// let curve = whiskmap::curve(&cone.to_builder().distance_mm([15.6604597633658]).build()?, Options::default())?;
/// let (_, cb) = &curve[1];
/// assert_eq!(cb.kind, DetachmentKind::SlipOff);
/// assert!(cb.push_angle_deg.is_some_and(|push| (push - 15.60793).abs() < 1e-5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the tolerance cannot be kept.
pub fn curve(scene: &Scene, options: Options) -> Result<Vec<(SweepPlace, Detachment)>, Error> {
    let resolution = resolution(scene, &options, &Side::BOTH)?;
    let distances = &scene.grid.distance_mm;
    let curves = |group: Vec<_>| {
        sides(&group, |own: &SweptWhisker, side| {
            curve_at(resolution, &own.whisker, &own.pole, side, distances)
        })
    };
    let groups = scene.whisker_groups(whiskers_at_once(distances.len()));
    Ok(groups.flat_map(curves).collect())
}

/// Follows the states of the scene's first whisker in front of one pole, from first touch at `distance_mm` through the fold.
///
/// ```
/// use whiskmap::{rod::Side, scene::Scene};
///
/// let cone = Scene::parse(include_str!("../scenes/cone.toml"), "cone.toml")?;
/// let points = whiskmap::branch(&cone, 15.66, Side::Cb)?.points(50)?;
/// assert!(points[0].stable && !points[49].stable);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the whisker at rest does not reach the pole, or the continuation gets lost.
pub fn branch(scene: &Scene, distance_mm: f64, side: Side) -> Result<Branch, NoState> {
    let first = scene.first_whisker();
    Branch::new(&first.whisker, &first.pole, side, distance_mm)
}

/// The stable shape of the scene's first whisker, in 200 places, after a push from first touch at `distance_mm`.
///
/// ```
/// use whiskmap::scene::Scene;
///
/// let cone = Scene::parse(include_str!("../scenes/cone.toml"), "cone.toml")?;
/// assert!(whiskmap::shape(&cone, 15.66, 10.0).is_ok());
/// let slipped = whiskmap::shape(&cone, 15.66, 20.0).err();
/// assert!(slipped.is_some_and(|why| why.to_string().starts_with("slipped off at 15.6")));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When there is no such state: the message tells how the whisker has left the pole, and at which push angle.
pub fn shape(scene: &Scene, distance_mm: f64, push_angle_deg: f64) -> Result<Shape, NoState> {
    let branch = branch(scene, distance_mm, Side::of_push(push_angle_deg))?;
    let state = branch.state(push_angle_deg.to_radians(), true)?;
    Ok(Shape::new(&branch, &state, 200))
}

/// Fits parameters of the scene's first whisker and of its pole to measured detachments, from the scene's values on.
///
/// ```
/// use whiskmap::measured::MeasuredPoints;
/// use whiskmap::scene::{Parameter, Scene};
///
/// let cone = Scene::parse(include_str!("../scenes/cone.toml"), "cone.toml")?;
/// let points = MeasuredPoints::parse("side,distance_mm,push_angle_deg\ncb,15.6604597633658,15.60793\n", "points.csv")?;
/// let start = cone.with(Parameter::TipRadiusUm, 3.0)?;
/// let fit = whiskmap::fit(&start, &points, &[Parameter::TipRadiusUm])?;
/// assert!((fit.estimates[0].value - 1.5).abs() < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When a parameter cannot be free, a point is beyond the whisker, points are too few, or the iteration does not converge.
#[cfg(feature = "fit")]
pub fn fit(
    scene: &Scene,
    points: &MeasuredPoints,
    free: &[Parameter],
) -> Result<Fit, fit::FitError> {
    fit::fit(scene, points, free)
}

/// The steps that keep the tolerance, if there is one.
fn resolution(scene: &Scene, options: &Options, sides: &[Side]) -> Result<Resolution, Error> {
    let Some(asked) = options.tolerance_deg else {
        return Ok(Resolution::FINE);
    };
    let accuracy = cheapest(scene, sides, asked).map_err(|finest| Error::Tolerance {
        asked,
        least: finest.error_deg,
    })?;
    Ok(accuracy.resolution)
}
