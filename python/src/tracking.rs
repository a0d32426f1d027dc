//! Files of whisker trackers, as columns.

use crate::arguments;
use crate::columns::{Column, Table};
use crate::motion::refused;
use crate::threads;
use numpy::PyArray1;
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
    likelihood: Option<f64>,
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
#[derive(IntoPyObject)]
pub struct TrackedFilm<'py> {
    format: &'static str,
    frames: Vec<Column<'py>>,
    detachments: Vec<Column<'py>>,
    /// Points of all frames in mm, one frame after the other, `[point, x or y]` in one dimension.
    points: Bound<'py, PyArray1<f64>>,
    /// Number of points of each frame, `[frame]`; 0 in a gap.
    counts: Bound<'py, PyArray1<i64>>,
    notes: Vec<String>,
    warnings: Vec<String>,
}

/// Reads the texts of a tracker's files, each with its name in messages.
#[pyfunction]
pub fn read_tracking(
    py: Python<'_>,
    texts: Vec<(String, String)>,
    options: Options,
) -> PyResult<TrackedFilm<'_>> {
    let options = options.checked()?;
    let job = |cancel: &Arc<AtomicBool>| {
        let film = Tracking::parse(&texts, &options, cancel)?;
        let frames = Table::new(&film.frames, TrackedFrame::COLUMNS, cancel);
        let detachments = Table::new(&film.detachments, TrackedDetachment::COLUMNS, cancel);
        Ok((film, frames, detachments))
    };
    let found = threads::run(py, None, |_| Ok(()), job)?;
    let (film, frames, detachments) = found.map_err(|why: TrackingError| refused(&why))?;
    let counts = film.points_mm().map(|points| points.len() as i64);
    let points = film.points_mm().flatten().flatten().copied();
    Ok(TrackedFilm {
        format: film.format.name(),
        frames: frames.into_columns(py)?,
        detachments: detachments.into_columns(py)?,
        points: PyArray1::from_iter(py, points),
        counts: PyArray1::from_iter(py, counts),
        notes: film.notes,
        warnings: film.warnings,
    })
}
