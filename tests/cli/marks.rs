//! With friction, pictures hatch states that do not slide toward the tip.

use super::{Place, SCENE};
use whiskmap::map::Channels;
use whiskmap::store::{MapDescription, MapWriter, Output, TemporaryFiles};

/// Writes the small map with this friction into its own folder, and returns its name.
fn place(friction: f64) -> Place {
    Place::with(&SCENE.replace("[grid]", &format!("[contact]\nfriction = {friction}\n[grid]")))
}

/// Writes a map without `status`.
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
    let mut writer = MapWriter::create(
        Output::create(&place.path("old.exr"), &TemporaryFiles::default()).unwrap(),
        &about,
    )
    .unwrap();
    writer.write_panels(&map.panels).unwrap();
    let summary = map.summary;
    writer.finish(summary.engine_cells, summary.audit).unwrap();
}

#[test]
fn a_picture_of_loads_is_hatched() {
    const LEGEND: &str = "slides to base, or sticks";
    for (friction, is_hatched) in [(0.3, true), (0.0, false)] {
        let place = place(friction);
        place.map(&["scene.toml", "--no-png"]);
        for (channel, has_loads) in [("force_un", true), ("margin_deg", false)] {
            let channel = format!("--channel={channel}");
            let arguments = ["render", "outputs/scene.exr", &channel, "-o", "s.svg"];
            place.quiet(&arguments);
            let picture = place.text("s.svg");
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
        place.good(&arguments);
        let picture = place.text("s.svg");
        let mut rasters = picture.split("<image");
        let body = rasters.find(|raster| raster.contains("width=\"1280\" height=\"880\""));
        body.unwrap().split_once("/>").unwrap().0.to_owned()
    });
    assert_ne!(with, without);
}
