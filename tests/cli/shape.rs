//! `whiskmap shape`.

use super::traces::{BRANCH, CURVE, SHAPE, cells};
use super::{Place, SCENE, names, words};
use whiskmap::Side;
use whiskmap::scene::Scene;
use whiskmap::trace::Branch;

#[test]
fn a_shape_is_the_requested_state() {
    let place = Place::with(SCENE);
    let at = words("shape scene.toml --distance=15.66 --push-angle=10 --points=11");
    let stable = place.quiet(&at);
    let unstable = place.quiet(&[&at[..], &["--branch", "unstable"]].concat());
    let scene = Scene::parse(SCENE, "scene").unwrap();
    let branch = Branch::new(&scene.whisker, &scene.pole, Side::Cb, 15.66).unwrap();
    for (run, part) in [(stable, true), (unstable, false)] {
        let rows = cells(&run.out, SHAPE);
        assert_eq!(rows.len(), 12);
        let contact = rows.iter().find(|row| row[7] == "contact").unwrap();
        let state = branch.state(10_f64.to_radians(), part).unwrap();
        let arc = branch.read(&state).arc_length_mm;
        assert_eq!(contact[0].parse::<f64>().unwrap(), arc);
        assert_eq!(rows.last().unwrap()[0], "20.0");
    }
}

/// The row of `--state` has the loads of the shape: its base row has the moment, and no row a larger strain.
#[test]
fn the_state_has_the_loads_of_the_shape() {
    let place = Place::with(SCENE);
    let at = words("shape scene.toml --distance=15.66 --push-angle=10 --state state.csv");
    let table = place.quiet(&[&at[..], &["--csv", "-"]].concat()).out;
    let state = place.text("state.csv");
    let state = cells(&state, BRANCH);
    let [row] = &state[..] else { panic!("{state:?}") };
    let number = |cell: &str| cell.parse::<f64>().unwrap();
    let shape = cells(&table, SHAPE);
    let base = &shape[0];
    assert_eq!((row[1], row[2], row[3]), ("cb", "true", "10.0"));
    assert!((number(row[11]) / number(base[5]) - 1.0).abs() < 1e-9, "{row:?} {base:?}");
    let most = shape.iter().map(|row| number(row[6])).fold(0.0, f64::max);
    let peak = number(row[13]);
    assert!((0.999..=1.0).contains(&(most / peak)), "{most} {peak}");
    // In other units; the names of columns end in them.
    let words = [&at[..], &["--csv", "shape.csv", "--units", "mN, Nmm,cm"]].concat();
    assert_eq!(place.quiet(&words).out, "shape.csv\nstate.csv\n");
    let other = place.text("state.csv");
    let header = BRANCH.replace("_un", "_mn").replace("_nnm", "_nmm").replace("_mm", "_cm");
    let converted = &cells(&other, &header)[0];
    for (column, size) in [(7, 1e3), (11, 1e6), (5, 10.0), (3, 1.0)] {
        assert_eq!(number(converted[column]), number(row[column]) / size, "{column}");
    }
    for (units, must) in [
        ("mN,kg", "--units kg: must be one of mm, cm, "),
        ("mN,uN", "--units uN: mN is a unit of the same quantity"),
        ("mn", "did you mean `mN`?"),
    ] {
        place.run(&[&at[..], &["--units", units]].concat()).assert_refused(&[must]);
    }
}

#[test]
fn states_that_do_not_exist_have_a_reason() {
    let place = Place::with(SCENE);
    let shape = |distance: &str, push: &str, more: &[&str]| {
        let arguments = ["shape", "scene.toml", "--distance", distance, "--push-angle", push];
        place.run(&[&arguments[..], more].concat())
    };
    shape("15.66", "20", &[]).assert_refused(&["--push-angle 20 deg: slipped off at 15.6094"]);
    // An end that has the same nine decimals as the push angle is told apart.
    let curve = place.run(&["curve", "scene.toml", "--distance", "15.66"]).out;
    let end: f64 = curve.lines().nth(2).unwrap().split(',').nth(4).unwrap().parse().unwrap();
    let beyond = (end + 2e-10).to_string();
    shape("15.66", &beyond, &[])
        .assert_refused(&["slipped off at 15.6094", " deg, 2e-10 deg earlier"]);
    // The whisker has moved away from the pole.
    for (push, side, stays) in
        [("-5", "cb", "between 0.000000000 and 15.6094"), ("5", "cf", "between -24.91")]
    {
        let lost = format!("--push-angle {push} deg: lost touch");
        shape("15.66", push, &["--side", side]).assert_refused(&[&lost, stays]);
    }
    shape("19.5", "4", &[]).assert_refused(&["--push-angle 4 deg: pulled off at 2."]);
    shape("19.5", "1", &["--branch=unstable"])
        .assert_refused(&["no unstable state: pulled off at 2."]);
    shape("15.66", "-80", &["--branch=unstable"])
        .assert_refused(&["the unstable states lie between -24.9"]);
    let reach = "out of reach: the tip of the resting whisker is 19.657";
    shape("19.9", "1", &[]).assert_refused(&["--distance 19.9", reach]);
    let branch = ["branch", "scene.toml", "--distance", "19.9"];
    place.run(&branch).assert_refused(&["--distance 19.9", reach]);
    assert_eq!(names(&place.path("")), ["scene.toml"]);
}

/// A contact that slides toward the base is reported by a column, and a line of the summary.
#[test]
fn sliding_toward_the_base_is_reported() {
    let rough = SCENE.replace("[grid]", "[contact]\nfriction = 0.3\n[grid]");
    let place = Place::with(&rough);
    let shape = |distance: &str, push: &str| {
        let shape = ["shape", "scene.toml", "--state=state.csv", "--distance"];
        let run = place.run(&[&shape[..], &[distance, "--push-angle", push]].concat());
        assert_eq!(run.err, "");
        let state = place.text("state.csv");
        let lines: Vec<Vec<&str>> = state.lines().map(|line| line.split(',').collect()).collect();
        let column = lines[0].iter().position(|name| *name == "sliding").unwrap();
        lines[1][column].to_owned()
    };
    // On 17 mm the contact sticks from -8.43 to -9.65 degrees.
    let found = [("9", "-5"), ("17", "-9"), ("9", "-20"), ("9", "5")];
    assert_eq!(
        found.map(|(distance, push)| shape(distance, push)),
        ["base", "sticks", "tip", "tip"]
    );
    let branch = place.quiet(&["branch", "scene.toml", "--distance=9", "--side=cf"]);
    let rows = cells(&branch.out, BRANCH);
    assert_eq!([rows[1][17], rows[199][17]], ["base", "tip"]);
    let curve = place.quiet(&["curve", "scene.toml"]);
    for row in cells(&curve.out, CURVE) {
        let sliding = if row[3] == "out-of-reach" { "" } else { "tip" };
        assert_eq!(row[18], sliding, "{row:?}");
    }
    let map = place.map(&["scene.toml", "--no-png"]);
    map.assert_settled();
    let warning = "slide toward the base";
    assert!(map.count(warning) > 10, "{map:?}");
    place.write("scene.toml", SCENE);
    assert!(!place.map(&["scene.toml", "--no-png"]).out.contains("slide"));
}
