//! `whiskmap sensitivity` and the columns of `--derivatives`.

use super::{Place, SCENE, words};

fn lines(out: &str) -> Vec<Vec<String>> {
    let line = |line: &str| line.split(',').map(str::to_owned).collect();
    out.lines().map(line).collect()
}

/// A cell of the column `name` in a line with these `cells`.
fn cell<'a>(header: &[String], cells: &'a [String], name: &str) -> &'a str {
    let column = header.iter().position(|column| column == name).unwrap();
    &cells[column]
}

/// Lengths alone scale no angle: the products of derivatives and values of all lengths add up to 0.
#[test]
fn the_table_has_every_variable_of_the_scene() {
    let place = Place::with(SCENE);
    let run =
        place.quiet(&words("sensitivity scene.toml --distance 15.66 --csv - --plot bars.svg"));
    let table = lines(&run.out);
    let (header, rows) = table.split_first().unwrap();
    let sum = |side: &str| -> f64 {
        let of_side = rows.iter().filter(|row| row[0] == side);
        let part = |row: &Vec<String>| {
            let [value, slope] =
                ["value", "d_push_deg"].map(|name| cell(header, row, name).parse::<f64>().unwrap());
            match cell(header, row, "variable") {
                "length_mm" | "vertex_mm" | "pole_radius_mm" | "distance_mm" => value * slope,
                "parabola_per_mm" => -value * slope,
                _ => 0.0,
            }
        };
        of_side.map(part).sum()
    };
    assert!(sum("cb").abs() < 1e-9 && sum("cf").abs() < 1e-9, "{}", run.out);
    // Forces and moments are proportional to the modulus, and strains do not depend on it.
    for row in rows.iter().filter(|row| cell(header, row, "variable") == "youngs_modulus_gpa") {
        let number = |name: &str| cell(header, row, name).parse::<f64>().unwrap();
        for [size, slope] in [
            ["max_contact_force_un", "d_max_contact_force_un"],
            ["max_base_moment_nnm", "d_max_base_moment_nnm"],
        ] {
            assert!((number("value") * number(slope) / number(size) - 1.0).abs() < 1e-9, "{row:?}");
        }
        assert!((1e-4..0.1).contains(&number("max_strain")), "{row:?}");
    }
    let svg = place.text("bars.svg");
    assert!(svg.contains("distance_mm") && svg.contains("+1 %"));
}

/// The columns of a curve are those of the table, and a fold of a branch has no derivatives.
#[test]
fn curves_and_branches_have_columns_of_derivatives() {
    let place = Place::with(SCENE);
    let all = place.quiet(&["sensitivity", "scene.toml", "--distance", "15.66"]);
    let all = lines(&all.out);
    let curve = place.quiet(&words("curve scene.toml --distance 15.66 --derivatives=taper"));
    let curve = lines(&curve.out);
    for (side, line) in [("cf", &curve[1]), ("cb", &curve[2])] {
        let push_row = all.iter().find(|row| row[0] == side && row[4] == "taper").unwrap();
        assert_eq!(cell(&curve[0], line, "d_push_d_taper"), cell(&all[0], push_row, "d_push_deg"));
    }
    let branch = place
        .quiet(&words("branch scene.toml --distance 15.66 --side cb --points 9 --derivatives"));
    let branch = lines(&branch.out);
    let (header, rows) = branch.split_first().unwrap();
    for row in rows {
        let mark = cell(header, row, "mark");
        let stiffness = cell(header, row, "d_moment_d_push_angle_deg");
        assert_eq!(
            stiffness.is_empty(),
            mark.contains("slip-off") || mark.contains("fold"),
            "{mark}"
        );
    }
    let refused = place.run(&["curve", "scene.toml", "--derivatives=spiral_per_mm"]);
    assert_eq!(refused.code, Some(2));
    assert!(
        refused.err.contains("--derivatives spiral_per_mm: must be one of length_mm"),
        "{}",
        refused.err
    );
}

/// Both formats store derivatives, which come back as they are extracted; an absent parameter is refused.
#[test]
fn maps_store_derivatives_on_demand() {
    let place = Place::with(SCENE);
    let channels = "--channels=regime,margin_deg,d_push_d_taper";
    for format in ["exr", "zarr"] {
        place.map(&["scene.toml", "--no-png", channels, "--format", format]);
    }
    let tables = ["exr", "zarr"].map(|ending| {
        let source = format!("outputs/scene.{ending}");
        place.quiet(&["extract", &source, "-o", "table.csv"]);
        lines(&place.text("table.csv"))
    });
    // Channels of an EXR file are sorted by name.
    let [exr, zarr] = tables.each_ref().map(|table| {
        let (header, rows) = table.split_first().unwrap();
        let of_row =
            |row| ["regime", "margin_deg", "d_push_d_taper"].map(|name| cell(header, row, name));
        rows.iter().map(|row| of_row(row)).collect::<Vec<_>>()
    });
    assert_eq!(exr, zarr);
    let (header, rows) = tables[0].split_first().unwrap();
    let known = rows.iter().filter(|row| {
        let by = cell(header, row, "d_push_d_taper");
        assert_eq!(by.is_empty(), cell(header, row, "regime") != "1", "{row:?}");
        !by.is_empty()
    });
    assert!(known.count() > 20);
    place.quiet(&["render", "outputs/scene.exr", "--channel", "d_push_d_taper"]);
    let refused = place.run(&["map", "scene.toml", "--channels=regime,d_push_d_friction"]);
    assert_eq!(refused.code, Some(2));
    assert!(refused.err.contains("d_push_d_friction has no values"), "{}", refused.err);
}
