//! Points that name their whiskers: each is compared with its own whisker of a table, and the whiskers share what is fitted.

use whiskmap::Side;
use whiskmap::fit::{FitError, fit};
use whiskmap::measured::MeasuredPoints;
use whiskmap::scene::{Parameter::*, Scene, WhiskerRow};
use whiskmap::trace::curve;

/// Length, base and tip radius of each whisker of the table.
const WHISKERS: [(&str, [f64; 3]); 3] =
    [("C1", [25.0, 40.0, 2.0]), ("C2", [18.0, 33.0, 1.5]), ("C3", [12.0, 26.0, 1.0])];

/// A table of [`WHISKERS`] and of one without a radius, in follicles of the same stiffness.
fn table() -> Scene {
    let text = "title = 'Table'\n[whisker]\nlength_mm = 20\nbase_radius_um = 30\ntip_radius_um = 1.5\nyoungs_modulus_gpa = 3\n\
        curvature.parabola_per_mm = 0.01\nfollicle.stiffness_nnm_per_rad = 3000\n[pole]\nradius_mm = 0.25\n[contact]\nfriction = 0.1\n\
        [grid]\npush_angle_deg = [0, 10]\ndistance_mm = [5, 6]\n";
    let rows = WHISKERS.map(|(name, [length, base, tip])| {
        let row = WhiskerRow::new(name).set(LengthMm, length);
        row.set(BaseRadiusUm, base).set(TipRadiusUm, tip)
    });
    let unknown = WhiskerRow::new("C4").set(BaseRadiusUm, f64::NAN);
    let rows: Vec<WhiskerRow> = rows.into_iter().chain([unknown]).collect();
    let scene = Scene::parse(text, "table").unwrap();
    scene.to_builder().whiskers(rows).build().unwrap()
}

/// The detachments of all whiskers of `scene`, in an order in which neighbours belong to different whiskers.
fn points(scene: &Scene) -> MeasuredPoints {
    let mut text = "whisker,side,distance_mm,push_angle_deg\n".to_owned();
    for part in [0.3, 0.5, 0.7] {
        for swept in scene.whiskers().flatten() {
            let name = swept.place.whisker().unwrap();
            let distance_mm = part * swept.whisker.length_mm;
            for side in Side::BOTH {
                let end = curve(&swept.whisker, &swept.pole, side, &[distance_mm])[0];
                let side = format!("{side:?}").to_lowercase();
                let push_deg = end.push_angle_deg.unwrap();
                text += &format!("{name},{side},{distance_mm},{push_deg}\n");
            }
        }
    }
    MeasuredPoints::parse(&text, "points.csv").unwrap()
}

#[test]
fn whiskers_of_a_table_share_the_fitted_values() {
    let truth = [(FollicleStiffness, 3000.0), (Friction, 0.1), (PoleRadiusMm, 0.25)];
    let points = points(&table());
    let start = table().with_parameters(&[
        (FollicleStiffness, 10_000.0),
        (Friction, 0.3),
        (PoleRadiusMm, 0.4),
    ]);
    let found = fit(&start.unwrap(), &points, &truth.map(|(parameter, _)| parameter)).unwrap();
    for (estimate, (parameter, value)) in found.estimates.iter().zip(truth) {
        let off = (estimate.value / value - 1.0).abs();
        assert!(off < 1e-9, "{parameter:?}: {off:e}");
        assert!(estimate.standard_error.unwrap() < 1e-6 * value);
    }
    // The table stays as it is.
    let rows = |scene: &Scene| format!("{:?}", scene.table_rows());
    assert_eq!(rows(&found.scene), rows(&table()));
    assert!(found.comparison.rms_deg().unwrap() < 1e-9);
    assert_eq!(found.comparison.count(), 18);
}

/// A whisker is compared with the points that name it, and with no others.
#[test]
fn points_of_one_whisker_are_taken_out() {
    let table = table();
    let all = points(&table);
    for swept in table.whiskers().flatten() {
        let points = all.at(&swept.place).unwrap();
        assert_eq!((points.whiskers.len(), points.points.len()), (0, 6));
        let beside = points.beside(&swept.whisker, &swept.pole);
        // On a sheet with other rows, an end has another rounding: 2e-12 degrees.
        let rms = beside.rms_deg().unwrap();
        assert!(rms < 1e-11, "{rms:e}");
    }
    let refused = table.grid.place(3);
    let why = all.at(&refused).unwrap_err().to_string();
    assert!(why.contains("has no point of the whisker C4"), "{why}");
}

#[test]
fn points_of_other_whiskers_are_refused() {
    let head = "whisker,side,distance_mm,push_angle_deg\nC1,cb,8,20\n";
    let refused = |scene: &Scene, row: &str, free| -> FitError {
        let points = MeasuredPoints::parse(&format!("{head}{row}\n"), "p.csv").unwrap();
        fit(scene, &points, &[free]).unwrap_err()
    };
    let table = table();
    let single = table.of_whisker(0).unwrap();
    for (scene, row, free, said) in [
        (
            &table,
            "C22,cb,8,20",
            FollicleStiffness,
            "p.csv:3: whisker = C22: must be a whisker of the scene's table, such as C1; did you mean `C2`?",
        ),
        (
            &table,
            "C4,cb,8,20",
            FollicleStiffness,
            "p.csv:3: whisker = C4: its row has no whisker: base_radius_um is missing",
        ),
        (&table, "C3,cb,13,20", FollicleStiffness, "p.csv:3: distance_mm = 13: must be between"),
        (
            &single,
            "C1,cb,9,20",
            FollicleStiffness,
            "p.csv: has a column whisker: the scene must have a table of whiskers",
        ),
        (&table, "C2,cb,8,20", LengthMm, "length_mm: whiskers.table has the column length_mm"),
        (&table, "C2,cb,8,20", Taper, "taper: whiskers.table has the column tip_radius_um"),
    ] {
        let why = refused(scene, row, free).to_string();
        assert!(why.starts_with(said), "{row}: {why}");
    }
    let empty = MeasuredPoints::parse(&format!("{head},cb,8,20\n"), "p.csv").unwrap_err();
    let said = "p.csv:3: whisker is empty: must be the name of a whisker";
    assert!(empty.to_string().starts_with(said), "{empty}");
}
