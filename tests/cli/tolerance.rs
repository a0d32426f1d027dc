//! `--tolerance` of `map` and `curve`.

use super::{Place, SCENE};
use whiskmap::accuracy::BOUNDED;

#[test]
fn the_selected_steps_are_printed_and_stored_with_the_map() {
    let place = Place::with(SCENE);
    let run = place.map(&["scene.toml", "--tolerance", "1e-6deg", "--no-png"]);
    assert!(run.err.contains("steps of order 8"), "{}", run.err);
    assert!(run.err.contains(BOUNDED), "{}", run.err);
    let map = whiskmap::store::StoredMap::open(&place.path("outputs/scene.exr")).unwrap();
    let tolerances = map.attribute("tolerances").unwrap();
    let estimate = tolerances["push_angle_error_estimated_deg"].as_f64().unwrap();
    assert!(estimate > 1e-12 && estimate <= 1e-6, "{tolerances}");
    assert_eq!(tolerances["bounded"], BOUNDED);
}

/// Coarser steps change the results by at most the tolerance.
#[test]
fn a_curve_meets_its_tolerance() {
    let place = Place::with(SCENE);
    let angles = |arguments: &[&str]| -> Vec<f64> {
        let run = place.good(&[&["curve", "scene.toml"][..], arguments].concat());
        let rows = run.out.lines().skip(1);
        rows.filter_map(|row| row.split(',').nth(4).unwrap().parse().ok()).collect()
    };
    let exact = angles(&[]);
    for tolerance in [1e-2, 1e-5] {
        let found = angles(&["--tolerance", &format!("{tolerance:e}deg")]);
        assert_eq!(found.len(), exact.len());
        let apart = found.iter().zip(&exact).map(|(a, b)| (a - b).abs());
        let apart = apart.fold(0.0, f64::max);
        assert!(apart > 0.0 && apart < tolerance, "{tolerance}: {apart}");
    }
}

#[test]
fn what_is_no_tolerance_is_refused() {
    let place = Place::with(SCENE);
    for (text, why) in [
        ("0", "between 1e-10deg and 1deg"),
        ("1e-11deg", "between 1e-10deg and 1deg"),
        ("nan", "must be an angle, such as"),
        ("0.1rad", "between 1e-10deg and 1deg"),
        ("1e-6mm", "unit mm: must be deg (the default), ° or rad"),
        ("abc", "must be an angle, such as"),
        ("-1", "between 1e-10deg and 1deg"),
    ] {
        let run = place.run(&["curve", "scene.toml", &format!("--tolerance={text}")]);
        assert_eq!(run.code, Some(2), "{text}: {run:?}");
        assert!(run.err.contains(why), "{text}: {}", run.err);
    }
    // The nearest pole is at a tenth of the length: there, a residual of 1e-12 is 6e-10 degrees.
    let run = place.run(&["curve", "scene.toml", "--tolerance", "1e-10deg"]);
    run.assert_refused(&["must be at least", "e-10deg, the estimated error of the finest steps"]);
}
