//! `whiskmap reproduce` and `whiskmap verify`.

use super::{Place, SCENE, names, words};
use std::path::Path;

#[test]
fn figures_come_with_their_tables() {
    let place = Place::with(SCENE);
    let run = place.quiet(&["reproduce", "new/folder"]);
    let mut files: Vec<&str> = run
        .out
        .lines()
        .map(|line| Path::new(line).strip_prefix("new/folder").unwrap())
        .map(|name| name.to_str().unwrap())
        .collect();
    files.sort_unstable();
    assert_eq!(files, names(&place.path("new/folder")));
    let pictures = words("fig1 fig2 fig3 fig4b fig4d fig5b fig5c fig6 fig7b");
    let files_of = |figure| ["pdf", "png", "svg"].map(|ending| format!("{figure}.{ending}"));
    let mut expected: Vec<String> = pictures.into_iter().flat_map(files_of).collect();
    let branch = |shown: &str| format!("distance_mm,side,stable,push_angle_deg,{shown},mark");
    let shape = "arc_length_mm,x_mm,y_mm,angle_deg,curvature_per_mm,moment_nnm,strain,part";
    let frame = "time_s,angle_deg,regime,x_mm,y_mm";
    let (swept, tip) = ("time_s,angle_deg,phase,x_mm,y_mm", "tip_from_mm,tip_to_mm,tip_time_s");
    let trial = "time_s,angle_deg,curvature_per_mm,force_un,lever_force_un,model_force_un";
    let (section, sketch) = ("arc_length_mm,x_mm,y_mm,radius_um", "whisker,x_mm,y_mm");
    let solution = format!("solution,push_angle_deg,{shape}");
    let ends = "whisker,side,kind,push_angle_deg,distance_mm,contact_distance_mm";
    let samples = whiskmap::texture::TextureSample::COLUMNS.iter();
    let samples = samples.map(|(name, _)| *name).collect::<Vec<_>>().join(",");
    for (tables, header) in [
        (&["1a", "3a", "3f"][..], section),
        (&["1b"], shape),
        (&["1c", "1d"], sketch),
        (&["2a", "2b", "2c", "2d"], &solution),
        (&["3b", "3g"], &branch("theta_obj_deg")),
        (&["3c", "3h"], &branch("force_un")),
        (&["3d", "3i"], &branch("s_obj_mm")),
        (&["3e", "3j", "4d", "5c_left", "5c_right"], ends),
        (&["4b", "4c", "5b"], frame),
        (&words("6b_free 6b_330um 6b_1500um 6b_4500um 6e_free 6e_2000um"), swept),
        (&["6e_330um", "6e_3300um"], swept),
        (&words("6c_histogram_free 6c_histogram_330um 6c_histogram_1500um"), tip),
        (&words("6c_histogram_4500um 6f_histogram_free 6f_histogram_330um"), tip),
        (&["6f_histogram_2000um", "6f_histogram_3300um"], tip),
        (&["6c_free", "6c_330um", "6c_1500um", "6c_4500um"], &samples),
        (&["6f_free", "6f_330um", "6f_2000um", "6f_3300um"], &samples),
        (&["7b"], trial),
    ] {
        for table in tables {
            let name = format!("fig{table}.csv");
            let rows = place.text(&format!("new/folder/{name}"));
            assert_eq!(rows.lines().next(), Some(header), "{name}");
            assert!(rows.lines().count() > 2 && !rows.contains("NaN"), "{name}");
            expected.push(name);
        }
    }
    expected.sort_unstable();
    assert_eq!(files, expected);
    place.write("file", "");
    place
        .run(&["reproduce", "file"])
        .assert_refused(&["file: ", "give a folder that can be written"]);
}

#[test]
fn figures_show_measured_points() {
    let place = Place::with(SCENE);
    let circles = |folder: &str| {
        let picture = place.bytes(&format!("{folder}/fig4d.svg"));
        let picture = String::from_utf8(picture).unwrap();
        picture.matches("<circle").count()
    };
    place.quiet(&["reproduce", "theory"]);
    place.write("points.csv", "side,d,angle\ncb,9,21\ncf,9,-33\n");
    let points = words("--fig4d points.csv --columns distance=d,push=angle");
    place.quiet(&[&["reproduce", "both"], &points[..]].concat());
    // Two points, and one in the legend.
    assert_eq!(circles("both"), circles("theory") + 3);
    place.write("chord.csv", "side,distance_mm,push_chord_deg\ncb,9,21\n");
    place
        .run(&["reproduce", "none", "--fig4d", "chord.csv"])
        .assert_refused(&["--fig4d chord.csv: has push_chord_deg; must have push_angle_deg"]);
}

/// Points beyond reach are refused, as by `curve --data`.
#[test]
fn figures_refuse_points_beyond_reach() {
    let place = Place::with(SCENE);
    place.write("points.csv", "side,distance_mm,push_angle_deg\ncb,9,21\ncb,15.2,3\n");
    for option in ["--fig4d", "--fig5c-left", "--fig5c-right"] {
        let run = place.run(&["reproduce", "figures", option, "points.csv"]);
        run.assert_refused(&[&format!(
            "{option} points.csv:3: distance_mm = 15.2: must be between"
        )]);
        assert!(!place.path("figures").exists());
    }
}

#[test]
fn verify_passes_every_number_but_one_of_the_papers() {
    let run = Place::with(SCENE).quiet(&["verify"]);
    let said = |verdict| run.out.lines().filter(|line| line.ends_with(verdict)).collect::<Vec<_>>();
    let (passes, differs) = (said("PASS").len(), said("DIFFERS"));
    assert!(passes > 30, "{run:?}");
    assert!(
        differs.len() == 1 && differs[0].starts_with("cylinder CB, touched at 10 mm"),
        "{run:?}"
    );
    assert!(differs[0].contains("paper") && differs[0].contains("89.2197"), "{run:?}");
    let all = passes + 1;
    assert!(run.out.contains(&format!("\n{passes} of {all} checks pass; 1 DIFFERS")), "{run:?}");
}
