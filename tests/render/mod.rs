//! Pictures of maps show what the maps hold.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod boundary;
mod documents;
#[path = "../../crates/plot/tests/pictures/drawn.rs"]
mod drawn;
use crate::map;
mod regimes;
mod vision;

use drawn::Pixels;
use map::panel;
use std::collections::BTreeMap;
use whiskmap::map::{Audit, EngineCells, Panel};
use whiskmap::render::{self, MapOptions, Picture, RenderError};
use whiskmap::scene::SceneData;
use whiskmap::store::{MapWriter, Output, StoredMap, TemporaryFiles};

const CONTACT: [u8; 3] = [0x83, 0xc4, 0xa4];
const SLIP_OFF: [u8; 3] = [0xc8, 0x60, 0x2a];
const PULL_OFF: [u8; 3] = [0x22, 0x47, 0x8a];
const OUT_OF_REACH: [u8; 3] = [0xf2, 0xf3, 0xf4];
const UNRESOLVED: [u8; 3] = [0xf0, 0xe4, 0x42];
const BLANK: [u8; 3] = [0xdc, 0xdd, 0xde];

/// How many pixels there are of each colour.
fn colours(picture: &Pixels) -> BTreeMap<[u8; 3], usize> {
    let mut colours = BTreeMap::new();
    for pixel in &picture.pixels {
        *colours.entry(*pixel).or_default() += 1;
    }
    colours
}

/// Writes the panels of a map and draws it.
fn picture(
    scene: &SceneData,
    panels: &[Panel],
    options: &MapOptions,
) -> Result<Picture, RenderError> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("map.exr");
    let tolerances = serde_json::json!(null);
    let mut writer = MapWriter::create(
        Output::create(&file, &TemporaryFiles::default()).unwrap(),
        &map::describe(scene, &tolerances),
    )
    .unwrap();
    writer.write_panels(panels).unwrap();
    writer.finish(EngineCells::default(), Audit::default()).unwrap();
    render::map(&StoredMap::open(&file).unwrap().into(), options)
}

/// Draws one channel of a map, or the regimes.
fn draw(scene: &SceneData, panels: &[Panel], channel: Option<&str>) -> Pixels {
    let options = MapOptions { channel, ..MapOptions::default() };
    Pixels::of(&picture(scene, panels, &options).unwrap())
}

/// A panel all of whose regimes are `regime` and whose quantities are all `value`.
fn flat(scene: &SceneData, regime: &[u32], value: f32) -> Panel {
    let mut flat = panel(scene, 0);
    let cells = flat.regime.len();
    flat.regime = regime.to_vec();
    flat.state = flat.state.map(|_| vec![value; cells]);
    flat.margin_deg = vec![value; cells];
    flat
}
