//! Maps and stores that another process replaces while they are read.

use super::made_up::{self, store};
use super::map::{self, panel, scene};
use serde_json::json;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use whiskmap::map::{Audit, EngineCells};
use whiskmap::scene::SceneData;
use whiskmap::store::{
    ChannelValues, MapSlice, MapSource, MapWriter, Output, StoreError, StoredMap, TemporaryFiles,
};

/// Title and bits of all values of a map, channel by channel, as text.
fn whole(map: &StoredMap) -> Result<String, StoreError> {
    let mut found = format!("{} {:?}", map.title, map.counts);
    for name in map.channels() {
        for panel in 0..map.layout.panels() {
            let bits: Vec<u32> = match map.read_panel(name, panel)? {
                ChannelValues::F32(values) => values.into_iter().map(f32::to_bits).collect(),
                ChannelValues::U32(codes) => codes,
            };
            found += &format!("{bits:x?}");
        }
    }
    Ok(found)
}

/// Two scenes of six whiskers with equal grids, whose maps differ in the title and in all values.
fn scenes() -> [SceneData; 2] {
    let first = scene(7, 5, Some(vec![0.5, 0.75, 0.95]), Some(vec![0.0, 0.012]));
    let mut second = SceneData::clone(&first);
    second.title = "Another map".to_owned();
    [SceneData::clone(&first), second]
}

/// Writes the map of `scene`, with panels that begin at the index `from`.
fn write_from(path: &Path, scene: &SceneData, from: usize) -> StoredMap {
    let tolerances = json!(null);
    let about = map::describe(scene, &tolerances);
    let mut writer =
        MapWriter::create(Output::create(path, &TemporaryFiles::default()).unwrap(), &about)
            .unwrap();
    for index in 0..scene.whisker_count() {
        writer.write_panels(&[panel(scene, from + index)]).unwrap();
    }
    writer.finish(EngineCells::default(), Audit::default()).unwrap()
}

/// Another thread replaces the map without a pause, by the one and the other of two maps in turn.
#[test]
fn every_read_of_a_map_that_is_replaced_is_one_of_the_two() {
    let folder = tempfile::tempdir().unwrap();
    let [one, two] = scenes();
    let names = ["one.exr", "two.exr", "map.exr", "next.exr"];
    let [first, second, path, next] = names.map(|name| folder.path().join(name));
    let expected = [(&first, &one, 0), (&second, &two, 7)]
        .map(|(path, scene, from)| whole(&write_from(path, scene, from)).unwrap());
    assert_ne!(expected[0], expected[1]);
    fs::copy(&first, &path).unwrap();
    let is_read = AtomicBool::new(false);
    let mut met = [0; 2];
    thread::scope(|threads| {
        threads.spawn(|| {
            for source in [&second, &first].into_iter().cycle().take(10_000_000) {
                if is_read.load(Ordering::Relaxed) {
                    break;
                }
                fs::copy(source, &next).unwrap();
                fs::rename(&next, &path).unwrap();
            }
        });
        let reads: Vec<_> = (0..300).map(|_| whole(&StoredMap::open(&path)?)).collect();
        is_read.store(true, Ordering::Relaxed);
        for found in reads {
            let found = found.unwrap();
            let place = expected.iter().position(|scene| *scene == found);
            met[place.unwrap()] += 1;
        }
    });
    assert_eq!(met.iter().sum::<usize>(), 300);
}

#[test]
fn an_open_map_stays_the_file_that_was_opened() {
    let folder = tempfile::tempdir().unwrap();
    let [one, two] = scenes();
    let path = folder.path().join("map.exr");
    let written = write_from(&path, &one, 0);
    let opened = StoredMap::open(&path).unwrap();
    let expected = whole(&written).unwrap();
    write_from(&path, &two, 7);
    // The map that a writer returns is its own, too.
    for map in [&written, &opened] {
        assert_eq!(whole(map).unwrap(), expected);
        let scene = map.attribute("scene").unwrap();
        assert_eq!(scene, json!(one.text.to_string()));
    }
    fs::remove_file(&path).unwrap();
    assert_eq!(whole(&opened).unwrap(), expected);
}

/// The files of a store are opened one by one. Those of another store are not its values, and not damaged.
#[test]
fn a_store_that_is_replaced_while_it_is_read_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let [path, other] = ["store.zarr", "other.zarr"].map(|name| folder.path().join(name));
    store(&path, made_up::SCENE);
    store(&other, &made_up::SCENE.replace("0.25", "0.26"));
    let slice = MapSlice::whole(MapSource::open(&path).unwrap());
    slice.read_panel("regime", 0).unwrap();
    fs::remove_dir_all(&path).unwrap();
    let removed = slice.read_panel("regime", 1).unwrap_err();
    fs::rename(&other, &path).unwrap();
    let replaced = slice.read_panel("regime", 1).unwrap_err();
    for why in [removed, replaced] {
        assert!(matches!(why, StoreError::Displaced(_)), "{why}");
    }
    // A file that is damaged or missing in its own store is reported as such.
    let opened = MapSource::open(&path).unwrap();
    fs::remove_file(path.join("regime/c.0.0.0")).unwrap();
    let missing = opened.read_panel("regime", 0).unwrap_err();
    assert!(matches!(missing, StoreError::Unfinished(_)), "{missing}");
}
