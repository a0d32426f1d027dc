//! With friction, states that do not slide toward the tip keep the status that marks them.

use super::{Place, Run, SCENE};
use whiskmap::classify::Status;
use whiskmap::map::Channels;
use whiskmap::store::{
    ChannelValues, MapDescription, MapWriter, StoredMap, TemporaryFiles, ZarrStore,
};

/// Writes the small map with this friction into its own folder, and returns its name.
fn place(friction: f64) -> Place {
    Place::with(&SCENE.replace(
        "[grid]",
        &format!("[contact]\nfriction = {friction}\n[grid]"),
    ))
}

fn good(run: Run) -> Run {
    assert_eq!(run.code, Some(0), "{run:?}");
    run
}

const FEW: [&str; 3] = ["scene.toml", "--no-png", "--channels=regime,force_un"];

#[test]
fn a_map_with_friction_keeps_the_status_of_loads() {
    for (friction, wanted) in [
        (0.3, &["regime", "status", "force_un"][..]),
        (0.0, &["regime", "force_un"]),
    ] {
        let place = place(friction);
        place.map(&FEW);
        place.map(&[&FEW[..], &["--format=zarr"]].concat());
        let map = StoredMap::open(&place.path("outputs/scene.exr")).unwrap();
        assert_eq!(map.channels(), wanted);
        let store = ZarrStore::open(&place.path("outputs/scene.zarr")).unwrap();
        assert!(store.channels.names().eq(wanted.iter().copied()));
    }
    // Verdicts and margins are exact with friction, too.
    let place = place(0.3);
    place.map(&["scene.toml", "--no-png", "--channels=regime,margin_deg"]);
    let map = StoredMap::open(&place.path("outputs/scene.exr")).unwrap();
    assert_eq!(map.channels(), ["regime", "margin_deg"]);
    // A picture draws the line of detachments by the margins, and says if there are none.
    let render = || {
        place
            .run(&["render", "outputs/scene.exr", "-o", "map.png"])
            .err
    };
    assert_eq!(render(), "");
    place.map(&["scene.toml", "--no-png", "--channels=regime"]);
    assert_eq!(
        render(),
        "note: no detachment line is drawn: the map has no channel margin_deg\n"
    );
}

/// Returns the number of marked cells of a map.
fn marked(place: &Place) -> usize {
    let map = StoredMap::open(&place.path("outputs/scene.exr")).unwrap();
    let ChannelValues::U32(codes) = map.read_channel("status").unwrap() else {
        panic!("codes are u32");
    };
    let marks = Status::MARKS.map(Status::code);
    codes.iter().filter(|code| marks.contains(code)).count()
}

#[test]
fn a_slice_with_friction_keeps_the_status_of_loads() {
    let place = place(0.3);
    place.map(&["scene.toml", "--no-png"]);
    let extract = |arguments: &[&str]| {
        let source = ["extract", "outputs/scene.exr"];
        good(place.run(&[&source[..], arguments].concat()))
    };
    let table = |arguments: &[&str]| {
        let run = extract(&[arguments, &["-o", "s.csv"]].concat());
        assert_eq!(run.err, "");
        let text = String::from_utf8(place.bytes("s.csv")).unwrap();
        text.lines().next().unwrap().to_owned()
    };
    let axes = "distance_mm,push_angle_deg";
    assert_eq!(
        table(&["--channel=force_un"]),
        format!("{axes},status,status_name,force_un")
    );
    assert_eq!(
        table(&["--channel=margin_deg"]),
        format!("{axes},margin_deg")
    );
    extract(&["--channel=energy_nj", "-o", "s.zarr"]);
    let store = ZarrStore::open(&place.path("s.zarr")).unwrap();
    assert!(store.channels.contains("status"));

    let marked = marked(&place);
    assert!(marked > 10);
    let run = extract(&["--channel=force_un", "-o", "s.npy"]);
    let warning = format!("warning: {marked} of 576 cells of force_un are inexact");
    assert!(run.err.starts_with(&warning), "{run:?}");
    assert!(run.err.contains("--channel status"), "{run:?}");
    assert_eq!(extract(&["--channel=regime", "-o", "s.npy"]).err, "");
}

/// Writes a map without `status`, as older versions did.
fn write_without_status(place: &Place) {
    let scene = whiskmap::scene::Scene::read(place.path("scene.toml")).unwrap();
    let map = whiskmap::map(&scene, whiskmap::Options::default()).unwrap();
    let about = MapDescription {
        scene: &scene,
        engine: &whiskmap::engine::EngineDescription::of(None),
        tolerances: &serde_json::json!({}),
        channels: Channels::those(|name| name != "status" && Channels::STANDARD.contains(name)),
        digits: whiskmap::plan::Digits::ALL,
        arithmetic: "fma",
    };
    let mut writer =
        MapWriter::create(&place.path("old.exr"), &about, &TemporaryFiles::default()).unwrap();
    writer.write_panels(&map.panels).unwrap();
    let summary = map.summary;
    writer.finish(summary.engine_cells, summary.audit).unwrap();
}

#[test]
fn a_source_without_status_is_warned_of() {
    let commands = [
        ["extract", "old.exr", "--channel=force_un", "-o", "s.csv"],
        ["extract", "old.exr", "--channel=force_un", "-o", "s.npy"],
        ["extract", "old.exr", "--channel=force_un", "-o", "s.zarr"],
        ["render", "old.exr", "--channel=force_un", "-o", "s.png"],
    ];
    for (friction, is_warned) in [(0.3, true), (0.0, false)] {
        let place = place(friction);
        write_without_status(&place);
        for command in commands {
            let run = good(place.run(&command));
            let warning = "warning: old.exr has friction, but no channel status";
            assert_eq!(run.err.contains(warning), is_warned, "{run:?}");
        }
        let run = good(place.run(&["render", "old.exr", "-o", "s.png"]));
        assert_eq!(run.err, "");
    }
}

#[test]
fn a_picture_of_loads_is_hatched() {
    const LEGEND: &str = "off: friction is not as assumed";
    for (friction, is_hatched) in [(0.3, true), (0.0, false)] {
        let place = place(friction);
        place.map(&["scene.toml", "--no-png"]);
        for (channel, has_loads) in [("force_un", true), ("margin_deg", false)] {
            let channel = format!("--channel={channel}");
            let arguments = ["render", "outputs/scene.exr", &channel, "-o", "s.svg"];
            assert_eq!(good(place.run(&arguments)).err, "");
            let picture = String::from_utf8(place.bytes("s.svg")).unwrap();
            assert_eq!(picture.contains(LEGEND), is_hatched && has_loads);
        }
    }
    // The cells are hatched, not only the legend.
    let place = place(0.3);
    place.map(&["scene.toml", "--no-png"]);
    write_without_status(&place);
    let [with, without] = ["outputs/scene.exr", "old.exr"].map(|map| {
        let range = "--range=0,100";
        let arguments = ["render", map, "--channel=force_un", range, "-o", "s.svg"];
        good(place.run(&arguments));
        let picture = String::from_utf8(place.bytes("s.svg")).unwrap();
        let mut rasters = picture.split("<image");
        let body = rasters.find(|raster| raster.contains("width=\"1280\" height=\"880\""));
        body.unwrap().split_once("/>").unwrap().0.to_owned()
    });
    assert_ne!(with, without);
}
