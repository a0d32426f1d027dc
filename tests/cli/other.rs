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
        run.assert_refused(&["error: outputs/cut.exr is "]);
    }
    assert_eq!(names(&place.path("outputs")), ["cut.exr", "scene.exr"]);
}

/// A file of an incompatible version may mean other things by the same names.
#[test]
fn render_warns_of_another_version() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "--no-png"]);
    let own = env!("CARGO_PKG_VERSION");
    let render = |version: &str| {
        let written = format!("\"{version}\"");
        let mut bytes = place.bytes("outputs/scene.exr");
        let own = format!("\"{own}\"");
        for at in 0..=bytes.len() - own.len() {
            if bytes[at..].starts_with(own.as_bytes()) {
                bytes[at..at + own.len()].copy_from_slice(written.as_bytes());
            }
        }
        std::fs::write(place.path("old.exr"), bytes).unwrap();
        let run = place.run(&["render", "old.exr"]);
        assert_eq!(run.code, Some(0), "{run:?}");
        run.err
    };
    let patch = own.rfind('.').unwrap() + 1;
    assert_eq!(render(own), "");
    assert_eq!(render(&format!("{}9", &own[..patch])), "");
    let other = format!("9{}", &own[1..]);
    let warning = format!("warning: old.exr was written by whiskmap {other}, not by {own}");
    let said = render(&other);
    assert!(
        said.starts_with(&warning) && said.lines().count() == 1,
        "{said}"
    );
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
