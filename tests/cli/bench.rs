//! `whiskmap bench`: consistency of its tables and JSON, not the measured times.

use super::{Place, Run, SCENE, words};
use crate::shipped;
use serde_json::Value;

fn numbers(rows: &[Value], key: &str) -> Vec<f64> {
    let number = |row: &Value| row.pointer(key).and_then(Value::as_f64).unwrap();
    rows.iter().map(number).collect()
}

#[test]
fn errors_fall_from_rung_to_rung() {
    // A few cells have no net, so a GPU and the spectral engine would solve no cell.
    let place = Place::with(
        &SCENE
            .replace("to = 70, count = 24", "to = 70, count = 512")
            .replace("count = 24", "count = 64"),
    );
    let run = place.quiet(&["bench", "scene.toml", "--quick", "--json", "-"]);
    let report: Value = serde_json::from_str(&run.out).unwrap();
    assert!(report["states"].as_u64().unwrap() > 200);
    assert!(report["runs"].as_u64().unwrap() >= 5);
    let rows = report["rows"].as_array().unwrap();
    let engines = report["engines"].as_array().unwrap();
    assert!(engines.len() >= 2);
    for engine in engines {
        let of_engine: Vec<Value> = rows
            .iter()
            .filter(|row| row["engine"] == engine["name"] && row["threads"] == engine["threads"])
            .cloned()
            .collect();
        let is_cpu = engine["name"].as_str().unwrap().starts_with("cpu");
        let errors = numbers(&of_engine, "/errors/angle_deg/worst");
        // The last two rungs of the CPU are at the rounding error. A GPU has no such rung: measured 2.3e-5 in `f32`. Small bounds of the
        // spectral engine can take the same number of states.
        let (rungs, falling, exact) = match engine["name"].as_str().unwrap() {
            "spectral" => (5, 4, 1e-9),
            _ if is_cpu => (8, 6, 1e-9),
            _ => (1, 1, 1e-4),
        };
        assert_eq!(errors.len(), rungs, "{engine}: {errors:?}");
        // One size of nets may keep two bounds.
        let is_spectral = engine["name"] == "spectral";
        assert!(
            errors[..falling].is_sorted_by(|a, b| a > b || is_spectral && a == b),
            "{engine}: {errors:?}"
        );
        assert!(errors[0] > 1e3 * errors[rungs - 1] || rungs == 1, "{engine}: {errors:?}");
        assert!(errors[rungs - 1] < exact, "{engine}: {errors:?}");
        let keys = match is_cpu {
            true => &["/us_per_state", "/trajectories_per_s"][..],
            false => &["/us_per_state"],
        };
        for key in keys {
            assert!(numbers(&of_engine, key).iter().all(|number| *number > 0.0));
        }
        let p99 = numbers(&of_engine, "/errors/angle_deg/p99");
        assert!(p99.iter().zip(&errors).all(|(most, worst)| most <= worst));
    }
    let places: Vec<(f64, f64, bool)> = numbers(rows, "/us_per_state")
        .into_iter()
        .zip(numbers(rows, "/errors/angle_deg/worst"))
        .zip(rows)
        .map(|((time, error), row)| (time, error, row["pareto"].as_bool().unwrap()))
        .collect();
    for (time, error, pareto) in &places {
        let is_beaten =
            places.iter().any(|(t, e, _)| t <= time && e <= error && (t, e) != (time, error));
        assert_eq!(*pareto, !is_beaten);
    }
    let ends = report["detachments"].as_array().unwrap();
    let errors = numbers(ends, "/angle_deg/worst");
    // The few trajectories of a sheet share blocks, so two coarse rungs can take the same steps.
    assert!(errors[..6].is_sorted_by(|a, b| a >= b), "{errors:?}");
    assert!(errors[..6].windows(3).all(|few| few[0] > few[2]), "{errors:?}");
    assert!(errors[0] > 1e4 * errors[5], "{errors:?}");
    let maps = report["maps"].as_array().unwrap();
    for timed in rows.iter().chain(ends).chain(maps) {
        let seconds = &timed["seconds"];
        let is_noisy = seconds["spread"].as_f64().unwrap() > 0.2;
        assert_eq!(seconds["is_noisy"], is_noisy, "{seconds}");
    }
    let gpus = engines.iter().filter(|engine| engine["threads"].is_null());
    let gpus = gpus.count();
    assert_eq!(maps.len(), 2 + gpus);
    let trajectories = report["trajectories"].as_array().unwrap();
    assert_eq!(trajectories.len(), 1 + gpus);
    assert!(numbers(trajectories, "/per_s").iter().all(|rate| *rate > 0.0));
    for row in trajectories {
        let most = match row["engine"].as_str().unwrap() {
            engine if engine.ends_with("f32") => 2e-5,
            engine if engine.ends_with("f64") => 1e-12,
            _ => 0.0,
        };
        assert!(row["apart"].as_f64().unwrap() <= most, "{row}");
    }
    maps_hang_together(maps, report["verdicts"].as_array().unwrap());
    expansions_hang_together(&report);
}

/// Checks the one-time cost of expansions against the rows of the spectral engine and of trajectories on one thread.
fn expansions_hang_together(report: &Value) {
    let all = report["expansions"].as_array().unwrap();
    assert_eq!(all.len(), 5);
    let states = numbers(all, "/states");
    // A small bound leaves only rows with few states.
    assert!(states[..4].is_sorted() && states[0] < states[3], "{states:?}");
    let certified = numbers(all, "/certified");
    assert!(certified.iter().all(|part| (0.3..=1.0).contains(part)), "{certified:?}");
    let rows = report["rows"].as_array().unwrap();
    let rows = rows.iter().filter(|row| row["engine"] == "spectral" && row["threads"] == 1);
    for (engine, row) in all.iter().zip(rows) {
        assert_eq!(engine["us_per_state"], row["us_per_state"]);
        let number = |key: &str| engine[key].as_f64();
        let saved = number("us_by_trajectories").unwrap() - number("us_per_state").unwrap();
        let from = (saved > 0.0).then(|| 1e3 * number("ms_per_side").unwrap() / saved);
        let found = number("pays_from");
        assert_eq!(found.is_some(), from.is_some(), "{engine}");
        assert!(found.zip(from).is_none_or(|(a, b)| (a - b).abs() < 1e-9 * b), "{engine}");
    }
}

/// Checks the values of whole maps, with the CPU engine first, and the verdicts: on the two engines on the CPU, and on each GPU.
fn maps_hang_together(maps: &[Value], verdicts: &[Value]) {
    for part in numbers(maps, "/device_can_take") {
        assert!(part > 0.0 && part < 1.0, "{maps:?}");
    }
    let host = numbers(maps, "/host_us_per_cell");
    assert!(host.iter().all(|us| *us > 0.0), "{host:?}");
    let shares = numbers(maps, "/host_share");
    assert_eq!(shares[0], 1.0);
    assert!(shares.iter().all(|share| *share > 0.0), "{shares:?}");
    let is_cpu = |map: &Value| map["engine"].as_str().unwrap().starts_with("cpu");
    for map in maps {
        let device = map.pointer("/stages_ms/device").and_then(Value::as_f64);
        let is_gpu = map["engine"].as_str().unwrap().starts_with("gpu");
        assert_eq!(device != Some(0.0), is_gpu, "{map}");
    }
    assert!(is_cpu(&maps[0]));
    let medians = numbers(maps, "/seconds/median");
    let hosts = maps.iter().filter(|map| map["adapter"].is_null()).count();
    assert_eq!((hosts, verdicts.len()), (2, maps.len() - 1), "{verdicts:?}");
    let fastest = f64::min(medians[0], medians[1]);
    for (i, verdict) in verdicts.iter().enumerate() {
        let (other, pair) = match i {
            0 => (f64::max(medians[0], medians[1]), &maps[0]),
            _ => (medians[i + 1], &maps[i + 1]),
        };
        assert_eq!(verdict["adapter"], pair["adapter"], "{verdict}");
        let names = [&verdict["faster"], &verdict["slower"]];
        assert!(i == 0 || names.contains(&&pair["engine"]), "{verdict}");
        let times = f64::max(other / fastest, fastest / other);
        assert!((verdict["times"].as_f64().unwrap() - times).abs() < 1e-9);
    }
}

#[test]
fn tables_fit_a_terminal_and_pictures_are_drawn() {
    let place = Place::with(SCENE);
    // The link is kept.
    #[cfg(unix)]
    std::os::unix::fs::symlink("real.json", place.path("b.json")).unwrap();
    let peers = shipped::root().join("outputs/peers.json");
    let peers = peers.to_str().unwrap();
    let options = ["--json", "b.json", "--plot", "b.svg", "--peers", peers];
    let run = place.quiet(&[&["bench", "scene.toml", "--quick"][..], &options].concat());
    let adapters = |line: &&str| line.starts_with("                    ") && !line.contains("deg");
    let rows = run.out.lines().filter(|line| !adapters(line));
    let widest = rows.map(|line| line.chars().count()).max();
    assert!(widest <= Some(80), "{}", run.out);
    assert!(run.out.contains("\n* "), "{}", run.out);
    for line in ["for devices: ", "waiting: "] {
        let start = format!("\n{line}");
        assert_eq!(run.out.matches(&start).count(), 1, "{}", run.out);
    }
    assert!(run.out.contains("\nverdict: "), "{}", run.out);
    assert!(!run.out.contains(">99"), "{}", run.out);
    assert_eq!(place.path("b.json").is_symlink(), cfg!(unix));
    let json: Value = serde_json::from_slice(&place.bytes("b.json")).unwrap();
    assert_eq!(json["scene"], "A small map");
    let picture = place.text("b.svg");
    assert!(picture.contains("What accuracy costs"));
    // Axis labels are numbers, not logarithms.
    assert!(picture.contains(">1e\u{2212}"), "{picture}");
    for text in ["time per state (\u{b5}s)", "heyoka", "AUTO-07p", "solve_bvp"] {
        assert!(picture.contains(&format!(">{text}<")), "{text}");
    }
}

#[test]
fn an_output_that_cannot_be_written_is_refused_before_any_work() {
    let place = Place::with(SCENE);
    for (arguments, why) in [
        (["--plot", "b.jpg"], "must end in .png, .svg or .pdf"),
        (["--json", "no/b.json"], "--json no/b.json"),
    ] {
        let run = place.run(&[&["bench", "scene.toml", "--quick"][..], &arguments].concat());
        run.assert_refused(&[why]);
    }
    let no_plot = place.run(&["bench", "scene.toml", "--quick", "--peers", "scene.toml"]);
    no_plot.assert_refused(&["--plot"]);
    let both = ["--json", "b.svg", "--plot", "b.svg"];
    let run = place.run(&[&["bench", "scene.toml", "--quick"][..], &both].concat());
    run.assert_refused(&["must be two files"]);
}

#[test]
fn a_wrong_file_of_peers_is_refused_before_any_work() {
    let place = Place::with(SCENE);
    let row = |row: &str| format!(r#"{{"machine": "M", "heyoka": [{row}]}}"#);
    for (text, why) in [
        ("{", "must be as benches/peers/run.sh writes it: EOF"),
        (r#"{"heyoka": []}"#, "missing field `machine`"),
        (r#"{"machine": "M", "auto": null}"#, "has no program"),
        (&row(r#"{"microseconds": 0, "error_max": 1}"#), "heyoka, row 1: microseconds is 0"),
        (&row(r#"{"microseconds": 1, "error_max": -1}"#), "heyoka, row 1: error_max is -1"),
        (&row(r#"{"microseconds": 1, "error_max": 1e999}"#), "number out of range"),
        (&" ".repeat((1 << 20) + 1), "longer than 1 MiB"),
    ] {
        std::fs::write(place.path("peers.json"), text).unwrap();
        let run = place.run(&words("bench scene.toml --plot b.svg --peers peers.json"));
        run.assert_refused(&["--peers peers.json: ", why]);
        assert!(!place.path("b.svg").exists());
    }
    let run = place.run(&words("bench scene.toml --plot b.svg --peers none.json"));
    run.assert_refused(&["--peers none.json: cannot read the file"]);
    let mut piped = place.command(&["bench", "scene.toml", "--plot", "b.svg", "--peers", "-"]);
    let run = Run::of(&piped.write_stdin("{").output().unwrap());
    run.assert_refused(&["--peers -: must be as benches/peers/run.sh writes it"]);
}

#[test]
fn a_scene_without_states_has_nothing_to_measure() {
    let far = SCENE.replace("from = -70, to = 70", "from = 170, to = 171");
    let place = Place::with(&far.replace("from = 2, to = 20", "from = 18, to = 19"));
    let run = place.run(&["bench", "scene.toml", "--quick"]);
    run.assert_refused(&["no cell of the sample has a state"]);
}
