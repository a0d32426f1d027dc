//! Shipped scenes are accepted. Wrong scenes are refused with the place, the value and what is allowed. No text panics.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that cannot go on has failed")]

mod any_text;
mod axes;
mod changed;
mod profile;
mod refused;
mod shape;
mod tables;
mod warnings;

use crate::shipped;
use std::fs;

use whiskmap::Side;
use whiskmap::scene::{Curvature, Parameter, Scene};

/// A valid scene with every table and all axes but one, to be spoilt line by line. Lines are counted from 1.
const BASE: &str = r#"title = "base"
[whisker]
length_mm = 20
base_radius_um = 30.0
tip_radius_um = 1.5
youngs_modulus_gpa = 3.0
[whisker.curvature]
parabola_per_mm = 0.02
vertex_mm = 2.5
[pole]
radius_mm = 0.25
[grid]
push_angle_deg = { from = -70, to = 70, count = 5 }
distance_mm = [2.0, 7.5, 20.0]
# taper = { from = 0, to = 1, count = 3 }
curvature_per_mm = [0, 0.04]
[output]
name = "base"
"#;

fn parse(text: &str) -> Result<Scene, String> {
    Scene::parse(text, "test.toml").map_err(|why| why.to_string())
}

/// The base scene with an axis of tapers, which give the tip its radius.
fn sweep() -> String {
    BASE.replace("tip_radius_um", "# tip_radius_um").replace("# taper", "taper")
}

/// The base scene with one line replaced by others.
fn with_line(line: usize, replacement: &str) -> String {
    let mut lines: Vec<&str> = BASE.lines().collect();
    lines[line - 1] = replacement;
    lines.join("\n")
}

#[test]
fn every_shipped_scene_is_accepted() {
    let mut names = Vec::new();
    for path in shipped::scene_paths() {
        let scene = Scene::read(&path).unwrap_or_else(|why| panic!("{why}"));
        assert_eq!(scene.name, path.file_stem().unwrap().to_str().unwrap());
        assert_eq!((scene.notes(), scene.warnings()), (&[][..], vec![]));
        if scene.csv_files().is_empty() {
            assert_eq!(scene.to_toml(), fs::read_to_string(&path).unwrap());
        }
        let sides = match &*scene.name {
            "friction" => [1061, 1],
            "morphology" => [96, 96],
            "pad" => [141, 37],
            _ => [512, 512],
        };
        let grid = &scene.grid;
        let found = [grid.push_angle_deg.len(), grid.distance_mm.len()];
        assert_eq!(found, sides, "{}", scene.name);
        names.push(scene.name.clone());
    }
    let expected = [
        "cone",
        "cylinder",
        "euler_spiral",
        "fig4_hair",
        "fig4_whisker",
        "fig5_left",
        "fig5_right",
        "follicle",
        "friction",
        "measured",
        "morphology",
        "pad",
        "robot",
        "texture_cone",
        "texture_hair",
        "traced",
        "uncertain",
    ];
    assert_eq!(names, expected);
}

#[test]
fn every_value_arrives_where_it_belongs() {
    let scene = parse(BASE).unwrap();
    assert_eq!(scene.title, "base");
    assert_eq!(scene.name, "base");
    assert_eq!(scene.whisker.length_mm, 20.0);
    assert_eq!(scene.whisker.base_radius_um, 30.0);
    assert_eq!(scene.whisker.tip_radius_um, 1.5);
    assert_eq!(scene.whisker.youngs_modulus_gpa, 3.0);
    // The first of the axis, and the vertex that it keeps.
    assert_eq!(scene.whisker.curvature, curvature(0.0, 2.5));
    assert_eq!(scene.pole.radius_mm, 0.25);
    assert_eq!(scene.grid.push_angle_deg, [-70.0, -35.0, 0.0, 35.0, 70.0]);
    assert_eq!(scene.grid.distance_mm, [2.0, 7.5, 20.0]);
    assert_eq!(scene.grid.axis(Parameter::Taper), None);
    assert_eq!(scene.grid.axis(Parameter::ParabolaPerMm), Some(&[0.0, 0.04][..]));
    let swept = parse(&sweep()).unwrap();
    assert_eq!(swept.grid.axis(Parameter::Taper), Some(&[0.0, 0.5, 1.0][..]));
    // The first of the axis.
    assert_eq!(swept.whisker.tip_radius_um, 30.0);
}

fn curvature(parabola_per_mm: f64, vertex_mm: f64) -> Option<Curvature> {
    Some(Curvature { parabola_per_mm, vertex_mm })
}

#[test]
fn what_may_be_left_out_may_be_left_out() {
    let scene = parse(
        "title = 'bare'
         whisker = { length_mm = 20, base_radius_um = 30, tip_radius_um = 0, youngs_modulus_gpa = 3 }
         grid = { push_angle_deg = { from = 5, count = 1 }, distance_mm = { from = 2, to = 2, count = 1 } }",
    )
    .unwrap();
    assert_eq!(scene.whisker.curvature, None);
    assert_eq!(scene.pole.radius_mm, 0.0);
    assert_eq!(scene.grid.push_angle_deg, [5.0]);
    assert_eq!(scene.grid.distance_mm, [2.0]);
    assert_eq!(scene.name, "test");
    let whiskers: Vec<_> = scene.whiskers().flatten().collect();
    assert_eq!(whiskers.len(), 1);
    assert_eq!(whiskers[0].place.values().count(), 0);
    assert_eq!((&whiskers[0].whisker, whiskers[0].pole), (&scene.whisker, scene.pole));
    assert!(!scene.is_sweep());
}

#[test]
fn a_parabola_of_zero_is_straight_but_lends_its_vertex_to_an_axis() {
    let own_zero = with_line(8, "parabola_per_mm = 0");
    let scene = parse(&own_zero).unwrap();
    let curvatures: Vec<_> =
        scene.whiskers().flatten().map(|swept| swept.whisker.curvature).collect();
    assert_eq!(curvatures, [curvature(0.0, 2.5), curvature(0.04, 2.5)]);
    assert_eq!(
        scene.whiskers().flatten().next().unwrap().whisker.rod(&scene.pole, Side::Cb).bend,
        0.0
    );

    let no_axis = own_zero.replace("curvature_per_mm = [0, 0.04]", "");
    // The derivative by the curvature depends on the vertex.
    assert_eq!(parse(&no_axis).unwrap().whisker.curvature, curvature(0.0, 2.5));
    let at_base = no_axis.replace("vertex_mm = 2.5", "vertex_mm = 0");
    assert_eq!(parse(&at_base).unwrap().whisker.curvature, None);
}

#[test]
fn whiskers_come_in_atlas_order_taper_first() {
    let scene = parse(&sweep()).unwrap();
    let seen: Vec<_> = scene
        .whiskers()
        .flatten()
        .map(|swept| {
            let taper = swept.place.value(Parameter::Taper).unwrap();
            (taper, swept.whisker.tip_radius_um, swept.whisker.curvature)
        })
        .collect();
    assert!(scene.is_sweep());
    let [straight, bent] = [0.0, 0.04].map(|per_mm| curvature(per_mm, 2.5));
    let expected = [
        (0.0, 30.0, straight),
        (0.5, 15.0, straight),
        (1.0, 0.0, straight),
        (0.0, 30.0, bent),
        (0.5, 15.0, bent),
        (1.0, 0.0, bent),
    ];
    assert_eq!(seen, expected);

    let all: Vec<_> = scene.whiskers().flatten().collect();
    for size in [1, 4, 6, 7] {
        let groups: Vec<_> = scene.whisker_groups(size).collect();
        assert!(groups.iter().rev().skip(1).all(|group| group.len() == size));
        assert!(groups.concat().into_iter().flatten().eq(all.iter().cloned()));
    }
    assert_eq!(scene.whisker_count(), all.len());
    assert_eq!(scene.first_whisker(), all[0]);
}

/// The bound on the vertex is that beyond which the chord from the base stops growing.
#[test]
fn the_chord_grows_along_the_whisker_up_to_the_last_vertex_allowed() {
    let chord = |a: f64, v: f64, x: f64| x.hypot(a * ((x - v).powi(2) - v * v));
    let grows = |a: f64, v: f64| {
        let chords: Vec<f64> = (0..100_000).map(|i| chord(a, v, f64::from(i) * 1e-3)).collect();
        chords.is_sorted_by(|near, far| near < far)
    };
    let accepted = |a: f64, v: f64| {
        let text = BASE.replace("curvature_per_mm = [0, 0.04]", "");
        let text = text.replace("per_mm = 0.02", &format!("per_mm = {a}"));
        parse(&text.replace("vertex_mm = 2.5", &format!("vertex_mm = {v}"))).is_ok()
    };
    for (a, v) in [(0.05, 28.2), (0.05, 28.4), (0.1, 14.1), (0.1, 14.2), (0.1, -30.0), (0.5, 2.9)] {
        assert_eq!(accepted(a, v), grows(a, v), "A = {a} per mm, vertex at {v} mm");
    }
}

#[test]
fn few_values_stay_and_many_are_represented() {
    let scene = parse(&sweep()).unwrap();
    let pushes: Vec<f64> = (0..16).map(f64::from).collect();
    let thinned = scene.to_builder().push_angle_deg(pushes).build().unwrap().thinned(2, 1);
    assert_eq!(thinned.grid.push_angle_deg, [4.0, 12.0]);
    assert_eq!(thinned.grid.distance_mm, [2.0, 20.0]);
    assert_eq!(thinned.grid.axis(Parameter::Taper), Some(&[0.5][..]));
    assert_eq!(scene.thinned(9, 9), scene);
}
