//! Euler spirals and titles: what is accepted, and what is refused.

use whiskmap::scene::EulerSpiral;

use super::{BASE, parse};

/// The base scene with `whisker` in place of its radii, and `curvature` in place of its parabola.
pub(super) fn scene(whisker: &str, curvature: &str) -> String {
    let mut lines: Vec<&str> = BASE.lines().collect();
    let replaced = ["parabola_per_mm", "vertex_mm", "taper", "curvature_per_mm"];
    lines.retain(|line| !replaced.iter().any(|key| line.starts_with(key)));
    let text = lines.join("\n").replace("[whisker.curvature]", curvature);
    if whisker.is_empty() {
        return text;
    }
    let radii = |line: &&str| !line.starts_with("base_radius") && !line.starts_with("tip_radius");
    let text: Vec<&str> = text.lines().filter(radii).collect();
    text.join("\n").replace("[pole]", &format!("{whisker}\n[pole]"))
}

pub(super) fn refusal(text: &str) -> String {
    parse(text).expect_err(text)
}

#[test]
fn a_spiral_bends_both_ways() {
    let text = scene("", "[whisker.curvature]\neuler_spiral = { per_mm = -0.05, per_mm2 = 0.004 }");
    let whisker = &parse(&text).unwrap().whisker;
    let spiral = EulerSpiral { per_mm: -0.05, per_mm2: 0.004 };
    assert_eq!((whisker.euler_spiral, whisker.curvature), (Some(spiral), None));
    assert!((whisker.sharpest_bend_per_mm() - 0.05).abs() < 1e-15);
    let s_shape =
        scene("", "[whisker.curvature]\neuler_spiral = { per_mm = 0.4, per_mm2 = -0.04 }");
    assert!((parse(&s_shape).unwrap().whisker.sharpest_bend_per_mm() - 0.4).abs() < 1e-15);
    let none = scene("", "[whisker.curvature]\neuler_spiral = { per_mm = 0, per_mm2 = 0 }");
    assert_eq!(parse(&none).unwrap().whisker.euler_spiral, None);
}

#[test]
fn spirals_that_are_refused() {
    for (curvature, why) in [
        ("", "must have either parabola_per_mm"),
        ("parabola_per_mm = 0.02\neuler_spiral = { per_mm = 0, per_mm2 = 0 }", "must have either"),
        ("vertex_mm = 1\neuler_spiral = { per_mm = 0.1, per_mm2 = 0 }", "must have either"),
        ("euler_spiral = { per_mm = 0.1 }", "missing field `per_mm2`"),
        ("euler_spiral = { per_mm = nan, per_mm2 = 0 }", "per_mm = nan: must be between"),
        ("euler_spiral = { per_mm = 1.1, per_mm2 = 0 }", "20 / length_mm (1)"),
        ("euler_spiral = { per_mm = 0.5, per_mm2 = -0.1 }", "bends it by 20 / length_mm"),
        // A full circle and more: the distance from the base does not grow.
        ("euler_spiral = { per_mm = 0.32, per_mm2 = 0 }", "must bend the whisker less"),
        ("euler_spiral = { per_mm = 0, per_mm2 = 0.02 }", "must bend the whisker less"),
    ] {
        let message = refusal(&scene("", &format!("[whisker.curvature]\n{curvature}")));
        assert!(message.contains(why), "{curvature}: {message}");
    }
    let spiral = "[whisker.curvature]\neuler_spiral = { per_mm = 0.1, per_mm2 = 0 }";
    let axis = scene("", spiral).replace("[grid]", "[grid]\ncurvature_per_mm = [0, 0.1]");
    assert!(refusal(&axis).contains("must be left out: the whisker is an Euler spiral"));
    // Thicker than what it bends round.
    let bulky = scene("", spiral)
        .replace("radius_mm = 0.25", "radius_mm = 10")
        .replace("[2.0, 7.5, 20.0]", "[11, 20]");
    assert!(refusal(&bulky).contains("smallest radius of curvature (10)"), "{}", refusal(&bulky));
}

#[test]
fn a_title_has_at_most_a_thousand_characters() {
    let titled = |length: usize| {
        scene("", "").replacen("title = \"", &format!("title = \"{}", "\u{b5}".repeat(length)), 1)
    };
    let untitled = parse(&scene("", "")).unwrap().title.chars().count();
    assert_eq!(parse(&titled(1000 - untitled)).err(), None);
    let message = refusal(&titled(1001 - untitled));
    let why = "title: must have at most 1000 characters, has 1001";
    assert!(message.contains(why), "{message}");
}
