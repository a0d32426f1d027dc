//! `whiskmap map` on one whisker.

use super::{Place, SCENE, names};
use std::io::Read;
use std::process::Stdio;
use whiskmap::store::StoredMap;

#[test]
fn a_map_end_to_end() {
    let place = Place::with(SCENE);
    let run = place.map(&["scene.toml", "-o", "new/folder"]);
    assert_eq!(names(&place.path("new/folder")), ["scene.exr", "scene.png"]);

    run.assert_settled();
    let regimes = ["out of reach", "  contact", "slip-off", "pull-off"];
    let counts = regimes.map(|name| run.count(name));
    assert!(counts.iter().all(|cells| *cells > 0), "{run:?}");
    assert_eq!(counts.iter().sum::<u64>(), 24 * 24, "{run:?}");
    assert!(run.out.starts_with("A small map\n"), "{run:?}");
    assert!(run.out.contains(" s for the stages: sheets "), "{run:?}");
    assert!(run.out.contains("scene.exr\n"), "{run:?}");
    assert!(run.out.ends_with("scene.png\n"), "{run:?}");

    let engine = run.err.strip_prefix("engine: cpu f64 on ");
    let engine = engine.unwrap_or_else(|| panic!("{run:?}"));
    assert_eq!(engine.find('\n'), Some(engine.len() - 1), "{run:?}");
    assert!(engine.ends_with("(selected by --engine)\n"), "{run:?}");

    let stored = StoredMap::open(&place.path("new/folder/scene.exr")).unwrap();
    assert_eq!(stored.counts.regimes["slip-off"], counts[2]);
    assert_eq!(stored.attribute("scene").unwrap(), SCENE);
}

/// While a map is written and drawn, another thread replaces it by another map, again and again. Windows replaces no file that is open.
#[cfg(unix)]
#[test]
fn the_picture_is_that_of_the_map_of_the_run() {
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::{fs, thread};
    let place = Place::with(SCENE);
    let other = SCENE.replace("radius_mm = 0.25", "radius_mm = 0.5");
    fs::create_dir(place.path("other")).unwrap();
    place.write("other/scene.toml", &other);
    place.map(&["other/scene.toml", "-o", "other"]);
    place.map(&["scene.toml", "-o", "own"]);
    fs::create_dir(place.path("outputs")).unwrap();
    let is_done = AtomicBool::new(false);
    thread::scope(|threads| {
        threads.spawn(|| {
            let next = place.path("outputs/next.exr");
            for _ in 0..10_000_000 {
                if is_done.load(Ordering::Relaxed) {
                    break;
                }
                fs::copy(place.path("other/scene.exr"), &next).unwrap();
                fs::rename(&next, place.path("outputs/scene.exr")).unwrap();
            }
        });
        let map = ["map", "scene.toml", "--engine=cpu"];
        let runs: Vec<_> =
            (0..8).map(|_| (place.run(&map), fs::read(place.path("outputs/scene.png")))).collect();
        is_done.store(true, Ordering::Relaxed);
        for (run, picture) in runs {
            assert_eq!(run.code, Some(0), "{run:?}");
            assert!(picture.unwrap() == place.bytes("own/scene.png"));
        }
    });
}

#[test]
fn the_same_bytes_every_time_and_with_any_number_of_threads() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "-o", "first"]);
    place.map(&["scene.toml", "-o", "second"]);
    place.map(&["scene.toml", "-o", "one", "--threads", "1"]);
    place.map(&["scene.toml", "-o", "two", "--threads", "2"]);
    let same = |a: &str, b: &str| assert!(place.bytes(a) == place.bytes(b), "{a} and {b} differ");
    same("first/scene.exr", "second/scene.exr");
    same("first/scene.png", "second/scene.png");
    for file in ["scene.exr", "scene.png"] {
        same(&format!("first/{file}"), &format!("one/{file}"));
        same(&format!("one/{file}"), &format!("two/{file}"));
    }
    // More cells than one row batch, and more than one thread's share of it.
    place.write("large.toml", &SCENE.replace("count = 24", "count = 200"));
    for threads in ["1", "2", "3"] {
        place.map(&["large.toml", "-o", threads, "--threads", threads]);
        same("1/large.exr", &format!("{threads}/large.exr"));
    }
}

#[test]
fn a_map_replaces_the_one_before_it() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "-o", "."]);
    let before = place.bytes("scene.exr");
    place.write("scene.toml", &SCENE.replace("count = 24", "count = 12"));
    place.map(&["scene.toml", "-o", "."]);
    assert!(place.bytes("scene.exr").len() < before.len());
    assert_eq!(names(&place.path("")), ["scene.exr", "scene.png", "scene.toml"]);
}

#[test]
fn no_png() {
    let place = Place::with(SCENE);
    let run = place.map(&["scene.toml", "--no-png"]);
    assert_eq!(names(&place.path("outputs")), ["scene.exr"]);
    assert!(run.out.ends_with("scene.exr\n"), "{run:?}");
}

#[test]
fn standard_input_gives_the_map_that_the_file_gives() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml"]);
    let mut command = place.command(&["map", "-", "--engine", "cpu", "-o", "piped"]);
    command.write_stdin(SCENE).assert().code(0);
    assert_eq!(names(&place.path("piped")), ["scene.exr", "scene.png"]);
    for file in ["scene.exr", "scene.png"] {
        let piped = place.bytes(&format!("piped/{file}"));
        assert!(piped == place.bytes(&format!("outputs/{file}")), "{file}");
    }
}

#[test]
fn a_scene_names_its_output() {
    let place = Place::with(&format!("{SCENE}[output]\nname = \"other\"\n"));
    place.map(&["scene.toml"]);
    assert_eq!(names(&place.path("outputs")), ["other.exr", "other.png"]);
}

/// Like `whiskmap map scene.toml | head -0`.
#[test]
fn a_reader_that_has_gone_is_no_failure() {
    let place = Place::with(SCENE);
    for arguments in [&["map", "scene.toml", "--engine", "cpu"][..], &["devices"]] {
        let mut child = place
            .plain_command(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let mut err = String::new();
        child.stderr.take().unwrap().read_to_string(&mut err).unwrap();
        assert!(!err.contains("panicked"), "{err}");
        assert_eq!(child.wait().unwrap().code(), Some(0), "{err}");
    }
    assert_eq!(names(&place.path("outputs")), ["scene.exr", "scene.png"]);
}

/// Radii with a hinge next to the base: the whisker coils up for more turns than continuation follows.
pub const HINGED: &str = "title = 'A hinge'\n[whisker]\nlength_mm = 20\nyoungs_modulus_gpa = 3\n\
                          profile.rows = [[0, 30], [2, 7.5], [3, 30], [20, 30]]\n\
                          [grid]\npush_angle_deg = [5, 10]\ndistance_mm = [5, 8]\n";

#[test]
fn a_map_without_any_resolved_cell_is_written_and_fails() {
    let place = Place::with(HINGED);
    let run = place.run(&["map", "scene.toml", "-o", ".", "--engine", "cpu"]);
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(run.err.contains("error: all 4 cells are unresolved"), "{run:?}");
    assert_eq!(run.count("unresolved"), 4, "{run:?}");
    assert!(StoredMap::open(&place.path("scene.exr")).is_ok());

    // The farther row is pulled off before it coils up.
    place.write("scene.toml", &HINGED.replace("[5, 8]", "[8, 19]"));
    let run = place.map(&["scene.toml", "-o", "."]);
    let warning = "warning: 2 of 4 cells are unresolved: see the channel `status`\n";
    assert!(run.err.ends_with(warning), "{run:?}");
}

/// In a file of one part, the offset table directly follows the header.
#[test]
fn a_map_of_one_part_is_read_by_all() {
    use exr::prelude::{ReadChannels, ReadLayers, read};
    for sweep in ["", "pole_radius_mm = [0.1, 0.2]\n"] {
        let scene = SCENE.to_owned() + sweep;
        let place = Place::with(&scene);
        place.map(&["scene.toml", "--channels", "regime"]);
        let path = place.path("outputs/scene.exr");
        let map = StoredMap::open(&path).unwrap();
        let regimes: Vec<f64> = map.read_channel("regime").unwrap().values().collect();
        let image = read().no_deep_data().largest_resolution_level();
        let image = image.all_channels().all_layers().all_attributes();
        let image = image.from_file(&path).unwrap();
        let samples = &image.layer_data[0].channel_data.list[0].sample_data;
        let mut found: Vec<f64> = samples.values_as_f32().map(f64::from).collect();
        let mut expected = regimes;
        found.sort_by(f64::total_cmp);
        expected.sort_by(f64::total_cmp);
        assert_eq!(found, expected);
        for output in ["x.csv", "x.npy"] {
            place.good(&["extract", "outputs/scene.exr", "-o", output]);
        }
    }
}
