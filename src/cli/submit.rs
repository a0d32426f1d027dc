//! Command `whiskmap submit`: job array for Slurm.

use super::arguments::whole;
use super::failure::Failure;
use super::files::{check_folder, read_scene};
use clap::{Args, Parser};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use whiskmap::store::ZarrStore;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap submit scenes/morphology.toml --shards 8 > sweep.sbatch
  whiskmap submit scenes/morphology.toml --shards 8 --partition short --time 1:00:00 --cpus-per-task 4 > sweep.sbatch
  whiskmap submit scenes/morphology.toml --shards 8 -o /scratch/maps -- --channels regime,force_un > sweep.sbatch

`sbatch sweep.sbatch` then fills the store. The scene, the folder and this program must be visible to every node. A second \
submission of the script computes missing blocks. Give other options to sbatch, before the script's name.")]
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
    /// Time limit of a task, such as 30:00 or 1-12:00:00
    #[arg(long, value_name = "TIME", value_parser = word)]
    time: Option<String>,
    /// Number of threads of a task
    #[arg(long, value_name = "N", value_parser = whole(1..=1024))]
    cpus_per_task: Option<u32>,
    /// Memory of a task, such as 500M
    #[arg(long, value_name = "SIZE", value_parser = word)]
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

pub fn run(args: &SubmitArgs) -> Result<(), Failure> {
    if args.scene == Path::new("-") {
        let why = "scene -: must be a file, because every task reads it";
        return Err(Failure::Input(why.to_owned()));
    }
    let scene = read_scene(&args.scene)?;
    let blocks = ZarrStore::blocks(&scene.grid).len();
    if args.shards as usize > blocks {
        return Err(Failure::Input(format!(
            "--shards {}: must be at most {blocks}, the number of blocks of this sweep",
            args.shards
        )));
    }
    let store = args.output.join(format!("{}.zarr", scene.name));
    check_folder("--output", &args.output)?;
    check_folder("--output", &store)?;
    let script = args.script(&scene.name)?;
    check(&args.map)?;
    io::stdout().lock().write_all(script.as_bytes())?;
    Ok(())
}

/// Returns an error if `map` does not accept its `own` options together with those of the script.
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

impl SubmitArgs {
    /// Returns the script for a store of this `name`.
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
        // `auto` may select different engines on different nodes.
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
# The bytes of a block do not depend on the task that computes it: tasks may be
# interrupted, requeued or submitted again.

# When all tasks have ended, a last job verifies the store. It fails if a block is
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

/// Returns an absolute path.
fn absolute(what: &str, path: &Path) -> Result<PathBuf, Failure> {
    let absolute = std::path::absolute(path);
    absolute.map_err(|why| Failure::Input(format!("{what} {}: {why}", path.display())))
}

/// Returns a path as one word of the shell.
fn quoted(what: &str, path: &Path) -> Result<String, Failure> {
    let text = path
        .to_str()
        .filter(|text| !text.contains(char::is_control));
    text.map(word_of_shell).ok_or_else(|| {
        let path = path.display();
        Failure::Input(format!(
            "{what} {path:?}: must be UTF-8 without line breaks"
        ))
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
