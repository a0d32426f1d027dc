//! Command `whiskmap sensitivity`.

use super::arguments::{column_help, length};
use super::failure::{Failure, check_resolved};
use super::files::Files;
use super::marks::{MARKS, Marked};
use super::outputs::OutputArgs;
use super::pole::{self, WhiskerArgs, title};
use clap::Args;
use whiskmap::render::sensitivities;
use whiskmap::sensitivity::{VariableEffect, effects};
use whiskmap::trace::DetachmentKind;
use whiskmap::yields::YieldMark;

const EXAMPLES: &str = "\
Examples:
  whiskmap sensitivity scenes/cone.toml --distance 15.66
  whiskmap sensitivity scenes/cone.toml --distance 15.66 --plot sensitivity.svg
  whiskmap sensitivity scenes/measured.toml --csv sensitivity.csv --plot sensitivity.png

Derivatives are exact: no differences are taken. Each variable varies alone. The radius at the base varies at a fixed radius at the \
tip, the taper at a fixed radius at the base. The plot shows changes for +1 % of each variable, the largest at the top; \
variables of value 0 or without an effect are left out.";

#[derive(Debug, Args)]
#[command(
    after_help = EXAMPLES,
    after_long_help = column_help(EXAMPLES, &[("Columns", VariableEffect::COLUMNS), MARKS])
)]
pub struct SensitivityArgs {
    #[command(flatten)]
    whisker: WhiskerArgs,
    /// Distance from the base to the contact at first touch, in mm or with a unit, such as 1.5cm [default: the middle one of the scene]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = length)]
    distance: Option<f64>,
    #[command(flatten)]
    outputs: OutputArgs,
}

pub fn run(args: &SensitivityArgs, files: &mut Files) -> Result<(), Failure> {
    let distance: Vec<f64> = args.distance.into_iter().collect();
    let (scene, whisker) = pole::read(files, &args.whisker, "sensitivity", &distance)?;
    let distances = &scene.grid.distance_mm;
    let distance = args.distance.unwrap_or(distances[distances.len() / 2]);
    let mut outputs = args.outputs.open(files)?;
    let rows = effects(&scene, distance);
    let marked = rows.iter().map(|row| Marked(row, YieldMark::new(&whisker, row.max_strain)));
    outputs.rows(marked)?;
    outputs.finish(title(&scene, &[distance]), || sensitivities(&rows))?;
    let unresolved = rows.iter().filter(|row| row.kind == DetachmentKind::Unresolved);
    check_resolved(unresolved.count() as u64, rows.len() as u64, "rows", "the column `kind`")
}
