//! Stored maps, read panel by panel.

use crate::about;
use crate::errors::of_store;
use numpy::PyArray1;
use pyo3::prelude::*;
use std::path::PathBuf;
use whiskmap::store::{ChannelValues, MapSlice, MapSource};

/// Attributes of a stored map that every reader needs.
const ATTRIBUTES: [&str; 5] = ["whiskmap_version", "engine", "arithmetic", "tolerances", "scene"];

/// An EXR map or a Zarr store that is open for reading.
#[pyclass(frozen, module = "whiskmap._whiskmap")]
pub struct StoredMap {
    path: PathBuf,
    map: MapSlice,
}

#[pymethods]
impl StoredMap {
    /// Opens an EXR map, or a Zarr store if the path is a folder. Cells of a store that are not computed have fill values.
    #[new]
    fn new(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let opened = py.detach(|| {
            let source = MapSource::open(&path)?;
            // Without a selected value, none can be refused.
            let mut map = MapSlice::whole(source);
            map.blank_missing()?;
            Ok(map)
        });
        let map = opened.map_err(|why| of_store(&why))?;
        Ok(Self { path, map })
    }

    /// Names of the channels of the map.
    fn channels(&self) -> Vec<&'static str> {
        self.map.channels()
    }

    /// Name, CF attributes as JSON, and values of each coordinate.
    fn coordinates<'py>(&self, py: Python<'py>) -> Vec<about::Coordinate<'py>> {
        about::of_grid(py, self.map.grid())
    }

    /// Title of the scene, and other attributes as JSON.
    fn attributes(&self) -> PyResult<Vec<(&'static str, String)>> {
        let stored = self.map.source();
        let title = ("title", serde_json::Value::from(stored.title()).to_string());
        let others = ATTRIBUTES.into_iter().map(|name| {
            let value = stored.attribute(name).map_err(|why| of_store(&why))?;
            Ok((name, value.to_string()))
        });
        std::iter::once(Ok(title)).chain(others).collect()
    }

    /// Returns a warning about a map of another version; `None` about one of this version.
    fn warning(&self) -> PyResult<Option<String>> {
        let version = self.map.source().foreign_version();
        let version = version.map_err(|why| of_store(&why))?;
        Ok(version.map(|version| {
            let (path, current) = (self.path.display(), env!("CARGO_PKG_VERSION"));
            format!("{path} was written by whiskmap {version}, not by {current}; its channels may have another meaning")
        }))
    }

    /// Reads a channel of some whiskers, `[whisker, distance, push angle]` in one dimension. The first sweep axis varies fastest in
    /// the order of whiskers.
    fn read<'py>(
        &self,
        py: Python<'py>,
        channel: &str,
        whiskers: Vec<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (mut codes, mut quantities) = (Vec::new(), Vec::new());
        for whisker in whiskers {
            let panel = py.detach(|| self.map.read_panel(channel, whisker));
            match panel.map_err(|why| of_store(&why))? {
                ChannelValues::U32(whisker_codes) => codes.extend(whisker_codes),
                ChannelValues::F32(whisker_values) => quantities.extend(whisker_values),
            }
            py.check_signals()?;
        }
        let values = match codes.is_empty() {
            true => ChannelValues::F32(quantities),
            false => ChannelValues::U32(codes),
        };
        Ok(array(py, channel, values))
    }

    /// A map is pickled as its path.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyAny>, (PathBuf,)) {
        (slf.get_type().into_any(), (slf.get().path.clone(),))
    }
}

/// Returns the values of a channel as an array of one dimension; codes as `uint8`.
pub fn array<'py>(py: Python<'py>, channel: &str, values: ChannelValues) -> Bound<'py, PyAny> {
    match (channel, values) {
        (_, ChannelValues::F32(quantities)) => PyArray1::from_vec(py, quantities).into_any(),
        ("newton_steps", ChannelValues::U32(counts)) => PyArray1::from_vec(py, counts).into_any(),
        (_, ChannelValues::U32(codes)) => {
            let codes = codes.iter().map(|code| code.to_le_bytes()[0]);
            PyArray1::from_iter(py, codes).into_any()
        }
    }
}
