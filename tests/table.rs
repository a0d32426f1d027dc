//! Tables of whiskers: each row has the results of its whisker alone, and a row without a whisker has its reason and no values.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::compute::compute;
use std::fs;
use whiskmap::classify::{Regime, Status};
use whiskmap::engine::Spectral;
use whiskmap::map::Panel;
use whiskmap::scene::{Coordinate, Parameter, Scene, WhiskerRow};
use whiskmap::trace::DetachmentKind;
use whiskmap::{Options, curve};

/// Scene with the whiskers of a table, each at two values of friction.
fn scene(table: &str) -> String {
    format!(
        "title = \"A pad\"\n[whisker]\nyoungs_modulus_gpa = 3.0\n[whiskers]\ntable = {table}\n[pole]\nradius_mm = 0.2\n\
         [grid]\npush_angle_deg = {{ from = -60, to = 60, count = 25 }}\ndistance_mm = [4.0, 9.0, 14.0]\nfriction = [0.0, 0.2]\n"
    )
}

const ROWS: &str = r#"[
    { name = "A", length_mm = 20, base_radius_um = 30, taper = 0.95, parabola_per_mm = 0.02 },
    { name = "B", length_mm = 12.5, base_radius_um = nan, taper = 0.9 },
    { name = "C", length_mm = 15, base_radius_um = 20, taper = 0, spiral_per_mm = -0.01, spiral_per_mm2 = 0.002 },
    { name = "D", length_mm = 15, base_radius_um = 20, tip_radius_um = 25 },
    { name = "E", length_mm = 16, profile = [[0, 33], [8, 20], [16, 2]] },
    { name = "F", base_radius_um = 30, tip_radius_um = 2, rest_points = [[0, 0], [2.5, 0.1], [5, 0.3], [7.5, 0.7], [10, 1.2], [12, 1.7], [14, 2.4], [16, 3.1], [18, 4.0]] },
]"#;

fn parse(text: &str) -> Result<Scene, String> {
    Scene::parse(text, "pad.toml").map_err(|why| why.to_string())
}

/// A panel without the numbers that depend on which rows an engine got together.
fn values(panel: &Panel) -> (&[u32], &[u32], Vec<u32>) {
    let numbers = panel.state.iter().flatten().map(|value| value.to_bits());
    (&panel.regime, &panel.status, numbers.collect())
}

/// Warnings name the rows of numbers that look like another unit: three of them, each once.
#[test]
fn warnings_name_their_rows() {
    let row = |(name, um): (&str, f64)| {
        format!("{{ name = \"{name}\", length_mm = 20, base_radius_um = {um}, taper = 0.9 }}")
    };
    let rows = [("A", 30.0), ("B", 3e4), ("C", 0.03), ("D", 25.0), ("E", 4e4), ("F", 5e4)];
    let rows = rows.map(row).join(", ");
    let warnings = parse(&scene(&format!("[{rows}]"))).unwrap().warnings();
    let expected = [
        "whiskers.table: B: whisker.base_radius_um = 30000 um: expected 1e-5 to 0.1 of whisker.length_mm = 20 mm, is 1.5e0",
        "whiskers.table: C: whisker.base_radius_um = 0.03 um: expected 1e-5 to 0.1 of whisker.length_mm = 20 mm, is 1.5e-6",
        "whiskers.table: E: whisker.base_radius_um = 40000 um",
    ];
    for start in expected {
        let found = warnings.iter().filter(|warning| warning.starts_with(start));
        assert_eq!(found.count(), 1, "{warnings:?}");
    }
    assert!(warnings.iter().all(|warning| !warning.contains(": A:") && !warning.contains(": F:")));
    let last = "whiskers.table: rows with such warnings that are not named: 1";
    assert_eq!(warnings.last().map(String::as_str), Some(last));
}

#[test]
fn every_row_is_the_map_of_its_whisker() {
    let table = parse(&scene(ROWS)).unwrap();
    assert_eq!(table.whisker_count(), 12);
    let (summary, panels) = compute(&table, None);
    assert_eq!((panels.len(), summary.disagreements), (12, 0));
    for (index, panel) in panels.iter().enumerate() {
        let row = index % 6;
        if [1, 3].contains(&row) {
            let [unresolved, none] = [Regime::Unresolved.code(), Status::NoWhisker.code()];
            assert!(panel.regime.iter().all(|regime| *regime == unresolved));
            assert!(panel.status.iter().all(|status| *status == none));
            assert!(panel.state.iter().flatten().all(|value| value.is_nan()));
            assert!(panel.residual.iter().chain(&panel.margin_deg).all(|value| value.is_nan()));
            assert!(table.of_whisker(index).is_err());
            continue;
        }
        let alone = table.of_whisker(index).unwrap();
        let (_, panels_alone) = compute(&alone, None);
        assert_eq!(values(panel), values(&panels_alone[0]), "{index}");
        assert!(panel.regime.contains(&Regime::Contact.code()));
    }
    let refused: Vec<_> = table.refused().collect();
    let tip = "whisker.tip_radius_um = 25: must be between 0 and base_radius_um (20)";
    assert_eq!(refused, [("B", "base_radius_um is missing"), ("D", tip)]);
    let dense = scene(ROWS)
        .replace("count = 25", "count = 160")
        .replace("[4.0, 9.0, 14.0]", "{ from = 3, to = 16, count = 20 }");
    let dense = parse(&dense).unwrap();
    let (_, panels) = compute(&dense, None);
    let mut spectral = Spectral::default();
    let (summary, by_net) = compute(&dense, Some(&mut spectral));
    assert!(summary.engine_cells.solved > 0);
    for (net, exact) in by_net.iter().zip(&panels) {
        assert_eq!(net.regime, exact.regime);
        assert_eq!(net.status, exact.status);
    }
}

/// Groups of panels, of which some have no whisker at all: in front, between others, and at the end.
#[test]
fn groups_without_a_whisker_have_their_panels() {
    let row = |index: usize| {
        let length_mm = if [200, 4999].contains(&index) { 20.0 } else { f64::NAN };
        WhiskerRow::new(index.to_string())
            .set(Parameter::LengthMm, length_mm)
            .set(Parameter::BaseRadiusUm, 30.0)
            .set(Parameter::TipRadiusUm, 1.5)
    };
    let one = Scene::builder("Few whiskers")
        .set(Parameter::YoungsModulusGpa, 3.0)
        .push_angle_deg([-10.0, 10.0])
        .distance_mm([10.0]);
    let rows: Vec<WhiskerRow> = (0..6000).map(row).collect();
    let scene = one.whiskers(rows).build().unwrap();
    let (summary, panels) = compute(&scene, None);
    assert_eq!(panels.len(), 6000);
    let found = panels.iter().enumerate();
    let found = found.filter(|(_, panel)| panel.status != [Status::NoWhisker.code(); 2]);
    assert_eq!(found.map(|(index, _)| index).collect::<Vec<_>>(), [200, 4999]);
    assert_eq!((summary.cells(), summary.unresolved()), (12_000, 2 * 5998));
}

#[test]
fn every_row_has_the_curve_of_its_whisker() {
    let table = parse(&scene(ROWS)).unwrap();
    let ends = curve(&table, Options::default()).unwrap();
    assert_eq!(ends.len(), 12 * 2 * 3);
    for (index, ends) in ends.chunks(6).enumerate() {
        let name = ["A", "B", "C", "D", "E", "F"][index % 6];
        let friction = [0.0, 0.2][index / 6];
        let place: Vec<_> = ends[0].0.coordinates().collect();
        let named = ("whisker", Coordinate::Name(name.to_owned()));
        assert_eq!(place, [named, ("friction", Coordinate::Number(friction))]);
        match table.of_whisker(index) {
            Ok(alone) => {
                let ends_alone = curve(&alone, Options::default()).unwrap();
                assert!(ends.iter().zip(&ends_alone).all(|((_, one), (_, other))| one == other));
            }
            Err(_) => {
                let mut kinds = ends.iter().map(|(_, end)| end.kind);
                assert!(kinds.all(|kind| kind == DetachmentKind::NoWhisker));
            }
        }
    }
}

/// A table is the same listed, in a file, and in the text of the scene that was built or read.
#[test]
fn tables_survive_their_texts() {
    let listed = parse(&scene(ROWS)).unwrap();
    let built = listed.to_builder().build().unwrap();
    for text in [listed.to_toml(), built.to_toml()] {
        let again = parse(&text).unwrap();
        assert_eq!((&again.grid, &again.table), (&listed.grid, &listed.table));
    }
    let place = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(place.path().join(name), text).unwrap();
    write("e.csv", "arc_length_mm,radius_um\n0,33\n8,20\n16,2\n");
    write(
        "f.csv",
        "x_mm,y_mm\n0,0\n2.5,0.1\n5,0.3\n7.5,0.7\n10,1.2\n12,1.7\n14,2.4\n16,3.1\n18,4.0\n",
    );
    write(
        "pad.csv",
        "name;day;length_mm;base_radius_um;tip_radius_um;profile;rest_points\nA;1;20;30;1,5;;\nB;1;12,5;;2;;\nE;2;16;;;e.csv;\n\
         F;2;;30;2;;f.csv\n",
    );
    write("pad.toml", &scene("\"pad.csv\""));
    let read = Scene::read(place.path().join("pad.toml")).unwrap();
    let files: Vec<_> = read.csv_files().iter().map(|path| path.file_name().unwrap()).collect();
    assert_eq!(files, ["pad.csv", "e.csv", "f.csv"]);
    assert!(read.notes()[0].contains("columns that are not used: day"), "{:?}", read.notes());
    let found: Vec<_> = read.table.iter().map(|row| row.found.is_ok()).collect();
    assert_eq!(found, [true, false, true, true]);
    assert_eq!(read.table[2..], listed.table[4..]);
    let again = parse(&read.to_toml()).unwrap();
    assert_eq!((&again.grid, &again.table), (&read.grid, &read.table));
}

#[test]
fn wrong_tables_are_refused() {
    for (table, said) in [
        ("[]", "whiskers.table: must have between 1 and 65536 rows, has 0"),
        ("3", "expected the name of a CSV file or a list of { name, length_mm, ... }"),
        ("\"pad.csv\"", "must be a list of rows: only a scene file may name a CSV file"),
        ("[{ length_mm = 20 }]", "missing field `name`"),
        ("[{ name = \" \" }]", "whiskers.table[0]: the name of the whisker is missing"),
        ("[{ name = \"A\", lenght_mm = 20 }]", "did you mean `length_mm`?"),
        (
            "[{ name = \"A\", length_mm = \"20\" }]",
            "invalid type: string \"20\", expected a number",
        ),
        (
            "[{ name = \"A\", taper = 0.9, tip_radius_um = 2 }]",
            "must have either a taper or a tip_radius_um",
        ),
        (
            "[{ name = \"A\", length_mm = 20 }, { name = \"A\", length_mm = 21 }]",
            "whiskers.table[1]: the name of a whisker must be unlike those before it; row 1 is A too",
        ),
        (
            "[{ name = \"A\", parabola_per_mm = 0.1, curvature_per_mm = 0.1 }]",
            "whiskers.table[0]: must have either parabola_per_mm or curvature_per_mm, which are one",
        ),
        (
            "[{ name = \"A\", length_mm = 20, base_radius_um = 30 }]",
            "whiskers.table: must have a row with a whisker; row 1: whisker.tip_radius_um: is left out",
        ),
        (
            "[{ name = \"A\", length_mm = 20, base_radius_um = 30, rest_points = \"a.csv\" }]",
            "must be a list of points: only a scene file may name a CSV file",
        ),
    ] {
        let why = parse(&scene(table)).unwrap_err();
        assert!(why.contains(said), "{why}");
    }
    // A row is refused at the distances of the grid, too.
    let rows = "[{ name = \"A\", length_mm = 20, base_radius_um = 30, taper = 1 }, \
                { name = \"B\", length_mm = 1, base_radius_um = 3, taper = 1 }]";
    let small = parse(&scene(rows)).unwrap();
    let [(name, reason)] = small.refused().collect::<Vec<_>>()[..] else {
        unreachable!("one row of two is refused")
    };
    assert_eq!(name, "B");
    assert!(
        reason.contains("must be between length_mm / 1000 (0.001) and 10 * length_mm (10)"),
        "{reason}"
    );
}

/// A number of the scene has no effect where a column gives it, and a taper of the scene is that of its own base.
#[test]
fn numbers_that_a_column_gives_are_refused() {
    let numbers = "length_mm = 20\nbase_radius_um = 30\ntip_radius_um = 1.5\n";
    let text = scene("[{ name = \"A\", COLUMN }, { name = \"B\" }]")
        .replace("[whisker]\n", &format!("[whisker]\n{numbers}"));
    let with = |column: &str| parse(&text.replace("COLUMN", column)).unwrap();
    let bent = text.replace("[pole]", "[whisker.curvature]\nparabola_per_mm = 0.02\n[pole]");
    let bent = parse(&bent.replace("COLUMN", "spiral_per_mm = 0.01, spiral_per_mm2 = 0.001"));
    for (table, parameter, value, said) in [
        (&with("length_mm = 18"), Parameter::LengthMm, 15.0, "whisker.length_mm = 15"),
        (&with("taper = 0.9"), Parameter::TipRadiusUm, 2.0, "whisker.tip_radius_um = 2"),
        (&with("tip_radius_um = 2"), Parameter::Taper, 0.5, "whisker.taper = 0.5"),
        (&with("base_radius_um = 40"), Parameter::Taper, 0.5, "whisker.taper = 0.5"),
        (
            &bent.unwrap(),
            Parameter::ParabolaPerMm,
            0.01,
            "whisker.curvature.parabola_per_mm = 0.01",
        ),
    ] {
        let (column, _) = table.table_rows()[0].numbers()[0];
        let said =
            format!("{said}: must be left out: whiskers.table has the column {}", column.name());
        let why = table.with(parameter, value).unwrap_err().to_string();
        assert_eq!(why, format!("error: {said}"));
        // The whisker of a row is a scene without a table.
        assert!(table.of_whisker(1).unwrap().with(parameter, value).is_ok());
    }
    let tapers = with("taper = 0.9").with(Parameter::BaseRadiusUm, 40.0);
    let tapers = tapers.unwrap().whisker(0).unwrap().whisker;
    assert!((tapers.tip_radius_um - 4.0).abs() < 1e-12);
    let tapered = Scene::builder("A pad").set(Parameter::LengthMm, 20.0).set(Parameter::Taper, 0.5);
    let rows = [WhiskerRow::new("A").set(Parameter::BaseRadiusUm, 30.0)];
    let why = tapered.whiskers(rows).build().unwrap_err().to_string();
    let said = "must be left out: whiskers.table has the column base_radius_um";
    assert_eq!(why, format!("error: whisker.taper = 0.5: {said}"));
    let tapered = text.replace("tip_radius_um = 1.5", "taper = 0.95");
    let why = parse(&tapered.replace("COLUMN", "base_radius_um = 40")).unwrap_err();
    assert!(why.contains(said), "{why}");
    let measured = scene("[{ name = \"A\", length_mm = 16 }]");
    let measured =
        measured.replace("[whisker]\n", "[whisker]\nprofile.rows = [[0, 33], [16, 2]]\n");
    let measured = parse(&measured).unwrap().with(Parameter::Taper, 0.5);
    let said = "whisker.taper = 0.5: must be left out: the radii are those of whisker.profile";
    assert_eq!(measured.unwrap_err().to_string(), format!("error: {said}"));
}
