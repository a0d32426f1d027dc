//! `whiskmap force`.

use super::traces::cells;
use super::{Place, SCENE};

const HEADER: &str =
    "time_s,curvature_per_mm,at_arc_length_mm,contact_x_mm,contact_y_mm,contact_angle_deg";

const TABLE: &str = "time_s,curvature_change_per_mm,moment_nnm,force_un,base_force_x_un,base_force_y_un,base_moment_nnm,\
                     contact_angle_deg,contact_off_mm,reason";

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
    assert_eq!(
        (lever.code, model.code),
        (Some(0), Some(0)),
        "{lever:?} {model:?}"
    );
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
    assert_eq!(
        (plotted.code, &*plotted.out),
        (Some(0), "f.svg\n"),
        "{plotted:?}"
    );
    let svg = String::from_utf8(place.bytes("f.svg")).unwrap();
    assert!(
        svg.contains(">contact force (\u{b5}N)<")
            && svg.contains(">bending moment at the base (nN m)<")
    );
}

#[test]
fn wrong_frames_are_refused() {
    let place = Place::with(SCENE);
    for (rows, said) in [
        (
            "0,x,2,15,4,30",
            "f.csv:2: curvature_per_mm = x: must be a number between -1e6 and 1e6",
        ),
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
    place.write(
        "f.csv",
        &format!(
            "{}\n0,0.03,2,15,4\n",
            HEADER.replace(",contact_angle_deg", "")
        ),
    );
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
