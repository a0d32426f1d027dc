//! Shards of a sweep in `whiskmap plan`: their blocks, cells, hours and bytes.

use super::{fact, plan_with};
use crate::cli::{Place, Run};

/// Returns the lines of shards, as words.
fn shards(run: &Run) -> Vec<Vec<&str>> {
    let lines = run.out.lines().filter(|line| line.starts_with("shard"));
    lines.map(|line| line.split_whitespace().collect()).collect()
}

/// Eight blocks of three whiskers each.
#[test]
fn shards_have_their_part_of_cells_hours_and_bytes() {
    let place = Place::with(crate::cli::store::SWEEP);
    let run = plan_with(&place, &["--shards", "3", "--channels", "regime,force_un"]);
    let lines = shards(&run);
    assert_eq!(lines.len(), 2, "{run:?}");
    // Tasks of `submit` run the CPU engine, which needs no GPU.
    let engine = "cpu f64: that of `submit`, unless --engine names another";
    assert_eq!(fact(&run, "engine"), engine);
    assert!(!run.out.contains("GPU"), "{run:?}");
    let sum: Vec<&str> = fact(&run, "sum").split_whitespace().collect();
    assert_eq!(sum[..4], ["8", "blocks,", "98304", "cells:"]);
    let hours = |line: &[&str]| line[line.len() - 4].parse::<f64>().unwrap();
    // Two digits of each number.
    let parts = 2.0 * hours(&lines[0]) + hours(&lines[1]);
    assert!((hours(&sum) / parts - 1.0).abs() < 0.06, "{run:?}");
    let chosen = plan_with(&place, &["--shards", "3", "--engine", "spectral"]);
    assert_eq!(fact(&chosen, "engine"), "spectral f64: selected by --engine");
    assert_eq!(lines[0][..6], ["shards", "0-1", "3", "blocks,", "36864", "cells:"]);
    assert_eq!(lines[1][..6], ["shard", "2", "2", "blocks,", "24576", "cells:"]);
    for line in &lines {
        let hours: f64 = line[7].parse().unwrap();
        assert!(line[8] == "CPU-hours," && hours > 0.0, "{run:?}");
    }
    assert!(!run.out.contains("EXR file"), "{run:?}");
    let one = plan_with(&place, &["--shard", "2/3", "--format", "zarr", "--threads", "1"]);
    assert_eq!(shards(&one)[0][..6], lines[1][..6]);
    assert!(!one.out.contains("\nsum "), "{one:?}");
    assert!(fact(&one, "time").contains(" on 1 thread, "), "{one:?}");
    let plan = |options: &[&str]| place.run(&[&["plan", "scene.toml"], options].concat());
    plan(&["--shards", "9"])
        .assert_refused(&["--shards 9: must be at most 8, the number of blocks"]);
    plan(&["--shards", "2", "--format", "exr"]).assert_refused(&["an EXR file has one writer"]);
    plan(&["--shards", "2", "--shard", "0/2"]).assert_refused(&["cannot be used with"]);
}
