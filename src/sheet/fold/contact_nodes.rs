//! The contact nodes: contacts along the whisker at which the sheet is sampled, each with its first fold.
//!
//! They are evenly spaced in the coordinate `u` ([`u_of`]). One lies exactly at the tip, and one beyond it: a trajectory does not depend
//! on where the whisker ends. So interpolation is nearly as accurate at the tip as elsewhere. Each trajectory provides derivatives, so
//! Hermite interpolation gives the values between nodes.

use crate::sheet::case::SheetCase;
use crate::sheet::fold::coordinate::{Hermite, STENCIL, slope_of_u, tau_of, u_of};
use crate::sheet::fold::predicted::predicted_folds;
use crate::sheet::fold::{FoldPoint, are_stable_below, first_folds};
use crate::sheet::row::Row;
use glam::DVec2;
use whiskmap_mechanics::numerics::newton_form::{stencil, through_runs};
use whiskmap_mechanics::rod::Rod;

/// Spacing of the contact nodes in the contact coordinate `u`, dimensionless.
pub const SPACING: f64 = 0.68;

/// Spacing of the contact nodes in the contact coordinate `u`, dimensionless, where samples at [`SPACING`] are not certified.
pub const NARROW_SPACING: f64 = SPACING / 4.0;

/// Number of contact nodes beyond the tip.
const BEYOND_TIP: usize = 1;

/// Number of contact nodes between the contact nearest to the base of any row and the first node.
const BEYOND_NEAREST: usize = 1;

/// Largest distance in `u` from the tip to the last node. The smallest `tau` is then below 1e-12 of `tau` at the tip.
const LONGEST_RANGE: f64 = 68.0;

/// Ways to find the folds of contact nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Folds {
    /// Every node marches along the load, so that its fold is the first one, unless a pair of folds lies between two loads.
    Marched,
    /// One node in four marches, the tip among them. The folds of the others are near their predictions.
    Predicted,
}

/// Contact nodes with their folds, from the base outward.
#[derive(Clone, Debug)]
pub struct ContactNodes {
    /// Fold of each contact node, from the base outward: `[node]`. It is the first one if the node has marched. For other nodes, a net shows this, or
    /// [`ContactNodes::are_first`].
    pub folds: Vec<FoldPoint>,
    /// Index of the contact node at the tip.
    pub tip: usize,
    spacing: f64,
    first_u: f64,
    rod: Rod,
    /// Lower bound of `|load| tau^2` of the folds ([`least_q`]).
    least_q: f64,
    /// Derivatives of `ln tau` and `ln(|load| tau^2)` of the folds by node index.
    slopes: Vec<[f64; 2]>,
    /// Polynomials of `ln tau` of the folds, indexed by the first node of the stencil, `[stencil]`.
    pub ln_tau: Vec<Hermite>,
    /// Polynomials of `ln(|load| tau^2)` of the folds, `[stencil]`. The argument is the node index, counted from the first node of the
    /// stencil.
    pub ln_q: Vec<Hermite>,
}

/// Part of the smallest `|load| tau^2` of the folds up to which a load is certainly below the folds. The rest allows for a jump between
/// nodes.
const SURELY_BELOW: f64 = 0.75;

/// Bound on the magnitude of `d ln q/d ln tau` of a fold; it is 2 toward a slender tip.
const STEEPEST: f64 = 4.0;

/// Returns the derivatives of `ln tau` and `ln(|load| tau^2)` of the folds at `fold`, by the index of the contact node.
fn slopes_at(rod: &Rod, fold: &FoldPoint, spacing: f64) -> [f64; 2] {
    let ln_tau = spacing / slope_of_u(rod, fold.tau);
    let by_det = fold.variation.det_gradient();
    let ln_load = -by_det.x / by_det.y * fold.tau / fold.load;
    // Next to a jump, the fold edge may be vertical in load, and no polynomial approximates it.
    let ln_q = (2.0 + ln_load).clamp(-STEEPEST, STEEPEST);
    [ln_tau, ln_q * ln_tau]
}

/// Returns a lower bound of `|load| tau^2` of the folds, at the nodes and between them. A cubic through two values with their slopes
/// falls below both values by at most the `dip`.
fn least_q(values: &[[f64; 2]], slopes: &[[f64; 2]]) -> f64 {
    let pairs = values.windows(2).zip(slopes.windows(2));
    let least = pairs.map(|(values, slopes)| {
        let (falling, rising) = (-slopes[0][1], slopes[1][1]);
        let dip = 4.0 / 27.0 * (falling.max(0.0) + rising.max(0.0));
        values[0][1].min(values[1][1]) - dip
    });
    libm::exp(least.fold(f64::INFINITY, f64::min))
}

/// Returns the contact nearest to the base at which a whisker can touch the pole of `nearest`, whatever its shape.
fn nearest_contact(rod: &Rod, nearest: &Row) -> f64 {
    rod.tau((nearest.pole_distance - rod.pole.abs()).min(1.0))
}

/// Returns the folds of nodes from the base outward. The first ones are so close to the base that a whisker held there does not reach the
/// pole of `nearest`, whatever its shape.
fn folds_down_to(
    case: SheetCase,
    nearest: &Row,
    spacing: f64,
    folds: Folds,
) -> Option<Vec<FoldPoint>> {
    let rod = case.rod;
    let tau_tip = rod.tau_tip();
    let u_tip = u_of(rod, tau_tip);
    let range = (u_tip - u_of(rod, nearest_contact(rod, nearest))).min(LONGEST_RANGE);
    let count = (range / spacing) as usize + BEYOND_TIP + BEYOND_NEAREST + 2;
    let taus = (0..count).scan(tau_tip, |tau, from_end| {
        let inward = from_end as f64 - BEYOND_TIP as f64;
        *tau = match from_end {
            BEYOND_TIP => tau_tip,
            _ => tau_of(rod, u_tip - spacing * inward, *tau),
        };
        Some(*tau)
    });
    let taus: Vec<f64> = taus.collect();
    let folds = match folds {
        Folds::Marched => first_folds(case, &taus),
        Folds::Predicted => predicted_folds(case, &taus, BEYOND_TIP),
    };
    folds.into_iter().rev().collect()
}

impl ContactNodes {
    /// Computes the contact nodes of `rod` from its tip down to `nearest`, the row nearest to the base, and some beyond both. Returns
    /// `None` where a fold is missing.
    pub fn new(case: SheetCase, nearest: &Row, spacing: f64, folds: Folds) -> Option<Self> {
        let rod = case.rod;
        let folds = folds_down_to(case, nearest, spacing, folds)?;
        let values = folds.iter().map(|f| [f.tau, f.q()].map(libm::log));
        let values: Vec<[f64; 2]> = values.collect();
        let slopes = folds.iter().map(|fold| slopes_at(rod, fold, spacing));
        let slopes: Vec<[f64; 2]> = slopes.collect();
        let both = through_runs(&values, &slopes);
        let polynomials = |which: usize| {
            let runs = both.iter();
            runs.map(move |run| Hermite::on_even_nodes(2, run.map(|term| term[which])))
        };
        let tip = folds.len() - 1 - BEYOND_TIP;
        Some(Self {
            spacing,
            first_u: u_of(rod, rod.tau_tip()) - spacing * tip as f64,
            tip,
            rod: rod.clone(),
            least_q: least_q(&values, &slopes),
            ln_tau: polynomials(0).collect(),
            ln_q: polynomials(1).collect(),
            folds,
            slopes,
        })
    }

    /// Returns true if the folds of all nodes at which a whisker can touch the pole of `nearest` or of a farther row are first ones: nodes that have not
    /// marched are covered by a net that shows it (`is_covered(tau)`), or are sampled here.
    #[must_use]
    pub fn are_first(
        &self,
        case: SheetCase,
        nearest: &Row,
        is_covered: impl Fn(f64) -> bool,
    ) -> bool {
        let nearest = nearest_contact(case.rod, nearest);
        let is_open = |fold: &&FoldPoint| {
            let is_out_of_touch = fold.tau < nearest;
            !fold.has_marched && !is_out_of_touch && !is_covered(fold.tau)
        };
        let open: Vec<&FoldPoint> = self.folds[..=self.tip].iter().filter(is_open).collect();
        are_stable_below(case, &open)
    }

    /// Returns true if the load `f/rho^2` is certainly less than the fold load of the contact at `tau`.
    #[must_use]
    pub fn is_below_folds(&self, tau: f64, load: f64) -> bool {
        load.abs() * tau * tau < SURELY_BELOW * self.least_q
    }

    /// Returns the derivatives of `(ln D, phi)` by contact-node index along the fold, at the node `i`.
    #[must_use]
    pub fn slope(&self, i: usize) -> DVec2 {
        let map = &self.folds[i].variation.map;
        let (fold, [ln_tau, ln_q]) = (&self.folds[i], self.slopes[i]);
        let ln_load = ln_q - 2.0 * ln_tau;
        map.by_tau * (fold.tau * ln_tau) + map.by_load * (fold.load * ln_load)
    }

    /// Returns the magnitude `|f/rho^2|` of the load at the fold of the contact at `tau`, dimensionless, by interpolation.
    #[must_use]
    pub fn fold_load(&self, tau: f64) -> f64 {
        libm::exp(self.fold_ln_q(u_of(&self.rod, tau))) / (tau * tau)
    }

    /// Returns `ln(|load| tau^2)` at the fold of the contact with the coordinate `u`, by interpolation.
    #[must_use]
    pub fn fold_ln_q(&self, u: f64) -> f64 {
        let place = (u - self.first_u) / self.spacing;
        let before = (place as usize).min(self.folds.len() - 2);
        let start = stencil(before, STENCIL, self.folds.len());
        self.ln_q[start].at(place - start as f64).0
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failure fails the test")]
mod tests {
    use super::*;
    use crate::sheet::fold::tests::cone;
    use whiskmap_mechanics::rod::{Rest, Side};
    use whiskmap_mechanics::shooting::batch::Method;

    /// Compares slopes with differences between neighbours, at a node in the middle and at the tip.
    #[test]
    fn slopes_are_those_between_neighbours() {
        let slender = Rod { taper: 0.9, bend: 0.3, pole: 0.01, ..Rod::default() };
        for (gradient, friction) in [(0.0, 0.0), (0.0, 0.3), (-0.6, 0.0), (2.0, 0.0)] {
            for side in Side::BOTH {
                let rod = Rod {
                    gradient,
                    pole: side.sign() * slender.pole,
                    friction: side.sign() * friction,
                    ..slender.clone()
                };
                let case = SheetCase { method: Method::fine(), rod: &rod, side };
                let row = Row::new(&Rest::new(&rod), 0.3);
                let nodes = ContactNodes::new(case, &row, SPACING, Folds::Predicted).unwrap();
                for i in [2, nodes.tip] {
                    check(&nodes, case, i);
                }
            }
        }
    }

    /// Folds near their predictions are those of a march, at the nodes of a sheet and at contacts so far apart that most predictions are wrong.
    #[test]
    fn predicted_folds_are_first_folds() {
        let cone = |taper: f64, friction: f64| Rod {
            taper,
            bend: 0.4,
            pole: 0.0125,
            friction,
            ..Rod::default()
        };
        for rod in [cone(0.95, 0.0), cone(1.0, 0.0), cone(0.6, 0.3), cone(0.0, 0.0)] {
            let case = SheetCase { method: Method::fine(), rod: &rod, side: Side::Cb };
            let u_tip = u_of(&rod, rod.tau_tip());
            for spacing in [SPACING, 3.0] {
                let taus = (0..12).map(|i| tau_of(&rod, u_tip - spacing * f64::from(i), 1.0));
                let taus: Vec<f64> = taus.collect();
                let marched = first_folds(case, &taus);
                let predicted = predicted_folds(case, &taus, 1);
                for (marched, predicted) in marched.iter().zip(&predicted) {
                    let (marched, predicted) = (marched.unwrap(), predicted.unwrap());
                    let off = (predicted.load / marched.load - 1.0).abs();
                    let turned = (predicted.phi - marched.phi).abs();
                    assert!(off < 1e-9 && turned < 1e-9, "{spacing}: {off:e} {turned:e}");
                }
                let sampled = predicted.iter().flatten().filter(|fold| fold.has_marched);
                let expected = if spacing == SPACING { 3..4 } else { 4..12 };
                assert!(expected.contains(&sampled.count()), "{} {spacing}", rod.taper);
            }
        }
    }

    /// A later fold at a node is found where no net covers the node.
    #[test]
    fn later_folds_are_not_first() {
        let rod = cone();
        let case = SheetCase { method: Method::fine(), rod: &rod, side: Side::Cb };
        let row = Row::new(&Rest::new(&rod), 0.3);
        let mut nodes = ContactNodes::new(case, &row, SPACING, Folds::Predicted).unwrap();
        assert!(nodes.are_first(case, &row, |_| false));
        let later = (2..nodes.tip).find(|i| !nodes.folds[*i].has_marched).unwrap();
        nodes.folds[later].load *= 1.5;
        let tau = nodes.folds[later].tau;
        assert!(!nodes.are_first(case, &row, |_| false));
        assert!(nodes.are_first(case, &row, |covered| covered == tau));
    }

    fn check(nodes: &ContactNodes, case: SheetCase, i: usize) {
        const STEP: f64 = 1e-3;
        let rod = &nodes.rod;
        let u = u_of(rod, nodes.folds[i].tau);
        let around = [-STEP, STEP].map(|step| tau_of(rod, step.mul_add(SPACING, u), 1.0));
        let folds = first_folds(case, &around);
        let folds = [0, 1].map(|end| folds[end].unwrap());
        let differ = |[a, b]: [f64; 2]| (b - a) / (2.0 * STEP);
        let [ln_tau, ln_q] = nodes.slopes[i];
        assert!((differ(folds.map(|fold| fold.tau.ln())) - ln_tau).abs() < 1e-5);
        assert!((differ(folds.map(|fold| fold.q().ln())) - ln_q).abs() < 1e-5);
        let slope = nodes.slope(i);
        let maps = folds.map(|fold| fold.variation.map);
        let ln_distance = differ(maps.map(|map| map.pole.length().ln()));
        let phi = differ(maps.map(|map| map.pole.to_angle()));
        assert!((ln_distance - slope.x).abs() < 1e-5, "{i}");
        assert!((phi - slope.y).abs() < 1e-5, "{i}");
    }
}
