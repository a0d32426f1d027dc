//! Text of `whiskmap plan`.

use super::super::estimate::on_idle_cores;
use super::super::failure::Failure;
use super::super::map_format::MapFormat;
use super::super::sharded::ShardShare;
use super::{PlanEstimate, memory};
use indicatif::DecimalBytes;
use std::io::Write;
use std::ops::Range;
use whiskmap::engine::on_gpu;
use whiskmap::plan::{Cost, Plan, ROD_STATES, effects};
use whiskmap::scene::{Scene, digits, rounded};
use whiskmap::terminal::StandardOutput;

/// Prints the plan and the estimated cost of a map of `scene`.
pub fn print(scene: &Scene, estimate: &PlanEstimate) -> Result<(), Failure> {
    let (plan, cost) = (&estimate.plan, &estimate.cost);
    let mut out = StandardOutput::open();
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
    let (rows, whiskers) = (counted(distances, "distance"), counted(plan.whiskers, "whisker"));
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
    let (seconds, threads) =
        (two_digits(on_idle_cores(cost.cpu_seconds)), rayon::current_num_threads());
    let (on, hours) = (counted(threads, "thread"), significant(cost.cpu_seconds / 3600.0));
    writeln!(out, "time          about {seconds} s on {on}, {hours} CPU-hours, without the files")?;
    for file in &estimate.files {
        let name = match file.format {
            MapFormat::Exr => "EXR file",
            MapFormat::Zarr => "Zarr store",
        };
        let (bytes, seconds) =
            (DecimalBytes(file.bytes as u64), two_digits(on_idle_cores(file.cpu_seconds)));
        let memory = mib(memory(&file.format.plan(scene)?, threads));
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

fn mib(bytes: u64) -> u64 {
    bytes.div_ceil(1 << 20)
}

/// Prints a line for each run of equal shards, of which the first one has the index `first`, and the sum of several.
pub fn print_shards(
    scene: &Scene,
    estimate: &PlanEstimate,
    shares: &[ShardShare],
    mut first: usize,
) -> std::io::Result<()> {
    let mut out = StandardOutput::open();
    let panel = scene.grid.panel_cells();
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

/// Formats a number with two significant digits, or with all digits before the point.
fn two_digits(x: f64) -> String {
    if x < 100.0 { significant(x) } else { format!("{x:.0}") }
}

/// Formats a number with two significant digits, however small it is.
fn significant(x: f64) -> String {
    digits(rounded(x, 2))
}
