//! Files of whisker trackers: base angle, curvature and contact of each frame, shapes, and detachments.
//!
//! Trackers write positions in pixels, and their y axis points downward. A file is read into frames in pixels (`deeplabcut`, `measurements`,
//! `points`). Then the end at the base is found (`orient`), each frame gets its curve in millimetres (`curve`), and the curves give rows for
//! `whisk` and `force` (`rows`) and points for `fit` (`detachment`).

mod bent;
mod common;
mod curve;
mod deeplabcut;
mod detachment;
mod frame_curve;
mod measurements;
mod names;
mod options;
mod orient;
mod points;
mod rods;
mod rows;
mod sample;

pub use detachment::TrackedDetachment;
pub use options::{FaceAxis, ImagePole, TrackingError, TrackingFormat, TrackingOptions};
pub use rows::{NoFrame, TrackedFrame};

use crate::input::{CsvError, CsvLines, STDIN, read_bytes, text_of};
use crate::trace::row;
use frame_curve::FrameCurve;
use options::refused;
use serde::Serialize;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Longest file of a tracker in MiB: 400,000 frames of 10 body parts.
const TRACKING_MIB: u64 = 256;

/// Largest number of frames from the first to the last one.
const MOST_FRAMES: u64 = 1_000_000;

/// First bytes of an HDF5 file, and so of an NWB file.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";

/// Points more than the degree that a curve needs.
const MORE_POINTS: usize = 4;

/// Allowed cells of a column of frames.
const FRAME_NUMBERS: &str = "a whole number of at least 0";

/// Returns the number of a frame in a cell; `None` for another text.
fn frame_number(cell: &str) -> Option<u64> {
    u64::try_from(whole_number(cell)?).ok()
}

/// Returns the whole number in a cell, which may have a decimal point or comma: programs write `0.0` in a column with a gap.
fn whole_number(cell: &str) -> Option<i64> {
    let number: f64 = cell.replace(',', ".").parse().ok()?;
    let is_whole = number.fract() == 0.0 && number.abs() < 1e15;
    is_whole.then_some(number as i64)
}

/// Frame of a film as a tracker gives it, in pixels with the y axis downward.
#[derive(Clone, Debug, PartialEq)]
struct ImageFrame {
    /// Number of the frame in the film.
    number: u64,
    /// Points along the whisker, `[point][x, y]`; `None` where one is lost. Empty in a frame without a whisker.
    points_px: Vec<Option<[f64; 2]>>,
    /// Angle at the follicle as the tracker gives it, in degrees, and mean curvature, in 1/px, of a whisker with two points, its ends.
    bend: Option<[f64; 2]>,
    /// Centre of the pole; `None` if it is lost or there is none.
    pole_px: Option<[f64; 2]>,
}

impl ImageFrame {
    /// Returns the points in mm with the y axis upward, from the base on, at this scale in mm per pixel; `None` if the base is lost.
    fn points_mm(&self, scale: f64) -> Option<Vec<[f64; 2]>> {
        (*self.points_px.first()?)?;
        let points = self.points_px.iter().flatten();
        Some(points.map(|[x, y]| [scale * x, -scale * y]).collect())
    }
}

/// Frames of a file before their calibration.
#[derive(Debug)]
struct ImageFrames {
    /// Frames in the order of time, `[frame]`; numbers grow.
    frames: Vec<ImageFrame>,
    /// Order of the points of each frame.
    order: PointOrder,
    remarks: Remarks,
}

/// Notes and warnings about a film.
#[derive(Debug, Default)]
struct Remarks {
    /// What was found.
    notes: Vec<String>,
    /// What may be wrong, or is not known.
    warnings: Vec<String>,
}

/// Order of the points of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
enum PointOrder {
    /// Order from base to tip.
    FromBase,
    /// Order along the whisker, in either direction, which may change from frame to frame.
    Along,
    /// Any order, which is the same in all frames, of points with these names: `[point]`.
    Named(Vec<String>),
}

/// Whisker of a film, frame by frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Tracking {
    /// Format of the tracker's file.
    pub format: TrackingFormat,
    /// Frames from the first to the last one, `[frame]`; lost frames are gaps.
    pub frames: Vec<TrackedFrame>,
    /// Detachments from the pole, `[detachment]`; none without a pole.
    pub detachments: Vec<TrackedDetachment>,
    /// Notes on what was found: the base, mirrored images, the degree of curves, gaps.
    pub notes: Vec<String>,
    /// Warnings: a pole, an option or points that do not fit, and contacts that are not known.
    pub warnings: Vec<String>,
    /// Number of each frame, and its traced points in millimetres from base to tip, `[frame]`.
    shapes: Vec<(u64, Vec<[f64; 2]>)>,
}

row! {
    /// Point along a traced whisker, from base to tip, with the y axis upward.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct TrackedPoint {
        /// Position to the right in the image, in mm.
        pub x_mm: f64,
        /// Position upward in the image, in mm; downward in a mirrored one.
        pub y_mm: f64,
    }
}

impl Tracking {
    /// Reads the files of a tracker; `-` is standard input. Only points `x,y` may come in several files, one for each frame, in
    /// any order if their names have its number.
    ///
    /// # Errors
    /// If a file cannot be read, is longer than 256 MiB or has no known format, and for the reasons of [`Tracking::parse`].
    pub fn read(
        paths: &[impl AsRef<Path>],
        options: &TrackingOptions,
        cancel: &AtomicBool,
    ) -> Result<Self, TrackingError> {
        let text = |path: &Path| {
            let origin = match path.as_os_str() == "-" {
                true => STDIN.to_owned(),
                false => path.to_string_lossy().into_owned(),
            };
            let bytes = read_bytes(path, TRACKING_MIB)?;
            if bytes.starts_with(HDF5) {
                let what = "is an HDF5 file: NWB files are read in Python, by wm.read_tracking";
                return Err(CsvError::whole(&origin, what));
            }
            Ok((text_of(&bytes, &origin)?, origin))
        };
        let texts = paths.iter().map(|path| text(path.as_ref()));
        let texts = texts.collect::<Result<Vec<_>, _>>()?;
        Self::parse(&texts, options, cancel)
    }

    /// Reads texts of a tracker's files, each with its name in messages: `[file][text, name]`. If `cancel` becomes true, the function soon
    /// returns [`TrackingError::Cancelled`].
    ///
    /// # Errors
    /// If a text has no known format, a cell is no number, an option does not fit the format or is out of its range, or the data do not show
    /// which end is the base. Also after a cancellation.
    pub fn parse(
        texts: &[(String, String)],
        options: &TrackingOptions,
        cancel: &AtomicBool,
    ) -> Result<Self, TrackingError> {
        options.check()?;
        let go_on = || match cancel.load(Ordering::Relaxed) {
            true => Err(TrackingError::Cancelled),
            false => Ok(()),
        };
        go_on()?;
        let Some((first, rest)) = texts.split_first() else {
            return Err(CsvError::whole("tracking", "has no file: must have at least one").into());
        };
        let format = match options.format {
            Some(format) => format,
            None => TrackingFormat::of(first)?,
        };
        if !rest.is_empty() && format != TrackingFormat::Xy {
            let what = format!(
                "is a second file: only the format {} may have several, one for each frame",
                TrackingFormat::Xy.name()
            );
            return Err(CsvError::whole(&rest[0].1, what).into());
        }
        let (text, origin) = first;
        let mut image = match format {
            TrackingFormat::DeepLabCut => {
                let lines = CsvLines::split(text, origin)?;
                deeplabcut::read(lines, origin, options, cancel)?
            }
            TrackingFormat::Whisk => measurements::read(text, origin, options)?,
            TrackingFormat::Xy => points::read(texts, options)?,
        };
        let numbers = image.frames.iter().map(|frame| frame.number);
        let span = numbers.clone().max().zip(numbers.min());
        let Some((last, from)) = span.filter(|(last, from)| last - from < MOST_FRAMES) else {
            let what = format!("must have frames whose numbers differ by less than {MOST_FRAMES}");
            return Err(CsvError::whole(origin, what).into());
        };
        go_on()?;
        orient::order(&mut image, options)?;
        go_on()?;
        let curves = curve::Curves::new(&image.frames, options, cancel, &mut image.remarks)?;
        let needs = curves.needs.clone();
        let curves = curves.of_frames(from..=last);
        go_on()?;
        if curves.iter().all(|frame| frame.curve.is_err()) {
            let what = format!("has no frame with a curve: must have at least one with {needs}");
            return Err(CsvError::whole(origin, what).into());
        }
        let mut remarks = image.remarks;
        let (frames, contacts) = rows::frames(&curves, options, cancel, &mut remarks)?;
        go_on()?;
        let shapes = curves.iter().map(|frame| (frame.number, frame.points_mm.clone()));
        Ok(Self {
            format,
            detachments: detachment::detachments(&curves, &frames, &contacts, &mut remarks),
            frames,
            notes: remarks.notes,
            warnings: remarks.warnings,
            shapes: shapes.collect(),
        })
    }

    /// Returns the points of each frame from base to tip, in mm with the y axis upward, `[frame][point][x, y]`; a gap has none. Measurements of
    /// whisk have base and tip alone.
    pub fn points_mm(&self) -> impl Iterator<Item = &[[f64; 2]]> {
        self.shapes.iter().map(|(_, points)| &**points)
    }

    /// Returns the traced points of the frame with this number, from base to tip, for `whisker.rest.points` of a scene.
    ///
    /// # Errors
    /// If there is no such frame, it is a gap, or the format has no points.
    pub fn shape(&self, frame: u64) -> Result<Vec<TrackedPoint>, TrackingError> {
        let refused = |must: String| refused("shape", &frame.to_string(), must);
        if self.format == TrackingFormat::Whisk {
            return Err(refused(
                "must be left out: measurements of whisk have no points along the whisker"
                    .to_owned(),
            ));
        }
        let found = self.shapes.iter().find(|(number, _)| *number == frame);
        let Some((_, points)) = found else {
            let ends = [self.shapes.first(), self.shapes.last()]
                .map(|shape| shape.map_or(0, |(number, _)| *number));
            return Err(refused(format!(
                "must be between {} and {}, the numbers of the frames",
                ends[0], ends[1]
            )));
        };
        if points.is_empty() {
            return Err(refused("must be a frame with a whisker: this one is a gap".to_owned()));
        }
        let point = |[x_mm, y_mm]: &[f64; 2]| TrackedPoint { x_mm: *x_mm, y_mm: *y_mm };
        Ok(points.iter().map(point).collect())
    }
}

/// Curve of a frame, or the reason for its gap.
#[derive(Debug)]
struct CurvedFrame {
    number: u64,
    curve: Result<FrameCurve, NoFrame>,
    /// Traced points from base to tip, `[point][x, y]`, in mm; empty in a gap.
    points_mm: Vec<[f64; 2]>,
    /// Centre of the pole in mm; `None` if it is lost or there is none.
    pole_mm: Option<[f64; 2]>,
}
