//! Command `whiskmap plan`.

use super::arguments::whole;
use super::engine::EngineArgs;
use super::estimate::{FileCost, MapCost, MapFormat, estimate, files};
use super::failure::Failure;
use super::files::read_scene;
use super::map::{MapArgs, PlannedMap};
use super::sharded::{ShardShare, shares};
use clap::Args;
use indicatif::DecimalBytes;
use std::io::Write;
use std::ops::Range;
use whiskmap::engine::{EngineDescription, on_gpu};
use whiskmap::plan::{BYTES_PER_THREAD, Cost, Plan, ROD_STATES, effects};
use whiskmap::scene::{Scene, digits};

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap plan scenes/cone.toml
  whiskmap plan scenes/morphology.toml --format zarr --digits 5 --tolerance 1e-3deg
  whiskmap plan scenes/morphology.toml --engine cpu --shards 8
  whiskmap plan - < my_whisker.toml

plan takes all options of map. Effects with their own kernel add work to every integration step. The others are free: pole \
radius and friction only change the start of a trajectory, and projection is a faster taper and a steeper modulus gradient. \
The pole touches the whisker's centre line: the whisker's thickness does not add to the pole's radius. A GPU divides an engine \
call into submissions according to its speed.

Trajectories of cells, seconds and bytes are scaled up from samples: at most 128 x 128 cells (for the bytes, about 2^18 in \
all) and two values per sweep axis, fewer if these would take more than some seconds. They are computed and packed on this \
machine's CPU and discarded. Nothing is written and no GPU is opened: with --engine gpu, the seconds are those of the CPU \
engine. Seconds are wall seconds on all threads. The seconds of a file are the additional time for packing, without its \
picture and without the disk. CPU-hours are CPU seconds of the samples: other load on this machine makes seconds longer, not CPU-hours. Finished blocks of a store are not subtracted.")]
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
        let PlannedMap { plan, left_deg, .. } = args.plan(scene, first)?;
        let (mut engine, why) = options.without_gpu(scene, &plan, left_deg)?;
        let description = EngineDescription::of(engine.as_deref()).engine;
        Ok(Self {
            cost: estimate(scene, &plan, &mut engine, SAMPLE_SECONDS)?,
            files: files(scene, &plan, formats)?,
            plan,
            engine: (description, why),
            may_use_gpu: options.may_use_gpu(),
        })
    }

    /// Returns `[CPU seconds, bytes]` of some of the map's whiskers, packed in the first format.
    pub fn share(&self, whiskers: usize) -> [f64; 2] {
        let share = whiskers as f64 / self.plan.whiskers as f64;
        let file = self.files.first();
        let packing = file.map_or(0.0, |file| file.seconds);
        let threads = rayon::current_num_threads() as f64;
        let bytes = file.map_or(0.0, |file| file.bytes);
        [self.cost.cpu_seconds + packing * threads, bytes].map(|all| all * share)
    }
}

pub fn run(args: &PlanArgs) -> Result<(), Failure> {
    let scene = read_scene(&args.map.scene)?;
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
    let mut options = args.map.engine.clone();
    let are_tasks = args.shards.is_some() && !options.is_named();
    if are_tasks {
        options = options.of_task();
    }
    let mut estimate = PlanEstimate::measure(&args.map, &options, &scene, &formats)?;
    if are_tasks {
        estimate.engine.1 = "that of `submit`, unless --engine names another".to_owned();
    }
    print(&scene, &estimate)?;
    let own = shard.map_or(0..shares.len(), |shard| shard.index..shard.index + 1);
    print_shards(&scene, &estimate, &shares[own.clone()], own.start)?;
    Ok(())
}

fn print(scene: &Scene, estimate: &PlanEstimate) -> Result<(), Failure> {
    let (plan, cost) = (&estimate.plan, &estimate.cost);
    let mut out = std::io::stdout().lock();
    writeln!(out, "{}\n", scene.title)?;
    writeln!(out, "{:16}  {:3}  {:12}  why", "effect", "", "cost when on")?;
    for effect in effects(scene, plan.method.effects) {
        let on = if effect.on { "on" } else { "off" };
        let cost = match effect.cost {
            Cost::Kernel => "own kernel",
            Cost::Start => "free: start",
            Cost::Taper => "free: taper",
        };
        let name = effect.name;
        writeln!(out, "{name:16}  {on:3}  {cost:12}  {}", effect.why)?;
    }
    let rest = plan.rest_states();
    let derivatives = plan.derivative_states();
    let states = rest + ROD_STATES + derivatives;
    writeln!(
        out,
        "\nstates        {states}: {rest} rest shape, {ROD_STATES} rod, {derivatives} derivatives; \
         at last {} with energy",
        states + 2
    )?;
    let distances = scene.grid.distance_mm.len();
    let pushes = counted(scene.grid.push_angle_deg.len(), "push angle");
    let (rows, whiskers) = (
        counted(distances, "distance"),
        counted(plan.whiskers, "whisker"),
    );
    let (cells, steps) = (plan.cells, cost.steps_per_cell);
    writeln!(out, "cells         {cells}: {pushes} x {rows} x {whiskers}")?;
    let most = (steps + 1.0) * cells as f64;
    writeln!(
        out,
        "trajectories  about {most:.0} at most: {steps:.2} Newton steps a cell and 1 to confirm"
    )?;
    if scene.has_friction() {
        let line = "the CPU solves contacts that stick or slide toward the base";
        writeln!(out, "friction      {line}")?;
    }
    let (engine, why) = &estimate.engine;
    writeln!(out, "engine        {engine}: {why}")?;
    if estimate.may_use_gpu {
        print_gpu(&mut out, plan, distances)?;
    }
    let (seconds, threads) = (two_digits(cost.seconds), rayon::current_num_threads());
    let (on, hours) = (
        counted(threads, "thread"),
        significant(cost.cpu_seconds / 3600.0),
    );
    writeln!(
        out,
        "time          about {seconds} s on {on}, {hours} CPU-hours, without the files"
    )?;
    for own in &estimate.files {
        let name = match own.format {
            MapFormat::Exr => "EXR file",
            MapFormat::Zarr => "Zarr store",
        };
        let (bytes, seconds) = (DecimalBytes(own.bytes as u64), two_digits(own.seconds));
        let memory = mib(memory(&own.format.plan(scene)?, threads));
        writeln!(
            out,
            "{name:12}  about {bytes}, {seconds} s more, at most {memory} MiB of memory"
        )?;
    }
    Ok(())
}

/// Prints the calls and the memory of a GPU engine for maps with this number of distances.
fn print_gpu(out: &mut impl Write, plan: &Plan, distances: usize) -> std::io::Result<()> {
    match on_gpu(plan.method.effects) {
        Ok(()) => writeln!(
            out,
            "GPU calls     {}: groups of {}, {} of {}, {} a call",
            plan.engine_calls,
            counted(plan.panels_at_once, "whisker"),
            counted(plan.sides.len(), "side"),
            counted(distances, "row"),
            counted(plan.rows_at_once, "row")
        )?,
        Err(why) => writeln!(out, "GPU calls     none: {why}")?,
    }
    let gpu = mib(plan.gpu_bytes);
    writeln!(out, "GPU memory    {gpu} MiB more than below, on the host")
}

/// Returns the memory of panels and cells of a map on this number of threads, in bytes.
pub fn memory(plan: &Plan, threads: usize) -> u64 {
    plan.bytes + threads as u64 * BYTES_PER_THREAD
}

fn mib(bytes: u64) -> u64 {
    bytes.div_ceil(1 << 20)
}

/// Prints a line for each run of equal shards, of which the first one has the index `first`, and the sum of several.
fn print_shards(
    scene: &Scene,
    estimate: &PlanEstimate,
    shares: &[ShardShare],
    mut first: usize,
) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    let panel = scene.grid.push_angle_deg.len() * scene.grid.distance_mm.len();
    let mut line = |name: &str, share: ShardShare| {
        let [seconds, bytes] = estimate.share(share.whiskers);
        writeln!(
            out,
            "{name:12}  {}, {} cells: about {} CPU-hours, {}",
            counted(share.blocks, "block"),
            panel * share.whiskers,
            significant(seconds / 3600.0),
            DecimalBytes(bytes as u64)
        )
    };
    for run in shares.chunk_by(|one, next| one == next) {
        line(&named(first..first + run.len()), run[0])?;
        first += run.len();
    }
    if shares.len() > 1 {
        line("sum", shares.iter().copied().sum())?;
    }
    Ok(())
}

fn named(shards: Range<usize>) -> String {
    match shards.len() {
        1 => format!("shard {}", shards.start),
        _ => format!("shards {}-{}", shards.start, shards.end - 1),
    }
}

fn counted(count: usize, what: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {what}{ending}")
}

/// Formats a positive number with two digits, at most four of them after the point.
fn two_digits(x: f64) -> String {
    let digits = (1.0 - x.log10().floor()).clamp(0.0, 4.0);
    format!("{x:.*}", digits as usize)
}

/// Formats a number with two significant digits, however small it is.
fn significant(x: f64) -> String {
    digits(format!("{x:.1e}").parse().unwrap_or(x))
}
