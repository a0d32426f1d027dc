//! `whiskmap devices`.

use crate::{Place, SCENE};

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
