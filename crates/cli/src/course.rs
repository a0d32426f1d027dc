//! Arguments of commands over time: the course of the angle of the base.

use super::arguments::{angle, length};
use super::data::ColumnArgs;
use super::failure::{Failure, notes};
use super::files::{Files, STDOUT};
use clap::Args;
use std::path::{Path, PathBuf};
use whiskmap::scene::{digits, rounded};
use whiskmap::whisk::{AngleCourse, WhiskEventKind};

#[derive(Debug, Args)]
pub struct CourseArgs {
    /// CSV file of the angle over time, with the columns time_s and angle_deg; - is standard input
    #[arg(long, value_name = "FILE", group = "table", conflicts_with = "sine")]
    angles: Option<PathBuf>,
    #[command(flatten)]
    columns: ColumnArgs,
    /// Sine of the angle: amplitude in degrees or with a unit, frequency in Hz, duration in s
    #[arg(long, value_name = "AMPLITUDE,HZ,SECONDS", allow_hyphen_values = true, value_parser = sine)]
    sine: Option<Sine>,
    /// Number of samples per second of --sine
    #[arg(long, value_name = "HZ", default_value = "1000", value_parser = positive, conflicts_with = "angles")]
    rate: f64,
    /// Give samples the curvature at this arclength from the base, in mm or with a unit
    #[arg(long, value_name = "MM", value_parser = length)]
    pub curvature_at: Option<f64>,
}

/// Amplitude in degrees, frequency in Hz and duration in s of a sine.
type Sine = [f64; 3];

fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    let number = number.filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "must be a positive number".to_owned())
}

fn sine(text: &str) -> Result<Sine, String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let [amplitude, frequency, seconds] = parts[..] else {
        return Err("must be amplitude, frequency and duration, such as 25deg,10,0.2".to_owned());
    };
    let amplitude = angle(amplitude)?;
    if !(amplitude.abs() <= 360.0 && amplitude != 0.0) {
        return Err("the amplitude must be between -360deg and 360deg, and not 0".to_owned());
    }
    let named = |name: &str, text| positive(text).map_err(|why| format!("{name} {text}: {why}"));
    Ok([amplitude, named("frequency in Hz", frequency)?, named("duration in s", seconds)?])
}

impl CourseArgs {
    /// Declares the file of the course, if there is one.
    pub fn declare(&self, files: &mut Files) -> Result<(), Failure> {
        files.inputs("--angles", &self.angles)
    }

    /// Returns true if the course is in a file.
    pub const fn is_measured(&self) -> bool {
        self.angles.is_some()
    }

    /// Returns the course of the base's angle: a sine, or the samples of the CSV file that the options name.
    pub fn course(&self) -> Result<AngleCourse, Failure> {
        if let (None, Some([amplitude, frequency, seconds])) = (&self.angles, self.sine) {
            let sine = AngleCourse::sine(amplitude, frequency, seconds, self.rate);
            return sine.map_err(|why| Failure::Input(format!("{}: {why}", self.source())));
        }
        let path = self.angles.as_deref().unwrap_or(Path::new(STDOUT));
        let course = self.columns.read(path, &AngleCourse::COLUMNS, AngleCourse::of)?;
        notes(&course.note);
        Ok(course)
    }

    /// Returns the option that gives the course, with its value.
    pub fn source(&self) -> String {
        match (&self.angles, self.sine) {
            (Some(path), _) => format!("--angles {}", path.display()),
            (_, Some(sine)) => format!("--sine {}", sine.map(digits).join(",")),
            _ => String::new(),
        }
    }
}

/// Returns the text of an energy in nJ; NaN means an unknown energy.
pub fn energy(nj: f64) -> String {
    match nj.is_nan() {
        true => "an unknown energy".to_owned(),
        false => format!("{} nJ", digits(rounded(nj, 6))),
    }
}

/// Returns the number of touches, releases, slip-offs, pull-offs and snaps among `events`, in this order.
pub fn counts(events: impl Iterator<Item = WhiskEventKind> + Clone) -> [usize; 5] {
    use WhiskEventKind::{PullOff, Release, SlipOff, Snap, Touch};
    let count = |kind| events.clone().filter(|event| *event == kind).count();
    [Touch, Release, SlipOff, PullOff, Snap].map(count)
}
