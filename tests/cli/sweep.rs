//! `whiskmap map` on a sweep of whiskers.

use super::{Place, names};
use std::path::Path;
use whiskmap::scene::Parameter;
use whiskmap::store::{AtlasLayout, StoredMap};

const SWEEP: &str = r#"title = "A small sweep"
[whisker]
length_mm = 20
base_radius_um = 30.0
# tip_radius_um
youngs_modulus_gpa = 3.0
[pole]
radius_mm = 0.25
[grid]
push_angle_deg = { from = -120, to = 120, count = 24 }
distance_mm = { from = 2, to = 20, count = 24 }
taper = { from = 0, to = 1, count = 4 }
curvature_per_mm = [0, 0.02, 0.04]
"#;

/// The scene of one whisker of [`SWEEP`].
fn single(taper: f64, curvature_per_mm: f64) -> String {
    let tip = format!("tip_radius_um = {:?}", 30.0 * (1.0 - taper));
    let lines = SWEEP.lines().filter_map(|line| match line {
        "# tip_radius_um" => Some(tip.as_str()),
        _ if line.starts_with("taper") || line.starts_with("curvature") => None,
        _ => Some(line),
    });
    let mut text = lines.collect::<Vec<_>>().join("\n");
    if curvature_per_mm > 0.0 {
        text += &format!("\n[whisker.curvature]\nparabola_per_mm = {curvature_per_mm:?}\n");
    }
    text
}

fn png_size(path: &Path) -> (u32, u32) {
    let file = std::fs::File::open(path).unwrap();
    let reader = png::Decoder::new(std::io::BufReader::new(file))
        .read_info()
        .unwrap();
    (reader.info().width, reader.info().height)
}

#[test]
fn every_panel_is_the_map_of_its_whisker() {
    let place = Place::with(SWEEP);
    let run = place.map(&["scene.toml"]);
    run.assert_settled();
    assert_eq!(names(&place.path("outputs")), ["scene.exr", "scene.png"]);
    let (width, height) = png_size(&place.path("outputs/scene.png"));
    assert!(width > 4 * 24 && height > 3 * 24, "{width} x {height}");

    let sweep = StoredMap::open(&place.path("outputs/scene.exr")).unwrap();
    let layout = AtlasLayout {
        columns: 4,
        rows: 3,
        push_angles: 24,
        distances: 24,
    };
    assert_eq!(sweep.layout, layout);
    let tapers = sweep.grid.axis(Parameter::Taper).unwrap();
    let curvatures = sweep.grid.axis(Parameter::ParabolaPerMm).unwrap();
    assert_eq!([tapers[0], tapers[3]], [0.0, 1.0]);
    assert_eq!(*curvatures, [0.0, 0.02, 0.04]);

    for index in 0..layout.panels() {
        let (taper, curvature) = (tapers[index % 4], curvatures[index / 4]);
        place.write("single.toml", &single(taper, curvature));
        place.map(&["single.toml", "--no-png"]).assert_settled();
        let single = StoredMap::open(&place.path("outputs/single.exr")).unwrap();
        for channel in sweep.channels() {
            // The number of steps depends on the cells that were computed together.
            if channel != "newton_steps" {
                same(channel, &sweep, index, &single);
            }
        }
    }
}

/// Checks that codes are equal, and quantities up to rounding, relative to the largest of the panel.
fn same(channel: &str, sweep: &StoredMap, index: usize, single: &StoredMap) {
    let panel: Vec<f64> = sweep.read_panel(channel, index).unwrap().values().collect();
    let alone: Vec<f64> = single.read_panel(channel, 0).unwrap().values().collect();
    let finite = alone.iter().filter(|value| value.is_finite());
    let largest = finite.map(|value| value.abs()).fold(0.0, f64::max);
    let allowed = match channel {
        "regime" | "status" => 0.0,
        // Rounding decides whether a residual is measured or a bound, so only its presence is compared.
        "residual" => f64::INFINITY,
        _ => 1e-6 * largest,
    };
    for (cell, (a, b)) in panel.iter().zip(&alone).enumerate() {
        let equal = a == b || (a.is_nan() && b.is_nan()) || (a - b).abs() <= allowed;
        let (row, column) = (cell / 24, cell % 24);
        assert!(
            equal,
            "{channel}, panel {index}, row {row}, column {column}: {a} in the sweep, {b} alone"
        );
    }
}
