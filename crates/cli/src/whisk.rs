//! Command `whiskmap whisk`.

use super::arguments::{column_help, duration, named};
use super::course::{CourseArgs, counts, energy};
use super::data::note_follicle;
use super::failure::{Failure, message, warnings};
use super::files::Files;
use super::marks::{STRAIN_MARKS, marked};
use super::outputs::{OutputArgs, write_table};
use super::pole::{self, PoleArgs, refuse, title};
use clap::{ArgGroup, Args};
use std::path::PathBuf;
use whiskmap::render::courses;
use whiskmap::whisk::{
    self, CourseStart, Whisk, WhiskError, WhiskEvent, WhiskOptions, WhiskSample,
};
use whiskmap::yields::StrainMark;

const EXAMPLES: &str = "\
Examples:
  whiskmap whisk scenes/cone.toml --distance 15.66 --sine 25deg,10,0.2 --csv whisk.csv --plot whisk.svg
  whiskmap whisk scenes/cone.toml --distance 15.66 --angles scenes/whisking.csv --events events.csv --plot whisk.svg

The angle of the base is 0 where the resting whisker first touches the pole on CB, and grows with the push there. A whisker that \
detaches swings to the other side of the pole, and touches it there on the way back. The course is quasi-static: inertia is left \
out. Between samples the angle changes along straight lines, on which events are exact. A course begins without contact unless --start \
is contact. A first angle beyond first touch needs --start: the whisker may be free past the pole, or in contact.

An angle of --angles may be missing: an empty cell, or NaN. Its sample has no state. After such a gap the course is undecided until \
only one state is possible, unless --bridge continues it. After a gap at the beginning, --start decides.";

const START_HELP: [&str; 2] = [
    "The whisker is free. At an angle beyond first touch, it has passed the pole",
    "The pole bends the whisker, as after a push from first touch to the first angle: on CB if that side holds it, otherwise on CF",
];

#[derive(Debug, Args)]
#[command(
    group(ArgGroup::new("course").required(true).args(["angles", "sine"])),
    after_help = EXAMPLES,
    after_long_help = column_help(EXAMPLES, &[("Columns", WhiskSample::COLUMNS), STRAIN_MARKS, ("Columns of --events", WhiskEvent::COLUMNS)])
)]
pub struct WhiskArgs {
    #[command(flatten)]
    pole: PoleArgs,
    #[command(flatten)]
    course: CourseArgs,
    /// State of the whisker at the first angle
    #[arg(long, value_name = "STATE", value_parser = named(CourseStart::ALL, CourseStart::name, START_HELP))]
    start: Option<CourseStart>,
    /// Continue the course along a straight line across gaps of missing angles, if the angles around a gap are at most TIME apart
    #[arg(long, value_name = "TIME", value_parser = duration, conflicts_with = "sine")]
    bridge: Option<f64>,
    /// Write touches, releases, slip-offs, pull-offs and snaps to FILE, as CSV
    #[arg(long, value_name = "FILE")]
    events: Option<PathBuf>,
    #[command(flatten)]
    outputs: OutputArgs,
}

pub fn run(args: &WhiskArgs, files: &mut Files) -> Result<(), Failure> {
    let distance = args.pole.distance;
    args.course.declare(files)?;
    let (scene, whisker) = pole::read(files, &args.pole.whisker, "whisk", &[distance])?;
    let course = args.course.course()?;
    if args.course.is_measured() {
        note_follicle(&scene);
    }
    let mut outputs = args.outputs.open(files)?;
    let events = args.outputs.table(files, "--events", args.events.as_deref())?;
    let mut options = WhiskOptions::default();
    options.start = args.start;
    options.curvature_at_mm = args.course.curvature_at;
    options.bridge_s = args.bridge.unwrap_or_default();
    let found = whisk::whisk_with(&whisker, &scene.pole, distance, &course, &options);
    let found = found.map_err(|why| match why {
        WhiskError::Pole(why) => refuse(distance, why),
        WhiskError::Unresolved(_) => Failure::Course(why),
        WhiskError::CurvatureAt(why) => Failure::Input(format!("--curvature-at: {why}")),
        why => Failure::Input(format!("{}: {why}", args.course.source())),
    })?;
    let marks = StrainMark::of_rows(&whisker, &scene.pole, &found.samples);
    outputs.rows(marked(&found.samples, marks))?;
    let event_file = write_table(events, WhiskEvent::COLUMNS, &found.events)?;
    summarise(&found);
    outputs.finish_chart(|| courses(&title(&scene, &[distance]), &found), event_file)
}

/// Prints the number of events of each kind, the energies that detachments lose and that friction dissipates, and warnings.
fn summarise(whisk: &Whisk) {
    let events = whisk.events.iter().map(|event| event.event);
    let [touches, releases, slips, pulls, snaps] = counts(events);
    let dissipated = whisk.dissipated_nj();
    let lost = energy(whisk.lost_nj());
    message(&format!(
        "touches {touches}, releases {releases}, slip-offs {slips}, pull-offs {pulls}; detachments lose {lost}"
    ));
    if dissipated != 0.0 {
        let dissipated = energy(dissipated);
        message(&format!("snaps {snaps}; friction dissipates {dissipated}"));
    }
    warnings(whisk.warnings());
}
