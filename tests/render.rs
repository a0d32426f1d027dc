//! Pictures show what the map holds. The body of a picture of one whisker is 1280 by 880 pixels, 136 from the left and
//! 112 from the bottom.
#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot set up its files should stop"
)]

mod map;

use map::{panel, scene, spread, write};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::Path;
use whiskmap::scene::Setup;
use whiskmap::store::{MapWriter, Panel, Shots, StoredMap};
use whiskmap::{render, store};

const CONTACT: [u8; 3] = [0x8c, 0xcb, 0xae];
const SLIP_OFF: [u8; 3] = [0xec, 0xa0, 0x72];
const PULL_OFF: [u8; 3] = [0x5b, 0x8f, 0xc7];
const OUT_OF_REACH: [u8; 3] = [0xe6, 0xe8, 0xea];
const BLANK: [u8; 3] = [0xdc, 0xdd, 0xde];

struct Picture {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

impl Picture {
    fn open(path: &Path) -> Self {
        let mut reader = png::Decoder::new(File::open(path).unwrap())
            .read_info()
            .unwrap();
        let mut bytes = vec![0; reader.output_buffer_size()];
        let info = reader.next_frame(&mut bytes).unwrap();
        assert_eq!(info.color_type, png::ColorType::Rgb);
        Self {
            width: info.width as usize,
            height: info.height as usize,
            pixels: bytes.as_chunks().0.to_vec(),
        }
    }

    /// The pixel at fractions of the body from the left and from the bottom.
    fn body(&self, across: f64, up: f64) -> [u8; 3] {
        let x = 136.0 + across * 1280.0;
        let y = self.height as f64 - 112.0 - up * 880.0;
        self.pixels[y as usize * self.width + x as usize]
    }

    /// How many pixels there are of each colour.
    fn colours(&self) -> BTreeMap<[u8; 3], usize> {
        let mut colours = BTreeMap::new();
        for pixel in &self.pixels {
            *colours.entry(*pixel).or_default() += 1;
        }
        colours
    }
}

/// Writes the panels of a map and draws one channel of it, or the regimes.
fn draw(scene: &Setup, panels: &[Panel], channel: Option<&str>) -> Picture {
    let folder = tempfile::tempdir().unwrap();
    let [file, out] = ["map.exr", "map.png"].map(|name| folder.path().join(name));
    let tolerances = serde_json::json!(null);
    let mut writer = MapWriter::create(&file, &map::describe(scene, &tolerances)).unwrap();
    writer.write_panels(0, panels).unwrap();
    writer.finish(Shots::default()).unwrap();
    let map = StoredMap::open(&file).unwrap();
    match channel {
        Some(name) => render::channel(&map, name, &out).unwrap(),
        None => render::regimes(&map, &out).unwrap(),
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    Picture::open(&out)
}

/// A panel all of whose regimes are `regime` and whose quantities are all `value`.
fn flat(scene: &Setup, regime: &[u32], value: f32) -> Panel {
    let mut flat = panel(scene, 0);
    let cells = flat.regime.len();
    flat.regime = regime.to_vec();
    flat.state = flat.state.map(|_| vec![value; cells]);
    flat.margin_deg = vec![value; cells];
    flat
}

#[test]
fn a_regime_map_shows_every_cell_where_it_belongs() {
    let mut scene = scene(3, 2, None, None);
    // Midpoints between unequal values: the cells are 45, 35 and 25 degrees wide, from -72.5 to 32.5.
    scene.grid.push_angle_deg = vec![-50.0, -5.0, 20.0];
    scene.grid.distance_mm = vec![5.0, 15.0];
    let picture = draw(&scene, &[flat(&scene, &[1, 2, 3, 0, 0, 1], f32::NAN)], None);
    for (angle, row) in [
        (-72.0, [CONTACT, OUT_OF_REACH]),
        (-28.0, [CONTACT, OUT_OF_REACH]),
        (-27.0, [SLIP_OFF, OUT_OF_REACH]),
        (7.0, [SLIP_OFF, OUT_OF_REACH]),
        (8.0, [PULL_OFF, CONTACT]),
        (32.0, [PULL_OFF, CONTACT]),
    ] {
        let across = (angle + 72.5) / 105.0;
        for (up, colour) in [
            (0.01, row[0]),
            (0.49, row[0]),
            (0.51, row[1]),
            (0.99, row[1]),
        ] {
            assert_eq!(
                picture.body(across, up),
                colour,
                "{angle} deg, {up} of the height"
            );
        }
    }
}

#[test]
fn the_boundary_runs_where_the_margins_say() {
    let scene = scene(40, 50, None, None);
    let mut panel = panel(&scene, 0);
    let angles = &scene.grid.push_angle_deg;
    for (row, distance) in scene.grid.distance_mm.iter().enumerate() {
        for (column, angle) in angles.iter().enumerate() {
            let margin = 40.0 - distance - angle.abs();
            let cell = row * angles.len() + column;
            panel.margin_deg[cell] = if margin > 0.0 {
                margin as f32
            } else {
                f32::NAN
            };
            panel.regime[cell] = if margin > 0.0 { 1 } else { 2 };
        }
    }
    let picture = draw(&scene, &[panel], None);
    let step = |values: &[f64]| values[1] - values[0];
    let fraction = |values: &[f64], value: f64| {
        let low = values[0] - 0.5 * step(values);
        (value - low) / (step(values) * values.len() as f64)
    };
    for distance in [4.0, 10.0, 15.0, 20.0] {
        for side in [-1.0, 1.0] {
            let edge = side * (40.0 - distance);
            let up = fraction(&scene.grid.distance_mm, distance);
            let across = fraction(angles, edge);
            let dark = |colour: [u8; 3]| colour.iter().all(|channel| *channel < 0x60);
            assert!(dark(picture.body(across, up)), "{distance} mm, {edge} deg");
            let away = 8.0 / 1280.0;
            assert!(!dark(picture.body(across - away, up)));
            assert!(!dark(picture.body(across + away, up)));
        }
    }
}

#[test]
fn a_channel_map_is_white_at_zero_when_both_signs_occur() {
    let scene = scene(3, 1, None, None);
    let mut panel = flat(&scene, &[1; 3], 0.0);
    panel.state[2] = vec![-1.0, 0.0, 4.0];
    let picture = draw(&scene, &[panel.clone()], Some("force_un"));
    let [negative, zero, positive] = [0.1, 0.4, 0.9].map(|across| picture.body(across, 0.5));
    assert_eq!(zero, [0xf7; 3]);
    assert_eq!(positive, [0xb2, 0x18, 0x2b]);
    assert!(
        negative[2] > negative[0] && negative[0] > 0xb0,
        "a quarter of the way to blue"
    );

    panel.state[2] = vec![1.0, f32::INFINITY, 4.0];
    let picture = draw(&scene, &[panel], Some("force_un"));
    let [least, none, most] = [0.1, 0.4, 0.9].map(|across| picture.body(across, 0.5));
    assert_eq!(none, BLANK);
    assert!(
        least[2] > least[1] && most[1] > most[2],
        "viridis: {least:?} to {most:?}"
    );
}

#[test]
fn small_and_empty_maps_are_drawn_too() {
    for value in [f32::NAN, f32::INFINITY, 0.0, -3.0, 1e-30] {
        let scene = scene(1, 1, None, None);
        let picture = draw(&scene, &[flat(&scene, &[1], value)], Some("energy_nj"));
        let blank = picture.body(0.25, 0.25) == BLANK;
        assert_eq!(blank, !value.is_finite(), "{value}");
    }
    for (columns, rows) in [(1, 5), (5, 1)] {
        let scene = scene(columns, rows, None, None);
        let picture = draw(&scene, &[flat(&scene, &[1; 5], 1.0)], None);
        assert_eq!(picture.body(0.25, 0.25), CONTACT);
    }
}

#[test]
fn codes_and_counts_have_pictures() {
    let scene = scene(9, 7, None, None);
    for name in ["status", "newton_steps", "regime"] {
        let picture = draw(&scene, &[panel(&scene, 0)], Some(name));
        assert!(
            picture
                .colours()
                .values()
                .filter(|pixels| **pixels > 5000)
                .count()
                >= 3,
            "{name}"
        );
    }
}

#[test]
fn an_atlas_puts_taper_to_the_right_and_curvature_up() {
    let scene = scene(4, 4, Some(vec![0.5, 0.9]), Some(vec![0.0, 0.01]));
    let panels = [1, 2, 3, 0].map(|regime| flat(&scene, &[regime; 16], f32::NAN));
    let picture = draw(&scene, &panels, None);
    // Far right of the legend and below it.
    let at = |x: usize, y: usize| picture.pixels[y * picture.width + x];
    let (left, right) = (168 + 200, 168 + 560 + 200);
    let (lower, upper) = (picture.height - 180 - 200, picture.height - 180 - 560 - 200);
    assert_eq!(at(left, lower), CONTACT);
    assert_eq!(at(right, lower), SLIP_OFF);
    assert_eq!(at(left, upper), PULL_OFF);
    assert_eq!(at(right, upper), OUT_OF_REACH);
}

#[test]
fn an_atlas_of_any_size_is_a_picture_of_sane_size() {
    for (tapers, curvatures) in [(40, 30), (300, 1), (1, 90)] {
        let axis = |count| Some(spread(0.0, 0.9, count));
        let scene = scene(6, 5, axis(tapers), axis(curvatures));
        let panel = panel(&scene, 0);
        let picture = draw(&scene, &vec![panel; tapers * curvatures], Some("force_un"));
        assert!(picture.width <= 2100 && picture.height <= 2000);
        assert!(picture.width >= 500 && picture.height >= 250);
    }
}

#[test]
fn errors_leave_no_picture() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("map.exr");
    write(&file, &scene(2, 2, None, None));
    let map = StoredMap::open(&file).unwrap();
    let out = folder.path().join("map.png");
    let error = render::channel(&map, "weight", &out).unwrap_err();
    assert!(
        matches!(
            error,
            render::Error::Map(store::Error::UnknownChannel { .. })
        ),
        "{error}"
    );
    let nowhere = folder.path().join("no such folder/map.png");
    let error = render::regimes(&map, &nowhere).unwrap_err();
    assert!(matches!(error, render::Error::Write { .. }), "{error}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
