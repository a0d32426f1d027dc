//! `whisker.yield_strain`: marks in tables, maps, pictures and designs.

use super::{Place, SCENE, words};
use whiskmap::store::MapSource;

/// Scene with a yield strain, which some of its states exceed.
fn yielding(strain: f64) -> String {
    SCENE.replace("[whisker]\n", &format!("[whisker]\nyield_strain = {strain}\n"))
}

/// Returns the cells of a column of a table, `[row]`; `None` without the column. Names of files below the table are left out.
fn column(text: &str, name: &str) -> Option<Vec<String>> {
    let lines = text.lines().filter(|line| line.contains(','));
    let mut lines = lines.map(|line| line.split(','));
    let place = lines.next()?.position(|cell| cell == name)?;
    lines.map(|mut line| Some(line.nth(place)?.to_owned())).collect()
}

/// Frames of the scene's whisker: free, and in contact.
const FRAMES: &str = "time_s,curvature_per_mm,at_arc_length_mm,contact_x_mm,contact_y_mm\n0.004,0.03961985,2,,\n\
     0.006,0.03962440,2,14.999205,4.500917\n0.008,0.04060842,2,14.911963,4.754610\n0.010,0.15610992,2,6.16253623,4.93100638\n";

/// Every table of states or pushes has the mark at its end, by its own largest strain; without a yield strain, it has the other columns alone.
#[test]
fn tables_have_a_mark() {
    let surface =
        "[surface]\ndistance_mm = 14\nspacing_um = 800\nasperity_radius_um = 20\nlength_mm = 12\n";
    let uncertain = "[uncertainty]\nlength_mm = 0.5\n";
    let extra = format!("{surface}{uncertain}");
    let place = Place::with(&format!("{}{extra}", yielding(0.002)));
    place.write("elastic.toml", &format!("{SCENE}{extra}"));
    place.write("frames.csv", FRAMES);
    let at = "--distance=10";
    for (words, value, last) in [
        (&["curve", at][..], "max_strain", "max_strain,yields"),
        (&["curve", at, "--derivatives=taper"], "max_strain", "max_strain,yields"),
        (&["curve", at, "--units=mN,Nmm"], "max_strain", "max_strain,yields"),
        (&["curve", at, "--samples=3", "--largest"], "max_strain", "yields"),
        (&["curve", "--corner"], "max_strain", "max_strain,yields"),
        (&["force", "--frames=frames.csv", "--model"], "peak_strain", "peak_strain,yields"),
        (&["branch", at], "peak_strain", "yields"),
        (&["shape", at, "--push-angle=30"], "strain", "yields"),
        (&["shape", at, "--push-angle=30", "--csv=s.csv", "--state=-"], "peak_strain", "yields"),
        (&["sensitivity", at], "max_strain", "yields"),
        (&["whisk", at, "--sine=45deg,1,1", "--rate=40"], "peak_strain", "peak_strain,yields"),
        (&["texture", "--sine=15deg,1,1", "--rate=40"], "peak_strain", "peak_strain,yields"),
        (
            &["locate", "--base-moment=260nNm", "--base-force-y=26uN"],
            "peak_strain",
            "peak_strain,yields",
        ),
    ] {
        let of = |scene: &str| {
            let words = [&words[..1], &[scene], &words[1..]].concat();
            place.good(&words).out
        };
        let (marked, elastic) = (of("scene.toml"), of("elastic.toml"));
        let [header, other] =
            [&marked, &elastic].map(|text| text.lines().next().unwrap().to_owned());
        assert_eq!(header, format!("{other},{last}"), "{words:?}");
        let strains = column(&marked, value).unwrap();
        let yields = column(&marked, "yields").unwrap();
        let mut seen = [0, 0];
        for (strain, mark) in strains.iter().zip(&yields) {
            let wanted = strain.parse().ok().map(|strain: f64| strain > 0.002);
            assert_eq!(
                *mark,
                wanted.map_or(String::new(), |is_marked| is_marked.to_string()),
                "{words:?}"
            );
            if let Some(is_marked) = wanted {
                seen[usize::from(is_marked)] += 1;
            }
        }
        assert!(
            seen[1] > 0
                || words[0] == "texture" && seen[0] > 0
                || words[1] == "--corner" && seen[0] == 1,
            "{words:?} {seen:?}"
        );
        // The other columns have the same cells.
        for (line, other) in marked.lines().zip(elastic.lines()) {
            assert!(line.starts_with(other), "{words:?}:\n{line}\n{other}");
        }
    }
}

/// Each row of a table of whiskers has its own yield strain: in tables, counts and pictures. A row without a number has no marks, and one
/// with a number that is not allowed has no whisker.
#[test]
fn rows_of_a_table_have_their_own_yield_strains() {
    const LEGEND: &str = "beyond the yield strain";
    let place = Place::with(&format!("{SCENE}[whiskers]\ntable = 'w.csv'\n"));
    place.write("w.csv", "name,yield_strain\nunknown,\nsoft,0.002\nstrong,0.9\nbad,2\n");
    let curve = place.good(&["curve", "scene.toml", "--distance=10"]);
    let marks = ["", "", "true", "true", "false", "false", "", ""];
    assert_eq!(column(&curve.out, "yields").unwrap(), marks);
    let reason = "whisker.yield_strain = 2: must be more than 0 and at most 1";
    assert!(curve.err.contains(&format!("bad ({reason})")), "{curve:?}");
    let corner = place.good(&["curve", "scene.toml", "--corner"]);
    assert!(corner.out.lines().next().unwrap().ends_with("max_strain,yields"));
    let of =
        |words: &[&str]| place.good(&[words, &["--distance=10", "--at=whisker=soft"]].concat());
    assert!(of(&["branch", "scene.toml"]).out.contains(",true\n"));
    let map = place.map(&["scene.toml"]);
    // The count is that of the one whisker with marks.
    let alone = Place::with(&yielding(0.002));
    assert_eq!(map.count(LEGEND), alone.map(&["scene.toml"]).count(LEGEND));
    for file in ["scene.toml", "outputs/scene.exr"] {
        for (whisker, has_marks) in [("unknown", false), ("soft", true), ("strong", false)] {
            let at = format!("--at=whisker={whisker}");
            place.good(&["render", file, &at, "-o", "s.svg"]);
            let picture = place.text("s.svg");
            assert_eq!(picture.contains(LEGEND), has_marks, "{file} {whisker}");
        }
    }
    // Without strains, a note says so of a whisker with a yield strain.
    let few = words("map scene.toml -o few --channels=regime,margin_deg");
    place.good(&few);
    for (whisker, has_note) in [("unknown", false), ("soft", true)] {
        let at = format!("--at=whisker={whisker}");
        let run = place.good(&["render", "few/scene.exr", &at, "-o", "s.svg"]);
        assert_eq!(run.err.contains("no cell is hatched"), has_note, "{run:?}");
    }
    // The text of the map has the rows of the file.
    let again = MapSource::open(&place.path("outputs/scene.exr")).unwrap();
    let scene = again.scene().unwrap().unwrap();
    let strains =
        scene.whiskers().map(|found| found.ok().and_then(|swept| swept.whisker.yield_strain));
    assert_eq!(strains.collect::<Vec<_>>(), [None, Some(0.002), Some(0.9), None]);
}

/// Maps and stores have the channel, and pictures hatch cells beyond the yield strain.
#[test]
fn maps_have_strains_and_hatched_cells() {
    const LEGEND: &str = "beyond the yield strain";
    let place = Place::with(&yielding(0.002));
    place.write("elastic.toml", &SCENE.replace("A small map", "elastic"));
    place.write("strong.toml", &yielding(0.9));
    let svg = |words: &[&str]| {
        let run = place.good(&[words, &["-o", "s.svg"]].concat());
        (place.text("s.svg"), run.err)
    };
    let map = place.map(&["scene.toml"]);
    assert!(map.count(LEGEND) > 10, "{map:?}");
    place.map(&["elastic.toml", "-o", "elastic"]);
    for (name, has_strain) in [("outputs/scene.exr", true), ("elastic/elastic.exr", false)] {
        let map = MapSource::open(&place.path(name)).unwrap();
        assert_eq!(map.channels().contains(&"peak_strain"), has_strain, "{name}");
    }
    for channel in [&[][..], &["--channel=force_un"], &["--channel=peak_strain"]] {
        for map in ["outputs/scene.exr", "scene.toml"] {
            let (picture, _) = svg(&[&["render", map], channel].concat());
            assert!(picture.contains(LEGEND), "{map} {channel:?}");
        }
        // No state of it is so strained.
        let (picture, _) = svg(&[&["render", "strong.toml"], channel].concat());
        assert!(!picture.contains(LEGEND), "{channel:?}");
    }
    let (bar, _) = svg(&["render", "outputs/scene.exr", "--channel=peak_strain"]);
    assert!(bar.contains("largest bending strain"), "{bar}");
    // A row is a line, whose part beyond the yield strain has another stroke.
    let row = ["--channel=force_un", "--at=distance_mm=10"];
    for (scene, has_part) in [("scene.toml", true), ("strong.toml", false)] {
        let (picture, _) = svg(&[&["render", scene], &row[..]].concat());
        assert_eq!(picture.contains(LEGEND), has_part, "{scene}");
        assert_eq!(picture.contains("stroke-dasharray"), has_part, "{scene}");
    }
    // A curve has another stroke over the ends that the table marks.
    for (scene, has_marks) in [("scene.toml", true), ("strong.toml", false)] {
        let run = place.good(&["curve", scene, "--csv", "-", "--plot", "s.svg"]);
        let marks = column(&run.out, "yields").unwrap();
        let count = marks.iter().filter(|mark| *mark == "true").count();
        let picture = place.text("s.svg");
        assert_eq!(picture.contains(LEGEND), has_marks, "{scene}");
        // A point has one comma. The line of the legend has two points.
        let dashed = picture.lines().filter(|line| line.contains("stroke-dasharray"));
        let points: usize = dashed.map(|line| line.matches(',').count()).sum();
        assert_eq!(points, if has_marks { count + 2 } else { 0 }, "{scene}");
    }
    // The cells are hatched, not only the legend.
    let body = |picture: &str| {
        let mut rasters = picture.split("<image");
        let body = rasters.find(|raster| raster.contains("width=\"1280\" height=\"880\""));
        body.unwrap().split_once("/>").unwrap().0.to_owned()
    };
    let [marked, plain, strong] =
        ["scene.toml", "elastic.toml", "strong.toml"].map(|scene| body(&svg(&["render", scene]).0));
    assert!(marked != plain && strong == plain);
    // On demand, and left out.
    place.good(&words("map elastic.toml -o asked --channels=regime,peak_strain"));
    let asked = MapSource::open(&place.path("asked/elastic.exr")).unwrap();
    assert_eq!(asked.channels(), ["regime", "peak_strain"]);
    place.good(&words("map scene.toml -o few --channels=regime,margin_deg"));
    let (picture, err) = svg(&["render", "few/scene.exr"]);
    let note =
        "note: no cell is hatched beyond the yield strain: the map has no channel peak_strain";
    assert!(err.contains(note) && !picture.contains(LEGEND), "{err}");
    let run = place.run(&["render", "elastic/elastic.exr", "--channel=peak_strain"]);
    run.assert_refused(&["--channel peak_strain: must be one of regime"]);
}

/// With friction, the two kinds of hatched cells have one line in the legend.
#[test]
fn both_marks_are_in_one_line_of_the_legend() {
    let rough = yielding(0.002).replace("[grid]", "[contact]\nfriction = 0.3\n[grid]");
    let place = Place::with(&rough);
    place.good(&["render", "scene.toml", "--channel=force_un", "-o", "s.svg"]);
    let picture = place.text("s.svg");
    assert!(picture.contains("slides to base, or sticks, or beyond the yield strain"), "{picture}");
}

/// An EXR map, a store and a table have the same strains, and a run of a store with another yield strain is refused.
#[test]
fn a_store_has_the_strains_of_the_map() {
    let place = Place::with(&yielding(0.002));
    place.map(&["scene.toml"]);
    let zarr = words("map scene.toml --engine=cpu --format=zarr -o out");
    place.good(&zarr);
    // Parts of maps and stores have them, too.
    place.good(&["extract", "outputs/scene.exr", "-o", "part.zarr"]);
    place.good(&["extract", "out/scene.zarr", "-o", "part.exr"]);
    let maps = words("outputs/scene.exr out/scene.zarr part.zarr part.exr");
    let tables = maps.into_iter().map(|map| {
        place.good(&["extract", map, "--channel=peak_strain", "-o", "t.csv"]);
        place.text("t.csv")
    });
    let tables: Vec<String> = tables.collect();
    assert!(tables.iter().all(|table| *table == tables[0]));
    let strains = column(&tables[0], "peak_strain").unwrap();
    assert!(strains.iter().filter(|strain| !strain.is_empty()).count() > 100);
    place.write("scene.toml", &yielding(0.003));
    let resumed = place.run(&[&zarr[..], &["--resume"]].concat());
    resumed.assert_said(2, "differs in `scene`");
}

/// A design names the largest strain of each solution, and marks one that yields. Its values stay alone on standard output.
#[test]
fn a_design_names_the_strain_of_a_solution() {
    let design = |strain: f64, more: &[&str]| {
        let place = Place::with(&yielding(strain));
        let words = ["design", "scene.toml", "--distance=15.66"];
        place.good(&[&words[..], more].concat())
    };
    let one = ["--slip-off=20deg", "--for=taper"];
    let plain = Place::with(SCENE)
        .quiet(&[&["design", "scene.toml", "--distance=15.66"], &one[..]].concat());
    let (within, beyond) = (design(0.0025, &one), design(0.002, &one));
    assert_eq!([&within.out, &beyond.out], [&plain.out; 2]);
    let taper = plain.out.trim();
    assert_eq!(
        within.err,
        format!(
            "taper = {taper}: the largest strain of the push is 0.00212405, within whisker.yield_strain = 0.0025\n"
        )
    );
    assert_eq!(
        beyond.err,
        format!(
            "warning: taper = {taper}: the whisker yields: the largest strain of the push, 0.00212405, exceeds whisker.yield_strain = \
             0.002; --max-strain searches for values within it\n"
        )
    );
    // Of several parameters, the strain is the target.
    let several =
        design(0.003, &words("--slip-off=20deg --max-strain=0.004 --for=base_radius_um,taper"));
    assert!(
        several.err.contains("base_radius_um = 56.")
            && several.err.contains("of the push, 0.004, exceeds"),
        "{several:?}"
    );
}
