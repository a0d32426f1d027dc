//! Numbers that do not exist: no table and no JSON has NaN or an infinity, whatever the scene and the input.

use super::{Place, Run};

/// Scene of which the tests replace single lines.
const BASE: &str = r#"title = "A small map"
[whisker]
length_mm = 20
base_radius_um = 30
tip_radius_um = 1.5
youngs_modulus_gpa = 3
[whisker.curvature]
parabola_per_mm = 0.02
[pole]
radius_mm = 0.25
[grid]
push_angle_deg = { from = -70, to = 70, count = 6 }
distance_mm = { from = 2, to = 20, count = 6 }
"#;

const HEADER: &str =
    "time_s,curvature_per_mm,at_arc_length_mm,contact_x_mm,contact_y_mm,contact_angle_deg";

/// Checks that no cell of the program's output is NaN or infinite.
fn assert_finite(run: &Run, case: &str) {
    let is_not_finite = |word: &&str| word.parse::<f64>().is_ok_and(|number| !number.is_finite());
    let mut words = run.out.split([',', ' ', '\n', '"', ':']);
    assert_eq!(words.find(is_not_finite), None, "{case}: {run:?}");
}

/// Perfect cones and tips that are nearly one, cylinders, and the ends of the ranges of scenes.
#[test]
fn tables_of_extreme_whiskers_have_only_numbers() {
    let shape = ["shape", "scene.toml", "--push-angle=10"];
    let commands: [&[&str]; 7] = [
        &shape,
        &[&shape[..], &["--points=3", "--branch=unstable"]].concat(),
        &[&shape[..], &["--units=N,Nm,m,rad"]].concat(),
        &["branch", "scene.toml"],
        &["curve", "scene.toml", "--derivatives"],
        &["whisk", "scene.toml", "--sine=40deg,10,0.1", "--rate=200"],
        &["sensitivity", "scene.toml"],
    ];
    let mut tables = 0;
    for (before, after) in [
        ("", ""),
        ("tip_radius_um = 1.5", "tip_radius_um = 0"),
        ("tip_radius_um = 1.5", "tip_radius_um = 1e-300"),
        ("tip_radius_um = 1.5", "tip_radius_um = 30"),
        ("parabola_per_mm = 0.02", "parabola_per_mm = 0"),
        ("youngs_modulus_gpa = 3", "youngs_modulus_gpa = 1e-6"),
        ("youngs_modulus_gpa = 3", "youngs_modulus_gpa = 1e4"),
        ("base_radius_um = 30", "base_radius_um = 1e5"),
        ("radius_mm = 0.25", "radius_mm = 0"),
    ] {
        let place = Place::with(&BASE.replace(before, after));
        for distance in ["2", "15.66", "19.6"] {
            for command in commands {
                let at: &[&str] = match command[0] {
                    "curve" | "sensitivity" => &[],
                    _ => &["--distance", distance],
                };
                let run = place.run(&[command, at].concat());
                assert_finite(&run, &format!("{after} {distance} {command:?}"));
                tables += usize::from(run.code == Some(0));
            }
        }
    }
    assert!(tables > 120, "{tables}");
}

/// The free part of a whisker keeps its rest shape, to the tip of a perfect cone.
#[test]
fn the_tip_of_a_perfect_cone_has_no_strain() {
    for tip in ["0", "1e-300"] {
        let place =
            Place::with(&BASE.replace("tip_radius_um = 1.5", &format!("tip_radius_um = {tip}")));
        let run = place.run(&["shape", "scene.toml", "--distance=15.66", "--push-angle=10"]);
        let last = run.out.lines().last().unwrap_or_default();
        assert!(last.starts_with("20.0,") && last.ends_with(",0.0,0.0,free"), "{last}");
    }
}

#[test]
fn frames_with_absurd_numbers_are_refused() {
    let place = Place::with(BASE);
    let force = |row: &str| {
        place.write("f.csv", &format!("{HEADER},at_x_mm,at_y_mm\n{row}\n"));
        place.run(&["force", "scene.toml", "--frames=f.csv"])
    };
    for (row, column) in [
        ("0,1e308,2,15,4,30,2,0", "curvature_per_mm = 1e308"),
        ("0,-2e6,2,15,4,30,2,0", "curvature_per_mm = -2e6"),
        ("0,0.03,2,1e308,4,30,2,0", "contact_x_mm = 1e308"),
        ("0,0.03,2,15,-1e300,30,2,0", "contact_y_mm = -1e300"),
        ("0,0.03,2,15,4,30,1e200,0", "at_x_mm = 1e200"),
        ("0,0.03,2,15,4,30,2,-inf", "at_y_mm = -inf"),
    ] {
        let must = format!("f.csv:2: {column}: must be a number between -1e6 and 1e6");
        force(row).assert_refused(&[&must]);
    }
    for time in ["1e308", "-1e13"] {
        let must = format!("f.csv:2: time_s = {time}: must be a number between -1e12 and 1e12");
        force(&format!("{time},0.03,2,15,4,30,2,0")).assert_refused(&[&must]);
    }
    // A lever within the rounding errors of the positions gives no force.
    for (x, lever) in [("2", "none"), ("2.0000000000000004", "rounding"), ("3e-310", "subnormal")] {
        let at = if lever == "subnormal" { "0" } else { "2" };
        let run = force(&format!("0,0.03,0,{x},0,0,{at},0"));
        assert!(run.out.ends_with(",,,,,,,no-lever\n"), "{run:?}");
    }
    let largest = force("1e12,1e6,0,1e6,1e6,45,-1e6,-1e6");
    assert_finite(&largest, "the largest numbers");
    assert_eq!(largest.code, Some(0), "{largest:?}");
}

/// Times of a course have the limits of frames.
#[test]
fn courses_with_absurd_times_are_refused() {
    let place = Place::with(BASE);
    let whisk = ["whisk", "scene.toml", "--distance=9"];
    place.write("a.csv", "time_s,angle_deg\n-1e308,0\n1e308,20\n");
    let run = place.run(&[&whisk[..], &["--angles=a.csv"]].concat());
    run.assert_refused(&["a.csv:2: time_s = -1e308: must be a number between -1e12 and 1e12"]);
    let run = place.run(&[&whisk[..], &["--sine=25deg,1e-301,1e301", "--rate=1e-300"]].concat());
    run.assert_refused(&["--sine 25,1e-301,1e301: ", "must be between -1e12 and 1e12"]);
}

#[test]
fn lengths_that_overflow_in_their_unit_are_refused() {
    let place = Place::with(BASE);
    let run = place.run(&["branch", "scene.toml", "--distance=1e308m"]);
    run.assert_refused(&["1e308m", "must be a length"]);
}
