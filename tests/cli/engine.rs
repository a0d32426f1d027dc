//! Selection of engine and adapter by `map`.

use super::{Place, Run, SCENE};

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
    assert!(
        said.ends_with("(auto: the CPU is done before a GPU has started)"),
        "{said}"
    );
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
