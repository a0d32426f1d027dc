//! Damaged stores, and stores with files of other stores.

use super::integrity::SMALL;
use super::store::{SWEEP, assert_same, files, good, map};
use super::{Place, Run};
use std::fs;
use std::path::Path;

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
    run.assert_said(1, "1 block is missing, 1 block is damaged");
    let run = status(&place, "--verify");
    run.assert_said(1, "status/c.0.1.0.0.0 is damaged: chunk 0 does not have its checksum");
    run.assert_said(1, "1 block is missing, 2 blocks are damaged");
    assert!(run.out.contains("damaged blocks: "), "{run:?}");
    let run = good(&place, "out", &["--resume"]);
    assert!(run.err.contains("blocks: 3 of 8"), "{run:?}");
    assert!(run.err.contains("warning: "), "{run:?}");
    assert_same(&place, "whole", "out");

    damage();
    let run = status(&place, "--repair");
    run.assert_said(1, "1 block is missing, 2 blocks are damaged");
    assert!(run.out.contains("blocks removed: 2\n"), "{run:?}");
    let run = status(&place, "--verify");
    run.assert_said(1, "3 blocks are missing; ");
    good(&place, "out", &["--resume"]);
    assert_same(&place, "whole", "out");
}

/// Each file of metadata is removed, then overwritten with zeros.
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
            // Without its root, the folder is not a store.
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
    fs::write(&root, text.replacen("base_radius_um = 30.0", "base_radius_um = 31.0", 1)).unwrap();
    for arguments in [
        &["status", "out/scene.zarr"][..],
        &["extract", "out/scene.zarr", "-o", "x.csv"],
        &["render", "out/scene.zarr", "-o", "x.png"],
    ] {
        place.run(arguments).assert_said(2, "zarr.json is damaged: its `identity` does not fit");
    }
    let run = good(&place, "out", &["--resume"]);
    assert!(run.err.contains("zarr.json was damaged: rewritten"), "{run:?}");
    assert_same(&place, "whole", "out");

    // A run with other settings must not accept or overwrite the blocks.
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

/// The root of a store is replaced by another store's root. No block is removed or overwritten.
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
        let is_block = name.file_name().unwrap().to_str().unwrap().starts_with("c.0.");
        assert!(!is_block || bytes == before[&name], "{}", name.display());
    }
}

/// The files of two arrays lie in each other's folder, where no file has the right name. They still belong to the store.
#[test]
fn arrays_in_each_others_folder_are_computed_again() {
    let place = Place::with(SMALL);
    for channels in ["regime", "regime,force_un"] {
        let only = ["--channels", channels];
        good(&place, "whole", &only);
        for option in ["--verify", "--repair"] {
            good(&place, "out", &only);
            let folder = |name: &str| place.path("out/scene.zarr").join(name);
            for (from, to) in
                [("regime", "aside"), ("regime_cells", "regime"), ("aside", "regime_cells")]
            {
                fs::rename(folder(from), folder(to)).unwrap();
            }
            status(&place, option).assert_said(1, "1 block is missing");
            let run = good(&place, "out", &[&only[..], &["--resume"]].concat());
            assert!(run.err.contains("blocks: 1 of 1"), "{run:?}");
            for (name, bytes) in files(&place.path("whole")) {
                let found = fs::read(place.path("out").join(&name)).unwrap();
                assert!(found == bytes, "{}", name.display());
            }
            assert_eq!(status(&place, "--verify").code, Some(0));
            fs::remove_dir_all(place.path("out")).unwrap();
        }
        fs::remove_dir_all(place.path("whole")).unwrap();
    }
}

#[test]
fn a_folder_of_others_is_no_store() {
    let place = Place::with(SMALL);
    fs::create_dir_all(place.path("out/scene.zarr/taper")).unwrap();
    place.write("out/scene.zarr/taper/zarr.json", "of somebody");
    let run = map(&place, "out", &[]);
    run.assert_said(2, "is not a store of whiskmap: it has files, but no zarr.json");
    assert_eq!(place.bytes("out/scene.zarr/taper/zarr.json"), b"of somebody");
    for root in ["[]", "1", "\"x\"", "null", "{}", "{\"attributes\": 1}"] {
        place.write("out/scene.zarr/zarr.json", root);
        status(&place, "--verify").assert_said(2, "it has no attributes");
        map(&place, "out", &["--resume"]).assert_said(2, "it has no attributes");
    }
}

/// A pipe without a writer would never open, and a circle of links may hide a whole file.
#[cfg(unix)]
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
    let before = super::names(&place.path("out/scene.zarr/force_un"));
    let run = status(&place, "--repair");
    run.assert_said(1, "cannot read out/scene.zarr/force_un/c.0.0.0: ");
    assert!(run.out.contains("blocks removed: 0"), "{run:?}");
    assert_eq!(super::names(&place.path("out/scene.zarr/force_un")), before);
    let run = map(&place, "out", &["--resume"]);
    run.assert_said(2, "cannot read out/scene.zarr/force_un/c.0.0.0: ");
}

#[test]
fn scenes_that_differ_in_line_endings_are_distinguished() {
    let place = Place::with(SMALL);
    good(&place, "out", &[]);
    place.write("scene.toml", &SMALL.replace('\n', "\r\n"));
    let run = map(&place, "out", &["--resume"]);
    run.assert_said(2, "differs in `scene`: line endings there, other line endings here");
}
