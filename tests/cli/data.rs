//! `whiskmap curve --data`: measured points beside the curve.

use super::traces::cells;
use super::{Place, Run, SCENE};

pub const POINTS: &str = "line,side,distance_mm,measured_deg,sd_deg,kind,predicted_deg,predicted_kind,residual_deg,reason";

/// Points of a whisker whose tip is 2 um thick.
pub const DATA: &str = "# made up\nkind,side,distance_mm,push_angle_deg\n\
                    slip-off,cf,10,-49.2\nslip-off,cf,15,-29.1\nslip-off,cb,10,40.1\n,cb,15,18.9\npull-off,cb,19.3,4.3\n\
                    slip-off,cb,15,18.4\n";

pub fn place() -> Place {
    let place = Place::with(SCENE);
    place.write("points.csv", DATA);
    place
}

/// Runs `curve --data` with `more` options.
pub fn curve(place: &Place, more: &[&str]) -> Run {
    let arguments = ["curve", "scene.toml", "--data", "points.csv"];
    place.run(&[&arguments, more].concat())
}

#[test]
fn points_beside_the_curve() {
    let place = place();
    let run = curve(&place, &["--csv", "-", "--plot", "p.svg"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    let rows = cells(&run.out, POINTS);
    let firsts: Vec<&str> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(firsts, ["3", "4", "5", "6", "7", "8"]);
    for row in &rows {
        let number = |i: usize| row[i].parse::<f64>().unwrap();
        assert_eq!(number(8), number(3) - number(6));
        assert!(["slip-off", "pull-off"].contains(&row[7]), "{row:?}");
    }
    assert_eq!(rows[3][..6], ["6", "cb", "15.0", "18.9", "", ""]);
    assert_eq!(rows[4][5..8].first(), Some(&"pull-off"));
    let said = [
        "points compared: 6, 0 left out, 0 of another kind than predicted\n",
        "\nRMS: ",
        "\nbias: ",
    ];
    for part in said {
        assert!(run.err.contains(part), "{run:?}");
    }
    let svg = place.text("p.svg");
    for name in ["measured slip-off", "measured pull-off", "measured"] {
        assert!(svg.contains(&format!(">{name}<")), "{name}");
    }

    // Chord angles are compared with the curve of chord angles.
    place.write("points.csv", "side,distance_mm,push_chord_deg\ncb,15.66,15.14\n");
    let run = curve(&place, &["--csv", "t.csv", "--plot", "p.svg"]);
    assert_eq!(run.out, "t.csv\np.svg\n");
    let svg = place.text("p.svg");
    assert!(svg.contains("chord angle at detachment (deg)"));
    let table = place.text("t.csv");
    let residual: f64 = cells(&table, POINTS)[0][8].parse().unwrap();
    assert!(residual.abs() < 0.01, "{residual}");
}

/// The grid ends at 15 mm, and a point is at 19.3 mm.
#[test]
fn the_curve_reaches_points_beyond_the_grid() {
    let place = place();
    let short = SCENE.replace("from = 2, to = 20", "from = 9, to = 15");
    assert_ne!(short, SCENE);
    place.write("scene.toml", &short);
    assert_eq!(curve(&place, &["--plot", "p.svg"]).code, Some(0));
    let svg = place.text("p.svg");
    let lines = svg
        .lines()
        .filter(|line| line.starts_with("<polyline") && line.contains("stroke-width=\"3\""));
    let places = lines.flat_map(|line| line.split('"').nth(1).unwrap().split(' '));
    let heights = places.map(|place| place.split_once(',').unwrap().1);
    let heights = heights.map(|y| y.parse::<f64>().unwrap());
    // The legend is above 150.
    let highest = heights.filter(|y| *y > 150.0).fold(f64::INFINITY, f64::min);
    let point = format!("cy=\"{highest}\" r=\"8\" fill=\"#1c6cc4\"");
    assert!(svg.contains(&point), "{point}: {svg}");
}

#[test]
fn points_that_never_detach() {
    let place = Place::with(super::map::HINGED);
    place.write("points.csv", "side,distance_mm,push_angle_deg\ncb,8,40\ncb,19,5\n");
    let run = curve(&place, &[]);
    assert_eq!(run.code, Some(0), "{run:?}");
    let named = "warning: points.csv:2: left out: by theory this side never detaches at 8 mm\n\
                 points compared: 1, 1 left out, 0 of another kind than predicted\n";
    assert!(run.err.starts_with(named), "{run:?}");
    assert_eq!(cells(&run.out, POINTS)[0][4..], ["", "", "", "unresolved", "", "no-detachment"]);
    place.write("points.csv", "side,distance_mm,push_angle_deg\ncb,8,40\n");
    let run = curve(&place, &[]);
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(
        run.err.contains("error: all 1 points are unresolved: see the column `predicted_kind`"),
        "{run:?}"
    );
}

/// In an elastic follicle, the base that a film shows is not the axis that angles belong to: commands with measured angles say so.
#[test]
fn a_follicle_has_a_note_on_measured_angles() {
    let place = Place::with(SCENE);
    let soft = format!("{SCENE}[whisker.follicle]\nstiffness_nnm_per_rad = 5000\n");
    place.write("soft.toml", &soft);
    place.write("points.csv", "side,distance_mm,push_angle_deg\ncb,10,30\n");
    place.write("course.csv", "time_s,angle_deg\n0,0\n1,3\n");
    let note =
        "note: whisker.follicle: angles are those of the follicle's axis; a film shows those of";
    for (scene, is_soft) in [("scene.toml", false), ("soft.toml", true)] {
        for words in [
            &["curve", scene, "--data", "points.csv"][..],
            &["whisk", scene, "--distance", "15", "--angles", "course.csv"],
            &["fit", scene, "--data", "points.csv", "--free", "tip_radius_um"],
        ] {
            let run = place.run(words);
            assert_eq!(run.err.contains(note), is_soft, "{run:?}");
        }
    }
}
