//! The boundary of a regime map runs where the margins say.

use super::drawn::{body, frame, polylines, svg};
use super::map::{panel, scene};
use super::{draw, flat, picture};
use whiskmap::render::MapOptions;

#[test]
fn the_boundary_runs_where_the_margins_say() {
    let scene = scene(40, 50, None, None);
    let mut panel = panel(&scene, 0);
    let angles = &scene.grid.push_angle_deg;
    for (row, distance) in scene.grid.distance_mm.iter().enumerate() {
        for (column, angle) in angles.iter().enumerate() {
            let margin = 40.0 - distance - angle.abs();
            let cell = row * angles.len() + column;
            panel.margin_deg[cell] = if margin > 0.0 { margin as f32 } else { f32::NAN };
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
            assert!(dark(body(&picture, across, up)), "{distance} mm, {edge} deg");
            let away = 8.0 / 1280.0;
            assert!(!dark(body(&picture, across - away, up)));
            assert!(!dark(body(&picture, across + away, up)));
        }
    }
}

/// A single push angle has no extent that a boundary could cross.
#[test]
fn a_single_push_angle_has_no_boundary() {
    let mut scene = scene(1, 3, None, None);
    scene.grid.push_angle_deg = vec![10.0];
    let mut panel = flat(&scene, &[1; 3], f32::NAN);
    panel.margin_deg = vec![0.3, 0.2, 0.1];
    let document = svg(&picture(&scene, &[panel], &MapOptions::default()).unwrap());
    assert!(!document.contains(">detachment boundary<"));
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
        [1.5 * values[0] - 0.5 * values[1], 1.5 * values[last] - 0.5 * values[last - 1]]
    };
    let ([low, high], [near, far]) = (ends(angles), ends(&scene.grid.distance_mm));
    let back = |[x, y]: [f64; 2]| {
        let angle = low + (x - left) / (right - left) * (high - low);
        let distance = near + (bottom - y) / (bottom - top) * (far - near);
        // Two decimals of a pixel are less than a thousandth of either.
        [angle, distance].map(|value| (value * 1e3).round() / 1e3)
    };
    let thick = document.lines().filter(|line| line.contains("stroke-width=\"3\""));
    let lines = polylines(&thick.collect::<Vec<_>>().join("\n"));
    let inside = lines.into_iter().filter(|(points, _)| points[0][1] > top - 0.01);
    inside.map(|(points, _)| points.into_iter().map(back).collect()).collect()
}

#[test]
fn the_boundary_follows_from_the_cell_nearest_detachment() {
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
    let cells: Vec<f32> = margins.into_iter().flat_map(|margin| [margin, f32::NAN]).collect();
    let expected = [
        vec![[5.0, 0.0], [5.5, 1.0], [5.25, 2.0]],
        // From 14 at 5 mm to 16 at 6 mm, on an axis that ends at 15.
        vec![[14.0, 5.0], [15.0, 5.5]],
    ];
    assert_eq!(boundary(&[0.0, 10.0], &cells), expected);
}
