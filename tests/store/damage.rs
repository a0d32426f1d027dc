//! Damage to a store or a map is found, and no reader returns other numbers for it.

use super::map::{self, panel, write};
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};
use whiskmap::classify::Regime;
use whiskmap::map::Channels;
use whiskmap::scene::Scene;
use whiskmap::store::{
    BlockState, ChannelValues, CheckDepth, MapDescription, PackedPanel, StoreError, StoredMap,
    TemporaryFiles, ZarrStore,
};

/// Two blocks of three and one whiskers.
const SCENE: &str = r#"title = "Two blocks"
whisker = { length_mm = 20, base_radius_um = 30, youngs_modulus_gpa = 3 }
pole = { radius_mm = 0.25 }
[grid]
push_angle_deg = { from = -70, to = 70, count = 80 }
distance_mm = { from = 2, to = 20, count = 64 }
taper = [0, 0.5, 0.8, 1]
"#;

fn about<'a>(scene: &'a Scene, arithmetic: &'a str) -> MapDescription<'a> {
    MapDescription {
        channels: Channels::those(|name| ["regime", "status", "force_un"].contains(&name)),
        digits: whiskmap::plan::Digits::ALL,
        arithmetic,
        ..map::describe(scene, &serde_json::Value::Null)
    }
}

/// A store of made-up panels at `path`.
fn store(path: &Path, text: &str) -> ZarrStore {
    let scene = Scene::parse(text, "scene.toml").unwrap();
    let store = ZarrStore::join(path, &scene, &about(&scene, "fma"), false).unwrap();
    store.begin(&TemporaryFiles::default()).unwrap();
    for block in 0..store.block_count() {
        let panels = store.whiskers(block).map(|whisker| panel(&scene, whisker));
        let packed: Vec<PackedPanel> = panels.map(|panel| store.pack(&panel)).collect();
        store
            .write(block, &packed, &TemporaryFiles::default())
            .unwrap();
    }
    store
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The bits of every value.
fn bits(samples: &ChannelValues) -> Vec<u64> {
    samples.values().map(f64::to_bits).collect()
}

/// All that readers get of a store: each channel by its bits, the counts and the axes.
fn all_of_store(path: &Path) -> Result<Vec<u64>, StoreError> {
    let store = ZarrStore::open(path)?;
    let mut all: Vec<u64> = Vec::new();
    for channel in store.channels.names() {
        for whisker in 0..store.scene.grid.whisker_count() {
            all.extend(bits(&store.read_panel(channel, whisker)?));
        }
    }
    for block in 0..store.block_count() {
        all.extend(store.regimes(block)?);
    }
    let grid = &store.scene.grid;
    all.extend(grid.distance_mm.iter().map(|value| value.to_bits()));
    all.extend(grid.push_angle_deg.iter().map(|value| value.to_bits()));
    Ok(all)
}

fn is_sound(path: &Path) -> bool {
    let Ok(store) = ZarrStore::open(path) else {
        return false;
    };
    let mut blocks = 0..store.block_count();
    store
        .metadata_faults()
        .is_ok_and(|faults| faults.is_empty())
        && blocks.all(|block| matches!(store.state(block, CheckDepth::Values), BlockState::Done))
}

/// Numbers that look random, always the same.
struct Mixed(u64);

impl Mixed {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % end
    }
}

/// Flips a bit of one of `files` in each of `times` trials, and gives the file to `check`.
fn flip_bits(files: &[PathBuf], times: usize, mut check: impl FnMut(&Path)) {
    let mut mixed = Mixed(1);
    for _ in 0..times {
        let file = &files[mixed.below(files.len())];
        let whole = fs::read(file).unwrap();
        let mut flipped = whole.clone();
        flipped[mixed.below(whole.len())] ^= 1 << mixed.below(8);
        fs::write(file, flipped).unwrap();
        check(file);
        fs::write(file, whole).unwrap();
    }
}

#[test]
fn no_flipped_bit_of_a_store_passes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.zarr");
    store(&path, SCENE);
    assert!(is_sound(&path));
    let whole = all_of_store(&path).unwrap();
    flip_bits(&files(&path), 1000, |file| {
        assert!(!is_sound(&path), "{}", file.display());
        if let Ok(found) = all_of_store(&path) {
            assert!(found == whole, "{}", file.display());
        }
    });
    assert!(is_sound(&path));
}

/// Few bytes of the root matter to readers, so each of its attributes is tried.
#[test]
fn no_flipped_bit_of_the_root_passes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.zarr");
    store(&path, SCENE);
    let root = path.join("zarr.json");
    let whole = fs::read(&root).unwrap();
    let mut added = String::from_utf8(whole.clone()).unwrap();
    added = added.replacen("\"title\"", "\"note\":1,\"title\"", 1);
    fs::write(&root, added).unwrap();
    assert!(!is_sound(&path));
    for place in 0..whole.len().min(2000) {
        let mut flipped = whole.clone();
        flipped[place] ^= 1 << (place % 8);
        fs::write(&root, flipped).unwrap();
        assert!(!is_sound(&path), "byte {place}");
    }
}

/// All that readers get of a map.
fn all_of_map(path: &Path) -> Result<Vec<u64>, StoreError> {
    let map = StoredMap::open(path)?;
    let mut all: Vec<u64> = Vec::new();
    for channel in map.channels() {
        all.extend(bits(&map.read_channel(channel)?));
    }
    all.extend(map.grid.distance_mm.iter().map(|value| value.to_bits()));
    all.extend(map.grid.push_angle_deg.iter().map(|value| value.to_bits()));
    all.extend(map.counts.regimes.values());
    Ok(all)
}

#[test]
fn no_flipped_bit_of_a_map_gives_other_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    write(&path, &map::scene(40, 30, Some(vec![0.5, 0.9]), None));
    let whole = all_of_map(&path).unwrap();
    flip_bits(std::slice::from_ref(&path), 2000, |_| {
        if let Ok(found) = all_of_map(&path) {
            assert!(found == whole);
        }
    });
}

fn damaged(store: &ZarrStore, depth: CheckDepth) -> Vec<String> {
    let states = (0..store.block_count()).map(|block| store.state(block, depth));
    let faults = states.flat_map(|state| match state {
        BlockState::Damaged(faults) => faults,
        _ => Vec::new(),
    });
    faults.map(|fault| fault.to_string()).collect()
}

#[test]
fn files_that_are_cut_or_grown_are_damaged_without_reading_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.zarr");
    let store = store(&path, SCENE);
    let file = path.join("force_un/c.1.0.0");
    let whole = fs::read(&file).unwrap();
    let cut = whole[..whole.len() - 30].to_vec();
    for damage in [vec![], vec![0; 20], cut, [&whole[..], &[0; 9]].concat()] {
        fs::write(&file, damage).unwrap();
        let faults = damaged(&store, CheckDepth::Structure);
        assert_eq!(faults.len(), 1, "{faults:?}");
        assert!(
            faults[0].contains("force_un/c.1.0.0 is damaged"),
            "{faults:?}"
        );
        assert!(store.read_panel("force_un", 3).is_err());
    }
    // A damaged chunk is seen when it is read.
    let mut flipped = whole;
    flipped[100] ^= 4;
    fs::write(&file, flipped).unwrap();
    assert!(damaged(&store, CheckDepth::Structure).is_empty());
    for depth in [CheckDepth::Checksums, CheckDepth::Values] {
        let faults = damaged(&store, depth);
        assert!(
            faults[0].contains("chunk 0 does not have its checksum"),
            "{faults:?}"
        );
    }
}

/// A writer with a fault: the index has its checksum, but not the places and sizes of the chunks.
#[test]
fn an_index_must_fit_the_chunks() {
    const ENTRY: usize = 16;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.zarr");
    let store = store(&path, SCENE);
    let file = path.join("force_un/c.1.0.0");
    let whole = fs::read(&file).unwrap();
    let (sealed, checksum) = whole.split_last_chunk::<4>().unwrap();
    let is_index = |begin: &usize| crc32c::crc32c(&sealed[*begin..]).to_le_bytes() == *checksum;
    let mut begins = (1..).map(|entries| sealed.len() - entries * ENTRY);
    let index = begins.find(is_index).unwrap();
    for (place, by) in [(0, 1), (8, 1), (sealed.len() - index - 8, u8::MAX)] {
        let mut forged = sealed.to_vec();
        forged[index + place] = forged[index + place].wrapping_add(by);
        let checksum = crc32c::crc32c(&forged[index..]).to_le_bytes();
        fs::write(&file, [&forged[..], &checksum].concat()).unwrap();
        let faults = damaged(&store, CheckDepth::Structure);
        let why = "the index does not fit the file's length";
        assert!(faults.len() == 1 && faults[0].contains(why), "{faults:?}");
        assert!(store.read_panel("force_un", 3).is_err());
    }
    let short = vec![0; sealed.len() - index + 4];
    let long = [&whole[..], &vec![0; 1 << 20]].concat();
    for (damage, why) in [(short, "bytes are too few"), (long, "bytes are too many")] {
        fs::write(&file, damage).unwrap();
        let faults = damaged(&store, CheckDepth::Structure);
        assert!(faults.len() == 1 && faults[0].contains(why), "{faults:?}");
    }
}

#[test]
fn blocks_of_other_stores_and_places_are_damaged() {
    let folder = tempfile::tempdir().unwrap();
    let [one, other] = ["one.zarr", "other.zarr"].map(|name| folder.path().join(name));
    let store_of_one = store(&one, SCENE);
    store(&other, &SCENE.replace("0.8, 1]", "0.9, 1]"));
    let file = one.join("regime/c.0.0.0");
    let whole = fs::read(&file).unwrap();
    for foreign in [
        other.join("regime/c.0.0.0"),
        one.join("regime/c.1.0.0"),
        one.join("status/c.0.0.0"),
    ] {
        fs::copy(&foreign, &file).unwrap();
        let faults = damaged(&store_of_one, CheckDepth::Structure);
        assert!(faults[0].contains("belongs to another block"), "{faults:?}");
        assert!(store_of_one.read_panel("regime", 0).is_err());
    }
    fs::write(&file, whole).unwrap();
    assert!(is_sound(&one));
}

/// A writer with a fault: sound files, counts of other regimes.
#[test]
fn counts_are_compared_with_the_regimes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.zarr");
    let store = store(&path, SCENE);
    let scene = Scene::parse(SCENE, "scene.toml").unwrap();
    let counts = path.join("regime_cells/c.1.0");
    let sound = fs::read(&counts).unwrap();
    let mut panel = panel(&scene, 3);
    let contact = panel
        .regime
        .iter()
        .position(|code| *code == Regime::Contact.code());
    panel.regime[contact.unwrap()] = Regime::SlipOff.code();
    store
        .write(1, &[store.pack(&panel)], &TemporaryFiles::default())
        .unwrap();
    assert!(is_sound(&path));
    fs::write(&counts, sound).unwrap();
    let faults = damaged(&store, CheckDepth::Values);
    assert!(
        faults[0].contains("its counts are not those of the array `regime`"),
        "{faults:?}"
    );
}

#[test]
fn a_store_has_one_scene_version_engine_arithmetic_and_accuracy() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.zarr");
    store(&path, SCENE);
    let scene = Scene::parse(SCENE, "scene.toml").unwrap();
    let join = |about: &MapDescription<'_>| {
        let joined = ZarrStore::join(&path, &scene, about, true);
        joined.map(drop).map_err(|why| why.to_string())
    };
    let fma = about(&scene, "fma");
    assert_eq!(join(&fma), Ok(()));
    let why = join(&about(&scene, "no-fma")).unwrap_err();
    assert!(
        why.contains("differs in `arithmetic`: fma there, no-fma here (with and without"),
        "{why}"
    );
    let engine = whiskmap::engine::EngineDescription {
        engine: "gpu f32".to_owned(),
        adapter: String::new(),
    };
    let why = join(&MapDescription {
        engine: &engine,
        ..fma
    })
    .unwrap_err();
    assert!(
        why.contains("differs in `engine`: cpu f64 there, gpu f32 here;"),
        "{why}"
    );
    let tolerances = json!({ "rtol": 1 });
    let why = join(&MapDescription {
        tolerances: &tolerances,
        ..fma
    })
    .unwrap_err();
    assert!(why.contains("differs in `tolerances`"), "{why}");
}

/// Two threads create a store at the same moment with two engines: one succeeds.
#[test]
fn of_two_engines_that_create_a_store_one_succeeds() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Scene::parse(SCENE, "scene.toml").unwrap();
    for race in 0..50 {
        let path = folder.path().join(format!("{race}.zarr"));
        let start = std::sync::Barrier::new(2);
        let create = |name: &str| {
            let engine = whiskmap::engine::EngineDescription {
                engine: name.to_owned(),
                adapter: String::new(),
            };
            let about = MapDescription {
                engine: &engine,
                ..about(&scene, "fma")
            };
            let store = ZarrStore::join(&path, &scene, &about, true).unwrap();
            start.wait();
            store
                .begin(&TemporaryFiles::default())
                .map_err(|why| why.to_string())
        };
        let results = std::thread::scope(|scope| {
            let both = ["cpu f64", "gpu f32"].map(|name| scope.spawn(move || create(name)));
            both.map(|thread| thread.join().unwrap())
        });
        let why = match &results {
            [Ok(_), Err(why)] | [Err(why), Ok(_)] => why,
            _ => panic!("{results:?}"),
        };
        assert!(why.contains("differs in `engine`: "), "{why}");
        assert!(
            ZarrStore::open(&path)
                .unwrap()
                .metadata_faults()
                .unwrap()
                .is_empty()
        );
    }
}
