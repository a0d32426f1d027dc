//! Units of options, and warnings about values that look like another unit.

use super::{Place, SCENE, words};

#[test]
fn distances_and_angles_take_units() {
    let place = Place::with(SCENE);
    let shape = |distance: &str, angle: &str| {
        let words = ["shape", "scene.toml", "--distance", distance, "--push-angle", angle];
        place.quiet(&words).out
    };
    let plain = shape("15", "5");
    for (distance, angle) in
        [("15mm", "5deg"), ("1.5cm", "5°"), ("15000um", "0.08726646259971647rad")]
    {
        assert!(shape(distance, angle) == plain, "{distance} {angle}");
    }
    let branch = |distances: &str| {
        place.good(&["branch", "scene.toml", "--points", "9", "--distance", distances]).out
    };
    assert_eq!(branch("10,1.5cm"), branch("10,15"));
}

/// Messages give values in the unit of the option, for any unit of the argument.
#[test]
fn messages_name_units() {
    let place = Place::with(SCENE);
    for (distance, angle, said) in [
        ("15", "7rad", "--push-angle 401.07"),
        ("15", "7rad", " deg: must be between -360 deg and 360 deg"),
        ("1m", "5", "--distance 1000 mm: must be between 0.02 mm"),
    ] {
        let words = ["shape", "scene.toml", "--distance", distance, "--push-angle", angle];
        place.run(&words).assert_refused(&[said]);
    }
}

/// Each command that reads a scene warns, once.
#[test]
fn numbers_in_other_units_are_warned_of() {
    let place = Place::with(&SCENE.replace("count = 24", "count = 3").replace("= 3.0", "= 3000"));
    place.write("points.csv", super::data::DATA);
    let warning =
        "warning: whisker.youngs_modulus_gpa = 3000 GPa: expected 0.1 to 250 GPa; is it in MPa?\n";
    for words in [
        &["map", "scene.toml", "--engine", "cpu", "--no-png"][..],
        &["plan", "scene.toml"],
        &["curve", "scene.toml"],
        &["branch", "scene.toml", "--distance", "15"],
        &words("shape scene.toml --distance 15 --push-angle 5"),
        &words("design scene.toml --distance 15 --slip-off 20 --for taper"),
        &words("fit scene.toml --data points.csv --free tip_radius_um"),
        &["submit", "scene.toml", "--shards", "1"],
    ] {
        let run = place.good(words);
        assert_eq!(run.err.matches(warning).count(), 1, "{run:?}");
        assert_eq!(run.err.matches("warning: ").count(), 1, "{run:?}");
    }
}
