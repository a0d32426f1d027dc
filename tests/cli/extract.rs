//! `whiskmap extract`: slices of stores and maps.

use super::store::{SWEEP, good};
use super::{Place, SCENE, words};
use std::fs;
use whiskmap::classify::Regime;
use whiskmap::scene::Parameter;
use whiskmap::store::{StoredMap, ZarrStore};

/// Compares values of a table or an array with those of the store.
#[test]
fn a_slice_is_what_the_store_has_there() {
    let place = Place::with(SWEEP);
    good(&place, ".", &[]);
    let store = ZarrStore::open(&place.path("scene.zarr")).unwrap();
    let run = |arguments: &[&str]| place.run(&[&["extract", "scene.zarr"], arguments].concat());

    // The nearest radius is 0.2, the second of the third axis.
    let at = words("--at=taper=0.6 --at=pole_radius_mm=0.21 --at=push_angle_deg=-70");
    let said = run(&[&at[..], &["--channel=regime", "--channel=force_un", "-o", "s.csv"]].concat());
    assert_eq!((said.code, &*said.out), (Some(0), "s.csv\n"), "{said:?}");
    assert!(said.err.starts_with("taper = 0.5\npole_radius_mm = 0.2"), "{said:?}");
    let table = place.text("s.csv");
    let mut lines = table.lines();
    let header =
        "taper,friction,pole_radius_mm,distance_mm,push_angle_deg,regime,regime_name,force_un";
    assert_eq!(lines.next(), Some(header));
    for friction in 0..2 {
        let whisker = 1 + 3 * friction + 6;
        let [regime, force] =
            ["regime", "force_un"].map(|name| store.read_panel(name, whisker).unwrap());
        for row in 0..64 {
            let cells: Vec<&str> = lines.next().unwrap().split(',').collect();
            assert_eq!(cells[1], ["0.0", "0.3"][friction]);
            assert_eq!(cells[4..6], ["-70.0", &regime.value(row * 64).to_string()]);
            let code = regime.value(row * 64) as u32;
            let named = Regime::ALL.into_iter().find(|regime| regime.code() == code).unwrap();
            assert_eq!(cells[6], named.name());
            let value = force.value(row * 64);
            let found = cells[7].parse::<f32>().map(f64::from).ok();
            assert_eq!(found, Some(value).filter(|value| value.is_finite()));
        }
    }
    assert_eq!(lines.next(), None);

    // Half a step beyond the end is the end, whatever the unit.
    let beyond = ["--at=distance_mm=2.01cm", "--at=push_angle_deg=-1.23rad"];
    let said = run(&[&beyond[..], &["--channel=regime", "-o", "s.csv"]].concat());
    assert_eq!(said.err, "distance_mm = 20\npush_angle_deg = -70\n", "{said:?}");

    let npy = words("--at=taper=0.5 --channel=force_un --exact -o s.npy");
    assert_eq!(run(&npy).code, Some(0));
    let bytes = place.bytes("s.npy");
    let start = bytes.len() - 2 * 4 * 4096 * 4;
    let header = String::from_utf8_lossy(&bytes[..start]).into_owned();
    assert!(header.contains("'shape': (2,4,64,64,)") && start.is_multiple_of(64), "{header}");
    // Friction is the slower one of the two that are left.
    let second = store.read_panel("force_un", 1 + 6).unwrap();
    let values: Vec<f32> = bytes[start + 4 * 4096..][..4 * 4096]
        .chunks(4)
        .map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap()))
        .collect();
    let mut pairs = values.iter().map(|value| f64::from(*value)).zip(second.values());
    assert!(pairs.all(|(a, b)| a == b || a.is_nan() && b.is_nan()));

    for (arguments, said) in [
        (
            &["-o", "s.exr"][..],
            "a map holds at most two sweep axes, the slice has taper, friction, pole_radius_mm",
        ),
        (&["-o", "s.npy"], "give one --channel"),
        (&["-o", "s.txt"], "must end in .csv, .npy, .zarr or .exr"),
        (
            &["--at=colour=1", "-o", "s.csv"],
            "--at colour: must be one of the axes, taper, friction",
        ),
        (&["--at=frction=0", "-o", "s.csv"], "push_angle_deg; did you mean `friction`?"),
        (
            &["--at=distance_cm=1.5", "-o", "s.csv"],
            "; values must be in mm: convert them, and use the name `distance_mm`",
        ),
        (
            &["--at=distance_mm=150", "-o", "s.csv"],
            "--at distance_mm: 150 mm is more than half a step beyond the axis, which goes from 2 mm to 20 mm",
        ),
        (
            &["--at=distance_mm=1", "-o", "s.csv"],
            "--at distance_mm: 1 mm is more than half a step beyond the axis",
        ),
        (
            &["--at=distance_mm=3cm", "-o", "s.csv"],
            "--at distance_mm: 30 mm is more than half a step beyond the axis",
        ),
        (
            &["--at=push_angle_deg=5mm", "-o", "s.csv"],
            "unit mm: must be deg (the default), ° or rad",
        ),
        (&["--at=taper=1mm", "-o", "s.csv"], "unit mm: must be left out"),
        (&["--at=taper", "-o", "s.csv"], "must be AXIS=VALUE"),
        (
            &["--at=taper=0.6", "--exact", "-o", "s.csv"],
            "--at taper: 0.6 is no value of the axis; the nearest is 0.5",
        ),
        (
            &["--channel=force", "-o", "s.csv"],
            "--channel force: must be one of regime, status, arc_length_mm",
        ),
    ] {
        run(arguments).assert_refused(&[said]);
    }
}

/// The map of a slice equals the map of the scene with this value, up to rounding.
#[test]
fn a_map_of_a_slice_can_be_drawn() {
    let place = Place::with(SWEEP);
    good(&place, ".", &[]);
    let extract = words("extract scene.zarr --at=friction=0.3 -o slice.exr");
    place.good(&extract);
    let slice = StoredMap::open(&place.path("slice.exr")).unwrap();
    assert_eq!(slice.title, "A sweep in blocks, friction = 0.3");
    assert_eq!((slice.layout.columns, slice.layout.rows), (3, 4));
    let store = ZarrStore::open(&place.path("scene.zarr")).unwrap();
    for panel in 0..12 {
        let whisker = panel % 3 + 3 + panel / 3 * 6;
        for name in slice.channels() {
            let part = slice.read_panel(name, panel).unwrap();
            let whole = store.read_panel(name, whisker).unwrap();
            let mut pairs = part.values().zip(whole.values());
            assert!(pairs.all(|(a, b)| a == b || a.is_nan() && b.is_nan()), "{name}");
        }
    }
    place.good(&["render", "slice.exr", "-o", "slice.png"]);
    let again = ["extract", "slice.exr", "--at=taper=1", "-o", "again.exr"];
    place.good(&again);
    assert_eq!(StoredMap::open(&place.path("again.exr")).unwrap().layout.columns, 4);
}

/// A store of a slice is a complete store: it contains its scene, and can be sliced and drawn.
#[test]
fn a_store_of_a_slice_has_the_values_of_the_whole() {
    let place = Place::with(SWEEP);
    good(&place, ".", &[]);
    let extract = |from: &str, arguments: &[&str]| {
        place.good(&[&["extract", from], arguments].concat());
    };
    let at = words("--at=friction=0.2 --at=distance_mm=5.1 -o slice.zarr");
    extract("scene.zarr", &at);
    place.quiet(&["status", "slice.zarr", "--verify"]);
    let [whole, slice] =
        ["scene.zarr", "slice.zarr"].map(|name| ZarrStore::open(&place.path(name)).unwrap());
    let row = whole.scene.grid.distance_mm.iter().position(|d| (d - 5.1).abs() < 0.1);
    let row = row.unwrap();
    assert_eq!(slice.scene.grid.distance_mm, whole.scene.grid.distance_mm[row..=row]);
    assert_eq!(slice.scene.grid.axis(Parameter::Friction), Some(&[0.3][..]));
    assert!(
        slice.scene.title.starts_with("A sweep in blocks, friction = 0.3, distance_mm = 5.14286")
    );
    assert_eq!(slice.channels, whole.channels);
    for name in slice.channels.names() {
        for whisker in 0..12 {
            let part = slice.read_panel(name, whisker).unwrap();
            let from = whole.read_panel(name, whisker % 3 + 3 + whisker / 3 * 6).unwrap();
            let mut pairs = part.values().zip(from.values().skip(row * 64));
            let same = pairs.all(|(a, b)| a == b || a.is_nan() && b.is_nan());
            assert!(same, "{name}, whisker {whisker}");
        }
    }

    // A repeated run rewrites an equal store, but does not replace another one.
    extract("slice.zarr", &["--at=taper=1", "--exact", "-o", "again.zarr"]);
    extract("scene.zarr", &["--at=taper=1", "--at=friction=0.3", "-o", "map.exr"]);
    for channel in [&[][..], &["--channel=force_un"]] {
        let of_map = [&["--at=push_angle_deg=-70", "-o", "map.zarr"], channel].concat();
        extract("map.exr", &of_map);
        extract("map.exr", &of_map);
        let other = words("extract map.exr --at=push_angle_deg=70 -o map.zarr");
        let run = place.run(&[&other, channel].concat());
        run.assert_said(2, "map.zarr differs in `scene`");
        run.assert_said(2, "push_angle_deg = -70\" there");
        fs::remove_dir_all(place.path("map.zarr")).unwrap();
    }
    let draw = words("render again.zarr --at=friction=0.3 --at=taper=1 -o a.png");
    place.good(&draw);
}

/// The selected value would make the title longer than allowed.
#[test]
fn the_longest_title_is_extracted() {
    let title = "t".repeat(1000);
    let place = Place::with(&SCENE.replace("A small map", &title));
    place.map(&["scene.toml", "--no-png"]);
    let at = ["--at=push_angle_deg=-70", "-o", "part.exr"];
    place.good(&[&["extract", "outputs/scene.exr"], &at[..]].concat());
    assert_eq!(StoredMap::open(&place.path("part.exr")).unwrap().title, title);
}
