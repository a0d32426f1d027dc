//! `whiskmap fit`: best values that are not a fit.

use super::data::{DATA, place};
use super::fit::{FIT, fit, json};
use super::{Run, names, words};
use serde_json::Value;

/// Data in radians are not a fit: exit code 1, and no file except the JSON.
#[test]
fn values_that_are_not_a_fit_are_reported() {
    let place = place();
    let text = "side,distance_mm,push_angle_deg,sd_deg\ncf,10,-0.859,0.01\ncf,15,-0.508,0.01\ncb,10,0.7,0.01\ncb,15,0.33,0.01\n";
    place.write("points.csv", text);
    let more = words("--free tip_radius_um -o fitted.toml --json fit.json");
    let run = place.run(&[&FIT[..], &more].concat());
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(run.out.contains("\nnot a fit\n"), "{run:?}");
    let line = run.out.lines().find(|line| line.starts_with("tip_radius_um"));
    assert!(line.unwrap().ends_with("not a fit"), "{run:?}");
    for part in [
        "error: not a fit: RMS ",
        "reduced chi-square ",
        "all measured angles are below 6.3, predicted ones are tens: are they in radians?; fitted.toml is not written\n",
    ] {
        assert!(run.err.contains(part), "no {part:?} in {run:?}");
    }
    assert_eq!(names(&place.path("")), ["fit.json", "points.csv", "scene.toml"]);
    let found = json(&place, "fit.json");
    assert_eq!(found["standard_errors"]["tip_radius_um"], Value::Null);
    assert!(found["not_a_fit"].as_str().unwrap().starts_with("not a fit: RMS "));
    let streamed = place.run(&[&FIT[..], &more[..2], &["-o", "-"]].concat());
    streamed.assert_said(1, "radians?; no scene is written to standard output\n");
    assert!(streamed.out.contains("\nnot a fit\n"), "{streamed:?}");
    let both = [&FIT[..], &more[..2], &["-o", "-", "--json", "fit.json"]].concat();
    assert!(place.run(&both).out.ends_with("\nfit.json\n"));

    // The reader of standard output has ended.
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut closed = place.plain_command(&[&FIT[..], &more[..2]].concat());
    let run = Run::of(&closed.stdout(writer).output().unwrap());
    run.assert_said(1, "error: not a fit: RMS ");

    // Deviations can be too small for a good fit.
    place.write(
        "points.csv",
        &DATA
            .replace("deg\n", "deg,sd_deg\n")
            .replace(".2\n", ".2,0.25\n")
            .replace(".1\n", ".1,0.25\n")
            .replace(".9\n", ".9,0.25\n")
            .replace(".3\n", ".3,0.25\n")
            .replace(".4\n", ".4,0.25\n"),
    );
    let run = fit(&place, &["--free", "tip_radius_um"]);
    assert!(
        run.err.contains(
            " times as large as sd_deg: standard errors are too small by about that factor\n"
        ),
        "{run:?}"
    );
}
