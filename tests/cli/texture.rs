//! `whiskmap texture`.

use super::traces::cells;
use super::{Place, SCENE, words};

const SURFACE: &str = "\
[surface]
distance_mm = 18.0
spacing_um = 200.0
asperity_radius_um = 20.0
length_mm = 20.0
";

fn place(surface: &str) -> Place {
    Place::with(&format!("{SCENE}\n{surface}"))
}

#[test]
fn a_sweep_gives_its_tables_and_its_picture() {
    let place = place(SURFACE);
    let files = words("--csv s.csv --events e.csv --dwells d.csv --histogram h.csv --plot t.svg");
    let texture = |more: &[&str]| place.good(&[&["texture", "scene.toml"], more].concat());
    let run = texture(&[&["--rate", "50"], &files[..]].concat());
    assert_eq!(run.out, "s.csv\nt.svg\ne.csv\nd.csv\nh.csv\n");
    let samples = place.text("s.csv");
    let header = samples.lines().next().unwrap().to_owned();
    // Three periods of 0.2 Hz by default.
    let samples = cells(&samples, &header);
    assert_eq!(samples.len(), 751);
    assert_eq!((samples[0][1], samples[0][2]), ("0.0", "free"));
    let events = place.text("e.csv");
    let header = "time_s,event,asperity,side,angle_deg,push_angle_deg,tip_x_mm,force_un,base_moment_nnm,energy_nj,lost_nj";
    let events = cells(&events, header);
    let touches = events.iter().filter(|event| event[1] == "touch").count();
    let dwells = place.text("d.csv");
    let dwells = cells(&dwells, "asperity,side,begin_s,end_s,dwell_s,end");
    assert_eq!(dwells.len(), touches);
    assert!(run.err.contains(&format!("touches {touches}, ")), "{run:?}");
    let bins = place.text("h.csv");
    assert_eq!(cells(&bins, "tip_from_mm,tip_to_mm,tip_time_s").len(), 80);
    let svg = place.text("t.svg");
    for label in ["tip along the surface (mm)", "dwell time on an asperity (s)", "stuck"] {
        assert!(svg.contains(&format!(">{label}<")), "{label}");
    }
    // The same angles from a file, in other units.
    let angles = samples.iter().map(|row| format!("{},{}\n", row[0], row[1]));
    place.write("a.csv", &format!("time_s,angle_deg\n{}", angles.collect::<String>()));
    let again = texture(&["--angles", "a.csv"]);
    assert_eq!(again.out, place.text("s.csv"));
    let other = texture(&["--angles", "a.csv", "--units", "um,mN"]).out;
    let header = other.lines().next().unwrap();
    assert!(header.contains(",tip_x_um,tip_height_um,force_mn,"), "{header}");
}

#[test]
fn a_sweep_needs_a_surface_and_no_friction() {
    Place::with(SCENE)
        .run(&["texture", "scene.toml"])
        .assert_refused(&["scene.toml: the scene has no [surface]: add that table"]);
    let rough =
        format!("{}\n{SURFACE}", SCENE.replace("[grid]", "[contact]\nfriction = 0.3\n[grid]"));
    Place::with(&rough)
        .run(&["texture", "scene.toml"])
        .assert_refused(&["contact.friction = 0.3: must be 0"]);
}

#[test]
fn wrong_sweeps_are_refused() {
    let place = place(SURFACE);
    let texture = |more: &[&str]| place.run(&[&["texture", "scene.toml"], more].concat());
    texture(&["--sine", "95deg,0.2,5"])
        .assert_refused(&["--sine 95,0.2,5: angle", "must be between -90 and 90 deg"]);
    place.write("a.csv", "time_s,angle_deg\n0,0\n1,x\n");
    texture(&["--angles", "a.csv"])
        .assert_refused(&["a.csv:3: angle_deg = x: must be a number between -360 and 360"]);
    texture(&["--angles", "a.csv", "--sine", "1,1,1"]).assert_refused(&["cannot be used with"]);
    texture(&["--histogram", "scene.toml"]).assert_refused(&["--histogram", "scene.toml"]);
    // The first touch is an angle at which a course may begin; between the touches of an asperity it may not.
    let run = texture(&["--rate", "20", "--csv", "s.csv", "--events", "e.csv"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    let events = place.text("e.csv");
    let touch: f64 = events.lines().nth(1).unwrap().split(',').nth(4).unwrap().parse().unwrap();
    let begin = |angle: f64| {
        place.write("a.csv", &format!("time_s,angle_deg\n0,{angle:?}\n1,{:?}\n", angle + 1.0));
        texture(&["--angles", "a.csv"])
    };
    assert_eq!(begin(touch).code, Some(0));
    begin(touch + 0.01).assert_refused(&["--angles a.csv: begins in contact", "must be at most"]);
}

/// The curvature of samples is that at rest where the whisker is free, and another one in contact.
#[test]
fn samples_have_the_curvature_at_an_arclength() {
    let place = place(SURFACE);
    let sweep = words("texture scene.toml --sine 15,0.2,5 --rate 20");
    let run = place.good(&[&sweep[..], &["--curvature-at", "2"]].concat());
    let header = run.out.lines().next().unwrap().to_owned();
    let column = |name: &str| header.split(',').position(|column| column == name).unwrap();
    let (phase, curvature) = (column("phase"), column("curvature_per_mm"));
    let (x, y) = (column("contact_x_mm"), column("contact_y_mm"));
    let rows = cells(&run.out, &header);
    let at_rest = rows.iter().find(|row| row[phase] == "free").unwrap()[curvature];
    let mut held = 0;
    for row in rows.iter().filter(|row| row[phase] == "stuck") {
        assert_ne!(row[curvature], at_rest, "{row:?}");
        let [x, y]: [f64; 2] = [row[x], row[y]].map(|cell| cell.parse().unwrap());
        // On the whisker's side of an asperity, whose radius is 0.02 mm.
        assert!((y - 18.0).abs() <= 0.02 && x.abs() < 10.1, "{row:?}");
        held += 1;
    }
    assert!(held > 10, "{held}");
    place
        .run(&[&sweep[..], &["--curvature-at", "21"]].concat())
        .assert_refused(&["--curvature-at: curvature_at_mm = 21: must be between 0 and 20"]);
    place.write("a.csv", "time_s,angle_deg\n0,0\n1,\n2,1\n");
    place.run(&["texture", "scene.toml", "--angles", "a.csv"]).assert_refused(&[
        "--angles a.csv: angle_deg[1] = NaN: must be between -90 and 90 deg",
        "none may be missing",
    ]);
}
