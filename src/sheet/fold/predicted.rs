//! Folds of contacts along the whisker, most of them near the fold that an interpolation of neighbouring folds predicts.

use super::{
    FoldBracket, FoldPoint, MARCH_END, bracket, first_folds, load_scale, march, polish,
    surely_stable,
};
use crate::sheet::case::SheetCase;
use whiskmap_mechanics::numerics::nearest_turn;
use whiskmap_mechanics::numerics::newton_form::{stencil, through_nodes};
use whiskmap_mechanics::shooting::ShootingMap;

/// Contacts from one that marches to the next.
const STRIDE: usize = 4;

/// Rounds of predictions, `(step, off)`. A round samples every contact `step / 2, 3 step / 2, ...` contacts away from a marching one. A fold may differ
/// from its prediction by the part `off` of `q`: `q` changes by at most a fifth from contact node to contact node, and smoothly.
const ROUNDS: [(usize, f64); 2] = [(STRIDE, 0.12), (STRIDE / 2, 0.04)];

/// Number of loads around a predicted fold. With four, the fold between them is so inaccurate that Newton's method takes a third round.
const LOADS: usize = 6;

/// Number of known folds through which a prediction passes.
const KNOWN: usize = 4;

/// Fold that is predicted for a contact.
struct PredictedFold {
    /// Index of the contact.
    contact: usize,
    /// `q = |load| s^2` of the fold, dimensionless.
    q: f64,
    /// Direction of the pole in radians, continuous from first touch.
    phi: f64,
}

/// Returns folds of `rod` at the contacts `taus`, which follow one another at about equal steps along the whisker: `[contact]`. The contact with the
/// index `marching`, and every fourth one from it, march along the load. The loads of the others are sampled around their predicted folds: a fold that
/// is found there need not be their first one. An entry is `None` where there is no fold, as in [`first_folds`].
pub fn predicted_folds(case: SheetCase, taus: &[f64], marching: usize) -> Vec<Option<FoldPoint>> {
    let coarse = case.coarsely();
    let marching = marching % STRIDE;
    let marched: Vec<usize> = (marching..taus.len()).step_by(STRIDE).collect();
    let of_marched: Vec<f64> = marched.iter().map(|contact| taus[*contact]).collect();
    let mut brackets = vec![None; taus.len()];
    let found = march(coarse, &of_marched, surely_stable(case.rod));
    for (contact, bracket) in marched.into_iter().zip(found) {
        brackets[contact] = bracket;
    }
    for (step, off) in ROUNDS {
        let predicted = predictions(coarse, taus, &brackets, (marching + step / 2) % step, step);
        let found = brackets_near(coarse, taus, &predicted, off);
        for (predicted, bracket) in predicted.into_iter().zip(found) {
            brackets[predicted.contact] = bracket;
        }
    }
    let mut folds = polish(case, brackets);
    let missing: Vec<usize> = (0..taus.len()).filter(|&i| folds[i].is_none()).collect();
    let again: Vec<f64> = missing.iter().map(|&i| taus[i]).collect();
    for (i, fold) in missing.into_iter().zip(first_folds(case, &again)) {
        folds[i] = fold;
    }
    folds
}

/// Returns the predicted folds of the contacts from the index `first` on, `step` apart, by the known `brackets`. A contact has no entry if no fold is known,
/// or if a march would not come to the predicted one.
fn predictions(
    case: SheetCase,
    taus: &[f64],
    brackets: &[Option<FoldBracket>],
    first: usize,
    step: usize,
) -> Vec<PredictedFold> {
    let known = brackets.iter().enumerate().filter_map(|(contact, bracket)| {
        let bracket = bracket.as_ref()?;
        let q = bracket.guess / load_scale(case, taus[contact]);
        Some((contact as f64, [q, bracket.phi]))
    });
    let known: Vec<(f64, [f64; 2])> = known.collect();
    let predicted = (first..taus.len()).step_by(step).filter_map(|contact| {
        let place = contact as f64;
        let before = known.partition_point(|(other, _)| *other < place);
        let around = stencil(before.saturating_sub(1), KNOWN, known.len());
        let functions = through_nodes::<KNOWN, 2>(known[around..].iter().copied());
        let [q, phi] = functions.map(|function| function.at(place).0);
        (q > 0.0 && q <= MARCH_END).then_some(PredictedFold { contact, q, phi })
    });
    predicted.collect()
}

/// Returns brackets of folds that differ from the `predicted` ones by at most the part `off` of `q`. An entry is `None` where `det` does not fall below
/// zero there.
fn brackets_near(
    case: SheetCase,
    taus: &[f64],
    predicted: &[PredictedFold],
    off: f64,
) -> Vec<Option<FoldBracket>> {
    let step = 2.0 * off / (LOADS - 1) as f64;
    let samples = |fold: &PredictedFold| -> [f64; LOADS] {
        std::array::from_fn(|i| fold.q * step.mul_add(i as f64, 1.0 - off))
    };
    let points = predicted.iter().flat_map(|fold| {
        let tau = taus[fold.contact];
        let scale = load_scale(case, tau);
        samples(fold).map(|q| (tau, q * scale))
    });
    let maps: Vec<ShootingMap> = case.shoot(points);
    let brackets = predicted.iter().zip(maps.chunks(LOADS));
    let brackets = brackets.map(|(fold, maps)| {
        let dets: Vec<f64> = maps.iter().map(ShootingMap::det).collect();
        let falls = |pair: &[f64]| pair[0] > 0.0 && pair[1] <= 0.0;
        let at = dets.windows(2).position(falls)?;
        let phi = nearest_turn(maps[at].pole.to_angle(), fold.phi);
        let before = (at, maps[at], phi);
        Some(FoldBracket {
            has_marched: false,
            ..bracket(case, taus[fold.contact], &samples(fold), &dets, before)
        })
    });
    brackets.collect()
}
