//! Files of trackers: base, order, scale, angle, curvature, contact and detachments come back; bad files are refused.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod film;
mod refused;
mod rods;
mod warnings;

use std::sync::atomic::AtomicBool;
use whiskmap::tracking::{
    FaceAxis, NoFrame, Tracking, TrackingError, TrackingFormat, TrackingOptions,
};

/// Scale of all images, in mm per pixel.
const SCALE: f64 = 0.05;

/// Radius and length of the arc that most tests trace, in mm.
const ARC_MM: [f64; 2] = [25.0, 20.0];

/// Angles of the base of the arc, in degrees, counterclockwise from the x axis of the image: it turns in each frame.
const ANGLES: [f64; 6] = [10.0, 12.0, 15.0, 13.0, 9.0, 5.0];

fn options() -> TrackingOptions {
    TrackingOptions::new(SCALE, 500.0)
}

/// Options with a change.
fn with(change: &dyn Fn(&mut TrackingOptions)) -> TrackingOptions {
    let mut changed = options();
    change(&mut changed);
    changed
}

fn parse(text: &str, options: &TrackingOptions) -> Result<Tracking, TrackingError> {
    Tracking::parse(&[(text.to_owned(), "film.csv".to_owned())], options, &AtomicBool::new(false))
}

fn refusal(text: &str, options: &TrackingOptions) -> String {
    parse(text, options).unwrap_err().to_string()
}

/// Point of the arc at an arclength in pixels, with the y axis downward. The base is at 40,300, and the arc turns counterclockwise.
fn arc(s_mm: f64, base_deg: f64) -> [f64; 2] {
    let [radius, _] = ARC_MM;
    let (base, turn) = (base_deg.to_radians(), s_mm / radius);
    let x = radius * ((base + turn).sin() - base.sin());
    let y = radius * (base.cos() - (base + turn).cos());
    [40.0 + x / SCALE, 300.0 - y / SCALE]
}

/// Names of points and their places from the base, in mm, in the order of the file.
const PARTS: [(&str, f64); 9] = [
    ("c", 7.5),
    ("base", 0.0),
    ("tip", 20.0),
    ("a", 2.5),
    ("f", 15.0),
    ("b", 5.0),
    ("g", 17.5),
    ("d", 10.0),
    ("e", 12.5),
];

/// CSV file of DeepLabCut of the arc; `change` may change position and likelihood of a point: `(frame, name, position)`.
fn deeplabcut(change: impl Fn(usize, &str, [f64; 2]) -> (String, f64)) -> String {
    let names: String = PARTS.iter().map(|(name, _)| format!(",{name},{name},{name}")).collect();
    let scorers = ",net".repeat(3 * PARTS.len());
    let coords = ",x,y,likelihood".repeat(PARTS.len());
    let mut text = format!("scorer{scorers}\nbodyparts{names}\ncoords{coords}\n");
    for (frame, angle) in ANGLES.iter().enumerate() {
        text += &frame.to_string();
        for (name, s) in PARTS {
            let (at, likelihood) = change(frame, name, arc(s, *angle));
            text += &format!(",{at},{likelihood}");
        }
        text += "\n";
    }
    text
}

fn exact(_: usize, _: &str, [x, y]: [f64; 2]) -> (String, f64) {
    (format!("{x:?},{y:?}"), 1.0)
}

#[track_caller]
fn assert_near(found: Option<f64>, wanted: f64, tolerance: f64) {
    let found = found.unwrap();
    assert!((found - wanted).abs() <= tolerance, "{found} {wanted}");
}

/// Whatever the order of the parts: base, angle, curvature and place come from the positions.
#[test]
fn an_arc_of_deeplabcut_comes_back() {
    let found = parse(&deeplabcut(exact), &options()).unwrap();
    assert_eq!(found.format, TrackingFormat::DeepLabCut);
    assert_eq!(found.frames.len(), ANGLES.len());
    for (row, angle) in found.frames.iter().zip(ANGLES) {
        // Positive angles push CB: the base turns clockwise.
        assert_near(row.angle_deg, ANGLES[0] - angle, 1e-7);
        assert_near(row.curvature_per_mm, 0.04, 1e-9);
        assert_near(row.at_arc_length_mm, 5.0, 1e-9);
        assert_near(row.at_x_mm, 25.0 * 0.2_f64.sin(), 1e-7);
        assert_near(row.at_y_mm, 25.0 * (1.0 - 0.2_f64.cos()), 1e-7);
        assert_near(row.length_mm, 20.0, 1e-7);
        assert_near(row.rms_mm, 0.0, 1e-9);
        assert_eq!((row.contact, row.contact_x_mm, row.reason), (None, None, None));
    }
    assert!((found.frames[5].time_s - 0.01).abs() < 1e-15);
    let notes = found.notes.join("\n");
    assert!(notes.contains("base at 40.0,300.0 px; it moves by 0.00 px"), "{notes}");
    assert!(
        notes.contains(
            "of whole whiskers have a curvature of degree 0, chosen by cross-validation in 6 frames"
        ),
        "{notes}"
    );
    assert!(!notes.contains("mirrored"), "{notes}");
    // The shape is in mm, with the y axis upward, from base to tip.
    let shape = found.shape(2).unwrap();
    assert_eq!(shape.len(), 9);
    for (point, s) in shape.iter().zip(0..) {
        let [x, y] = arc(2.5 * f64::from(s), ANGLES[2]);
        assert!((point.x_mm - SCALE * x).abs() < 1e-12 && (point.y_mm + SCALE * y).abs() < 1e-12);
    }
    // Forces are 0 without contact, but whether there is one is not known.
    let place = with(&|options| {
        options.curvature_at_mm = Some(2.0);
        options.degree = Some(2);
    });
    let found = parse(&deeplabcut(exact), &place).unwrap();
    assert_near(found.frames[0].at_arc_length_mm, 2.0, 0.0);
    assert_near(found.frames[0].curvature_per_mm, 0.04, 1e-7);
}

#[test]
fn lost_points_are_left_out_and_a_lost_base_is_a_gap() {
    let text = deeplabcut(|frame, name, [x, y]| match (frame, name) {
        (1, "base") => (format!("{x},{y}"), 0.89),
        (2, "d") => (format!("{},{y}", x + 100.0), 0.1),
        (3, "base" | "tip" | "a") => (",".to_owned(), 1.0),
        (4, _) => (format!("{},{y}", if name == "c" { x + 60.0 } else { x }), 1.0),
        (5, "tip") => (format!("{x},{y}"), 0.5),
        _ => (format!("{x},{y}"), 1.0),
    });
    let found = parse(&text, &options()).unwrap();
    let reasons: Vec<_> = found.frames.iter().map(|row| row.reason).collect();
    let (missing, off) = (Some(NoFrame::Missing), Some(NoFrame::NoCurve));
    assert_eq!(reasons, [None, missing, None, missing, off, None]);
    assert_near(found.frames[2].curvature_per_mm, 0.04, 1e-7);
    assert_near(found.frames[5].length_mm, 17.5, 1e-7);
    let gap = found.frames[1];
    assert_eq!((gap.angle_deg, gap.curvature_per_mm, gap.length_mm), (None, None, None));
    assert_eq!(gap.time_s, 0.002);
    let notes = found.notes.join("\n");
    assert!(notes.contains("3 of 6 frames are gaps: 2 without base or enough points (missing), 1 along no smooth curve (no-curve)"), "{notes}");
    let why = found.shape(1).unwrap_err().to_string();
    assert_eq!(why, "shape = 1: must be a frame with a whisker: this one is a gap");
    assert!(found.shape(6).unwrap_err().to_string().contains("must be between 0 and 5"));
    // A lower limit keeps the point.
    let low = with(&|options| options.likelihood = Some(0.85));
    assert_eq!(parse(&text, &low).unwrap().frames[1].reason, None);
    // Frames that the file leaves out are gaps, too.
    let lines: Vec<String> = deeplabcut(exact).lines().map(str::to_owned).collect();
    let skipped = [&lines[..4], &lines[7..]].concat().join("\n");
    let found = parse(&skipped, &options()).unwrap();
    let reasons: Vec<_> = found.frames.iter().map(|row| row.reason).collect();
    assert_eq!(reasons, [None, missing, missing, missing, None, None]);
}

/// A whisker that turns clockwise is the mirror image of one that turns counterclockwise.
#[test]
fn an_image_is_mirrored_by_its_curvature_or_by_an_option() {
    let mirrored = deeplabcut(|_, _, [x, y]| (format!("{x:?},{:?}", 600.0 - y), 1.0));
    let found = parse(&mirrored, &options()).unwrap();
    let plain = parse(&deeplabcut(exact), &options()).unwrap();
    for (row, other) in found.frames.iter().zip(&plain.frames) {
        assert_near(row.angle_deg, other.angle_deg.unwrap(), 1e-7);
        assert_near(row.curvature_per_mm, 0.04, 1e-9);
        assert_near(row.at_y_mm, other.at_y_mm.unwrap(), 1e-7);
    }
    assert!(
        found.notes.join("\n").contains("the image is mirrored, so that the concave side is CF")
    );
    assert!(found.shape(0).unwrap()[8].y_mm > found.shape(0).unwrap()[0].y_mm);
    let not = with(&|options| options.mirror = Some(false));
    let found = parse(&mirrored, &not).unwrap();
    assert_near(found.frames[3].curvature_per_mm, -0.04, 1e-9);
    assert_near(found.frames[3].angle_deg, 3.0, 1e-7);
}

#[test]
fn the_base_is_named_found_or_near_the_follicle() {
    let names = ["tip", "g", "f", "e", "d", "c", "b", "a", "base"].map(str::to_owned);
    let reversed = with(&|options| options.points = names.to_vec());
    let found = parse(&deeplabcut(exact), &reversed).unwrap();
    assert_eq!(found.shape(0).unwrap()[0].x_mm, SCALE * arc(20.0, ANGLES[0])[0]);
    let follicle = with(&|options| options.follicle_px = Some([400.0, 200.0]));
    let found = parse(&deeplabcut(exact), &follicle).unwrap();
    assert_eq!(found.shape(0).unwrap()[0].x_mm, SCALE * arc(20.0, ANGLES[0])[0]);
    // The whisker that shifts as a whole shows no base.
    let shifted = deeplabcut(|frame, name, _| {
        let s = PARTS.iter().find(|(part, _)| *part == name).unwrap().1;
        let [x, y] = arc(s, 0.0);
        (format!("{},{y}", x + frame as f64), 1.0)
    });
    let why = refusal(&shifted, &options());
    assert!(why.starts_with("follicle_px = (left out): must be given: both ends of the whisker move about equally, by "), "{why}");
    let given = with(&|options| options.follicle_px = Some([40.0, 300.0]));
    assert!(parse(&shifted, &given).is_ok());
}

/// Rows of `whisk` for the arc, whose angle is measured from this axis of the image.
fn measurements(axis: FaceAxis) -> String {
    segments(axis, &ANGLES, 0.0)
}

/// Rows of `whisk` for the arc at these angles of the base, in degrees. The whiskers differ from the arc by `off` degrees at the base.
fn segments(axis: FaceAxis, angles: &[f64], off: f64) -> String {
    let mut text = "fid,wid,label,face_x,face_y,length,score,angle,curvature,follicle_x,follicle_y,tip_x,tip_y\n".to_owned();
    for (frame, angle) in angles.iter().enumerate().filter(|(frame, _)| *frame != 2) {
        let ([x, y], [tip_x, tip_y]) = (arc(0.0, *angle), arc(20.0, *angle));
        // The y axis of the image is downward, where counterclockwise is negative.
        let angle = match axis {
            FaceAxis::X => -angle - off,
            FaceAxis::Y => 90.0 + angle + off,
        };
        let curvature = -0.04 * SCALE;
        text += &format!(
            "{frame},3,0,-100,200,400,1500,{angle:?},{curvature:?},{x:?},{y:?},{tip_x:?},{tip_y:?}\n"
        );
        text += &format!("{frame},1,-1,-100,200,50,500,80,0.01,200,100,230,90\n");
    }
    text
}

#[test]
fn measurements_of_whisk_come_back() {
    for axis in [FaceAxis::X, FaceAxis::Y] {
        let found = parse(&measurements(axis), &options()).unwrap();
        assert_eq!(found.format, TrackingFormat::Whisk);
        assert_eq!(found.frames.len(), ANGLES.len());
        for (row, angle) in found.frames.iter().zip(ANGLES) {
            if row.frame == 2 {
                assert_eq!((row.reason, row.angle_deg), (Some(NoFrame::Missing), None));
                continue;
            }
            assert_near(row.angle_deg, ANGLES[0] - angle, 1e-9);
            assert_near(row.curvature_per_mm, 0.04, 1e-12);
            assert_near(row.length_mm, 20.0, 1e-9);
            // The mean curvature of a curvature that is linear is that in the middle.
            assert_near(row.at_arc_length_mm, 10.0, 1e-9);
            assert_near(row.at_x_mm, 25.0 * 0.4_f64.sin(), 1e-7);
        }
        let name = if axis == FaceAxis::X { "x" } else { "y" };
        let note = format!(
            "angles are measured from the {name} axis of the image, as the ends of the segments show"
        );
        assert!(found.notes.contains(&note), "{:?}", found.notes);
        let why = found.shape(0).unwrap_err().to_string();
        assert!(why.contains("measurements of whisk have no points along the whisker"), "{why}");
    }
    // Frames without the whisker are gaps at the ends of the film, too.
    let first = "0,3,0,-100,200,400,1500,nan,0.01,200,100,230,90\n";
    let last = "6,1,-1,-100,200,50,500,80,0.01,200,100,230,90\n";
    let all = measurements(FaceAxis::Y);
    let (header, rows) = all.split_once('\n').unwrap();
    let rows: Vec<&str> = rows.lines().filter(|row| !row.starts_with("0,3")).collect();
    let found =
        parse(&format!("{header}\n{first}{}\n{last}", rows.join("\n")), &options()).unwrap();
    let reasons: Vec<_> =
        found.frames.iter().map(|row| (row.frame, row.reason.is_some())).collect();
    let lost = [true, false, true, false, false, false, true];
    assert_eq!(reasons, (0..).zip(lost).collect::<Vec<_>>());
    let why = refusal(&all, &with(&|options| options.whisker = Some(-1)));
    assert_eq!(why, "whisker = -1: must be an identity in the column label: 0 (5 rows)");
    // The axis may be given, and the table may have the names of ndx-whisk and no labels.
    let named =
        measurements(FaceAxis::Y).replace("fid,wid,label", "frame_id,whisker_id,chunk_start");
    let third = with(&|options| {
        options.whisker = Some(3);
        options.face_axis = Some(FaceAxis::X);
    });
    let found = parse(&named, &third).unwrap();
    assert_near(found.frames[1].angle_deg, 2.0, 1e-9);
    let why = refusal(&named, &options());
    assert_eq!(
        why,
        "whisker = (left out): must be an identity in the column whisker_id: 1 (5 rows), 3 (5 rows)"
    );
}

/// At 45 degrees, both axes are as near to the ends of a whisker that is no arc, but only from one of them do angles turn as the ends do.
#[test]
fn the_axis_of_angles_is_that_from_which_they_turn_as_the_ends() {
    for axis in [FaceAxis::X, FaceAxis::Y] {
        for (middle, off) in [(-46.0, 4.0), (-44.0, -4.0), (-50.0, 9.0)] {
            let angles = [-4.0, -2.0, 0.0, 2.0, 3.0, 4.0].map(|angle| middle + angle);
            let found = parse(&segments(axis, &angles, off), &options()).unwrap();
            for (row, angle) in found.frames.iter().zip(angles).filter(|(row, _)| row.frame != 2) {
                assert_near(row.angle_deg, angles[0] - angle, 1e-9);
            }
            assert_eq!(found.warnings, [""; 0]);
        }
    }
    let warns = |text: &str, options: &TrackingOptions, what: &str| {
        let found = parse(text, options).unwrap().warnings;
        assert!(found.iter().any(|warning| warning.contains(what)), "{what}: {found:?}");
    };
    let still = segments(FaceAxis::X, &[-45.0; 6], 4.0);
    warns(&still, &options(), "hardly show that angles are not measured from the ");
    let wrong = with(&|options| options.face_axis = Some(FaceAxis::Y));
    warns(&measurements(FaceAxis::X), &wrong, "fit angles from the x axis better");
    let off = segments(FaceAxis::X, &ANGLES, 40.0);
    warns(&off, &options(), "differ by 40 deg from those of arcs");
}

/// Points `x,y` of a frame in steps of 1 mm, from the base or from the tip.
fn points(frame: usize) -> String {
    let point = |s: i32| {
        let [x, y] = arc(f64::from(s), ANGLES[frame]);
        format!("{x:?},{y:?}\n")
    };
    match frame % 2 {
        0 => (0..=20).map(point).collect(),
        _ => (0..=20).rev().map(point).collect(),
    }
}

#[test]
fn points_without_a_header_come_back() {
    let files: Vec<(String, String)> = (0..ANGLES.len())
        .map(|frame| {
            (if frame == 3 { String::new() } else { points(frame) }, format!("{frame}.csv"))
        })
        .collect();
    let cancel = AtomicBool::new(false);
    let several = Tracking::parse(&files, &options(), &cancel).unwrap();
    // Names have the numbers of frames, whatever the order of the files.
    let mut shuffled = files.clone();
    shuffled.rotate_left(2);
    assert_eq!(Tracking::parse(&shuffled, &options(), &cancel).unwrap(), several);
    shuffled[0].1 = "03.csv".to_owned();
    let why = Tracking::parse(&shuffled, &options(), &cancel).unwrap_err();
    assert!(why.to_string().contains("is of frame 3, as"), "{why}");
    for (file, name) in shuffled.iter_mut().zip(["b", "a", "c", "d", "e", "f"]) {
        file.1 = format!("{name}.csv");
    }
    let counted = Tracking::parse(&shuffled, &options(), &cancel).unwrap();
    assert_eq!(counted.frames[1].reason, Some(NoFrame::Missing));
    assert!(counted.notes[0].contains("have no numbers of frames: frame 0 is b.csv"));
    let rows = |frame: usize| -> String {
        points(frame).lines().map(|line| format!("{frame},{line}\n")).collect()
    };
    let one: String = (0..ANGLES.len()).filter(|frame| *frame != 3).map(rows).collect();
    let one = parse(&one, &options()).unwrap();
    assert_eq!((several.format, &several.frames), (TrackingFormat::Xy, &one.frames));
    for (row, angle) in one.frames.iter().zip(ANGLES) {
        if row.frame == 3 {
            assert_eq!(row.reason, Some(NoFrame::Missing));
            continue;
        }
        assert_near(row.angle_deg, ANGLES[0] - angle, 1e-7);
        assert_near(row.curvature_per_mm, 0.04, 1e-9);
    }
    let headed: Vec<(String, String)> =
        files.iter().map(|(text, name)| (format!("x,y\n{text}"), name.clone())).collect();
    assert_eq!(Tracking::parse(&headed, &options(), &cancel).unwrap(), several);
    // One frame does not show which end is the base.
    let single = parse(&points(0), &options()).unwrap();
    assert!(single.notes[0].contains("points are taken from base to tip as they are given"));
    assert_near(single.frames[0].curvature_per_mm, 0.04, 1e-9);
    let semicolons = points(0).replace(',', ";").replace('.', ",");
    assert_eq!(parse(&semicolons, &options()).unwrap().frames, single.frames);
}

/// A lost end does not turn the points of its frame around, and a frame without its base is a gap.
#[test]
fn points_without_numbers_are_lost() {
    let known = (0..ANGLES.len()).map(|frame| (points(frame), format!("{frame}.csv")));
    let lost = |frame: usize, which: usize, marker: &str| -> String {
        let text = points(frame);
        let lines = text.lines().enumerate();
        lines.map(|(i, line)| format!("{}\n", if i == which { marker } else { line })).collect()
    };
    let mut files: Vec<(String, String)> = known.collect();
    let cancel = AtomicBool::new(false);
    let all = Tracking::parse(&files, &options(), &cancel).unwrap().frames;
    // Odd frames are given from tip to base. Frame 1 loses its tip, 2 its base, 3 its base, and 4 a point between.
    for (frame, which, marker) in
        [(1, 0, "NA,NA"), (2, 0, "nan,3"), (3, 20, ",4"), (4, 7, "none,#N/A")]
    {
        files[frame].0 = lost(frame, which, marker);
    }
    let some = Tracking::parse(&files, &options(), &cancel).unwrap().frames;
    for (found, wanted) in some.iter().zip(&all) {
        if [2, 3].contains(&found.frame) {
            assert_eq!(found.reason, Some(NoFrame::Missing));
        } else {
            assert_near(found.angle_deg, wanted.angle_deg.unwrap(), 1e-7);
            assert_near(found.curvature_per_mm, 0.04, 1e-9);
        }
    }
    let one = parse("0,NA,NA\n", &options());
    assert!(
        one.unwrap_err()
            .to_string()
            .contains("has no frame with a curve: must have at least one with 4 points")
    );
}

/// The time of the angle 0 may be given.
#[test]
fn the_angle_is_0_at_a_given_time() {
    let options = with(&|options| options.zero_s = Some(0.004));
    let found = parse(&deeplabcut(exact), &options).unwrap();
    assert_near(found.frames[2].angle_deg, 0.0, 1e-12);
    assert_near(found.frames[0].angle_deg, 5.0, 1e-7);
}
