//! Measured radii.

use whiskmap_mechanics::rod::{Demands, RadiusProfile};

const ROWS: [[f64; 2]; 6] =
    [[0.0, 1.0], [0.1, 0.93], [0.3, 0.9], [0.5, 0.9], [0.8, 0.2], [1.0, 0.05]];

#[test]
fn it_goes_through_the_rows_smoothly_and_falls_where_they_do() {
    let profile = RadiusProfile::new(&ROWS, 1.0);
    for [s, radius] in ROWS {
        assert!((profile.radius(s) - radius).abs() < 1e-15, "{s}");
    }
    for pair in profile.pieces[..ROWS.len() - 1].windows(2) {
        let row = pair[1].from;
        assert!((pair[0].slope(row) - pair[1].slope(row)).abs() < 1e-13, "{row}");
    }
    let radii: Vec<f64> = (0..=1000).map(|i| profile.radius(f64::from(i) / 1000.0)).collect();
    assert!(radii.is_sorted_by(|a, b| a >= b));
}

#[test]
fn a_linear_table_is_the_cone() {
    let rows = [0.0, 0.2, 0.7, 1.0].map(|s| [s, 1.0 - 0.9 * s]);
    let profile = RadiusProfile::new(&rows, 1.0);
    for s in [0.0, 0.1, 0.2, 0.5, 0.9, 1.0, 1.05] {
        assert!((profile.radius(s) - (1.0 - 0.9 * s)).abs() < 1e-15, "{s}");
    }
}

#[test]
fn the_way_from_the_last_row_to_the_tip_counts() {
    let rows = [0.0, 0.5, 1.0].map(|s| [s, 1.0 - 0.6 * s]);
    let beyond = |stretch: f64| {
        let taper = 0.6 * stretch;
        let tau = |s: f64| -(-taper * s).ln_1p() / taper;
        tau(1.0) - tau(1.0 / stretch)
    };
    for stretch in [1.0, 1.2, 1.6] {
        let profile = RadiusProfile::new(&rows, stretch);
        let beyond = beyond(stretch);
        let change = 0.6 * stretch * beyond;
        assert!((profile.changes[2] - change).abs() < 1e-12, "{stretch}");
        let tail = 1.0 - 1.0 / stretch;
        assert!((profile.widths[2] - tail).abs() < 1e-12, "{stretch}");
    }
}

#[test]
fn a_cone_is_as_compliant_as_by_integration() {
    let rows: Vec<[f64; 2]> =
        (0..=20).map(|i| f64::from(i) / 20.0).map(|s| [s, 1.0 - 0.8 * s]).collect();
    let profile = RadiusProfile::new(&rows, 1.0);
    for s in [0.01_f64, 0.3, 0.72, 1.0] {
        // Two integrations of (1 - 0.8 s)^-4.
        let radius = 1.0 - 0.8 * s;
        let exact = (radius.powi(-2) - 1.0 - 1.6 * s) / (6.0 * 0.64);
        assert!(
            (profile.compliance(s) / exact - 1.0).abs() < 1e-6,
            "{s}: {}",
            profile.compliance(s) / exact
        );
    }
}

/// Shares of four pieces of equal length in the deflection of a straight cylinder, computed by hand.
#[test]
fn pieces_share_the_bending() {
    let rows = [0.0, 0.25, 0.5, 0.75, 1.0].map(|s| [s, 1.0]);
    let profile = RadiusProfile::new(&rows, 1.0);
    for s in [0.99_f64, 0.6, 0.3, 0.2, 1e-3, 1e-6] {
        for k in 0..4 {
            let from = s.min(0.25 * k as f64);
            let to = s.min(from + 0.25);
            // Under a load, the end of a lever turns by the square of its length.
            let share = ((s - from).powi(2) - (s - to).powi(2)) / (s * s);
            let exact = (share * (0.25 / s).min(1.0)).sqrt().max(0.5 * share);
            let found = f64::from(profile.demands.of(Demands::reach(s), k).bending);
            // Other contacts of the reach have larger demands.
            assert!((exact - 1e-6..exact + 0.25).contains(&found), "{s}, {k}: {exact}, {found}");
        }
    }
    // The only piece has all the bending and no roughness.
    let sum: f32 = (0..4).map(|k| profile.demands.of(0, k).bending).sum();
    assert!((1.0..1.2).contains(&sum), "{sum}");
    assert!((0..4).all(|k| profile.demands.of(0, k).roughness == 0.0));
}
