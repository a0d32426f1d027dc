//! Command `whiskmap plan`.

mod print;

use super::arguments::whole;
use super::engine::EngineArgs;
use super::estimate::{FileCost, MapCost, estimate, file_costs};
use super::failure::Failure;
use super::files::Files;
use super::map::MapArgs;
use super::map_format::MapFormat;
use super::sharded::shares;
use clap::Args;
use print::{print, print_shards};
use whiskmap::engine::EngineDescription;
use whiskmap::plan::{BYTES_PER_THREAD, Plan};
use whiskmap::scene::Scene;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap plan scenes/cone.toml
  whiskmap plan scenes/morphology.toml --format zarr --digits 5 --tolerance 1e-3deg
  whiskmap plan scenes/morphology.toml --engine cpu --shards 8
  whiskmap plan - < scenes/cone.toml

plan takes all options of map. Effects with their own kernel add work to every integration step. The others are free: pole \
radius and friction only change the start of a trajectory, and projection is a faster taper and a steeper modulus gradient. \
The pole touches the whisker's centre line: the whisker's thickness does not add to the pole's radius. A GPU divides an engine \
call into submissions according to its speed.

Trajectories of cells, seconds and bytes are scaled up from samples: at most 128 x 128 cells (for the bytes, about 2^18 in \
all) and two values per sweep axis, fewer if these would take more than some seconds. They are computed and packed on this \
machine's CPU and discarded. Nothing is written and no GPU is opened: with --engine gpu, the seconds are those of the CPU \
engine. CPU-hours are scaled from the CPU time of the samples, so that other load on this machine hardly changes them. Seconds are the same \
CPU time divided by the threads: they assume idle cores, one for each thread. The seconds of a file are the additional time for packing, without its \
picture and without the disk. Finished blocks of a store are not subtracted.")]
pub struct PlanArgs {
    #[command(flatten)]
    pub map: MapArgs,
    /// Print the CPU-hours and bytes of each of N shards of a store, and their sum; without --engine, by the CPU engine, as `submit`
    /// runs them
    #[arg(long, value_name = "N", value_parser = whole(1..=1_000_000), conflicts_with = "shard")]
    shards: Option<u32>,
}

/// Seconds for the samples.
const SAMPLE_SECONDS: f64 = 2.0;

/// Estimate of a map in some formats.
pub struct PlanEstimate {
    /// Plan of the map in the first format.
    pub plan: Plan,
    pub cost: MapCost,
    pub files: Vec<FileCost>,
    /// Description of the engine that the samples use, and why.
    engine: (String, String),
    /// True if a GPU may solve cells of the map.
    may_use_gpu: bool,
}

impl PlanEstimate {
    /// Measures samples of `scene` for a map in each of these formats, by an engine of these options.
    pub fn measure(
        args: &MapArgs,
        options: &EngineArgs,
        scene: &Scene,
        formats: &[MapFormat],
    ) -> Result<Self, Failure> {
        let first = formats.first().copied().unwrap_or(MapFormat::Zarr);
        let map = args.plan(scene, first)?;
        let (mut engine, why) = options.without_gpu(&map)?;
        let plan = map.plan;
        let description = EngineDescription::of(engine.as_deref()).engine;
        Ok(Self {
            cost: estimate(scene, &plan, &mut engine, SAMPLE_SECONDS)?,
            files: file_costs(scene, &plan, formats)?,
            plan,
            engine: (description, why),
            may_use_gpu: options.may_use_gpu(),
        })
    }

    /// Returns `[CPU seconds, bytes]` of some of the map's whiskers, packed in the first format.
    pub fn share(&self, whiskers: usize) -> [f64; 2] {
        let share = whiskers as f64 / self.plan.whiskers as f64;
        let file = self.files.first();
        let packing = file.map_or(0.0, |file| file.cpu_seconds);
        let bytes = file.map_or(0.0, |file| file.bytes);
        [self.cost.cpu_seconds + packing, bytes].map(|all| all * share)
    }
}

pub fn run(args: &PlanArgs, files: &mut Files) -> Result<(), Failure> {
    let scene = files.scene(&args.map.scene)?;
    let shard = args.map.run.shard;
    let count = args.shards.map(|count| count as usize);
    let count = count.or(shard.map(|shard| shard.count));
    let shares = count.map_or(Ok(Vec::new()), |count| shares(&scene, count))?;
    let formats = match (args.map.format, count) {
        (Some(format), _) => vec![format],
        (None, Some(_)) => vec![MapFormat::Zarr],
        (None, None) => MapFormat::of(&scene),
    };
    if count.is_some() && formats == [MapFormat::Exr] {
        let why = "--shards: an EXR file has one writer; give --format zarr";
        return Err(Failure::Input(why.to_owned()));
    }
    let mut options = args.map.solver.engine.clone();
    let are_tasks = args.shards.is_some() && !options.is_named();
    if are_tasks {
        options = options.of_task();
    }
    let mut estimate = PlanEstimate::measure(&args.map, &options, &scene, &formats)?;
    if are_tasks {
        estimate.engine.1 = "that of `submit`, unless --engine names another".to_owned();
    }
    print(&scene, &estimate)?;
    let printed = shard.map_or(0..shares.len(), |shard| shard.index..shard.index + 1);
    print_shards(&scene, &estimate, &shares[printed.clone()], printed.start)?;
    Ok(())
}

/// Returns the memory of panels and cells of a map on this number of threads, in bytes.
pub fn memory(plan: &Plan, threads: usize) -> u64 {
    plan.bytes + threads as u64 * BYTES_PER_THREAD
}
