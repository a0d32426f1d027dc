//! Command `whiskmap map`.

use super::arguments::{THREADS, all_channels, completed, whole};
use super::digits::DigitsArgs;
use super::disk;
use super::failure::{Failure, message};
use super::files::{Files, unwritten};
use super::map_format::MapFormat;
use super::outputs::PictureFile;
use super::scene::check_strict;
use super::sharded::{self, RunArgs};
use super::solver::{SolverArgs, compute};
use super::summary::report;
use clap::Args;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Instant;
use whiskmap::compute::PlannedMap;
use whiskmap::engine::EngineDescription;
use whiskmap::mechanics::numerics::ArithmeticClass;
use whiskmap::plan::Channels;
use whiskmap::render::{self, MapOptions, PictureFormat, PictureSize};
use whiskmap::scene::Scene;
use whiskmap::store::{MapDescription, MapWriter, Output};

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap map scenes/cone.toml
  whiskmap map scenes/morphology.toml -o /tmp --engine cpu --threads 1
  whiskmap map scenes/morphology.toml --tolerance 1e-3deg
  whiskmap map scenes/cone.toml --engine gpu --adapter 0
  whiskmap map scenes/morphology.toml --format zarr --channels regime,force_un
  whiskmap map scenes/morphology.toml --format zarr --digits 5,force_un=3
  whiskmap map scenes/morphology.toml --format zarr --resume
  whiskmap map scenes/morphology.toml --format zarr --shard 3/8 --resume
  whiskmap map - < scenes/cone.toml

A sweep over more than two axes needs a Zarr store, the folder NAME.zarr. Any number of runs may fill it, each with blocks of \
whiskers; finished blocks are kept.")]
pub struct MapArgs {
    /// Scene file; - is standard input
    pub scene: PathBuf,
    /// Folder for the files; created if it does not exist
    #[arg(short, long, value_name = "DIR", default_value = "outputs")]
    output: PathBuf,
    #[command(flatten)]
    pub solver: SolverArgs,
    /// Number of CPU threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = whole(THREADS))]
    pub threads: Option<u32>,
    /// Compute and store only these channels, separated by commas
    /// [default: all but derivatives, such as d_push_d_taper]
    #[arg(long, value_name = "LIST", value_parser = completed(Channels::from_str, all_channels()), hide_possible_values = true)]
    channels: Option<Channels>,
    #[command(flatten)]
    digits: DigitsArgs,
    /// Format of the map [default: exr]
    #[arg(long, value_enum)]
    pub format: Option<MapFormat>,
    #[command(flatten)]
    pub run: RunArgs,
    /// Write no picture
    #[arg(long)]
    no_png: bool,
}

pub fn run(args: &MapArgs, files: &mut Files) -> Result<(), Failure> {
    let scene = files.scene(&args.scene)?;
    check_strict(args.run.strict, &scene)?;
    let format = args.format.unwrap_or(MapFormat::Exr);
    let planned = args.plan(&scene, format)?;
    let (mut engine, why) = args.solver.open(&planned)?;
    let tolerances = planned.tolerances(engine.as_deref());
    let plan = planned.plan;
    let solver = EngineDescription::of(engine.as_deref());
    let about = MapDescription {
        scene: &scene,
        engine: &solver,
        tolerances: &tolerances,
        channels: plan.channels,
        digits: plan.digits,
        arithmetic: ArithmeticClass::detect().name(),
    };
    files.folder("--output", &args.output)?;
    if format == MapFormat::Zarr {
        let path = args.output.join(format!("{}.zarr", scene.name));
        let engine = (&mut engine, &*why);
        return sharded::fill(&path, &args.run, files, &scene, plan, &about, engine);
    }
    let file = args.output.join(format!("{}.exr", scene.name));
    let output = files.file("--output", &file)?;
    let picture = (!args.no_png).then(|| file.with_extension("png"));
    if let Some(picture) = &picture {
        // It is only checked: a temporary file that is not written to is removed after a day.
        files.file("--output", picture)?;
    }
    if !args.run.force {
        disk::check(&args.output, MapFormat::Exr, &scene, &plan)?;
    }
    let (name, adapter) = (&solver.engine, &solver.adapter);
    message(&format!("engine: {name} on {adapter} ({why})"));

    let start = Instant::now();
    let mut writer = MapWriter::create(output, &about)?;
    let keep = |panels: &mut Vec<_>| writer.write_panels(panels);
    let summary = compute(&scene, &plan, &mut engine, keep)?;
    let map = writer.finish(summary.engine_cells, summary.audit)?;
    let mut written = vec![file];
    if let Some(path) = picture {
        let regimes = render::map(&map.into(), &MapOptions::default())?;
        let picture = PictureFile {
            output: Output::create(&path, files.temporary()).map_err(unwritten(&path))?,
            format: PictureFormat::Png,
            size: PictureSize::Natural,
        };
        picture.write(&regimes)?;
        written.push(path);
    }
    report(&scene, &summary, start, &written)
}

impl MapArgs {
    /// Returns the text that an interrupt adds to its message.
    pub fn advice(&self) -> &'static str {
        match self.format {
            None | Some(MapFormat::Exr) => "",
            Some(MapFormat::Zarr) => {
                "; finished blocks are kept: resume with the same command and --resume"
            }
        }
    }

    /// Returns the plan of the map in this format, with the given options.
    ///
    /// # Errors
    /// If the options contradict each other, the scene or the format.
    pub fn plan<'a>(&self, scene: &'a Scene, format: MapFormat) -> Result<PlannedMap<'a>, Failure> {
        self.check(scene, format)?;
        let channels = self.channels.unwrap_or_else(|| Channels::of_scene(scene));
        let mut map = self.solver.plan(scene, format.plan(scene)?, channels)?;
        map.plan.digits = self.digits.of(channels)?;
        Ok(map)
    }

    /// Returns an error if the format does not support the options.
    fn check(&self, scene: &Scene, format: MapFormat) -> Result<(), Failure> {
        if format == MapFormat::Zarr {
            return Ok(());
        }
        let refuse = |why: String| Err(Failure::Input(format!("{why}; give --format zarr")));
        if scene.grid.sweep.len() > 2 {
            let axes = scene.grid.sweep_names();
            return refuse(format!(
                "grid: an EXR file has room for two sweep axes, the scene has {axes}"
            ));
        }
        if self.run.resume {
            return refuse("--resume: an EXR file is written at once".to_owned());
        }
        if self.run.shard.is_some() {
            return refuse("--shard: an EXR file has one writer".to_owned());
        }
        let regimes = |channels: Channels| channels.contains("regime");
        if !self.no_png && !self.channels.is_none_or(regimes) {
            return Err(Failure::Input(
                "--channels: must have regime, which the picture shows; or give --no-png"
                    .to_owned(),
            ));
        }
        Ok(())
    }
}
