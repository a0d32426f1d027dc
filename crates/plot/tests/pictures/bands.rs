//! Bands are where their numbers are, below everything else.

use crate::drawn::{frame, line, single};
use crate::{BLACK, WHITE, both};
use whiskmap_plot::{Band, Ink, Plot, Shade, Stroke};

const LIGHT: [u8; 3] = [0xdb, 0xe4, 0xee];
const DARK: [u8; 3] = [0xa9, 0xbd, 0xd2];

#[test]
fn a_band_is_where_its_numbers_are() {
    let around = |x: f64, y: f64, half: f64| [[x, y - half], [x, y + half]];
    let band = |half: f64, shade| Band {
        points: vec![
            around(0.0, 10.0, half),
            around(40.0, 10.0, half),
            around(f64::NAN, 0.0, 0.0),
            around(60.0, 20.0, half),
            [[80.0, 20.0 - half], [80.0, f64::INFINITY]],
            around(90.0, 20.0, half),
            around(100.0, 30.0, half),
        ],
        shade,
        name: Some(format!("band of {half}")),
    };
    let (svg, picture) = both(&single(Plot {
        bands: vec![band(10.0, Shade::Light), band(5.0, Shade::Dark)],
        lines: vec![line(&[[0.0, 10.0], [40.0, 10.0]], Ink::Black, Stroke::Solid)],
        ..Plot::default()
    }));
    let [left, top, right, bottom] = frame(&svg);
    // The data take 1 of 1.08 parts of the axes: 100 across, from 0 to 40 upwards.
    let place = |x: f64, y: f64| {
        let [across, up] = [x / 100.0, y / 40.0].map(|part| (part + 0.04) / 1.08);
        [left + (right - left) * across, bottom - (bottom - top) * up]
    };
    for (x, y, colour) in [
        (20.0, 10.0, BLACK),
        (20.0, 13.0, DARK),
        (20.0, 7.0, DARK),
        (20.0, 15.3, LIGHT),
        (20.0, 19.7, LIGHT),
        (20.0, 20.5, WHITE),
        (1.0, 2.0, LIGHT),
        (42.0, 10.0, WHITE),
        (58.0, 15.0, WHITE),
        // A single point between gaps has no area.
        (60.0, 20.0, WHITE),
        (70.0, 20.0, WHITE),
        (95.0, 25.0, DARK),
        (95.0, 33.0, LIGHT),
        (95.0, 15.5, LIGHT),
    ] {
        assert_eq!(picture.at(place(x, y)), colour, "{x}, {y}");
    }
    let polygons = svg.lines().filter(|line| line.starts_with("<polygon"));
    let corners = polygons.map(|line| line.matches(',').count());
    assert_eq!(corners.collect::<Vec<_>>(), [4, 4, 4, 4]);
    assert_eq!(svg.matches(">band of 10<").count(), 1);
    assert_eq!(svg.matches(">band of 5<").count(), 1);
}

/// A band of one point has no area: a bar shows its range.
#[test]
fn a_band_of_one_point_is_a_bar() {
    let band = |half: f64, shade| Band {
        points: vec![[[10.0 - half, 5.0], [10.0 + half, 5.0]]],
        shade,
        name: None,
    };
    let (svg, picture) = both(&single(Plot {
        bands: vec![band(10.0, Shade::Light), band(5.0, Shade::Dark)],
        ..Plot::default()
    }));
    let [left, top, right, bottom] = frame(&svg);
    // The data take 1 of 1.08 parts of the axis, and all have one height.
    let place = |x: f64| [left + (right - left) * (x / 20.0 + 0.04) / 1.08, 0.5 * (top + bottom)];
    for (x, colour) in [(1.0, LIGHT), (6.0, DARK), (10.0, DARK), (14.0, DARK), (19.0, LIGHT)] {
        assert_eq!(picture.at(place(x)), colour, "{x}");
    }
    assert_eq!(picture.at([place(10.0)[0], 0.5 * (top + bottom) - 20.0]), WHITE);
    // A bar ends where its range does.
    let colours = [(-0.1, WHITE), (0.1, LIGHT), (4.9, LIGHT), (5.1, DARK), (20.1, WHITE)];
    for (x, colour) in colours {
        assert_eq!(picture.at(place(x)), colour, "{x}");
    }
}
