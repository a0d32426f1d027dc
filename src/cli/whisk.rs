//! Command `whiskmap whisk`.

use super::arguments::{angle, column_help};
use super::failure::{Failure, message};
use super::files::{Files, STDOUT};
use super::outputs::OutputArgs;
use super::pole::{self, PoleArgs, refuse, title};
use clap::Args;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use whiskmap::render::courses;
use whiskmap::scene::{digits, rounded};
use whiskmap::whisk::{
    self, AngleCourse, Whisk, WhiskError, WhiskEvent, WhiskEventKind, WhiskRegime, WhiskSample,
};

const EXAMPLES: &str = "\
Examples:
  whiskmap whisk scenes/cone.toml --distance 15.66 --sine 25deg,10,0.2 --csv whisk.csv --plot whisk.svg
  whiskmap whisk scenes/cone.toml --distance 15.66 --angles scenes/whisking.csv --events events.csv --plot whisk.svg

The angle of the base is 0 where the resting whisker first touches the pole on CB, and grows with the push there. A whisker that \
detaches swings to the other side of the pole, and touches it there on the way back. The course is quasi-static: inertia is left \
out. Between samples the angle changes along straight lines, on which events are exact. A course must begin without contact.";

#[derive(Debug, Args)]
#[command(
    after_help = EXAMPLES,
    after_long_help = column_help(EXAMPLES, &[("Columns", WhiskSample::COLUMNS), ("Columns of --events", WhiskEvent::COLUMNS)])
)]
pub struct WhiskArgs {
    #[command(flatten)]
    pole: PoleArgs,
    #[command(flatten)]
    course: CourseArgs,
    /// Number of samples per second of --sine
    #[arg(long, value_name = "HZ", default_value = "1000", value_parser = positive, conflicts_with = "angles")]
    rate: f64,
    /// Write touches, releases, slip-offs, pull-offs and snaps to FILE, as CSV
    #[arg(long, value_name = "FILE")]
    events: Option<PathBuf>,
    #[command(flatten)]
    outputs: OutputArgs,
}

#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct CourseArgs {
    /// CSV file of the angle over time, with the columns time_s and angle_deg; - is standard input
    #[arg(long, value_name = "FILE")]
    angles: Option<PathBuf>,
    /// Sine of the angle: amplitude in degrees or with a unit, frequency in Hz, duration in s
    #[arg(long, value_name = "AMPLITUDE,HZ,SECONDS", allow_hyphen_values = true, value_parser = sine)]
    sine: Option<Sine>,
}

/// Amplitude in degrees, frequency in Hz and duration in s of a sine.
type Sine = [f64; 3];

fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    let number = number.filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "must be a positive number".to_owned())
}

fn sine(text: &str) -> Result<Sine, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let [amplitude, frequency, seconds] = parts[..] else {
        return Err("must be amplitude, frequency and duration, such as 25deg,10,0.2".to_owned());
    };
    let amplitude = angle(amplitude)?;
    if !(amplitude.abs() <= 360.0 && amplitude != 0.0) {
        return Err("the amplitude must be between -360deg and 360deg, and not 0".to_owned());
    }
    let named = |name: &str, text| positive(text).map_err(|why| format!("{name} {text}: {why}"));
    Ok([
        amplitude,
        named("frequency in Hz", frequency)?,
        named("duration in s", seconds)?,
    ])
}

pub fn run(args: &WhiskArgs, files: &mut Files) -> Result<(), Failure> {
    let distance = args.pole.distance;
    if args.course.angles.as_deref() == Some(Path::new(STDOUT))
        && args.pole.scene == Path::new(STDOUT)
    {
        let why = "--angles -: standard input is the scene, and can be read once; name a file";
        return Err(Failure::Input(why.to_owned()));
    }
    let (scene, whisker) = pole::read(files, &args.pole.scene, "whisk", &[distance])?;
    let course = args.course(files)?;
    let mut outputs = args.outputs.open(files)?;
    let events = args.events.as_deref();
    let events = events.map(|path| args.outputs.table(files, "--events", path));
    let events = events.transpose()?;
    let found =
        whisk::whisk(&whisker, &scene.pole, distance, &course).map_err(|why| match why {
            WhiskError::Pole(why) => refuse(distance, why),
            WhiskError::Unresolved(_) => Failure::Course(why),
            why => Failure::Input(format!("{}: {why}", args.source())),
        })?;
    outputs.rows(&found.samples)?;
    let events = events.map(|mut table| {
        table.rows(&found.events)?;
        table.finish()
    });
    let events = events.transpose()?.flatten();
    summarise(&found);
    outputs.finish_chart(|| courses(&title(&scene, &[distance]), &found))?;
    if let Some(path) = events {
        writeln!(io::stdout(), "{}", path.display())?;
    }
    Ok(())
}

impl WhiskArgs {
    fn course(&self, files: &mut Files) -> Result<AngleCourse, Failure> {
        if let Some([amplitude, frequency, seconds]) = self.course.sine {
            let sine = AngleCourse::sine(amplitude, frequency, seconds, self.rate);
            return sine.map_err(|why| Failure::Input(format!("{}: {why}", self.source())));
        }
        let path = self.course.angles.as_deref().unwrap_or(Path::new(STDOUT));
        let course = AngleCourse::read(path)?;
        files.input(path);
        if let Some(note) = &course.note {
            message(&format!("note: {note}"));
        }
        Ok(course)
    }

    /// Returns the option that gives the course, with its value.
    fn source(&self) -> String {
        match (&self.course.angles, self.course.sine) {
            (Some(path), _) => format!("--angles {}", path.display()),
            (_, Some(sine)) => format!("--sine {}", sine.map(digits).join(",")),
            _ => String::new(),
        }
    }
}

/// Prints the number of events of each kind, and the energies that detachments lose and that friction dissipates, and warns of samples without a state.
fn summarise(whisk: &Whisk) {
    let count = |kind| {
        whisk
            .events
            .iter()
            .filter(|event| event.event == kind)
            .count()
    };
    let [touches, releases, slips, pulls, snaps] = [
        WhiskEventKind::Touch,
        WhiskEventKind::Release,
        WhiskEventKind::SlipOff,
        WhiskEventKind::PullOff,
        WhiskEventKind::Snap,
    ]
    .map(&count);
    let [lost, taken] = [whisk.lost_nj(), whisk.dissipated_nj()];
    let [lost, dissipated] = [lost, taken].map(|energy| digits(rounded(energy, 6)));
    message(&format!(
        "touches {touches}, releases {releases}, slip-offs {slips}, pull-offs {pulls}; detachments lose {lost} nJ"
    ));
    if taken != 0.0 {
        message(&format!(
            "snaps {snaps}; friction dissipates {dissipated} nJ"
        ));
    }
    let spans = count(WhiskEventKind::Undecided);
    let undecided = whisk
        .samples
        .iter()
        .filter(|sample| sample.regime == WhiskRegime::Undecided);
    let undecided = undecided.count();
    if undecided > 0 || spans > 0 {
        let all = whisk.samples.len();
        message(&format!(
            "warning: {undecided} of {all} samples are undecided, for the reasons in the table; {spans} such spans begin"
        ));
    }
}
