//! Changes of the first fold from contact node to contact node.

use crate::rod::Rod;
use crate::sheet::fold::FoldPoint;
use crate::sheet::fold::coordinate::slope_of_u;

/// Returns the row parameter `|load| tau^2` of a fold.
pub fn q(fold: &FoldPoint) -> f64 {
    fold.load.abs() * fold.tau * fold.tau
}

/// Bound on the magnitude of `d ln q/d ln tau` of a fold; it is 2 toward a slender tip.
const STEEPEST: f64 = 4.0;

/// Returns the derivatives of `ln tau` and `ln(|load| tau^2)` of the folds at `fold`, by the index of the contact node.
pub fn slopes_at(rod: &Rod, fold: &FoldPoint, spacing: f64) -> [f64; 2] {
    let ln_tau = spacing / slope_of_u(rod, fold.tau);
    let by_det = fold.variation.det_gradient();
    let ln_load = -by_det.x / by_det.y * fold.tau / fold.load;
    // Next to a jump, the fold edge may be vertical in load, and no polynomial approximates it.
    let ln_q = (2.0 + ln_load).clamp(-STEEPEST, STEEPEST);
    [ln_tau, ln_q * ln_tau]
}

/// Returns a lower bound of `|load| tau^2` of the folds, at the nodes and between them. A cubic through two values with their slopes
/// falls below both values by at most the `dip`.
pub fn least_q(values: &[[f64; 2]], slopes: &[[f64; 2]]) -> f64 {
    let pairs = values.windows(2).zip(slopes.windows(2));
    let least = pairs.map(|(values, slopes)| {
        let (falling, rising) = (-slopes[0][1], slopes[1][1]);
        let dip = 4.0 / 27.0 * (falling.max(0.0) + rising.max(0.0));
        values[0][1].min(values[1][1]) - dip
    });
    libm::exp(least.fold(f64::INFINITY, f64::min))
}

/// Difference between the change of `ln q` from node to node and the slope at one of them from which on the first fold jumps. A jump with
/// friction led from 29 to 15; without one, `scenes/measured.toml` has 0.19.
const JUMP: f64 = 0.25;

/// Returns true if the fold jumps between two nodes with these `slopes` of `ln q`, between which `ln q` changes by `change`.
pub fn jumps(change: f64, slopes: [f64; 2]) -> bool {
    let misses = slopes.map(|slope| (change - slope).abs());
    misses[0].max(misses[1]) >= JUMP
}

#[cfg(test)]
mod tests {
    use super::jumps;

    /// Right after a jump down, a fold that changes like a square root is as steep as the jump.
    #[test]
    fn a_jump_is_seen_whatever_the_slopes() {
        assert!(jumps(-0.6, [0.0, 0.0]));
        assert!(jumps(-0.6, [0.0, -1.2]));
        assert!(jumps(-0.6, [-0.6, -0.1]));
        assert!(!jumps(0.47, [0.38, 0.29]));
        assert!(!jumps(1.3, [1.3, 1.3]));
    }
}
