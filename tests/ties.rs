//! Distances within which two results count as equal: each case lies at half or at twice the documented distance.

use whiskmap::classify::{Outcome, Regime, RowBoundary};
use whiskmap::mechanics::rod::{Rod, Side};
use whiskmap::mechanics::shooting::ShootingMap;
use whiskmap::mechanics::shooting::batch::{Batch, Method};
use whiskmap::sheet::{Crossing, Edge, Row, Sheet};

/// Row that touches and slips off at a push angle of 0.5.
fn slips_off(residual: f64) -> RowBoundary {
    let end = Crossing { edge: Edge::Fold, tau: 1.0, load: 1.0, push: 0.5, residual, slope: 0.0 };
    RowBoundary::new(true, &[end])
}

/// Both verdicts are correct within 1e-10 radians of an end.
#[test]
fn an_end_is_a_tie_within_1e_10_radians() {
    let row = slips_off(0.0);
    for (by, is_tie) in [(0.5e-10, true), (2e-10, false)] {
        let beyond = row.classify(0.5 + by, Outcome::Solved).0;
        assert_eq!(beyond == Regime::Contact, is_tie, "{by}");
        let before = row.classify(0.5 - by, Outcome::BeyondFold).0;
        assert_eq!(before == Regime::SlipOff, is_tie, "{by}");
    }
}

#[test]
fn a_crossing_is_found_with_a_residual_up_to_1e_10() {
    for (residual, is_found) in [(0.5e-10, true), (2e-10, false)] {
        assert_eq!(!slips_off(residual).spans().is_empty(), is_found);
    }
}

#[test]
fn a_whisker_reaches_a_pole_1e_12_beyond_its_tip() {
    for (by, reaches) in [(0.5e-12, true), (2e-12, false)] {
        let row = Row { pole_distance: 1.0 + by, contact: 1.0 + by, touch: 0.0, end: 1.0 };
        assert_eq!((row.is_reached(), row.is_at_reach()), (reaches, reaches));
    }
}

/// Sheet of a straight cylinder at a point contact, with a row that slips off.
fn cylinder() -> Sheet {
    Sheet::new(Method::fine(), &Rod::default(), Side::Cb, &[0.5])
}

/// A straight whisker that reaches the pole just with its tip is pulled off by any push, with friction, too: the tip moves away from a point under
/// each load. Its row is a point, at which a state exists.
#[test]
fn a_row_at_the_reach_of_a_straight_whisker_ends_at_first_touch() {
    for taper in [0.0, 0.3, 0.8, 0.95] {
        for friction in [0.0, 0.02, 0.05, 0.1, 0.2, 0.5] {
            for distances in [&[1.0][..], &[0.5, 1.0]] {
                let rod = Rod { taper, friction, ..Rod::default() };
                let sheet = Sheet::new(Method::fine(), &rod, Side::Cb, distances);
                let row = distances.len() - 1;
                let crossings = &sheet.crossings[row];
                let what = format!("{taper} {friction} {distances:?}");
                assert_eq!(crossings[..], [Crossing::at_touch(&rod)], "{what}");
                let boundary = RowBoundary::new(true, crossings);
                let [at, beyond] = [(0.0, Outcome::Solved), (0.1, Outcome::OffSheet)]
                    .map(|(push, outcome)| boundary.classify(push, outcome).0);
                assert_eq!([at, beyond], [Regime::Contact, Regime::PullOff], "{what}");
            }
        }
    }
}

#[test]
fn a_contact_is_at_the_tip_within_1e_12_of_it() {
    let sheet = cylinder();
    let [tip, _] = sheet.tip;
    for (by, is_at_tip) in [(0.5e-12, true), (2e-12, false)] {
        let tau = tip * (1.0 - by) - sheet.tip_blur();
        assert_eq!(sheet.is_at_tip(tau, 0.0), is_at_tip, "{by}");
    }
}

/// Loads of a contact from first touch to the fold are on the sheet, with a slack of 1e-6 and 1e-4 of the fold load.
#[test]
fn loads_from_first_touch_to_the_fold_are_on_the_sheet() {
    let sheet = cylinder();
    let end = sheet.crossings[0][0];
    assert_eq!(end.edge, Edge::Fold);
    // A map with a positive determinant, so that the load alone decides.
    let at_touch = [(end.tau, 0.0)];
    let map: ShootingMap = Batch::new(Method::fine()).shoot_at(&sheet.rod, at_touch)[0];
    for (part, is_on_sheet) in
        [(-2e-6, false), (-0.5e-6, true), (0.5, true), (1.0 + 0.5e-4, true), (1.0 + 2e-4, false)]
    {
        let load = part * end.load;
        assert_eq!(sheet.is_stable(end.tau, load, &map), is_on_sheet, "{part}");
    }
}
