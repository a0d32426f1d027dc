//! `whiskmap import`.

use super::{Place, SCENE, words};
use crate::shipped::root;
use std::fs;

/// The shipped film of DeepLabCut, its pole and its scale.
const FILM: [&str; 8] = [
    "import",
    "film.csv",
    "--mm-per-pixel",
    "0.05",
    "--pole",
    "pole",
    "--contact-within",
    "0.35mm",
];

fn film() -> Place {
    let place = Place::with(SCENE);
    for (name, shipped) in [("film.csv", "deeplabcut.csv"), ("rows.csv", "measurements.csv")] {
        let text = fs::read_to_string(root().join("scenes").join(shipped)).unwrap();
        place.write(name, &text);
    }
    place
}

/// An empty file may be of any tracker, so that no option is at fault.
#[test]
fn an_empty_file_has_no_points() {
    let place = film();
    place.write("film.csv", "");
    let import = [&FILM[..], &["--fps", "500"]].concat();
    place.run(&import).assert_refused(&["film.csv: has no points"]);
}

#[test]
fn frames_are_those_that_force_and_whisk_read() {
    let place = film();
    let more = words("--fps 500 -o frames.csv --curvature-at 2mm");
    let run = place.run(&[&FILM[..], &more].concat());
    assert_eq!((run.code, &*run.out), (Some(0), "frames.csv\n"), "{run:?}");
    for note in [
        "note: base at ",
        "note: curves are those of a rod: at rest, its curvature has the degree ",
        "note: the taper is 0.9",
        "note: angles of the base are 0 in frame ",
        "of 56 frames are gaps: 3 without base or enough points (missing), 0 along no smooth curve",
        "of 56 frames are in contact",
    ] {
        assert!(run.err.contains(note), "{note}: {run:?}");
    }
    let table = place.text("frames.csv");
    assert!(table.starts_with(
        "frame,time_s,angle_deg,curvature_per_mm,at_arc_length_mm,at_x_mm,at_y_mm,contact,"
    ));
    assert_eq!(table.lines().count(), 57);
    assert!(
        table.lines().nth(5).unwrap().starts_with("4,0.008,,,") && table.contains(",missing\n")
    );

    // The shape of a frame without contact is the whisker's at rest.
    let shape = [&FILM[..], &["--shape", "2", "-o", "traced.csv"]].concat();
    let run = place.run(&shape);
    assert_eq!((run.code, &*run.out), (Some(0), "traced.csv\n"), "{run:?}");
    let scene = SCENE.replace("length_mm = 20.0\n", "");
    let scene = scene.replace(
        "[whisker.curvature]\nparabola_per_mm = 0.02\n",
        "[whisker.rest]\npoints = \"traced.csv\"\n",
    );
    place.write("traced.toml", &scene);
    let run = place.good(&words("shape traced.toml --distance 15 --push-angle 0"));
    assert!(run.err.contains("note: whisker.rest: curvature of degree "), "{run:?}");

    let run = place.good(&["force", "scene.toml", "--frames", "frames.csv", "--model"]);
    // The baseline is that of the frames without contact.
    assert!(run.err.contains("baseline"), "{run:?}");
    assert_eq!(run.out.matches(",missing").count(), 3, "{run:?}");
    let run = place.good(&words(
        "whisk scene.toml --distance 15.66 --angles frames.csv --bridge 10ms --events - \
         --csv samples.csv",
    ));
    assert!(run.out.contains(",slip-off,cb,"), "{run:?}");
}

#[test]
fn detachments_are_those_that_fit_reads() {
    let place = film();
    let words = [&FILM[..], &["--fps", "500", "--detachments", "-o", "points.csv"]].concat();
    let run = place.run(&words);
    assert_eq!((run.code, &*run.out), (Some(0), "points.csv\n"), "{run:?}");
    let table = place.text("points.csv");
    assert!(table.starts_with("side,distance_mm,push_angle_deg,time_s\ncb,15."), "{table}");
    let run = place.good(&["curve", "scene.toml", "--data", "points.csv"]);
    assert!(run.out.contains("slip-off"), "{run:?}");
    // A pole that is not reached leaves none. Curves of a given degree take a tenth of the time.
    let parts = "base,w1,w2,w3,w4,w5,w6,w7,tip";
    let mut far = [&words[..], &["--points", parts, "--degree", "1"]].concat();
    far[5] = "500,500";
    let run = place.good(&far);
    assert!(
        run.err.contains(
            "warning: no contact with a first touch and an end in the film has the pole on the other side"
        ),
        "{run:?}"
    );
    assert!(!run.err.contains("contacts that give no detachment"), "{run:?}");
}

/// A gap hides when a contact begins or ends, as do the ends of the film. Such contacts are counted.
#[test]
fn contacts_without_first_touch_or_end_are_counted() {
    let whole = include_str!("../../scenes/deeplabcut.csv");
    let place = film();
    let words = [&FILM[..], &["--fps", "500", "--detachments", "-o", "points.csv"]].concat();
    // First touch is in frame 12, and the last contact in frame 43.
    for lost in [&[11, 12][..], &[44, 45], &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]] {
        let is_kept = |line: &&str| {
            let number = line.split(',').next().unwrap_or_default();
            number.parse().map_or(true, |frame: u32| !lost.contains(&frame))
        };
        let kept: Vec<&str> = whole.lines().filter(is_kept).collect();
        place.write("film.csv", &kept.join("\n"));
        let run = place.good(&words);
        for said in [
            "note: contacts that give no detachment: 1 (first touch or end next to a gap or outside the film, or a trace that ends before the pole)\n",
            "warning: no contact with a first touch and an end in the film has the pole on the other side",
        ] {
            assert!(run.err.contains(said), "{lost:?} {run:?}");
        }
    }
}

/// A shell sorts `f_10.csv` before `f_2.csv`.
#[test]
fn files_of_frames_are_in_the_order_of_their_numbers() {
    let place = film();
    let frames = [1, 2, 10, 12].map(|frame| {
        let (sin, cos) = (0.02 * f64::from(frame)).sin_cos();
        let point = |s: i32| {
            let s = f64::from(s);
            format!("{},{}\n", cos * s + 0.01 * sin * s * s, sin * s - 0.01 * cos * s * s)
        };
        place.write(&format!("f_{frame}.csv"), &(0..20).map(point).collect::<String>());
        frame
    });
    let files = ["f_1.csv", "f_10.csv", "f_12.csv", "f_2.csv"];
    let options = ["--mm-per-pixel=0.5", "--fps=10", "--follicle=0,0", "--degree=1"];
    let run = place.good(&[&["import"], &files[..], &options].concat());
    let rows: Vec<Vec<&str>> = run.out.lines().map(|line| line.split(',').collect()).collect();
    let known = rows[1..].iter().filter(|row| !row[2].is_empty());
    let known: Vec<(i32, f64)> =
        known.map(|row| (row[0].parse().unwrap(), row[2].parse().unwrap())).collect();
    assert_eq!(known.iter().map(|(frame, _)| *frame).collect::<Vec<_>>(), frames);
    for (frame, angle) in known {
        let turned = (0.02 * f64::from(frame - 1)).to_degrees();
        assert!((angle - turned).abs() < 1e-6, "{frame}: {angle} {turned}");
    }
    assert_eq!((rows.len(), rows[2][1]), (13, "0.2"));
}

#[test]
fn measurements_of_whisk_and_points_are_read() {
    let place = film();
    let run = place.good(&words("import rows.csv --mm-per-pixel 50um --fps 500"));
    assert!(run.err.contains("note: angles are measured from the y axis of the image, as the ends of the segments show"), "{run:?}");
    assert_eq!(run.out.lines().count(), 57);
    assert!(run.out.contains("\n25,0.05,,,"), "{run:?}");
    place.write("a.csv", "0,0\n10,1\n20,3\n30,6\n40,10\n");
    place.write("b.csv", "0,0\n10,2\n20,5\n30,9\n40,14\n");
    let run = place.run(&words("import a.csv b.csv --mm-per-pixel 0.1 --fps 100 --degree 0"));
    assert_eq!((run.code, run.out.lines().count()), (Some(0), 3), "{run:?}");
}

#[test]
fn bad_imports_are_refused() {
    let place = film();
    place.write("film.nwb", "\u{89}HDF");
    fs::write(place.path("film.nwb"), b"\x89HDF\r\n\x1a\nmore").unwrap();
    let import = |file: &str, more: &[&str]| place.run(&[&["import", file], more].concat());
    let scaled =
        |more: &[&'static str]| [&["--mm-per-pixel", "0.05", "--fps", "500"], more].concat();
    // Curves of a given degree take a tenth of the time.
    let curved = |more: &[&'static str]| scaled(&[&["--degree", "1"], more].concat());
    for (file, more, said) in [
        (
            "film.csv",
            vec!["--fps", "500"],
            "the following required arguments were not provided:\n  --mm-per-pixel <MM>",
        ),
        ("film.csv", vec!["--mm-per-pixel", "0.05"], "--fps <HZ>"),
        (
            "film.csv",
            vec!["--mm-per-pixel", "0", "--fps", "500"],
            "--mm-per-pixel 0: must be a number between 1e-9 and 1e9",
        ),
        ("film.csv", vec!["--mm-per-pixel", "0.05px", "--fps", "500"], "unit px: must be mm"),
        ("no.csv", scaled(&[]), "no.csv: cannot be read:"),
        (
            "film.nwb",
            scaled(&[]),
            "film.nwb: is an HDF5 file: NWB files are read in Python, by wm.read_tracking",
        ),
        ("film.csv", scaled(&["--format", "whisk"]), "film.csv:2: found scorer"),
        ("film.csv", scaled(&["--pole", "pole"]), "--contact-within <MM>"),
        ("film.csv", scaled(&["--contact-within", "1"]), "--pole <X,Y/NAME>"),
        ("film.csv", scaled(&["--detachments"]), "--pole <X,Y/NAME>"),
        (
            "film.csv",
            scaled(&["--pole", "1,x", "--contact-within", "1"]),
            "must be X,Y in pixels, such as 120.5,80, or a body part",
        ),
        (
            "film.csv",
            scaled(&["--pole", "bar", "--contact-within", "1"]),
            "--pole bar: must be one of w3, base, tip",
        ),
        (
            "film.csv",
            curved(&["--points", "base,tip"]),
            "film.csv: has no frame with a curve: must have at least one with 5 points along a smooth curve, the base among them and all within ",
        ),
        ("film.csv", scaled(&["--follicle", "12"]), "must be X,Y in pixels"),
        (
            "film.csv",
            curved(&["--curvature-at", "30"]),
            "--curvature-at 30: must be between 0 and ",
        ),
        (
            "film.csv",
            curved(&["--zero", "9s"]),
            "--zero 9: must be the time of a frame with a whisker, between 0.002 and 0.084 s in steps of 1/500 s",
        ),
        ("film.csv", scaled(&["--mirror", "maybe"]), "must be yes or no"),
        ("film.csv", scaled(&["--degree", "7"]), "must be a whole number between 0 and 6"),
        (
            "film.csv",
            curved(&["--shape", "56"]),
            "--shape 56: must be between 0 and 55, the numbers of the frames",
        ),
        (
            "film.csv",
            curved(&["--shape", "4"]),
            "--shape 4: must be a frame with a whisker: this one is a gap",
        ),
        (
            "rows.csv",
            scaled(&["--shape", "4"]),
            "--shape 4: must be left out: measurements of whisk have no points",
        ),
        ("film.csv", curved(&["-o", "film.csv"]), "is the input film.csv; name another file"),
    ] {
        let run = import(file, &more);
        assert_eq!(run.code, Some(2), "{more:?}: {run:?}");
        assert!(run.err.contains(said), "{said}: {run:?}");
    }
}

/// Counts the frames of a run by their contact.
fn contacts(out: &str, contact: &str) -> usize {
    let rows = out.lines().skip(1);
    rows.filter(|row| row.split(',').nth(7) == Some(contact)).count()
}

/// The pole of the shipped film has a radius of 0.25 mm.
#[test]
fn a_film_that_does_not_fit_its_pole_has_warnings_and_no_contact_of_0() {
    let place = film();
    let words = [&FILM[..], &["--fps", "500"]].concat();
    let run = place.run(&words);
    assert!(!run.err.contains("warning: "), "{run:?}");
    assert_eq!([contacts(&run.out, "0"), contacts(&run.out, "1")], [23, 30]);
    let small = words.iter().map(|word| if *word == "0.35mm" { "0.15mm" } else { *word });
    let small = place.run(&small.collect::<Vec<_>>());
    let why = "frames, the whisker is bent at the pole, but is 0.25 mm from its centre (median), more than 0.15 mm";
    assert!(small.err.contains("warning: in "), "{small:?}");
    assert!(small.err.contains(why), "{small:?}");
    // The two lightest pushes bend the whisker by less than the errors of points.
    assert_eq!([contacts(&small.out, "0"), contacts(&small.out, "1")], [25, 0]);
    let names = "base,w1,w2,w3,w4,w5,w6,w7,w8,w9,w10,w11,w12,tip";
    let aside = [&words[..], &["--points", names, "--degree", "1"]].concat();
    let aside = aside.iter().map(|word| if *word == "pole" { "300,900" } else { *word });
    let aside = place.run(&aside.collect::<Vec<_>>());
    let why = "warning: no frame comes near the pole: ";
    assert!(aside.err.contains(why), "{aside:?}");
    let why = "warning: frames far from the pole have no shape at rest in common";
    assert!(aside.err.contains(why), "{aside:?}");
    assert_eq!(contacts(&aside.out, "0"), 0, "{aside:?}");
}
