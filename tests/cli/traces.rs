//! `whiskmap curve`, `branch`, `shape`, `reproduce` and `verify`.

use crate::{Place, Run, SCENE, names};
use whiskmap::model::Side;
use whiskmap::scene::Scene;
use whiskmap::trace::{Branch, curve};

const CURVE: &str = "side,distance_mm,pole_distance_mm,kind,push_angle_deg,push_chord_deg,contact_distance_mm,\
                     arc_length_mm,force_un,base_force_x_un,base_force_y_un,base_moment_nnm,contact_angle_deg,residual";
const BRANCH: &str = "side,stable,push_angle_deg,push_chord_deg,arc_length_mm,contact_angle_deg,force_un,\
                      base_moment_nnm,det,mark";
const SHAPE: &str = "arc_length_mm,x_mm,y_mm,angle_deg,curvature_per_mm,moment_nnm,part";
const CB: [&str; 5] = ["branch", "scene.toml", "--distance", "15.66", "--side=cb"];

fn good(place: &Place, arguments: &[&str]) -> Run {
    let run = place.run(arguments);
    assert_eq!(
        (run.code, &*run.err),
        (Some(0), ""),
        "{arguments:?}: {run:?}"
    );
    run
}

/// The cells of a table below its header, which must be `header`.
fn cells<'a>(text: &'a str, header: &str) -> Vec<Vec<&'a str>> {
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(header));
    lines.map(|line| line.split(',').collect()).collect()
}

/// Every number comes back with its last bit.
#[test]
fn a_curve_is_a_table_of_exact_numbers() {
    let place = Place::with(SCENE);
    let run = good(&place, &["curve", "scene.toml"]);
    let rows = cells(&run.out, CURVE);
    let scene = Scene::parse(SCENE, "scene", "scene").unwrap();
    let whisker = scene.whisker_at(None, None);
    let expected: Vec<_> = Side::BOTH
        .into_iter()
        .flat_map(|side| curve(&whisker, &scene.pole, side, &scene.grid.distance_mm))
        .collect();
    assert_eq!(rows.len(), expected.len());
    for (row, end) in rows.iter().zip(&expected) {
        assert_eq!(row[0], if end.side == Side::Cb { "cb" } else { "cf" });
        assert!(
            ["slip-off", "pull-off", "out-of-reach"].contains(&row[3]),
            "{row:?}"
        );
        let number = |i: usize| (!row[i].is_empty()).then(|| row[i].parse::<f64>().unwrap());
        assert_eq!(number(1), Some(end.distance_mm));
        assert_eq!(number(4), end.push_angle_deg);
        assert_eq!(number(11), end.base_moment_nnm);
        assert_eq!(number(13), end.residual);
        assert_eq!(
            row[3] == "out-of-reach",
            row[4..].iter().all(|cell| cell.is_empty())
        );
    }
}

#[test]
fn tables_and_plots_go_where_they_are_told() {
    let place = Place::with(SCENE);
    let shape = [
        "shape",
        "scene.toml",
        "--distance=15.66",
        "--push-angle=-10",
    ];
    for (arguments, header) in [
        (&["curve", "scene.toml"][..], CURVE),
        (&CB[..], BRANCH),
        (&shape[..], SHAPE),
    ] {
        let streamed = good(&place, arguments).out;
        assert!(streamed.starts_with(header));
        assert_eq!(
            good(&place, &[arguments, &["--csv", "-"]].concat()).out,
            streamed
        );
        let files = ["--csv", "t.csv", "--plot", "p.PNG"];
        let run = good(&place, &[arguments, &files].concat());
        assert_eq!(run.out, "t.csv\np.PNG\n");
        assert_eq!(place.bytes("t.csv"), streamed.as_bytes());
        assert!(place.bytes("p.PNG").starts_with(b"\x89PNG"));
        // A plot alone leaves standard output to its name.
        assert_eq!(
            good(&place, &[arguments, &["--plot", "p.svg"]].concat()).out,
            "p.svg\n"
        );
        let svg = place.bytes("p.svg");
        assert!(svg.starts_with(b"<svg") || svg.starts_with(b"<?xml"));
        good(&place, &[arguments, &["--plot", "p.svg"]].concat());
        assert!(svg == place.bytes("p.svg"), "not deterministic");
    }
    let left = ["p.PNG", "p.svg", "scene.toml", "t.csv"];
    assert_eq!(names(&place.path("")), left);
}

#[test]
fn a_sweep_leads_with_the_whisker() {
    let sweep = format!("{SCENE}taper = [0, 0.3, 1]\ncurvature_per_mm = [0.0, 0.03]\n");
    let place = Place::with(&sweep);
    let run = good(&place, &["curve", "scene.toml"]);
    let rows = cells(&run.out, &format!("taper,curvature_per_mm,{CURVE}"));
    assert_eq!(rows.len(), 6 * 2 * 24);
    let whiskers: Vec<&[&str]> = rows.chunks(48).map(|rows| &rows[0][..2]).collect();
    let expected = [
        ["0.0", "0.0"],
        ["0.3", "0.0"],
        ["1.0", "0.0"],
        ["0.0", "0.03"],
        ["0.3", "0.03"],
        ["1.0", "0.03"],
    ];
    assert_eq!(whiskers, expected);

    let run = good(&place, &["curve", "scene.toml", "--corner"]);
    let rows = cells(
        &run.out,
        "taper,curvature_per_mm,side,distance_mm,push_angle_deg",
    );
    assert_eq!(rows.len(), 12);
    // A perfect cone is never pulled off.
    for row in rows.iter().filter(|row| row[0] == "1.0") {
        assert_eq!(row[3..], ["", ""]);
    }

    place
        .run(&["curve", "scene.toml", "--plot", "p.png"])
        .assert_refused(&["--plot: the scene sweeps 6 whiskers"]);
    for command in ["branch", "shape"] {
        let arguments = [command, "scene.toml", "--distance", "9"];
        let push = ["--push-angle", "1"];
        let arguments = [&arguments[..], if command == "shape" { &push } else { &[] }].concat();
        place
            .run(&arguments)
            .assert_refused(&["grid.taper: the scene sweeps 6 whiskers", command]);
    }
}

#[test]
fn the_corner_of_the_cone() {
    let place = Place::with(SCENE);
    let run = good(&place, &["curve", "scene.toml", "--corner"]);
    let rows = cells(&run.out, "side,distance_mm,push_angle_deg");
    assert_eq!(rows[0], ["cf", "", ""]);
    let distance: f64 = rows[1][1].parse().unwrap();
    assert_eq!(rows[1][0], "cb");
    assert!((distance - 19.09).abs() < 5e-3, "{distance}");
}

#[test]
fn a_branch_has_as_many_points_as_asked_for() {
    let place = Place::with(SCENE);
    let run = good(&place, &[&CB[..], &["--points", "17"]].concat());
    let rows = cells(&run.out, BRANCH);
    assert_eq!(rows.len(), 17);
    let marks: Vec<&str> = rows
        .iter()
        .map(|row| row[9])
        .filter(|mark| !mark.is_empty())
        .collect();
    assert_eq!(marks, ["touch", "fold", "second-fold"]);
    let both = good(&place, &["branch", "scene.toml", "--distance", "15.66"]);
    assert_eq!(cells(&both.out, BRANCH).len(), 400);
}

#[test]
fn a_shape_is_the_state_asked_for() {
    let place = Place::with(SCENE);
    let at = [
        "shape",
        "scene.toml",
        "--distance=15.66",
        "--push-angle=10",
        "--points=11",
    ];
    let stable = good(&place, &at);
    let unstable = good(&place, &[&at[..], &["--branch", "unstable"]].concat());
    let scene = Scene::parse(SCENE, "scene", "scene").unwrap();
    let branch = Branch::new(&scene.whisker, &scene.pole, Side::Cb, 15.66).unwrap();
    for (run, part) in [(stable, true), (unstable, false)] {
        let rows = cells(&run.out, SHAPE);
        assert_eq!(rows.len(), 12);
        let contact = rows.iter().find(|row| row[6] == "contact").unwrap();
        let state = branch.state(10_f64.to_radians(), part).unwrap();
        let arc = branch.read(&state).arc_length_mm;
        assert_eq!(contact[0].parse::<f64>().unwrap(), arc);
        assert_eq!(rows.last().unwrap()[0], "20.0");
    }
}

/// The push angle of the fold, as printed, is a state, whichever way degrees are rounded.
#[test]
fn the_fold_can_be_asked_for() {
    let place = Place::with(SCENE);
    for distance in ["5.5", "8", "11.3", "14.1", "15.66", "17.9"] {
        for side in ["cb", "cf"] {
            let run = good(
                &place,
                &[
                    "branch",
                    "scene.toml",
                    "--distance",
                    distance,
                    "--side",
                    side,
                ],
            );
            let rows = cells(&run.out, BRANCH);
            let fold = rows.iter().find(|row| row[9] == "fold").unwrap();
            for branch in ["stable", "unstable"] {
                let at = [
                    "shape",
                    "scene.toml",
                    "--distance",
                    distance,
                    "--push-angle",
                    fold[2],
                ];
                good(
                    &place,
                    &[&at[..], &["--branch", branch, "--points=2"]].concat(),
                );
            }
        }
    }
    // Unstable states reach across first touch.
    let at = [
        "shape",
        "scene.toml",
        "--distance=15.66",
        "--push-angle",
        "-20",
        "--branch=unstable",
    ];
    let run = good(&place, &[&at[..], &["--side", "cb"]].concat());
    assert!(run.out.starts_with(SHAPE));
    good(
        &place,
        &[
            "shape",
            "scene.toml",
            "--distance=9",
            "--push-angle",
            "-1e-5",
        ],
    );
}

/// What is not a plain file is written to, not replaced.
#[cfg(unix)]
#[test]
fn links_and_devices_stay_what_they_are() {
    let place = Place::with(SCENE);
    let run = good(&place, &["curve", "scene.toml", "--csv", "/dev/null"]);
    assert_eq!(run.out, "/dev/null\n");
    place.write("real.csv", "");
    std::os::unix::fs::symlink("real.csv", place.path("link.csv")).unwrap();
    good(&place, &["curve", "scene.toml", "--csv", "link.csv"]);
    assert!(place.path("link.csv").is_symlink());
    assert!(place.bytes("real.csv").starts_with(CURVE.as_bytes()));
    let full = place.run(&["curve", "scene.toml", "--csv", "/dev/full"]);
    assert_eq!(full.code, Some(1), "{full:?}");
    assert!(
        full.err.contains("cannot write /dev/full: No space left"),
        "{full:?}"
    );
    place
        .run(&["curve", "scene.toml", "--csv", "a.svg", "--plot", "./a.svg"])
        .assert_refused(&["must be two files"]);
}

#[test]
fn states_that_do_not_exist_have_a_reason() {
    let place = Place::with(SCENE);
    let shape = |distance: &str, push: &str, more: &[&str]| {
        let arguments = [
            "shape",
            "scene.toml",
            "--distance",
            distance,
            "--push-angle",
            push,
        ];
        place.run(&[&arguments[..], more].concat())
    };
    shape("15.66", "20", &[]).assert_refused(&["--push-angle 20: slipped off at 15.6094"]);
    shape("19.5", "4", &[]).assert_refused(&["--push-angle 4: pulled off at 2."]);
    shape("19.5", "1", &["--branch=unstable"])
        .assert_refused(&["no unstable state: pulled off at 2."]);
    shape("15.66", "-80", &["--branch=unstable"])
        .assert_refused(&["the unstable states lie between -24.9"]);
    let reach = "out of reach: the tip of the resting whisker is 19.657";
    shape("19.9", "1", &[]).assert_refused(&["--distance 19.9", reach]);
    let branch = ["branch", "scene.toml", "--distance", "19.9"];
    place
        .run(&branch)
        .assert_refused(&["--distance 19.9", reach]);
    assert_eq!(names(&place.path("")), ["scene.toml"]);
}

#[test]
fn wrong_arguments_are_refused_before_any_work() {
    let place = Place::with(SCENE);
    for distance in ["nan", "inf", "0", "0.25", "200.1"] {
        let run = place.run(&["branch", "scene.toml", "--distance", distance]);
        let shown = if distance == "nan" { "NaN" } else { distance };
        run.assert_refused(&[
            &format!("--distance {shown}: must be between 0.02"),
            "and more than 0.25",
        ]);
    }
    let refused = |more: &[&str], parts: &[&str]| {
        for start in [&["curve", "scene.toml"][..], &CB[..]] {
            place.run(&[start, more].concat()).assert_refused(parts);
        }
    };
    refused(
        &["--plot", "p.jpg"],
        &["--plot p.jpg: must end in .png or .svg"],
    );
    refused(
        &["--plot", "nowhere/p.png"],
        &["--plot nowhere/p.png: No such file"],
    );
    refused(
        &["--csv", "nowhere/t.csv"],
        &["--csv nowhere/t.csv: No such file"],
    );
    refused(&["--csv", "."], &["--csv .: is a directory"]);
    refused(
        &["--csv", "t.svg", "--plot", "t.svg"],
        &["must be two files"],
    );
    let push = [
        "shape",
        "scene.toml",
        "--distance",
        "9",
        "--push-angle",
        "1e9",
    ];
    place
        .run(&push)
        .assert_refused(&["--push-angle 1000000000: must be between -360 and 360"]);
    for few in [
        &[&CB[..], &["--points", "2"]].concat(),
        &[&push[..5], &["1", "--points", "1"]].concat(),
    ] {
        let run = place.run(few);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.err.contains("--points"), "{run:?}");
    }
    place.write(
        "broken.toml",
        &SCENE.replace("length_mm = 20", "length_mm = -20"),
    );
    let key = ["whisker.length_mm = -20: must be between"];
    place.run(&["curve", "broken.toml"]).assert_refused(&key);
    place
        .run(&["branch", "broken.toml", "--distance", "9"])
        .assert_refused(&key);
    assert_eq!(names(&place.path("")), ["broken.toml", "scene.toml"]);
}

#[test]
fn figures_come_with_their_tables() {
    let place = Place::with(SCENE);
    let run = good(&place, &["reproduce", "new/folder"]);
    let mut files: Vec<&str> = run
        .out
        .lines()
        .map(|line| line.trim_start_matches("new/folder/"))
        .collect();
    files.sort_unstable();
    assert_eq!(files, names(&place.path("new/folder")));
    for figure in ["fig2", "fig3", "fig4d", "fig5c"] {
        for ending in ["png", "svg"] {
            assert!(files.contains(&&*format!("{figure}.{ending}")), "{files:?}");
        }
        let tables = files
            .iter()
            .filter(|file| file.starts_with(figure) && file.ends_with(".csv"));
        assert!(tables.count() >= 2, "{files:?}");
    }
    place.write("file", "");
    place
        .run(&["reproduce", "file"])
        .assert_refused(&["file: ", "give a folder that can be written"]);
}

#[test]
fn verify_says_pass_for_every_number() {
    let run = good(&Place::with(SCENE), &["verify"]);
    let passes = run
        .out
        .lines()
        .filter(|line| line.ends_with("PASS"))
        .count();
    assert!(passes > 30, "{run:?}");
    assert!(
        run.out
            .ends_with(&format!("{passes} of {passes} checks pass\n")),
        "{run:?}"
    );
}
