//! `whiskmap fit`.

use super::data::{DATA, curve, place};
use super::{Place, Run, SCENE, names, no_folder, words};
use serde_json::Value;
use whiskmap::scene::Scene;

pub const FIT: [&str; 4] = ["fit", "scene.toml", "--data", "points.csv"];

pub fn fit(place: &Place, more: &[&str]) -> Run {
    place.good(&[&FIT, more].concat())
}

pub fn json(place: &Place, name: &str) -> Value {
    serde_json::from_slice(&place.bytes(name)).unwrap()
}

/// Formats a number as tables have statistics.
fn four_digits(value: f64) -> String {
    format!("{value:.3e}").parse::<f64>().unwrap().to_string()
}

#[test]
fn table_scene_and_document_agree() {
    let place = place();
    let free = ["--free", "parabola_per_mm,tip_radius_um"];
    let files = ["-o", "fitted.toml", "--json", "fit.json"];
    let run = fit(&place, &[&free[..], &files].concat());
    assert_eq!(run.err, "");
    assert!(run.out.ends_with("\nfitted.toml\nfit.json\n"), "{run:?}");
    let found = json(&place, "fit.json");
    let mut keys: Vec<&String> = found.as_object().unwrap().keys().collect();
    keys.sort_unstable();
    let wanted = words(
        "bias_deg chi_square correlation degrees_of_freedom left_out loss not_a_fit points pulls \
         rms_deg smooth_radii standard_errors traced values",
    );
    assert_eq!(keys, wanted);
    let fitted = Scene::read(place.path("fitted.toml")).unwrap();
    let whisker = &fitted.whisker;
    let bent = whisker.curvature.unwrap().parabola_per_mm;
    for (name, value) in [("tip_radius_um", whisker.tip_radius_um), ("parabola_per_mm", bent)] {
        assert_eq!(found["values"][name], value);
        let error = found["standard_errors"][name].as_f64().unwrap();
        let line = run.out.lines().find(|line| line.starts_with(name)).unwrap();
        let words: Vec<&str> = line.split_whitespace().collect();
        assert_eq!(words[2], "+-");
        // The last digit of the error is that of the value.
        let [estimate, of_error] = [words[1], words[3]].map(|word| word.parse::<f64>().unwrap());
        let places = words[3].split('.').nth(1).unwrap().len();
        assert_eq!(words[1].split('.').nth(1).unwrap().len(), places);
        let half = 0.5 * 10_f64.powi(-(places as i32)) * (1.0 + 1e-9);
        assert!((estimate - value).abs() <= half && (of_error - error).abs() <= half, "{line}");
        assert!(half < 0.2 * error, "{line}");
        assert!(error > 0.0);
    }
    assert!((1.5..2.5).contains(&whisker.tip_radius_um), "{}", whisker.tip_radius_um);
    let correlation = &found["correlation"];
    assert_eq!(correlation["tip_radius_um"]["tip_radius_um"], 1.0);
    assert_eq!(
        correlation["tip_radius_um"]["parabola_per_mm"],
        correlation["parabola_per_mm"]["tip_radius_um"]
    );
    let between = correlation["tip_radius_um"]["parabola_per_mm"].as_f64().unwrap();
    assert!(run.out.contains(&format!(
        "correlation of parabola_per_mm and tip_radius_um: {}\n",
        four_digits(between)
    )));
    let chi_square = found["chi_square"].as_f64().unwrap();
    assert!(
        run.out
            .contains(&format!("chi-square: {}, 4 degrees of freedom\n", four_digits(chi_square)))
    );
    let points = found["points"].as_array().unwrap();
    let square = |point: &Value| point["residual_deg"].as_f64().unwrap().powi(2);
    let squares: f64 = points.iter().map(square).sum();
    assert_eq!(points.len(), 6);
    assert!((squares / chi_square - 1.0).abs() < 1e-12, "deviations are 1 degree");
    assert!((found["rms_deg"].as_f64().unwrap() - (squares / 6.0).sqrt()).abs() < 1e-12);
    assert!(run.out.contains("points compared: 6, 0 left out, 0 of another kind than predicted\n"));

    // A second fit stays at the fitted scene; equal runs write equal bytes.
    let bytes = place.bytes("fit.json");
    fit(&place, &[&free[..], &files].concat());
    assert!(bytes == place.bytes("fit.json"), "not deterministic");
    let start = words("fit fitted.toml --data points.csv --json again.json");
    place.good(&[&start[..], &free].concat());
    let again = json(&place, "again.json");
    let [one, other] = [&found, &again].map(|fit| fit["values"]["tip_radius_um"].as_f64().unwrap());
    assert!((one / other - 1.0).abs() < 1e-5, "{one} {other}");
}

#[test]
fn standard_output_takes_one_of_them() {
    let place = place();
    let free = ["--free", "tip_radius_um"];
    let run = fit(&place, &[&free[..], &["-o", "-"]].concat());
    assert!(Scene::parse(&run.out, "fitted.toml").is_ok(), "{run:?}");
    let run = fit(&place, &[&free[..], &["--json", "-", "-o", "fitted.toml"]].concat());
    assert!(serde_json::from_str::<Value>(&run.out).is_ok(), "{run:?}");
    let both = [&FIT[..], &free, &["--json", "-", "-o", "-"]].concat();
    place.run(&both).assert_refused(&["--output - and --json -: must be two files"]);
}

#[test]
fn what_is_not_determined_is_null() {
    let place = place();
    let more = words(
        "--free youngs_modulus_gpa,base_radius_um,pole_radius_mm,tip_radius_um --json fit.json",
    );
    let run = fit(&place, &more);
    let found = json(&place, "fit.json");
    for name in ["youngs_modulus_gpa", "base_radius_um", "tip_radius_um"] {
        assert!(
            run.err.contains(&format!("warning: {name}: not determined by these points\n")),
            "{run:?}"
        );
        assert!(
            run.out.lines().any(|line| line.starts_with(name) && line.ends_with("not determined")),
            "{run:?}"
        );
        assert_eq!(found["standard_errors"][name], Value::Null);
        assert_eq!(found["correlation"]["pole_radius_mm"][name], Value::Null);
    }
    assert!(!run.err.contains("pole_radius_mm: not"), "{run:?}");
    assert!(found["standard_errors"]["pole_radius_mm"].is_f64());
}

#[test]
fn limits_and_signs_are_reported() {
    let place = place();
    place.write("points.csv", &DATA.replace("49.2", "43").replace("-29.1", "29.1"));
    let run = place.run(&[&FIT[..], &["--free", "pole_radius_mm"]].concat());
    let signs = "warning: 1 of 6 points in points.csv have an angle of the other side's sign: it is positive for cb, negative for cf\n";
    assert!(run.err.contains(signs), "{run:?}");
    // Thinner poles detach earlier, up to a point.
    let early = DATA.replace("49.2", "43").replace("40.1", "35");
    place.write("points.csv", &early.replace("19.3,4.3", "19.3,1"));
    let run = fit(&place, &["--free", "pole_radius_mm"]);
    let limit = "warning: pole_radius_mm: 0 is the last value that the scene accepts, so there is no standard error\n";
    assert_eq!(run.err, limit);
    let line = run.out.lines().find(|line| line.starts_with("pole_radius_mm"));
    assert!(line.unwrap().ends_with(" 0, at its limit"), "{run:?}");
}

/// The points go farther than the scene's whisker, and a name may be given twice.
#[test]
fn a_note_gives_a_start_that_reaches_all_points() {
    let place = place();
    place.write("scene.toml", &SCENE.replace("length_mm = 20", "length_mm = 18"));
    let free = ["--free", "length_mm,parabola_per_mm,length_mm"];
    let run = fit(&place, &[&free[..], &["-o", "fitted.toml"]].concat());
    let note =
        "note: points.csv:7: 19.3 mm is out of reach of the scene's whisker: length_mm starts at ";
    assert!(run.err.starts_with(note), "{run:?}");
    assert!(run.err.contains(" instead of 18\n"), "{run:?}");
    assert_eq!(run.out.matches("\nlength_mm").count(), 1, "{run:?}");
    let beside = place.run(&["curve", "fitted.toml", "--data", "points.csv"]);
    assert!(beside.err.contains("points compared: 6, 0 left out"), "{beside:?}");
}

#[test]
fn wrong_input_is_refused_before_any_file_is_made() {
    let place = place();
    let refused =
        |more: &[&str], parts: &[&str]| place.run(&[&FIT, more].concat()).assert_refused(parts);
    refused(&[], &["--free"]);
    refused(
        &["--free", "tip_radius"],
        &[
            "'tip_radius'",
            "--free",
            "possible values: length_mm, base_radius_um,",
            "a similar value exists: 'tip_radius_um'",
        ],
    );
    refused(
        &["--free", "curvature_per_mm"],
        &["'curvature_per_mm'", "did you mean `parabola_per_mm`?"],
    );
    refused(
        &["--free", "friction", "-o", "f.toml"],
        &["--free friction: the scene has no contact.friction; give it a value"],
    );
    refused(
        &["--free", "taper,tip_radius_um"],
        &["--free taper and tip_radius_um: both are whisker.tip_radius_um"],
    );
    refused(
        &["--free", "taper", "-o", "nowhere/f.toml"],
        &[&format!("--output nowhere/f.toml: {}", no_folder())],
    );
    refused(
        &["--free", "taper", "-o", "f", "--json", "f"],
        &["--output f and --json f: must be two files"],
    );
    let data = |text: &str, parts: &[&str]| {
        place.write("points.csv", text);
        refused(&["--free", "taper", "-o", "f.toml"], parts);
        curve(&place, &["--csv", "t.csv"]).assert_refused(parts);
    };
    data(
        &DATA.replace("19.3,", "25,"),
        &["points.csv:7: distance_mm = 25: must be between 0.02 (length_mm / 1000) and 19.6"],
    );
    place.write("points.csv", "side,distance_mm,push_angle_deg\ncb,15,18\n");
    let few = "2 free parameters need as many points: points.csv has 1 that detach";
    refused(&["--free", "taper,pole_radius_mm"], &[few]);
    place
        .run(&words("fit scene.toml --free taper --data nowhere.csv"))
        .assert_refused(&["nowhere.csv: cannot be read"]);
    place.write("sweep.toml", &SCENE.replace("[grid]", "[grid]\ncurvature_per_mm = [0.01, 0.02]"));
    for command in [&["fit", "--free", "taper"][..], &["curve"]] {
        let run = place.run(&[command, &["sweep.toml", "--data", "points.csv"]].concat());
        run.assert_refused(&["grid.curvature_per_mm: the scene sweeps 2 whiskers"]);
    }
    curve(&place, &["--corner"]).assert_refused(&["--data", "--corner"]);
    assert_eq!(names(&place.path("")), ["points.csv", "scene.toml", "sweep.toml"]);
}

/// A point with a missing number is a row with its reason, and the others are fitted as without it.
#[test]
fn points_with_a_missing_number_are_left_out() {
    let place = place();
    let points = place.text("points.csv");
    let options = ["--free", "tip_radius_um", "--json", "fit.json"];
    fit(&place, &options);
    let whole = json(&place, "fit.json");
    place.write("points.csv", &format!("{}\n,cb,,12\n,cf,9,NaN\n", points.trim_end()));
    let run = fit(&place, &options);
    assert!(
        run.err.contains(
            "2 of 8 points in points.csv have a missing value and are left out: lines 9, 10"
        ),
        "{run:?}"
    );
    let found = json(&place, "fit.json");
    assert_eq!(found["values"], whole["values"]);
    assert_eq!(found["left_out"], 0);
    let rows = found["points"].as_array().unwrap();
    let reasons: Vec<&Value> = rows.iter().map(|row| &row["reason"]).collect();
    assert_eq!(reasons[5..], [&Value::Null, &Value::from("missing"), &Value::from("missing")]);
    assert_eq!(rows[6]["measured_deg"], 12.0);
    assert_eq!(rows[7]["distance_mm"], 9.0);
    let beside = place.run(&["curve", "scene.toml", "--data", "points.csv"]);
    assert!(beside.out.ends_with(",missing\n"), "{beside:?}");
    place.write("points.csv", "side,distance_mm,push_angle_deg\ncb,,12\n");
    place.run(&[&FIT[..], &options].concat()).assert_refused(&[
        "points.csv: has no row with all of its values: must have at least one with side, distance_mm, push_angle_deg or push_chord_deg",
    ]);
}

/// Points of two whiskers of a table: both together, and those of one alone.
#[test]
fn points_of_whiskers_share_the_fitted_values() {
    let place = place();
    let table = "[whiskers]\ntable = [{ name = \"C1\", length_mm = 20 }, { name = \"C2\", length_mm = 24 }]\n";
    let scene = SCENE.replace("length_mm = 20\n", "");
    assert_ne!(scene, SCENE);
    place.write("scene.toml", &format!("{scene}{table}"));
    let mut text = "whisker,side,distance_mm,push_angle_deg\n".to_owned();
    for (name, distance) in [("C1", "9"), ("C2", "12"), ("C1", "12"), ("C2", "8")] {
        let at = ["--at", &format!("whisker={name}"), "--distance", distance];
        let csv = place.run(&[&["curve", "scene.toml"], &at[..]].concat()).out;
        let mut lines = csv.lines().map(|line| line.split(','));
        let header: Vec<&str> = lines.next().unwrap().collect();
        let column = |name: &str| header.iter().position(|column| *column == name).unwrap();
        for line in lines {
            let cells: Vec<&str> = line.collect();
            let push_deg = cells[column("push_angle_deg")];
            text += &format!("{name},{},{distance},{push_deg}\n", cells[column("side")]);
        }
    }
    place.write("points.csv", &text);
    let free = ["--free", "tip_radius_um,pole_radius_mm"];
    let files = ["-o", "fitted.toml", "--json", "fit.json"];
    fit(&place, &[&free[..], &files].concat());
    let found = json(&place, "fit.json");
    assert_eq!(found["points"].as_array().unwrap().len(), 8);
    let start = Scene::read(place.path("scene.toml")).unwrap();
    let tip_um = found["values"]["tip_radius_um"].as_f64().unwrap();
    assert!((tip_um / start.whisker.tip_radius_um - 1.0).abs() < 1e-6);
    let fitted = Scene::read(place.path("fitted.toml")).unwrap();
    assert_eq!(fitted.whisker.tip_radius_um, tip_um);
    assert_eq!(fitted.table_rows(), start.table_rows());
    fit(&place, &[&free[..], &files, &["--at", "whisker=C2"]].concat());
    assert_eq!(json(&place, "fit.json")["points"].as_array().unwrap().len(), 4);
    let curve = ["curve", "scene.toml", "--data", "points.csv"];
    let beside = place.run(&[&curve[..], &["--at", "whisker=C1"]].concat());
    assert_eq!((beside.code, beside.out.lines().count()), (Some(0), 5));
    place.run(&curve).assert_refused(&["curve --data needs one; select it by --at whisker=VALUE"]);
    place
        .run(&["reproduce", "figures", "--fig4d", "points.csv"])
        .assert_refused(&["--fig4d points.csv: has a column whisker"]);
    place.write("nameless.csv", "side,distance_mm,push_angle_deg\ncb,9,20\n");
    let nameless = words("fit scene.toml --data nameless.csv --free tip_radius_um");
    place.run(&nameless).assert_refused(&[
        "fit needs one; select it by --at whisker=VALUE, or name the whisker of each point in a column whisker of --data",
    ]);
}
