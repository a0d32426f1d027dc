//! Files of points, and points beside the theory.

use crate::cone;
use whiskmap::measured::{Angle, Points};
use whiskmap::rod::Side;
use whiskmap::trace::DetachmentKind;

const GOOD: &str =
    "side,distance_mm,push_angle_deg,kind,sd_deg\ncb,15.5,16,slip-off,0.5\ncf,12,-41,,0.7\n";

fn refused(text: &str) -> String {
    Points::parse(text, "p.csv").unwrap_err().to_string()
}

#[test]
fn columns_come_in_any_order() {
    let points = Points::parse(GOOD, "p.csv").unwrap();
    assert_eq!((points.angle, points.have_deviations), (Angle::Push, true));
    let [cb, cf] = points.points[..] else {
        panic!()
    };
    assert_eq!(
        (cb.line, cb.side, cb.distance_mm, cb.angle_deg, cb.sd_deg),
        (2, Side::Cb, 15.5, 16.0, 0.5)
    );
    assert_eq!(
        (cf.line, cf.side, cf.distance_mm, cf.angle_deg, cf.sd_deg),
        (3, Side::Cf, 12.0, -41.0, 0.7)
    );
    assert_eq!((cb.kind, cf.kind), (Some(DetachmentKind::SlipOff), None));
    let turned =
        "sd_deg,kind,push_angle_deg,distance_mm,side\n0.5,slip-off,16,15.5,cb\n0.7,,-41,12,cf\n";
    assert_eq!(Points::parse(turned, "p.csv").unwrap(), points);
    let chord = "push_chord_deg,side,distance_mm\n1.5e1,cb,15.5\n";
    let chord = Points::parse(chord, "p.csv").unwrap();
    assert_eq!(
        (chord.angle, chord.have_deviations, chord.points[0].sd_deg),
        (Angle::Chord, false, 1.0)
    );
}

/// Lines are those of the file, whatever stands between the points and however it was saved.
#[test]
fn lines_are_counted_as_an_editor_does() {
    let text = "\u{feff}# measured\r\n\r\n\"side\", distance_mm,push_angle_deg\r\n# first day\r\ncb, 15.5 ,16\r\n\r\ncf,12,far";
    assert_eq!(
        refused(text),
        "p.csv:7: push_angle_deg = far: must be a number between -360 and 360"
    );
}

#[test]
fn what_is_wrong_is_told() {
    let with = |old: &str, new: &str| {
        let text = GOOD.replacen(old, new, 1);
        assert_ne!(text, GOOD);
        refused(&text)
    };
    let columns = "side, distance_mm, push_angle_deg, push_chord_deg, kind, sd_deg";
    assert_eq!(
        refused(""),
        format!("p.csv: is empty: must have columns of {columns}")
    );
    assert_eq!(
        refused("side,distance_mm,push_angle_deg\n"),
        "p.csv: has no points: must have at least one line below its header"
    );
    assert_eq!(
        with("sd_deg", "error"),
        format!("p.csv:1: unknown column \"error\": must be one of {columns}")
    );
    assert_eq!(
        with("sd_deg", "kind"),
        "p.csv:1: column kind: must be there once"
    );
    assert_eq!(
        with("side", "sd_deg"),
        "p.csv:1: column sd_deg: must be there once"
    );
    assert_eq!(
        refused("distance_mm,push_angle_deg\n15,16\n"),
        "p.csv:1: missing column side"
    );
    assert_eq!(
        refused("side,push_angle_deg\ncb,16\n"),
        "p.csv:1: missing column distance_mm"
    );
    assert_eq!(
        refused("side,distance_mm\ncb,15\n"),
        "p.csv:1: missing column push_angle_deg, or push_chord_deg in its place"
    );
    assert_eq!(
        with("kind", "push_chord_deg"),
        "p.csv:1: push_angle_deg and push_chord_deg: must be one of them"
    );
    assert_eq!(
        with("cb,", "left,"),
        "p.csv:2: side = left: must be cb or cf"
    );
    assert_eq!(
        with("slip-off", "slip"),
        "p.csv:2: kind = slip: must be slip-off, pull-off or empty"
    );
    for (number, must) in [("15.5", "distance_mm"), ("0.5\n", "sd_deg")] {
        for bad in ["far", "", "0", "-1", "nan", "inf", "1e999"] {
            let new = if number.ends_with('\n') {
                format!("{bad}\n")
            } else {
                bad.to_owned()
            };
            assert_eq!(
                with(number, &new),
                format!("p.csv:2: {must} = {bad}: must be a positive number")
            );
        }
    }
    for bad in ["far", "", "361", "-inf", "NaN"] {
        assert_eq!(
            with(",16,", &format!(",{bad},")),
            format!("p.csv:2: push_angle_deg = {bad}: must be a number between -360 and 360")
        );
    }
    assert_eq!(
        with("cf,12", "12"),
        "p.csv:3: has 4 cells: must have 5, one a column"
    );
    assert_eq!(
        with("cf,12", "cf,12,12"),
        "p.csv:3: has 6 cells: must have 5, one a column"
    );
    let long = with("cb,", &format!("{},", "x".repeat(100_000)));
    assert!(long.len() < 200, "{long}");
}

#[test]
fn files_that_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.csv");
    let said = |path: &std::path::Path| Points::read(path).unwrap_err().to_string();
    assert!(said(&path).contains("p.csv: cannot be read: No such file"));
    std::fs::write(&path, b"side,distance_mm,push_angle_deg\ncb,1\xff,2\n").unwrap();
    assert!(said(&path).ends_with("p.csv:2: not UTF-8 text: byte 0xFF"));
    std::fs::write(&path, vec![b'#'; (1 << 20) + 1]).unwrap();
    assert!(said(&path).ends_with("p.csv: cannot be read: longer than 1 MiB"));
    std::fs::write(&path, GOOD).unwrap();
    assert_eq!(Points::read(&path).unwrap().points.len(), 2);
}

/// In any order, with repeats, on both sides; distances that no resting whisker reaches are refused.
#[test]
fn points_are_compared_one_by_one() {
    let text = "side,distance_mm,push_angle_deg,kind\n\
                cb,19.5,3,slip-off\ncb,15.66,15,slip-off\ncf,15.66,-29,\ncb,15.66,17,pull-off\n";
    let points = Points::parse(text, "p.csv").unwrap();
    let scene = cone();
    let whisker = scene.first_whisker().whisker;
    points.check_reach(&whisker, &scene.pole).unwrap();
    let beside = points.beside(&whisker, &scene.pole);
    let [far, first, cf, again] = beside.rows[..] else {
        panic!()
    };
    assert_eq!((far.line, far.predicted_kind), (2, DetachmentKind::PullOff));
    assert_eq!((cf.side, cf.kind), (Side::Cf, None));
    let slip = first.predicted_deg.unwrap();
    assert!(
        (slip - 15.6094).abs() < 1e-3 && again.predicted_deg == Some(slip),
        "{slip}"
    );
    assert_eq!(
        (first.residual_deg, again.residual_deg),
        (Some(15.0 - slip), Some(17.0 - slip))
    );
    assert_eq!(
        (
            beside.count(),
            beside.of_another_kind(),
            beside.left_out().count()
        ),
        (4, 2, 0)
    );
    let residuals: Vec<f64> = beside
        .rows
        .iter()
        .map(|row| row.residual_deg.unwrap())
        .collect();
    let mean = residuals.iter().sum::<f64>() / 4.0;
    let square = residuals.iter().map(|own| own * own).sum::<f64>() / 4.0;
    assert!((beside.bias_deg().unwrap() - mean).abs() < 1e-12);
    assert!((beside.rms_deg().unwrap() - square.sqrt()).abs() < 1e-12);

    for (distance, allowed) in [
        ("19.9", false),
        ("0.25", false),
        ("0.26", true),
        ("0.01", false),
    ] {
        let points = Points::parse(&text.replace("19.5", distance), "p.csv").unwrap();
        let checked = points
            .check_reach(&whisker, &scene.pole)
            .map_err(|why| why.to_string());
        assert_eq!(checked.is_ok(), allowed, "{distance}");
        if let Err(said) = checked {
            let start = format!(
                "p.csv:2: distance_mm = {distance}: must be between 0.02 (length_mm / 1000) and 19."
            );
            assert!(said.starts_with(&start), "{said}");
            assert!(
                said.ends_with(
                    "(the tip of the resting whisker), and more than 0.25 (pole.radius_mm)"
                ),
                "{said}"
            );
        }
    }
}
