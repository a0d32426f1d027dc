//! Command `whiskmap design`.

mod messages;
mod options;
mod solutions;

use super::arguments::{completed, side, variable_names};
use super::failure::Failure;
use super::files::Files;
use super::outputs::{PictureFile, PlotArgs, write};
use super::pole::{self, WhiskerArgs, title};
use super::progress::Progress;
use clap::Args;
use messages::{print_warnings, refused, undetermined, unreached, unreached_together};
use options::{Distance, GoalArgs, distance, variable};
use solutions::{SOLUTION_DIGITS, Solutions};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use whiskmap::Side;
use whiskmap::design::{
    Design, DesignTarget, DesignVariable, DesignVaried, design_until, designs_until, ends_between,
};
use whiskmap::render::{Chart, designs as chart};
use whiskmap::scene::{Scene, digits, rounded};
use whiskmap::sensitivity::Variable;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap design scenes/robot.toml --distance 60 --side cb --slip-off 30deg --for taper --plot taper.svg
  whiskmap design scenes/robot.toml --distance 60 --slip-off -50deg --for parabola_per_mm
  whiskmap design scenes/robot.toml --distance 60 --side cb --max-force 60mN --for base_radius_um -o better.toml
  whiskmap design scenes/robot.toml --distance 70% --slip-off 30deg --max-moment 20mNm --for base_radius_um,taper=0.5..1
  whiskmap design scenes/robot.toml --slip-off 30deg --for distance_mm
  whiskmap design scenes/cylinder.toml --distance 19 --pull-off 40deg --for length_mm

Each line is one value with which a push reaches the target; with several parameters, a header and a line of values for each solution. \
There must be as many targets as parameters. --max-force, --max-moment and --max-strain are the largest values of \
the push, from first touch until the whisker detaches in either way: of the contact force, the moment at the base, and the \
bending strain at the surface of the whisker.

For one push angle, values have 10 significant digits and a relative error of 1e-9; where two solutions nearly merge, that of the \
root of the rounding error. Other values have 6 digits. The search covers the whole range that the scene accepts, or the limits \
NAME=FROM..TO, with 128 values; in a wide range, half of them are spaced logarithmically. A pair of solutions between two of these \
values is found if the target's quantity turns back only once there. Several parameters have about 600 places, from which Newton's method \
starts. Without any solution the exit code is 1, and standard error gives what is possible; where every value in a range reaches \
the target, it gives the range. The scene's grid is ignored.")]
pub struct DesignArgs {
    #[command(flatten)]
    whisker: WhiskerArgs,
    /// Distance from the base to the contact at first touch, in mm or with a unit, such as 1.5cm, or in parts of the length, such as 70%
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = distance)]
    distance: Option<Distance>,
    /// Side of the whisker that the pole is on [default: by the sign of the angle]
    #[arg(long, value_parser = side())]
    side: Option<Side>,
    #[command(flatten)]
    goal: GoalArgs,
    /// Parameters of the scene to vary, separated by commas, or distance_mm; NAME=FROM..TO keeps within limits
    #[arg(long = "for", value_name = "NAMES", required = true, value_delimiter = ',', value_parser = completed(variable, variable_names(&["distance_mm"])), hide_possible_values = true)]
    varied: Vec<DesignVariable>,
    /// Keep the taper where a radius varies, instead of the radius at the tip
    #[arg(long, value_name = "taper", value_parser = ["taper"])]
    keep: Option<String>,
    /// Write the scene with the values to BETTER.toml; of several solutions, the one nearest to the scene's own; - is standard output
    #[arg(short, long, value_name = "BETTER.toml")]
    output: Option<PathBuf>,
    #[command(flatten)]
    picture: PlotArgs,
}

pub fn run(args: &DesignArgs, files: &mut Files) -> Result<(), Failure> {
    let path = &args.whisker.scene;
    let scene = args.whisker.read(files, "design")?;
    let (varied, distance_mm) = args.varied(&scene)?;
    pole::check_distances(&scene, &[distance_mm])?;
    let asked = args.targets(distance_mm)?;
    args.check(&varied, &asked)?;
    let better = match &args.output {
        Some(path) => Some(files.output("--output", path)?),
        None => None,
    };
    let picture = args.picture.open(files)?;
    let solutions = match &asked[..] {
        [one] => {
            let found = with_progress(|on_progress, never| {
                design_until(&scene, varied.clone(), &one.target, on_progress, never)
            });
            let found = found.map_err(|why| refused(path, why))?;
            if let Some(picture) = picture {
                plot(path, &scene, &varied, (&one.target, &found), picture)?;
            }
            let variable = varied.variables[0].variable;
            if !found.spans.is_empty() {
                let why = undetermined(variable, variable.value(&scene), one, &found);
                return Err(Failure::NoValue(why));
            }
            if found.values.is_empty() {
                return Err(Failure::NoValue(unreached(variable, one, &found)));
            }
            let values = found.values.iter().map(|value| vec![*value]);
            let digits = one.target.goal.digits();
            Solutions::new(&scene, &varied, values.collect(), digits)
        }
        several => {
            let targets: Vec<DesignTarget> = several.iter().map(|asked| asked.target).collect();
            let found = with_progress(|on_progress, never| {
                designs_until(&scene, &varied, &targets, on_progress, never)
            });
            let found = found.map_err(|why| refused(path, why))?;
            if found.solutions.is_empty() || found.is_undetermined {
                let why = unreached_together(&varied.variables, several, &found);
                return Err(Failure::NoValue(why));
            }
            Solutions::new(&scene, &varied, found.solutions, SOLUTION_DIGITS)
        }
    };
    let side = asked[0].target.side;
    print_warnings(&scene, &varied, (side, distance_mm), &solutions.values);
    if let Some(output) = better {
        let is_stdout = output.is_stdout();
        write(output, solutions.nearest_scene()?.as_bytes())?;
        if is_stdout {
            return Ok(());
        }
    }
    solutions.print()?;
    Ok(())
}

/// Runs a search with the function that it calls for its progress, and a flag that never cancels it. The progress is shown meanwhile.
fn with_progress<T>(search: impl FnOnce(&(dyn Fn(usize) + Sync), &AtomicBool) -> T) -> T {
    let count = Progress::counting("pushes");
    let found = search(&|pushes| count.inc(pushes), &AtomicBool::new(false));
    count.finish();
    found
}

/// Draws the ends of pushes around the values `found` for a `target`.
fn plot(
    path: &Path,
    scene: &Scene,
    varied: &DesignVaried,
    (target, found): (&DesignTarget, &Design),
    picture: PictureFile,
) -> Result<(), Failure> {
    let range = found.shown();
    let ends = with_progress(|on_progress, _| {
        ends_between(scene, varied.clone(), target, range, on_progress)
    });
    let near = Design { range, ends: ends.map_err(|why| refused(path, why))?, ..found.clone() };
    let chart = chart(varied.variables[0].variable, target, &near);
    let title = heading(scene, varied, target.distance_mm);
    picture.chart(&Chart::single(title, chart))?;
    Ok(())
}

/// Returns the title of a chart of the scene, with the distance of the pole unless it varies.
fn heading(scene: &Scene, varied: &DesignVaried, distance_mm: f64) -> String {
    match varied.distance_to_length {
        _ if distance_is_varied(varied) => scene.title.clone(),
        Some(part) => format!(
            "{}, touched at {} % of its length",
            scene.title,
            digits(rounded(100.0 * part, 6))
        ),
        None => title(scene, &[distance_mm]),
    }
}

fn distance_is_varied(varied: &DesignVaried) -> bool {
    let mut all = varied.variables.iter();
    all.any(|variable| variable.variable == Variable::DistanceMm)
}
