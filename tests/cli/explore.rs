//! `whiskmap explore`.

use super::{Place, SCENE, names};
use serde_json::Value;
use std::path::Path;

/// Scene and points on a page, as its script reads them.
fn start(page: &[u8]) -> Value {
    let page = std::str::from_utf8(page).unwrap();
    let (_, rest) = page.split_once("id=\"start\">").unwrap();
    serde_json::from_str(rest.split("</script>").next().unwrap()).unwrap()
}

#[test]
fn a_page_has_scene_and_points() {
    let title = "title = '</script><script>alert(1)</script>'";
    let scene = SCENE.lines().map(|line| match line.starts_with("title") {
        true => format!("{title}\n"),
        false => format!("{line}\n"),
    });
    let scene: String = scene.collect();
    let place = Place::with(&scene);
    let points = "side,distance_mm,push_angle_deg,kind\ncb,15,16.5,slip-off\ncf,10,-40.25,\n";
    place.write("points.csv", points);
    let words = ["explore", "scene.toml", "--data", "points.csv", "--no-open"];
    let run = place.quiet(&[&words[..], &["-o", "page.html"]].concat());
    assert_eq!(run.out, "page.html\n");
    let start = start(&place.bytes("page.html"));
    assert_eq!(start["scene"]["text"], scene);
    assert_eq!(start["scene"]["origin"], "scene.toml");
    assert_eq!(start["points"]["csv"], points);
}

#[test]
fn a_map_and_a_store_have_their_scene() {
    let place = Place::with(SCENE);
    for format in ["exr", "zarr"] {
        place.map(&["scene.toml", "--no-png", "-o", ".", "--format", format]);
        let map = format!("scene.{format}");
        let page = place.quiet(&["explore", &map, "-o", "-"]);
        let start = start(page.out.as_bytes());
        assert_eq!(start["scene"]["text"], SCENE);
        // A name that is not that of a scene file: commands on the page contain the scene.
        assert_eq!(start["scene"]["origin"], map);
    }
}

#[test]
fn a_page_without_a_name_is_in_a_folder_that_is_created() {
    let place = Place::with(SCENE);
    let run = place.quiet(&["explore", "scene.toml"]);
    let page = Path::new("outputs").join("scene.html");
    assert_eq!(run.out, format!("{}\n", page.display()));
    assert_eq!(names(&place.path("outputs")), ["scene.html"]);
}

#[test]
fn bad_inputs_are_refused() {
    let place = Place::with(SCENE);
    let far = "side,distance_mm,push_angle_deg\ncb,500,16\n";
    place.write("far.csv", far);
    for (words, why) in [
        (&["explore", "none.toml"][..], "none.toml"),
        (&["explore", "none.exr"], "none.exr"),
        (&["explore", "scene.toml", "--data", "far.csv"], "distance_mm = 500: must be between"),
        (&["explore", "scene.toml", "-o", "scene.toml"], "--output scene.toml"),
    ] {
        let run = place.run(words);
        assert_ne!(run.code, Some(0), "{words:?}");
        assert!(run.err.contains(why), "{words:?} {}", run.err);
    }
}
