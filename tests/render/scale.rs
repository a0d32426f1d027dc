//! Scales of channels: colours, ranges, logarithms and units.

use crate::drawn::{Pixels, svg};
use crate::map::{panel, scene};
use crate::{BLANK, body, draw, flat, picture};
use whiskmap::render::{self, MapOptions, Picture};

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
fn a_logarithmic_scale_starts_at_the_1st_percentile() {
    let scene = scene(40, 10, None, None);
    let mut panel = flat(&scene, &[1; 400], 0.0);
    for (value, cell) in panel.state[2].iter_mut().zip(0_u16..) {
        *value = match cell {
            0..10 => 0.0,
            10..13 => 1e-30,
            _ => f32::from(cell),
        };
    }
    let options = MapOptions {
        channel: Some("force_un"),
        log: true,
        ..MapOptions::default()
    };
    let svg = svg(&picture(&scene, &[panel], &options).unwrap());
    for name in ["\u{2264} 0 (cells: 10)", "> 0, below the scale (cells: 3)"] {
        let name = name.replace('>', "&gt;");
        assert!(svg.contains(&format!(">{name}<")), "{name}");
    }
    for tick in [">20<", ">50<", ">100<", ">200<"] {
        assert!(svg.contains(tick), "{tick}");
    }
}

/// The powers of ten between the ends are few, whatever the ends and the unit.
#[test]
fn a_logarithmic_scale_takes_all_positive_numbers() {
    let options = MapOptions {
        log: true,
        range: Some([1e-320, 1e308]),
        ..MapOptions::default()
    };
    let svg = svg(&force([1.0, 100.0, 1e4], &options).unwrap());
    assert!(svg.contains(">force (N)<") && !svg.contains("NaN") && !svg.contains("inf"));
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
