//! `whiskmap plan`.

mod effects;
mod shards;
mod size;

use super::{Place, Run, SCENE, names, words};

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
    let run = place.quiet(&[&["plan", "scene.toml"], options].concat());
    let wide = run.out.lines().find(|line| line.chars().count() > 80);
    assert_eq!(wide, None);
    assert_eq!(names(&place.path("")), before);
    run
}

/// Returns the line below the effects that begins with `name`.
fn fact<'a>(run: &'a Run, name: &str) -> &'a str {
    let facts = run.out.split("\n\n").nth(2).unwrap();
    let line = facts.lines().find_map(|line| line.strip_prefix(name));
    line.unwrap_or_else(|| panic!("no {name}: {run:?}")).trim()
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

/// Every option of `map` is an option of `plan`.
#[test]
fn the_options_of_a_map_change_its_estimate() {
    let place = Place::with(SCENE);
    let all = bytes(&plan_with(&place, &[]), "EXR file");
    let run = plan_with(&place, &["--channels", "regime", "--engine", "cpu", "--format", "exr"]);
    assert!(bytes(&run, "EXR file") < 0.2 * all, "{run:?}");
    assert_eq!(fact(&run, "engine"), "cpu f64: selected by --engine");
    assert!(!run.out.contains("GPU"), "{run:?}");
    assert!(!run.out.contains("Zarr store"), "{run:?}");
    let run = plan_with(
        &place,
        &words("--engine spectral --tolerance 1e-2deg --no-png -o elsewhere --force"),
    );
    assert_eq!(fact(&run, "engine"), "spectral f64: selected by --engine");
    let plan = |options: &[&str]| place.run(&[&["plan", "scene.toml"], options].concat());
    plan(&["--engine", "cpu", "--precision", "f32"]).assert_refused(&["--precision f32: the CPU"]);
    plan(&["--tolerance", "1e-10deg"]).assert_refused(&["must be at least"]);
    plan(&["--channels", "regime", "--digits", "force_un=3"]).assert_refused(&["is not stored"]);
}

#[test]
fn standard_input_and_refused_scenes() {
    let place = Place::with(&STRAIGHT.replace("length_mm = 20", "length_mm = -20"));
    place
        .run(&["plan", "scene.toml"])
        .assert_refused(&["whisker.length_mm = -20: must be between"]);
    place.run(&["plan", "nowhere.toml"]).assert_refused(&["nowhere.toml: cannot be read"]);
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

/// Seconds are CPU time by threads, so that they agree with the CPU-hours on a busy machine, too. Both have two digits.
#[test]
fn seconds_and_cpu_hours_are_one_time() {
    let place = Place::with(SCENE);
    for threads in [1.0, 2.0] {
        let run = plan_with(&place, &["--engine", "cpu", "--threads", &threads.to_string()]);
        let numbers: Vec<f64> = fact(&run, "time").split([' ', ',']).flat_map(str::parse).collect();
        let [seconds, found, hours] = numbers[..] else {
            panic!("{run:?}");
        };
        assert_eq!(found, threads);
        let ratio = seconds * threads / (3600.0 * hours);
        // The last digits of 10 and of 1.0 are off by up to 5 % each.
        assert!((0.9..1.11).contains(&ratio), "{ratio} {run:?}");
    }
}
