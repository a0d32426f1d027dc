//! Maps of scenes that are computed when they are read.

use crate::arguments;
use crate::errors::{of_front, of_store};
use crate::maps::spectral_warning;
use crate::scene::CheckedScene;
use crate::stored::array;
use crate::threads::{self, ThreadCount};
use pyo3::prelude::*;
use whiskmap::store;

/// Map of a scene, of which whiskers are computed when they are read. Calls of several threads must take turns.
#[pyclass(frozen, module = "whiskmap._whiskmap")]
pub struct ComputedMap {
    map: store::ComputedMap,
    threads: Option<ThreadCount>,
    warning: Option<String>,
}

#[pymethods]
impl ComputedMap {
    /// Opens the map of `scene`. No whisker is computed.
    #[new]
    fn new(
        py: Python<'_>,
        scene: &CheckedScene,
        engine: &str,
        tolerance_deg: Option<f64>,
        channels: Option<Vec<String>>,
        threads: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let threads = ThreadCount::of(threads.as_ref())?;
        let scene = &scene.0;
        let options = arguments::options(engine, tolerance_deg, channels)?;
        let warning = spectral_warning(scene, options.engine);
        let open = |_: &_| whiskmap::lazy_map(scene, options);
        let map = threads::run(py, threads, |_| Ok(()), open)?;
        Ok(Self { map: map.map_err(|why| of_front(&why))?, threads, warning })
    }

    /// Names of the channels of the map.
    fn channels(&self) -> Vec<&'static str> {
        self.map.channels()
    }

    /// Name of the engine that solves the cells.
    fn engine(&self) -> &str {
        &self.map.engine.engine
    }

    /// Returns a warning about the engine, if there is one.
    fn warning(&self) -> Option<&str> {
        self.warning.as_deref()
    }

    /// Returns a channel of some whiskers, `[whisker, distance, push angle]` in one dimension, and warnings about those that were computed. The
    /// first sweep axis varies fastest in the order of whiskers.
    fn read<'py>(
        &self,
        py: Python<'py>,
        channel: &str,
        whiskers: Vec<usize>,
    ) -> PyResult<(Bound<'py, PyAny>, Vec<String>)> {
        let values = threads::run(
            py,
            self.threads,
            |_| Ok(()),
            |cancel| self.map.read(channel, &whiskers, &mut |_| {}, cancel),
        )?
        .map_err(|why| of_store(&why))?;
        Ok((array(py, channel, values), self.map.take_warnings()))
    }
}
