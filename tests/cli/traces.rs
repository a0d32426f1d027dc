//! Common behaviour of `whiskmap curve`, `branch` and `shape`: tables, plots, refused input.

use super::{Place, SCENE, names, no_folder, words};

pub const CURVE: &str = "side,distance_mm,pole_distance_mm,kind,push_angle_deg,push_chord_deg,contact_distance_mm,\
                     arc_length_mm,force_un,contact_force_un,base_force_x_un,base_force_y_un,base_moment_nnm,energy_nj,peak_strain,\
                     peak_strain_mm,contact_angle_deg,residual,sliding,snaps_deg";
pub const BRANCH: &str = "distance_mm,side,stable,push_angle_deg,push_chord_deg,arc_length_mm,contact_angle_deg,force_un,\
                      contact_force_un,base_force_x_un,base_force_y_un,base_moment_nnm,energy_nj,peak_strain,peak_strain_mm,det,\
                      mark,sliding,snaps_deg";
pub const SHAPE: &str = "arc_length_mm,x_mm,y_mm,angle_deg,curvature_per_mm,moment_nnm,strain,part";
pub const SPREAD: &str = "side,distance_mm,kind,push_angle_deg,slip_off,pull_off,out_of_reach,unresolved,p5_deg,p25_deg,\
                      p50_deg,p75_deg,p95_deg,mean_deg,sd_deg,sd_first_order_deg,\
                      force_un,force_p5_un,force_p25_un,force_p50_un,force_p75_un,force_p95_un,force_mean_un,force_sd_un,\
                      base_moment_nnm,base_moment_p5_nnm,base_moment_p25_nnm,base_moment_p50_nnm,base_moment_p75_nnm,base_moment_p95_nnm,base_moment_mean_nnm,base_moment_sd_nnm";
pub const CB: [&str; 5] = ["branch", "scene.toml", "--distance", "15.66", "--side=cb"];

/// Returns the cells of a table, whose header must be `header`.
pub fn cells<'a>(text: &'a str, header: &str) -> Vec<Vec<&'a str>> {
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(header));
    lines.map(|line| line.split(',').collect()).collect()
}

#[test]
fn tables_and_plots_are_written_to_the_given_files() {
    let place = Place::with(SCENE);
    let shape = words("shape scene.toml --distance=15.66 --push-angle=-10");
    for (arguments, header) in
        [(&["curve", "scene.toml"][..], CURVE), (&CB[..], BRANCH), (&shape[..], SHAPE)]
    {
        let streamed = place.quiet(arguments).out;
        assert!(streamed.starts_with(header));
        assert_eq!(place.quiet(&[arguments, &["--csv", "-"]].concat()).out, streamed);
        let files = ["--csv", "t.csv", "--plot", "p.PNG"];
        let run = place.quiet(&[arguments, &files].concat());
        assert_eq!(run.out, "t.csv\np.PNG\n");
        assert_eq!(place.bytes("t.csv"), streamed.as_bytes());
        assert!(place.bytes("p.PNG").starts_with(b"\x89PNG"));
        // With only a plot, standard output has its name.
        assert_eq!(place.quiet(&[arguments, &["--plot", "p.svg"]].concat()).out, "p.svg\n");
        let svg = place.bytes("p.svg");
        assert!(svg.starts_with(b"<svg") || svg.starts_with(b"<?xml"));
        place.quiet(&[arguments, &["--plot", "p.svg"]].concat());
        assert!(svg == place.bytes("p.svg"), "not deterministic");
    }
    let left = ["p.PNG", "p.svg", "scene.toml", "t.csv"];
    assert_eq!(names(&place.path("")), left);
}

/// `--help` defines every column of every table in order, and no other column.
#[test]
fn help_defines_the_columns() {
    let place = Place::with(SCENE);
    let corner = "side,distance_mm,push_angle_deg,reason";
    for (command, tables) in [
        ("curve", &[CURVE, corner, super::data::POINTS, SPREAD][..]),
        ("branch", &[BRANCH]),
        ("shape", &[SHAPE]),
    ] {
        let help = place.quiet(&[command, "--help"]).out;
        let defined: Vec<String> = help
            .split("\nColumns")
            .skip(1)
            .map(|table| {
                let lines = table.lines().skip(1).take_while(|line| line.starts_with("  "));
                let names = lines.map(|line| {
                    let (name, meaning) = line.trim().split_once(' ').unwrap();
                    assert!(meaning.trim().len() > 10 && line.len() <= 100, "{line}");
                    name
                });
                names.collect::<Vec<_>>().join(",")
            })
            .collect();
        assert_eq!(defined, tables, "{help}");
    }
    let short = place.quiet(&["curve", "-h"]).out;
    assert!(!short.contains("Columns"), "{short}");
}

#[test]
fn wrong_arguments_are_refused_before_any_work() {
    let place = Place::with(SCENE);
    let branch = |distance| place.run(&["branch", "scene.toml", "--distance", distance]);
    for distance in ["0", "0.25", "200.1"] {
        branch(distance).assert_refused(&[
            &format!("--distance {distance} mm: must be between 0.02 mm"),
            "and more than 0.25",
        ]);
    }
    for distance in ["nan", "inf", "far"] {
        branch(distance).assert_refused(&["'--distance <LENGTH>'", "must be a length, such as"]);
    }
    place
        .run(&["curve", "scene.toml", "--distance", "2000"])
        .assert_refused(&["--distance 2000 mm: must be between 0.02 mm"]);
    let refused = |more: &[&str], parts: &[&str]| {
        for start in [&["curve", "scene.toml"][..], &CB[..]] {
            place.run(&[start, more].concat()).assert_refused(parts);
        }
    };
    refused(&["--plot", "p.jpg"], &["--plot p.jpg: must end in .png, .svg or .pdf"]);
    refused(&["--plot", "nowhere/p.png"], &[&format!("--plot nowhere/p.png: {}", no_folder())]);
    refused(&["--csv", "nowhere/t.csv"], &[&format!("--csv nowhere/t.csv: {}", no_folder())]);
    refused(&["--csv", "."], &["--csv .: is a directory"]);
    refused(&["--csv", "t.svg", "--plot", "t.svg"], &["must be two files"]);
    let push = words("shape scene.toml --distance 9 --push-angle 1e9");
    place
        .run(&push)
        .assert_refused(&["--push-angle 1000000000 deg: must be between -360 deg and 360 deg"]);
    for few in
        [&[&CB[..], &["--points", "2"]].concat(), &[&push[..5], &["1", "--points", "1"]].concat()]
    {
        let run = place.run(few);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.err.contains("--points"), "{run:?}");
    }
    place.write("broken.toml", &SCENE.replace("length_mm = 20", "length_mm = -20"));
    let key = ["whisker.length_mm = -20: must be between"];
    place.run(&["curve", "broken.toml"]).assert_refused(&key);
    place.run(&["branch", "broken.toml", "--distance", "9"]).assert_refused(&key);
    assert_eq!(names(&place.path("")), ["broken.toml", "scene.toml"]);
}
