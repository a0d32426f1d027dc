//! Stores of made-up panels.

use super::map::{self, panel};
use std::path::Path;
use whiskmap::map::Channels;
use whiskmap::scene::Scene;
use whiskmap::store::{
    BlockState, CheckDepth, MapDescription, PackedPanel, TemporaryFiles, ZarrStore,
};

/// Two blocks of three and one whiskers.
pub const SCENE: &str = r#"title = "Two blocks"
whisker = { length_mm = 20, base_radius_um = 30, youngs_modulus_gpa = 3 }
pole = { radius_mm = 0.25 }
[grid]
push_angle_deg = { from = -70, to = 70, count = 80 }
distance_mm = { from = 2, to = 20, count = 64 }
taper = [0, 0.5, 0.8, 1]
"#;

/// Returns the description of a map of three channels.
pub fn about<'a>(scene: &'a Scene, arithmetic: &'a str) -> MapDescription<'a> {
    MapDescription {
        channels: Channels::those(|name| ["regime", "status", "force_un"].contains(&name)),
        arithmetic,
        ..map::describe(scene, &serde_json::Value::Null)
    }
}

/// Creates a store of made-up panels at `path`.
pub fn store(path: &Path, text: &str) -> ZarrStore {
    let scene = Scene::parse(text, "scene.toml").unwrap();
    let store = ZarrStore::join(path, &scene, &about(&scene, "fma"), false).unwrap();
    store.begin(&TemporaryFiles::default()).unwrap();
    for block in 0..store.block_count() {
        let panels = store.whiskers(block).map(|whisker| panel(&scene, whisker));
        let packed: Vec<PackedPanel> = panels.map(|panel| store.pack(&panel)).collect();
        store.write(block, &packed, &TemporaryFiles::default()).unwrap();
    }
    store
}

/// Returns true if all checks of a store pass.
pub fn is_sound(path: &Path) -> bool {
    let Ok(store) = ZarrStore::open(path) else {
        return false;
    };
    let mut blocks = 0..store.block_count();
    store.metadata_faults().is_ok_and(|faults| faults.is_empty())
        && blocks.all(|block| matches!(store.state(block, CheckDepth::Values), BlockState::Done))
}
