//! A file is whole or not there, and what is no map is refused.

use super::map::{self, panel, scene, write};
use super::sweeps;
use serde_json::json;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use whiskmap::map::{Audit, EngineCells, Panel};
use whiskmap::store::{
    MapSlice, MapSource, MapWriter, Output, StoreError, StoredMap, TemporaryFiles,
};

fn listing(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn a_map_appears_only_when_it_is_finished() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    let scene = scene(5, 4, Some(vec![0.5, 0.9]), None);
    let tolerances = json!(null);
    let about = map::describe(&scene, &tolerances);

    let mut dropped =
        MapWriter::create(Output::create(&path, &TemporaryFiles::default()).unwrap(), &about)
            .unwrap();
    dropped.write_panels(&[panel(&scene, 0)]).unwrap();
    assert_eq!(listing(folder.path()).len(), 1);
    assert!(!path.exists());
    drop(dropped);
    assert!(listing(folder.path()).is_empty());

    let mut short =
        MapWriter::create(Output::create(&path, &TemporaryFiles::default()).unwrap(), &about)
            .unwrap();
    short.write_panels(&[panel(&scene, 0)]).unwrap();
    let error = short.finish(EngineCells::default(), Audit::default()).unwrap_err().to_string();
    assert_eq!(error, "the map was finished after 1 of 2 panels");
    assert!(listing(folder.path()).is_empty());

    fs::write(&path, "an older map").unwrap();
    write(&path, &scene);
    assert_eq!(listing(folder.path()), ["map.exr"]);
    StoredMap::open(&path).unwrap();

    let nowhere = folder.path().join("no such folder/map.exr");
    let error = Output::create(&nowhere, &TemporaryFiles::default()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::NotFound);
}

#[cfg(unix)]
#[test]
fn a_map_has_the_permissions_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    write(&path, &scene(2, 2, None, None));
    let plain = folder.path().join("plain");
    fs::write(&plain, "").unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&path), mode(&plain));
}

#[test]
fn a_panel_that_does_not_fit_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    let scene = scene(5, 4, Some(vec![0.5, 0.9]), None);
    let tolerances = json!(null);
    let mut writer = MapWriter::create(
        Output::create(&path, &TemporaryFiles::default()).unwrap(),
        &map::describe(&scene, &tolerances),
    )
    .unwrap();
    let good = panel(&scene, 0);
    let mut refusal = |panels: &[Panel]| writer.write_panels(panels).unwrap_err().to_string();
    assert_eq!(
        refusal(&[good.clone(), good.clone(), good.clone()]),
        "there is no panel 2; the map has 2"
    );
    let mut small = good.clone();
    small.state[3].pop();
    assert_eq!(refusal(&[small]), "panel 0: channel `base_force_x_un` has 19 cells instead of 20");
    let mut strange = good.clone();
    strange.regime[7] = 99;
    assert_eq!(
        refusal(&[strange.clone()]),
        "panel 0: channel `regime` holds the code 99, which has no name"
    );
    // None of them was counted.
    assert!(refusal(&[good.clone(), strange]).starts_with("panel 1: "));
    writer.write_panels(&[good.clone(), good]).unwrap();
    let counts = writer.finish(EngineCells::default(), Audit::default()).unwrap().counts;
    assert_eq!(counts.regimes.values().sum::<u64>(), 40);
}

/// The only panel of a map may come in bands of whole blocks; the file has the same bytes.
#[test]
fn bands_make_the_same_file() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(5, 70, None, None);
    let tolerances = json!(null);
    let about = map::describe(&scene, &tolerances);
    let whole = panel(&scene, 0);
    let rows = |from: usize, to: usize| {
        let cells = from * 5..to * 5;
        let mut band = whole.clone();
        let codes = [&mut band.regime, &mut band.status, &mut band.newton_steps];
        for codes in codes {
            *codes = codes[cells.clone()].to_vec();
        }
        let numbers = [&mut band.residual, &mut band.margin_deg];
        for numbers in band.state.iter_mut().chain(numbers) {
            *numbers = numbers[cells.clone()].to_vec();
        }
        band
    };
    let write = |name: &str, bands: &[Panel]| {
        let path = folder.path().join(name);
        let mut writer =
            MapWriter::create(Output::create(&path, &TemporaryFiles::default()).unwrap(), &about)
                .unwrap();
        for band in bands {
            writer.write_panels(std::slice::from_ref(band))?;
        }
        writer.finish(EngineCells::default(), Audit::default())?;
        Ok::<_, StoreError>(fs::read(&path).unwrap())
    };
    let expected = write("whole", std::slice::from_ref(&whole)).unwrap();
    let bands = [rows(0, 32), rows(32, 48), rows(48, 70)];
    assert!(write("bands", &bands).unwrap() == expected);
    let refusal = |bands: &[Panel]| write("refused", bands).unwrap_err().to_string();
    assert_eq!(
        refusal(&[rows(0, 32), rows(32, 50)]),
        "panel 0: channel `regime` has 90 cells instead of 190"
    );
    assert_eq!(refusal(&bands[..2]), "the map was finished after 0 of 1 panels");
    assert_eq!(refusal(&[whole.clone(), rows(0, 16)]), "there is no panel 1; the map has 1");
}

#[test]
fn an_unknown_channel_is_refused_with_the_known_ones() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    write(&path, &scene(2, 2, None, None));
    let map = StoredMap::open(&path).unwrap();
    let error = map.read_channel("force").unwrap_err().to_string();
    for name in ["`force`", "regime", "force_un", "margin_deg"] {
        assert!(error.contains(name), "{error}");
    }
    let error = map.read_panel("regime", 1).unwrap_err().to_string();
    assert_eq!(error, "there is no panel 1; the map has 1");
}

/// A part of a map has fewer panels than the map.
#[test]
fn a_part_has_its_own_panels() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    write(&path, &scene(2, 2, Some(vec![0.5, 0.9]), None));
    let part = |wanted: &[&str]| {
        let wanted: Vec<_> = wanted.iter().map(|at| at.parse().unwrap()).collect();
        MapSlice::new(MapSource::open(&path).unwrap(), &wanted, true)
    };
    let second = part(&["taper=0.9"]).unwrap();
    assert_eq!(second.shape(), [2, 2]);
    assert!(second.read_panel("regime", 0).is_ok());
    let error = second.read_panel("regime", 1).unwrap_err().to_string();
    assert_eq!(error, "there is no panel 1; the map has 1");
    let row = part(&["distance_mm=3", "taper=0.5"]).unwrap();
    assert_eq!(row.shape(), [2]);
    let error = part(&["taper=0.5", "taper=0.9"]).unwrap_err().to_string();
    assert_eq!(error, "taper: is given twice");
}

#[test]
fn files_of_other_kinds_are_distinguished() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    let missing = StoredMap::open(&path).unwrap_err();
    assert!(matches!(missing, StoreError::Read(..)));
    for text in ["", "\x76", "this is no picture"] {
        fs::write(&path, text).unwrap();
        let error = StoredMap::open(&path).unwrap_err();
        assert!(matches!(error, StoreError::NotExr { .. }), "{error}");
    }
    exr::prelude::write_rgb_file(&path, 4, 4, |x, y| (x as f32, y as f32, 0.0)).unwrap();
    let error = StoredMap::open(&path).unwrap_err();
    assert!(matches!(error, StoreError::NotAMap { .. }), "{error}");
}

#[test]
fn channels_that_do_not_fit_the_axes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    write(&path, &scene(3, 2, None, None));
    let mut bytes = fs::read(&path).unwrap();
    let name = b"newton_steps\0";
    let place = bytes.windows(name.len()).position(|found| found == name);
    bytes[place.unwrap()] = b'm';
    super::sealed::seal(&mut bytes);
    fs::write(&path, bytes).unwrap();
    let error = StoredMap::open(&path).unwrap_err();
    assert!(matches!(error, StoreError::NotAMap { .. }), "{error}");
}

/// Headers with their checksum, whose axes do not increase or do not give the number of panels.
#[test]
fn axes_that_contradict_themselves_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    for (text, forged, why) in [
        ("[3.0,20.5]", "[3e1,20.5]", "the values of `distance_mm` do not increase"),
        ("[3.0,20.5]", "[3.0,3.00]", "the values of `distance_mm` do not increase"),
        ("[2,1]", "[1,2]", "attributes `panels` and `axes` differ"),
    ] {
        write(&path, &scene(3, 2, Some(vec![0.5, 0.9]), None));
        let mut bytes = fs::read(&path).unwrap();
        let places: Vec<usize> = (0..bytes.len() - text.len())
            .filter(|place| bytes[*place..].starts_with(text.as_bytes()))
            .collect();
        assert_eq!(places.len(), 3, "one for each part");
        for place in places {
            bytes[place..place + text.len()].copy_from_slice(forged.as_bytes());
        }
        super::sealed::seal(&mut bytes);
        fs::write(&path, bytes).unwrap();
        let error = StoredMap::open(&path).unwrap_err().to_string();
        assert!(error.contains(why), "{error}");
    }
}

/// The table of positions has no checksum.
#[test]
fn a_block_in_the_place_of_another_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    write(&path, &scene(23, 37, None, None));
    let mut bytes = fs::read(&path).unwrap();
    let mut header = std::io::Cursor::new(&bytes[..]);
    exr::meta::MetaData::read_from_buffered(&mut header, true).unwrap();
    let table = header.position() as usize;
    let (one, other) = bytes[table..table + 16].split_at_mut(8);
    one.swap_with_slice(other);
    fs::write(&path, bytes).unwrap();
    let error = StoredMap::open(&path).unwrap().read_channel("regime").unwrap_err().to_string();
    assert!(error.contains("another block is in its place"), "{error}");
}

/// Opens a file and reads every block of it.
fn read_all(path: &Path) -> Result<(), StoreError> {
    let map = StoredMap::open(path)?;
    for name in ["regime", "force_un", "residual"] {
        map.read_channel(name)?;
    }
    Ok(())
}

#[test]
fn a_file_cut_short_is_an_error_at_every_length() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    for (taper, curvature) in sweeps() {
        write(&path, &scene(3, 2, taper, curvature));
        let whole = fs::read(&path).unwrap();
        read_all(&path).unwrap();
        for length in (0..whole.len()).rev().step_by(17) {
            fs::write(&path, &whole[..length]).unwrap();
            let error = read_all(&path).unwrap_err();
            assert!(
                matches!(error, StoreError::NotExr { .. } | StoreError::Damaged { .. }),
                "{length}: {error}"
            );
        }
    }
}

#[test]
fn a_spoiled_byte_never_panics() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    let mut refused = 0;
    for (taper, curvature) in sweeps() {
        write(&path, &scene(3, 2, taper, curvature));
        let whole = fs::read(&path).unwrap();
        for place in (0..whole.len()).step_by(11) {
            let mut spoiled = whole.clone();
            spoiled[place] ^= 1 << (place % 8);
            fs::write(&path, &spoiled).unwrap();
            refused += usize::from(read_all(&path).is_err());
        }
    }
    assert!(refused > 300, "{refused}");
}
