//! Errors of the system: the exit code is 1, and outputs stay as they were.

use super::{Place, Run, SCENE, names};
use crate::shipped;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

const EIO: i32 = 5;
const EAGAIN: i32 = 11;
const EMFILE: i32 = 24;
const ENOSPC: i32 = 28;
const EROFS: i32 = 30;
const EDQUOT: i32 = 122;

/// Program with a preloaded library that makes calls of the system fail.
struct FaultyPlace {
    place: Place,
    preloaded: PathBuf,
}

impl FaultyPlace {
    fn new() -> Self {
        let place = Place::with(SCENE);
        let preloaded = place.path("faults.so");
        let mut compiler = Command::new("cc");
        compiler.args(["-shared", "-fPIC", "-O1", "-o"]).arg(&preloaded);
        compiler.arg(shipped::root().join("tests/support/faults.c"));
        assert!(compiler.arg("-ldl").status().unwrap().success());
        Self { place, preloaded }
    }

    /// Runs the program; the calls named `fault` fail with the error `errno`, after as many that do not.
    fn run(&self, arguments: &[&str], fault: &str, errno: i32, after: usize) -> Run {
        let mut command = self.place.plain_command(arguments);
        command.env("LD_PRELOAD", &self.preloaded).env("FAULT", fault);
        command.env("ERRNO", errno.to_string());
        let command = command.env("AFTER", after.to_string());
        Run::of(&command.output().unwrap())
    }
}

const SHAPE: [&str; 5] = ["shape", "scene.toml", "--distance=9", "--push-angle=1", "--csv=t.csv"];
const MAP: [&str; 4] = ["map", "scene.toml", "--engine=cpu", "-o"];

/// A file whose bytes are not on the disk does not get its name, in a store or not.
#[test]
fn every_file_is_on_the_disk_before_it_has_its_name() {
    let faulty = FaultyPlace::new();
    let place = &faulty.place;
    place.map(&["scene.toml", "-o", "maps"]);
    place.write("t.csv", "old");
    place.write("x.exr", "old");
    let before = names(&place.path(""));
    let store = [&MAP[..], &["new", "--format=zarr"]].concat();
    for (arguments, file) in [
        (&SHAPE[..], "t.csv"),
        (&["extract", "maps/scene.exr", "-o", "x.exr"], "x.exr"),
        (&["extract", "maps/scene.exr", "-o", "x.csv"], "x.csv"),
        (&["explore", "scene.toml", "-o", "x.html"], "x.html"),
        (&["render", "maps/scene.exr", "-o", "x.svg"], "x.svg"),
        (&["extract", "maps/scene.exr", "-o", "x.zarr"], ""),
        (&store, "new/scene.zarr/zarr.json"),
    ] {
        let run = faulty.run(arguments, "fsync", EIO, 0);
        run.assert_said(1, &format!("error: cannot write {file}"));
        run.assert_said(1, "Input/output error (os error 5)\n");
        let _ = fs::remove_dir_all(place.path("new"));
        assert_eq!(names(&place.path("")), before, "{arguments:?}");
    }
    assert_eq!(place.bytes("t.csv"), b"old");
    assert_eq!(place.bytes("x.exr"), b"old");
}

/// Each file of a store is brought to the disk, and each folder once, after them; the root's name is there before the other files. A
/// failure at any of these is one of the command.
#[test]
fn a_store_is_on_the_disk_when_its_command_ends() {
    let faulty = FaultyPlace::new();
    let store = [&MAP[..], &["new", "--format=zarr", "--channels=regime"]].concat();
    for after in 0.. {
        let run = faulty.run(&store, "fsync", EIO, after);
        if run.code != Some(0) {
            run.assert_said(1, "error: cannot write new/scene.zarr");
            run.assert_said(1, "Input/output error (os error 5)\n");
            assert!(!run.err.contains("panicked"), "{run:?}");
            fs::remove_dir_all(faulty.place.path("new")).unwrap();
            continue;
        }
        let root = faulty.place.path("new/scene.zarr");
        let (folders, files): (Vec<PathBuf>, Vec<PathBuf>) = fs::read_dir(&root)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .partition(|path| path.is_dir());
        let inside = folders.iter().map(|folder| names(folder).len());
        let files = files.len() + inside.sum::<usize>();
        assert_eq!(after, files + folders.len() + 2);
        break;
    }
}

/// Another path helps against a read-only file system, not against the other errors.
#[test]
fn errors_at_the_first_check_of_an_output_are_failures_while_running() {
    let faulty = FaultyPlace::new();
    let map = [&MAP[..], &["maps"]].concat();
    for (arguments, path, option) in [(&SHAPE[..], "t.csv", "--csv"), (&map, "maps", "--output")] {
        for (errno, code) in [(EIO, 1), (EMFILE, 1), (ENOSPC, 1), (EDQUOT, 1), (EROFS, 2)] {
            let run = faulty.run(arguments, "create", errno, 0);
            let said = match code {
                1 => format!("error: cannot write {path}: "),
                _ => format!("error: {option} {path}: Read-only file system"),
            };
            run.assert_said(code, &said);
            run.assert_said(code, &format!("(os error {errno})"));
            assert_eq!(run.err.lines().count(), 1, "{run:?}");
        }
    }
}

#[test]
fn threads_that_cannot_be_started_are_a_failure_while_running() {
    let faulty = FaultyPlace::new();
    let map = [&MAP[..], &["maps", "--threads=3"]].concat();
    // The first thread waits for signals.
    for (after, count) in [(0, 1), (1, 3), (3, 3)] {
        let run = faulty.run(&map, "thread", EAGAIN, after);
        run.assert_said(1, &format!("error: cannot start threads ({count}): "));
        assert_eq!(run.err.lines().count(), 1, "{run:?}");
    }
    assert!(!faulty.place.path("maps").exists());
}

/// Files without a thread are written on that of their block; a block without one is an error, not a panic.
#[test]
fn a_store_needs_no_thread_for_each_file() {
    let faulty = FaultyPlace::new();
    let store = [&MAP[..], &["new", "--format=zarr", "--threads=1"]].concat();
    let enough = (0..200).find(|after| {
        let run = faulty.run(&store, "thread", EAGAIN, *after);
        let _ = fs::remove_dir_all(faulty.place.path("new"));
        assert!(!run.err.contains("panicked"), "{run:?}");
        if run.code != Some(0) {
            run.assert_said(1, "error: cannot ");
        }
        run.code == Some(0)
    });
    assert!(enough.is_some());
}
