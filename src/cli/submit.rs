//! `whiskmap submit`: a sweep as a job array of Slurm.

use super::failure::Failure;
use super::files::check_folder;
use super::numbers::whole;
use super::scene;
use clap::{Args, Parser};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use whiskmap::store::ZarrStore;

/// Options of `submit`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap submit scenes/morphology.toml --shards 8 > sweep.sbatch
  whiskmap submit scenes/morphology.toml --shards 8 --partition short --time 1:00:00 --cpus-per-task 4 > sweep.sbatch
  whiskmap submit scenes/morphology.toml --shards 8 -o /scratch/maps -- --channels regime,force_un > sweep.sbatch

`sbatch sweep.sbatch` then fills the store; every node must see the scene, the folder and this program. Submitted again, the \
script computes what is missing. Other options go to sbatch itself, before the script's name.")]
pub struct Options {
    /// Scene file
    scene: PathBuf,
    /// Number of tasks, each of which computes one shard: at most one for each block of the store
    #[arg(long, value_name = "N", value_parser = whole(1..=1_000_000))]
    shards: u32,
    /// Folder for the store
    #[arg(short, long, value_name = "DIR", default_value = "outputs")]
    output: PathBuf,
    /// Partition of the cluster
    #[arg(long, value_name = "NAME", value_parser = word)]
    partition: Option<String>,
    /// Most time of a task, such as 30:00 or 1-12:00:00
    #[arg(long, value_name = "TIME", value_parser = word)]
    time: Option<String>,
    /// Threads of a task
    #[arg(long, value_name = "N", value_parser = whole(1..=1024))]
    cpus_per_task: Option<u32>,
    /// Memory of a task, such as 500M
    #[arg(long, value_name = "SIZE", value_parser = word)]
    mem: Option<String>,
    /// Options of `map`, such as --channels or --tolerance
    #[arg(last = true, value_name = "OPTIONS OF MAP")]
    map: Vec<String>,
}

/// A value of Slurm's options, which has no blank.
fn word(text: &str) -> Result<String, String> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_.,:+".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) {
        Ok(text.to_owned())
    } else {
        Err("must be letters, digits and -_.,:+".to_owned())
    }
}

/// Runs `submit`.
pub fn run(options: &Options) -> Result<(), Failure> {
    if options.scene == Path::new("-") {
        let why = "scene -: must be a file, which every task reads";
        return Err(Failure::Input(why.to_owned()));
    }
    let scene = scene::read(&options.scene)?;
    let blocks = ZarrStore::blocks(&scene.grid);
    if options.shards as usize > blocks {
        return Err(Failure::Input(format!(
            "--shards {}: must be at most {blocks}, the number of blocks of this sweep",
            options.shards
        )));
    }
    let store = options.output.join(format!("{}.zarr", scene.name));
    check_folder("--output", &options.output)?;
    check_folder("--output", &store)?;
    let script = options.script(&scene.name)?;
    check(&options.map)?;
    io::stdout().lock().write_all(script.as_bytes())?;
    Ok(())
}

/// Finds out whether `map` takes its own options, beside those that the script gives it.
fn check(own: &[String]) -> Result<(), Failure> {
    let given = "whiskmap map SCENE -o=DIR --format=zarr --shard=0/1 --resume --threads=1";
    let all = given.split(' ').chain(own.iter().map(String::as_str));
    super::Arguments::try_parse_from(all)
        .map(drop)
        .map_err(|why| {
            let why = why.to_string();
            let why = why.lines().next().unwrap_or_default();
            let why = why.strip_prefix("error: ").unwrap_or(why);
            Failure::Input(format!("-- {}: {why}", own.join(" ")))
        })
}

impl Options {
    /// The script, for a store called `name`.
    fn script(&self, name: &str) -> Result<String, Failure> {
        let program = std::env::current_exe()?;
        let folder = absolute("--output", &self.output)?;
        let store = quoted("--output", &folder.join(format!("{name}.zarr")))?;
        let folder = quoted("--output", &folder)?;
        let scene = quoted("scene", &absolute("scene", &self.scene)?)?;
        let program = quoted("this program", &program)?;

        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
        let job: String = name.chars().map(plain).collect();
        let last = self.shards - 1;
        let cpus = self.cpus_per_task.map(|cpus| cpus.to_string());
        let resources = [
            ("partition", &self.partition),
            ("time", &self.time),
            ("cpus-per-task", &cpus),
            ("mem", &self.mem),
        ];
        let resources = resources.map(|(option, value)| {
            let value = value.as_ref();
            value.map_or_else(String::new, |value| format!("#SBATCH --{option}={value}\n"))
        });
        let resources = resources.concat();
        let partition = self.partition.as_ref();
        let partition = partition.map_or_else(String::new, |name| format!(" --partition={name}"));
        // What nodes would choose by themselves may differ.
        let is_chosen = self.map.iter().any(|own| own.starts_with("--engine"));
        let engine = if is_chosen { "" } else { " --engine cpu" };
        let own = self
            .map
            .iter()
            .map(|own| format!(" {}", word_of_shell(own)));
        let own: String = own.collect();
        let status = word_of_shell(&format!("{program} status --verify {store}"));
        let shards = self.shards;
        Ok(format!(
            r#"#!/bin/sh
#SBATCH --job-name={job}
#SBATCH --array=0-{last}
#SBATCH --requeue
#SBATCH --open-mode=append
{resources}
# Whoever computes a block of the store, and however often, it is the same: tasks may
# be killed, requeued or submitted again.

# When all tasks have ended, a last job verifies the store, and fails if anything is
# missing or damaged.
if [ "$SLURM_ARRAY_TASK_ID" = "$SLURM_ARRAY_TASK_MIN" ]; then
    sbatch --job-name={job}-status --dependency="afterany:$SLURM_ARRAY_JOB_ID"{partition} \
        --output="slurm-${{SLURM_ARRAY_JOB_ID}}_status.out" --wrap={status}
fi

exec {program} map {scene} -o {folder} --format zarr{engine}{own} \
    --shard "$SLURM_ARRAY_TASK_ID/{shards}" --resume --threads "$SLURM_CPUS_ON_NODE"
"#
        ))
    }
}

/// Where a path leads from any folder.
fn absolute(what: &str, path: &Path) -> Result<PathBuf, Failure> {
    let absolute = std::path::absolute(path);
    absolute.map_err(|why| Failure::Input(format!("{what} {}: {why}", path.display())))
}

/// A path as a word of the shell.
fn quoted(what: &str, path: &Path) -> Result<String, Failure> {
    let text = path
        .to_str()
        .filter(|text| !text.contains(char::is_control));
    text.map(word_of_shell).ok_or_else(|| {
        let path = path.display();
        Failure::Input(format!(
            "{what} {path:?}: must be UTF-8 without line breaks, for a script"
        ))
    })
}

/// A text as one word of the shell, in quotes if it needs them.
fn word_of_shell(text: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/-_.,:+=@%".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) {
        return text.to_owned();
    }
    format!("'{}'", text.replace('\'', r"'\''"))
}
