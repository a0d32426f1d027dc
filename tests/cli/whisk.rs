//! `whiskmap whisk`.

use super::traces::cells;
use super::{Place, SCENE, words};

const AT: [&str; 4] = ["whisk", "scene.toml", "--distance", "15.66"];

fn whisk(place: &Place, more: &[&str]) -> super::Run {
    place.run(&[&AT[..], more].concat())
}

/// The first event of a sine is the slip-off of `curve`; a file with the same angles gives the same table.
#[test]
fn a_sine_and_its_angles_give_one_course() {
    let place = Place::with(SCENE);
    let sine = ["--sine", "40deg, 10, 0.1", "--rate", "500"];
    let run = whisk(
        &place,
        &[&sine[..], &["--events", "e.csv", "--csv", "s.csv", "--plot", "w.svg"]].concat(),
    );
    assert_eq!((run.code, &*run.out), (Some(0), "s.csv\nw.svg\ne.csv\n"), "{run:?}");
    assert!(run.err.contains("slip-offs 2, pull-offs 0; detachments lose 9.68466 nJ"), "{run:?}");
    let header = "time_s,event,side,angle_deg,push_angle_deg,force_un,contact_force_un,base_moment_nnm,energy_nj,snaps_deg";
    let events = place.text("e.csv");
    let events = cells(&events, header);
    let kinds: Vec<_> = events.iter().map(|event| [event[1], event[2]]).collect();
    assert_eq!(kinds, [["touch", "cb"], ["slip-off", "cb"], ["touch", "cf"], ["slip-off", "cf"]]);
    let curve = place.quiet(&["curve", "scene.toml", "--distance", "15.66"]).out;
    let end: Vec<&str> = curve.lines().nth(2).unwrap().split(',').collect();
    let [push, wanted]: [f64; 2] = [events[1][3], end[4]].map(|cell| cell.parse().unwrap());
    assert!((push - wanted).abs() < 1e-9, "{push} {wanted}");
    // A table on standard output stays alone there.
    let piped = whisk(&place, &[&sine[..], &["--events", "e.csv"]].concat());
    assert_eq!(piped.out, place.text("s.csv"), "{piped:?}");
    let svg = place.text("w.svg");
    for label in [
        "angle of the base (deg)",
        "contact force (\u{b5}N)",
        "bending moment at the base (nN m)",
        "slip-off",
    ] {
        assert!(svg.contains(&format!(">{label}<")), "{label}");
    }
    // The three plots share one axis of times, on paper, too.
    assert_eq!(svg.matches(">time (s)<").count(), 1);
    let paper = whisk(&place, &[&sine[..], &["--plot", "paper.svg", "--size", "85mm"]].concat());
    assert_eq!(paper.code, Some(0), "{paper:?}");
    let times = place.text("paper.svg");
    assert!(
        times.matches(">time (s)<").count() + times.matches(">time (ms)<").count() == 1,
        "{times}"
    );
    let table = place.text("s.csv");
    let angles =
        table.lines().map(|line| line.splitn(3, ',').take(2).collect::<Vec<_>>().join(","));
    place.write("angles.csv", &angles.collect::<Vec<_>>().join("\n"));
    let again = whisk(&place, &["--angles", "angles.csv"]);
    assert_eq!((again.code, again.out), (Some(0), table), "{}", again.err);
}

/// A course without an event has a table of events all the same: its header.
#[test]
fn a_table_without_rows_has_a_header() {
    let place = Place::with(SCENE);
    place.write("a.csv", "time_s,angle_deg\n0,-5\n1,-6\n");
    for (units, column) in
        [(&[][..], "base_moment_nnm"), (&["--units", "Nmm,mN"], "base_moment_nmm")]
    {
        let course = ["--angles", "a.csv", "--events", "e.csv", "--csv", "s.csv"];
        let run = whisk(&place, &[&course[..], units].concat());
        assert_eq!(run.code, Some(0), "{run:?}");
        let events = place.text("e.csv");
        assert!(events.starts_with("time_s,event,side,angle_deg,"), "{events}");
        assert!(events.contains(column) && events.lines().count() == 1, "{events}");
    }
}

#[test]
fn wrong_courses_are_refused() {
    let place = Place::with(SCENE);
    for (sine, said) in [
        ("40", "such as 25deg,10,0.2"),
        ("0,10,1", "must be between -360deg and 360deg, and not 0"),
        ("400,10,1", "must be between -360deg and 360deg, and not 0"),
        ("40,-1,1", "frequency in Hz -1: must be a positive number"),
        ("40,1,inf", "duration in s inf: must be a positive number"),
        ("40,1,1e9", "samples: must be between 2 and 1000000"),
        (
            "40,501,1",
            "frequency 501 Hz with 1000 samples per second: must be at most half as large",
        ),
    ] {
        whisk(&place, &["--sine", sine]).assert_refused(&["--sine", said]);
    }
    for (text, said) in [
        ("time_s,angle\n0,1\n", "needed time_s, angle_deg, each once"),
        (
            "time_s,angle_deg\n0,0\n1,x\n",
            "a.csv:3: angle_deg = x: must be a number between -360 and 360",
        ),
        (
            "time_s,angle_deg\n0,0\n1,1\n1,2\n",
            "a.csv:4: time_s = 1: must be more than 1 of the line before",
        ),
        ("time_s,angle_deg\n0,0\n", "must be at least 2 of each"),
        (
            "time_s,angle_deg\n0,1\n1,2\n",
            "--angles a.csv: begins in contact: the first angle is 1 deg; must be at most 0 deg",
        ),
    ] {
        place.write("a.csv", text);
        whisk(&place, &["--angles", "a.csv"]).assert_refused(&[said]);
    }
    whisk(&place, &[]).assert_refused(&["--angles <FILE>|--sine"]);
    place
        .run(&words("whisk scene.toml --distance 19.9 --sine 1,1,1"))
        .assert_refused(&["--distance 19.9", "out of reach"]);
}

/// A course that begins beyond first touch says what it assumes, and `--start` chooses.
#[test]
fn a_start_beyond_first_touch_is_named() {
    let place = Place::with(SCENE);
    place.write("a.csv", "time_s,angle_deg\n0,10\n1,12\n");
    let angles = ["--angles", "a.csv"];
    let assumed =
        "warning: the first angle is 10 deg, beyond first touch: the whisker is assumed to be free";
    let run = whisk(&place, &angles);
    assert!(run.code == Some(0) && run.err.contains(assumed), "{run:?}");
    assert!(run.out.contains(",free,"), "{run:?}");
    for (start, regime) in [("free", ",free,"), ("contact", ",contact,cb,10.0,")] {
        let run = whisk(&place, &[&angles[..], &["--start", start]].concat());
        assert!(run.code == Some(0) && !run.err.contains("warning"), "{run:?}");
        assert!(run.out.contains(regime), "{run:?}");
    }
    place.write("a.csv", "time_s,angle_deg\n0,20\n1,12\n");
    let run = whisk(&place, &["--angles", "a.csv", "--start", "contact"]);
    run.assert_refused(&["--angles a.csv: cannot begin in contact: the first angle is 20 deg"]);
}

/// A lost frame is a row with its reason; a bridge continues the course across it, and says so.
#[test]
fn gaps_are_rows_with_a_reason() {
    let place = Place::with(SCENE);
    place.write("a.csv", "time_s,angle_deg\n0,-5\n0.01,5\n0.02,\n0.03,NaN\n0.04,10\n");
    let reasons = |run: &super::Run| -> Vec<String> {
        let cells = run.out.lines().skip(1).map(|line| line.rsplit(',').next());
        cells.map(|cell| cell.unwrap().to_owned()).collect()
    };
    let run = whisk(&place, &["--angles", "a.csv"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    assert_eq!(reasons(&run), ["", "", "missing", "missing", "after-gap"]);
    let warned = "warning: missing angles: 2, gaps: 1, the first at 0.02 s: after them the course is undecided";
    assert!(run.err.contains(warned), "{run:?}");
    assert!(run.err.contains("detachments lose an unknown energy"), "{run:?}");
    let run = whisk(&place, &["--angles", "a.csv", "--bridge", "30ms"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    assert_eq!(reasons(&run), ["", "", "bridged", "bridged", ""]);
    let said = "the course continues along straight lines across them, the longest of 0.03 s";
    assert!(run.err.contains(said), "{run:?}");
    for (options, said) in [
        (&["--bridge", "0"][..], "--bridge <TIME>': must be a positive time"),
        (&["--bridge", "20mm"], "unit mm: must be s (the default), ms or us"),
        (&["--bridge", "20ms", "--sine", "1,1,1"], "cannot be used with"),
    ] {
        let course: &[&str] = if options.len() > 2 { &[] } else { &["--angles", "a.csv"] };
        whisk(&place, &[course, options].concat()).assert_refused(&[said]);
    }
    place.write("a.csv", "time_s,angle_deg\n0,\n0.01,5\n");
    whisk(&place, &["--angles", "a.csv"])
        .assert_refused(&["a.csv: 1 of 2 angles are not missing: must be at least 2"]);
}

/// The curvature is a column where it is wanted, and its arclength takes units.
#[test]
fn samples_have_the_curvature_at_an_arclength() {
    let place = Place::with(SCENE);
    let column = |more: &[&str]| -> Vec<String> {
        let sine = ["--sine", "12,10,0.1", "--rate", "100"];
        let run = whisk(&place, &[&sine[..], more].concat());
        assert_eq!(run.code, Some(0), "{run:?}");
        let mut lines = run.out.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let header = lines.next().unwrap();
        let place = header.iter().position(|name| *name == "curvature_per_mm").unwrap();
        lines.map(|line| line[place].to_owned()).collect()
    };
    let curvatures = column(&["--curvature-at", "2mm"]);
    assert_eq!(curvatures, column(&["--curvature-at", "0.2cm"]));
    assert!(curvatures.iter().all(|cell| cell.parse::<f64>().is_ok()), "{curvatures:?}");
    assert!(curvatures.iter().any(|cell| *cell != curvatures[0]), "{curvatures:?}");
    assert!(column(&[]).iter().all(String::is_empty));
    for (at, said) in [
        (
            "20.1",
            "--curvature-at: curvature_at_mm = 20.1: must be between 0 and 20, the whisker's length in mm",
        ),
        ("2s", "unit s: must be mm"),
    ] {
        whisk(&place, &["--sine", "12,10,0.1", "--curvature-at", at]).assert_refused(&[said]);
    }
}
