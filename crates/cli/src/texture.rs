//! Command `whiskmap texture`.

use super::arguments::column_help;
use super::course::{CourseArgs, counts, energy};
use super::failure::{Failure, message, warnings};
use super::files::Files;
use super::marks::{STRAIN_MARKS, marked};
use super::outputs::{OutputArgs, write_table};
use super::pole::WhiskerArgs;
use clap::Args;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use whiskmap::render::textures;
use whiskmap::texture::{
    AsperityStay, Texture, TextureError, TextureEvent, TexturePhase, TextureSample, TipBin,
    texture_until,
};
use whiskmap::yields::StrainMark;

const EXAMPLES: &str = "\
Examples:
  whiskmap texture scenes/texture_cone.toml --csv texture.csv --plot texture.svg
  whiskmap texture scenes/texture_hair.toml --sine 15deg,0.2,5 --dwells dwells.csv --plot hair.svg

The scene's table [surface] puts asperities, small poles without friction, on a line. The angle of the base is 0 where the chord of \
the resting whisker is normal to that line. A whisker that detaches from an asperity comes to rest against the first asperity ahead \
that holds it at this angle of the base, else it is free. The paper has no model for this. This one leaves out inertia and friction, \
and lets one asperity at a time bend the whisker, which passes between them.";

#[derive(Debug, Args)]
#[command(
    mut_arg("sine", |sine| sine.default_value("15deg,0.2,15")),
    after_help = EXAMPLES,
    after_long_help = column_help(EXAMPLES, &[
        ("Columns", TextureSample::COLUMNS),
        STRAIN_MARKS,
        ("Columns of --events", TextureEvent::COLUMNS),
        ("Columns of --dwells", AsperityStay::COLUMNS),
        ("Columns of --histogram", TipBin::COLUMNS),
    ])
)]
pub struct TextureArgs {
    #[command(flatten)]
    whisker: WhiskerArgs,
    #[command(flatten)]
    course: CourseArgs,
    /// Write touches, releases, slip-offs and pull-offs to FILE, as CSV
    #[arg(long, value_name = "FILE")]
    events: Option<PathBuf>,
    /// Write the stays on asperities with their dwell times to FILE, as CSV
    #[arg(long, value_name = "FILE")]
    dwells: Option<PathBuf>,
    /// Write the histogram of the position of the tip to FILE, as CSV
    #[arg(long, value_name = "FILE")]
    histogram: Option<PathBuf>,
    #[command(flatten)]
    outputs: OutputArgs,
}

pub fn run(args: &TextureArgs, files: &mut Files) -> Result<(), Failure> {
    args.course.declare(files)?;
    let scene = args.whisker.read(files, "texture")?;
    let surface = scene.surface.ok_or_else(|| {
        let path = args.whisker.scene.display();
        let keys = "distance_mm, spacing_um, asperity_radius_um and length_mm";
        Failure::Input(format!("{path}: the scene has no [surface]: add that table, with {keys}"))
    })?;
    let friction = scene.pole.friction;
    if friction != 0.0 {
        return Err(Failure::Input(format!(
            "contact.friction = {friction}: must be 0, because asperities have no friction in this model"
        )));
    }
    let course = args.course.course()?;
    let mut outputs = args.outputs.open(files)?;
    let mut table =
        |option, path: &Option<PathBuf>| args.outputs.table(files, option, path.as_deref());
    let events = table("--events", &args.events)?;
    let dwells = table("--dwells", &args.dwells)?;
    let histogram = table("--histogram", &args.histogram)?;
    let at_mm = args.course.curvature_at;
    let found = texture_until(&scene.whisker, &surface, &course, at_mm, &AtomicBool::new(false))
        .map_err(|why| match why {
            TextureError::Unresolved { .. } => Failure::Texture(why),
            TextureError::CurvatureAt(why) => Failure::Input(format!("--curvature-at: {why}")),
            TextureError::Blocked { .. } | TextureError::Surface(_) => {
                Failure::Input(format!("{}: {why}", args.whisker.scene.display()))
            }
            why => Failure::Input(format!("{}: {why}", args.course.source())),
        })?;
    let marks = StrainMark::of_rows(&scene.whisker, &surface.asperity(), &found.samples);
    outputs.rows(marked(&found.samples, marks))?;
    let paths = [
        write_table(events, TextureEvent::COLUMNS, &found.events)?,
        write_table(dwells, AsperityStay::COLUMNS, found.stays())?,
        write_table(histogram, TipBin::COLUMNS, found.tip_histogram())?,
    ];
    summarise(&found);
    outputs.finish_chart(|| textures(&scene.title, &found), paths.into_iter().flatten())
}

/// Prints the number of events, the energy that detachments lose, and the part of the samples in each phase.
fn summarise(texture: &Texture) {
    let events = texture.events.iter().map(|event| event.event);
    let [touches, releases, slips, pulls, _] = counts(events);
    let lost = energy(texture.lost_nj());
    let reached = texture.reached;
    message(&format!(
        "{reached} asperities within reach; touches {touches}, releases {releases}, slip-offs {slips}, pull-offs {pulls}; \
         detachments lose {lost}"
    ));
    let all = texture.samples.len();
    let phase = |phase| {
        let samples = texture.samples.iter();
        samples.filter(|sample| sample.phase == phase).count()
    };
    let [stuck, slipping, free] =
        [TexturePhase::Stuck, TexturePhase::Slipping, TexturePhase::Free].map(phase);
    message(&format!("of {all} samples, {stuck} are stuck, {slipping} slipping, {free} free"));
    warnings(texture.warning());
}
