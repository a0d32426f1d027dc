//! `whiskmap design`.

use super::{Place, SCENE, words};

const TAPER: [&str; 6] = ["design", "scene.toml", "--distance", "15.66", "--for", "taper"];

/// Runs `design` with more arguments.
fn run(place: &Place, more: &[&str]) -> super::Run {
    place.run(&[&TAPER[..], more].concat())
}

/// A scene with the value of each line detaches at the target.
#[test]
fn a_value_is_a_line() {
    let place = Place::with(SCENE);
    let found = run(&place, &["--side", "cb", "--slip-off", "20deg"]);
    assert_eq!((found.code, &*found.err), (Some(0), ""), "{found:?}");
    let [line] = found.out.lines().collect::<Vec<_>>()[..] else {
        panic!("{found:?}");
    };
    let taper: f64 = line.parse().unwrap();
    let tip = format!("tip_radius_um = {:?}", 30.0 * (1.0 - taper));
    let designed = SCENE.replace("tip_radius_um = 1.5", &tip);
    let designed = designed.replace("{ from = 2, to = 20, count = 24 }", "[15.66]");
    place.write("designed.toml", &designed);
    let curve = place.quiet(&["curve", "designed.toml"]).out;
    let end: Vec<&str> = curve.lines().nth(2).unwrap().split(',').collect();
    assert_eq!((end[0], end[3]), ("cb", "slip-off"));
    assert!((end[4].parse::<f64>().unwrap() - 20.0).abs() < 1e-7, "{curve}");
    // The value has 10 digits. The scene written by -o has the radius to match, and its comments.
    assert!((11..=12).contains(&line.len()), "{line}");
    place.write("scene.toml", &format!("# mine\n{SCENE}"));
    let better = run(&place, &["--slip-off", "20deg", "-o", "better.toml"]);
    assert_eq!((better.code, &better.out), (Some(0), &found.out));
    let better = place.text("better.toml");
    let radius = better.split("tip_radius_um = ").nth(1).unwrap();
    let radius = radius.split_whitespace().next().unwrap();
    let tip_radius: f64 = radius.parse().unwrap();
    assert!(better.starts_with("# mine\n") && radius.len() <= 12, "{better}");
    assert!((tip_radius / 30.0 + taper - 1.0).abs() < 1e-9, "{better}");
    assert_eq!(run(&place, &["--slip-off", "20deg", "-o", "-"]).out, better);
    // The plot does not change the result, and has one dot at the solution.
    let plotted = run(&place, &["--slip-off", "20deg", "--plot", "p.svg"]);
    assert_eq!((plotted.code, plotted.out), (Some(0), found.out.clone()));
    let svg = place.text("p.svg");
    assert!(
        svg.contains(">taper (1 \u{2212} tip/base radius)<") && svg.contains(">20 deg<"),
        "{svg}"
    );
    assert_eq!(svg.matches("<circle").count(), 2, "the dot, and its sample in the legend");
    // Loads have the unit in which they read best, in the legend and on an axis.
    let load = ["--side", "cb", "--max-force", "2mN", "--plot", "p.svg"];
    run(&place, &load);
    let svg = place.text("p.svg");
    assert!(svg.contains(">2 mN<") && svg.contains("N)<"), "{svg}");
    // The angle in another unit; its sign gives the side.
    for angle in ["20", "20 deg", "20°", "0.3490658503988659rad"] {
        assert_eq!(run(&place, &["--slip-off", angle]).out, found.out, "{angle}");
    }
}

#[test]
fn an_unreachable_target_is_refused_with_the_angles_that_are_reached() {
    let place = Place::with(SCENE);
    let none = |more: &[&str], parts: &[&str]| {
        let run = run(&place, more);
        assert_eq!((run.code, &*run.out), (Some(1), ""), "{run:?}");
        for part in parts {
            assert!(run.err.contains(part), "no {part} in {run:?}");
        }
    };
    let range = "error: no taper between 0 and 1 ";
    none(
        &["--slip-off", "5deg"],
        &[
            range,
            "makes the whisker slip off at 5 deg: it slips off between ",
            ", and it is pulled off between ",
        ],
    );
    none(&["--pull-off", "-5"], &[range, "pulls the whisker off at -5 deg: "]);
    none(
        &["--max-strain", "10", "--side", "cb"],
        &[
            range,
            "gives a largest bending strain of 10: it slips off with ",
            ", and it is pulled off with ",
        ],
    );
    // Numbers come back in the unit of the question.
    for (moment, asked, reached) in [
        ("20mNm", "gives a largest moment at the base of 20 mNm: it slips off with 7.88", "mNm"),
        ("5uNmm", "gives a largest moment at the base of 5 uNmm: it slips off with ", "uNmm"),
    ] {
        none(
            &["--max-moment", moment, "--side", "cb"],
            &[range, asked, &format!(" {reached} to "), &format!(" {reached}, and ")],
        );
    }
    none(&["--slip-off", "0.1rad"], &["slip off at 0.1 rad: it slips off between 0.", " rad and "]);
    let far = words("design scene.toml --distance 150 --for taper --slip-off 9");
    let far = place.run(&far);
    assert_eq!(far.code, Some(1), "{far:?}");
    assert!(far.err.contains("it does not reach the pole"), "{far:?}");
    let soft = SCENE.replace("[grid]", "[whisker.follicle]\nstiffness_nnm_per_rad = 10\n[grid]");
    place.write("soft.toml", &soft);
    let soft =
        place.run(&words("design soft.toml --distance 5 --for base_radius_um --slip-off 40"));
    let said =
        "the ends of some pushes are unresolved, such as those beyond nine turns of the base";
    assert!(soft.code == Some(1) && soft.err.contains(said), "{soft:?}");
    let stiff = words("design scene.toml --distance 15.66 --for youngs_modulus_gpa --slip-off 9");
    let stiff = place.run(&stiff);
    assert_eq!(stiff.code, Some(1), "{stiff:?}");
    assert!(
        stiff.err.contains("it slips off at 15.6") && stiff.err.contains("for every value"),
        "{stiff:?}"
    );
}

/// A target that every value reaches has the range, not a denial, nor a list. A target next to it has a digit that differs.
#[test]
fn a_target_that_every_value_reaches_has_a_range() {
    let place = Place::with(include_str!("../../scenes/cylinder.toml"));
    let curve = place.quiet(&["curve", "scene.toml", "--distance", "5"]).out;
    let row = curve.lines().find(|line| line.starts_with("cf,")).unwrap();
    let exact = row.split(',').nth(4).unwrap();
    let design = |goal: &str, varied: &[&str]| {
        let words = ["design", "scene.toml", "--distance", "5", goal, "--for"];
        let run = place.run(&[&words[..], varied].concat());
        assert_eq!((run.code, &*run.out), (Some(1), ""), "{run:?}");
        run.err
    };
    let slip_off = format!("--slip-off={exact}");
    let said = design(&slip_off, &["length_mm"]);
    assert!(
        said.starts_with("error: the target does not determine length_mm: every value between "),
        "{said}"
    );
    let own = " and 500, such as the scene's own 20, makes the whisker slip off at -109.74";
    assert!(said.contains(own), "{said}");
    let said = design(&slip_off, &["base_radius_um", "--keep", "taper"]);
    assert!(said.contains(", such as the scene's own 30, "), "{said}");
    let near = format!("{:.9}", exact.parse::<f64>().unwrap() + 1e-8);
    let said = design(&format!("--slip-off={near}"), &["length_mm"]);
    let wanted = format!(" slip off at {near} deg: it slips off at ");
    let reached = said.split_once(&wanted).unwrap_or_else(|| panic!("{said}"));
    let exact: f64 = exact.parse().unwrap();
    assert!(reached.1.starts_with(&format!("{exact:.8} deg")), "{said}");
}

#[test]
fn what_cannot_be_designed_is_refused() {
    let place = Place::with(SCENE);
    let refused = |more: &[&str], parts: &[&str]| run(&place, more).assert_refused(parts);
    refused(&[], &["--slip-off <ANGLE>|--pull-off <ANGLE>|--max-force <FORCE>"]);
    refused(&["--max-force", "60mN"], &["--side"]);
    let cb = |goal, value| ["--side", "cb", goal, value];
    refused(&cb("--max-force", "60Nm"), &["unit Nm: must be uN (the default), nN, mN or N"]);
    refused(&cb("--max-strain", "-1"), &["must be more than 0"]);
    refused(&cb("--max-moment", "0uNm"), &["must be more than 0"]);
    refused(&["--slip-off", "9", "--pull-off", "9"], &["cannot be used with"]);
    refused(
        &["--slip-off", "9", "--plot", "p.gif"],
        &["--plot p.gif: must end in .png, .svg or .pdf"],
    );
    refused(
        &["--slip-off", "nine"],
        &["'nine'", "must be an angle, such as 30, 30deg, 30° or 0.5rad"],
    );
    for angle in ["0", "3241", "57rad"] {
        let said = "must be between -3240deg and 3240deg, nine turns of the base, and not 0";
        refused(&["--slip-off", angle], &[said]);
    }
    refused(
        &["--slip-off", "-9", "--side", "cb"],
        &["--slip-off -9 deg: a push angle of --side cb must be positive"],
    );
    refused(
        &["--pull-off", "9", "--side", "cf"],
        &["--pull-off 9 deg: a push angle of --side cf must be negative"],
    );
    let other = |scene: &str, name: &str, parts: &[&str]| {
        let words = ["design", scene, "--distance", "9", "--slip-off", "9", "--for", name];
        place.run(&words).assert_refused(parts);
    };
    other(
        "scene.toml",
        "friction",
        &["scene.toml: --for friction: must be one of length_mm, ", "it has no contact.friction"],
    );
    other("scene.toml", "stiffness", &["'stiffness'", "--for", "taper"]);
    place.write("sweep.toml", &format!("{SCENE}curvature_per_mm = [0.02, 0.03]\n"));
    other(
        "sweep.toml",
        "taper",
        &[
            "grid.curvature_per_mm: the scene sweeps 2 whiskers, but design needs one; select it by --at",
        ],
    );
    let far = words("design scene.toml --distance 1e9 --slip-off 9 --for taper");
    place.run(&far).assert_refused(&["--distance 1000000000 mm: must be between"]);
}

/// Several parameters have a header, and the scene with the values reaches all targets. Distances may be parts of the length.
#[test]
fn several_targets_have_a_line_of_values() {
    let place = Place::with(SCENE);
    let asked =
        words("design scene.toml --distance 60% --slip-off 30deg --max-moment 0.05uNm --for");
    let more = ["base_radius_um=10um..0.1mm,taper", "-o", "better.toml"];
    let found = place.quiet(&[&asked[..], &more].concat());
    let mut lines = found.out.lines();
    assert_eq!(lines.next(), Some("base_radius_um,taper"));
    let values = lines.next().unwrap().split(',').map(|value| value.parse().unwrap());
    let values: Vec<f64> = values.collect();
    assert_eq!((values.len(), lines.next()), (2, None), "{found:?}");
    let again = words("design better.toml --distance 12 --slip-off 30deg --for taper");
    let taper: f64 = place.run(&again).out.trim().parse().unwrap();
    assert!((taper - values[1]).abs() < 1e-5, "{taper} {values:?}");
    let none = place.run(&[&asked[..], &["base_radius_um=10..20,taper"]].concat());
    assert_eq!((none.code, &*none.out), (Some(1), ""), "{none:?}");
    for part in [
        "no base_radius_um between 10 and 20 and taper between 0 and 1 makes the whisker slip off at 30 deg and gives a largest moment \
         at the base of 0.05 uNm: the nearest values are base_radius_um 20 (a limit) and taper ",
        " uNm; beyond the limits the targets may be nearer",
    ] {
        assert!(none.err.contains(part), "{part}: {none:?}");
    }
}

#[test]
fn a_distance_and_a_kept_taper_are_designed() {
    let place = Place::with(SCENE);
    let found = place.good(&words("design scene.toml --slip-off 20deg --for distance_mm"));
    let distance = found.out.lines().next().unwrap();
    let back =
        ["design", "scene.toml", "--distance", distance, "--slip-off", "20deg", "--for", "taper"];
    let taper: f64 = place.run(&back).out.lines().next().unwrap().parse().unwrap();
    assert!((taper - 0.95).abs() < 1e-6, "{taper}");
    let kept = [
        &words("design scene.toml --distance 12 --side cb --max-moment 100")[..],
        &["--for", "base_radius_um", "--keep", "taper", "-o", "-"],
    ];
    let kept = place.good(&kept.concat());
    let radius = |name: &str| -> f64 {
        let text = kept.out.split(&format!("{name} = ")).nth(1).unwrap();
        text.split_whitespace().next().unwrap().parse().unwrap()
    };
    // The tip has 15 digits.
    let tip_to_base = radius("tip_radius_um") / radius("base_radius_um");
    assert!((tip_to_base - 0.05).abs() < 1e-15, "{}", kept.out);
    place.write("scene.toml", &SCENE.replace("tip_radius_um = 1.5", "taper = 0.940"));
    let kept = place.good(&words(
        "design scene.toml --distance 12 --side cb --max-moment 100 --for base_radius_um --keep taper -o -",
    ));
    assert!(kept.out.contains("\ntaper = 0.940\n"), "{}", kept.out);
    assert!(!kept.out.contains("base_radius_um = 30"), "{}", kept.out);
    let varied = words("design scene.toml --distance 12 --side cb --max-moment 100 --for taper");
    let printed = place.good(&varied).out;
    let written = place.good(&[&varied[..], &["-o", "-"]].concat()).out;
    let mut values = printed.lines();
    let is_written = values.any(|taper| written.contains(&format!("\ntaper = {taper}\n")));
    assert!(is_written, "{printed}{written}");
}

#[test]
fn targets_and_parameters_that_do_not_fit_are_refused() {
    let place = Place::with(SCENE);
    let slip = ["design", "scene.toml", "--slip-off", "20deg"];
    for (more, said) in [
        (
            "--distance 12 --for taper,base_radius_um",
            "--for taper,base_radius_um: must be as many parameters as targets; these are --slip-off",
        ),
        ("--for taper", "--distance: is left out, and --for does not vary distance_mm"),
        (
            "--distance 12 --for distance_mm",
            "--distance: must be left out, because --for varies distance_mm",
        ),
        ("--distance 0% --for taper", "or a part of the whisker's length, such as 70%"),
        (
            "--distance 12 --for taper=1..0",
            "taper: limits must be two growing values, such as taper=1..2",
        ),
        ("--distance 12 --for length_mm=1um..9deg", "length_mm=9deg: unit deg: must be mm"),
        (
            "--distance 12 --for taper --keep taper",
            "--keep taper: it can be kept where base_radius_um or",
        ),
        ("--distance 12 --for taper --keep length", "'length'"),
        ("--for distance_mm -o b.toml", "--output: must be left out with --for distance_mm"),
        (
            "--distance 12 --for taper,length_mm --max-force 1 --plot p.svg",
            "--plot: must be left out with several parameters",
        ),
        (
            "--distance 12 --for taper,tip_radius_um --max-force 1",
            "--for taper and tip_radius_um: give one of them",
        ),
    ] {
        let words: Vec<&str> = slip.into_iter().chain(more.split(' ')).collect();
        place.run(&words).assert_refused(&[said]);
    }
}
