//! `whiskmap plan`.

use super::{Place, Run, SCENE, names};

const STRAIGHT: &str = r#"title = "A straight cylinder"
[whisker]
length_mm = 20
base_radius_um = 30
tip_radius_um = 30
youngs_modulus_gpa = 3
[grid]
push_angle_deg = { from = 5, to = 70, count = 8 }
distance_mm = [5.0, 10.0]
"#;

/// Runs `plan`, which must succeed without messages, fit a terminal, and write no file.
fn plan(place: &Place) -> Run {
    plan_with(place, &[])
}

/// Runs `plan` on `scene.toml` with these options, as [`plan`] does.
fn plan_with(place: &Place, options: &[&str]) -> Run {
    let before = names(&place.path(""));
    let run = place.run(&[&["plan", "scene.toml"], options].concat());
    assert_eq!((run.code, &*run.err), (Some(0), ""), "{run:?}");
    let wide = run.out.lines().find(|line| line.chars().count() > 80);
    assert_eq!(wide, None);
    assert_eq!(names(&place.path("")), before);
    run
}

/// Returns the effects as `name on cost: why`.
fn effects(run: &Run) -> Vec<String> {
    let lines = run.out.split("\n\n").nth(1).unwrap().lines().skip(1);
    let squeezed = lines.map(|line| {
        let words: Vec<&str> = line.split("  ").map(str::trim).collect();
        let words: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
        words.join(" | ")
    });
    squeezed.collect()
}

/// Returns the line below the effects that begins with `name`.
fn fact<'a>(run: &'a Run, name: &str) -> &'a str {
    let facts = run.out.split("\n\n").nth(2).unwrap();
    let line = facts.lines().find_map(|line| line.strip_prefix(name));
    line.unwrap_or_else(|| panic!("no {name}: {run:?}")).trim()
}

#[test]
fn a_straight_cylinder_has_no_effects() {
    let run = plan(&Place::with(STRAIGHT));
    assert!(run.out.starts_with("A straight cylinder\n\neffect "));
    let expected = [
        "taper | off | own kernel | tip_radius_um 30 = base_radius_um 30",
        "measured radii | off | own kernel | no whisker.profile",
        "curvature | off | own kernel | parabola_per_mm is 0 or left out",
        "euler spiral | off | own kernel | euler_spiral is 0 or left out",
        "traced shape | off | own kernel | no whisker.rest",
        "modulus gradient | off | own kernel | tip_to_base is 1 or left out",
        "pole radius | off | free: start | radius_mm is 0 or left out",
        "friction | off | free: start | friction is 0 or left out",
        "projection | off | free: taper | arc_stretch is 1 or left out",
    ];
    assert_eq!(effects(&run), expected);
    let states = "7: 0 rest shape, 4 rod, 3 derivatives; at last 9 with energy";
    assert_eq!(fact(&run, "states"), states);
    let cells = "16: 8 push angles x 2 distances x 1 whisker";
    assert_eq!(fact(&run, "cells"), cells);
    let calls = "1: groups of 1 whisker, 1 side of 2 rows, 1024 rows a call";
    assert_eq!(fact(&run, "GPU calls"), calls);
    assert_eq!(
        fact(&run, "GPU memory"),
        "192 MiB more than below, on the host"
    );
    // 4 MiB for each thread, 256 KiB for the sheet of the only side, and 16 cells.
    let threads = std::thread::available_parallelism().unwrap();
    let mib = 4 * threads.get() + 1;
    for format in ["EXR file", "Zarr store"] {
        assert_eq!(memory_mib(&run, format), mib);
    }
}

#[test]
fn the_cone_scene() {
    let place = Place::with(include_str!("../../scenes/cone.toml"));
    let run = plan(&place);
    let expected = [
        "taper | on | own kernel | tip_radius_um 1.5 < base_radius_um 30",
        "measured radii | off | own kernel | no whisker.profile",
        "curvature | on | own kernel | parabola_per_mm 0.02",
        "euler spiral | off | own kernel | euler_spiral is 0 or left out",
        "traced shape | off | own kernel | no whisker.rest",
        "modulus gradient | off | own kernel | tip_to_base is 1 or left out",
        "pole radius | on | free: start | radius_mm 0.25",
        "friction | off | free: start | friction is 0 or left out",
        "projection | off | free: taper | arc_stretch is 1 or left out",
    ];
    assert_eq!(effects(&run), expected);
    assert!(fact(&run, "states").starts_with("11: 2 rest shape"));
    let cells = "262144: 512 push angles x 512 distances x 1 whisker";
    assert_eq!(fact(&run, "cells"), cells);
    let calls = "4: groups of 1 whisker, 2 sides of 512 rows, 256 rows a call";
    assert_eq!(fact(&run, "GPU calls"), calls);

    // Only the seconds change, and they are positive.
    let same = |run: &Run| run.out.lines().take(17).collect::<Vec<_>>().join("\n");
    let again = plan(&place);
    assert_eq!(same(&run), same(&again));
    let words: Vec<&str> = fact(&run, "time").split(' ').collect();
    let seconds: f64 = words[1].parse().unwrap();
    assert!(
        words[0] == "about" && words[2] == "s" && seconds > 0.0,
        "{run:?}"
    );
}

/// Returns the bytes of a file of this `format`, as `plan` prints them.
fn bytes(run: &Run, format: &str) -> f64 {
    let said: Vec<&str> = fact(run, format).split([' ', ',']).collect();
    let unit = ["B", "kB", "MB", "GB"];
    let unit = unit.iter().position(|unit| *unit == said[2]).unwrap();
    said[1].parse::<f64>().unwrap() * 1000_f64.powi(unit as i32)
}

/// Returns the MiB of memory for a file of this `format`, as `plan` prints them.
fn memory_mib(run: &Run, format: &str) -> usize {
    let line = fact(run, format).strip_suffix(" MiB of memory").unwrap();
    line.rsplit(' ').next().unwrap().parse().unwrap()
}

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
    place.write(
        "scene.toml",
        &format!("{sweep}{axes}pole_radius_mm = [0.1, 0.2]\n"),
    );
    let run = plan(&place);
    assert!(!run.out.contains("EXR file"), "{run:?}");
}

/// A single panel is in bands of rows only for an EXR file, and only a store keeps the packed panels of a block.
#[test]
fn the_memory_of_a_store_includes_its_block_and_whole_panels() {
    let scene = STRAIGHT.replace("count = 8", "count = 2048");
    let scene = scene.replace("[5.0, 10.0]", "{ from = 2, to = 20, count = 1024 }");
    let run = plan(&Place::with(&scene));
    let [exr, zarr] = ["EXR file", "Zarr store"].map(|format| memory_mib(&run, format));
    // A panel of 56 bytes a cell is 112 MiB; two bands of 128 rows are 28 MiB.
    assert_eq!(zarr - exr, 112 - 28);
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
    // A block has 64 panels of 32 packed bytes a cell.
    assert_eq!(zarr - exr, ((64 - 16) * 128 * 128 * 32) >> 20);
}

/// Returns the lines of shards, as words.
fn shards(run: &Run) -> Vec<Vec<&str>> {
    let lines = run.out.lines().filter(|line| line.starts_with("shard"));
    lines
        .map(|line| line.split_whitespace().collect())
        .collect()
}

/// Eight blocks of three whiskers each.
#[test]
fn shards_have_their_part_of_cells_hours_and_bytes() {
    let place = Place::with(super::store::SWEEP);
    let run = plan_with(&place, &["--shards", "3", "--channels", "regime,force_un"]);
    let lines = shards(&run);
    assert_eq!(lines.len(), 2, "{run:?}");
    assert_eq!(
        lines[0][..6],
        ["shards", "0-1", "3", "blocks,", "36864", "cells:"]
    );
    assert_eq!(
        lines[1][..6],
        ["shard", "2", "2", "blocks,", "24576", "cells:"]
    );
    for line in &lines {
        let hours: f64 = line[7].parse().unwrap();
        assert!(line[8] == "CPU-hours," && hours > 0.0, "{run:?}");
    }
    assert!(!run.out.contains("EXR file"), "{run:?}");
    let one = plan_with(
        &place,
        &["--shard", "2/3", "--format", "zarr", "--threads", "1"],
    );
    assert_eq!(shards(&one)[0][..6], lines[1][..6]);
    assert!(fact(&one, "time").contains(" on 1 thread, "), "{one:?}");
    let plan = |options: &[&str]| place.run(&[&["plan", "scene.toml"], options].concat());
    plan(&["--shards", "9"])
        .assert_refused(&["--shards 9: must be at most 8, the number of blocks"]);
    plan(&["--shards", "2", "--format", "exr"]).assert_refused(&["an EXR file has one writer"]);
    plan(&["--shards", "2", "--shard", "0/2"]).assert_refused(&["cannot be used with"]);
}

/// Every option of `map` is an option of `plan`.
#[test]
fn the_options_of_a_map_change_its_estimate() {
    let place = Place::with(SCENE);
    let all = bytes(&plan_with(&place, &[]), "EXR file");
    let run = plan_with(
        &place,
        &["--channels", "regime", "--engine", "cpu", "--format", "exr"],
    );
    assert!(bytes(&run, "EXR file") < 0.2 * all, "{run:?}");
    assert_eq!(fact(&run, "engine"), "cpu f64: selected by --engine");
    assert!(!run.out.contains("Zarr store"), "{run:?}");
    let run = plan_with(
        &place,
        &[
            "--engine",
            "spectral",
            "--tolerance",
            "1e-2deg",
            "--no-png",
            "-o",
            "elsewhere",
            "--force",
        ],
    );
    assert_eq!(fact(&run, "engine"), "spectral f64: selected by --engine");
    let plan = |options: &[&str]| place.run(&[&["plan", "scene.toml"], options].concat());
    plan(&["--engine", "cpu", "--precision", "f32"]).assert_refused(&["--precision f32: the CPU"]);
    plan(&["--tolerance", "1e-10deg"]).assert_refused(&["must be at least"]);
    plan(&["--channels", "regime", "--digits", "force_un=3"]).assert_refused(&["is not stored"]);
}

#[test]
fn everything_on() {
    let more = "[whisker.modulus_gradient]\ntip_to_base = 1.4\n[whisker.projection]\narc_stretch = 1.03\n\
                [contact]\nfriction = 0.2\n[pole]";
    let run = plan(&Place::with(&SCENE.replace("[pole]", more)));
    let listed = effects(&run);
    let off: Vec<&str> = listed
        .iter()
        .filter(|line| !line.contains(" | on | "))
        .map(|line| line.split(" | ").next().unwrap())
        .collect();
    // Measured radii replace the taper; a spiral and a traced shape the parabola.
    assert_eq!(
        off,
        ["measured radii", "euler spiral", "traced shape"],
        "{run:?}"
    );
}

#[test]
fn a_sweep_names_its_axes() {
    let whisker = STRAIGHT.replace("tip_radius_um = 30\n", "");
    let axes = "taper = { from = 0, to = 1, count = 4 }\ncurvature_per_mm = [0, 0.02, 0.04]\n";
    let run = plan(&Place::with(&format!("{whisker}{axes}")));
    let listed = effects(&run);
    assert_eq!(listed[0], "taper | on | own kernel | grid.taper 0 to 1");
    let curvature = "curvature | on | own kernel | grid.curvature_per_mm 0 to 0.04";
    assert_eq!(listed[2], curvature);
    let cells = "192: 8 push angles x 2 distances x 12 whiskers";
    assert_eq!(fact(&run, "cells"), cells);
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
        let shell = shell
            .args(["-c", &limited, program])
            .current_dir(place.path(""));
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

#[test]
fn standard_input_and_refused_scenes() {
    let place = Place::with(&STRAIGHT.replace("length_mm = 20", "length_mm = -20"));
    place
        .run(&["plan", "scene.toml"])
        .assert_refused(&["whisker.length_mm = -20: must be between"]);
    place
        .run(&["plan", "nowhere.toml"])
        .assert_refused(&["nowhere.toml: cannot be read"]);
    let large = STRAIGHT.replace("count = 8", "count = 60000");
    let large = large.replace("[5.0, 10.0]", "{ from = 2, to = 20, count = 4000 }");
    place.write("large.toml", &large);
    place
        .run(&["plan", "large.toml"])
        .assert_refused(&["60000 push angles x 4000 distances", "4096 MiB"]);
    let mut piped = place.command(&["plan", "-"]);
    let run = Run::of(&piped.write_stdin(STRAIGHT).output().unwrap());
    assert_eq!(run.code, Some(0), "{run:?}");
    assert!(run.out.starts_with("A straight cylinder\n"), "{run:?}");
}
