//! Pictures of curves, branches and rows: their axes, regions and ranges, and their size on paper.

use super::{Place, SCENE, words};

/// Draws a picture as SVG.
fn drawn(place: &Place, arguments: &[&str]) -> String {
    place.good(&[arguments, &["--plot", "p.svg"]].concat());
    place.text("p.svg")
}

/// The lines of a plot with this colour, without those of its legend: `[line][point]`.
fn lines(svg: &str, colour: &str) -> Vec<Vec<[f64; 2]>> {
    let tags = svg.lines().filter(|line| line.starts_with("<polyline"));
    let coloured =
        tags.filter(|tag| tag.contains(&format!("stroke=\"{colour}\" stroke-width=\"3\"")));
    let point = |pair: &str| {
        let (x, y) = pair.split_once(',').unwrap();
        [x.parse().unwrap(), y.parse().unwrap()]
    };
    let points = |tag: &str| tag.split('"').nth(1).unwrap().split(' ').map(point).collect();
    let lines = coloured.map(points);
    lines.filter(|line: &Vec<[f64; 2]>| line.len() > 2 || line[1][0] - line[0][0] != 62.0).collect()
}

/// The push angle is to the right, CF on the left; the region is closed by a level line where the tip touches first.
#[test]
fn a_curve_has_the_push_angle_to_the_right_and_is_closed_at_the_tip() {
    let place = Place::with(SCENE);
    let svg = drawn(&place, &["curve", "scene.toml"]);
    for text in [
        "push angle at detachment (deg)",
        "distance at first touch (mm)",
        "concave forward (CF)",
        "concave backward (CB)",
        "first touch at the tip",
    ] {
        assert!(svg.contains(&format!(">{text}<")), "{text}");
    }
    let top = lines(&svg, "#9aa1a8").pop().unwrap();
    assert!(top.len() == 2 && top[0][1] == top[1][1] && top[0][0] < top[1][0], "{top:?}");
    let curves = [lines(&svg, "#222b33"), lines(&svg, "#1c6cc4")].concat();
    let ends: Vec<[f64; 2]> = curves.iter().flatten().copied().collect();
    assert!(top.iter().all(|end| ends.contains(end)));
    assert!(ends.iter().all(|[_, y]| *y >= top[0][1]), "nothing is above the tip");
}

/// In the colours of two whiskers, the lines would look like slip-offs.
#[test]
fn curves_of_several_whiskers_are_closed_in_grey() {
    let sweep = SCENE.replace("tip_radius_um = 1.5\n", "") + "taper = [0.9, 0.95]\n";
    let svg = drawn(&Place::with(&sweep), &["curve", "scene.toml"]);
    assert_eq!(lines(&svg, "#9aa1a8").iter().filter(|line| line[0][1] == line[1][1]).count(), 2);
    assert_eq!(svg.matches(">first touch at the tip<").count(), 1);
}

#[test]
fn the_regions_of_a_straight_whisker_are_minus_and_plus() {
    let straight = SCENE.replace("parabola_per_mm = 0.02", "parabola_per_mm = 0");
    let place = Place::with(&straight);
    let svg = drawn(&place, &["curve", "scene.toml"]);
    assert!(svg.contains(">\u{2212}<") && svg.contains(">+<") && !svg.contains("concave"));
}

/// Unstable forces at 10 mm are more than ten times as large as stable ones.
#[test]
fn the_force_axis_of_a_branch_ends_with_the_stable_states() {
    let place = Place::with(SCENE);
    let branch = ["branch", "scene.toml", "--distance=10,13", "--y=force_un"];
    let height = |svg: &str| {
        let stable = lines(svg, "#0072b2");
        let heights = stable.iter().filter(|line| line.len() > 2).flatten();
        let [low, high] = heights
            .fold([f64::INFINITY, 0.0_f64], |[low, high], [_, y]| [low.min(*y), high.max(*y)]);
        high - low
    };
    let limited = drawn(&place, &branch);
    assert!(height(&limited) > 800.0, "{}", height(&limited));
    assert!(!lines(&limited, "#d55e00").is_empty(), "a second colour");
    let whole = drawn(&place, &[&branch[..], &["--whole"]].concat());
    let ticks = |svg: &str| svg.matches("text-anchor=\"end\"").count();
    assert!(ticks(&whole) > 0 && whole != limited);
}

#[test]
fn a_row_of_a_map_is_a_line_chart() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "--no-png"]);
    let row = words("render outputs/scene.exr --at distance_mm=12 -o p.svg");
    place.good(&[&row[..], &["--channel", "force_un"]].concat());
    let svg = place.text("p.svg");
    assert!(svg.contains(">contact force (\u{b5}N)<") && !svg.contains("<image"));
    assert_eq!(lines(&svg, "#222b33").len(), 2, "one on each side of the push 0");
    assert!(!svg.contains("slides to base"));
    place.run(&row).assert_said(0, "");
    let regimes = place.text("p.svg");
    assert!(regimes.contains("<image"), "regimes have no values");
    let column = words("render outputs/scene.exr --at push_angle_deg=10 -o p.svg");
    place.good(&[&column[..], &["--channel", "force_un"]].concat());
    let svg = place.text("p.svg");
    assert!(svg.contains(">distance at first touch (mm)<") && !svg.contains("<image"));
    let [force] = &lines(&svg, "#222b33")[..] else { panic!("{svg}") };
    // At one push angle, the force falls with the distance; heights are from the top.
    assert!(force.len() > 5 && force.is_sorted_by(|[x, y], [right, lower]| x < right && y < lower));
    // On CF the contact first slides toward the base, then sticks.
    place.write("scene.toml", &SCENE.replace("[grid]", "[contact]\nfriction = 0.3\n[grid]"));
    place.map(&["scene.toml", "--no-png"]);
    place.good(&[&row[..], &["--channel", "force_un"]].concat());
    let svg = place.text("p.svg");
    assert!(svg.contains(">slides to base<"));
    // On CB, and on CF where the contact slides toward the base and toward the tip.
    assert_eq!(lines(&svg, "#222b33").len(), 3);
}

#[test]
fn a_picture_has_its_size_on_paper() {
    let place = Place::with(SCENE);
    let curve = ["curve", "scene.toml", "--size", "8.5x6cm"];
    let svg = drawn(&place, &curve);
    assert!(svg.contains(" width=\"85mm\" height=\"60mm\" "));
    for (name, start) in [("p.pdf", &b"%PDF"[..]), ("p.png", b"\x89PNG")] {
        let run = place.run(&[&curve[..], &["--dpi", "100", "--plot", name]].concat());
        assert_eq!((run.code, &*run.out), (Some(0), &*format!("{name}\n")));
        assert!(place.bytes(name).starts_with(start), "{name}");
    }
    // Width and height in pixels, at bytes 16 to 23 of a PNG.
    assert_eq!(place.bytes("p.png")[16..24], [0, 0, 1, 79, 0, 0, 0, 236]);
    let refused = |more: &[&str], parts: &[&str]| {
        place.run(&[&["curve", "scene.toml"], more].concat()).assert_refused(parts);
    };
    refused(&["--size", "85mm"], &["--size: needs --plot"]);
    refused(&["--plot=q.pdf", "--dpi=300"], &["--size"]);
    let sized = |size: &str, part: &str| refused(&["--plot=q.pdf", "--size", size], &[size, part]);
    sized("85pt", "such as 85mm or 180x120mm");
    sized("3m", "3000 mm: must be between 10 mm and 2000 mm");
    refused(
        &["--plot=q.pdf", "--size=20mm"],
        &["--size: too small for text of 7 pt; the width must be at least"],
    );
    refused(&["--plot=q.pdf", "--size=85x20mm"], &["the height must be at least"]);
    refused(
        &["--plot=q.png", "--size=1m", "--dpi=600"],
        &["--dpi 600: gives 23622 pixels", "at most 10000"],
    );
    assert!(!place.path("q.pdf").exists() && !place.path("q.png").exists());
    let small = ["-o", "q.png", "--size", "12mm"];
    let run = place.run(&[&["render", "scene.toml"][..], &small].concat());
    assert_eq!((run.code, &*run.out), (Some(2), ""), "{run:?}");
    assert!(
        run.err.ends_with(
            "error: --size: too small for text of 7 pt; the width must be at least 40 mm\n"
        ),
        "{run:?}"
    );
}
