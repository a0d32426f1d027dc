//! Files of whisker trackers, as columns.

use crate::arguments;
use crate::columns::{Column, Table};
use crate::motion::refused;
use crate::threads;
use pyo3::prelude::*;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use whiskmap::tracking::{
    FaceAxis, ImagePole, TrackedDetachment, TrackedFrame, Tracking, TrackingError, TrackingFormat,
    TrackingOptions,
};

/// Options by name.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Options {
    format: Option<String>,
    mm_per_pixel: f64,
    fps: f64,
    whisker: Option<i64>,
    points: Vec<String>,
    likelihood: f64,
    follicle_px: Option<[f64; 2]>,
    curvature_at_mm: Option<f64>,
    fit_to_mm: Option<f64>,
    degree: Option<usize>,
    mirror: Option<bool>,
    face_axis: Option<String>,
    pole: Option<Pole>,
    contact_within_mm: Option<f64>,
    taper: Option<f64>,
    zero_s: Option<f64>,
}

/// Pole: its position in pixels, or the name of a body part.
#[derive(FromPyObject)]
enum Pole {
    Part(String),
    At([f64; 2]),
}

impl Options {
    fn checked(self) -> PyResult<TrackingOptions> {
        let mut options = TrackingOptions::new(self.mm_per_pixel, self.fps);
        let format = self.format.as_deref().map(|name| {
            arguments::named("format", name, TrackingFormat::ALL, TrackingFormat::name)
        });
        options.format = format.transpose()?;
        options.whisker = self.whisker;
        options.points = self.points;
        options.likelihood = self.likelihood;
        options.follicle_px = self.follicle_px;
        options.curvature_at_mm = self.curvature_at_mm;
        options.fit_to_mm = self.fit_to_mm;
        options.degree = self.degree;
        options.mirror = self.mirror;
        let face_axis = self.face_axis.as_deref();
        let face_axis = face_axis
            .map(|name| arguments::named("face_axis", name, FaceAxis::ALL, FaceAxis::name));
        options.face_axis = face_axis.transpose()?;
        options.pole = self.pole.map(|pole| match pole {
            Pole::Part(name) => ImagePole::Part(name),
            Pole::At(at) => ImagePole::At(at),
        });
        options.contact_within_mm = self.contact_within_mm;
        options.taper = self.taper;
        options.zero_s = self.zero_s;
        Ok(options)
    }
}

/// Whisker of a film, frame by frame.
#[pyclass(frozen, module = "whiskmap._whiskmap")]
pub struct TrackedFilm(Tracking);

#[pymethods]
impl TrackedFilm {
    /// Reads the texts of a tracker's files, each with its name in messages.
    #[staticmethod]
    fn parse(py: Python<'_>, texts: Vec<(String, String)>, options: Options) -> PyResult<Self> {
        let options = options.checked()?;
        let job = |cancel: &Arc<AtomicBool>| Tracking::parse(&texts, &options, cancel);
        let found =
            threads::run(py, None, |_| Ok(()), job)?.map_err(|why: TrackingError| refused(&why))?;
        Ok(Self(found))
    }

    /// Returns the name of the format.
    fn format(&self) -> &'static str {
        self.0.format.name()
    }

    /// Returns the columns of the frames.
    fn frames<'py>(&self, py: Python<'py>) -> PyResult<Vec<Column<'py>>> {
        let none = AtomicBool::new(false);
        Table::new(&self.0.frames, TrackedFrame::COLUMNS, &none).into_columns(py)
    }

    /// Returns the columns of the detachments.
    fn detachments<'py>(&self, py: Python<'py>) -> PyResult<Vec<Column<'py>>> {
        let none = AtomicBool::new(false);
        Table::new(&self.0.detachments, TrackedDetachment::COLUMNS, &none).into_columns(py)
    }

    /// Returns notes on what was found.
    fn notes(&self) -> Vec<String> {
        self.0.notes.clone()
    }

    /// Returns warnings about what may be wrong or is not known.
    fn warnings(&self) -> Vec<String> {
        self.0.warnings.clone()
    }

    /// Returns the points of a frame from base to tip, `[point][x, y]` in mm.
    fn shape(&self, frame: u64) -> PyResult<Vec<[f64; 2]>> {
        let points = self.0.shape(frame).map_err(|why| refused(&why))?;
        Ok(points.iter().map(|point| [point.x_mm, point.y_mm]).collect())
    }
}
