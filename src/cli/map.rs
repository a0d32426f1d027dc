//! `whiskmap map`.

use super::engine::{self, Choice, Shaders};
use super::failure::{Failure, say};
use super::progress;
use super::tolerance::Tolerance;
use crate::accuracy::{Accuracy, BOUNDED};
use crate::classify::{Regime, Status};
use crate::map::{self, Observer, Summary};
use crate::plan::Plan;
use crate::refine::{GOAL, TOLERANCE};
use crate::scene::Scene;
use crate::store::{Description, MapWriter, Panel};
use crate::{render, store};
use clap::Args;
use indicatif::ProgressBar;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Options of `map`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap map scenes/cone.toml
  whiskmap map scenes/morphology.toml -o /tmp --engine cpu --threads 1
  whiskmap map scenes/morphology.toml --tolerance 1e-3deg
  whiskmap map - < my_whisker.toml")]
pub struct Options {
    /// Scene file; - reads it from standard input
    scene: PathBuf,
    /// Folder for the files; it is made if it is missing
    #[arg(short, long, value_name = "DIR", default_value = "outputs")]
    output: PathBuf,
    /// What solves the cells
    #[arg(long, value_enum, default_value = "auto")]
    engine: Choice,
    /// Scalar of the shaders [default: f32]
    #[arg(long, value_enum)]
    precision: Option<Shaders>,
    /// Threads of the CPU [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    #[command(flatten)]
    tolerance: Tolerance,
    /// Write no picture
    #[arg(long)]
    no_png: bool,
}

/// Runs `map`.
pub fn run(options: &Options) -> Result<(), Failure> {
    let scene = Scene::read(&options.scene)?;
    let mut plan = Plan::new(&scene)?;
    let accuracy = options.tolerance.choose(&scene, &plan.sides)?;
    if let Some(accuracy) = &accuracy {
        plan.method.resolution = accuracy.resolution;
    }
    let (mut engine, why) = engine::open(options.engine, options.precision)?;
    let description = engine.describe();
    let file = options.output.join(format!("{}.exr", scene.name));
    let picture = (!options.no_png).then(|| file.with_extension("png"));
    writable(
        &options.output,
        [Some(&file), picture.as_ref()].into_iter().flatten(),
    )?;
    say(&format!(
        "engine: {} on {} ({why})",
        description.engine, description.adapter
    ));

    let start = Instant::now();
    let writer = MapWriter::create(
        &file,
        &Description {
            scene: &scene,
            engine: &description.engine,
            adapter: &description.adapter,
            tolerances: &tolerances(accuracy),
            status_names: &Status::ALL.map(|status| (status.code(), status.name())),
        },
    )
    .map_err(|error| Failure::Input(error.to_string()))?;
    let bar = progress::bar(plan.cells as u64);
    let mut keeper = Keeper { writer, bar };
    let result = map::run(&scene, &plan, engine.as_mut(), &mut keeper);
    keeper.bar.finish_and_clear();
    let summary = result?;
    keeper.writer.finish(summary.shots)?;
    if let Some(failure) = &summary.engine_failure {
        say(&format!("warning: {failure}; the CPU went on in its stead"));
    }
    if let Some(picture) = &picture {
        render::regimes(&store::StoredMap::open(&file)?, picture)?;
    }
    let written: Vec<PathBuf> = [Some(file), picture].into_iter().flatten().collect();
    print(&scene, &summary, start.elapsed().as_secs_f64(), &written)?;
    Ok(())
}

/// What the file says of its accuracy.
fn tolerances(accuracy: Option<Accuracy>) -> serde_json::Value {
    let mut tolerances = serde_json::json!({
        "residual_goal_whisker_lengths": GOAL,
        "residual_accepted_whisker_lengths": TOLERANCE,
    });
    if let Some(accuracy) = accuracy {
        tolerances["push_angle_error_estimated_deg"] = accuracy.error_deg.into();
        tolerances["bounded"] = BOUNDED.into();
    }
    tolerances
}

/// Keeps panels in the file and moves the bar.
struct Keeper {
    writer: MapWriter,
    bar: ProgressBar,
}

impl Observer for Keeper {
    fn panels(&mut self, first: usize, panels: &[Panel]) -> Result<(), store::Error> {
        self.writer.write_panels(first, panels)
    }

    fn settled(&mut self, cells: usize) {
        self.bar.inc(cells as u64);
    }
}

/// Makes the output folder and finds out, before any work, whether `files` can be made in it.
fn writable<'a>(path: &Path, mut files: impl Iterator<Item = &'a PathBuf>) -> Result<(), Failure> {
    let refuse = |what: &str, error: std::io::Error| {
        let path = path.display();
        Failure::Input(format!(
            "--output {path}: {what}: {error}; give a folder that can be written"
        ))
    };
    if path.is_file() {
        let path = path.display();
        return Err(Failure::Input(format!(
            "--output {path}: is a file; give a folder that can be written"
        )));
    }
    std::fs::create_dir_all(path).map_err(|error| refuse("cannot make the folder", error))?;
    tempfile::tempfile_in(path).map_err(|error| refuse("cannot write there", error))?;
    if let Some(file) = files.find(|file| file.is_dir()).map(|file| file.display()) {
        return Err(Failure::Input(format!(
            "{file}: is a folder; remove it or choose another --output"
        )));
    }
    Ok(())
}

fn print(scene: &Scene, summary: &Summary, seconds: f64, files: &[PathBuf]) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{}", scene.title)?;
    for (regime, cells) in Regime::ALL.iter().zip(summary.regimes) {
        if cells > 0 || *regime == Regime::Unresolved {
            writeln!(out, "{cells:>12}  {}", regime.name())?;
        }
    }
    writeln!(
        out,
        "{:>12}  refined in f64, {:.2} Newton steps each, worst residual {:.1e} of the length",
        summary.refined,
        summary.steps as f64 / summary.refined.max(1) as f64,
        summary.worst_residual
    )?;
    for (shots, what) in [
        (
            summary.shots.restarted,
            "shots without a solution from the engine, restarted in f64",
        ),
        (
            summary.shots.on_cpu_instead,
            "shots left to the refinement, after the engine had failed",
        ),
    ] {
        if shots > 0 {
            writeln!(out, "{shots:>12}  {what}")?;
        }
    }
    writeln!(
        out,
        "{:>12}  disagreements between cells and boundaries",
        summary.disagreements
    )?;
    let rate = summary.cells() as f64 / seconds;
    write!(out, "{rate:>12.0}  cells/s; {seconds:.2} s:")?;
    for (stage, seconds) in summary.seconds() {
        write!(out, " {stage} {seconds:.2}")?;
    }
    writeln!(out)?;
    for file in files {
        writeln!(out, "{}", file.display())?;
    }
    Ok(())
}
