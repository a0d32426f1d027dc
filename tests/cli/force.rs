//! `whiskmap force`.

use super::traces::cells;
use super::{Place, SCENE};

const HEADER: &str =
    "time_s,curvature_per_mm,at_arc_length_mm,contact_x_mm,contact_y_mm,contact_angle_deg";

const TABLE: &str = "time_s,curvature_change_per_mm,moment_nnm,force_un,base_force_x_un,base_force_y_un,base_moment_nnm,\
                     contact_angle_deg,contact_off_mm,force_sd_un,base_force_x_sd_un,base_force_y_sd_un,base_moment_sd_nnm,\
                     side,arc_length_mm,reason";

fn force(place: &Place, more: &[&str]) -> super::Run {
    place.run(&[&["force", "scene.toml", "--frames", "f.csv"], more].concat())
}

/// The example file has a push of the whisker of `cone.toml` to just before its slip-off, rounded to six decimals.
#[test]
fn both_methods_agree_on_the_example() {
    let place = Place::with(SCENE);
    place.write("f.csv", include_str!("../../scenes/frames.csv"));
    let lever = force(&place, &[]);
    let model = force(&place, &["--model"]);
    assert_eq!((lever.code, model.code), (Some(0), Some(0)), "{lever:?} {model:?}");
    let forces = |run: &super::Run| -> Vec<f64> {
        let rows = cells(&run.out, TABLE);
        rows.iter().map(|row| row[3].parse().unwrap()).collect()
    };
    let (lever, model) = (forces(&lever), forces(&model));
    assert_eq!(lever.len(), 60);
    assert!(lever.iter().any(|force| *force > 1.0) && lever.contains(&0.0));
    for (one, other) in lever.iter().zip(&model) {
        assert!((one - other).abs() < 1e-3, "{one} {other}");
    }
    let plotted = force(&place, &["--plot", "f.svg"]);
    assert_eq!((plotted.code, &*plotted.out), (Some(0), "f.svg\n"), "{plotted:?}");
    let svg = place.text("f.svg");
    assert!(
        svg.contains(">contact force (\u{b5}N)<")
            && svg.contains(">bending moment at the base (nN m)<")
    );
    // Frames have no standard deviations yet.
    assert!(!svg.contains("standard deviation"), "{svg}");
    place.write("sd.toml", &format!("{SCENE}\n[uncertainty]\ncurvature_sd_per_mm = 1e-3\n"));
    place.quiet(&["force", "sd.toml", "--frames", "f.csv", "--plot", "sd.svg"]);
    let svg = place.text("sd.svg");
    assert_eq!(svg.matches(">\u{b1} standard deviation<").count(), 1);
}

#[test]
fn wrong_frames_are_refused() {
    let place = Place::with(SCENE);
    for (rows, said) in [
        ("0,x,2,15,4,30", "f.csv:2: curvature_per_mm = x: must be a number between -1e6 and 1e6"),
        (
            "0,0.03,20,15,4,30",
            "at_arc_length_mm = 20: must be a number of at least 0 and less than 20",
        ),
        (
            "0,0.03,2,15,4,30\n0,0.03,2,15,4,30",
            "f.csv:3: time_s = 0: must be more than 0 of the line before",
        ),
    ] {
        place.write("f.csv", &format!("{HEADER}\n{rows}\n"));
        force(&place, &[]).assert_refused(&[said]);
    }
    place.write("f.csv", &format!("{}\n0,0.03,2,15,4\n", HEADER.replace(",contact_angle_deg", "")));
    force(&place, &[]).assert_refused(&["needed time_s", "contact_angle_deg"]);
    let model = force(&place, &["--model"]);
    assert_eq!(model.code, Some(0), "{model:?}");
    let rough = Place::with(&SCENE.replace("[grid]", "[contact]\nfriction = 0.3\n[grid]"));
    rough.write("f.csv", &format!("{HEADER}\n0,0.03,2,15,4,30\n"));
    force(&rough, &[]).assert_refused(&["contact.friction = 0.3: must be 0"]);
}

/// A frame with a missing number is a row with its reason, and what is known.
#[test]
fn frames_with_a_missing_number_have_a_reason() {
    let place = Place::with(SCENE);
    let rows = [
        "0,,2,15,4,30",
        "1,NaN,2,15,4,30",
        "2,0.03,,15,4,30",
        "3,0.03,2,15,,30",
        "4,0.03,2,15,4,",
        "5,0.03,2,,,",
        "6,0.03,2,15,4,30",
    ];
    place.write("f.csv", &format!("{HEADER}\n{}\n", rows.join("\n")));
    let run = force(&place, &[]);
    assert_eq!(run.code, Some(0), "{run:?}");
    let found = cells(&run.out, TABLE);
    let reasons: Vec<&str> = found.iter().map(|row| *row.last().unwrap()).collect();
    assert_eq!(reasons, [&["missing"; 5][..], &["", ""]].concat());
    let changes: Vec<bool> = found.iter().map(|row| !row[1].is_empty()).collect();
    assert_eq!(changes, [false, false, false, true, true, true, true]);
    assert!(run.err.contains("5 of 7 frames have no force"), "{run:?}");
    // The model needs no angle.
    let model = force(&place, &["--model"]);
    let found = cells(&model.out, TABLE);
    assert_eq!(*found[4].last().unwrap(), "");
}

/// The frames of a time, or those whose contact is 0, give the baseline, which is reported with its scatter.
#[test]
fn a_baseline_is_reported_and_used() {
    let place = Place::with(SCENE);
    let rows = ["0,0.011,2,,,", "0.05,0.013,2,,,", "0.1,0.012,2,,,", "0.2,0.03,2,15,4,30"];
    place.write("f.csv", &format!("{HEADER}\n{}\n", rows.join("\n")));
    let plain = force(&place, &[]);
    let sds = |run: &super::Run| -> Vec<bool> {
        let rows = cells(&run.out, TABLE);
        rows.iter().map(|row| !row[9].is_empty()).collect()
    };
    assert_eq!(sds(&plain), [false; 4]);
    assert!(
        plain.err.starts_with("warning: frames without contact have a moment of "),
        "{plain:?}"
    );
    let spanned = force(&place, &["--baseline", "0s..100ms"]);
    assert_eq!(spanned.code, Some(0), "{spanned:?}");
    assert!(spanned.err.contains("baseline of 3 frames without contact: "), "{spanned:?}");
    assert!(spanned.err.contains("; the scatter of a frame is 0.001 per mm"), "{spanned:?}");
    assert_eq!(sds(&spanned), [false, false, false, true]);
    // The column needs no empty cells.
    let with_column: Vec<String> = rows
        .iter()
        .zip([0, 0, 0, 1])
        .map(|(row, contact)| format!("{},{contact}", row.replace(",,,", ",9,9,9")))
        .collect();
    place.write("f.csv", &format!("{HEADER},contact\n{}\n", with_column.join("\n")));
    let column = force(&place, &[]);
    assert_eq!((&column.out, &column.err), (&spanned.out, &spanned.err));
    // A contact that is not known, or whose position is not, is missing.
    place.write(
        "f.csv",
        &format!(
            "{HEADER},contact\n{}\n1,0.03,2,15,4,30,\n2,0.03,2,,,,1\n",
            with_column.join("\n")
        ),
    );
    let run = force(&place, &[]);
    let reasons = cells(&run.out, TABLE);
    let reasons: Vec<&str> = reasons.iter().map(|row| *row.last().unwrap()).collect();
    assert_eq!(reasons, ["", "", "", "", "missing", "missing"]);
    for (text, options, said) in [
        ("0,0.01,2,,,,0", &["--baseline", "0..1"][..], "f.csv: has 1 frames without contact"),
        ("0,0.01,2,1,1,1,0.5", &[], "contact = 0.5: must be 0 or 1, or empty where it is missing"),
        ("0,0.01,2,,,,0", &["--baseline", "1"], "must be a span of time, such as 0s..0.1s"),
        ("0,0.01,2,,,,0", &["--baseline", "1..0"], "must be a span of time, such as 0s..0.1s"),
        (
            "0,0.01,2,,,,0",
            &["--baseline", "0..1mm"],
            "1mm: unit mm: must be s (the default), ms or us",
        ),
    ] {
        place.write("f.csv", &format!("{HEADER},contact\n{text}\n"));
        force(&place, options).assert_refused(&[said]);
    }
    // A film of contacts alone has no baseline, as if it had no column.
    let contacts = format!("{HEADER},contact\n{},1\n", rows[3]);
    place.write("f.csv", &contacts);
    let alone = force(&place, &[]);
    assert_eq!((alone.code, &*alone.err), (Some(0), ""), "{alone:?}");
    assert_eq!(alone.out.lines().last(), plain.out.lines().last());
}

/// A frame that the tracker has lost does not count in a baseline; a frame in contact whose position is missing is refused.
#[test]
fn a_baseline_leaves_out_lost_frames() {
    let place = Place::with(SCENE);
    let rows = |lost: &str| {
        let rows = ["0,0.011,2,,,,0", lost, "0.1,0.013,2,,,,0", "0.2,0.03,2,15,4,30,1"];
        format!("{HEADER},contact\n{}\n", rows.join("\n"))
    };
    for lost in ["0.05,,,,,,", "0.05,0.02,2,,,,NA", "0.05,0.02,2,15,4,30,"] {
        place.write("f.csv", &rows(lost));
        let run = force(&place, &["--baseline", "0..0.1"]);
        assert_eq!(run.code, Some(0), "{run:?}");
        let note = "baseline of 2 frames without contact: ";
        assert!(run.err.contains(note), "{run:?}");
        let reasons = cells(&run.out, TABLE);
        let reasons: Vec<&str> = reasons.iter().map(|row| *row.last().unwrap()).collect();
        assert_eq!(reasons, ["", "missing", "", ""]);
    }
    place.write("f.csv", &rows("0.05,0.02,2,,,,1"));
    force(&place, &["--baseline", "0..0.1"])
        .assert_refused(&["f.csv:3: time_s = 0.05: is in contact"]);
}

/// One frame without contact is no baseline. Where it is asked for, it is refused.
#[test]
fn one_free_frame_is_no_baseline() {
    let place = Place::with(SCENE);
    let rows = ["0,0.011,2,,,,0", "0.2,0.03,2,15,4,30,1"];
    place.write("f.csv", &format!("{HEADER},contact\n{}\n", rows.join("\n")));
    let run = force(&place, &[]);
    let note = "no baseline: fewer than 2 frames without contact have a curvature\n";
    assert_eq!((run.code, &*run.err), (Some(0), note), "{run:?}");
    let said = "has 1 frames without contact and with a curvature from 0 to 0.1 s";
    force(&place, &["--baseline", "0..0.1"]).assert_refused(&[said]);
}

/// Without the curvature at rest of the cone, free frames seem to have a load.
#[test]
fn a_shape_at_rest_that_is_not_the_whiskers_is_noticed() {
    let place = Place::with(SCENE);
    place.write("f.csv", include_str!("../../scenes/frames.csv"));
    assert_eq!(force(&place, &[]).err, "");
    place.write("scene.toml", &SCENE.replace("parabola_per_mm = 0.02", "parabola_per_mm = 0.0"));
    let run = force(&place, &[]);
    assert!(run.err.contains("warning: frames without contact have a moment of "), "{run:?}");
}

/// A contact on the other side of the base has a warning.
#[test]
fn impossible_contacts_are_noticed() {
    let place = Place::with(SCENE);
    let rows = ["0,0.05,5,-11,-4,40", "1,0.05,5,30,4,40"];
    place.write("f.csv", &format!("{HEADER}\n{}\n", rows.join("\n")));
    let model = force(&place, &["--model"]);
    let warning = "1 of 2 frames have a contact_off_mm of more than 2, a tenth of the whisker's length, and up to 23.4: check";
    assert!(model.err.contains(warning), "{model:?}");
    place.write("f.csv", include_str!("../../scenes/frames.csv"));
    assert_eq!(force(&place, &["--model"]).err, "");
}

/// The scene's standard deviations of frames are those of forces.
#[test]
fn a_scene_gives_standard_deviations_of_frames() {
    let row = format!("{HEADER}\n0,0.03,2,15,4,30\n");
    let sd = |keys: &str, options: &[&str]| -> Vec<f64> {
        let place = Place::with(&format!("{SCENE}[uncertainty]\n{keys}\n"));
        place.write("f.csv", &row);
        let run = force(&place, options);
        assert_eq!(run.code, Some(0), "{run:?}");
        let cells = cells(&run.out, TABLE);
        cells[0][9..13].iter().map(|cell| cell.parse().unwrap()).collect()
    };
    let keys = ["curvature_sd_per_mm = 1e-3", "contact_sd_mm = 0.1", "angle_sd_deg = 2"];
    for key in keys {
        let found = sd(key, &[]);
        assert!(found.iter().all(|sd| *sd > 0.0), "{key}: {found:?}");
    }
    assert_eq!(sd(keys[2], &["--model"]), [0.0; 4]);
    let place = Place::with(&format!("{SCENE}[uncertainty]\nangle_sd_deg = 2\n"));
    place
        .run(&["curve", "scene.toml", "--samples", "20"])
        .assert_refused(&["[uncertainty] is of frames alone: add a parameter of the scene"]);
}
