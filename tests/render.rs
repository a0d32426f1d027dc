//! Pictures show what the map holds. The body of a picture of one whisker is 1280 by 880 pixels, 136 from the left and
//! 112 from the bottom.
#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot set up its files should stop"
)]

mod drawn;
mod map;
#[path = "drawn/vision.rs"]
mod vision;

use drawn::{Pixels, frame, polylines, rasters, svg, well_formed};
use map::{panel, scene, spread, write};
use std::collections::BTreeMap;
use std::fs;
use whiskmap::render::{self, Format, MapOptions, Picture};
use whiskmap::scene::Setup;
use whiskmap::store::{self, MapWriter, Panel, Shots, StoredMap};

const CONTACT: [u8; 3] = [0x83, 0xc4, 0xa4];
const SLIP_OFF: [u8; 3] = [0xc8, 0x60, 0x2a];
const PULL_OFF: [u8; 3] = [0x22, 0x47, 0x8a];
const OUT_OF_REACH: [u8; 3] = [0xf2, 0xf3, 0xf4];
const UNRESOLVED: [u8; 3] = [0xf0, 0xe4, 0x42];
const BLANK: [u8; 3] = [0xdc, 0xdd, 0xde];

/// The pixel at fractions of the body of a picture in its natural size, from the left and from the bottom.
fn body(picture: &Pixels, across: f64, up: f64) -> [u8; 3] {
    let y = picture.height as f64 - 112.0 - up * 880.0;
    picture.at([136.0 + across * 1280.0, y])
}

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
    scene: &Setup,
    panels: &[Panel],
    options: &MapOptions,
) -> Result<Picture, render::Error> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("map.exr");
    let tolerances = serde_json::json!(null);
    let mut writer = MapWriter::create(&file, &map::describe(scene, &tolerances)).unwrap();
    writer.write_panels(panels).unwrap();
    writer.finish(Shots::default()).unwrap();
    render::map(&StoredMap::open(&file).unwrap(), options)
}

/// Draws one channel of a map, or the regimes.
fn draw(scene: &Setup, panels: &[Panel], channel: Option<&str>) -> Pixels {
    let options = MapOptions {
        channel,
        ..MapOptions::default()
    };
    Pixels::of(&picture(scene, panels, &options).unwrap())
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
                body(&picture, across, up),
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
            assert!(
                dark(body(&picture, across, up)),
                "{distance} mm, {edge} deg"
            );
            let away = 8.0 / 1280.0;
            assert!(!dark(body(&picture, across - away, up)));
            assert!(!dark(body(&picture, across + away, up)));
        }
    }
}

/// The boundary of a map, line by line: push angles and distances. The cells have the given margins, row by row.
fn boundary(angles: &[f64], margins: &[f32]) -> Vec<Vec<[f64; 2]>> {
    let mut scene = scene(angles.len(), margins.len() / angles.len(), None, None);
    scene.grid.push_angle_deg = angles.to_vec();
    let distances = &mut scene.grid.distance_mm;
    *distances = (0..distances.len()).map(|row| row as f64).collect();
    let mut panel = flat(&scene, &vec![1; margins.len()], f32::NAN);
    panel.margin_deg = margins.to_vec();
    let document = svg(&picture(&scene, &[panel], &MapOptions::default()).unwrap());
    let [left, top, right, bottom] = frame(&document);
    let ends = |values: &[f64]| {
        let last = values.len() - 1;
        [
            1.5 * values[0] - 0.5 * values[1],
            1.5 * values[last] - 0.5 * values[last - 1],
        ]
    };
    let ([low, high], [near, far]) = (ends(angles), ends(&scene.grid.distance_mm));
    let back = |[x, y]: [f64; 2]| {
        let angle = low + (x - left) / (right - left) * (high - low);
        let distance = near + (bottom - y) / (bottom - top) * (far - near);
        // Two decimals of a pixel are less than a thousandth of either.
        [angle, distance].map(|value| (value * 1e3).round() / 1e3)
    };
    let thick = document
        .lines()
        .filter(|line| line.contains("stroke-width=\"3\""));
    let lines = polylines(&thick.collect::<Vec<_>>().join("\n"));
    let inside = lines
        .into_iter()
        .filter(|(points, _)| points[0][1] > top - 0.01);
    inside
        .map(|(points, _)| points.into_iter().map(back).collect())
        .collect()
}

#[test]
fn the_cell_nearest_detachment_tells_where_it_is() {
    let nan = f32::NAN;
    let margins = [nan, 4.0, 14.5, 4.0, nan, 2.0, 12.0, nan];
    assert_eq!(
        boundary(&[-20.0, -10.0, 0.0, 10.0], &margins),
        [[[-14.0, 0.0], [-12.0, 1.0]], [[14.0, 0.0], [12.0, 1.0]]]
    );
}

#[test]
fn the_boundary_breaks_at_jumps_and_gaps_and_ends_at_the_axis() {
    let margins = [5.0, 5.5, 5.25, 14.0, f32::NAN, 14.0, 16.0];
    let cells: Vec<f32> = margins
        .into_iter()
        .flat_map(|margin| [margin, f32::NAN])
        .collect();
    let expected = [
        vec![[5.0, 0.0], [5.5, 1.0], [5.25, 2.0]],
        // From 14 at 5 mm to 16 at 6 mm, on an axis that ends at 15.
        vec![[14.0, 5.0], [15.0, 5.5]],
    ];
    assert_eq!(boundary(&[0.0, 10.0], &cells), expected);
}

#[test]
fn a_channel_map_is_white_at_zero_when_both_signs_occur() {
    let scene = scene(3, 1, None, None);
    let mut panel = flat(&scene, &[1; 3], 0.0);
    panel.state[2] = vec![-1.0, 0.0, 4.0];
    let picture = draw(&scene, &[panel.clone()], Some("force_un"));
    let [negative, zero, positive] = [0.1, 0.4, 0.9].map(|across| body(&picture, across, 0.5));
    assert_eq!(zero, [0xf7; 3]);
    assert_eq!(positive, [0xb2, 0x18, 0x2b]);
    assert!(
        negative[2] > negative[0] && negative[0] > 0xb0,
        "a quarter of the way to blue"
    );

    panel.state[2] = vec![1.0, f32::INFINITY, 4.0];
    let picture = draw(&scene, &[panel], Some("force_un"));
    let [least, none, most] = [0.1, 0.4, 0.9].map(|across| body(&picture, across, 0.5));
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
        let blank = body(&picture, 0.25, 0.25) == BLANK;
        assert_eq!(blank, !value.is_finite(), "{value}");
    }
    for (columns, rows) in [(1, 5), (5, 1)] {
        let scene = scene(columns, rows, None, None);
        let picture = draw(&scene, &[flat(&scene, &[1; 5], 1.0)], None);
        assert_eq!(body(&picture, 0.25, 0.25), CONTACT);
    }
}

#[test]
fn codes_and_counts_have_pictures() {
    let scene = scene(9, 7, None, None);
    for name in ["status", "newton_steps", "regime"] {
        let picture = draw(&scene, &[panel(&scene, 0)], Some(name));
        assert!(
            colours(&picture)
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
    let at = |x: usize, y: usize| picture.at([x as f64, y as f64]);
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

/// Draws force of three cells side by side.
fn force(values: [f32; 3], options: &MapOptions) -> Result<Picture, render::Error> {
    let scene = scene(3, 1, None, None);
    let mut panel = flat(&scene, &[1; 3], 0.0);
    panel.state[2] = values.to_vec();
    let channel = Some("force_un");
    picture(
        &scene,
        &[panel],
        &MapOptions {
            channel,
            ..*options
        },
    )
}

/// The colours of three cells side by side.
fn cells(picture: &Picture) -> [[u8; 3]; 3] {
    let pixels = Pixels::of(picture);
    [0.1, 0.4, 0.9].map(|across| body(&pixels, across, 0.5))
}

#[test]
fn a_logarithmic_scale_has_equal_ratios_at_equal_distances() {
    let log = MapOptions {
        log: true,
        ..MapOptions::default()
    };
    let linear = force([0.0, 5.0, 10.0], &MapOptions::default()).unwrap();
    let decades = force([1.0, 100.0, 1e4], &log).unwrap();
    assert_eq!(cells(&decades), cells(&linear));
    assert!(svg(&decades).contains(">0.1<"), "in mN");

    let some = force([-3.0, 0.0, 7.0], &log).unwrap();
    assert_eq!(cells(&some)[..2], [BLANK; 2]);
    assert!(svg(&some).contains(">\u{2264} 0 (cells: 2)<"));
    let both = force([f32::NAN, -1.0, 7.0], &log).unwrap();
    assert!(svg(&both).contains(">no contact, or \u{2264} 0 (cells: 1)<"));
}

#[test]
fn values_beyond_the_range_take_the_colours_of_its_ends() {
    let ranged = |values, log| {
        let range = Some([1.0, 100.0]);
        let options = MapOptions {
            log,
            range,
            ..MapOptions::default()
        };
        cells(&force(values, &options).unwrap())
    };
    for log in [false, true] {
        let [low, _, high] = ranged([1.0, 2.0, 100.0], log);
        assert_ne!(low, high);
        assert_eq!(ranged([0.5, 1e3, 1e30], log), [low, high, high]);
    }
    let narrow = MapOptions {
        range: Some([-1.0, 4.0]),
        ..MapOptions::default()
    };
    let [_, white, red] = cells(&force([-9.0, 0.0, 9.0], &narrow).unwrap());
    assert_eq!([white, red], [[0xf7; 3], [0xb2, 0x18, 0x2b]]);
}

#[test]
fn scales_that_cannot_be_are_refused() {
    let refused = |values, range, log, what: &str| {
        let options = MapOptions {
            log,
            range,
            ..MapOptions::default()
        };
        let error = force(values, &options).unwrap_err();
        assert!(matches!(error, render::Error::Scale(_)), "{error}");
        assert!(error.to_string().contains(what), "{error}");
    };
    let some = [1.0, 2.0, 3.0];
    for range in [
        [5.0, 2.0],
        [2.0, 2.0],
        [f64::NAN, 1.0],
        [0.0, f64::INFINITY],
        [-f64::MAX, f64::MAX],
    ] {
        refused(some, Some(range), false, "two finite numbers");
    }
    refused(some, Some([0.0, 1.0]), true, "must begin above 0");
    refused(
        [-1.0, 0.0, f32::NAN],
        None,
        true,
        "no cell has a value above 0",
    );
    let scene = scene(3, 1, None, None);
    for (channel, log, range) in [
        (None, true, None),
        (Some("regime"), false, Some([0.0, 1.0])),
        (Some("status"), true, None),
    ] {
        let options = MapOptions {
            channel,
            log,
            range,
            width: None,
        };
        let error = picture(&scene, &[panel(&scene, 0)], &options).unwrap_err();
        assert!(error.to_string().contains("made of codes"), "{error}");
    }
}

#[test]
fn a_colour_bar_chooses_the_unit_that_suits_it() {
    for (values, label, tick) in [
        ([1e6, 5e6, 1e7], ">force (N)<", ">10<"),
        ([1.0, 2.0, 8e3], ">force (mN)<", ">8<"),
        ([1.0, 2.0, 500.0], ">force (\u{b5}N)<", ">500<"),
        ([0.0, 0.0, 0.0], ">force (\u{b5}N)<", ">0.0<"),
        ([0.0, 0.0, 2e-3], ">force (nN)<", ">2.0<"),
    ] {
        let svg = svg(&force(values, &MapOptions::default()).unwrap());
        assert!(svg.contains(label) && svg.contains(tick), "{label} {tick}");
    }
}

#[test]
fn an_svg_document_has_the_cells_as_pixels_and_the_rest_as_such() {
    for (tapers, panels) in [(None, 1), (Some(vec![0.2, 0.5]), 2)] {
        let scene = scene(40, 50, tapers, None);
        let panels: Vec<Panel> = (0..panels).map(|index| panel(&scene, index)).collect();
        for channel in [None, Some("force_un")] {
            let options = MapOptions {
                channel,
                ..MapOptions::default()
            };
            let picture = picture(&scene, &panels, &options).unwrap();
            let (document, pixels) = (svg(&picture), Pixels::of(&picture));
            assert!(well_formed(&document));
            let texts = ["A made-up whisker in front of a pole<", "push angle (deg)"];
            assert!(texts.iter().all(|text| document.contains(text)));
            let rasters = rasters(&document);
            // Inside of the frames, away from lines.
            let (mut same, mut all) = (0, 0);
            for ([left, top, width, height], raster) in &rasters {
                assert_eq!(
                    [raster.width as f64, raster.height as f64],
                    [*width, *height]
                );
                for (place, pixel) in raster.pixels.iter().enumerate() {
                    let (x, y) = (place % raster.width, place / raster.width);
                    same += usize::from(*pixel == pixels.at([left + x as f64, top + y as f64]));
                }
                all += raster.pixels.len();
            }
            assert!(
                rasters.len() > panels.len() && same * 100 > all * 97,
                "{same} of {all}"
            );
            let boundary = document.matches("stroke-width=\"3\"").count();
            assert_eq!(boundary > 1, channel.is_none() && panels.len() == 1);
        }
    }
}

#[test]
fn the_width_is_what_was_asked_for() {
    let scene = scene(6, 5, None, None);
    let panels = [flat(&scene, &[2; 30], 3.0)];
    for width in [300, 1001, 3000] {
        let options = MapOptions {
            width: Some(width),
            ..MapOptions::default()
        };
        let picture = picture(&scene, &panels, &options).unwrap();
        let pixels = Pixels::of(&picture);
        assert_eq!(pixels.width, width as usize);
        let ratio = pixels.height as f64 / pixels.width as f64;
        assert!((0.7..0.8).contains(&ratio), "{ratio}");
        let part = colours(&pixels)[&SLIP_OFF] as f64 / pixels.pixels.len() as f64;
        assert!((0.6..0.75).contains(&part), "{part} of the picture");
        let document = svg(&picture);
        assert!(document.contains(&format!(" width=\"{width}\" height=\"{}\"", pixels.height)));
        assert!(document.contains(" viewBox=\"0 0 14"), "the natural size");
        assert!(rasters(&document)[1].1.width > width as usize * 8 / 10);
    }
}

#[test]
fn regimes_differ_in_print_and_for_every_colour_vision() {
    // The colours are those of a picture.
    let scene = scene(5, 1, None, None);
    let picture = draw(&scene, &[flat(&scene, &[0, 1, 2, 3, 255], f32::NAN)], None);
    let regimes = [OUT_OF_REACH, CONTACT, SLIP_OFF, PULL_OFF, UNRESOLVED];
    for (place, colour) in regimes.iter().enumerate() {
        assert_eq!(body(&picture, 0.2 * place as f64 + 0.1, 0.3), *colour);
    }
    let pairs = || (0..5).flat_map(|one| (one + 1..5).map(move |other| (one, other)));
    for (name, vision) in vision::VISIONS {
        let seen = regimes.map(|colour| vision::lab(colour, vision));
        for (one, other) in pairs() {
            let apart = vision::apart(seen[one], seen[other]);
            assert!(apart >= 20.0, "{name}, {one} and {other}: {apart}");
            if name == "all cones" && other < 4 {
                let lightness = (seen[one][0] - seen[other][0]).abs();
                assert!(lightness >= 20.0, "{one} and {other}: {lightness}");
            }
        }
    }
}

#[test]
fn errors_leave_no_picture() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("map.exr");
    write(&file, &scene(2, 2, None, None));
    let map = StoredMap::open(&file).unwrap();
    let options = MapOptions {
        channel: Some("weight"),
        ..MapOptions::default()
    };
    let error = render::map(&map, &options).unwrap_err();
    assert!(
        matches!(
            error,
            render::Error::Map(store::Error::UnknownChannel { .. })
        ),
        "{error}"
    );
    let nowhere = folder.path().join("no such folder/map.png");
    let picture = render::map(&map, &MapOptions::default()).unwrap();
    let error = picture.save(&nowhere, Format::Png).unwrap_err();
    assert!(matches!(error, render::Error::Write { .. }), "{error}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
