//! Numbers in another unit: accepted, with a warning.

use whiskmap::random::RandomStream;
use whiskmap::scene::Scene;

use super::{BASE, with_line};

fn warnings(text: &str) -> Vec<String> {
    Scene::parse(text, "test.toml").unwrap().warnings()
}

#[test]
fn a_number_in_another_unit_is_named_with_key_value_and_unit() {
    let thin = "expected 1e-5 to 0.1 of whisker.length_mm = 20 mm";
    let forces = "uN (E I / L^2 of ";
    for (line, replacement, parts) in [
        (
            4,
            "base_radius_um = 0.03\ntip_radius_um = 0",
            &["whisker.base_radius_um = 0.03 um", thin, "is it in mm", forces][..],
        ),
        (4, "base_radius_um = 30000", &["whisker.base_radius_um = 30000 um", thin, "is it in nm"]),
        (5, "tip_radius_um = 0.0015", &["whisker.tip_radius_um = 0.0015 um", thin, "is it in mm"]),
        (
            6,
            "youngs_modulus_gpa = 3000",
            &["whisker.youngs_modulus_gpa = 3000 GPa", "0.1 to 250 GPa", "is it in MPa"],
        ),
        (
            6,
            "youngs_modulus_gpa = 0.003",
            &["whisker.youngs_modulus_gpa = 0.003 GPa", "is it in TPa"],
        ),
    ] {
        let mut text = with_line(line, replacement);
        if replacement.contains('\n') {
            text = text.replace("tip_radius_um = 1.5\n", "");
        }
        let found = warnings(&text).join("\n");
        for part in parts {
            assert!(found.contains(part), "{replacement}: no {part:?} in {found:?}");
        }
    }
    // No other unit makes it a modulus of a whisker.
    let soft = warnings(&with_line(6, "youngs_modulus_gpa = 1e-5")).join("\n");
    assert!(
        soft.contains("1e-5 GPa: expected 0.1 to 250 GPa") && !soft.contains("is it"),
        "{soft}"
    );
    assert_eq!(warnings(BASE), [""; 0]);
    // A perfect cone has no radius at its tip.
    assert_eq!(warnings(&with_line(5, "tip_radius_um = 0")), [""; 0]);
}

/// Both ends of an axis count, and the axis has the number's place.
#[test]
fn axes_are_looked_at_from_end_to_end() {
    let axis = |axis: &str| warnings(&BASE.replace("# taper", &format!("{axis}\n# taper")));
    assert_eq!(axis("base_radius_um = [20, 30]"), [""; 0]);
    let thick = axis("base_radius_um = [20, 30, 3000]");
    assert!(thick[0].starts_with("grid.base_radius_um = 3000 um"), "{thick:?}");
    let thin = axis("tip_radius_um = [0, 0.1, 1]");
    assert!(thin[0].starts_with("grid.tip_radius_um = 0.1 um"), "{thin:?}");
    // The tip of a taper is none of the scene's numbers.
    let tapers = BASE.replace("tip_radius_um = 1.5", "").replace("# taper", "taper");
    assert_eq!(warnings(&tapers), [""; 0]);
}

#[test]
fn forces_of_slender_rods_count_too() {
    let soft = BASE.replace("= 30.0", "= 1").replace("= 1.5", "= 1");
    let soft = soft.replace("length_mm = 20", "length_mm = 99").replace("= 3.0", "= 0.1");
    let soft = soft.replace("[2.0", "[3.0").replace("0.04", "0.004").replace("0.02", "0.002");
    let found = warnings(&soft);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].starts_with("forces of about 8.0e-9 uN (E I / L^2 of 0.1 GPa, 1 um and 99 mm)"),
        "{found:?}"
    );
}

/// A column of radii has one unit, so that its largest radius counts; a waist may be thin.
#[test]
fn of_measured_radii_the_largest_counts() {
    let measured = |rows: &str| {
        let rows = format!("profile = {{ rows = {rows} }}");
        let text = BASE.replace("base_radius_um = 30.0", &rows);
        warnings(&text.replace("tip_radius_um = 1.5", ""))
    };
    let found = measured("[[0, 0.03], [10, 0.04], [20, 0.0015]]");
    assert!(found[0].starts_with("whisker.profile.rows = 0.04 um"), "{found:?}");
    assert_eq!(measured("[[0, 30], [10, 8], [20, 0.1]]"), [""; 0]);
}

/// Rows that jump are named with the size of the jumps; smooth ones and too few are not.
#[test]
fn radii_that_scatter_are_named() {
    let rows = |error: f64, count: u32| -> String {
        let mut random = RandomStream::new(1, 0);
        let row = |i: u32| {
            let s = 20.0 * f64::from(i) / f64::from(count - 1);
            // A curved profile with errors.
            [s, 30.0 - 2.0 * s + 0.03 * s * s + error * random.normal()]
        };
        format!("{:?}", (0..count).map(row).collect::<Vec<_>>())
    };
    let found = |rows: &str, more: &str| {
        let profile = format!("profile = {{ rows = {rows}{more} }}");
        let text = BASE.replace("base_radius_um = 30.0", &profile);
        warnings(&text.replace("tip_radius_um = 1.5", ""))
    };
    let rough = found(&rows(0.5, 41), "");
    assert_eq!(rough.len(), 1, "{rough:?}");
    let (said, rest) = rough[0].split_once(" um from row to row").unwrap();
    let scatter = said.strip_prefix("whisker.profile.rows: radii scatter by ").unwrap();
    let scatter: f64 = scatter.parse().unwrap();
    assert!((scatter / 0.5 - 1.0).abs() < 0.3, "{scatter}");
    assert!(rest.contains("expected at most 0.5 %. Tapers between rows are off by "), "{rest}");
    assert!(
        rough[0].contains(
            "smooth = true replaces the radii by a polynomial through the rows: degree 2"
        )
    );
    assert_eq!(found(&rows(0.5, 41), ", smooth = true"), [""; 0]);
    assert_eq!(found(&rows(0.5, 11), ""), [""; 0]);
    for error in [0.0, 0.05] {
        assert_eq!(found(&rows(error, 41), ""), [""; 0]);
    }
}
