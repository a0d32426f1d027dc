//! Scenes with traced points: what is accepted, stored and refused.

use std::fs;
use whiskmap::scene::{Parameter, Scene};
use whiskmap::traced::TracedShape;

const WHISKER: &str = "title = \"traced\"\n[whisker]\nbase_radius_um = 30\ntip_radius_um = 1.5\n\
                       youngs_modulus_gpa = 3\n";

const REST_OF_SCENE: &str =
    "\n[pole]\nradius_mm = 0.25\n[grid]\npush_angle_deg = [-20, 20]\ndistance_mm = [5, 10]\n";

fn scene(rest: &str) -> String {
    format!("{WHISKER}[whisker.rest]\n{rest}{REST_OF_SCENE}")
}

/// Points of an arc of radius 20 mm, 20 mm long.
fn arc(count: u32) -> Vec<[f64; 2]> {
    let point = |i: u32| {
        let angle = f64::from(i) / f64::from(count - 1);
        [20.0 * angle.sin(), 20.0 * (1.0 - angle.cos())]
    };
    (0..count).map(point).collect()
}

/// A fit to so many points would take minutes without a word.
#[test]
fn too_many_points_are_refused_at_once() {
    let why = TracedShape::fit(arc(1_000_000), None).unwrap_err();
    assert_eq!(
        why.to_string(),
        "must be at most 50000 points, are 1000000: leave out points, such as all but every 20th"
    );
    assert!(TracedShape::fit(arc(50_000), Some(0)).is_ok());
}

fn refusal(text: &str) -> String {
    Scene::parse(text, "scene.toml").unwrap_err().to_string()
}

#[test]
fn points_are_read_from_the_scene_and_from_a_file() {
    let points = arc(12);
    let listed = Scene::parse(&scene(&format!("points = {points:?}")), "scene.toml").unwrap();
    let traced = listed.traced().unwrap();
    assert_eq!((traced.degree, &traced.points_mm), (0, &points));
    assert!((listed.whisker.length_mm - 20.0).abs() < 1e-9);
    assert!((listed.whisker.sharpest_bend_per_mm() - 0.05).abs() < 1e-9);
    assert_eq!(Parameter::LengthMm.value(&listed), Some(traced.length_mm));

    let folder = tempfile::tempdir().unwrap();
    let rows = points.iter().map(|[x, y]| format!("{y},{x}\n"));
    let csv = format!("# a remark\ny_mm,x_mm\n{}", rows.collect::<String>());
    fs::write(folder.path().join("points.csv"), csv).unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(&path, scene("points = \"points.csv\"")).unwrap();
    let read = Scene::read(&path).unwrap();
    assert_eq!(read.whisker, listed.whisker);
    assert_eq!(read.csv_files(), [folder.path().join("points.csv")]);

    // What is kept with a map stands for itself: points, degree, coefficients and length.
    fs::remove_dir_all(folder.path()).unwrap();
    let text = read.to_toml();
    for key in ["points = [\n", "degree = 0", "curvature = [", "length_mm = "] {
        assert!(text.contains(key), "{text}");
    }
    let again = Scene::parse(&text, "scene.toml").unwrap();
    assert_eq!(again.whisker, read.whisker);
    assert_eq!(again.to_toml(), text);
    let built = listed.to_builder().build().unwrap();
    let rebuilt = Scene::parse(&built.to_toml(), "scene.toml").unwrap();
    assert_eq!(rebuilt.whisker, listed.whisker);
}

#[test]
fn points_that_are_refused() {
    let points = |change: &dyn Fn(&mut Vec<[f64; 2]>)| {
        let mut points = arc(12);
        change(&mut points);
        format!("points = {points:?}")
    };
    for (rest, why) in [
        ("points = \"no.csv\"".to_owned(), "only a scene file may name a CSV file"),
        ("points = 5".to_owned(), "expected the name of a CSV file or a list of [x_mm, y_mm]"),
        ("points = [[0, 0], [1]]".to_owned(), "invalid length 1, expected a list of 2 numbers"),
        ("degree = 2".to_owned(), "missing field `points`"),
        (
            "points = []".to_owned(),
            "must be at least 8 points to choose the degree by cross-validation, are 0",
        ),
        (
            format!("points = {:?}\ndegree = 4", arc(7)),
            "must be at least 8 points for the degree 4, are 7",
        ),
        (format!("points = {:?}\ndegree = 7", arc(12)), "degree = 7: must be between 0 and 6"),
        (format!("points = {:?}\ndegree = -1", arc(12)), "degree = -1: must be between 0 and 6"),
        (format!("points = {:?}\ndegree = 1.5", arc(12)), "invalid type: floating point"),
        (
            format!("points = {:?}\ncurvature = [1.1]", arc(12)),
            "must be left out, or be the coefficients of the fit",
        ),
        (
            points(&|all| all[4][1] = f64::NAN).replace("NaN", "nan"),
            "points[4]: x_mm and y_mm must be numbers",
        ),
        (points(&|all| all[4] = all[3]), "points[4]: must differ from the point before it"),
        (points(&|all| all.swap(5, 7)), "points[6]: must not fold back: it is"),
        (
            points(&|all| all.iter_mut().step_by(2).for_each(|point| point[1] += 1.4)),
            "must lie along a smooth curve: their rms distance",
        ),
        (points(&|all| all.push([0.5, 0.5])), "points[12]: must not fold back"),
    ] {
        let message = refusal(&scene(&rest));
        assert!(message.contains(why), "{rest}: {message}");
    }
}

#[test]
fn a_traced_shape_is_the_only_one() {
    let rest = format!("points = {:?}", arc(12));
    for (added, why) in [
        (
            "[whisker.curvature]\nparabola_per_mm = 0.02",
            "parabola_per_mm = 0.02: must be left out: the shape at rest is that of whisker.rest",
        ),
        (
            "[whisker.curvature]\neuler_spiral = { per_mm = 0.02, per_mm2 = 0 }",
            "must be left out: the shape at rest",
        ),
    ] {
        let message = refusal(&scene(&format!("{rest}\n{added}")));
        assert!(message.contains(why), "{message}");
    }
    let axis = scene(&rest) + "curvature_per_mm = [0, 0.02]\n";
    assert!(refusal(&axis).contains("must be left out: the shape at rest is that of whisker.rest"));
    let longer = scene(&rest).replace("[whisker]", "[whisker]\nlength_mm = 40");
    let longer = Scene::parse(&longer, "scene.toml").unwrap();
    assert!((longer.whisker.sharpest_bend_per_mm() - 0.025).abs() < 1e-9);
}

/// Errors in a CSV file name its line, whatever lines of comments there are.
#[test]
fn errors_name_the_line_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(&path, scene("points = \"points.csv\"")).unwrap();
    let good: String = arc(12).iter().map(|[x, y]| format!("{x},{y}\n")).collect();
    for (csv, why) in [
        (
            format!("x_mm,z_mm\n{good}"),
            "points.csv:1: found x_mm, z_mm; needed x_mm, y_mm, each once",
        ),
        (format!("x_mm,y_mm\n{good}20,far\n"), "points.csv:14: y_mm = far: must be a number"),
        (format!("# a remark\n\nx_mm,y_mm\n{good}1,0\n"), "line 16: must not fold back"),
    ] {
        fs::write(folder.path().join("points.csv"), &csv).unwrap();
        let message = Scene::read(&path).unwrap_err().to_string();
        assert!(message.contains(why), "{message}");
        assert!(message.contains("whisker.rest.points = \"points.csv\""), "{message}");
    }
    let unused = format!("x_mm,y_mm\n{good}").replace("\n", ",7\n").replacen(",7", ",day", 1);
    fs::write(folder.path().join("points.csv"), unused).unwrap();
    let scene = Scene::read(&path).unwrap();
    assert!(scene.notes()[0].ends_with("columns that are not used: day"), "{:?}", scene.notes());
}

/// Points in pixels have no scale: the scene must give the length.
#[test]
fn a_traced_length_of_no_whisker_must_be_given() {
    let scaled = |scale: f64| {
        let points: Vec<[f64; 2]> = arc(12).iter().map(|point| point.map(|x| scale * x)).collect();
        scene(&format!("points = {points:?}"))
    };
    let why = refusal(&scaled(39.25));
    let said = "whisker.rest.points: must be in mm: the curve through them is 785 mm long, and a length outside 1 to 200 mm must be given \
                by whisker.length_mm. `whiskmap import --mm-per-pixel` converts pixels";
    assert!(why.contains(said), "{why}");
    assert!(refusal(&scaled(0.049)).contains("is 0.98 mm long"));
    for (scale, length) in [(39.25, 785), (39.25, 20)] {
        let given = scaled(scale).replace("[whisker]", &format!("[whisker]\nlength_mm = {length}"));
        let read = Scene::parse(&given, "scene.toml").unwrap();
        assert_eq!(read.whisker.length_mm, f64::from(length));
        // What is kept with a map has the length.
        let again = Scene::parse(&read.to_toml(), "scene.toml").unwrap();
        assert_eq!(again.to_builder().build().unwrap().whisker, read.whisker);
    }
    let longest = Scene::parse(&scaled(9.99), "scene.toml").unwrap();
    assert!((longest.whisker.length_mm - 199.8).abs() < 1e-9);
}
