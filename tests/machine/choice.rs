//! Which engine and which adapter the program takes.

use crate::program::{Place, Run, SCENE};
use serde_json::Value;
use whiskmap::store::StoredMap;

tests! {
    Adapter:
        auto_times_the_engines_for_a_large_map,
        adapters_are_taken_by_number_and_name,
        a_file_states_the_tolerances_of_its_engine,
        a_map_without_numbers_of_states_needs_no_gpu,
        a_missing_driver_is_named;
}

/// So many cells that a processor four times as fast as today's takes longer for them than a GPU takes to start.
fn large() -> String {
    let large = SCENE.replace("count = 24", "count = 2048");
    large.replace("title = \"A small map\"", "title = \"A large map\"")
}

/// The name of the first adapter that `devices` lists.
fn adapter(place: &Place) -> String {
    let run = place.good(&["devices"]);
    let line = run.out.lines().find(|line| line.get(2..4) == Some("0 "));
    line.unwrap()[4..].rsplit_once(" (").unwrap().0.to_owned()
}

fn said(run: &Run) -> &str {
    assert_eq!(run.code, Some(0), "{run:?}");
    run.assert_settled();
    run.err.strip_prefix("engine: ").unwrap().trim_end()
}

/// It takes what it has found to be faster, and says against what. A software adapter is timed only if it is named.
fn auto_times_the_engines_for_a_large_map() {
    let place = Place::with(&large());
    let adapter = adapter(&place);
    let map: Vec<&str> =
        "map scene.toml --no-png --channels regime,force_un --threads 1".split(' ').collect();
    let devices = place.run(&["devices"]).out;
    let is_first = |line: &&str| line.get(2..4) == Some("0 ");
    if devices.lines().find(is_first).unwrap().contains("software") {
        let run = place.run(&map);
        let end = format!("; {adapter} also computes on the CPU)");
        assert!(said(&run).ends_with(&end), "{run:?}");
    }
    let run = place.run(&[&map[..], &["--adapter", "0"]].concat());
    let said = said(&run);
    let (taken, why) = said.rsplit_once(" (auto: ").unwrap();
    let gpu = format!("gpu f32 on {adapter}");
    let host = "spectral f64 on ";
    let times = match taken.starts_with(host) {
        true => {
            let (counted, times) = why.rsplit_once("; ").unwrap();
            assert!(counted.starts_with("at most "), "{said}");
            times.strip_suffix(')').unwrap().strip_suffix(&gpu)
        }
        false => {
            assert!(taken.starts_with(&gpu), "{said}");
            why.split_once(host).map(|(times, _)| times)
        }
    };
    let times = times.and_then(|times| times.strip_suffix(" times "));
    assert!(times.is_some_and(|times| times.parse::<f64>().unwrap() >= 1.0), "{said}");
}

fn adapters_are_taken_by_number_and_name() {
    let place = Place::with(SCENE);
    let adapter = adapter(&place);
    let map = ["map", "scene.toml", "--no-png", "--engine", "gpu"];
    let taken = |run: Run| assert!(said(&run).starts_with(&format!("gpu f32 on {adapter}")));
    taken(place.run(&[&map[..], &["--adapter", "0"]].concat()));
    let part = &adapter.to_uppercase()[..adapter.find(' ').unwrap_or(adapter.len())];
    taken(place.run(&[&map[..], &["--adapter", part]].concat()));
    let named = |arguments: &[&str], name: &str| {
        let mut command = place.command(arguments);
        Run::of(&command.env("WGPU_ADAPTER_NAME", name).output().unwrap())
    };
    taken(named(&map, part));
    taken(named(&map, ""));
    // What is asked for comes before the variable.
    taken(named(&[&map[..], &["--adapter", "0"]].concat(), "abacus"));
    let auto = ["map", "scene.toml", "--no-png"];
    let allowed = format!("0 ({adapter})");
    for engine in [&map[..], &auto] {
        for adapter in ["99", "abacus", ""] {
            let run = place.run(&[engine, &["--adapter", adapter]].concat());
            let what = format!("--adapter {adapter}: no such GPU adapter");
            run.assert_refused(&[&what, &allowed]);
        }
        named(engine, "abacus").assert_refused(&["WGPU_ADAPTER_NAME=abacus: no such", &allowed]);
    }
    let devices = named(&["devices"], "abacus");
    assert_eq!(devices.code, Some(2), "{devices:?}");
    assert!(devices.err.contains(&allowed) && !devices.out.contains('*'), "{devices:?}");
}

/// Regimes follow from the ends of rows. The file names the engine that solved.
fn a_map_without_numbers_of_states_needs_no_gpu() {
    let place = Place::with(&SCENE.replace("count = 24", "count = 256"));
    let engine = |channels: &str| {
        let map = ["map", "scene.toml", "--no-png", "--engine", "gpu"];
        let run = place.run(&[&map[..], &["--channels", channels, "--force"]].concat());
        let map = StoredMap::open(&place.path("outputs/scene.exr")).unwrap();
        let about = map.attribute("engine").unwrap().to_string();
        (said(&run).to_owned(), about)
    };
    let (said, about) = engine("regime,margin_deg");
    assert!(said.contains("the map has no numbers of states"), "{said}");
    assert!(about.contains("spectral f64"), "{about}");
    let (said, about) = engine("regime,force_un");
    assert!(said.starts_with("gpu f32 on "), "{said}");
    assert!(about.contains("gpu f32"), "{about}");
}

/// Without a driver, the message says which part of Vulkan is missing.
#[cfg(target_os = "linux")]
fn a_missing_driver_is_named() {
    let place = Place::with(SCENE);
    let without = |arguments: &[&str]| {
        let mut command = place.command(arguments);
        Run::of(&command.env("VK_DRIVER_FILES", "none.json").output().unwrap())
    };
    let what = "no Vulkan driver is installed: no file in VK_DRIVER_FILES=none.json";
    let run = without(&["map", "scene.toml", "--engine", "gpu"]);
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(run.err.contains(what), "{run:?}");
    let devices = without(&["devices"]);
    assert!(devices.out.contains(what), "{devices:?}");
}

#[cfg(not(target_os = "linux"))]
fn a_missing_driver_is_named() {}

/// The file says what the engine that solved leaves, and no cell leaves more.
fn a_file_states_the_tolerances_of_its_engine() {
    let place = Place::with(&SCENE.replace("count = 24", "count = 64"));
    let tolerances = |arguments: &[&str]| {
        place.good(&[&["map", "scene.toml", "--no-png"], arguments].concat());
        let map = StoredMap::open(&place.path("outputs/scene.exr")).unwrap();
        let tolerances = map.attribute("tolerances").unwrap();
        let accepted = tolerances["residual_accepted_whisker_lengths"].as_f64().unwrap();
        let residuals = map.read_channel("residual").unwrap();
        let worst = residuals.values().fold(0.0, f64::max);
        assert!(worst > 0.0 && worst <= accepted, "{worst:e}: {tolerances}");
        tolerances
    };
    let goal = |tolerances: &Value| tolerances["residual_goal_whisker_lengths"].as_f64();
    let estimate = |tolerances: &Value| tolerances["push_angle_error_estimated_deg"].as_f64();
    let tolerance = ["--tolerance", "1e-3deg"];
    let on = |engine: &str| tolerances(&[&tolerance[..], &["--engine", engine]].concat());
    let (cpu, gpu) = (on("cpu"), on("gpu"));
    assert_eq!((goal(&cpu), goal(&gpu)), (Some(1e-12), Some(1e-6)));
    // The nearest pole is at 2 of 20 mm.
    let more = estimate(&gpu).unwrap() - estimate(&cpu).unwrap();
    assert!((more - 1e-5_f64.to_degrees()).abs() < 1e-11, "{more:e}");
    assert!(estimate(&gpu).unwrap() <= 1e-3);
    // A tolerance that shaders do not meet is met by the CPU.
    let handed = tolerances(&["--tolerance", "1e-6deg", "--engine", "gpu"]);
    assert!(goal(&handed) < goal(&gpu));
    assert!(estimate(&handed).unwrap() <= 1e-6);
}
