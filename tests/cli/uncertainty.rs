//! `whiskmap curve --samples`, and `[uncertainty]` elsewhere.

use super::traces::{CURVE, SPREAD, cells};
use super::{Place, SCENE, names, words};

const UNCERTAIN: &str = "[uncertainty]\nbase_radius_um = 1.0\ntip_radius_um = 0.3\n";

fn uncertain() -> Place {
    Place::with(&format!("{SCENE}{UNCERTAIN}"))
}

#[test]
fn a_spread_is_a_table_and_bands() {
    let place = uncertain();
    let sample = ["curve", "scene.toml", "--samples", "20"];
    let run = place.quiet(&sample);
    let rows = cells(&run.out, SPREAD);
    assert_eq!(rows.len(), 48);
    let curve = place.quiet(&["curve", "scene.toml"]).out;
    for (row, curve) in rows.iter().zip(cells(&curve, CURVE)) {
        assert_eq!((row[0], row[1], row[2], row[3]), (curve[0], curve[1], curve[3], curve[4]));
        let counts = row[4..8].iter().map(|count| count.parse::<u32>().unwrap());
        assert_eq!(counts.sum::<u32>(), 20, "{row:?}");
        let percentiles: Vec<f64> = row[8..13].iter().flat_map(|p| p.parse()).collect();
        assert!(percentiles.is_sorted() && (percentiles.len() == 5 || row[6] == "20"), "{row:?}");
    }
    // The default seed is 1.
    let seeded = |seed| place.quiet(&[&sample[..], &["--seed", seed]].concat()).out;
    assert_eq!(seeded("1"), run.out);
    assert_ne!(seeded("2"), run.out);

    let files = ["--csv", "t.csv", "--plot", "p.svg"];
    place.quiet(&[&sample[..], &files].concat());
    assert_eq!(place.bytes("t.csv"), run.out.as_bytes());
    let svg = place.text("p.svg");
    assert_eq!(svg.matches("<polygon").count(), 4, "two sides, two bands");
    assert!(svg.contains(">5 to 95 % of samples<") && svg.contains(">25 to 75 % of samples<"));
}

/// At one distance, a bar shows the range of a band.
#[test]
fn a_spread_at_one_distance_has_bars() {
    let place = uncertain();
    let plot = ["--samples", "20", "--distance", "12", "--plot", "p.svg"];
    place.run(&[&["curve", "scene.toml", "--csv", "t.csv"], &plot[..]].concat());
    let svg = place.text("p.svg");
    let polygons = svg.lines().filter(|line| line.starts_with("<polygon"));
    let corners = polygons.map(|line| line.matches(',').count());
    assert_eq!(corners.collect::<Vec<_>>(), [4; 4], "two sides, two bands: {svg}");
    // Out of reach, there is nothing to draw.
    let far = ["--samples", "20", "--distance", "50", "--plot", "p.svg"];
    let run = place.run(&[&["curve", "scene.toml", "--csv", "t.csv"], &far[..]].concat());
    assert!(run.err.contains("warning: the picture is empty"), "{run:?}");
    assert!(!place.text("p.svg").contains("of samples"));
}

/// One picture has the bands, the points and their error bars; the table has the points, and the percentiles at each.
#[test]
fn samples_and_measured_points_share_a_plot() {
    let place = uncertain();
    let data = "side,distance_mm,push_angle_deg,kind,sd_deg\ncb,10,40,slip-off,1.5\ncf,15,-29,slip-off,0.5\n";
    place.write("points.csv", data);
    let curve = words("curve scene.toml --samples 20 --data points.csv");
    place.good(&[&curve[..], &["--csv", "t.csv", "--plot", "p.svg"]].concat());
    let table = place.text("t.csv");
    let columns = format!("{},p5_deg,p25_deg,p50_deg,p75_deg,p95_deg", super::data::POINTS);
    let rows = cells(&table, &columns);
    assert_eq!([rows[0][4], rows[1][4]], ["1.5", "0.5"]);
    // The same samples as without points.
    let alone = [&curve[..4], &["--distance", "10,15"]].concat();
    let alone = place.quiet(&alone).out;
    let spread = cells(&alone, SPREAD);
    assert_eq!((spread[0][0], spread[1][0], spread[2][0]), ("cf", "cf", "cb"));
    // Measured: at most 4e-14 apart, because continuation starts elsewhere.
    for (row, alone) in [(&rows[0], &spread[2]), (&rows[1], &spread[1])] {
        for (cell, other) in row[10..].iter().zip(&alone[8..13]) {
            let [cell, other] = [cell, other].map(|cell| cell.parse::<f64>().unwrap());
            assert!((cell / other - 1.0).abs() < 1e-9, "{row:?} {alone:?}");
        }
    }
    let svg = place.text("p.svg");
    assert_eq!(svg.matches("<polygon").count(), 4, "two sides, two bands");
    // Both points and the sample in the legend.
    assert_eq!(svg.matches("<circle").count(), 3, "{svg}");
    assert!(svg.contains(" \u{b1} standard deviation<"), "{svg}");
    assert_eq!(place.run(&curve).out, table);
    place.write("points.csv", &data.replace("push_angle_deg", "push_chord_deg"));
    let chords = place.run(&[&curve[..], &["--plot", "q.svg"]].concat());
    chords.assert_refused(&[
        "--samples: bands are of push angles, and points.csv has push_chord_deg",
    ]);

    let forces = words("curve scene.toml --samples 20 --x force_un --plot f.svg");
    place.quiet(&forces);
    let svg = place.text("f.svg");
    assert!(svg.contains("force at detachment"), "{svg}");
    assert_eq!(svg.matches("<polygon").count(), 4, "two sides, two bands");
}

/// Commands that draw no whiskers ignore the table, also in stored scenes.
#[test]
fn other_commands_leave_the_table_alone() {
    let place = uncertain();
    place.write("plain.toml", SCENE);
    let both = |arguments: &[&str]| {
        let outs = ["scene.toml", "plain.toml"].map(|scene| {
            let words: Vec<&str> =
                arguments.iter().map(|word| if *word == "SCENE" { scene } else { word }).collect();
            place.quiet(&words).out
        });
        assert_eq!(outs[0], outs[1], "{arguments:?}");
    };
    both(&["curve", "SCENE"]);
    both(&["branch", "SCENE", "--distance=9"]);
    both(&["shape", "SCENE", "--distance=9", "--push-angle=9"]);
    both(&words("design SCENE --distance=15.66 --slip-off=20 --for=taper"));
    place.map(&["scene.toml"]).assert_settled();
    place.quiet(&["render", "outputs/scene.exr", "-o", "again.png"]);
}

#[test]
fn draws_outside_of_the_limits_are_counted() {
    let place = Place::with(&format!("{SCENE}[uncertainty]\ntip_radius_um = 1.5\n"));
    let run = place.good(&["curve", "scene.toml", "--samples", "50"]);
    let warning = "draws were outside the scene's limits and were repeated\n";
    assert!(run.err.starts_with("note: ") && run.err.ends_with(warning), "{run:?}");
}

#[test]
fn samples_without_sense_are_refused() {
    let place = uncertain();
    place.write("plain.toml", SCENE);
    let sample = ["curve", "plain.toml", "--samples", "20", "--csv", "t.csv"];
    let missing = ["--samples 20: the scene has no [uncertainty]: add that table"];
    place.run(&sample).assert_refused(&missing);
    let refused = |more: &[&str], parts: &[&str]| {
        place.run(&[&["curve", "scene.toml"], more].concat()).assert_refused(parts);
    };
    refused(&["--samples", "1"], &["'1'", "must be a whole number between 2 and 1000000"]);
    refused(&["--samples", "9", "--seed", "-1"], &["'-1'"]);
    refused(&["--seed", "9"], &["--samples"]);
    refused(&["--samples", "9", "--corner"], &["cannot be used with"]);
    refused(
        &["--samples", "1000000"],
        &["--samples 1000000: makes 24000000 ends at the scene's 24 distances", "at most 16777216"],
    );
    let sweep = format!("{SCENE}curvature_per_mm = [0.02, 0.03]\n{UNCERTAIN}");
    place.write("sweep.toml", &sweep);
    let words = ["curve", "sweep.toml", "--samples", "5", "--distance", "10"];
    place.run(&words).assert_refused(&[
        "grid.curvature_per_mm: the scene sweeps 2 whiskers, but curve --samples needs one; select it by --at",
    ]);
    // A selected whisker is one.
    let run = place.good(&[&words[..], &["--at", "curvature_per_mm=0.02"]].concat());
    let alone = place.quiet(&["curve", "scene.toml", "--samples", "5", "--distance", "10"]);
    assert_eq!(run.out, alone.out);
    let left = ["plain.toml", "scene.toml", "sweep.toml"];
    assert_eq!(names(&place.path("")), left);
}

/// The largest loads follow the other columns, and without --samples there are none.
#[test]
fn largest_loads_are_more_columns() {
    let place = uncertain();
    let words = ["curve", "scene.toml", "--distance", "10", "--samples", "5"];
    let ends = place.quiet(&words).out;
    let largest = place.quiet(&[&words[..], &["--largest"]].concat()).out;
    let (ends, largest): (Vec<&str>, Vec<&str>) =
        (ends.lines().collect(), largest.lines().collect());
    assert_eq!(ends.len(), largest.len());
    for (end, largest) in ends.iter().zip(&largest) {
        let more = largest.strip_prefix(&format!("{end},")).unwrap();
        assert_eq!(more.split(',').count(), 24, "{more}");
    }
    assert!(largest[0].ends_with(",max_strain_mean,max_strain_sd"), "{}", largest[0]);
    place.run(&["curve", "scene.toml", "--largest"]).assert_refused(&["--samples <N>"]);
}
