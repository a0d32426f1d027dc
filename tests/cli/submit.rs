//! `whiskmap submit`: the script, run by a shell task by task. `tests/cluster` runs it on Slurm.

use super::store::{SWEEP, assert_same, good};
use super::{Place, Run};
use crate::shipped;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

/// Runs a script in the shell with these variables; a fake `sbatch` records its arguments.
fn shell(place: &Place, script: &[&str], variables: &[(&str, &str)]) -> Run {
    let tools = place.path("tools");
    fs::create_dir_all(&tools).unwrap();
    let sbatch = tools.join("sbatch");
    fs::write(&sbatch, "#!/bin/sh\nprintf '%s\\n' \"$@\" >> sbatch.log\n").unwrap();
    fs::set_permissions(&sbatch, fs::Permissions::from_mode(0o755)).unwrap();
    let program = Path::new(env!("CARGO_BIN_EXE_whiskmap")).parent().unwrap();
    let others = std::env::var("PATH").unwrap();
    let path = format!("{}:{}:{others}", tools.display(), program.display());
    let mut command = Command::new("sh");
    command.args(script).envs(variables.iter().copied());
    let command = command.env("PATH", path).current_dir(place.path(""));
    Run::of(&command.output().unwrap())
}

#[test]
fn the_tasks_of_the_script_fill_the_store_and_a_last_job_verifies_it() {
    let place = Place::with(SWEEP);
    good(&place, "whole", &["--channels=regime,force_un"]);
    let folder = "it's \"a\" folder $HOME";
    fs::create_dir(place.path(folder)).unwrap();
    let scene = format!("{folder}/scene.toml");
    place.write(&scene, SWEEP);
    let submit = [
        "submit",
        &scene,
        "--output",
        folder,
        "--shards=3",
        "--partition=short",
        "--time=1-12:00:00",
        "--cpus-per-task=2",
        "--mem=500M",
        "--",
        "--channels",
        "regime, force_un",
    ];
    let run = place.quiet(&submit);
    for line in [
        "#SBATCH --job-name=scene",
        "#SBATCH --array=0-2",
        "#SBATCH --requeue",
        "#SBATCH --partition=short",
        "#SBATCH --time=1-12:00:00",
        "#SBATCH --cpus-per-task=2",
        "#SBATCH --mem=500M",
    ] {
        assert!(run.out.lines().any(|printed| printed == line), "{line}: {run:?}");
    }
    assert!(run.out.lines().count() < 25, "{run:?}");
    place.write("sweep.sbatch", &run.out);

    // From another folder, and one task twice, as after a requeue.
    for task in ["2", "0", "0", "1"] {
        let variables = [
            ("SLURM_ARRAY_JOB_ID", "7"),
            ("SLURM_ARRAY_TASK_ID", task),
            ("SLURM_ARRAY_TASK_MIN", "0"),
            ("SLURM_CPUS_ON_NODE", "2"),
        ];
        let run = shell(&place, &["sweep.sbatch"], &variables);
        assert_eq!(run.code, Some(0), "{run:?}");
    }
    fs::create_dir(place.path("found")).unwrap();
    fs::rename(place.path(&format!("{folder}/scene.zarr")), place.path("found/scene.zarr"))
        .unwrap();
    assert_same(&place, "whole", "found");

    let log = place.text("sbatch.log");
    let calls: Vec<&str> = log.lines().collect();
    let (first, again) = calls.split_at(calls.len() / 2);
    assert_eq!(first, again);
    assert_eq!(
        first[..4],
        [
            "--job-name=scene-status",
            "--dependency=afterany:7",
            "--partition=short",
            "--output=slurm-7_status.out"
        ]
    );
    let status = first[4].strip_prefix("--wrap=").unwrap();
    let run = shell(&place, &["-c", status], &[]);
    assert_eq!(run.code, Some(2), "the store is elsewhere: {run:?}");
    assert!(run.err.contains(&format!("{folder}/scene.zarr")), "{run:?}");
    fs::rename(place.path("found/scene.zarr"), place.path(&format!("{folder}/scene.zarr")))
        .unwrap();
    let run = shell(&place, &["-c", status], &[]);
    assert_eq!((run.code, run.count("of 8 blocks")), (Some(0), 8), "{run:?}");
}

#[test]
fn submit_refuses_what_no_task_could_do() {
    let place = Place::with(SWEEP);
    let submit = |options: &[&str]| place.run(&[&["submit", "scene.toml"], options].concat());
    submit(&[]).assert_refused(&["--shards <N>"]);
    for shards in ["0", "-1", "some", "1.5", ""] {
        submit(&[&format!("--shards={shards}")]).assert_refused(&["--shards <N>"]);
    }
    submit(&["--shards=9"])
        .assert_refused(&["--shards 9: must be at most 8, the number of blocks"]);
    submit(&["--shards=2", "--partition=a\nb"]).assert_refused(&["must be letters, digits and"]);
    for time in ["1 h", "1h", "1:00:00:00", "-5", ""] {
        submit(&["--shards=2", &format!("--time={time}")])
            .assert_refused(&["must be minutes, minutes:seconds, hours:minutes:seconds, "]);
    }
    for memory in ["", "1.5G", "2GB"] {
        submit(&["--shards=2", &format!("--mem={memory}")])
            .assert_refused(&["must be a whole number with K, M (the default), G or T"]);
    }
    for (given, said) in [
        (&["--colour"][..], "unexpected argument '--colour'"),
        (&["--shard", "0/2"], "'--shard <I/N>' cannot be used multiple times"),
        (&["--channels", "force"], "--channels force: invalid value 'force'"),
        (&["another.toml"], "unexpected argument 'another.toml'"),
    ] {
        let options = [&["--shards=2", "--"], given].concat();
        submit(&options).assert_refused(&["error: -- ", said]);
    }
    submit(&["--shards=2", "-o", "a\nb"]).assert_refused(&["--output", "without line breaks"]);
    let scene = |scene: &str| place.run(&["submit", scene, "--shards=2"]);
    scene("-").assert_refused(&["scene -: must be a file"]);
    scene("nowhere.toml").assert_refused(&["nowhere.toml: cannot be read"]);
    place.write("wrong.toml", &SWEEP.replace("length_mm = 20", "length_mm = -20"));
    scene("wrong.toml").assert_refused(&["length_mm = -20"]);
}

/// The sweep takes seconds, so the limit is five minutes and the next whole one. A task of one thread takes 4 MiB for its cells, 64 MiB
/// for the program and some for panels.
#[test]
fn time_and_memory_are_proposed() {
    let place = Place::with(SWEEP);
    let run = place.good(&["submit", "scene.toml", "--shards=8"]);
    let value = |option: &str| {
        let line = format!("#SBATCH --{option}=");
        let value = run.out.lines().find_map(|printed| printed.strip_prefix(&line));
        value.unwrap_or_else(|| panic!("no {line}: {run:?}")).to_owned()
    };
    let minutes: u32 = value("time").split(':').nth(1).unwrap().parse().unwrap();
    assert!(value("time").starts_with("0:") && (6..30).contains(&minutes), "{run:?}");
    assert_eq!(value("mem"), "100M");
    for option in ["time", "mem"] {
        let note = format!("note: --{option} {} is proposed: a task takes ", value(option));
        assert!(run.err.contains(&note), "{run:?}");
    }
    assert_eq!(run.err.lines().count(), 2, "{run:?}");
    let on_gpu = place.run(&["submit", "scene.toml", "--shards=8", "--", "--engine=gpu"]);
    assert!(on_gpu.err.contains("#SBATCH --gres=gpu:1"), "{on_gpu:?}");
    let given = place.run(&["submit", "scene.toml", "--shards=8", "--time=1-12"]);
    assert!(given.out.contains("#SBATCH --time=1-12\n"), "{given:?}");
    assert!(!given.err.contains("--time"), "{given:?}");
}

/// The lines for GNU parallel and Kubernetes in the documentation run.
#[test]
fn other_schedulers_fill_the_store_as_documented() {
    let page = shipped::root().join("docs/sweeps.md");
    let page = fs::read_to_string(page).unwrap();
    let block = |with: &str| {
        let mut blocks = page.split("```").skip(1).step_by(2);
        let block = blocks.find(|block| block.contains(with)).unwrap();
        block.split_once('\n').unwrap().1.to_owned()
    };
    let place = Place::with(SWEEP);
    fs::create_dir(place.path("scenes")).unwrap();
    place.write("scenes/morphology.toml", SWEEP);
    good(&place, "whole", &["--channels=regime,force_un"]);
    let as_whole = || {
        fs::create_dir_all(place.path("found")).unwrap();
        let store = place.path("outputs/morphology.zarr");
        fs::rename(store, place.path("found/scene.zarr")).unwrap();
        assert_same(&place, "whole", "found");
        fs::remove_dir_all(place.path("found")).unwrap();
    };

    // Without GNU parallel, a loop replaces `{}`.
    let parallel = "command -v parallel || parallel() {
        while [ \"$1\" != whiskmap ]; do shift; done
        while read -r line; do eval \"$(echo \"$@\" | sed \"s/{}/$line/g\")\" || return; done
    }\n";
    let lines = block("| parallel");
    let run = shell(&place, &["-ec", &format!("{parallel}{lines}")], &[]);
    assert_eq!((run.code, run.count("of 8 blocks")), (Some(0), 8), "{run:?}");
    as_whole();

    // The command of the indexed job runs for each index.
    let job = block("JOB_COMPLETION_INDEX");
    let command = job.split('\'').nth(1).unwrap();
    assert!(job.contains("completionMode: Indexed") && job.contains("completions: 8"));
    for index in 0..8 {
        let index = index.to_string();
        let variables = [("JOB_COMPLETION_INDEX", &*index)];
        let run = shell(&place, &["-ec", command], &variables);
        assert_eq!(run.code, Some(0), "{run:?}");
    }
    as_whole();
}
