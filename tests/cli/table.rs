//! Tables of whiskers in commands and files.

use super::{Place, names, words};
use whiskmap::scene::Scene;
use whiskmap::store::StoredMap;

const PAD: &str = r#"title = "A pad"
[whisker]
youngs_modulus_gpa = 3.0
[whiskers]
table = "pad.csv"
[grid]
push_angle_deg = { from = -60, to = 60, count = 13 }
distance_mm = [5, 10]
"#;

const ROWS: &str =
    "name,length_mm,base_radius_um,tip_radius_um\nC1,20,30,1.5\nC2,18,28,\nC3,16,26,2\n";

fn place() -> Place {
    let place = Place::with(PAD);
    place.write("pad.csv", ROWS);
    place
}

const REFUSED: &str = "whiskers.table: 1 of 3 rows have no whisker: C2 (tip_radius_um is missing)";

#[test]
fn maps_name_their_whiskers() {
    let place = place();
    let run = place.map(&["scene.toml", "-o", "."]);
    assert!(run.err.contains(&format!("warning: {REFUSED}")), "{run:?}");
    assert!(!run.err.contains("are unresolved"), "{run:?}");
    place.map(&["scene.toml", "-o", ".", "--format", "zarr"]);
    let map = StoredMap::open(&place.path("scene.exr")).unwrap();
    assert_eq!(map.grid.sweep[0].variable.names(), ["C1", "C2", "C3"]);
    for source in ["scene.exr", "scene.zarr", "scene.toml"] {
        let run = place.run(&[
            "extract",
            source,
            "--at",
            "whisker=C3",
            "--at",
            "distance_mm=5",
            "-o",
            "-",
        ]);
        assert_eq!(run.code, Some(2), "{run:?}");
        let part =
            ["extract", source, "--at", "whisker=C3", "--at", "distance_mm=5", "-o", "c3.csv"];
        let run = place.good(&part);
        assert!(run.err.contains("whisker = C3"), "{run:?}");
        assert!(!run.err.contains("are unresolved"), "{run:?}");
        let table = place.text("c3.csv");
        let mut lines = table.lines();
        assert!(lines.next().unwrap().starts_with("whisker,distance_mm,push_angle_deg,regime,"));
        assert_eq!(lines.filter(|line| line.starts_with("C3,5.0,")).count(), 13);
        let none = place.run(&["extract", source, "--at", "whisker=c3", "-o", "none.csv"]);
        assert_eq!(none.code, Some(2));
        assert!(none.err.contains("there is no whisker c3; must be one of C1, "), "{none:?}");
    }
    place.good(&words("extract scene.exr --at whisker=C3 -o c3.zarr"));
    let coordinate = place.text("c3.zarr/whisker/c.0");
    assert_eq!(coordinate, "\u{1}\0\0\0\u{2}\0\0\0C3");
    place.good(&words("compare scene.exr scene.zarr --within regime=0,force_un=0"));
    for source in ["scene.toml", "scene.zarr"] {
        let run = place.good(&["render", source, "-o", "pad.svg"]);
        assert!(!run.err.contains("are unresolved"), "{run:?}");
    }
    let picture = place.text("pad.svg");
    assert!(picture.contains(">C2<") && picture.contains("whisker"));
}

#[test]
fn curves_have_the_reason_of_a_row_without_a_whisker() {
    let place = place();
    let run = place.good(&["curve", "scene.toml"]);
    let lines: Vec<&str> = run.out.lines().collect();
    assert!(lines[0].starts_with("whisker,no_whisker,side,distance_mm,pole_distance_mm,kind,"));
    assert_eq!(lines.len(), 1 + 3 * 2 * 2);
    let empty = "C2,tip_radius_um is missing,cf,5.0,,no-whisker,,,,,,,,,,,,,,,,";
    assert_eq!(lines[5], empty);
    let one = place.run(&["curve", "scene.toml", "--at", "whisker=C3"]);
    assert_eq!(one.out.lines().skip(1).collect::<Vec<_>>(), lines[9..]);
    let text = Scene::read(place.path("scene.toml")).unwrap().of_whisker(2).unwrap();
    place.write("alone.toml", &text.to_toml());
    for command in [&["branch", "--distance", "10"][..], &["sensitivity"]] {
        let run = |file: &[&str]| place.run(&[command, file].concat());
        let (selected, alone) = (run(&["scene.toml", "--at", "whisker=C3"]), run(&["alone.toml"]));
        assert_eq!((selected.code, &selected.out), (Some(0), &alone.out));
    }
    let corner = place.run(&["curve", "scene.toml", "--corner"]);
    assert!(corner.out.contains("C2,tip_radius_um is missing,cf,,,no-whisker"), "{corner:?}");
    let derivatives = place.good(&["curve", "scene.toml", "--derivatives=taper"]);
    assert!(derivatives.out.lines().nth(1).unwrap().ends_with(|c: char| c.is_ascii_digit()));
}

#[test]
fn a_picture_has_no_regime_for_a_row_without_a_whisker() {
    let place = place();
    place.good(&["render", "scene.toml", "-o", "map.svg"]);
    let picture = place.text("map.svg");
    let shown = |name: &str| picture.contains(&format!(">{name}<"));
    let found = ["C2", "contact", "no whisker", "unresolved"].map(shown);
    assert_eq!(found, [true, true, true, false]);
}

#[test]
fn a_plot_names_the_whiskers() {
    let place = place();
    place.good(&["curve", "scene.toml", "--plot", "curve.svg"]);
    let picture = place.text("curve.svg");
    let shown = ["C1", "C2", "C3"].map(|name| picture.contains(&format!(">{name}<")));
    assert_eq!(shown, [true, false, true]);
    assert!(picture.contains(">A pad (1 of 3 rows have no whisker)<"));
    // Only rows with a whisker share the names of the legend.
    let row = |i: usize| format!("W{i},{},30,{}\n", 20 + i, if i < 10 { "" } else { "1.5" });
    let rows: String = (0..18).map(row).collect();
    let header = "name,length_mm,base_radius_um,tip_radius_um\n";
    place.write("pad.csv", &format!("{header}{rows}"));
    place.run(&["curve", "scene.toml", "--plot", "curve.svg"]);
    let picture = place.text("curve.svg");
    let shown = (0..18).filter(|i| picture.contains(&format!(">W{i}<")));
    assert_eq!(shown.collect::<Vec<_>>(), [10, 12, 14, 15, 17]);
}

/// A column has the name of its parameter or of its sweep axis. An unknown name that is meant as a known one is refused.
#[test]
fn columns_share_the_names_of_axes() {
    let place = place();
    let curve = |header: &str, row: &str| {
        place.write("pad.csv", &format!("{header}\n{row}\n"));
        place.run(&["curve", "scene.toml"])
    };
    let numbers = "name,length_mm,base_radius_um,tip_radius_um";
    let [parabola, axis, straight] =
        [(",parabola_per_mm", ",0.02"), (",curvature_per_mm", ",0.02"), (",notes", ",0.02")].map(
            |(column, cell)| curve(&format!("{numbers}{column}"), &format!("C1,20,30,1.5{cell}")),
        );
    assert_eq!((axis.code, &axis.out), (Some(0), &parabola.out), "{axis:?}");
    assert!(straight.err.starts_with("note: "), "{straight:?}");
    assert_ne!(axis.out, straight.out);
    let whole = PAD.replace(
        "[whiskers]",
        "length_mm = 20\nbase_radius_um = 30\ntip_radius_um = 1.5\n[whiskers]",
    );
    place.write("scene.toml", &whole);
    let said = "pad.csv:1: has the column length_um; values must be in mm: convert them, and use the name `length_mm`";
    curve("name,length_um", "C1,5").assert_refused(&[said]);
    let run = curve("name,length_sd_mm", "C1,5");
    assert_eq!(run.code, Some(0), "{run:?}");
    assert!(run.err.contains("columns that are not used"), "{run:?}");
}

/// An axis would replace the numbers of a column, or leave the tip of a row where its taper does not put it.
#[test]
fn axes_of_columns_are_refused() {
    for (column, axis, said) in [
        (
            "base_radius_um",
            "base_radius_um = [20, 40]",
            "grid.base_radius_um: must be left out: whiskers.table has the column base_radius_um",
        ),
        (
            "taper",
            "base_radius_um = [20, 40]",
            "grid.base_radius_um: must be left out: whiskers.table has the column taper",
        ),
        (
            "tip_radius_um",
            "taper = [0.5, 0.9]",
            "grid.taper: must be left out: whiskers.table has the column tip_radius_um",
        ),
    ] {
        let scene = PAD.replace(
            "youngs_modulus_gpa = 3.0",
            "youngs_modulus_gpa = 3.0\nlength_mm = 20\nbase_radius_um = 30\ntip_radius_um = 1",
        );
        let place = Place::with(&format!("{scene}{axis}\n"));
        place.write("pad.csv", &format!("name,{column}\nC1,0.9\n"));
        place.run(&["curve", "scene.toml"]).assert_refused(&[said]);
    }
}

#[test]
fn wrong_uses_of_tables_are_refused() {
    let place = place();
    for (arguments, said) in [
        (&["map", "scene.toml", "--strict"][..], format!("--strict: {REFUSED}")),
        (&["curve", "scene.toml", "--strict"], format!("--strict: {REFUSED}")),
        (
            &["curve", "scene.toml", "--at", "whisker=C2"],
            "--at whisker: C2: tip_radius_um is missing".to_owned(),
        ),
        (
            &["curve", "scene.toml", "--samples", "20"],
            "whiskers.table: the scene sweeps 3 whiskers, but curve --samples needs one; select it by --at whisker=VALUE".to_owned(),
        ),
        (
            &["branch", "scene.toml", "--distance", "10"],
            "whiskers.table: the scene sweeps 3 whiskers, but branch needs one; select it by --at whisker=VALUE".to_owned(),
        ),
    ] {
        let run = place.run(arguments);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.err.contains(&said), "{run:?}");
    }
    for (rows, said) in [
        ("length_mm\n20\n", "pad.csv:1: found length_mm; needed name"),
        (
            "name,length_mm\nC1,long\n",
            "pad.csv:2: length_mm = long: must be a number, or empty where it is missing",
        ),
        ("name,length_mm\nC1,20\n,21\n", "line 3: the name of the whisker is missing"),
        ("name,size_mm,remark\nC1,2,good\n", "row 1: whisker.length_mm: is left out; "),
        (
            "name,size_mm,remark\nC1,2,good\n",
            "pad.csv:1: columns that are not used: size_mm, remark",
        ),
        ("name,profile\nC1,no.csv\n", "line 2: profile: no.csv: cannot be read"),
        (
            "name,length_mm\nC1,20\nC1,21\n",
            "line 3: the name of a whisker must be unlike those before it; row 1 is C1 too",
        ),
    ] {
        place.write("pad.csv", rows);
        let run = place.run(&["curve", "scene.toml"]);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.err.contains(said), "{run:?}");
    }
    assert_eq!(names(&place.path("")), ["pad.csv", "scene.toml"]);
}
