//! Command `whiskmap submit`: job array for Slurm.

use super::arguments::{THREADS, whole};
use super::failure::{Failure, message};
use super::files::{Files, check_folder};
use super::map::MapArgs;
use super::map_format::MapFormat;
use super::plan::{PlanEstimate, memory};
use super::sharded::shares;
use super::slurm;
use clap::{Args, Parser};
use std::io::Write;
use std::path::{Path, PathBuf};
use whiskmap::scene::Scene;
use whiskmap::terminal::StandardOutput;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap submit scenes/morphology.toml --shards 8 > sweep.sbatch
  whiskmap submit scenes/morphology.toml --shards 8 --partition short --time 1:00:00 --cpus-per-task 4 > sweep.sbatch
  whiskmap submit scenes/morphology.toml --shards 8 -o /scratch/maps -- --channels regime,force_un > sweep.sbatch

`sbatch sweep.sbatch` then fills the store. The scene, the folder and this program must be visible to every node. A second \
submission of the script computes missing blocks. Give other options to sbatch, before the script's name.

Without --time or --mem, both are proposed from samples of the scene on this machine: three times the estimated CPU time of \
the largest shard over --cpus-per-task, and five minutes; and the memory of `whiskmap plan`.")]
pub struct SubmitArgs {
    /// Scene file
    scene: PathBuf,
    /// Number of tasks, at most one per block of the store; each computes one shard
    #[arg(long, value_name = "N", value_parser = whole(1..=1_000_000))]
    shards: u32,
    /// Folder for the store
    #[arg(short, long, value_name = "DIR", default_value = "outputs")]
    output: PathBuf,
    /// Partition of the cluster
    #[arg(long, value_name = "NAME", value_parser = word)]
    partition: Option<String>,
    /// Time limit of a task in a format of Slurm, such as 30:00 or 1-12:00:00 [default: by an estimate]
    #[arg(long, value_name = "TIME", value_parser = slurm::time, allow_hyphen_values = true)]
    time: Option<String>,
    /// Number of threads of a task
    #[arg(long, value_name = "N", value_parser = whole(THREADS))]
    cpus_per_task: Option<u32>,
    /// Memory of a task in a format of Slurm, such as 500M [default: by an estimate]
    #[arg(long, value_name = "SIZE", value_parser = slurm::memory, allow_hyphen_values = true)]
    mem: Option<String>,
    /// Options of `map`, such as --channels or --tolerance
    #[arg(last = true, value_name = "OPTIONS OF MAP")]
    map: Vec<String>,
}

/// Parses the value of an option of Slurm.
fn word(text: &str) -> Result<String, String> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_.,:+".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) {
        Ok(text.to_owned())
    } else {
        Err("must be letters, digits and -_.,:+".to_owned())
    }
}

pub fn run(args: &SubmitArgs, files: &mut Files) -> Result<(), Failure> {
    if args.scene == Path::new("-") {
        let why = "scene -: must be a file, because every task reads it";
        return Err(Failure::Input(why.to_owned()));
    }
    let scene = files.scene(&args.scene)?;
    let shares = shares(&scene, args.shards as usize)?;
    let store = args.output.join(format!("{}.zarr", scene.name));
    check_folder("--output", &args.output)?;
    check_folder("--output", &store)?;
    let map = args.map()?;
    let whiskers = shares.iter().map(|share| share.whiskers).max();
    let limits = || args.limits(&scene, &map, whiskers.unwrap_or_default());
    let script = args.script(&scene.name, &map, limits)?;
    if map.solver.engine.names_gpu() {
        message(
            "note: with --engine gpu, add the line that requests a GPU on your cluster, such as `#SBATCH --gres=gpu:1`",
        );
    }
    StandardOutput::open().write_all(script.as_bytes())?;
    Ok(())
}

/// Factor of a proposed time limit over the estimate: samples underestimate by a factor of up to 1.1, and nodes may be slower.
const SLOWER: f64 = 3.0;

/// Seconds of a proposed time limit for the start of a task.
const START_SECONDS: f64 = 300.0;

/// Memory of the program besides panels and cells, in bytes. It takes 20 MiB on Linux.
const PROGRAM_BYTES: u64 = 64 << 20;

impl SubmitArgs {
    /// Returns the arguments of `map` in a task.
    ///
    /// # Errors
    /// If `map` does not accept its own options together with the options of the script.
    fn map(&self) -> Result<MapArgs, Failure> {
        let given = "whiskmap map SCENE -o=DIR --format=zarr --shard=0/1 --resume --threads=1";
        let all = given.split(' ').chain(self.map.iter().map(String::as_str));
        let parsed = super::Arguments::try_parse_from(all).map_err(|why| why.to_string());
        match parsed.map(|parsed| parsed.command) {
            Ok(super::Command::Map(map)) => Ok(map),
            Ok(_) => Err("must be options of map".to_owned()),
            Err(why) => Err(why),
        }
        .map_err(|why| {
            let why = why.lines().next().unwrap_or_default();
            let why = why.strip_prefix("error: ").unwrap_or(why);
            Failure::Input(format!("-- {}: {why}", self.map.join(" ")))
        })
    }

    /// Returns time limit and memory of a task: those given, or else those that an estimate of `whiskers` of the sweep proposes.
    fn limits(
        &self,
        scene: &Scene,
        map: &MapArgs,
        whiskers: usize,
    ) -> Result<[String; 2], Failure> {
        if let (Some(time), Some(memory)) = (&self.time, &self.mem) {
            return Ok([time.clone(), memory.clone()]);
        }
        let estimate =
            PlanEstimate::measure(map, &map.solver.engine.of_task(), scene, &[MapFormat::Zarr])?;
        let cpus = self.cpus_per_task.unwrap_or(1);
        let [cpu_seconds, _] = estimate.share(whiskers);
        let seconds = cpu_seconds / f64::from(cpus);
        let bytes = memory(&estimate.plan, cpus as usize) + PROGRAM_BYTES;
        let limit = |option: &str, given: &Option<String>, proposed: String, why: String| {
            given.clone().unwrap_or_else(|| {
                message(&format!("note: --{option} {proposed} is proposed: {why}"));
                proposed
            })
        };
        let time = slurm::time_of(SLOWER * seconds + START_SECONDS);
        let plural = if cpus == 1 { "" } else { "s" };
        let of_time =
            format!("a task takes about {seconds:.0} s on {cpus} CPU{plural} of this kind");
        let of_memory = format!("a task takes at most {} MiB", bytes.div_ceil(1 << 20));
        Ok([
            limit("time", &self.time, time, of_time),
            limit("mem", &self.mem, slurm::memory_of(bytes), of_memory),
        ])
    }

    /// Returns the script for a store of this `name`, with these options of `map`, and the time and the memory that `limits` returns.
    fn script(
        &self,
        name: &str,
        map: &MapArgs,
        limits: impl FnOnce() -> Result<[String; 2], Failure>,
    ) -> Result<String, Failure> {
        let program = std::env::current_exe()?;
        let folder = absolute("--output", &self.output)?;
        let store = quoted("--output", &folder.join(format!("{name}.zarr")))?;
        let folder = quoted("--output", &folder)?;
        let scene = quoted("scene", &absolute("scene", &self.scene)?)?;
        let program = quoted("this program", &program)?;
        let [time, memory] = limits()?;

        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
        let job: String = name.chars().map(plain).collect();
        let last = self.shards - 1;
        let cpus = self.cpus_per_task.map(|cpus| cpus.to_string());
        let requests = [
            ("partition", self.partition.as_ref()),
            ("time", Some(&time)),
            ("cpus-per-task", cpus.as_ref()),
            ("mem", Some(&memory)),
        ];
        let lines = requests.map(|(option, value)| {
            value.map_or_else(String::new, |value| format!("#SBATCH --{option}={value}\n"))
        });
        let resources = lines.concat();
        let partition = self.partition.as_ref();
        let partition = partition.map_or_else(String::new, |name| format!(" --partition={name}"));
        // `auto` may select different engines on different nodes.
        let engine = if map.solver.engine.is_named() { "" } else { " --engine cpu" };
        let words = self.map.iter();
        let options: String = words.map(|word| format!(" {}", word_of_shell(word))).collect();
        let status = word_of_shell(&format!("{program} status --verify {store}"));
        let shards = self.shards;
        Ok(format!(
            r#"#!/bin/sh
#SBATCH --job-name={job}
#SBATCH --array=0-{last}
#SBATCH --requeue
#SBATCH --open-mode=append
{resources}
# The bytes of a block do not depend on the task that computes it: tasks may be
# interrupted, requeued or submitted again.

# When all tasks have ended, a last job verifies the store. It fails if a block is
# missing or damaged.
if [ "$SLURM_ARRAY_TASK_ID" = "$SLURM_ARRAY_TASK_MIN" ]; then
    sbatch --job-name={job}-status --dependency="afterany:$SLURM_ARRAY_JOB_ID"{partition} \
        --output="slurm-${{SLURM_ARRAY_JOB_ID}}_status.out" --wrap={status}
fi

exec {program} map {scene} -o {folder} --format zarr{engine}{options} \
    --shard "$SLURM_ARRAY_TASK_ID/{shards}" --resume --threads "$SLURM_CPUS_ON_NODE"
"#
        ))
    }
}

/// Returns an absolute path.
fn absolute(what: &str, path: &Path) -> Result<PathBuf, Failure> {
    let absolute = std::path::absolute(path);
    absolute.map_err(|why| Failure::Input(format!("{what} {}: {why}", path.display())))
}

/// Returns a path as one word of the shell.
fn quoted(what: &str, path: &Path) -> Result<String, Failure> {
    let text = path.to_str().filter(|text| !text.contains(char::is_control));
    text.map(word_of_shell).ok_or_else(|| {
        let path = path.display();
        Failure::Input(format!("{what} {path:?}: must be UTF-8 without line breaks"))
    })
}

/// Returns a text as one word of the shell, quoted if necessary.
fn word_of_shell(text: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/-_.,:+=@%".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) {
        return text.to_owned();
    }
    format!("'{}'", text.replace('\'', r"'\''"))
}
