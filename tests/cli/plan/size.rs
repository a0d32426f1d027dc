//! Sizes of files, and memory, that `whiskmap plan` prints.

#[cfg(target_os = "linux")]
use super::fact;
use super::{STRAIGHT, bytes, memory_mib, plan};
use crate::cli::Place;
#[cfg(target_os = "linux")]
use crate::cli::Run;

/// Returns the bytes of all files below a folder.
fn size(path: &std::path::Path) -> u64 {
    let files = || path.read_dir().unwrap().map(|entry| entry.unwrap().path());
    if path.is_dir() {
        files().map(|path| size(&path)).sum()
    } else {
        path.metadata().unwrap().len()
    }
}

/// The sample is 4 of 9 whiskers with all their lines. The estimate lacks headers: 4 KB, and 15 files of metadata.
#[test]
fn the_size_of_files_is_estimated() {
    let sweep = STRAIGHT.replace("tip_radius_um = 30\n", "");
    let sweep = sweep.replace("count = 8", "count = 200");
    let sweep = sweep.replace("[5.0, 10.0]", "{ from = 2, to = 20, count = 200 }");
    let axes = "taper = [0, 0.4, 0.8]\nfriction = [0, 0.2, 0.4]\n";
    let place = Place::with(&format!("{sweep}{axes}"));
    let run = plan(&place);
    place.map(&["scene.toml", "--no-png"]);
    place.map(&["scene.toml", "--format", "zarr"]);
    for (format, name) in [("EXR file", "scene.exr"), ("Zarr store", "scene.zarr")] {
        let (foretold, found) = (bytes(&run, format), size(&place.path("outputs").join(name)));
        let ratio = foretold / found as f64;
        assert!((0.9..1.1).contains(&ratio), "{format}: {foretold}, {found}");
    }
    place.write("scene.toml", &format!("{sweep}{axes}pole_radius_mm = [0.1, 0.2]\n"));
    let run = plan(&place);
    assert!(!run.out.contains("EXR file"), "{run:?}");
}

/// A single panel is in bands of rows. Only a store keeps the packed panels of a block.
#[test]
fn the_memory_of_a_store_includes_its_block() {
    let scene = STRAIGHT.replace("count = 8", "count = 2048");
    let scene = scene.replace("[5.0, 10.0]", "{ from = 2, to = 20, count = 1024 }");
    let run = plan(&Place::with(&scene));
    let [exr, zarr] = ["EXR file", "Zarr store"].map(|format| memory_mib(&run, format));
    assert_eq!(zarr, exr);
    let axes = "friction = { from = 0, to = 0.5, count = 512 }\n";
    let scene = scene.replace("count = 2048", "count = 128");
    let scene = scene.replace("count = 1024", "count = 128");
    let run = plan(&Place::with(&format!("{scene}{axes}")));
    let [exr, zarr] = ["EXR file", "Zarr store"].map(|format| memory_mib(&run, format));
    // A group has 16 panels; a block has 4, which take no more.
    assert_eq!(zarr, exr);
    let axes = "friction = { from = 0, to = 0.5, count = 8192 }\n";
    let run = plan(&Place::with(&format!("{scene}{axes}")));
    let [exr, zarr] = ["EXR file", "Zarr store"].map(|format| memory_mib(&run, format));
    // A block has 64 panels of 32 packed bytes a cell, and another one is written meanwhile.
    assert_eq!(zarr - exr, ((2 * 64 - 16) * 128 * 128 * 32) >> 20);
}

/// All whiskers together would take 24 GB.
#[cfg(target_os = "linux")]
#[test]
fn a_large_sweep_is_never_held() {
    let whisker = STRAIGHT.replace("tip_radius_um = 30\n", "");
    let whisker = whisker.replace("{ from = 5, to = 70, count = 8 }", "[5]");
    let whisker = whisker.replace("[5.0, 10.0]", "[9]");
    let axes = "taper = { from = 0, to = 0.95, count = 4096 }\n\
                curvature_per_mm = { from = 0, to = 0.04, count = 65536 }\n";
    let place = Place::with(&format!("{whisker}{axes}"));
    let bounded = |command: &str| {
        let limited = format!("ulimit -v {}; {command}", 8 << 20);
        let mut shell = std::process::Command::new("sh");
        let program = env!("CARGO_BIN_EXE_whiskmap");
        let shell = shell.args(["-c", &limited, program]).current_dir(place.path(""));
        Run::of(&shell.output().unwrap())
    };
    let run = bounded("\"$0\" plan scene.toml");
    assert_eq!(run.code, Some(0), "{run:?}");
    let cells = "268435456: 1 push angle x 1 distance x 268435456 whiskers";
    assert_eq!(fact(&run, "cells"), cells);
    // `plan` ends when its reader ends.
    let run = bounded("\"$0\" curve scene.toml | head -n 2");
    assert_eq!((run.out.lines().count(), &*run.err), (2, ""), "{run:?}");
}
