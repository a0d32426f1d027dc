//! Regime maps as arrays that own the memory in which they were computed.

use crate::arguments;
use crate::errors::{of_front, of_plan};
use crate::scene::CheckedScene;
use crate::threads::{self, ThreadCount};
use numpy::PyArray1;
use pyo3::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use whiskmap::plan::Plan;
use whiskmap::scene::{Grid, Scene};
use whiskmap::{Channel, Channels, Error, MapEngine, Options, Panel, Summary};

/// Values of one channel of all whiskers, in the order of the axes: `[sweep axes.., distance, push angle]`.
enum ChannelArray {
    Codes(Vec<u8>),
    Counts(Vec<u32>),
    Quantities(Vec<f32>),
}

/// Arrays of channels by name.
type ChannelArrays = Vec<(&'static str, ChannelArray)>;

/// Names and arrays of channels, the name of the engine, its hardware, and warnings.
type MapArrays<'py> = (Vec<(&'static str, Bound<'py, PyAny>)>, String, String, Vec<String>);

/// Computes the map of `scene`. `progress` is called with the numbers of finished cells and of all cells.
#[pyfunction]
pub fn map<'py>(
    py: Python<'py>,
    scene: &CheckedScene,
    engine: &str,
    tolerance_deg: Option<f64>,
    channels: Option<Vec<String>>,
    threads: Option<Bound<'py, PyAny>>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<MapArrays<'py>> {
    let threads = ThreadCount::of(threads.as_ref())?;
    let scene = &scene.0;
    let mut options = arguments::options(engine, tolerance_deg, channels)?;
    let channels = options.channels.unwrap_or_else(|| Channels::of_scene(scene));
    let done = Arc::new(AtomicUsize::new(0));
    let cells = Arc::clone(&done);
    options.on_progress =
        Some(Arc::new(move |finished, _| cells.store(finished, Ordering::Relaxed)));
    let plan = Plan::in_memory(scene).map_err(|why| of_plan(&why))?;
    let spectral = spectral_warning(scene, options.engine);
    let all = plan.cells;
    let report = |finished: usize| match &progress {
        Some(progress) => progress.call1((finished, all)).map(drop),
        None => Ok(()),
    };
    let (arrays, summary) = threads::run(
        py,
        threads,
        |_| report(done.load(Ordering::Relaxed)),
        |cancel| {
            options.cancel = Some(Arc::clone(cancel));
            gathered(scene, options, channels)
        },
    )?
    .map_err(|why| of_front(&why))?;
    report(all)?;
    let warnings = spectral.into_iter().chain(warnings(&summary)).collect();
    let arrays = arrays.into_iter().map(|(name, values)| {
        let array = match values {
            ChannelArray::Codes(codes) => PyArray1::from_vec(py, codes).into_any(),
            ChannelArray::Counts(counts) => PyArray1::from_vec(py, counts).into_any(),
            ChannelArray::Quantities(values) => PyArray1::from_vec(py, values).into_any(),
        };
        (name, array)
    });
    Ok((arrays.collect(), summary.engine.engine, summary.engine.adapter, warnings))
}

/// Returns the warning about the spectral engine with measured radii.
pub fn spectral_warning(scene: &Scene, engine: MapEngine) -> Option<String> {
    let is_unexpanded = engine == MapEngine::Spectral && scene.whisker.profile.is_some();
    let why = "engine = 'spectral': a whisker with measured radii has no expansions; the CPU engine solves every cell";
    is_unexpanded.then(|| why.to_owned())
}

/// Returns the warnings about the cells of a map.
fn warnings(summary: &Summary) -> impl Iterator<Item = String> {
    let failure = summary.engine_failure.as_ref();
    let failure = failure.map(|why| format!("{why}; the CPU solved the remaining cells"));
    let [unresolved, all] = summary.unresolved_of_all();
    let unresolved = (unresolved > 0)
        .then(|| format!("{unresolved} of {all} cells are unresolved: see the variable `status`"));
    failure.into_iter().chain(unresolved)
}

/// Computes the panels of all whiskers, and gathers the channels.
fn gathered(
    scene: &Scene,
    options: Options,
    channels: Channels,
) -> Result<(ChannelArrays, Summary), Error> {
    let mut arrays: ChannelArrays = Vec::new();
    let whiskers = scene.whisker_count();
    let summary = whiskmap::for_each_panel(scene, options, |whisker, mut panel| {
        let place = place(&scene.grid, whisker);
        for (index, name) in channels.names().enumerate() {
            let values = taken(&mut panel, name);
            if whisker == 0 {
                arrays.push((name, values.spread(whiskers)));
            } else if let Some((_, array)) = arrays.get_mut(index) {
                array.put(place, &values);
            }
        }
        Ok::<(), Error>(())
    })?;
    Ok((arrays, summary))
}

/// Takes a channel out of a panel.
fn taken(panel: &mut Panel, name: &str) -> ChannelArray {
    let codes = |codes: &[u32]| codes.iter().map(|code| code.to_le_bytes()[0]).collect();
    match name {
        "regime" => ChannelArray::Codes(codes(&panel.regime)),
        "status" => ChannelArray::Codes(codes(&panel.status)),
        "newton_steps" => ChannelArray::Counts(std::mem::take(&mut panel.newton_steps)),
        "residual" => ChannelArray::Quantities(std::mem::take(&mut panel.residual)),
        "peak_strain" => ChannelArray::Quantities(std::mem::take(&mut panel.peak_strain)),
        "margin_deg" => ChannelArray::Quantities(std::mem::take(&mut panel.margin_deg)),
        _ => {
            let values = match Channel::of(name) {
                Some(channel) => panel.state.get_mut(channel as usize),
                None => panel.push_derivative_mut(name),
            };
            ChannelArray::Quantities(values.map(std::mem::take).unwrap_or_default())
        }
    }
}

impl ChannelArray {
    /// Returns the array for all whiskers, with this one as the first. A single whisker keeps its memory.
    fn spread(self, whiskers: usize) -> Self {
        fn longer<T: Clone + Default>(mut values: Vec<T>, whiskers: usize) -> Vec<T> {
            values.resize(values.len() * whiskers, T::default());
            values
        }
        match self {
            Self::Codes(values) => Self::Codes(longer(values, whiskers)),
            Self::Counts(values) => Self::Counts(longer(values, whiskers)),
            Self::Quantities(values) => Self::Quantities(longer(values, whiskers)),
        }
    }

    /// Writes the values of one whisker at its place.
    fn put(&mut self, place: usize, values: &Self) {
        fn copy<T: Copy>(all: &mut [T], place: usize, values: &[T]) {
            all[place * values.len()..][..values.len()].copy_from_slice(values);
        }
        match (self, values) {
            (Self::Codes(all), Self::Codes(values)) => copy(all, place, values),
            (Self::Counts(all), Self::Counts(values)) => copy(all, place, values),
            (Self::Quantities(all), Self::Quantities(values)) => copy(all, place, values),
            _ => {}
        }
    }
}

/// Returns the place of a whisker in an array whose last sweep axis varies fastest. In the sweep, the first one does.
fn place(grid: &Grid, whisker: usize) -> usize {
    let axes = grid.sweep.iter().zip(grid.indices(whisker));
    axes.fold(0, |place, (axis, index)| place * axis.values.len() + index)
}
