//! Axes along which whiskers and poles differ.

use whiskmap::Side;
use whiskmap::scene::{Parameter, Scene};

use super::parse;

/// A scene with these lines in its grid.
fn swept(lines: &str) -> Result<Scene, String> {
    parse(&format!(
        "title = 'swept'
[whisker]
length_mm = 20
base_radius_um = 30
{}youngs_modulus_gpa = 3
curvature = {{ parabola_per_mm = 0.02, vertex_mm = 1 }}
[pole]
radius_mm = 0.25
[grid]
push_angle_deg = [-10, 10]
distance_mm = [3, 12]
{lines}",
        if lines.contains("taper") { "" } else { "tip_radius_um = 3\n" },
    ))
}

#[test]
fn every_axis_takes_the_place_of_its_number() {
    for (axis, parameter, values) in [
        ("taper", Parameter::TipRadiusUm, [0.25, 0.5]),
        ("tip_radius_um", Parameter::TipRadiusUm, [0.0, 7.0]),
        ("base_radius_um", Parameter::BaseRadiusUm, [10.0, 50.0]),
        ("length_mm", Parameter::LengthMm, [15.0, 30.0]),
        ("curvature_per_mm", Parameter::ParabolaPerMm, [0.0, 0.04]),
        ("vertex_mm", Parameter::VertexMm, [-2.0, 3.0]),
        ("pole_radius_mm", Parameter::PoleRadiusMm, [0.0, 1.0]),
        ("friction", Parameter::Friction, [0.0, 0.5]),
        ("modulus_tip_to_base", Parameter::ModulusTipToBase, [0.5, 2.0]),
        ("arc_stretch", Parameter::ArcStretch, [1.0, 1.05]),
    ] {
        let scene = swept(&format!("{axis} = {values:?}")).unwrap();
        assert_eq!(scene.grid.sweep[0].variable.name(), axis);
        assert_eq!(scene.whisker_count(), 2, "{axis}");
        let plain = swept("").unwrap();
        for (swept, value) in scene.whiskers().flatten().zip(values) {
            let place: Vec<f64> = swept.place.values().map(|(_, value)| value).collect();
            assert_eq!(place, [value], "{axis}");
            let value = if axis == "taper" { 30.0 * (1.0 - value) } else { value };
            let alone = plain.with(parameter, value).unwrap();
            assert_eq!(swept.whisker, alone.first_whisker().whisker, "{axis}");
            assert_eq!(swept.pole, alone.pole, "{axis}");
            assert_eq!(swept.rod(Side::Cf), alone.first_whisker().rod(Side::Cf));
        }
    }
}

#[test]
fn axes_are_in_the_order_of_the_file_and_the_first_varies_fastest() {
    let lines = "friction = [0, 0.5]\npole_radius_mm = [0.1, 0.2]\ntaper = [0.5]\ncurvature_per_mm = [0, 0.01, 0.02]";
    let scene = swept(lines).unwrap();
    let names: Vec<_> = scene.grid.sweep.iter().map(|axis| axis.variable.name()).collect();
    assert_eq!(names, ["friction", "pole_radius_mm", "taper", "curvature_per_mm"]);
    assert_eq!(scene.whisker_count(), 12);
    let seen: Vec<(f64, f64)> = scene
        .whiskers()
        .flatten()
        .map(|swept| (swept.pole.friction, swept.pole.radius_mm))
        .collect();
    assert_eq!(seen[..4], [(0.0, 0.1), (0.5, 0.1), (0.0, 0.2), (0.5, 0.2)]);
    assert_eq!(scene.whisker(11).unwrap().place.value(Parameter::ParabolaPerMm), Some(0.02));

    // An axis may be a list, a table in one line, keys with dots, or a table.
    let lines = "pole_radius_mm.from = 0.1\npole_radius_mm.count = 1\nfriction = { from = 0, count = 1 }\n\
                 arc_stretch = [1]\n[grid.length_mm]\nfrom = 20\ncount = 1";
    assert_eq!(
        swept(lines).unwrap().grid.sweep_names(),
        "pole_radius_mm, friction, arc_stretch, length_mm"
    );

    // In an atlas a curvature lies upwards, as ever.
    let scene = swept("curvature_per_mm = [0, 0.01, 0.02]\ntaper = [0, 1]").unwrap();
    assert_eq!(scene.grid.sweep[0].variable, Parameter::Taper.into());
    let alone = swept("curvature_per_mm = [0, 0.01, 0.02]").unwrap();
    let [across, upwards] = alone.grid.atlas();
    assert!(across.is_none() && upwards.is_some());
}

#[test]
fn a_logarithmic_range_has_equal_ratios() {
    let scene =
        swept("pole_radius_mm = { from = 0.01, to = 1, count = 5, scale = 'log' }").unwrap();
    let values = &scene.grid.sweep[0].values;
    assert_eq!((values[0], values[4]), (0.01, 1.0));
    for pair in values.windows(2) {
        // Rounding of a power and a product.
        assert!((pair[1] / pair[0] / 10_f64.sqrt() - 1.0).abs() < 1e-15, "{values:?}");
    }
    let linear = swept("friction = { from = 0, to = 1, count = 5, scale = 'linear' }").unwrap();
    assert_eq!(linear.grid.sweep[0].values, [0.0, 0.25, 0.5, 0.75, 1.0]);
    for (line, said) in [
        (
            "friction = { from = 0, to = 1, count = 5, scale = 'log' }",
            "grid.friction.from = 0: must be greater than 0 where scale is \"log\"",
        ),
        (
            "friction = { from = 0, to = 1, count = 5, scale = 'cubic' }",
            "unknown variant `cubic`, expected `linear` or `log`",
        ),
    ] {
        let why = swept(line).unwrap_err();
        assert!(why.contains(said), "{why}");
    }
}

/// Each value is allowed by itself, or the axis by the scene, but some combination is not.
#[test]
fn every_combination_must_be_a_whisker() {
    for (lines, said) in [
        (
            "tip_radius_um = [1, 20]\nbase_radius_um = [10, 30]",
            "grid.tip_radius_um: must be between 0 and base_radius_um (10); refused is tip_radius_um = 20, base_radius_um = 10",
        ),
        (
            "base_radius_um = [2, 30]",
            "whisker.tip_radius_um = 3: must be between 0 and base_radius_um (2); refused is base_radius_um = 2",
        ),
        (
            "curvature_per_mm = [0, 0.2, 0.3]\npole_radius_mm = [0.1, 2]",
            "grid.pole_radius_mm: must be at least 0 and less than the whisker's smallest radius of curvature (1.6",
        ),
        (
            "pole_radius_mm = [0.1, 3]",
            "less than the smallest distance (3); refused is pole_radius_mm = 3",
        ),
        ("pole_radius_mm = [-0.1, 2]", "grid.pole_radius_mm[0] = -0.1: must be between 0 and"),
        (
            "vertex_mm = [0, 80]",
            "grid.vertex_mm: must be at least -10 * length_mm (-200) and less than sqrt(2)",
        ),
        (
            "arc_stretch = [1, 1.5]\nmodulus_tip_to_base = [0.2, 1]",
            "grid.arc_stretch: must be between 1 and 1 / taper, where the radius at the tip is 0 (1.11",
        ),
        (
            "curvature_per_mm = [0, 1e-12, 0.1]",
            "grid.curvature_per_mm: must be 0 (straight) or at least 1e-9 / length_mm",
        ),
        (
            "length_mm = [0.5, 20]",
            "grid.distance_mm[1] = 12: must be between length_mm / 1000 (0.02) and 10 * length_mm (5)",
        ),
        (
            "friction = [0, 3]",
            "grid.friction[1] = 3: must be between 0 and 1; with more, whiskers coil around the pole for turns on end, and not all ends are known",
        ),
        (
            "taper = [0.1, 0.2]\ntip_radius_um = [1, 2]",
            "grid.tip_radius_um: must be left out: grid.taper gives",
        ),
        ("youngs_modulus_gpa = [1, 2]", "unknown field `youngs_modulus_gpa`"),
    ] {
        let why = swept(lines).unwrap_err();
        assert!(why.contains(said), "{lines}\n{why}");
    }
    let measured = "title = 'm'\n[whisker]\nlength_mm = 20\nyoungs_modulus_gpa = 3\nprofile.rows = [[0, 30], [20, 3]]\n\
                    [grid]\npush_angle_deg = [1]\ndistance_mm = [3]\n";
    for axis in ["length_mm", "base_radius_um", "tip_radius_um"] {
        let why = parse(&format!("{measured}{axis} = [1, 2]")).unwrap_err();
        assert!(why.contains(&format!("grid.{axis}: must be left out")), "{why}");
    }
    assert!(parse(&format!("{measured}friction = [0, 1]\npole_radius_mm = [0, 1]")).is_ok());
}
