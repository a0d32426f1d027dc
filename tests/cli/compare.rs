//! `whiskmap compare`.

use super::{Place, Run, SCENE, words};
use serde_json::{Value, json};
use whiskmap::engine::EngineDescription;
use whiskmap::map::{Audit, Channels, EngineCells, Panel};
use whiskmap::plan::Digits;
use whiskmap::scene::Scene;
use whiskmap::store::{
    ChannelValues, MapDescription, MapSlice, MapWriter, Output, StoredMap, TemporaryFiles,
};

/// Scene with four whiskers in one block of a store.
fn sweep() -> String {
    format!("{SCENE}friction = [0, 0.2]\npole_radius_mm = [0.1, 0.2]\n")
}

/// Writes `changed.exr`: the EXR map at `source`, changed by `change`, which gets each panel and its index.
fn change(place: &Place, source: &str, change: impl Fn(&mut Panel, usize)) {
    let map = StoredMap::open(&place.path(source)).unwrap();
    let text = map.attribute("scene").unwrap();
    let scene = Scene::parse(text.as_str().unwrap(), source).unwrap();
    let about = MapDescription {
        scene: &scene,
        engine: &EngineDescription::of(None),
        tolerances: &json!({}),
        channels: Channels::STANDARD,
        digits: Digits::ALL,
        arithmetic: "fma",
    };
    let path = place.path("changed.exr");
    let mut writer =
        MapWriter::create(Output::create(&path, &TemporaryFiles::default()).unwrap(), &about)
            .unwrap();
    let slice = MapSlice::from(map);
    for whisker in 0..scene.whisker_count() {
        let mut panel = slice.panel(Channels::STANDARD, whisker).unwrap();
        change(&mut panel, whisker);
        writer.write_panels(&[panel]).unwrap();
    }
    writer.finish(EngineCells::default(), Audit::default()).unwrap();
}

fn compare(place: &Place, options: &[&str]) -> Run {
    place.run(&[&["compare"], options].concat())
}

/// Returns the comparison as JSON, of a run with this exit code.
fn document(place: &Place, options: &[&str], code: i32) -> Value {
    let run = compare(place, &[options, &["--json", "-"]].concat());
    assert_eq!(run.code, Some(code), "{run:?}");
    serde_json::from_str(&run.out).unwrap()
}

fn channel<'a>(document: &'a Value, name: &str) -> &'a Value {
    let mut all =
        ["codes", "quantities"].into_iter().flat_map(|kind| document[kind].as_array().unwrap());
    all.find(|row| row["channel"] == name).unwrap()
}

#[test]
fn formats_do_not_differ() {
    let place = Place::with(&sweep());
    place.map(&["scene.toml", "--no-png"]);
    place.map(&words("scene.toml --format zarr --channels regime,status,force_un"));
    let maps = ["outputs/scene.exr", "outputs/scene.zarr"];
    let run = compare(&place, &[&maps[..], &["--within", "0"]].concat());
    assert_eq!((run.code, &*run.err), (Some(0), ""), "{run:?}");
    assert_eq!(run.count("  cells"), 4 * 24 * 24);
    assert_eq!(run.count("cells differ in regime"), 0);
    let only = "only in outputs/scene.exr: arc_length_mm, base_force_x_un, ";
    assert!(run.out.contains(only) && !run.out.contains("only in outputs/scene.zarr"), "{run:?}");
}

/// The last whisker has friction 0.2 and a pole of 0.2 mm. Cell 300 is in row 12 and column 12.
#[test]
fn changed_cells_are_found() {
    const CELL: usize = 300;
    let place = Place::with(&sweep());
    place.map(&["scene.toml", "--no-png"]);
    let map = StoredMap::open(&place.path("outputs/scene.exr")).unwrap();
    let ChannelValues::F32(force) = map.read_channel("force_un").unwrap() else {
        panic!("forces are f32");
    };
    let ChannelValues::U32(regimes) = map.read_channel("regime").unwrap() else {
        panic!("regimes are codes");
    };
    let cell = 3 * 24 * 24 + CELL;
    assert_eq!(regimes[cell], 1);
    change(&place, "outputs/scene.exr", |panel, whisker| {
        if whisker == 3 {
            panel.regime[CELL] = 2;
            panel.state[2][CELL] += 4.0;
            panel.state[0][CELL] = f32::NAN;
        }
        // A larger number of small changes sets the median.
        for value in &mut panel.state[5] {
            *value += 0.25;
        }
    });
    let maps = ["outputs/scene.exr", "changed.exr"];
    let found = document(&place, &maps, 0);
    let place_of_cell = json!({
        "friction": 0.2, "pole_radius_mm": 0.2,
        "distance_mm": map.grid.distance_mm[12], "push_angle_deg": map.grid.push_angle_deg[12],
    });
    let regime = channel(&found, "regime");
    assert_eq!(regime["differing"], 1);
    assert_eq!(regime["pairs"], json!([{"names": ["contact", "slip-off"], "cells": 1}]));
    assert_eq!(regime["first"][0]["place"], place_of_cell);
    let forces = channel(&found, "force_un");
    let known = force.iter().filter(|force| !force.is_nan()).count();
    assert_eq!(forces["cells"], known);
    assert_eq!(forces["differing"], 1);
    let changed = f64::from(force[cell] + 4.0) - f64::from(force[cell]);
    assert_eq!(forces["largest"], changed);
    assert_eq!(forces["place"], place_of_cell);
    assert_eq!(forces["median"], 0.0);
    let moments = channel(&found, "base_moment_nnm");
    let median = moments["median"].as_f64().unwrap();
    assert!((median / 0.25 - 1.0).abs() < 0.004, "{median}");
    assert_eq!(channel(&found, "arc_length_mm")["only_in"], json!([1, 0]));

    let exceeded = |within: &str, code| {
        document(&place, &[&maps[..], &["--within", within]].concat(), code)["exceeded"].clone()
    };
    let all = json!(["regime", "arc_length_mm", "base_moment_nnm", "force_un"]);
    assert_eq!(exceeded("0", 1), all);
    // A cell lost its arclength.
    assert_eq!(exceeded("arc_length_mm=1", 1), json!(["arc_length_mm"]));
    assert_eq!(exceeded("arc_length_mm=1,regime=1", 0), json!([]));
    assert_eq!(exceeded("force_un=5,regime=1", 0), json!([]));
    assert_eq!(exceeded("force_un=3,regime=1", 1), json!(["force_un"]));
    assert_eq!(exceeded("1,regime=1", 0), json!([]));
    let run = compare(&place, &[&maps[..], &["--within", "0"]].concat());
    run.assert_said(1, "error: the maps differ by more than --within allows in regime, arc");
    let line = "at friction = 0.2, pole_radius_mm = 0.2, distance_mm = 11.39, push_angle_deg = 3.043: contact / slip-off";
    assert!(run.out.contains(line), "{run:?}");
}

/// The differences of rounded values are not larger than half a unit of the last digit.
#[test]
fn rounding_explains_differences() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "--no-png"]);
    place.map(&["scene.toml", "--no-png", "-o", "rounded", "--digits", "3"]);
    let maps = ["outputs/scene.exr", "rounded/scene.exr"];
    let found = document(&place, &[&maps[..], &["--within", "0"]].concat(), 0);
    let force = channel(&found, "force_un");
    assert!(force["largest"].as_f64().unwrap() > 0.0);
    assert_eq!(force["beyond_rounding"], 0.0);
    let run = compare(&place, &maps);
    assert!(
        run.out.contains("digits arc_length_mm=3, ") && run.out.contains("beyond digits"),
        "{run:?}"
    );
}

#[test]
fn other_scenes_and_grids_are_refused() {
    let place = Place::with(SCENE);
    let regime = ["--channels", "regime", "--no-png"];
    place.map(&[&["scene.toml"], &regime[..]].concat());
    for (name, from, to, said) in [
        (
            "grid",
            "push_angle_deg = { from = -70, to = 70, count = 24",
            "push_angle_deg = { from = -70, to = 70, count = 12",
            "the axis push_angle_deg differs: 24 values from -70 to 70 in the first map, 12 values",
        ),
        (
            "axes",
            "distance_mm =",
            "friction = [0, 0.1]\ndistance_mm =",
            "the sweep axes differ: none in the first map, friction in the second",
        ),
        (
            "whisker",
            "tip_radius_um = 1.5",
            "tip_radius_um = 2.5",
            "the scenes differ: tip_radius_um is 1.5 in the first map, 2.5 in the second",
        ),
    ] {
        let scene = SCENE.replace(from, to);
        assert_ne!(scene, SCENE);
        let file = format!("{name}.toml");
        place.write(&file, &scene);
        place.map(&[&[&*file], &regime[..]].concat());
        let other = format!("outputs/{name}.exr");
        compare(&place, &["outputs/scene.exr", &other]).assert_refused(&[said]);
        // Scenes are refused before an engine is opened for them.
        for first in ["scene.toml", "outputs/scene.exr"] {
            let run = compare(&place, &[first, &file]);
            run.assert_refused(&[said]);
            assert!(!run.err.contains("engine: "), "{run:?}");
        }
    }
    let same = ["outputs/scene.exr", "outputs/scene.exr"];
    for (within, said) in [
        ("-1", "`-1`: must be at least 0"),
        ("nan", "must be a number"),
        ("1e-3,1", "`1`: must be given once"),
        ("regime=1,regime=1", "must be given once"),
        ("forces=1", "must be one of the channels, regime, "),
        ("arc_length_mm=1deg", "unit deg: must be mm"),
        ("force_un=1", "--within force_un: outputs/scene.exr has no such channel; it has regime"),
    ] {
        let within = format!("--within={within}");
        compare(&place, &[&same[..], &[&within]].concat()).assert_refused(&[said]);
    }
    compare(&place, &["outputs/scene.exr", "nowhere.exr"]).assert_refused(&["nowhere.exr"]);
    let output = [&same[..], &["--json", "outputs/scene.exr"]].concat();
    compare(&place, &output).assert_refused(&["is the input"]);
}

/// Marks of yielding are no part of a state. Radii along the whisker, traced shapes, and every row of a table are parts of a scene.
#[test]
fn marks_are_ignored_and_shapes_and_tables_compared() {
    let place = Place::with(SCENE);
    let whisker = |lines: &str| SCENE.replacen("[whisker]\n", &format!("[whisker]\n{lines}"), 1);
    let profile = |middle: f64| {
        let radii = format!("[whisker.profile]\nrows = [[0, 30], [10, {middle}], [20, 1.5]]\n");
        let removed = ["base_radius_um = 30.0\n", "tip_radius_um = 1.5\n"];
        let lines = removed.iter().fold(SCENE.to_owned(), |scene, line| scene.replace(line, ""));
        format!("{lines}{radii}")
    };
    let table = |rows: &str| format!("{SCENE}[whiskers]\ntable = [{rows}]\n");
    let first = r#"{ name = "C1", length_mm = 20 }, "#;
    let rows = |second: &str| table(&format!("{first}{second}"));
    for (name, scene) in [
        ("plain", whisker("")),
        ("marked", whisker("yield_strain = 0.01\n")),
        ("radii", profile(15.0)),
        ("others", profile(16.0)),
        ("table", rows(r#"{ name = "C2", length_mm = 24 }"#)),
        ("longer", rows(r#"{ name = "C2", length_mm = 25 }"#)),
        ("renamed", rows(r#"{ name = "D9", length_mm = 24 }"#)),
    ] {
        let file = format!("{name}.toml");
        place.write(&file, &scene);
        place.map(&[&file, "--channels", "regime", "--no-png"]);
    }
    let maps = |pair: [&str; 2]| pair.map(|name| format!("outputs/{name}.exr"));
    let [plain, marked] = maps(["plain", "marked"]);
    assert_eq!(compare(&place, &[&plain, &marked]).code, Some(0));
    for (pair, said) in [
        (["radii", "others"], "whisker.profile is not the same"),
        (["table", "longer"], "the whisker C2 of the table is not the same"),
        (
            ["table", "renamed"],
            "the axis whisker differs: 2 values from C1 to C2 in the first map, 2 values from C1 to D9",
        ),
    ] {
        let [one, other] = maps(pair);
        compare(&place, &[&one, &other]).assert_refused(&[said]);
    }
}
