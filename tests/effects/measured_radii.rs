//! Accuracy along the rows of measured radii.

use super::{conditions, with};
use crate::effect_sets;
use crate::random_rods::ROWS;
use std::sync::Arc;
use whiskmap::mechanics::rod::{RadiusProfile, Rod, arclength};
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap::mechanics::shooting::{Resolution, ShootingMap};

/// Errors fall with the steps to the 7th power, as those of two iterations from levers off by the third, though the profile has jumps
/// in its second derivative. Measured 6.50 to 6.79: what is left after 12 is 1e-14 to 3e-14, hardly more than rounding.
#[test]
fn rows_do_not_cost_the_order() {
    for effects in effect_sets::all().filter(|effects| effects.profile) {
        let mut conditions = conditions(effects, 400);
        // On the last piece, with all rows behind.
        conditions
            .retain(|condition| arclength(condition.rod, condition.tau) > ROWS[ROWS.len() - 2][0]);
        let poles = |least| {
            let method = with(effects, Resolution::of(least));
            Batch::new(method).shoot::<ShootingMap>(&conditions)
        };
        // With fewer, pieces take a step of their own, and cannot take half of one.
        let [rough, half, exact] = [6, 12, 60].map(poles);
        let worst = |found: &[ShootingMap]| {
            let errors = found.iter().zip(&exact);
            errors.fold(0.0, |worst: f64, (a, b)| worst.max(a.pole.distance(b.pole)))
        };
        let order = (worst(&rough) / worst(&half)).log2();
        assert!((6.3..7.5).contains(&order), "{effects:?}: {order}, {:e}", worst(&half));
    }
}

/// A cone in 200 rows is the cone, also where a contact near the base leaves it a piece or two to bend. Measured: 6e-14.
#[test]
fn many_rows_are_fine_at_every_contact() {
    let rows: Vec<[f64; 2]> =
        (0..=200).map(|i| f64::from(i) / 200.0).map(|s| [s, 1.0 - 0.95 * s]).collect();
    let cone = Rod { taper: 0.95, pole: 0.003, ..Rod::default() };
    let measured = Rod { profile: Some(Arc::new(RadiusProfile::new(&rows, 1.0))), ..cone.clone() };
    for s in [0.002, 0.004, 0.0075, 0.03, 0.3, 0.9, 0.999] {
        for q in [1.0, 6.0, 12.0] {
            let pole = |rod: &Rod, resolution: Resolution| {
                let condition = InitialCondition { rod, tau: cone.tau(s), load: q / (s * s) };
                Batch::new(Method::new(resolution)).shoot::<ShootingMap>(&[condition])[0].pole
            };
            let apart =
                pole(&cone, Resolution::FINE.doubled()).distance(pole(&measured, Resolution::FINE));
            assert!(apart < 1e-12 * s, "{apart:e} at {s}, q {q}");
        }
    }
}
