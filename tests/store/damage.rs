//! Damaged files and forged contents of a store are found, and not read.

use super::made_up::{SCENE, is_sound, store};
use super::map::panel;
use std::fs;
use std::path::Path;
use whiskmap::classify::Regime;
use whiskmap::scene::Scene;
use whiskmap::store::{
    BlockState, CheckDepth, MapSlice, MapSource, NOT_COMPUTED, TemporaryFiles, ZarrStore,
};

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
        let name = Path::new("force_un").join("c.1.0.0");
        let said = format!("{} is damaged", name.display());
        assert!(faults[0].contains(&said), "{faults:?}");
        assert!(store.read_panel("force_un", 3).is_err());
    }
    // A damaged chunk is seen when it is read.
    let mut flipped = whole;
    flipped[100] ^= 4;
    fs::write(&file, flipped).unwrap();
    assert!(damaged(&store, CheckDepth::Structure).is_empty());
    let faults = damaged(&store, CheckDepth::Values);
    assert!(faults[0].contains("chunk 0 does not have its checksum"), "{faults:?}");
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
    // Sizes of which one wraps around.
    let mut forged = sealed.to_vec();
    let entries = [index + 2 * ENTRY - 8, index + 2 * ENTRY, index + 2 * ENTRY + 8];
    let number = |place: usize| u64::from_le_bytes(sealed[place..place + 8].try_into().unwrap());
    let [size, begin, last] = entries.map(number);
    for (place, number) in entries.into_iter().zip([u64::MAX, begin - size - 1, last + size + 1]) {
        forged[place..place + 8].copy_from_slice(&number.to_le_bytes());
    }
    let checksum = crc32c::crc32c(&forged[index..]).to_le_bytes();
    let wrapped = [&forged[..], &checksum].concat();
    let short = vec![0; sealed.len() - index + 4];
    // Identity, three chunks that are not compressed, and the index.
    let most = 16 + 3 * (80 * 64 * 4 + 20) + 3 * ENTRY + 4;
    let long = [&whole[..], &vec![0; most + 1 - whole.len()]].concat();
    for (damage, why) in [
        (wrapped, "the index does not fit the file's length"),
        (short, "bytes are too few"),
        (long, "bytes are too many"),
    ] {
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
    for foreign in
        [other.join("regime/c.0.0.0"), one.join("regime/c.1.0.0"), one.join("status/c.0.0.0")]
    {
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
    let contact = panel.regime.iter().position(|code| *code == Regime::Contact.code());
    panel.regime[contact.unwrap()] = Regime::SlipOff.code();
    store.write(1, &[store.pack(&panel)], &TemporaryFiles::default()).unwrap();
    assert!(is_sound(&path));
    fs::write(&counts, sound).unwrap();
    let faults = damaged(&store, CheckDepth::Values);
    assert!(faults[0].contains("its counts are not those of the array `regime`"), "{faults:?}");
}

/// A writer with a fault: a code without a name, with counts that fit.
#[test]
fn codes_without_a_name_are_damaged() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.zarr");
    let store = store(&path, SCENE);
    let scene = Scene::parse(SCENE, "scene.toml").unwrap();
    let mut panel = panel(&scene, 3);
    panel.regime[7] = 99;
    store.write(1, &[store.pack(&panel)], &TemporaryFiles::default()).unwrap();
    let faults = damaged(&store, CheckDepth::Values);
    assert_eq!(faults.len(), 1);
    assert!(faults[0].contains("the code 99 has no name"), "{faults:?}");
}

#[test]
fn metadata_of_more_than_16_mib_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.zarr");
    store(&path, SCENE);
    let root = path.join("zarr.json");
    let mut bytes = fs::read(&root).unwrap();
    bytes.resize(16 << 20, b' ');
    fs::write(&root, &bytes).unwrap();
    ZarrStore::open(&path).unwrap();
    bytes.push(b' ');
    fs::write(&root, &bytes).unwrap();
    let why = ZarrStore::open(&path).unwrap_err().to_string();
    assert!(why.contains("is longer than 16 MiB"), "{why}");
}

/// Whiskers of unfinished blocks, which follow one another, read as not computed.
#[test]
fn missing_blocks_read_as_not_computed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.zarr");
    let store = store(&path, SCENE);
    for file in ["force_un/c.0.0.0", "regime/c.1.0.0"] {
        fs::remove_file(path.join(file)).unwrap();
    }
    for block in 0..2 {
        let state = store.state(block, CheckDepth::Structure);
        assert!(matches!(state, BlockState::Missing), "{state:?}");
    }
    let mut slice = MapSlice::whole(MapSource::open(&path).unwrap());
    assert!(slice.read_panel("force_un", 0).is_err());
    assert_eq!(slice.blank_missing().unwrap(), 4);
    for whisker in 0..4 {
        let codes = slice.read_panel("regime", whisker).unwrap();
        assert!(codes.values().all(|code| code == f64::from(NOT_COMPUTED)));
        let forces = slice.read_panel("force_un", whisker).unwrap();
        assert!(forces.values().all(f64::is_nan));
    }
    let metadata = fs::read_to_string(path.join("regime/zarr.json")).unwrap();
    assert!(metadata.contains(&format!("\"fill_value\":{NOT_COMPUTED}")));
}
