//! Computation of regime maps in memory, panel by panel, or when they are read.

use super::{Error, Map, MapEngine, Options, PlannedMap};
#[cfg(feature = "gpu")]
use crate::engine::gpu::Gpu;
use crate::engine::{Engine, EngineError, Precision};
use crate::map::{self, Panel, Summary};
use crate::plan::Plan;
use crate::scene::Scene;
use crate::store::ComputedMap;
use std::sync::atomic::AtomicBool;

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
    Ok(Map { grid: scene.grid.clone(), panels, summary })
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

/// Opens the regime map of `scene`, each whisker of which is computed when it is read. Progress and cancellation of `options` have no effect.
///
/// Memory and time do not grow with the number of whiskers. A [`MapSlice`](crate::store::MapSlice) selects values on the axes.
///
/// ```
/// use whiskmap::{Options, scene::Scene, store::MapSlice};
///
/// let scene = Scene::parse(include_str!("../../scenes/morphology.toml"), "morphology.toml")?.thinned(8, 16);
/// let map = whiskmap::lazy_map(&scene, Options::default())?;
/// let cones = MapSlice::new(map.into(), &["taper=1".parse()?], true)?;
/// assert_eq!(cones.grid().whisker_count(), 16);
/// let force = cones.read_panel("force_un", 0)?; // computes one whisker
/// assert_eq!(force.values().count(), 64);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When one panel takes more than [`MEMORY_LIMIT`](crate::plan::MEMORY_LIMIT), the tolerance cannot be kept, or there is no GPU where
/// one is required.
pub fn lazy_map(scene: &Scene, options: Options) -> Result<ComputedMap, Error> {
    let (map, engine) = prepared(scene, Plan::new(scene)?, &options)?;
    let tolerances = map.tolerances(engine.as_deref());
    Ok(ComputedMap::new(scene.clone(), map.plan, engine, tolerances))
}

/// Runs `plan` with the steps and the engine of `options`.
fn run<E: From<Error> + Send>(
    scene: &Scene,
    plan: Plan,
    options: Options,
    mut each: impl FnMut(usize, Panel) -> Result<(), E> + Send,
) -> Result<Summary, E> {
    let (PlannedMap { plan, .. }, mut engine) = prepared(scene, plan, &options)?;
    let engine = engine.as_mut().map(|engine| &mut **engine as _);
    let (mut done, all) = (0, plan.cells);
    let mut on_progress = |cells| {
        done += cells;
        if let Some(on_progress) = &options.on_progress {
            on_progress(done, all);
        }
    };
    let never = AtomicBool::new(false);
    let cancel = options.cancel.as_deref().unwrap_or(&never);
    let mut whiskers = 0..plan.whiskers;
    let mut keep = |panels: &mut Vec<Panel>| {
        let mut numbered = panels.drain(..).zip(&mut whiskers);
        numbered.try_for_each(|(panel, whisker)| each(whisker, panel))
    };
    let summary = map::run(scene, &plan, engine, &mut on_progress, cancel, &mut keep)?;
    match summary.is_cancelled {
        true => Err(Error::Cancelled.into()),
        false => Ok(summary),
    }
}

/// Planned map, and its engine; `None` for the CPU engine alone.
type PreparedMap<'a> = (PlannedMap<'a>, Option<Box<dyn Engine>>);

/// Returns `plan` with the steps and channels of `options`, and opens their engine.
fn prepared<'a>(scene: &'a Scene, plan: Plan, options: &Options) -> Result<PreparedMap<'a>, Error> {
    let map = PlannedMap::new(scene, plan, options.tolerance_deg, options.channels)?;
    let engine: Option<Box<dyn Engine>> = match options.engine {
        MapEngine::Cpu => None,
        MapEngine::Spectral => Some(Box::new(map.spectral())),
        MapEngine::Gpu(precision) if map.plan.channels.needs_states() => Some(open(precision)?),
        MapEngine::Auto | MapEngine::Gpu(_) => {
            map.cheaper().map(|spectral| Box::new(spectral) as _)
        }
    };
    let residual_bound = engine.as_ref().map(|engine| engine.residual_bound());
    let excess = residual_bound.and_then(|bound| map.excess_deg(bound));
    if let (Some(excess), Some(tolerance_deg), Some(left)) =
        (excess, options.tolerance_deg, map.left_deg)
    {
        let least = tolerance_deg - left + excess;
        return Err(Error::Tolerance { tolerance_deg, least });
    }
    Ok((map, engine))
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
