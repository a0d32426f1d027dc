//! Maps by the CPU engine, with which tests compare those in each precision.

use crate::compute::compute;
use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock};
use whiskmap::map::{Panel, Summary};
use whiskmap::scene::Scene;

/// Summary and panels of a map.
type WholeMap = (Summary, Vec<Panel>);

/// Maps by the description of their scene. They stay until the program ends.
static MAPS: Mutex<BTreeMap<String, &'static OnceLock<WholeMap>>> = Mutex::new(BTreeMap::new());

/// Returns the map of `scene` by the CPU engine. Equal scenes are computed once.
pub fn by_cpu(scene: &Scene) -> &'static WholeMap {
    let mut maps = MAPS.lock().unwrap();
    let map = *maps.entry(format!("{scene:?}")).or_insert_with(|| Box::leak(Box::default()));
    drop(maps);
    map.get_or_init(|| compute(scene, None))
}
