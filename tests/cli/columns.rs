//! `--columns`: own names of columns, in all commands that read tables.

use super::{Place, SCENE, words};

/// Every command with a table: the option of the table, its header and a row, and the own names with a header to match.
const TABLES: [(&[&str], &str, &str, &str, &str); 5] = [
    (
        &["curve", "scene.toml", "--data"],
        "side,distance_mm,push_angle_deg",
        "cb,15.66,15.6",
        "push=angle,distance=d",
        "side,d,angle",
    ),
    (
        &["fit", "scene.toml", "--free", "tip_radius_um", "--data"],
        "side,distance_mm,push_angle_deg",
        "cb,15.66,15.6",
        "push_angle_deg=angle",
        "side,distance_mm,angle",
    ),
    (
        &["whisk", "scene.toml", "--distance", "15", "--angles"],
        "time_s,angle_deg",
        "0,0\n1,3",
        "angle=Base,time=t",
        "t,Base",
    ),
    (
        &["force", "scene.toml", "--model", "--frames"],
        "time_s,curvature_per_mm,at_arc_length_mm,contact_x_mm,contact_y_mm",
        "0,0.03,3,,",
        "curvature_per_mm=kappa,time=t",
        "t,kappa,at_arc_length_mm,contact_x_mm,contact_y_mm",
    ),
    (
        &["locate", "scene.toml", "--readings"],
        "base_moment_nnm,base_force_y_un",
        "60,6",
        "base_moment=Mz,base_force_y=Fy",
        "Mz,Fy",
    ),
];

/// A column that is not used is named once.
#[test]
fn own_names_of_columns_are_the_expected_ones() {
    let place = Place::with(SCENE);
    for (command, header, row, names, renamed) in TABLES {
        let row = row.replace('\n', ",\n");
        place.write("table.csv", &format!("{header},day\n{row},Monday\n"));
        let expected = place.good(&[command, &["table.csv"]].concat());
        let note = "note: table.csv:1: columns that are not used: day\n";
        assert_eq!(expected.err.matches(note).count(), 1, "{expected:?}");
        place.write("table.csv", &format!("{renamed},day\n{row},Monday\n"));
        let found = place.run(&[command, &["table.csv", "--columns", names]].concat());
        assert_eq!((found.code, &found.out), (Some(0), &expected.out), "{found:?}");
    }
}

#[test]
fn names_of_columns_that_do_not_fit_are_refused() {
    let place = Place::with(SCENE);
    place.write("table.csv", "side,d,angle,angle,push_chord_deg\ncb,15.66,15.6,1,2\n");
    let curve = ["curve", "scene.toml", "--data", "table.csv", "--columns"];
    for (names, said) in [
        (
            "distanze=d",
            "table.csv:1: columns distanze=d: `distanze` is not known; must be one of side, distance_mm, push_angle_deg, \
             push_chord_deg, kind, sd_deg, whisker; did you mean `distance_mm`?",
        ),
        (
            "distance=e",
            "columns distance=e: `e` is no column of the file; found side, d, angle, angle, push_chord_deg",
        ),
        (
            "push=angle",
            "columns push=angle: `angle` must be one column of the file, and is several",
        ),
        ("distance=d,distance_mm=side", "columns distance_mm=side: `distance_mm` is given twice"),
        ("distance=d,kind=d", "columns kind=d: `d` is given twice"),
        (
            "push_chord_deg=d",
            "columns push_chord_deg=d: the file has a column `push_chord_deg`, too; leave one of both out",
        ),
        (
            "distance",
            "must be NAME=COLUMN, the name that the command expects and the column of the file, such as distance_mm=d",
        ),
        ("=d", "must be NAME=COLUMN, the name that the command expects"),
    ] {
        place.run(&[&curve[..], &[names]].concat()).assert_refused(&[said]);
    }
}

#[test]
fn a_table_that_lacks_columns_names_the_option() {
    let place = Place::with(SCENE);
    for (command, _, row, _, renamed) in TABLES {
        place.write("table.csv", &format!("{renamed}\n{row}\n"));
        let run = place.run(&[command, &["table.csv"]].concat());
        run.assert_refused(&["error: table.csv:", "; --columns NAME=COLUMN takes own names"]);
    }
    place.write("table.csv", "side,distance_mm,push_angle_deg\nup,15.66,15.6\n");
    let run = place.run(&words("fit scene.toml --data table.csv --free taper"));
    assert!(run.code == Some(2) && !run.err.contains("--columns"), "{run:?}");
}

/// A column that is most likely meant as one of the table is not left out.
#[test]
fn columns_with_nearly_right_names_are_refused() {
    let place = Place::with(SCENE);
    for (header, row, said) in [
        ("SD_deg", "1", "has the column SD_deg; did you mean `sd_deg`?"),
        (
            "sd_rad",
            "1",
            "has the column sd_rad; values must be in deg: convert them, and use the name `sd_deg`",
        ),
        ("Kind", "slip-off", "has the column Kind; did you mean `kind`?"),
    ] {
        place.write(
            "table.csv",
            &format!("side,distance_mm,push_angle_deg,{header}\ncb,15.66,15.6,{row}\n"),
        );
        let run = place.run(&["curve", "scene.toml", "--data", "table.csv"]);
        run.assert_refused(&[&format!("table.csv:1: {said}")]);
    }
    place.write("table.csv", "base_moment_nnm,base_force_y_un,base_force_x_mn\n60,5,1\n");
    let said = "has the column base_force_x_mn; values must be in uN: convert them, and use the name `base_force_x_un`";
    place.run(&["locate", "scene.toml", "--readings", "table.csv"]).assert_refused(&[said]);
    let scene = SCENE.replace("[grid]", "[whiskers]\ntable = \"table.csv\"\n[grid]");
    let place = Place::with(&scene);
    place.write("table.csv", "name,base_diameter_um\nA,80\n");
    let said = "has the column base_diameter_um; values must be radii in um, half the diameters: convert them, and use the name `base_radius_um`";
    place.run(&["curve", "scene.toml"]).assert_refused(&[said]);
}

/// Without a table there are no columns, whatever else the command has.
#[test]
fn names_of_columns_need_a_table() {
    let place = Place::with(SCENE);
    let commands: [(&[&str], &str); 6] = [
        (&["curve", "scene.toml"], "<--data <FILE>>"),
        (&["fit", "scene.toml", "--free", "length_mm"], "--data <FILE>"),
        (&["explore", "scene.toml"], "<--data <FILE>>"),
        (&["texture", "scene.toml", "--sine", "1deg,1,1"], "<--angles <FILE>>"),
        (&["locate", "scene.toml", "--base-moment", "60nNm"], "<--readings <FILE>>"),
        (&["reproduce", "figures"], "<--fig4d <FILE>|--fig5c-left <FILE>|--fig5c-right <FILE>>"),
    ];
    for (command, options) in commands {
        let said = place.run(&[command, &["--columns", "distance=d"]].concat());
        said.assert_refused(&["required arguments were not provided", options]);
    }
    assert!(!place.path("figures").exists());
}

/// The values of a column keep their unit, so one with another unit in its name is refused.
#[test]
fn columns_in_other_units_are_refused() {
    let place = Place::with(SCENE);
    place.write("rad.csv", "time_ms,angle_rad\n0,0\n1,0.3\n");
    let whisk = ["whisk", "scene.toml", "--distance", "15", "--angles", "rad.csv", "--columns"];
    for (columns, said) in [
        ("angle=angle_rad", "columns angle=angle_rad: the column is in rad; values must be in deg"),
        ("time=time_ms", "columns time=time_ms: the column is in ms; values must be in s"),
    ] {
        place.run(&[&whisk[..], &[columns]].concat()).assert_refused(&[said]);
    }
}
