//! `whiskmap curve`.

use super::traces::{CURVE, cells};
use super::{Place, SCENE};
use whiskmap::Side;
use whiskmap::scene::Scene;
use whiskmap::trace::curve;

/// Every value of the table has all its bits.
#[test]
fn a_curve_is_a_table_of_exact_numbers() {
    let place = Place::with(SCENE);
    let run = place.quiet(&["curve", "scene.toml"]);
    let rows = cells(&run.out, CURVE);
    let scene = Scene::parse(SCENE, "scene").unwrap();
    let whisker = scene.first_whisker().whisker;
    let expected: Vec<_> = Side::BOTH
        .into_iter()
        .flat_map(|side| curve(&whisker, &scene.pole, side, &scene.grid.distance_mm))
        .collect();
    assert_eq!(rows.len(), expected.len());
    for (row, end) in rows.iter().zip(&expected) {
        assert_eq!(row[0], if end.side == Side::Cb { "cb" } else { "cf" });
        assert!(["slip-off", "pull-off", "out-of-reach"].contains(&row[3]), "{row:?}");
        let number = |i: usize| (!row[i].is_empty()).then(|| row[i].parse::<f64>().unwrap());
        assert_eq!(number(1), Some(end.distance_mm));
        assert_eq!(number(4), end.push_angle_deg);
        assert_eq!(number(12), end.base_moment_nnm);
        assert_eq!(number(14), end.peak_strain);
        assert_eq!(number(17), end.residual);
        assert_eq!(row[3] == "out-of-reach", row[4..].iter().all(|cell| cell.is_empty()));
    }
}

#[test]
fn a_sweep_leads_with_the_whisker() {
    let whiskers = SCENE.replace("tip_radius_um = 1.5\n", "");
    let sweep = format!("{whiskers}taper = [0, 0.3, 1]\ncurvature_per_mm = [0.0, 0.03]\n");
    let place = Place::with(&sweep);
    let run = place.quiet(&["curve", "scene.toml"]);
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

    let run = place.quiet(&["curve", "scene.toml", "--corner"]);
    let rows = cells(&run.out, "taper,curvature_per_mm,side,distance_mm,push_angle_deg,reason");
    assert_eq!(rows.len(), 12);
    // A perfect cone is never pulled off.
    for row in rows.iter().filter(|row| row[0] == "1.0") {
        assert_eq!(row[3..], ["", "", "always-slips-off"]);
    }

    for command in ["branch", "shape"] {
        let arguments = [command, "scene.toml", "--distance", "9"];
        let push = ["--push-angle", "1"];
        let arguments = [&arguments[..], if command == "shape" { &push } else { &[] }].concat();
        place.run(&arguments).assert_refused(&["grid.taper: the scene sweeps 6 whiskers", command]);
    }
}

#[test]
fn a_curve_without_any_end_is_written_and_fails() {
    let place = Place::with(super::map::HINGED);
    let run = place.run(&["curve", "scene.toml", "--csv", "curve.csv"]);
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(run.err.contains("error: all 4 ends are unresolved"), "{run:?}");
    let table = place.text("curve.csv");
    assert_eq!(table.matches(",unresolved,").count(), 4, "{table}");

    place.write("near.toml", &super::map::HINGED.replace("[5, 8]", "[8, 19]"));
    let run = place.run(&["curve", "near.toml"]);
    let warning = "warning: 2 of 4 ends are unresolved: see the column `kind`\n";
    assert_eq!((run.code, &*run.err), (Some(0), warning), "{run:?}");
}

/// The curve of a part of a sweep is the curve of a scene with its values.
#[test]
fn a_part_of_a_sweep_is_selected() {
    let tapers = SCENE.replace("tip_radius_um = 1.5\n", "");
    let place = Place::with(&format!("{tapers}taper = [0, 0.5, 1]\nfriction = [0, 0.2]\n"));
    place.write("one.toml", &SCENE.replace("tip_radius_um = 1.5", "tip_radius_um = 15"));
    let curve = |options: &[&str]| place.run(&[&["curve"], options].concat());
    let one = curve(&["one.toml"]);
    let at = ["--at", "taper=0.6", "--at", "friction=0"];
    let run = curve(&[&["scene.toml"], &at[..]].concat());
    assert_eq!((run.code, &*run.err), (Some(0), "taper = 0.5\nfriction = 0\n"), "{run:?}");
    let rows: Vec<&str> = run.out.lines().skip(1).collect();
    let parts: Vec<_> = rows.iter().map(|row| row.strip_prefix("0.5,0.0,").unwrap()).collect();
    assert_eq!(parts, one.out.lines().skip(1).collect::<Vec<_>>());
    assert_eq!(parts.len(), 48);
    let run = curve(&[&["scene.toml"], &at[..2]].concat());
    assert_eq!(run.out.lines().count(), 1 + 2 * 48);

    let plot = ["scene.toml", "--plot", "plot.svg"];
    let advice = ["--at", "taper=0.5", "--at", "friction=0.2"];
    assert_eq!(curve(&[&plot[..], &advice].concat()).code, Some(0));
    let picture = place.text("plot.svg");
    assert!(picture.contains("A small map, taper = 0.5, friction = 0.2"));
    for (at, said) in [
        (&["taper=2"][..], "--at taper: 2 is more than half a step beyond the axis"),
        (
            &["tapr=0.5"],
            "--at tapr: must be one of the axes, taper, friction; did you mean `taper`?",
        ),
        (&["taper=0", "taper=1"], "--at taper: is given twice"),
    ] {
        let at: Vec<&str> = at.iter().flat_map(|at| ["--at", at]).collect();
        curve(&[&["scene.toml"], &at[..]].concat()).assert_refused(&[said]);
    }
    curve(&["scene.toml", "--exact", "--at", "taper=0.6"])
        .assert_refused(&["0.6 is no value of the axis"]);
    curve(&["one.toml", "--at", "taper=0.6"])
        .assert_refused(&["--at taper: there is no sweep axis"]);
    curve(&["one.toml", "--at", "distance_mm=1.5cm"])
        .assert_refused(&["--at distance_mm=15: selects a whisker of the sweep; --distance 15"]);
}

/// A plot shows the distances that are asked for. Without any in reach it is empty, as a warning says.
#[test]
fn a_plot_has_no_curve_out_of_reach() {
    let place = Place::with(SCENE);
    let plot = ["--plot", "plot.svg", "--csv", "t.csv"];
    let warning = "warning: the picture is empty: the rows of the table have no values for it\n";
    for words in [
        ["curve", "scene.toml", "--distance", "30"],
        ["sensitivity", "scene.toml", "--distance", "30"],
    ] {
        let run = place.run(&[&words[..], &plot].concat());
        assert_eq!((run.code, &*run.err), (Some(0), warning), "{run:?}");
        assert!(place.text("t.csv").contains("out-of-reach"));
        assert!(!place.text("plot.svg").contains("slip-off"));
    }
    place.quiet(&["curve", "scene.toml", "--distance", "15,30", "--plot", "plot.svg"]);
    assert!(place.text("plot.svg").contains("slip-off"));
    let run = place.run(&["curve", "scene.toml", "--corner", "--distance", "15"]);
    run.assert_refused(&["--corner", "--distance"]);
}

/// Few whiskers have a colour and a name each. Of many, five are named, and neighbours have similar colours.
#[test]
fn a_plot_shows_all_whiskers() {
    let tapers = SCENE.replace("tip_radius_um = 1.5\n", "");
    let (few, many) = ("[0, 0.1, 0.2, 0.4, 0.6, 0.8, 1]", "{ from = 0, to = 1, count = 16 }");
    for (axis, names, count) in [
        (few, &["0", "0.1", "0.2", "0.4", "0.6", "0.8", "1"][..], 7),
        (many, &["0", "0.2667", "0.5333", "0.7333", "1"], 16),
    ] {
        let place = Place::with(&format!("{tapers}taper = {axis}\nfriction = [0, 0.2]\n"));
        place.quiet(&["curve", "scene.toml", "--plot", "plot.svg"]);
        let picture = place.text("plot.svg");
        let named = picture.matches(">taper = ").count();
        assert_eq!(named, names.len());
        for name in names {
            assert!(picture.contains(&format!(">taper = {name}<")), "{name}");
        }
        assert!(picture.contains(">pull-off<"));
        let colours = picture.split("stroke=\"#").skip(1).map(|rest| &rest[..6]);
        let colours: std::collections::BTreeSet<&str> = colours.collect();
        // The frame is black, the line between the regions grey.
        assert_eq!(colours.len(), count + 2, "{colours:?}");
    }
    let place = Place::with(&format!(
        "{tapers}taper = {{ from = 0, to = 1, count = 1001 }}\nfriction = [0, 0.2]\n"
    ));
    place
        .run(&["curve", "scene.toml", "--plot", "plot.svg"])
        .assert_refused(&[
            "--plot: the scene sweeps 2002 whiskers over grid.taper, grid.friction; a plot shows at most 2000: \
             choose some, such as by --at taper=0.5 --at friction=0.2",
        ]);
}
