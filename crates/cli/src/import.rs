//! Command `whiskmap import`.

use super::arguments::{column_help, duration, length, named, whole};
use super::failure::{Failure, message, notes, warnings};
use super::files::Files;
use super::outputs::{Columns, OutputTable, write_table};
use clap::{ArgAction, Args};
use serde::Serialize;
use std::io::Write;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use whiskmap::input::Quantity;
use whiskmap::store::Output;
use whiskmap::terminal::StandardOutput;
use whiskmap::tracking::{
    FaceAxis, ImagePole, TrackedDetachment, TrackedFrame, TrackedPoint, Tracking, TrackingError,
    TrackingFormat, TrackingOptions,
};

const EXAMPLES: &str = "\
Examples:
  whiskmap import scenes/deeplabcut.csv --mm-per-pixel 0.05 --fps 500 --pole pole --contact-within 0.35mm -o frames.csv
  whiskmap import scenes/deeplabcut.csv --mm-per-pixel 0.05 --pole pole --contact-within 0.35mm --shape 0 -o traced.csv
  whiskmap import scenes/measurements.csv --mm-per-pixel 0.05 --fps 500 -o frames.csv

FILE is a CSV file of DeepLabCut, measurements of whisk as CSV, or points along the whisker: x,y in a file for each frame, or \
frame,x,y, with or without these names in the first line. Positions are in pixels, and the y axis of the image points downward.

The base is the end of the whisker that moves less, or the one nearer to --follicle. The image is mirrored if the whisker turns clockwise \
from base to tip. Lost frames are rows with a reason.";

const FORMAT_HELP: [&str; 3] = [
    "CSV file with the rows scorer, bodyparts and coords",
    "Measurements of Janelia's whisk as CSV",
    "Points x,y or frame,x,y, with or without a header",
];

const FACE_AXIS_HELP: [&str; 2] = [
    "The face is at the top or at the bottom of the image",
    "The face is at the left or at the right of the image",
];

#[derive(Debug, Args)]
#[command(
    after_help = EXAMPLES,
    after_long_help = column_help(EXAMPLES, &[
        ("Columns", TrackedFrame::COLUMNS),
        ("Columns with --shape", TrackedPoint::COLUMNS),
        ("Columns with --detachments", TrackedDetachment::COLUMNS),
    ])
)]
pub struct ImportArgs {
    /// File of the tracker, or a file for each frame; - is standard input
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Write the table to FILE; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    /// Format of the files [default: recognised by the first line]
    #[arg(long, value_parser = named(TrackingFormat::ALL, TrackingFormat::name, FORMAT_HELP))]
    format: Option<TrackingFormat>,
    /// Scale of the image: size of a pixel, in mm or with a unit
    #[arg(long, value_name = "MM", value_parser = length)]
    mm_per_pixel: f64,
    /// Frames per second
    #[arg(long, value_name = "HZ", required_unless_present = "shape", value_parser = number)]
    fps: Option<f64>,
    /// Write the points of frame NUMBER instead, in mm, as whisker.rest.points of a scene
    #[arg(long, value_name = "NUMBER", conflicts_with = "detachments")]
    shape: Option<u64>,
    /// Write the detachments from the pole instead, as `fit` reads them
    #[arg(long, requires = "pole")]
    detachments: bool,
    /// Identity of the whisker in measurements of whisk [default: the only one]
    #[arg(long, value_name = "ID", allow_hyphen_values = true)]
    whisker: Option<i64>,
    /// Body parts along the whisker, from base to tip, separated by commas [default: all but the pole, whose order is found]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    points: Vec<String>,
    /// Least likelihood of a point of DeepLabCut, from 0 to 1; points below it are lost [default: 0.9]
    #[arg(long, value_name = "P", value_parser = number)]
    likelihood: Option<f64>,
    /// Position of the follicle in pixels; the nearer end of the whisker is the base [default: the end that moves less]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, value_parser = pixels)]
    follicle: Option<[f64; 2]>,
    /// Arclength from the base at which the curvature is given, in mm or with a unit [default: a quarter of the median length]
    #[arg(long, value_name = "MM", value_parser = length)]
    curvature_at: Option<f64>,
    /// Distance from the base up to which points give base angle and curvature, in mm or with a unit [default: 0.6 of the median length, or as far as 8 points reach]. It selects polynomials, also with --pole
    #[arg(long, value_name = "MM", value_parser = length)]
    fit_to: Option<f64>,
    /// Degree of the curvature of the curves through the points of a frame, or with --pole of the rod at rest [default: chosen]
    #[arg(long, value_name = "DEGREE", value_parser = whole(0..=6))]
    degree: Option<u32>,
    /// Mirror the image [default: if the whisker turns clockwise from base to tip]
    #[arg(long, value_name = "YES/NO", action = ArgAction::Set, value_parser = yes_or_no)]
    mirror: Option<bool>,
    /// Axis of the image from which the angles of whisk are measured [default: found by the ends of the segments]
    #[arg(long, value_parser = named(FaceAxis::ALL, FaceAxis::name, FACE_AXIS_HELP))]
    face_axis: Option<FaceAxis>,
    /// Centre of the pole: X,Y in pixels, or a body part of DeepLabCut
    #[arg(long, value_name = "X,Y/NAME", allow_hyphen_values = true, requires = "contact_within", value_parser = pole)]
    pole: Option<ImagePole>,
    /// Largest distance of the whisker from the pole's centre in contact, in mm or with a unit
    #[arg(long, value_name = "MM", requires = "pole", value_parser = length)]
    contact_within: Option<f64>,
    /// Taper of the traced whisker, 1 - r_tip/r_base, from 0 to 1 [default: found from frames in contact]
    #[arg(long, value_name = "TAPER", requires = "pole", conflicts_with = "fit_to", value_parser = number)]
    taper: Option<f64>,
    /// Time of the frame in which the angle of the base is 0, in s or with a unit [default: first touch on CB]
    #[arg(long, value_name = "TIME", value_parser = time)]
    zero: Option<f64>,
}

fn number(text: &str) -> Result<f64, String> {
    Quantity::Number.parse(text)
}

/// Parses a time in seconds, 0 or more.
fn time(text: &str) -> Result<f64, String> {
    match number(text) {
        Ok(0.0) => Ok(0.0),
        _ => duration(text),
    }
}

fn pixels(text: &str) -> Result<[f64; 2], String> {
    let words = text.split_once(',');
    let numbers = words.and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
    let pair = numbers.filter(|[x, y]: &[f64; 2]| x.is_finite() && y.is_finite());
    pair.ok_or_else(|| "must be X,Y in pixels, such as 120.5,80".to_owned())
}

fn pole(text: &str) -> Result<ImagePole, String> {
    match pixels(text) {
        Ok(at) => Ok(ImagePole::At(at)),
        Err(why) if text.contains(',') => Err(format!("{why}, or a body part")),
        Err(_) => Ok(ImagePole::Part(text.to_owned())),
    }
}

fn yes_or_no(text: &str) -> Result<bool, String> {
    match text {
        "yes" => Ok(true),
        "no" => Ok(false),
        _ => Err("must be yes or no".to_owned()),
    }
}

/// Returns the command-line option of a field of [`TrackingOptions`], whose name may end in its unit.
fn flag(option: &str) -> String {
    let units = ["_px", "_s"];
    let stem = units.iter().find_map(|unit| option.strip_suffix(unit));
    let stem = stem.or_else(|| option.strip_suffix("_mm"));
    format!("--{}", stem.unwrap_or(option).replace('_', "-"))
}

/// Returns notes or warnings with the command-line options in place of the names of [`TrackingOptions`], which are in backticks.
fn with_flags(texts: &[String]) -> Vec<String> {
    let replaced = |text: String, option| text.replace(&format!("`{option}`"), &flag(option));
    texts
        .iter()
        .map(|text| TrackingOptions::NAMES.into_iter().fold(text.clone(), replaced))
        .collect()
}

impl From<TrackingError> for Failure {
    fn from(why: TrackingError) -> Self {
        match why {
            TrackingError::Option { option, value, must } => {
                Self::Input(format!("{} {value}: {must}", flag(option)))
            }
            why => Self::Input(why.to_string()),
        }
    }
}

impl ImportArgs {
    fn options(&self) -> TrackingOptions {
        let mut options = TrackingOptions::new(self.mm_per_pixel, self.fps.unwrap_or(1.0));
        options.format = self.format;
        options.whisker = self.whisker;
        options.points.clone_from(&self.points);
        options.likelihood = self.likelihood;
        options.follicle_px = self.follicle;
        options.curvature_at_mm = self.curvature_at;
        options.fit_to_mm = self.fit_to;
        options.degree = self.degree.map(|degree| degree as usize);
        options.mirror = self.mirror;
        options.face_axis = self.face_axis;
        options.pole.clone_from(&self.pole);
        options.contact_within_mm = self.contact_within;
        options.taper = self.taper;
        options.zero_s = self.zero;
        options
    }
}

pub fn run(args: &ImportArgs, files: &mut Files) -> Result<(), Failure> {
    files.inputs("FILE", &args.files)?;
    let output = files.output("--output", &args.output)?;
    let tracking = Tracking::read(&args.files, &args.options(), &AtomicBool::new(false))?;
    let shape = args.shape.map(|frame| tracking.shape(frame)).transpose()?;
    notes(with_flags(&tracking.notes));
    warnings(with_flags(&tracking.warnings));
    match shape {
        Some(points) => write(output, TrackedPoint::COLUMNS, points),
        None if args.detachments => {
            if tracking.detachments.is_empty() {
                message(
                    "warning: no contact with a first touch and an end in the film has the pole on the other side of the whisker afterwards",
                );
            }
            write(output, TrackedDetachment::COLUMNS, tracking.detachments)
        }
        None => write(output, TrackedFrame::COLUMNS, tracking.frames),
    }
}

/// Writes the whole table, and prints the name of a regular file.
fn write<R: Serialize>(output: Output, columns: Columns, rows: Vec<R>) -> Result<(), Failure> {
    if let Some(path) = write_table(Some(OutputTable::new(output)), columns, rows)? {
        writeln!(StandardOutput::open(), "{}", path.display())?;
    }
    Ok(())
}
