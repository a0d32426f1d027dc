//! The front of the library: a scene in, answers in memory out.

use crate::accuracy::cheapest;
use crate::classify::Regime;
use crate::engine::EngineError;
#[cfg(feature = "gpu")]
use crate::engine::gpu::{Gpu, Precision};
#[cfg(feature = "fit")]
use crate::fit::{self, Fit};
use crate::map::{self as stages, Panel, STATE_CHANNELS, Summary};
#[cfg(feature = "fit")]
use crate::measured::MeasuredPoints;
use crate::plan::{Plan, PlanError};
use crate::rod::Side;
#[cfg(feature = "fit")]
use crate::scene::Parameter;
use crate::scene::{Grid, Scene, SweepPlace, SweptWhisker};
use crate::shooting::Resolution;
use crate::trace::{Branch, Detachment, NoState, Shape, curve_at, sides, whiskers_at_once};

/// How exact an answer is to be, and what shoots before the refinement.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// Error of push angles that is small enough, in degrees; without it, the finest steps are taken.
    pub tolerance_deg: Option<f64>,
    /// Shoots cells on the preferred GPU before they are refined, in this precision.
    #[cfg(feature = "gpu")]
    pub gpu: Option<Precision>,
}

/// Why there is no answer at all; a cell without one is no error.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A map that takes too much memory.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A GPU that cannot be had.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// A tolerance below what rounding leaves.
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
pub struct Map {
    /// The axes.
    pub grid: Grid,
    /// The whiskers' cells, in the order of [`SceneData::whiskers`](crate::scene::SceneData::whiskers).
    pub panels: Vec<Panel>,
    /// Counts and times of the run.
    pub summary: Summary,
}

impl Map {
    /// How many cells have this regime.
    #[must_use]
    pub fn count(&self, regime: Regime) -> u64 {
        let place = Regime::ALL.iter().position(|other| *other == regime);
        place.map_or(0, |place| self.summary.regimes[place])
    }

    /// The regime of a whisker at the index of a distance and of a push angle; `None` beyond the axes.
    #[must_use]
    pub fn regime(&self, whisker: usize, distance: usize, push_angle: usize) -> Option<Regime> {
        let code = self.panels.get(whisker)?.regime[self.cell(distance, push_angle)?];
        Regime::ALL.into_iter().find(|regime| regime.code() == code)
    }

    /// The value of one of [`STATE_CHANNELS`] there; `None` beyond the axes, without such a channel, and without contact.
    #[must_use]
    pub fn value(
        &self,
        channel: &str,
        whisker: usize,
        distance: usize,
        push_angle: usize,
    ) -> Option<f32> {
        let channel = STATE_CHANNELS.iter().position(|name| *name == channel)?;
        let cell = self.cell(distance, push_angle)?;
        Some(self.panels.get(whisker)?.state[channel][cell]).filter(|value| value.is_finite())
    }

    fn cell(&self, distance: usize, push_angle: usize) -> Option<usize> {
        let width = self.grid.push_angle_deg.len();
        let is_inside = distance < self.grid.distance_mm.len() && push_angle < width;
        is_inside.then_some(distance * width + push_angle)
    }
}

/// Computes the regime map of `scene`, every cell with its state, on all cores.
///
/// ```
/// use whiskmap::classify::Regime;
/// use whiskmap::{Options, scene::Scene};
///
/// let scene = Scene::parse(include_str!("../scenes/cone.toml"), "cone.toml")?.thinned(32, 1);
/// let map = whiskmap::map(&scene, Options::default())?;
/// assert_eq!(map.count(Regime::Unresolved), 0);
/// assert_eq!(map.regime(0, 16, 16), Some(Regime::Contact));
/// assert!(map.value("force_un", 0, 16, 16).is_some_and(|force| force > 0.0));
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
/// use whiskmap::classify::Regime;
/// use whiskmap::{Options, scene::Scene};
///
/// let scene = Scene::parse(include_str!("../scenes/morphology.toml"), "morphology.toml")?.thinned(8, 2);
/// let mut contacts = Vec::new();
/// whiskmap::for_each_panel(&scene, Options::default(), |whisker, panel| {
///     assert_eq!(whisker, contacts.len());
///     let is_contact = |code: &&u32| **code == Regime::Contact.code();
///     contacts.push(panel.regime.iter().filter(is_contact).count());
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
    plan.method.resolution = resolution(scene, options, &plan.sides)?;
    #[cfg(feature = "gpu")]
    let mut gpu = options.gpu.map(Gpu::new).transpose().map_err(Error::from)?;
    #[cfg(feature = "gpu")]
    let engine = gpu.as_mut().map(|gpu| gpu as _);
    #[cfg(not(feature = "gpu"))]
    let engine = None;
    let mut whiskers = 0..plan.whiskers;
    let mut keep = |panels: Vec<Panel>| {
        let mut numbered = panels.into_iter().zip(&mut whiskers);
        numbered.try_for_each(|(panel, whisker)| each(whisker, panel))
    };
    stages::run(scene, &plan, engine, &mut |_| (), &mut keep)
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
    let resolution = resolution(scene, options, &Side::BOTH)?;
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
fn resolution(scene: &Scene, options: Options, sides: &[Side]) -> Result<Resolution, Error> {
    let Some(asked) = options.tolerance_deg else {
        return Ok(Resolution::FINE);
    };
    let accuracy = cheapest(scene, sides, asked).map_err(|finest| Error::Tolerance {
        asked,
        least: finest.error_deg,
    })?;
    Ok(accuracy.resolution)
}
