//! Files of points, and points beside the theory.

use super::cone;
use crate::program::no_file;
use whiskmap::Side;
use whiskmap::measured::{MeasuredAngle, MeasuredPoints};
use whiskmap::trace::DetachmentKind;

const GOOD: &str =
    "side,distance_mm,push_angle_deg,kind,sd_deg\ncb,15.5,16,slip-off,0.5\ncf,12,-41,,0.7\n";

fn refused(text: &str) -> String {
    MeasuredPoints::parse(text, "p.csv").unwrap_err().to_string()
}

#[test]
fn columns_come_in_any_order() {
    let points = MeasuredPoints::parse(GOOD, "p.csv").unwrap();
    assert_eq!((points.angle, points.have_deviations), (MeasuredAngle::Push, true));
    let [cb, cf] = points.points[..] else { panic!() };
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
    assert_eq!(MeasuredPoints::parse(turned, "p.csv").unwrap(), points);
    let chord = "push_chord_deg,side,distance_mm\n1.5e1,cb,15.5\n";
    let chord = MeasuredPoints::parse(chord, "p.csv").unwrap();
    assert_eq!(
        (chord.angle, chord.have_deviations, chord.points[0].sd_deg),
        (MeasuredAngle::Chord, false, 1.0)
    );
}

/// Lines are those of the file, whatever stands between the points and however it was saved.
#[test]
fn lines_are_counted_as_an_editor_does() {
    let text = "\u{feff}# measured\r\n\r\n\"side\", distance_mm,push_angle_deg\r\n# first day\r\ncb, 15.5 ,16\r\n\r\ncf,12,far";
    assert_eq!(
        refused(text),
        "p.csv:7: push_angle_deg = far: must be a number between -360 and 360, or empty where it is missing"
    );
}

#[test]
fn missing_values_have_several_spellings() {
    for missing in ["", "NA", "n/a", "NaN", "nan", "null", "None"] {
        let text = format!("side,distance_mm,push_angle_deg\ncb,15.5,16\ncb,15.6,{missing}\n");
        let points = MeasuredPoints::parse(&text, "p.csv").unwrap();
        assert_eq!(points.points.len(), 1, "{missing}");
    }
}

#[test]
fn errors_name_the_line_the_value_and_what_is_allowed() {
    let with = |old: &str, new: &str| {
        let text = GOOD.replacen(old, new, 1);
        assert_ne!(text, GOOD);
        refused(&text)
    };
    let columns = "side, distance_mm, push_angle_deg or push_chord_deg";
    let rows = "p.csv: has no rows: must have a header and at least one row below it";
    assert_eq!(refused(""), rows);
    assert_eq!(refused("side,distance_mm,push_angle_deg\n"), rows);
    for (old, new) in
        [("kind", "push_chord_deg"), ("distance_mm", "distance"), ("push_angle_deg", "angle")]
    {
        let header = GOOD.lines().next().unwrap();
        let found = header.replacen(old, new, 1).replace(',', ", ");
        let said = format!("p.csv:1: found {found}; needed {columns}, each once");
        let why = with(old, new);
        assert!(why.starts_with(&said), "{why}");
    }
    for (old, new) in [("sd_deg", "kind"), ("side", "sd_deg")] {
        let twice = format!("p.csv:1: has the column {new} 2 times: must have it once");
        assert_eq!(with(old, new), twice);
    }
    let hint = "; `distance` is not known; did you mean `distance_mm`?";
    assert!(with("distance_mm", "distance").ends_with(hint));
    let unit = "; `distance_cm` is not known; values must be in mm: convert them, and use the name `distance_mm`";
    assert!(with("distance_mm", "distance_cm").ends_with(unit));
    assert!(with("side", "\u{1b}[31mside").contains(r"found \u{1b}[31mside"));
    assert_eq!(with("cb,", "left,"), "p.csv:2: side = left: must be cb or cf");
    assert_eq!(
        with("slip-off", "slip"),
        "p.csv:2: kind = slip: must be slip-off, pull-off or empty"
    );
    for (number, name, must) in [
        ("15.5", "distance_mm", "a positive number, or empty where it is missing"),
        ("0.5\n", "sd_deg", "a number between 1e-6 and 360, or empty where it is missing"),
    ] {
        for bad in ["far", "0", "-1", "inf", "1e999"] {
            let new = if number.ends_with('\n') { format!("{bad}\n") } else { bad.to_owned() };
            assert_eq!(with(number, &new), format!("p.csv:2: {name} = {bad}: must be {must}"));
        }
    }
    for bad in ["far", "361", "-inf"] {
        assert_eq!(
            with(",16,", &format!(",{bad},")),
            format!(
                "p.csv:2: push_angle_deg = {bad}: must be a number between -360 and 360, or empty where it is missing"
            )
        );
    }
    assert_eq!(with("cf,12", "12"), "p.csv:3: has 4 cells: must have 5, one a column");
    assert_eq!(with("cf,12", "cf,12,far"), "p.csv:3: has 6 cells: must have 5, one a column");
    let commas = "; where numbers have decimal commas, separate columns by `;`";
    assert_eq!(
        with("cb,15.5", "cb,15,66"),
        format!("p.csv:2: has 6 cells: must have 5, one a column{commas}")
    );
    assert_eq!(with("cf,12,-41,,0.7", "cf"), "p.csv:3: has 1 cell: must have 5, one a column");
    assert!(
        with("0.5\n", "1e-7\n")
            .ends_with("must be a number between 1e-6 and 360, or empty where it is missing")
    );
    let long = with("cb,", &format!("{},", "x".repeat(100_000)));
    assert!(long.len() < 200, "{long}");
}

/// One table in the formats of spreadsheet programs of several countries.
#[test]
fn separators_decimal_commas_and_encodings() {
    let wanted = MeasuredPoints::parse(GOOD, "p.csv").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.csv");
    let read = |bytes: Vec<u8>| {
        std::fs::write(&path, bytes).unwrap();
        let points = MeasuredPoints::read(&path).unwrap();
        assert_eq!((&points.points, points.note), (&wanted.points, None));
    };
    let semicolons = GOOD.replace(',', ";").replace('.', ",");
    for text in [
        GOOD,
        &GOOD.replace(',', ";"),
        &GOOD.replace(',', "\t"),
        &semicolons,
        &semicolons.replace(';', "\t"),
        &GOOD.replace("cb", "CB").replace("cf", "Cf"),
        &GOOD.replace("side", "\"side\"").replace('\n', "\r\n"),
        &GOOD.replace('\n', "\r"),
        &GOOD.replace('\n', ",,\n").replace("deg,,", "deg"),
    ] {
        let marked = format!("\u{feff}{text}");
        read(text.as_bytes().to_vec());
        read(marked.as_bytes().to_vec());
        read(marked.encode_utf16().flat_map(u16::to_le_bytes).collect());
        read(marked.encode_utf16().flat_map(u16::to_be_bytes).collect());
    }
    let refused = |bytes: &[u8], said: &str| {
        std::fs::write(&path, bytes).unwrap();
        let why = MeasuredPoints::read(&path).unwrap_err().to_string();
        assert!(why.ends_with(said), "{why}");
    };
    let half = "p.csv:2: not UTF-16LE text: half a character at the end";
    refused(b"\xff\xfe\n\0i", half);
    let code = "p.csv:1: not UTF-16BE text: code 0xD800";
    refused(b"\xfe\xff\xd8\0\0a", code);
    // A column has one decimal mark, and a comma that separates columns is none.
    let mixed = semicolons.replace("12;", "12.0;");
    let said = "p.csv:3: distance_mm = 12.0: must be a positive number, or empty where it is missing; this column has decimal commas";
    refused(mixed.as_bytes(), said);
    let quoted = GOOD.replace("15.5", "\"15,5\"");
    let said = "p.csv:2: distance_mm = 15,5: must be a positive number, or empty where it is missing; where numbers have decimal commas, separate columns by `;`";
    refused(quoted.as_bytes(), said);
}

/// A carriage return alone ends a line; of as many semicolons as commas, semicolons separate columns.
#[test]
fn lines_and_columns_of_rare_files() {
    let header = "side;distance_mm;push_angle_deg;a,b,c";
    let text = format!("{header}\rcb;15,5;16;\r# none\rcf;12;far;\r");
    let why = "p.csv:4: push_angle_deg = far: must be a number between -360 and 360, or empty where it is missing";
    assert_eq!(refused(&text), why);
    let declared = format!("sep=;\n{header}\ncb;15,5;far;\n");
    assert!(refused(&declared).starts_with("p.csv:3: push_angle_deg = far"));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.csv");
    std::fs::write(&path, b"side\rcb\xff").unwrap();
    let why = MeasuredPoints::read(&path).unwrap_err().to_string();
    assert!(why.ends_with("p.csv:2: not UTF-8 text: byte 0xFF"), "{why}");
}

/// Columns that are not used may hold anything, line breaks too.
#[test]
fn columns_that_are_not_used_are_noted_once() {
    let text = "rat,side,weight,distance_mm,push_angle_deg,note,\nA,cb,1,15.5,16,\"two\nlines\",\n,,,,,,\n \nB,cf,1,12,-41,,\n";
    let text = text.replace("\n \n", "\n\n");
    let points = MeasuredPoints::parse(&text, "p.csv").unwrap();
    let note = "p.csv:1: columns that are not used: rat, weight, note";
    assert_eq!(points.note.as_deref(), Some(note));
    let lines: Vec<usize> = points.points.iter().map(|point| point.line).collect();
    assert_eq!((lines, points.have_deviations), (vec![2, 6], false));
    let why = "p.csv:6: distance_mm = far: must be a positive number, or empty where it is missing";
    assert_eq!(refused(&text.replace("12,", "far,")), why);
}

#[test]
fn files_that_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.csv");
    let said = |path: &std::path::Path| MeasuredPoints::read(path).unwrap_err().to_string();
    assert!(said(&path).ends_with(&format!("p.csv: cannot be read: {}", no_file())));
    std::fs::write(&path, b"side,distance_mm,push_angle_deg\ncb,1\xff,2\n").unwrap();
    assert!(said(&path).ends_with("p.csv:2: not UTF-8 text: byte 0xFF"));
    std::fs::write(&path, vec![b'#'; (32 << 20) + 1]).unwrap();
    assert!(said(&path).ends_with("p.csv: cannot be read: longer than 32 MiB"));
    std::fs::write(&path, GOOD).unwrap();
    assert_eq!(MeasuredPoints::read(&path).unwrap().points.len(), 2);
}

/// In any order, with repeats, on both sides; distances that no resting whisker reaches are refused.
#[test]
fn points_are_compared_one_by_one() {
    let text = "side,distance_mm,push_angle_deg,kind\n\
                cb,19.5,3,slip-off\ncb,15.66,15,slip-off\ncf,15.66,-29,\ncb,15.66,17,pull-off\n";
    let points = MeasuredPoints::parse(text, "p.csv").unwrap();
    let scene = cone();
    let whisker = scene.first_whisker().whisker;
    points.check_reach(&whisker, &scene.pole).unwrap();
    let beside = points.beside(&whisker, &scene.pole);
    let [far, first, cf, again] = beside.rows[..] else { panic!() };
    assert_eq!((far.line, far.predicted_kind), (2, Some(DetachmentKind::PullOff)));
    assert_eq!((cf.side, cf.kind), (Side::Cf, None));
    let slip = first.predicted_deg.unwrap();
    assert!((slip - 15.6094).abs() < 1e-3 && again.predicted_deg == Some(slip), "{slip}");
    assert_eq!((first.residual_deg, again.residual_deg), (Some(15.0 - slip), Some(17.0 - slip)));
    assert_eq!((beside.count(), beside.of_another_kind(), beside.left_out().count()), (4, 2, 0));
    let residuals: Vec<f64> = beside.rows.iter().map(|row| row.residual_deg.unwrap()).collect();
    let mean = residuals.iter().sum::<f64>() / 4.0;
    let square = residuals.iter().map(|residual| residual * residual).sum::<f64>() / 4.0;
    assert!((beside.bias_deg().unwrap() - mean).abs() < 1e-12);
    assert!((beside.rms_deg().unwrap() - square.sqrt()).abs() < 1e-12);

    for (distance, allowed) in
        [("19.9", false), ("0.25", false), ("0.26", true), ("0.01", false), ("1e160", false)]
    {
        let points = MeasuredPoints::parse(&text.replace("19.5", distance), "p.csv").unwrap();
        let checked = points.check_reach(&whisker, &scene.pole).map_err(|why| why.to_string());
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
