//! Effects with values that equal their absence, or nearly so.

use super::{conditions, kept, with};
use std::sync::Arc;
use whiskmap::mechanics::rod::{Effects, RadiusProfile, Rod};
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition};
use whiskmap::mechanics::shooting::{FirstVariation, Resolution};

/// A state on two rods.
type Pair = (InitialCondition<'static>, InitialCondition<'static>);

fn farthest(one: Effects, other: Effects, pairs: &[Pair]) -> f64 {
    let ends = |effects: Effects, conditions: Vec<InitialCondition>| {
        Batch::new(with(effects, Resolution::FINE)).shoot::<FirstVariation>(&conditions)
    };
    let ones = ends(one, pairs.iter().map(|pair| pair.0).collect());
    let others = ends(other, pairs.iter().map(|pair| pair.1).collect());
    let apart = ones.iter().zip(&others).map(|(one, other)| {
        let (one, other) = (one.full, other.full);
        let energy = (one.energy - other.energy).abs() / (1.0 + one.energy);
        one.map.pole.distance(other.map.pole) + energy
    });
    apart.fold(0.0, f64::max)
}

/// What a spiral without curvature, a parabola without curvature and a table of a cone are; to rounding, and
/// to 6e-12 (measured) the truncation of a cone of taper 0.99.
#[test]
fn neutral_values_are_absence() {
    let tapered = Effects { taper: true, ..Effects::default() };
    // The turn of a mount is rounded to 256 times the rounding of numbers.
    let clamped = |condition: InitialCondition| InitialCondition {
        rod: kept(Rod { mount: 0.0, ..condition.rod.clone() }),
        ..condition
    };
    let usual: Vec<InitialCondition> = conditions(tapered, 200).into_iter().map(clamped).collect();
    let spiral = Effects { spiral: true, ..tapered };
    let unbent: Vec<Pair> = usual
        .iter()
        .map(|condition| {
            let rod = kept(Rod { spiral: Some([0.0, 0.0]), ..condition.rod.clone() });
            (*condition, InitialCondition { rod, ..*condition })
        })
        .collect();
    assert!(farthest(tapered, spiral, &unbent) < 1e-14);

    let profile = Effects { profile: true, ..tapered };
    let measured: Vec<Pair> = usual
        .iter()
        .map(|condition| {
            let cone = condition.rod;
            let rows = [0.0, 0.1, 0.4, 0.75, 1.0].map(|s| [s, 1.0 - cone.taper * s]);
            let rod = kept(Rod {
                profile: Some(Arc::new(RadiusProfile::new(&rows, 1.0))),
                ..cone.clone()
            });
            (*condition, InitialCondition { rod, ..*condition })
        })
        .collect();
    let apart = farthest(tapered, profile, &measured);
    assert!(apart < 5e-11, "{apart:e}");
}

/// The curvature of the parabola is `2 A (1 - 6 A^2 s^2 + ...)`: a circular arc differs in the third order.
#[test]
fn a_faint_parabola_is_a_circular_arc_to_third_order() {
    let bent = Effects { taper: true, curvature: true, ..Effects::default() };
    let arc = Effects { spiral: true, curvature: false, ..bent };
    let apart = |bend: f64| {
        let pairs: Vec<Pair> = conditions(bent, 100)
            .iter()
            .map(|condition| {
                let shaped = |bend, spiral| InitialCondition {
                    rod: kept(Rod { bend, slope: 0.0, spiral, ..condition.rod.clone() }),
                    ..*condition
                };
                (shaped(bend, None), shaped(0.0, Some([2.0 * bend, 0.0])))
            })
            .collect();
        farthest(bent, arc, &pairs)
    };
    let order = (apart(0.02) / apart(0.01)).log2();
    assert!((2.8..3.2).contains(&order), "{order}");
}
