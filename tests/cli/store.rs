//! `whiskmap map --format zarr` and `whiskmap status`: equal bytes for any processes, order and interruptions.

use super::{Place, Run};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
#[cfg(unix)]
use std::process::Command;
use std::process::{Child, Stdio};
use whiskmap::store::{StoredMap, ZarrStore};

/// Scene of eight blocks with three whiskers each.
pub const SWEEP: &str = r#"title = "A sweep in blocks"
[whisker]
length_mm = 20
base_radius_um = 30.0
youngs_modulus_gpa = 3.0
[grid]
push_angle_deg = { from = -70, to = 70, count = 64 }
distance_mm = { from = 2, to = 20, count = 64 }
taper = [0, 0.5, 1]
friction = [0, 0.3]
pole_radius_mm = { from = 0.1, to = 0.8, count = 4, scale = "log" }
"#;

pub const MAP: [&str; 5] = ["map", "scene.toml", "--engine=cpu", "--format=zarr", "-o"];

pub fn map(place: &Place, folder: &str, options: &[&str]) -> Run {
    place.run(&[&MAP[..], &[folder], options].concat())
}

pub fn good(place: &Place, folder: &str, options: &[&str]) -> Run {
    place.good(&[&MAP[..], &[folder], options].concat())
}

/// Returns every file below a folder, with its bytes.
pub fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_owned();
                found.insert(name, fs::read(path).unwrap());
            }
        }
    }
    found
}

pub fn assert_same(place: &Place, one: &str, other: &str) {
    let [one, other] = [one, other].map(|folder| files(&place.path(folder)));
    let names = |files: &BTreeMap<PathBuf, _>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&one), names(&other));
    for (name, bytes) in &one {
        assert!(*bytes == other[name], "{}", name.display());
    }
}

pub fn assert_complete(place: &Place, store: &str) {
    let run = place.quiet(&["status", store, "--verify"]);
    assert_eq!(run.count("of 8 blocks"), 8);
    assert_eq!(run.count("of 98304 cells"), 98304);
}

#[test]
fn a_store_has_the_values_of_the_map() {
    let two = SWEEP.replace("pole_radius_mm = {", "# {");
    has_the_values_of_the_map(&two);
    // All whiskers in one block.
    has_the_values_of_the_map(&two.replace("count = 64", "count = 20"));
}

/// A single panel of more than 2^18 cells, which is packed in two bands of rows.
#[test]
fn a_store_of_one_panel_in_bands_has_the_values_of_the_map() {
    let axes = SWEEP.find("taper").unwrap();
    let one = SWEEP[..axes].replace("base_radius_um", "tip_radius_um = 1.5\nbase_radius_um");
    has_the_values_of_the_map(&one.replace("count = 64", "count = 520"));
}

fn has_the_values_of_the_map(scene: &str) {
    let place = Place::with(scene);
    place.map(&["scene.toml", "-o", "exr", "--no-png"]);
    good(&place, "zarr", &[]);
    let exr = StoredMap::open(&place.path("exr/scene.exr")).unwrap();
    let zarr = ZarrStore::open(&place.path("zarr/scene.zarr")).unwrap();
    assert_eq!(zarr.scene.grid, exr.grid);
    for channel in exr.channels() {
        for whisker in 0..zarr.scene.whisker_count() {
            let [a, b] = [
                exr.read_panel(channel, whisker).unwrap(),
                zarr.read_panel(channel, whisker).unwrap(),
            ];
            let mut pairs = a.values().zip(b.values());
            let same = pairs.all(|(a, b)| a == b || a.is_nan() && b.is_nan());
            assert!(same, "{channel}, whisker {whisker}");
        }
    }
    assert!(zarr.read_panel("force", 0).is_err());
    // Counts have another shape than channels.
    assert!(zarr.read_panel("regime_cells", 0).is_err());
    place.quiet(&["status", "zarr/scene.zarr", "--verify"]);
}

#[test]
fn any_shards_in_any_order_give_one_store() {
    let place = Place::with(SWEEP);
    good(&place, "whole", &[]);
    assert_complete(&place, "whole/scene.zarr");

    good(&place, "parts", &["--shard=2/3", "--threads=1"]);
    let run = place.run(&["status", "parts/scene.zarr"]);
    assert_eq!(run.code, Some(1), "{run:?}");
    assert_eq!(run.count("of 8 blocks"), 2);
    assert!(run.out.contains("missing blocks: 0-1, 3-4, 6-7\n"), "{run:?}");
    assert!(run.err.contains("is incomplete: 6 blocks are missing; "), "{run:?}");

    // Two runs at once, then a repeated one.
    let spawn = |shard| {
        let arguments = [&MAP[..], &["parts", shard]].concat();
        let mut command = place.plain_command(&arguments);
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        command.spawn().unwrap()
    };
    let runs = ["--shard=0/3", "--shard=0/3", "--shard=1/3", "--shard=2/3"].map(spawn);
    for child in runs {
        let run = Run::of(&child.wait_with_output().unwrap());
        assert_eq!(run.code, Some(0), "{run:?}");
    }
    assert_same(&place, "whole", "parts");
    let run = good(&place, "parts", &["--resume"]);
    assert!(run.err.contains("blocks: 0 of 8"), "{run:?}");
    assert_same(&place, "whole", "parts");
}

/// Starts a run, and waits until it has finished `count` blocks.
pub fn begun(place: &Place, folder: &str, blocks: usize) -> Child {
    let arguments = [&MAP[..], &[folder, "--resume", "--threads=1"]].concat();
    let mut command = place.plain_command(&arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let regimes = place.path(folder).join("scene.zarr/regime");
    let done = || {
        let names = super::names(&regimes);
        names.iter().filter(|name| name.starts_with("c.")).count()
    };
    while done() < blocks {
        assert!(child.try_wait().unwrap().is_none(), "it ended early");
        std::thread::yield_now();
    }
    child
}

#[test]
fn an_interrupted_run_is_resumed_with_equal_bytes() {
    let place = Place::with(SWEEP);
    good(&place, "whole", &[]);
    for blocks in 0..7 {
        // With a count of 0, it is killed before or during the creation of the store.
        let mut child = begun(&place, "killed", blocks);
        child.kill().unwrap();
        child.wait().unwrap();
    }
    let run = good(&place, "killed", &["--resume"]);
    assert!(!run.err.contains("blocks: 8 of 8"), "{run:?}");
    assert_same(&place, "whole", "killed");
}

/// The kernel stops a writer in the middle of a file by an error as on a full disk, whether its signal is ignored or not.
#[cfg(unix)]
#[test]
fn a_file_that_grows_too_large_is_never_there_in_part() {
    let place = Place::with(SWEEP);
    good(&place, "whole", &[]);
    for ignored in ["", "trap '' XFSZ; "] {
        let script = format!("{ignored}ulimit -f 40; exec \"$0\" \"$@\"");
        let mut shell = Command::new("sh");
        shell.args(["-c", &script, env!("CARGO_BIN_EXE_whiskmap")]);
        shell.args(MAP).arg("torn").current_dir(place.path(""));
        let output = shell.output().unwrap();
        let run = Run::of(&output);
        run.assert_said(1, "error: cannot write torn/scene.zarr/");
        run.assert_said(1, ": File too large (os error 27)\n");
        let hidden = files(&place.path("torn")).into_keys();
        assert_eq!(hidden.filter(|path| is_hidden(path)).count(), 0);
        goes_on(&place);
        fs::remove_dir_all(place.path("torn")).unwrap();
    }
}

pub fn is_hidden(path: &Path) -> bool {
    path.file_name().unwrap().to_str().unwrap().starts_with('.')
}

/// Checks that all files of the store in the folder `torn` are complete, and that a resumed run finishes it.
#[cfg(unix)]
fn goes_on(place: &Place) {
    let whole = files(&place.path("whole"));
    for name in files(&place.path("torn")).keys() {
        if is_hidden(name) {
            continue;
        }
        let bytes = place.bytes(&format!("torn/{}", name.display()));
        assert!(bytes == whole[name], "{}", name.display());
    }
    let run = place.run(&["status", "torn/scene.zarr", "--verify"]);
    assert!(run.err.contains("missing") && !run.err.contains("damaged"), "{run:?}");
    good(place, "torn", &["--resume"]);
    assert_same(place, "whole", "torn");
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_prints_how_to_resume() {
    let place = Place::with(SWEEP);
    good(&place, "whole", &[]);
    let child = begun(&place, "out", 2);
    super::signals::send("TERM", &child);
    let run = Run::of(&child.wait_with_output().unwrap());
    assert_eq!(run.code, Some(143), "{run:?}");
    let said = "interrupted by SIGTERM; unfinished files are removed; finished blocks are kept: resume with the same command and --resume\n";
    assert!(run.err.ends_with(said), "{run:?}");
    assert!(!files(&place.path("out")).keys().any(|path| is_hidden(path)));
    good(&place, "out", &["--resume"]);
    assert_same(&place, "whole", "out");
}

#[test]
fn a_store_is_resumed_with_its_own_settings_only() {
    let place = Place::with(SWEEP);
    good(&place, ".", &["--shard=0/8"]);
    map(&place, ".", &[]).assert_refused(&["scene.zarr exists already", "--resume"]);
    map(&place, ".", &["--resume", "--channels=force_un"])
        .assert_refused(&["differs in `channels`: ", "regime, force_un here"]);
    map(&place, ".", &["--resume", "--tolerance=1e-3deg"])
        .assert_said(2, "differs in `tolerances`");
    place.write("scene.toml", &SWEEP.replace("[0, 0.5, 1]", "[0, 0.6, 1]"));
    map(&place, ".", &["--shard=1/8"]).assert_refused(&[
        "differs in `scene`: ",
        "`taper = [0, 0.5, 1]` in line 9 there, `taper = [0, 0.6, 1]` in line 9 here",
    ]);
    place
        .run(&["status", "nothing.zarr"])
        .assert_refused(&["cannot read nothing.zarr: ", "(os error 2)"]);
    fs::create_dir(place.path("empty")).unwrap();
    for command in
        [&["status", "empty"][..], &["render", "empty"], &["extract", "empty", "-o", "t.csv"]]
    {
        place
            .run(command)
            .assert_refused(&["error: empty is not a store: it has no zarr.json; give a folder"]);
    }
    place.write("zarr.json", "{}");
    place
        .run(&["status", "."])
        .assert_refused(&["is not a store of whiskmap", "`map SCENE --resume`"]);
    place
        .run(&["status", "scene.toml"])
        .assert_refused(&["error: scene.toml is not a store: it has no zarr.json; give a folder"]);
}

/// Nobody can create files in `/sys`, not even root.
#[cfg(unix)]
#[test]
fn a_store_that_cannot_be_written_is_refused_before_any_work() {
    let place = Place::with(SWEEP);
    good(&place, ".", &["--shard=0/8"]);
    let before = files(&place.path("scene.zarr"));
    let [force, aside] = ["scene.zarr/force_un", "aside"].map(|name| place.path(name));
    fs::rename(&force, &aside).unwrap();
    std::os::unix::fs::symlink("/sys", &force).unwrap();
    let run = map(&place, ".", &["--shard=1/8"]);
    run.assert_said(
        1,
        "error: cannot write ./scene.zarr/force_un/zarr.json: Permission denied (os error 13)\n",
    );
    assert_eq!(run.out, "");
    fs::remove_file(&force).unwrap();
    fs::rename(&aside, &force).unwrap();
    assert_eq!(files(&place.path("scene.zarr")), before);
}

#[test]
fn an_exr_file_refuses_what_only_a_store_can() {
    let place = Place::with(SWEEP);
    let exr =
        |options: &[&str]| place.run(&[&["map", "scene.toml", "--engine=cpu"], options].concat());
    exr(&[]).assert_refused(&[
        "two sweep axes, the scene has taper, friction, pole_radius_mm",
        "--format zarr",
    ]);
    place.write("scene.toml", &SWEEP.replace("pole_radius_mm = {", "# {"));
    exr(&["--resume"]).assert_refused(&["--resume", "--format zarr"]);
    exr(&["--shard=0/2"]).assert_refused(&["--shard", "--format zarr"]);
    for shard in ["2/2", "-1/2", "1", "a/b", "0/0"] {
        exr(&[&format!("--shard={shard}")]).assert_refused(&["must be I/N"]);
    }
    exr(&["--channels=force_un"]).assert_refused(&["--channels: must have regime", "--no-png"]);
    exr(&["--channels=force"]).assert_refused(&["names with commas", "force_un"]);
}

#[test]
fn channels_that_are_not_wanted_are_not_stored() {
    let scene = SWEEP.replace("pole_radius_mm = {", "# {");
    // With friction, `status` is stored too.
    let place = Place::with(&scene.replace("friction =", "# "));
    place.map(&["scene.toml", "-o", "all"]);
    place.map(&["scene.toml", "-o", "some", "--channels", "regime,force_un"]);
    good(&place, "some", &["--channels", "force_un"]);
    let [all, some] = ["all", "some"]
        .map(|folder| StoredMap::open(&place.path(&format!("{folder}/scene.exr"))).unwrap());
    assert_eq!(some.channels(), ["regime", "force_un"]);
    for name in some.channels() {
        let [all, some] = [&all, &some].map(|map| map.read_channel(name).unwrap());
        let mut pairs = all.values().zip(some.values());
        assert!(pairs.all(|(a, b)| a == b || a.is_nan() && b.is_nan()), "{name}");
    }
    assert!(some.read_channel("status").is_err());
    let store = ZarrStore::open(&place.path("some/scene.zarr")).unwrap();
    assert_eq!(store.channels.to_string(), "regime, force_un");
    let place = place.path("some/scene.zarr");
    assert!(place.join("force_un").exists() && !place.join("status").exists());
}
