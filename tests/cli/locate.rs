//! `whiskmap locate`.

use super::{Place, SCENE, words};

/// The numbers that `shape` gives a state lead back to it.
#[test]
fn a_state_of_shape_comes_back() {
    let place = Place::with(SCENE);
    place.good(&words(
        "shape scene.toml --distance 15.66 --push-angle 10 --state state.csv --csv shape.csv",
    ));
    let table = |text: &str, name: &str| -> f64 {
        let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let at = lines.next().unwrap().iter().position(|column| *column == name).unwrap();
        lines.next().unwrap()[at].parse().unwrap()
    };
    let state = place.text("state.csv");
    let moment = format!("{:?}", table(&state, "base_moment_nnm"));
    let force = format!("{:?}", table(&state, "base_force_y_un"));
    let located = place.good(&[
        "locate",
        "scene.toml",
        "--base-moment",
        &moment,
        "--base-force-y",
        &force,
        "--angle",
        "0.5rad",
    ]);
    for (name, wanted) in [("distance_mm", 15.66), ("push_angle_deg", 10.0)] {
        let value = table(&located.out, name);
        assert!((value - wanted).abs() < 1e-8, "{name} {value}");
    }
    assert!(table(&located.out, "lab_contact_x_mm") < table(&located.out, "contact_x_mm"));
}

#[test]
fn readings_of_a_file_have_rows_and_a_picture() {
    let place = Place::with(SCENE);
    place.write(
        "r.csv",
        "base_moment_nnm,base_force_y_un,day\n60,6,1\n,6,1\n0,0,1\n-60,6,1\nNA,nan,1\n",
    );
    let run = place.run(&words(
        "locate scene.toml --readings r.csv --moment-sd 1nNm --force-sd 0.1uN --csv out.csv \
         --plot out.svg",
    ));
    assert_eq!((run.code, &*run.out), (Some(0), "out.csv\nout.svg\n"), "{run:?}");
    assert!(run.err.contains("columns that are not used: day"), "{run:?}");
    assert!(run.err.contains("4 of 5 readings have no state"), "{run:?}");
    let table = place.text("out.csv");
    for end in [",incomplete", ",no-load", ",no-state"] {
        assert!(table.lines().any(|line| line.ends_with(end)), "{table}");
    }
    let svg = place.text("out.svg");
    assert!(svg.contains(">at rest<") && svg.contains(">one state<"), "{svg}");
}

/// A cylinder's moment and axial force are dependent; other pairs have at least the state itself.
#[test]
fn a_map_counts_the_states_that_share_numbers() {
    let cylinder = SCENE.replace("tip_radius_um = 1.5", "tip_radius_um = 30");
    let straight = cylinder.replace("[whisker.curvature]\nparabola_per_mm = 0.02\n", "");
    let (axes, _) = straight.split_once("[grid]").unwrap();
    let grid = "[grid]\npush_angle_deg = { from = -60, to = 60, count = 200 }\ndistance_mm = { from = 1, to = 22, count = 60 }\n";
    let place = Place::with(&format!("{axes}{grid}"));
    let run = place.run(&words("locate scene.toml --map --csv map.csv --plot map.svg"));
    assert_eq!((run.code, &*run.out), (Some(0), "map.csv\nmap.svg\n"), "{run:?}");
    let table = place.text("map.csv");
    let header = table.lines().next().unwrap();
    assert!(header.starts_with("distance_mm,side,push_angle_deg,arc_length_mm,moment_x_states"));
    let rows = table.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    let counts = rows.map(|row| [4, 6, 8].map(|column| row[column].parse::<usize>().unwrap()));
    let counts: Vec<[usize; 3]> = counts.collect();
    assert!(counts.len() > 500, "{table}");
    for [moment_x, moment_y, force] in counts {
        assert!(moment_x == 0 && moment_y > 0 && force > 0, "{moment_x} {moment_y} {force}");
    }
    let svg = place.text("map.svg");
    for text in [
        ">moment and axial force<",
        ">condition of the contact<",
        ">singular line<",
        "one number follows from the other<",
    ] {
        assert!(svg.contains(text), "{text}: {svg}");
    }
    place
        .write("scene.toml", &format!("{axes}[grid]\npush_angle_deg = [10]\ndistance_mm = [30]\n"));
    place
        .run(&["locate", "scene.toml", "--map"])
        .assert_refused(&["--map: no distance and push angle of the grid has a stable state"]);
}

#[test]
fn bad_readings_are_refused() {
    let place = Place::with(SCENE);
    let locate = |more: &[&str]| place.run(&[&["locate", "scene.toml"], more].concat());
    for (given, said) in [
        (
            &["--base-moment", "60"][..],
            "--base-moment 60: must come with another of --base-moment, --base-force-x and --base-force-y",
        ),
        (&["--base-moment", "60mm", "--base-force-x", "1"], "unit mm: must be nNm"),
        (
            &["--base-moment", "1e19", "--base-force-x", "1"],
            "must be between -1e18 nNm and 1e18 nNm",
        ),
        (
            &["--base-moment", "1", "--base-force-x", "-1e19"],
            "must be between -1e18 uN and 1e18 uN",
        ),
        (&words("--base-moment 1 --base-force-x 1 --angle 361"), "must be between -360"),
        (&words("--base-moment 1 --base-force-x 1 --moment-sd 1"), "--force-sd"),
        (
            &words("--base-moment 1 --base-force-x 1 --moment-sd 0 --force-sd 1"),
            "must be more than 0",
        ),
        (
            &words("--base-moment 1 --base-force-x 1 --moment-sd 1 --force-sd -1"),
            "must be more than 0",
        ),
        (&["--base-moment", "1", "--readings", "r.csv"], "--readings"),
        (&["--map", "--base-moment", "1"], "--map"),
        (&["--map", "--readings", "r.csv"], "--map"),
        (&[], "--readings"),
    ] {
        locate(given).assert_refused(&[said]);
    }
    for (text, said) in [
        (
            "base_moment_nnm\n1\n",
            "r.csv: must have at least two of the columns base_moment_nnm, base_force_x_un and base_force_y_un",
        ),
        ("base_moment_nnm,base_force_q_un\n1,2\n", "did you mean"),
        (
            "base_moment_nnm,base_force_x_un\n1,x\n",
            "r.csv:2: base_force_x_un = x: must be a number between -1e18 and 1e18, or empty where it is missing",
        ),
        (
            "base_moment_nnm,base_force_x_un,angle_deg\n1,2,400\n",
            "r.csv:2: angle_deg = 400: must be a number between -360 and 360",
        ),
        (
            "base_moment_nnm,base_moment_nnm,base_force_x_un\n1,2,3\n",
            "r.csv:1: has the column base_moment_nnm 2 times: must have it once",
        ),
    ] {
        place.write("r.csv", text);
        locate(&["--readings", "r.csv"]).assert_refused(&[said]);
    }
    let rough = Place::with(&SCENE.replace("[grid]", "[contact]\nfriction = 0.3\n[grid]"));
    let rough = rough.run(&words("locate scene.toml --base-moment 1 --base-force-x 1"));
    rough.assert_refused(&["contact.friction = 0.3: must be 0"]);
}
