//! `whiskmap render` and `whiskmap devices`.

use crate::{Place, SCENE, names};

#[test]
fn render_draws_the_picture_again() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml"]);
    let drawn = place.bytes("outputs/scene.png");
    std::fs::remove_file(place.path("outputs/scene.png")).unwrap();

    let run = place.run(&["render", "outputs/scene.exr"]);
    assert_eq!((run.code, &*run.err), (Some(0), ""), "{run:?}");
    assert!(run.out.trim_end().ends_with("scene.png"), "{run:?}");
    assert!(place.bytes("outputs/scene.png") == drawn);

    let run = place.run(&["render", "outputs/scene.exr", "--channel", "force_un"]);
    assert_eq!((run.code, &*run.err), (Some(0), ""), "{run:?}");
    let force = place.bytes("outputs/scene.force_un.png");
    assert!(force.starts_with(b"\x89PNG") && force != drawn);

    let run = place.run(&["render", "outputs/scene.exr", "-o", "elsewhere.png"]);
    assert_eq!(
        (run.code, &*run.out),
        (Some(0), "elsewhere.png\n"),
        "{run:?}"
    );
    assert!(place.bytes("elsewhere.png") == drawn);
}

#[test]
fn every_channel_can_be_drawn() {
    let place = Place::with(&SCENE.replace("count = 24", "count = 7"));
    place.map(&["scene.toml", "--no-png"]);
    let map = whiskmap::store::StoredMap::open(&place.path("outputs/scene.exr")).unwrap();
    for channel in map.channels() {
        let run = place.run(&["render", "outputs/scene.exr", "--channel", channel]);
        assert_eq!((run.code, &*run.err), (Some(0), ""), "{channel}: {run:?}");
    }
    assert_eq!(
        names(&place.path("outputs")).len(),
        1 + map.channels().len()
    );
}

#[test]
fn render_refuses_what_is_no_map() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "--no-png"]);
    let run = place.run(&["render", "outputs/scene.exr", "--channel", "colour"]);
    let known = [
        "--channel colour",
        "must be one of",
        "regime, ",
        "force_un",
        "margin_deg",
    ];
    run.assert_refused(&known);

    let run = place.run(&["render", "scene.toml"]);
    run.assert_refused(&["scene.toml", "not an EXR file"]);
    let run = place.run(&["render", "nowhere.exr"]);
    run.assert_refused(&["nowhere.exr", "No such file"]);
    place
        .run(&["render", "outputs"])
        .assert_refused(&["outputs"]);

    let whole = place.bytes("outputs/scene.exr");
    for bytes in [0, 4, 100, whole.len() / 2, whole.len() - 1] {
        std::fs::write(place.path("outputs/cut.exr"), &whole[..bytes]).unwrap();
        let run = place.run(&["render", "outputs/cut.exr"]);
        assert!(matches!(run.code, Some(1 | 2)), "{bytes} bytes: {run:?}");
        assert!(run.err.starts_with("error: outputs/cut.exr"), "{run:?}");
    }
    assert_eq!(names(&place.path("outputs")), ["cut.exr", "scene.exr"]);
}

#[test]
fn devices_says_which_engine_auto_takes() {
    let place = Place::with(SCENE);
    let run = place.run(&["devices"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    let last = run.out.lines().last().unwrap();
    assert!(last.starts_with("--engine auto takes "), "{run:?}");
    let map = place.run(&["map", "scene.toml"]);
    let taken = last.strip_prefix("--engine auto takes").unwrap();
    assert_eq!(map.err, format!("engine:{taken}\n"));
    map.assert_settled();
}
