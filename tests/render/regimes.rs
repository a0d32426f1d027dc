//! Maps of regimes, codes and counts, and atlases of them.

use super::drawn::body;
use super::map::{panel, scene, spread};
use super::vision;
use super::{BLANK, CONTACT, OUT_OF_REACH, PULL_OFF, SLIP_OFF, UNRESOLVED, colours, draw, flat};

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
        for (up, colour) in [(0.01, row[0]), (0.49, row[0]), (0.51, row[1]), (0.99, row[1])] {
            assert_eq!(body(&picture, across, up), colour, "{angle} deg, {up} of the height");
        }
    }
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
        assert!(colours(&picture).values().filter(|pixels| **pixels > 5000).count() >= 3, "{name}");
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
