//! What is written comes back.

use super::map::{self, panel, scene, write};
use super::sweeps;
use serde_json::json;
use std::fs;
use whiskmap::classify::{Regime, Status};
use whiskmap::map::{Audit, EngineCells, Panel, STATE_CHANNELS};
use whiskmap::store::{AtlasLayout, ChannelValues, MapWriter, Output, StoredMap, TemporaryFiles};

fn bits(samples: &ChannelValues) -> Vec<u32> {
    match samples {
        ChannelValues::F32(values) => values.iter().map(|value| value.to_bits()).collect(),
        ChannelValues::U32(values) => values.clone(),
    }
}

/// A channel of a panel, by the name it has in the file.
fn channel(panel: &Panel, name: &str) -> ChannelValues {
    match name {
        "regime" => ChannelValues::U32(panel.regime.clone()),
        "status" => ChannelValues::U32(panel.status.clone()),
        "newton_steps" => ChannelValues::U32(panel.newton_steps.clone()),
        "residual" => ChannelValues::F32(panel.residual.clone()),
        "margin_deg" => ChannelValues::F32(panel.margin_deg.clone()),
        _ => {
            let place = STATE_CHANNELS.iter().position(|known| *known == name);
            ChannelValues::F32(panel.state[place.unwrap()].clone())
        }
    }
}

#[test]
fn every_channel_of_every_panel_comes_back_bit_for_bit() {
    for (taper, curvature) in sweeps() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.exr");
        // 37 rows are two blocks of 16 scan lines and one of 5.
        let scene = scene(23, 37, taper, curvature);
        write(&path, &scene);
        let map = StoredMap::open(&path).unwrap();
        let layout = AtlasLayout::of(&scene.grid);
        assert_eq!(map.layout, layout);
        assert_eq!(map.channels().len(), STATE_CHANNELS.len() + 5);
        for name in map.channels() {
            let mut whole = Vec::new();
            for index in 0..layout.panels() {
                let expected = bits(&channel(&panel(&scene, index), name));
                let found = bits(&map.read_panel(name, index).unwrap());
                assert_eq!(found, expected, "{name} of panel {index}");
                whole.extend(found);
            }
            assert_eq!(bits(&map.read_channel(name).unwrap()), whole, "{name}");
        }
        let ChannelValues::F32(force) = map.read_channel("force_un").unwrap() else {
            panic!("forces are f32");
        };
        assert!(force.iter().any(|value| value.is_nan()) && force.iter().any(|f| f.is_finite()));
    }
}

#[test]
fn every_attribute_comes_back() {
    for (taper, curvature) in sweeps() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.exr");
        let mut scene = scene(3, 2, taper, curvature);
        scene.title = "Whisker of 100 \u{b5}m, \"\u{1f400}\"".to_owned();
        scene.text =
            whiskmap::scene::SceneText::of_source("title = \"\u{e9}\\\"\"\n\t# \u{4e2d}\n");
        scene.grid.distance_mm = vec![0.1 + 0.2, 2.5e300];
        // Many values with 17 digits: a parser that rounds twice loses some of them.
        scene.grid.push_angle_deg = map::spread(-60.0 / 7.0, 70.0 / 3.0, 997);
        let counts = write(&path, &scene);
        let map = StoredMap::open(&path).unwrap();
        assert_eq!(map.title, scene.title);
        assert_eq!(map.grid, scene.grid);
        assert_eq!(map.counts, counts);
        let layout = map.layout;
        let attribute = |name| map.attribute(name).unwrap();
        assert_eq!(attribute("scene"), json!(scene.text.to_string()));
        assert_eq!(attribute("whiskmap_version"), json!(env!("CARGO_PKG_VERSION")));
        assert_eq!(attribute("engine"), json!("cpu f64"));
        assert_eq!(attribute("adapter"), json!("a \u{201c}card\u{201d}"));
        assert_eq!(attribute("tolerances"), json!({"rtol": 0.1 + 0.2}));
        assert_eq!(attribute("panels"), json!([layout.columns, layout.rows]));
        assert_eq!(attribute("axes")[1]["unit"], "mm");
        assert_eq!(attribute("axes")[1]["direction"], "y");
        assert_eq!(map.regime_names[&255], "unresolved");
        let not_converged = Status::NotConverged;
        assert_eq!(map.status_names[&101], not_converged.name());
        assert_eq!(map.status_names.len(), Status::ALL.len());
        let error = map.attribute("weather").unwrap_err().to_string();
        assert!(error.contains("`weather`"), "{error}");
    }
}

#[test]
fn the_header_counts_the_cells() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    let scene = scene(40, 30, Some(vec![0.5, 0.9]), None);
    let counts = write(&path, &scene);
    let map = StoredMap::open(&path).unwrap();
    let ChannelValues::U32(regimes) = map.read_channel("regime").unwrap() else {
        panic!("regimes are u32");
    };
    for (code, name) in &map.regime_names {
        let cells = regimes.iter().filter(|found| *found == code).count();
        assert_eq!(counts.regimes[name], cells as u64, "{name}");
    }
    assert_eq!(counts.regimes.values().sum::<u64>(), regimes.len() as u64);
    assert_eq!(counts.statuses.values().sum::<u64>(), regimes.len() as u64);
    let worst = map.read_channel("residual").unwrap();
    let worst = worst.values().filter(|value| !value.is_nan());
    assert_eq!(counts.worst_residual, worst.reduce(f64::max));
    assert!(counts.worst_residual.is_some());
}

/// The residual of an unresolved cell is that of no state.
#[test]
fn unresolved_cells_do_not_count_for_the_worst_residual() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    let scene = scene(40, 30, None, None);
    let tolerances = json!(null);
    let about = map::describe(&scene, &tolerances);
    let mut writer =
        MapWriter::create(Output::create(&path, &TemporaryFiles::default()).unwrap(), &about)
            .unwrap();
    let mut panel = panel(&scene, 0);
    panel.regime[0] = Regime::Unresolved.code();
    panel.residual[0] = 1.0;
    writer.write_panels(&[panel]).unwrap();
    let counts = writer.finish(EngineCells::default(), Audit::default()).unwrap().counts;
    // Residuals of made-up cells are at most 70e-9.
    assert!(counts.worst_residual.unwrap() < 1e-6);
}

#[test]
fn equal_maps_have_equal_bytes_all_attributes_ascii() {
    for (taper, curvature) in sweeps() {
        let folder = tempfile::tempdir().unwrap();
        let mut scene = scene(23, 37, taper, curvature);
        scene.title = "\u{b5}".to_owned();
        let files = ["one.exr", "two.exr"].map(|name| {
            write(&folder.path().join(name), &scene);
            fs::read(folder.path().join(name)).unwrap()
        });
        assert!(files[0] == files[1]);
        let meta = exr::meta::MetaData::read_from_buffered(&files[0][..], true).unwrap();
        assert_eq!(meta.headers.len(), 3);
        for header in &meta.headers {
            assert_eq!(header.own_attributes.other.len(), 13);
            for value in header.own_attributes.other.values() {
                assert!(value.to_text().unwrap().bytes().is_ascii());
            }
        }
    }
}

#[test]
fn another_strict_reader_finds_every_cell_where_the_axes_say() {
    use exr::prelude::*;
    for (taper, curvature) in sweeps() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.exr");
        let scene = scene(23, 37, taper, curvature);
        write(&path, &scene);
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .all_layers()
            .all_attributes()
            .pedantic()
            .from_file(&path)
            .unwrap();
        let names = image.layer_data.iter().map(|layer| &layer.attributes);
        let names: Vec<_> =
            names.map(|name| name.layer_name.clone().unwrap().to_string()).collect();
        assert_eq!(names, ["regime", "state", "numerics"]);
        let layout = AtlasLayout::of(&scene.grid);
        let width = layout.columns * 23;
        for found in image.layer_data.iter().flat_map(|layer| &layer.channel_data.list) {
            let name = found.name.to_string();
            for index in 0..layout.panels() {
                let (column, row) = (index % layout.columns, index / layout.columns);
                let expected = channel(&panel(&scene, index), &name);
                for (cell, expected) in bits(&expected).into_iter().enumerate() {
                    let (x, y) = (column * 23 + cell % 23, row * 37 + cell / 23);
                    let found = match &found.sample_data {
                        FlatSamples::F32(values) => values[y * width + x].to_bits(),
                        FlatSamples::U32(values) => values[y * width + x],
                        FlatSamples::F16(_) => panic!("no channel is f16"),
                    };
                    assert_eq!(found, expected, "{name} at {x}, {y}");
                }
            }
        }
    }
}

#[test]
fn blocks_lie_in_the_order_that_the_header_promises() {
    use exr::meta::attribute::LineOrder;
    use std::io::Read;
    for (taper, curvature) in sweeps() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.exr");
        write(&path, &scene(23, 37, taper, curvature));
        let mut file = std::io::BufReader::new(fs::File::open(&path).unwrap());
        let meta = exr::meta::MetaData::read_from_buffered(&mut file, true).unwrap();
        for header in &meta.headers {
            assert_eq!(header.line_order, LineOrder::Increasing);
            let mut table = vec![0; 8 * header.chunk_count];
            file.read_exact(&mut table).unwrap();
            let offsets: Vec<u64> =
                table.as_chunks().0.iter().copied().map(u64::from_le_bytes).collect();
            assert!(offsets.is_sorted_by(|one, next| one < next), "{offsets:?}");
        }
    }
}
