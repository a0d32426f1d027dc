//! Command `whiskmap plan`.

use super::digits::DigitsArgs;
use super::engine::expansions;
use super::estimate::{FileCost, MapCost, MapFormat, estimate, files};
use super::failure::Failure;
use super::files::read_scene;
use clap::Args;
use indicatif::DecimalBytes;
use std::io::Write;
use std::path::PathBuf;
use whiskmap::engine::on_gpu;
use whiskmap::plan::{BYTES_PER_THREAD, Cost, Plan, ROD_STATES, effects};
use whiskmap::scene::Scene;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap plan scenes/cone.toml
  whiskmap plan scenes/morphology.toml --digits 5
  whiskmap plan - < my_whisker.toml

Effects with their own kernel add work to every integration step. The others are free: pole radius and friction only change \
the start of a trajectory, and projection is a faster taper and a steeper modulus gradient. The pole touches the whisker's \
centre line: the whisker's thickness does not add to the pole's radius. A GPU divides an engine call into submissions \
according to its speed.

Trajectories of cells, seconds and bytes are scaled up from samples: at most 128 x 128 cells (for the bytes, about 2^18 in \
all) and two values per sweep axis, fewer if these would take more than some seconds. They are computed and packed on this \
machine's CPU and discarded. Nothing is written and no GPU is opened. Seconds are wall seconds on all threads. The seconds \
of a file are the additional time for packing, without its picture and without the disk. A store also keeps the packed \
panels of its current block: at most 2 million cells.")]
pub struct PlanArgs {
    /// Scene file; - is standard input
    scene: PathBuf,
    #[command(flatten)]
    digits: DigitsArgs,
}

/// Seconds for the samples.
const SAMPLE_SECONDS: f64 = 2.0;

pub fn run(args: &PlanArgs) -> Result<(), Failure> {
    let scene = read_scene(&args.scene)?;
    let mut plan = Plan::in_bands(&scene)?;
    plan.digits = args.digits.of(plan.channels)?;
    let estimate = estimate(&scene, &plan, SAMPLE_SECONDS)?;
    let files = files(&scene, &plan, &MapFormat::of(&scene))?;
    print(&scene, &plan, &estimate, &files)?;
    Ok(())
}

fn print(scene: &Scene, plan: &Plan, cost: &MapCost, files: &[FileCost]) -> std::io::Result<()> {
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
    let pays = plan.expansions(scene).is_some_and(|count| count.pays());
    let engine = if pays { "spectral" } else { "cpu" };
    writeln!(out, "engine        {engine}: {}", expansions(scene, plan))?;
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
    let (seconds, threads) = (two_digits(cost.seconds), rayon::current_num_threads());
    let bytes = plan.bytes + threads as u64 * BYTES_PER_THREAD;
    let [mib, of_gpu] = [bytes, plan.gpu_bytes].map(|bytes| bytes.div_ceil(1 << 20));
    writeln!(
        out,
        "memory        at most {mib} MiB for panels and cells, and {of_gpu} MiB more with a GPU"
    )?;
    let threads = counted(threads, "thread");
    writeln!(
        out,
        "time          about {seconds} s on {threads} of the CPU engine, without the files"
    )?;
    for own in files {
        let name = match own.format {
            MapFormat::Exr => "EXR file",
            MapFormat::Zarr => "Zarr store",
        };
        let (bytes, seconds) = (DecimalBytes(own.bytes as u64), two_digits(own.seconds));
        writeln!(out, "{name:12}  about {bytes}, {seconds} s more")?;
    }
    Ok(())
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
