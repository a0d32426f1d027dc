//! Stores that several runs create at once, that are moved while a run fills them, or that claim huge sizes.

#[cfg(unix)]
use super::store::{MAP, begun};
use super::store::{SWEEP, assert_complete, assert_same, files, good, is_hidden};
use super::{Place, Run};
use std::fs;
#[cfg(unix)]
use std::process::Command;
use std::process::Stdio;

/// One block of two whiskers.
pub const SMALL: &str = r#"title = "One block"
[whisker]
length_mm = 20
base_radius_um = 30.0
youngs_modulus_gpa = 3.0
[grid]
push_angle_deg = { from = -70, to = 70, count = 8 }
distance_mm = { from = 2, to = 20, count = 8 }
taper = [0, 0.5]
"#;

/// Runs two processes at once that fill the store `scene.zarr` in `folder`.
fn race(place: &Place, folder: &str, scenes: [&str; 2], options: [&str; 2]) -> [Run; 2] {
    let spawn = |number: usize| {
        let arguments = [
            "map",
            scenes[number],
            "--engine=cpu",
            "--format=zarr",
            "--threads=1",
            "--shard=0/1",
            "-o",
            folder,
            options[number],
        ];
        let mut command = place.plain_command(&arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command.spawn().unwrap()
    };
    let both = [0, 1].map(spawn);
    both.map(|child| Run::of(&child.wait_with_output().unwrap()))
}

/// Checks that one run completes, and that the other one is refused and names what differs.
fn assert_one_succeeds(place: &Place, folder: &str, runs: &[Run; 2], said: &str) {
    let [one, other] = runs;
    let (winner, loser) = if one.code == Some(0) { (one, other) } else { (other, one) };
    assert_eq!(winner.code, Some(0), "{runs:?}");
    loser.assert_said(2, said);
    place.good(&["status", &format!("{folder}/scene.zarr"), "--verify"]);
}

#[test]
fn of_two_runs_that_create_a_store_differently_one_succeeds() {
    let place = Place::with(SMALL);
    for name in ["a", "b"] {
        fs::create_dir(place.path(name)).unwrap();
    }
    place.write("a/scene.toml", SMALL);
    place.write("b/scene.toml", &SMALL.replace("[0, 0.5]", "[0, 0.6]"));
    let (a, b) = ("a/scene.toml", "b/scene.toml");
    let exact = "--no-png";
    for number in 0..50 {
        let folder = format!("scenes-{number}");
        let runs = race(&place, &folder, [a, b], [exact; 2]);
        assert_one_succeeds(&place, &folder, &runs, "differs in `scene`: `taper = [0, 0.");
        let folder = format!("tolerances-{number}");
        let runs = race(&place, &folder, [a; 2], [exact, "--tolerance=1e-3deg"]);
        assert_one_succeeds(&place, &folder, &runs, "differs in `tolerances`: ");
        let folder = format!("equal-{number}");
        let runs = race(&place, &folder, [a; 2], [exact; 2]);
        assert!(runs.iter().all(|run| run.code == Some(0)), "{runs:?}");
        assert_same(&place, &folder, "equal-0");
    }
}

/// Windows moves no folder with open files.
#[cfg(unix)]
#[test]
fn a_store_that_is_moved_or_removed_is_not_begun_twice() {
    for is_moved in [true, false] {
        let place = Place::with(SWEEP);
        let child = begun(&place, "out", 1);
        let store = place.path("out/scene.zarr");
        fs::rename(&store, place.path("moved.zarr")).unwrap();
        if !is_moved {
            fs::remove_dir_all(place.path("moved.zarr")).unwrap();
        }
        let run = Run::of(&child.wait_with_output().unwrap());
        run.assert_said(1, "error: ");
        assert!(!store.exists(), "{run:?}");
    }
    // In its place there is another store.
    let place = Place::with(SWEEP);
    let child = begun(&place, "out", 1);
    fs::rename(place.path("out"), place.path("moved")).unwrap();
    fs::create_dir(place.path("other")).unwrap();
    place.write("other/scene.toml", &SWEEP.replace("[0, 0.5, 1]", "[0, 0.6, 1]"));
    let arguments = [&["map", "other/scene.toml"], &MAP[2..], &["out", "--shard=0/8"]].concat();
    place.good(&arguments);
    let run = Run::of(&child.wait_with_output().unwrap());
    run.assert_said(1, "error: ");
    let run = place.run(&["status", "out/scene.zarr", "--verify"]);
    run.assert_said(1, "7 blocks are missing; `whiskmap map --format zarr --resume`");
}

#[test]
fn a_failed_extract_leaves_no_store() {
    let place = Place::with(SWEEP);
    good(&place, "out", &[]);
    let lost = "out/scene.zarr/force_un/c.0.1.2.0.0";
    fs::remove_file(place.path(lost)).unwrap();
    let run = place.run(&["extract", "out/scene.zarr", "-o", "x.zarr"]);
    run.assert_said(2, "out/scene.zarr is not finished: ");
    assert!(!place.path("x.zarr").exists());
    assert!(!files(&place.path("")).keys().any(|path| is_hidden(path)));
    good(&place, "out", &["--resume"]);
    place.good(&["extract", "out/scene.zarr", "-o", "x.zarr"]);
    assert_complete(&place, "x.zarr");
    fs::create_dir(place.path("full.zarr")).unwrap();
    place.write("full.zarr/notes.txt", "of somebody");
    let run = place.run(&["extract", "out/scene.zarr", "-o", "full.zarr"]);
    run.assert_said(2, "full.zarr: exists, and is neither a store nor an empty folder");
    assert_eq!(super::names(&place.path("full.zarr")), ["notes.txt"]);
}

/// The program, which may take 3 GB of memory.
#[cfg(unix)]
fn in_little_memory(place: &Place, arguments: &[&str]) -> Run {
    let mut shell = Command::new("sh");
    shell.args(["-c", "ulimit -v 3000000; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_whiskmap")]);
    let output = shell.args(arguments).current_dir(place.path("")).output();
    Run::of(&output.unwrap())
}

#[cfg(unix)]
#[test]
fn sizes_that_a_store_claims_are_not_allocated() {
    let place = Place::with(SMALL);
    let huge = "title = \"huge\"\nwhisker = { length_mm = 20, base_radius_um = 30, youngs_modulus_gpa = 3 }\n\
        [grid]\npush_angle_deg = { from = -9, to = 9, count = 2 }\ndistance_mm = { from = 2, to = 20, count = 2 }\n\
        taper = { from = 0.1, to = 0.9, count = 65536 }\npole_radius_mm = { from = 0.1, to = 0.2, count = 65536 }\n";
    let scene = whiskmap::scene::Scene::parse(huge, "huge.toml").unwrap();
    let about = whiskmap::store::MapDescription {
        scene: &scene,
        engine: &whiskmap::engine::EngineDescription::of(None),
        tolerances: &serde_json::Value::Null,
        channels: whiskmap::plan::Channels::STANDARD,
        digits: whiskmap::plan::Digits::ALL,
        arithmetic: "fma",
    };
    let path = place.path("huge.zarr");
    let store = whiskmap::store::ZarrStore::join(&path, &scene, &about, false).unwrap();
    store.begin(&whiskmap::store::TemporaryFiles::default()).unwrap();
    for output in ["x.csv", "x.npy", "x.zarr"] {
        let run =
            in_little_memory(&place, &["extract", "huge.zarr", "--channel=regime", "-o", output]);
        run.assert_said(2, "error: huge.zarr is not finished: ");
    }
    let run = in_little_memory(&place, &["status", "huge.zarr"]);
    run.assert_said(1, "blocks are missing; ");

    let root = fs::File::create(path.join("zarr.json")).unwrap();
    root.set_len(200 << 20).unwrap();
    let run = in_little_memory(&place, &["status", "huge.zarr"]);
    run.assert_said(2, "zarr.json is longer than 16 MiB");
}
