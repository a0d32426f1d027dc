//! A trajectory has all effects of its rod, whatever its method and batch.

use std::sync::Arc;
use whiskmap_mechanics::numerics::Unit;
use whiskmap_mechanics::rod::{CurvaturePolynomial, Effects, RadiusProfile, Rod};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap_mechanics::shooting::{SecondVariation, ShootingMap};

/// A rod with each effect, one with none, and two with radii measured in different places.
pub fn rods() -> Vec<Rod> {
    let cone = Rod { taper: 0.9, pole: 0.01, ..Rod::default() };
    let measured = |rows: &[[f64; 2]]| Rod {
        profile: Some(Arc::new(RadiusProfile::new(rows, 1.0))),
        ..cone.clone()
    };
    vec![
        Rod { taper: 0.0, ..cone.clone() },
        cone.clone(),
        Rod { bend: 0.4, slope: -0.1, ..cone.clone() },
        Rod { spiral: Some([0.3, -0.8]), ..cone.clone() },
        Rod { gradient: 0.5, ..cone.clone() },
        measured(&[[0.0, 1.0], [0.5, 0.7], [1.0, 0.1]]),
        measured(&[[0.0, 1.0], [0.1, 0.8], [0.2, 0.7], [0.5, 0.3], [0.6, 0.3], [1.0, 0.1]]),
        Rod {
            polynomial: Some(Arc::new(CurvaturePolynomial::new([
                0.2, -0.4, 0.15, 0.1, -0.1, 0.05, 0.05,
            ]))),
            ..cone
        },
    ]
}

/// Three contacts on each rod, under a load that bends it strongly.
pub fn conditions(rods: &[Rod]) -> Vec<InitialCondition<'_>> {
    let on = |rod| [0.3, 0.55, 0.8].map(|s| (rod, s));
    let pairs = rods.iter().flat_map(on);
    let condition =
        |(rod, s): (_, f64)| InitialCondition { rod, tau: Rod::tau(rod, s), load: 5.0 / (s * s) };
    pairs.map(condition).collect()
}

/// In a batch by a method without effects, every rod has the outputs that it has alone, padded or not.
#[test]
fn no_effect_is_dropped() {
    let rods = rods();
    let conditions = conditions(&rods);
    let method = Method::fine();
    for batch in [Batch::new(method), Batch::new(method).on(Unit::scalar())] {
        let all = batch.shoot::<ShootingMap>(&conditions);
        let padded = batch.padded().shoot::<ShootingMap>(&conditions);
        for ((condition, found), padded) in conditions.iter().zip(all).zip(padded) {
            let alone = batch.shoot::<ShootingMap>(&[*condition])[0];
            assert_eq!(found, alone, "{condition:?}");
            assert!(padded.pole.distance(alone.pole) < 1e-11, "{condition:?}");
        }
    }
}

/// Additional effects of the method change rounding alone, and another rest shape does not replace the rod's own.
#[test]
fn additional_effects_change_rounding_alone() {
    let rods = rods();
    let all = Effects::of(&rods);
    assert!(
        all.taper && all.curvature && all.spiral && all.polynomial && all.gradient && all.profile
    );
    for condition in conditions(&rods) {
        let shoot = |method| Batch::new(method).shoot::<SecondVariation>(&[condition])[0];
        let alone = shoot(Method::fine());
        let with_all = shoot(Method::fine().with_effects(all));
        let apart = alone.map.pole.distance(with_all.map.pole);
        assert!(apart < 1e-11, "{apart:e} {condition:?}");
    }
}
