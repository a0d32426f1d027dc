//! Command `whiskmap force`.

use super::arguments::{column_help, named, span};
use super::data::ColumnArgs;
use super::failure::{Failure, message, notes, warnings};
use super::files::Files;
use super::marks::{STRAIN_MARKS, marked};
use super::outputs::OutputArgs;
use super::pole::WhiskerArgs;
use clap::Args;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use whiskmap::force::{
    self, BaseAxis, CurvatureFrames, ForceMethod, ForceOptions, FrameForce, forces_until,
};
use whiskmap::render::forces as chart;
use whiskmap::yields::StrainMark;

const EXAMPLES: &str = "\
Examples:
  whiskmap force scenes/cone.toml --frames scenes/frames.csv --plot force.svg
  whiskmap force scenes/cone.toml --frames scenes/frames.csv --model --csv force.csv

FILE has the columns time_s, curvature_per_mm, at_arc_length_mm, contact_x_mm and contact_y_mm, in the frame of the base, whose \
first axis is --axis. Frames without contact leave the cells of the contact empty, or have 0 in a column contact, which has 1 \
in the others. Other numbers may be missing: an empty cell, or NaN. Without --model, the column \
contact_angle_deg has the angle of the whisker's tangent at the contact; at_x_mm and at_y_mm are the position of the measured \
point, which is otherwise that of the resting whisker.

The moment at the measured point is the bending stiffness there times the change of curvature. The force is this moment over the \
lever of the contact, normal to the whisker. With --model, it is that of the stable state of the full model that has this curvature \
at this distance of the contact from the base.

With --baseline or a column contact, the change of curvature is that from the mean of the frames without contact, and their scatter \
gives a standard deviation of each force. The scene's [uncertainty] may give curvature_sd_per_mm, contact_sd_mm and angle_sd_deg.";

const AXIS_HELP: [&str; 2] =
    ["Tangent of the bent whisker at its base", "Axis of the follicle, which a push turns"];

#[derive(Debug, Args)]
#[command(
    after_help = EXAMPLES,
    after_long_help = column_help(EXAMPLES, &[("Columns", FrameForce::COLUMNS), STRAIN_MARKS])
)]
pub struct ForceArgs {
    #[command(flatten)]
    whisker: WhiskerArgs,
    /// CSV file of the curvature over time; - is standard input
    #[arg(long, value_name = "FILE", group = "table")]
    frames: PathBuf,
    #[command(flatten)]
    columns: ColumnArgs,
    /// Compute the state of the full model instead of the moment over the lever
    #[arg(long)]
    model: bool,
    /// First axis of the frame of the base, in FILE and in the table
    #[arg(long, default_value = "tangent", value_parser = named(BaseAxis::ALL, BaseAxis::name, AXIS_HELP))]
    axis: BaseAxis,
    /// Subtract the mean change of curvature in the frames of this time, which must be without contact
    #[arg(long, value_name = "FROM..TO", allow_hyphen_values = true, value_parser = span)]
    baseline: Option<[f64; 2]>,
    #[command(flatten)]
    outputs: OutputArgs,
}

pub fn run(args: &ForceArgs, files: &mut Files) -> Result<(), Failure> {
    files.inputs("--frames", [&args.frames])?;
    let (scene, whisker) = args.whisker.without_friction(files, "force")?;
    let method = match args.model {
        true => ForceMethod::Model,
        false => ForceMethod::Lever,
    };
    let read = args.columns.read(&args.frames, &CurvatureFrames::COLUMNS, |table| {
        CurvatureFrames::of(table, whisker.length_mm, method)
    })?;
    notes(&read.note);
    let baseline = read.baseline(&whisker, args.baseline)?;
    match &baseline {
        Some(baseline) => message(&baseline.note()),
        None if read.have_contacts && read.frames.iter().any(|frame| frame.contact.is_none()) => {
            message("no baseline: fewer than 2 frames without contact have a curvature");
        }
        None => {}
    }
    let mut outputs = args.outputs.open(files)?;
    let options = ForceOptions {
        baseline,
        deviations: scene
            .uncertainty
            .as_ref()
            .map(|deviations| deviations.frames)
            .unwrap_or_default(),
        axis: args.axis,
        ..ForceOptions::new(method)
    };
    let frames = &read.frames;
    let found = forces_until(&whisker, &scene.pole, frames, &options, &AtomicBool::new(false));
    warnings(force::warnings(&whisker, &found));
    let marks = match method {
        ForceMethod::Model => StrainMark::of_rows(&whisker, &scene.pole, &found),
        ForceMethod::Lever => None,
    };
    outputs.rows(marked(&found, marks))?;
    outputs.finish_chart(|| chart(&scene.title, &found), [])
}
