//! A flipped bit of a store or a map is found, and no reader returns other numbers for it.

use super::made_up::{SCENE, is_sound, store};
use super::map::{self, write};
use std::fs;
use std::path::{Path, PathBuf};
use whiskmap::random::RandomStream;
use whiskmap::store::{ChannelValues, StoreError, StoredMap, ZarrStore};

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

/// Flips a bit of one of `files` in each of `times` trials, and gives the file to `check`.
fn flip_bits(files: &[PathBuf], times: usize, mut check: impl FnMut(&Path)) {
    let mut random = RandomStream::of_state(1);
    let mut below = |end: usize| (random.uniform() * end as f64) as usize;
    for _ in 0..times {
        let file = &files[below(files.len())];
        let whole = fs::read(file).unwrap();
        let mut flipped = whole.clone();
        flipped[below(whole.len())] ^= 1 << below(8);
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
