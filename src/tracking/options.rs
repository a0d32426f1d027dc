//! Formats and options of trackers, and their errors.

use crate::input::{CsvError, did_you_mean, is_missing};
use crate::names::names;
use crate::scene::digits;
use crate::traced::MOST_DEGREE;

/// Format of a tracker's file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrackingFormat {
    /// CSV file of DeepLabCut: the rows `scorer`, `bodyparts` and `coords`, then a row for each frame.
    DeepLabCut,
    /// Measurements of `whisk` as CSV: a row for each traced segment, with follicle, tip, angle and mean curvature.
    Whisk,
    /// Points `x,y`, a file for each frame, or `frame,x,y`, with or without these names in the first line.
    Xy,
}

names!(TrackingFormat { DeepLabCut = "deeplabcut", Whisk = "whisk", Xy = "xy" });

impl TrackingFormat {
    /// Finds the format of a text by its first line.
    pub(super) fn of((text, origin): &(String, String)) -> Result<Self, CsvError> {
        let is_content = |line: &&str| !line.trim().is_empty() && !line.starts_with('#');
        let text = text.trim_start_matches('\u{feff}');
        let line = text.lines().find(is_content).unwrap_or_default();
        let cells: Vec<&str> =
            line.split([',', ';', '\t']).map(|cell| cell.trim().trim_matches('"')).collect();
        let is_number =
            |cell: &&str| is_missing(cell) || cell.replace(',', ".").parse::<f64>().is_ok();
        match &cells[..] {
            ["scorer", ..] => Ok(Self::DeepLabCut),
            _ if cells.contains(&"follicle_x") => Ok(Self::Whisk),
            ["x", "y"] | ["frame", "x", "y"] => Ok(Self::Xy),
            _ if line.is_empty() || cells.iter().all(is_number) => Ok(Self::Xy),
            _ => {
                let what = "has no known format: must be of DeepLabCut (the first cell is scorer), measurements of whisk (with a column \
                            follicle_x), or points x,y or frame,x,y";
                Err(CsvError::whole(origin, what))
            }
        }
    }
}

/// Axis of the image from which `whisk` measures angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceAxis {
    /// Angles begin at the x axis: the face is at the top or at the bottom of the image.
    X,
    /// Angles begin at the y axis: the face is at the left or at the right of the image.
    Y,
}

names!(FaceAxis { X = "x", Y = "y" });

/// Pole in the image.
#[derive(Clone, Debug, PartialEq)]
pub enum ImagePole {
    /// Centre of a fixed pole, `[x, y]` in pixels.
    At([f64; 2]),
    /// Name of the body part of DeepLabCut that is the pole's centre.
    Part(String),
}

/// Options with which a tracker's file is read.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TrackingOptions {
    /// Format of the file; `None` to recognise it.
    pub format: Option<TrackingFormat>,
    /// Scale of the image, in mm per pixel.
    pub mm_per_pixel: f64,
    /// Frames per second.
    pub fps: f64,
    /// Identity of the whisker in measurements of `whisk`; `None` if there is one.
    pub whisker: Option<i64>,
    /// Names of the body parts of DeepLabCut along the whisker, from base to tip. If empty, they are all but the pole, and their order is found.
    pub points: Vec<String>,
    /// Least likelihood of a point of DeepLabCut; points below it are lost. `None` for 0.9.
    pub likelihood: Option<f64>,
    /// Position of the follicle, `[x, y]` in pixels: the end that is nearer to it is the base. `None` to find the end that moves less.
    pub follicle_px: Option<[f64; 2]>,
    /// Arclength from the base at which the curvature is given, in mm; `None` for a quarter of the median length.
    pub curvature_at_mm: Option<f64>,
    /// Distance from the base up to which points give base angle and curvature, in mm; `None` for 0.6 of the median length, or as far as 8
    /// points reach. A distance selects polynomials, also with a pole.
    pub fit_to_mm: Option<f64>,
    /// Degree of the curvature of each frame's curves, or of the rod at rest; `None` to choose it.
    pub degree: Option<usize>,
    /// True to mirror the image, false to leave it; `None` to mirror it if the whisker turns clockwise from base to tip.
    pub mirror: Option<bool>,
    /// Axis from which the angles of `whisk` are measured; `None` to find it.
    pub face_axis: Option<FaceAxis>,
    /// Pole; `None` without one.
    pub pole: Option<ImagePole>,
    /// Largest distance of the whisker from the pole's centre in contact, in mm. It is needed with a pole.
    pub contact_within_mm: Option<f64>,
    /// Taper of the traced whisker, `1 - r_tip/r_base`, from 0 to 1; `None` to find it from frames in contact.
    pub taper: Option<f64>,
    /// Time of the frame in which the angle of the base is 0, in s; `None` for first touch on CB, or else the first frame with a whisker.
    pub zero_s: Option<f64>,
}

impl TrackingOptions {
    /// Names of the options, which are in backticks in notes and warnings: `[option]`.
    pub const NAMES: [&'static str; 16] = [
        "format",
        "mm_per_pixel",
        "fps",
        "whisker",
        "points",
        "likelihood",
        "follicle_px",
        "curvature_at_mm",
        "fit_to_mm",
        "degree",
        "mirror",
        "face_axis",
        "pole",
        "contact_within_mm",
        "taper",
        "zero_s",
    ];

    /// Creates options with a scale in mm per pixel and a number of frames per second. All else is found.
    #[must_use]
    pub const fn new(mm_per_pixel: f64, fps: f64) -> Self {
        Self {
            format: None,
            mm_per_pixel,
            fps,
            whisker: None,
            points: Vec::new(),
            likelihood: None,
            follicle_px: None,
            curvature_at_mm: None,
            fit_to_mm: None,
            degree: None,
            mirror: None,
            face_axis: None,
            pole: None,
            contact_within_mm: None,
            taper: None,
            zero_s: None,
        }
    }

    /// Checks the ranges of the options.
    pub(super) fn check(&self) -> Result<(), TrackingError> {
        let positive = |number: f64| (1e-9..=1e9).contains(&number);
        let numbers = [
            ("mm_per_pixel", Some(self.mm_per_pixel)),
            ("fps", Some(self.fps)),
            ("contact_within_mm", self.contact_within_mm),
            ("fit_to_mm", self.fit_to_mm),
        ];
        for (option, number) in numbers {
            if let Some(number) = number.filter(|number| !positive(*number)) {
                let must = "must be a number between 1e-9 and 1e9".to_owned();
                return Err(refused(option, &digits(number), must));
            }
        }
        if let Some(likelihood) = self.likelihood.filter(|least| !(0.0..=1.0).contains(least)) {
            let must = "must be a number between 0 and 1".to_owned();
            return Err(refused("likelihood", &digits(likelihood), must));
        }
        if let Some(degree) = self.degree.filter(|degree| *degree > MOST_DEGREE) {
            let must = format!("must be between 0 and {MOST_DEGREE}");
            return Err(refused("degree", &degree.to_string(), must));
        }
        if let Some(taper) = self.taper {
            let must = if !(0.0..=1.0).contains(&taper) {
                Some("must be a number between 0 and 1")
            } else if self.pole.is_none() {
                Some("must be left out without a pole")
            } else if self.fit_to_mm.is_some() {
                Some("must be left out with fit_to_mm, which selects polynomials")
            } else {
                None
            };
            if let Some(must) = must {
                return Err(refused("taper", &digits(taper), must.to_owned()));
            }
        }
        match (&self.pole, self.contact_within_mm) {
            (Some(pole), None) => {
                let value = match pole {
                    ImagePole::At([x, y]) => format!("{x},{y}"),
                    ImagePole::Part(name) => name.clone(),
                };
                let must = "needs contact_within_mm, the largest distance of the whisker from the pole's centre in contact";
                Err(refused("pole", &value, must.to_owned()))
            }
            (None, Some(within)) => {
                let must = "must be left out without a pole".to_owned();
                Err(refused("contact_within_mm", &digits(within), must))
            }
            _ => Ok(()),
        }
    }
}

/// Error of a tracker's file, or of an option with which it is read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrackingError {
    /// The file cannot be read, or has a wrong cell.
    #[error(transparent)]
    File(#[from] CsvError),
    /// The flag that cancels is true.
    #[error("cancelled")]
    Cancelled,
    /// An option does not fit the file, or is out of its range.
    #[error("{option} = {value}: {must}")]
    Option {
        /// Name of the option: a field of [`TrackingOptions`], or `shape`.
        option: &'static str,
        /// Value of the option.
        value: String,
        /// Message: what is allowed.
        must: String,
    },
}

/// Error about an option.
pub(super) fn refused(option: &'static str, value: &str, must: String) -> TrackingError {
    TrackingError::Option { option, value: value.to_owned(), must }
}

/// Error about the name of a body part that a file does not have.
pub(super) fn unknown(option: &'static str, name: &str, known: &[&str]) -> TrackingError {
    let hint = did_you_mean(name, known.iter().copied());
    refused(option, name, format!("must be one of {}{hint}", known.join(", ")))
}
