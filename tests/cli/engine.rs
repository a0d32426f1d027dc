//! Selection of engine and adapter by `map`.

use super::store::{SWEEP, assert_same};
use super::{Place, Run, SCENE};
use crate::shipped;
use std::fs;
use whiskmap::store::StoredMap;

fn said(run: &Run) -> &str {
    assert_eq!(run.code, Some(0), "{run:?}");
    run.assert_settled();
    run.err.strip_prefix("engine: ").unwrap().trim_end()
}

#[test]
fn auto_does_not_start_a_gpu_for_a_small_map() {
    let place = Place::with(SCENE);
    let run = place.run(&["map", "scene.toml", "--no-png"]);
    let said = said(&run);
    assert!(said.starts_with("cpu f64 on "), "{said}");
    let counts = "(auto: at most 288 cells a side, expansions cost 672; a GPU is not timed below 0.1 s on all threads)";
    assert!(said.ends_with(counts), "{said}");
}

/// Rows of 256 cells on each side: the map takes less time with a net, and is too small for a GPU.
#[test]
fn auto_takes_the_net_where_the_counts_say_so() {
    let place = wide();
    let run = place.run(&["map", "scene.toml", "--no-png"]);
    let said = said(&run);
    assert!(said.starts_with("spectral f64 on "), "{said}");
    // What follows depends on how busy the machine is.
    let counts = "(auto: at most 6144 cells a side, expansions cost 672; ";
    assert!(said.contains(counts), "{said}");
    let plan = place.run(&["plan", "scene.toml"]);
    let line = "engine        spectral f64: at most 6144 cells a side, expansions cost 672";
    assert!(plan.out.contains(line), "{plan:?}");
}

/// The bound on residuals follows the tolerance; below the residual of refined states, nothing is expanded.
#[test]
fn a_tolerance_chooses_the_bound_of_expansions() {
    let place = wide();
    let mut bounds = Vec::new();
    for (tolerance, is_expanded) in [("1e-3deg", true), ("1e-6deg", true), ("1e-9deg", false)] {
        let arguments =
            ["map", "scene.toml", "--engine=spectral", "--no-png", "--tolerance", tolerance];
        let run = place.good(&arguments);
        let line = run.err.lines().find(|line| line.starts_with("accuracy: ")).unwrap();
        let bound = line.strip_prefix("accuracy: residuals of at most ").unwrap();
        let bound: f64 = bound.strip_suffix(" of the length").unwrap().parse().unwrap();
        let solved = run.count("solved by the engine spectral f64");
        assert_eq!(solved > 0, is_expanded, "{run:?}");
        let map = StoredMap::open(&place.path("outputs/scene.exr")).unwrap();
        let residuals = map.read_channel("residual").unwrap();
        let worst = residuals.values().fold(0.0, f64::max);
        assert!(worst <= bound.max(1e-12), "{tolerance}: {worst:e} {bound:e}");
        bounds.push(bound);
    }
    // The nearest pole is at a tenth of the length.
    for (bound, tolerance) in bounds.iter().zip([1e-3_f64, 1e-6, 1e-9]) {
        assert!(*bound <= 0.1 * tolerance.to_radians() * 1.05, "{bounds:?}");
    }
    assert!(bounds[0] > 100.0 * bounds[1], "{bounds:?}");
}

#[test]
fn the_cpu_engine_has_no_adapter_and_no_other_precision() {
    let place = Place::with(SCENE);
    let map = |arguments: &[&str]| place.run(&[&["map", "scene.toml"], arguments].concat());
    let f32 = ["--precision f32", "f64", "--engine gpu"];
    map(&["--engine", "cpu", "--precision", "f32"]).assert_refused(&f32);
    map(&["--precision", "f32"]).assert_refused(&f32);
    let adapter = ["--adapter 0", "CPU engine", "--engine gpu"];
    map(&["--engine", "cpu", "--adapter", "0"]).assert_refused(&adapter);
    said(&map(&["--precision", "f64", "--no-png"]));
    assert!(!place.path("outputs/scene.png").exists());
}

/// The small map with enough columns for expansions of its rows.
fn wide() -> Place {
    Place::with(&SCENE.replace("to = 70, count = 24", "to = 70, count = 512"))
}

#[test]
fn the_spectral_engine_is_named_with_its_cells() {
    let place = wide();
    let run = place.run(&["map", "scene.toml", "--engine", "spectral", "--no-png"]);
    let line = said(&run);
    assert!(line.starts_with("spectral f64 on "), "{line}");
    assert!(line.ends_with("(selected by --engine)"), "{line}");
    // All cells with a state.
    let solved = run.count("solved by the engine spectral f64");
    assert_eq!(solved, run.count("contact"), "{run:?}");
    assert!(run.count("of the engine's cells audited in f64") > 0);
    assert!(run.out.contains(", cells "), "{run:?}");
    assert!(!run.out.contains("waited for"), "{run:?}");
    let map = StoredMap::open(&place.path("outputs/scene.exr")).unwrap();
    assert_eq!(map.attribute("engine").unwrap(), "spectral f64");
}

#[test]
fn the_spectral_engine_has_no_adapter_and_no_other_precision() {
    let place = Place::with(SCENE);
    let map = |arguments: &[&str]| {
        let spectral = ["map", "scene.toml", "--engine", "spectral"];
        place.run(&[&spectral, arguments].concat())
    };
    map(&["--precision", "f32"]).assert_refused(&["--precision f32", "f64", "--engine gpu"]);
    map(&["--adapter", "0"]).assert_refused(&["--adapter 0", "spectral engine", "--engine gpu"]);
}

#[test]
fn measured_radii_warn_that_every_cell_falls_back() {
    let place = Place::with(SCENE);
    let scenes = shipped::root().join("scenes");
    let text = |name: &str| fs::read_to_string(scenes.join(name)).unwrap();
    place.write("measured.csv", &text("measured.csv"));
    let small = text("measured.toml").replace("count = 512", "count = 40");
    place.write("measured.toml", &small);
    let run = place.good(&["map", "measured.toml", "--engine", "spectral", "--no-png"]);
    let warning = "warning: --engine spectral: a whisker with measured radii has no expansions; the CPU engine solves every cell";
    assert!(run.err.starts_with(warning), "{run:?}");
    assert_eq!(run.count("solved by the engine spectral f64"), 0);
    // Regimes need no expansions.
    let run = place.run(&["map", "measured.toml", "--no-png", "--channels=regime"]);
    assert!(run.err.starts_with("engine: spectral f64 on "), "{run:?}");
    assert!(run.count("solved by the engine spectral f64") > 0);
}

/// Shards and a resumed run write the bytes of a single run; a store keeps its engine.
#[test]
fn a_store_by_the_spectral_engine_is_resumed_with_the_same_bytes() {
    let place = Place::with(&SWEEP.replace("to = 70, count = 64", "to = 70, count = 256"));
    let map = |engine: &str, folder: &str, options: &[&str]| {
        let map = ["map", "scene.toml", "--format=zarr", engine, "-o", folder];
        place.run(&[&map, options].concat())
    };
    let spectral = |folder: &str, options: &[&str]| {
        let run = map("--engine=spectral", folder, options);
        assert_eq!(run.code, Some(0), "{run:?}");
        assert!(run.err.starts_with("engine: spectral f64 ("), "{run:?}");
        run
    };
    let run = spectral("whole", &[]);
    assert!(run.count("solved by the engine spectral f64") > 0, "{run:?}");
    for shard in ["0/2", "1/2"] {
        spectral("parts", &["--shard", shard, "--resume", "--threads", "1"]);
    }
    assert_same(&place, "whole", "parts");
    fs::remove_file(place.path("parts/scene.zarr/regime/c.0.0.0.0.0")).unwrap();
    map("--engine=cpu", "parts", &["--resume"]).assert_refused(&["engine", "spectral f64"]);
    spectral("parts", &["--resume"]);
    assert_same(&place, "whole", "parts");
}
