//! Stores that several runs create at once, that are damaged, or that are moved while a run fills them.

use crate::store::{MAP, SWEEP, assert_complete, assert_same, begun, files, good, is_hidden, map};
use crate::{Place, Run};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// One block of two whiskers.
const SMALL: &str = r#"title = "One block"
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

/// Of both runs one completes, and the other one is refused and names what differs.
fn assert_one_succeeds(place: &Place, folder: &str, runs: &[Run; 2], said: &str) {
    let [one, other] = runs;
    let (winner, loser) = if one.code == Some(0) {
        (one, other)
    } else {
        (other, one)
    };
    assert_eq!(winner.code, Some(0), "{runs:?}");
    loser.assert_said(2, said);
    let status = place.run(&["status", &format!("{folder}/scene.zarr"), "--verify"]);
    assert_eq!(status.code, Some(0), "{status:?}");
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
        assert_one_succeeds(
            &place,
            &folder,
            &runs,
            "differs in `scene`: `taper = [0, 0.",
        );
        let folder = format!("tolerances-{number}");
        let runs = race(&place, &folder, [a; 2], [exact, "--tolerance=1e-3deg"]);
        assert_one_succeeds(&place, &folder, &runs, "differs in `tolerances`: ");
        let folder = format!("equal-{number}");
        let runs = race(&place, &folder, [a; 2], [exact; 2]);
        assert!(runs.iter().all(|run| run.code == Some(0)), "{runs:?}");
        assert_same(&place, &folder, "equal-0");
    }
}

fn status(place: &Place, option: &str) -> Run {
    place.run(&["status", "out/scene.zarr", option])
}

#[test]
fn torn_and_missing_files_are_found_and_computed_again() {
    let place = Place::with(SWEEP);
    good(&place, "out", &[]);
    fs::rename(place.path("out"), place.path("whole")).unwrap();
    good(&place, "out", &[]);
    let torn = place.path("out/scene.zarr/force_un/c.0.1.2.0.0");
    let bytes = fs::read(&torn).unwrap();
    let flipped = place.path("out/scene.zarr/status/c.0.1.0.0.0");
    let damage = || {
        fs::write(&torn, &bytes[..bytes.len() / 2]).unwrap();
        let mut bytes = fs::read(&flipped).unwrap();
        bytes[50] ^= 1;
        fs::write(&flipped, bytes).unwrap();
        fs::remove_file(place.path("out/scene.zarr/status/c.0.0.0.0.0")).unwrap();
    };
    damage();
    // The length and the index show the torn file, not the flipped bit.
    let run = status(&place, "--");
    run.assert_said(1, "force_un/c.0.1.2.0.0 is damaged");
    run.assert_said(1, "1 blocks are missing, 1 are damaged");
    let run = status(&place, "--verify");
    run.assert_said(
        1,
        "status/c.0.1.0.0.0 is damaged: chunk 0 does not have its checksum",
    );
    run.assert_said(1, "1 blocks are missing, 2 are damaged");
    assert!(run.out.contains("damaged blocks: "), "{run:?}");
    let run = good(&place, "out", &["--resume"]);
    assert!(run.err.contains("blocks: 3 of 8"), "{run:?}");
    assert!(run.err.contains("warning: "), "{run:?}");
    assert_same(&place, "whole", "out");

    damage();
    let run = status(&place, "--repair");
    run.assert_said(1, "1 blocks are missing, 2 are damaged");
    assert!(run.out.contains("blocks removed: 2\n"), "{run:?}");
    let run = status(&place, "--verify");
    run.assert_said(1, "3 blocks are missing, 0 are damaged");
    good(&place, "out", &["--resume"]);
    assert_same(&place, "whole", "out");
}

/// Every file of metadata, removed and overwritten with zeros.
#[test]
fn metadata_are_compared_with_the_scene_and_written_again() {
    let place = Place::with(SMALL);
    good(&place, "out", &[]);
    fs::rename(place.path("out"), place.path("whole")).unwrap();
    good(&place, "out", &[]);
    let names = files(&place.path("whole"));
    let is_metadata = |name: &&Path| {
        let axes = ["regime_code", "taper", "distance_mm", "push_angle_deg"];
        let is_axis = |axis: &&str| name.parent().unwrap().ends_with(axis);
        name.ends_with("zarr.json") || axes.iter().any(is_axis)
    };
    let names: Vec<&Path> = names.keys().map(|name| &**name).collect();
    let mut tried = 0;
    for name in names.into_iter().filter(is_metadata) {
        let file = place.path("out").join(name);
        let bytes = fs::read(&file).unwrap();
        let is_root = name.parent() == Some(Path::new("scene.zarr"));
        for is_removed in [true, false] {
            let spoil = || {
                if is_removed {
                    fs::remove_file(&file).unwrap();
                } else {
                    fs::write(&file, vec![0; bytes.len()]).unwrap();
                }
            };
            spoil();
            // Without its root it is no store.
            let code = if is_root { 2 } else { 1 };
            let run = status(&place, "--verify");
            run.assert_said(code, name.file_name().unwrap().to_str().unwrap());
            if !is_root {
                let run = status(&place, "--repair");
                assert_eq!(run.code, Some(0), "{run:?}");
                assert_same(&place, "whole", "out");
                spoil();
            }
            let run = good(&place, "out", &["--resume"]);
            assert!(run.err.contains("blocks: 0 of 1"), "{run:?}");
            assert_same(&place, "whole", "out");
            tried += 1;
        }
    }
    assert_eq!(tried, 2 * (1 + 4 * 2 + 15));
}

#[test]
fn an_edited_scene_is_found_and_the_scene_of_the_run_written_again() {
    let place = Place::with(SMALL);
    good(&place, "whole", &[]);
    good(&place, "out", &[]);
    let root = place.path("out/scene.zarr/zarr.json");
    let text = fs::read_to_string(&root).unwrap();
    fs::write(
        &root,
        text.replacen("base_radius_um = 30.0", "base_radius_um = 31.0", 1),
    )
    .unwrap();
    for arguments in [
        &["status", "out/scene.zarr"][..],
        &["extract", "out/scene.zarr", "-o", "x.csv"],
        &["render", "out/scene.zarr", "-o", "x.png"],
    ] {
        place
            .run(arguments)
            .assert_said(2, "zarr.json is damaged: its `identity` does not fit");
    }
    let run = good(&place, "out", &["--resume"]);
    assert!(
        run.err.contains("zarr.json was damaged: written again"),
        "{run:?}"
    );
    assert_same(&place, "whole", "out");

    // Another run must not take the blocks for its own, nor overwrite them.
    let other = SMALL.replace("base_radius_um = 30.0", "base_radius_um = 31.0");
    for damage in ["", "no JSON"] {
        fs::remove_file(&root).unwrap();
        if !damage.is_empty() {
            fs::write(&root, damage).unwrap();
        }
        place.write("scene.toml", &other);
        for option in ["--resume", "--shard=0/1"] {
            let run = map(&place, "out", &[option]);
            assert_eq!(run.code, Some(2), "{run:?}");
        }
        place.write("scene.toml", SMALL);
        good(&place, "out", &["--resume"]);
        assert_same(&place, "whole", "out");
    }
}

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
    place.write(
        "other/scene.toml",
        &SWEEP.replace("[0, 0.5, 1]", "[0, 0.6, 1]"),
    );
    let arguments = [
        &["map", "other/scene.toml"],
        &MAP[2..],
        &["out", "--shard=0/8"],
    ]
    .concat();
    assert_eq!(place.run(&arguments).code, Some(0));
    let run = Run::of(&child.wait_with_output().unwrap());
    run.assert_said(1, "error: ");
    let run = place.run(&["status", "out/scene.zarr", "--verify"]);
    run.assert_said(1, "7 blocks are missing, 0 are damaged");
}

#[test]
fn a_failed_extract_leaves_no_store() {
    let place = Place::with(SWEEP);
    good(&place, "out", &[]);
    let lost = "out/scene.zarr/force_un/c.0.1.2.0.0";
    fs::remove_file(place.path(lost)).unwrap();
    let run = place.run(&["extract", "out/scene.zarr", "-o", "x.zarr"]);
    run.assert_said(2, "c.0.1.2.0.0 is not there");
    assert!(!place.path("x.zarr").exists());
    assert!(!files(&place.path("")).keys().any(|path| is_hidden(path)));
    good(&place, "out", &["--resume"]);
    let run = place.run(&["extract", "out/scene.zarr", "-o", "x.zarr"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    assert_complete(&place, "x.zarr");
    fs::create_dir(place.path("full.zarr")).unwrap();
    place.write("full.zarr/notes.txt", "of somebody");
    let run = place.run(&["extract", "out/scene.zarr", "-o", "full.zarr"]);
    run.assert_said(
        2,
        "full.zarr: is there, and neither a store nor an empty folder",
    );
    assert_eq!(crate::names(&place.path("full.zarr")), ["notes.txt"]);
}

/// The program, which may take 3 GB of memory.
fn in_little_memory(place: &Place, arguments: &[&str]) -> Run {
    let mut shell = Command::new("sh");
    shell.args([
        "-c",
        "ulimit -v 3000000; exec \"$0\" \"$@\"",
        env!("CARGO_BIN_EXE_whiskmap"),
    ]);
    let output = shell.args(arguments).current_dir(place.path("")).output();
    Run::of(&output.unwrap())
}

#[test]
fn sizes_that_a_store_claims_are_not_allocated() {
    let place = Place::with(SMALL);
    let huge = "title = \"huge\"\nwhisker = { length_mm = 20, base_radius_um = 30, youngs_modulus_gpa = 3 }\n\
        [grid]\npush_angle_deg = { from = -9, to = 9, count = 2 }\ndistance_mm = { from = 2, to = 20, count = 2 }\n\
        taper = { from = 0.1, to = 0.9, count = 65536 }\npole_radius_mm = { from = 0.1, to = 0.2, count = 65536 }\n";
    let scene = whiskmap::scene::Scene::parse(huge, "huge.toml").unwrap();
    let about = whiskmap::store::Description {
        scene: &scene,
        engine: &whiskmap::integrate::Description::of(None),
        tolerances: &serde_json::Value::Null,
        channels: whiskmap::plan::Channels::ALL,
        arithmetic: "fma",
    };
    let path = place.path("huge.zarr");
    let store = whiskmap::store::ZarrStore::join(&path, &scene, &about, false).unwrap();
    store.begin().unwrap();
    for output in ["x.csv", "x.npy", "x.zarr"] {
        let run = in_little_memory(
            &place,
            &["extract", "huge.zarr", "--channel=regime", "-o", output],
        );
        run.assert_said(2, "is not there: the store is not complete");
    }
    let run = in_little_memory(&place, &["status", "huge.zarr"]);
    run.assert_said(1, "blocks are missing, 0 are damaged");

    let root = fs::File::create(path.join("zarr.json")).unwrap();
    root.set_len(200 << 20).unwrap();
    let run = in_little_memory(&place, &["status", "huge.zarr"]);
    run.assert_said(2, "zarr.json is longer than 16 MiB");
}

/// Blocks of a store whose root was replaced by another one's: the root is wrong, so no block is removed or overwritten.
#[test]
fn blocks_under_a_wrong_root_stay() {
    let place = Place::with(SMALL);
    good(&place, "out", &[]);
    place.write("scene.toml", &SMALL.replace("[0, 0.5]", "[0, 0.6]"));
    good(&place, "other", &[]);
    let root = "out/scene.zarr/zarr.json";
    fs::copy(place.path("other/scene.zarr/zarr.json"), place.path(root)).unwrap();
    let before = files(&place.path("out"));
    let run = status(&place, "--repair");
    run.assert_said(2, "scene.zarr has blocks of another scene, version");
    assert!(files(&place.path("out")).keys().eq(before.keys()));
    let run = map(&place, "out", &["--resume"]);
    run.assert_said(2, "scene.zarr has blocks of another scene, version");
    for (name, bytes) in files(&place.path("out")) {
        let is_block = name
            .file_name()
            .unwrap()
            .to_str()
            .unwrap()
            .starts_with("c.0.");
        assert!(!is_block || bytes == before[&name], "{}", name.display());
    }
}

#[test]
fn a_folder_of_others_is_no_store() {
    let place = Place::with(SMALL);
    fs::create_dir_all(place.path("out/scene.zarr/taper")).unwrap();
    place.write("out/scene.zarr/taper/zarr.json", "of somebody");
    let run = map(&place, "out", &[]);
    run.assert_said(
        2,
        "is not a store of whiskmap: it has files, but no zarr.json",
    );
    assert_eq!(
        place.bytes("out/scene.zarr/taper/zarr.json"),
        b"of somebody"
    );
    for root in ["[]", "1", "\"x\"", "null", "{}", "{\"attributes\": 1}"] {
        place.write("out/scene.zarr/zarr.json", root);
        status(&place, "--verify").assert_said(2, "it has no attributes");
        map(&place, "out", &["--resume"]).assert_said(2, "it has no attributes");
    }
}

/// A pipe without a writer would never open, and a circle of links may hide a whole file.
#[test]
fn what_is_no_file_is_neither_read_nor_removed() {
    let place = Place::with(SMALL);
    good(&place, "out", &[]);
    let coordinate = place.path("out/scene.zarr/taper/c.0");
    fs::remove_file(&coordinate).unwrap();
    place.pipe("out/scene.zarr/taper/c.0");
    status(&place, "--verify").assert_said(1, "taper/c.0 is no regular file");
    status(&place, "--repair").assert_said(2, "taper/c.0 is no regular file");
    map(&place, "out", &["--resume"]).assert_said(2, "taper/c.0 is no regular file");
    fs::remove_file(&coordinate).unwrap();
    good(&place, "out", &["--resume"]);

    let chunk = place.path("out/scene.zarr/force_un/c.0.0.0");
    fs::remove_file(&chunk).unwrap();
    std::os::unix::fs::symlink("c.0.0.0", &chunk).unwrap();
    let before = crate::names(&place.path("out/scene.zarr/force_un"));
    let run = status(&place, "--repair");
    run.assert_said(1, "cannot read out/scene.zarr/force_un/c.0.0.0: ");
    assert!(run.out.contains("blocks removed: 0"), "{run:?}");
    assert_eq!(crate::names(&place.path("out/scene.zarr/force_un")), before);
    let run = map(&place, "out", &["--resume"]);
    run.assert_said(2, "cannot read out/scene.zarr/force_un/c.0.0.0: ");
}

#[test]
fn scenes_that_differ_in_line_endings_are_told_apart() {
    let place = Place::with(SMALL);
    good(&place, "out", &[]);
    place.write("scene.toml", &SMALL.replace('\n', "\r\n"));
    let run = map(&place, "out", &["--resume"]);
    run.assert_said(
        2,
        "differs in `scene`: line endings there, other line endings here",
    );
}
