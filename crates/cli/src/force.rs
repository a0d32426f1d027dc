//! Command `whiskmap force`.

use super::arguments::column_help;
use super::failure::{Failure, message};
use super::files::{Files, STDOUT};
use super::outputs::OutputArgs;
use super::pole::check_single;
use clap::Args;
use std::path::{Path, PathBuf};
use whiskmap::force::{self, CurvatureFrames, ForceMethod, FrameForce, forces};
use whiskmap::render::forces as chart;

const EXAMPLES: &str = "\
Examples:
  whiskmap force scenes/cone.toml --frames scenes/frames.csv --plot force.svg
  whiskmap force scenes/cone.toml --frames scenes/frames.csv --model --csv force.csv

FILE has the columns time_s, curvature_per_mm, at_arc_length_mm, contact_x_mm and contact_y_mm, in the frame of the base: the first \
axis is the base's tangent. Frames without contact leave the cells of the contact empty. Without --model, the column \
contact_angle_deg has the angle of the whisker's tangent at the contact; at_x_mm and at_y_mm are the position of the measured \
point, which is otherwise that of the resting whisker.

The moment at the measured point is the bending stiffness there times the change of curvature. The force is this moment over the \
lever of the contact, normal to the whisker. With --model, it is that of the stable state of the full model that has this curvature \
at this distance of the contact from the base.";

#[derive(Debug, Args)]
#[command(
    after_help = EXAMPLES,
    after_long_help = column_help(EXAMPLES, &[("Columns", FrameForce::COLUMNS)])
)]
pub struct ForceArgs {
    /// Scene file; - is standard input
    scene: PathBuf,
    /// CSV file of the curvature over time; - is standard input
    #[arg(long, value_name = "FILE")]
    frames: PathBuf,
    /// Compute the state of the full model instead of the moment over the lever
    #[arg(long)]
    model: bool,
    #[command(flatten)]
    outputs: OutputArgs,
}

pub fn run(args: &ForceArgs, files: &mut Files) -> Result<(), Failure> {
    if [&args.scene, &args.frames] == [Path::new(STDOUT); 2] {
        let why = "--frames -: standard input is the scene, and can be read once; name a file";
        return Err(Failure::Input(why.to_owned()));
    }
    let scene = files.scene(&args.scene)?;
    check_single(&scene, "force")?;
    let friction = scene.pole.friction;
    if friction != 0.0 {
        let why = format!(
            "contact.friction = {friction}: must be 0, because the force is taken as normal to the whisker"
        );
        return Err(Failure::Input(why));
    }
    let whisker = scene.first_whisker().whisker;
    let method = match args.model {
        true => ForceMethod::Model,
        false => ForceMethod::Lever,
    };
    let read = CurvatureFrames::read(&args.frames, whisker.length_mm, method)?;
    files.input(&args.frames);
    if let Some(note) = &read.note {
        message(&format!("note: {note}"));
    }
    let mut outputs = args.outputs.open(files)?;
    let found = forces(&whisker, &scene.pole, &read.frames, method);
    if let Some(warning) = force::warning(&found) {
        message(&format!("warning: {warning}"));
    }
    outputs.rows(&found)?;
    outputs.finish_chart(|| chart(&scene.title, &found), [])
}
