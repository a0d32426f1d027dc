//! Tables that the base scene does not have, for effects and deviations: what they refuse.

use whiskmap::scene::Parameter;

use super::{BASE, parse, sweep, with_line};

/// The tables of the effects, which the base scene does not have.
#[test]
fn effects_have_their_ranges() {
    for (table, key, bad, said) in [
        ("whisker.modulus_gradient", "tip_to_base", "0", "must be between 0.05 and 20"),
        ("whisker.modulus_gradient", "tip_to_base", "nan", "must be between 0.05 and 20"),
        ("whisker.projection", "arc_stretch", "0.9", "must be between 1 and"),
        ("whisker.projection", "arc_stretch", "2.5", "must be between 1 and"),
        (
            "contact",
            "friction",
            "-0.1",
            "must be between 0 and 1; with more, whiskers coil around the pole for turns on end, and not all ends are known",
        ),
        (
            "contact",
            "friction",
            "inf",
            "must be between 0 and 1; with more, whiskers coil around the pole for turns on end, and not all ends are known",
        ),
    ] {
        let text = format!("{BASE}\n[{table}]\n{key} = {bad}\n");
        let message = parse(&text).unwrap_err();
        let said = format!("{table}.{key} = {bad}: {said}");
        assert!(message.contains(&said), "{said}: {message}");
        let unknown = parse(&text.replace(key, "more")).unwrap_err();
        assert!(unknown.contains("unknown field `more`"), "{unknown}");
    }
    // The sweep goes to a perfect cone, whose radius is 0 at the tip already.
    let pointed =
        parse(&format!("{}\n[whisker.projection]\narc_stretch = 1.03\n", sweep())).unwrap_err();
    assert!(pointed.contains("1 / taper, where the radius at the tip is 0 (1)"), "{pointed}");
}

#[test]
fn the_modulus_at_the_tip_of_a_drooping_whisker_has_limits() {
    let stretched = |tip_to_base: f64, arc_stretch: f64| {
        let effects = format!(
            "tip_radius_um = 30\nmodulus_gradient.tip_to_base = {tip_to_base}\nprojection.arc_stretch = {arc_stretch}"
        );
        parse(&with_line(5, &effects))
    };
    assert_eq!(stretched(0.5, 1.89).map(|_| ()), Ok(()));
    let soft = stretched(0.5, 1.91).unwrap_err();
    assert!(soft.contains("the modulus at the tip is 0.05 of the base's (1.9)"), "{soft}");
    assert!(
        stretched(11.0, 1.89).is_ok()
            && stretched(0.05, 1.0).is_ok()
            && stretched(20.0, 1.0).is_ok()
    );
    let stiff = stretched(11.0, 1.91).unwrap_err();
    assert!(stiff.contains("the modulus at the tip is 20 times the base's (1.9)"), "{stiff}");
}

/// The table of a surface, which the base scene does not have.
#[test]
fn surfaces_have_their_ranges() {
    const LINES: [&str; 6] = [
        "distance_mm = 18",
        "spacing_um = 200",
        "asperity_radius_um = 20",
        "length_mm = 20",
        "jitter = 0.1",
        "seed = 1",
    ];
    let scene = |lines: [&str; 6]| format!("{BASE}[surface]\n{}\n", lines.join("\n"));
    assert!(parse(&scene(LINES)).is_ok());
    for (at, line, said) in [
        (
            0,
            "distance_mm = 300",
            "surface.distance_mm = 300: must be between length_mm / 1000 (0.02) and 10 * length_mm (200)",
        ),
        (1, "spacing_um = 0", "surface.spacing_um = 0: must be between 0.001 and 100000000"),
        (1, "", "missing field `spacing_um`"),
        (
            2,
            "asperity_radius_um = 90",
            "surface.asperity_radius_um = 90: must be at least 0 and less than spacing_um * (1 - jitter) / 2, at which asperities touch (90)",
        ),
        (
            3,
            "length_mm = 1e9",
            "surface.length_mm = 1e9: must be between 0 and 99,999 spacings (19999.8)",
        ),
        (3, "length_mm = 'long'", "invalid type: string \"long\", expected a number"),
        (4, "jitter = 1", "surface.jitter = 1: must be at least 0 and less than 1"),
        (4, "jitter = -0.1", "surface.jitter = -0.1: must be at least 0 and less than 1"),
        (5, "seed = -1", "invalid value: integer `-1`, expected u32"),
        (5, "noise = 1", "unknown field `noise`, expected one of `distance_mm`, `spacing_um`"),
    ] {
        let mut lines = LINES;
        lines[at] = line;
        let why = parse(&scene(lines)).expect_err(line);
        assert!(why.contains(said), "{line}: {why}");
    }
}

/// The table of standard deviations, which the base scene does not have.
#[test]
fn deviations_belong_to_numbers_of_the_scene() {
    let with = |lines: &str| parse(&format!("{BASE}[uncertainty]\n{lines}\n"));
    let names = "`length_mm`, `base_radius_um`, `tip_radius_um`, `taper`";
    let measured = "profile = { rows = [[0, 30], [20, 1.5]] }";
    for (lines, place, parts) in [
        ("", "19:1", ["uncertainty: must have at least one of", names]),
        ("radius = 1", "20:10", ["uncertainty.radius = 1: is not known; must be one of", names]),
        (
            "pole_radius = 1",
            "20:15",
            [
                "uncertainty.pole_radius = 1: is not known; must be one of",
                "; did you mean `pole_radius_mm`?",
            ],
        ),
        (
            "length_mm = -1",
            "20:13",
            ["uncertainty.length_mm = -1: must be", "between 0 and 100000"],
        ),
        (
            "length_mm = nan",
            "20:13",
            ["uncertainty.length_mm = nan: must be", "between 0 and 100000"],
        ),
        (
            "length_mm = inf",
            "20:13",
            ["uncertainty.length_mm = inf: must be", "between 0 and 100000"],
        ),
        (
            "follicle_stiffness_nnm_per_rad = 1e16",
            "20:34",
            ["uncertainty.follicle_stiffness_nnm_per_rad", "between 0 and 1000000000000000"],
        ),
        ("length_mm = '1'", "20:13", ["invalid type: string", "expected a number"]),
        (
            "friction = 0.1",
            "20:12",
            ["uncertainty.friction = 0.1: must be left out", "contact.friction"],
        ),
        ("profile_radius_um = 1", "20:21", ["must be left out", "there is no whisker.profile"]),
        (
            "contact_sd_mm = -1",
            "20:17",
            ["uncertainty.contact_sd_mm = -1: must be", "between 0 and 100000"],
        ),
        (
            "curvature_sd = 1",
            "20:16",
            ["is not known; must be one of", "; did you mean `curvature_sd_per_mm`?"],
        ),
        (
            "tip_radius_um = 1\ntaper = 0.1",
            "21:9",
            ["uncertainty.taper = 0.1", "beside tip_radius_um"],
        ),
    ] {
        let why = with(lines).expect_err(lines);
        for part in parts.into_iter().chain([&*format!("test.toml:{place}")]) {
            assert!(why.contains(part), "{lines}: no {part:?} in {why}");
        }
    }
    let why = parse(&format!("uncertainty = 5\n{BASE}")).unwrap_err();
    assert!(why.contains("invalid type: integer `5`, expected a table"), "{why}");
    let scene = with("taper = 0.01\nlength_mm = 0").unwrap();
    let deviations = scene.uncertainty.as_ref().unwrap();
    assert_eq!(deviations.parameters, [(Parameter::LengthMm, 0.0), (Parameter::Taper, 0.01)]);
    assert_eq!(deviations.profile_radius_um, None);
    let frames = "angle_sd_deg = 2\ncontact_sd_mm = 0.1\ncurvature_sd_per_mm = 1e-3";
    let scene = with(frames).unwrap();
    let deviations = scene.uncertainty.as_ref().unwrap();
    assert_eq!(deviations.frames.values(), [Some(1e-3), Some(0.1), Some(2.0)]);
    let again = parse(&scene.to_toml()).unwrap();
    assert_eq!(again.uncertainty, scene.uncertainty);

    let measured =
        BASE.replace("base_radius_um = 30.0", measured).replace("tip_radius_um = 1.5", "");
    let with = |lines: &str| parse(&format!("{measured}[uncertainty]\n{lines}\n"));
    let scene = with("profile_radius_um = 0.5").unwrap();
    assert_eq!(scene.uncertainty.as_ref().unwrap().profile_radius_um, Some(0.5));
    let why = with("length_mm = 1").unwrap_err();
    assert!(why.contains("must be left out: whisker.profile.rows end at the length"), "{why}");
    let why = with("tip_radius_um = 1").unwrap_err();
    assert!(why.contains("the scene does not give whisker.tip_radius_um"), "{why}");
}

/// The key `whisker.taper` gives the tip its radius. A scene written with other radii keeps the key, and is the same scene when it is read.
#[test]
fn a_taper_takes_the_place_of_the_radius_at_the_tip() {
    let text = with_line(5, "taper = 0.95 # of a rat");
    let tapered = parse(&text).unwrap();
    assert!((tapered.whisker.tip_radius_um - 1.5).abs() < 1e-14);
    for changes in [
        &[(Parameter::Taper, 0.5)][..],
        &[(Parameter::TipRadiusUm, 3.0)],
        &[(Parameter::BaseRadiusUm, 40.0)],
        &[(Parameter::BaseRadiusUm, 40.0), (Parameter::Taper, 0.9)],
        &[(Parameter::LengthMm, 21.0)],
    ] {
        let changed = tapered.with_parameters(changes).unwrap();
        let written = tapered.to_toml_with(changes).unwrap();
        assert!(written.contains("# of a rat") && !written.contains("tip_radius_um"), "{written}");
        let again = parse(&written).unwrap();
        let tips = [&again, &changed].map(|scene| scene.whisker.tip_radius_um);
        assert!((tips[0] - tips[1]).abs() < 1e-13 * changed.whisker.base_radius_um, "{tips:?}");
        assert_eq!(again.whisker.base_radius_um, changed.whisker.base_radius_um);
    }
}

#[test]
fn a_taper_beside_other_radii_at_the_tip_is_refused() {
    let text = with_line(5, "taper = 0.95");
    for (axis, said) in [
        ("taper = [0.5]", "grid.taper gives every whisker of the sweep its tip"),
        ("tip_radius_um = [1]", "grid.tip_radius_um gives every whisker of the sweep its tip"),
        (
            "base_radius_um = [30, 40]",
            "grid.base_radius_um varies the base; give whisker.tip_radius_um to keep the tip, or grid.taper",
        ),
    ] {
        let why = parse(&text.replace("curvature_per_mm = [0, 0.04]", axis)).unwrap_err();
        let said = format!("whisker.taper = 0.95: must be left out: {said}");
        assert!(why.contains(&said), "{why}");
    }
    let no_base = parse(&text.replace("base_radius_um = 30.0", "")).unwrap_err();
    assert!(no_base.contains("whisker.base_radius_um: is left out"), "{no_base}");
    let rows = "profile = { rows = [[0, 30], [20, 1.5]] }";
    let measured = parse(&text.replace("base_radius_um = 30.0", rows)).unwrap_err();
    let said = "whisker.taper = 0.95: must be left out: the radii are those of whisker.profile";
    assert!(measured.contains(said), "{measured}");
}
