//! The 8th-order formula of Dormand, El-Mikkawy and Prince's Nystrom pair 8(6), with fixed steps.
//!
//! A lever `X` turns an angle, and the angle moves the lever: `theta' = f X/m^2`, `X' = -rho cos(theta)`, where `m^2` is the
//! inverse compliance. With `chi = m (theta - theta_0)/f` this is an equation of second order without a first derivative,
//! `chi'' = (m''/m) chi - (rho/m) cos(theta)` (Liouville's transformation). So is each of its derivatives by a
//! parameter. Nystrom's methods are made for such equations: 8 evaluations give order 8, in half the steps of a Runge-Kutta
//! method of order 8 (`benches/NOTES.md`).
//!
//! Coefficients: J. R. Dormand, M. E. A. El-Mikkawy, P. J. Prince, "High-order embedded Runge-Kutta-Nystrom formulae",
//! IMA Journal of Numerical Analysis 7 (1987) 423-430, with the corrigendum in 11 (1991) 297. The error weights are left out:
//! every map carries its residual, and tests measure the accuracy against finer runs.

use crate::numerics::{Real, Vector, rotated_by_small};
use crate::shooting::integrator::{Levers, STAGES, Scales};
use crate::shooting::{Intrinsic, Material, RodSystem, Section, Sensitivity, TrajectoryState};

/// The Nystrom method of order 8 with 8 stages: the integrator of all kernels on rods without a measured profile.
#[derive(Clone, Copy, Debug)]
pub struct Nystrom8;

/// `a/b`.
const fn ratio(a: i64, b: i64) -> f64 {
    a as f64 / b as f64
}

/// `y` plus the sum of `weights[j] k[j]` over the stages `j` that are named.
macro_rules! weighted_sum {
    ($y:expr, $weights:expr, $k:ident $($j:literal)*) => {{
        let sum = $y;
        $(let sum = sum.plus(T::of(const { $weights[$j] }), $k[$j]);)*
        sum
    }};
}

/// The tableau for `chi'' = g(sigma, chi)` with steps of length 1. The text of the GPU shader is made from it.
///
/// Stage `i` evaluates `k[i] = g(NODES[i], chi + NODES[i] chi' + sum over j < i of STAGE_WEIGHTS[i][j] k[j])`. At the end of
/// the step `chi` grows by `chi' + sum of POSITION_WEIGHTS[j] k[j]` and `chi'` by the sum of `SPEED_WEIGHTS[j] k[j]`.
impl Nystrom8 {
    /// Nodes of Nystrom's stages in the unit step, in `[0, 1]`: `[stage]`.
    pub const NODES: [f64; STAGES] = [0.0, 0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0];

    /// Nystrom weights of the stages `j` in the argument of the stage `i`: `[i][j]`, 0 for `j >= i`.
    #[rustfmt::skip]
    pub const STAGE_WEIGHTS: [[f64; STAGES]; STAGES] = [
        [0.0; STAGES],
        [ratio(1, 800), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [ratio(1, 600), ratio(1, 300), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [ratio(9, 200), ratio(-9, 100), ratio(9, 100), 0.0, 0.0, 0.0, 0.0, 0.0],
        [ratio(-66701, 197_352), ratio(28325, 32892), ratio(-2665, 5482), ratio(2170, 24669), 0.0, 0.0, 0.0, 0.0],
        [ratio(227_015_747, 304_251_000), ratio(-54_897_451, 30_425_100), ratio(12_942_349, 10_141_700),
            ratio(-9499, 304_251), ratio(539, 9250), 0.0, 0.0, 0.0],
        [ratio(-1_131_891_597, 901_789_000), ratio(41_964_921, 12_882_700), ratio(-6_663_147, 3_220_675),
            ratio(270_954, 644_135), ratio(-108, 5875), ratio(114, 1645), 0.0, 0.0],
        [ratio(13_836_959, 3_667_458), ratio(-17_731_450, 1_833_729), ratio(1_063_919_505, 156_478_208),
            ratio(-33_213_845, 39_119_552), ratio(13335, 28544), ratio(-705, 14272), ratio(1645, 57088), 0.0],
    ];

    /// Nystrom weights of the stages in `chi` at the end of a step: `[stage]`.
    pub const POSITION_WEIGHTS: [f64; STAGES] = [
        ratio(223, 7938),
        0.0,
        ratio(1175, 8064),
        ratio(925, 6048),
        ratio(41, 448),
        ratio(925, 14112),
        ratio(1175, 72576),
        0.0,
    ];

    /// Nystrom weights of the stages in `chi'` at the end of a step, and of an integrand in its integral over a step: `[stage]`.
    pub const SPEED_WEIGHTS: [f64; STAGES] = [
        ratio(223, 7938),
        0.0,
        ratio(5875, 36288),
        ratio(4625, 21168),
        ratio(41, 224),
        ratio(4625, 21168),
        ratio(5875, 36288),
        ratio(223, 7938),
    ];

    /// Returns the state of the rod one integration step after the state at the section `from`.
    #[inline(always)]
    pub fn step<T: Real, I: Intrinsic<T>, C: Material<T>, S: Sensitivity<T>>(
        system: &RodSystem<T, I, C>,
        scales: &Scales<T>,
        from: Section<T>,
        (rest, (rod, (angles, (levers, sums)))): TrajectoryState<T, I, S>,
    ) -> TrajectoryState<T, I, S> {
        let [c, s, x, y, bent] = rod;
        let h = scales.end().sigma;
        let speed: Levers<T, S> = ([x], levers);
        let reach = h * from.rho;
        // `chi` is counted in steps, so that no step is too short.
        let compliance = h * system.material.compliance(&from);
        let course = system.intrinsic.course(&from, rest);
        // Tangent, bend and angles at a stage, from `chi` there.
        macro_rules! at_chi {
            ($i:expr, $inverse_scale:expr, $at:expr) => {{
                let ([x], levers): Levers<T, S> = $at;
                let per_moment = compliance * $inverse_scale;
                let bend = per_moment * system.force * x;
                let turn = match I::turn(&course, scales.stage($i).along) {
                    Some(turn) => turn + bend,
                    None => bend,
                };
                let angles = angles.plus(per_moment, S::moments(system.force, x, levers));
                (rotated_by_small([c, s], turn), bent + bend, angles)
            }};
        }
        let start = S::pull(c, s, bent, angles);
        let mut rise = ([-s], start.1).times(T::of(const { Self::SPEED_WEIGHTS[0] }));
        let start: Levers<T, S> = ([-c], start.0).times(reach);
        let mut k = [start; STAGES];
        // `chi''` at a stage. Adds the stage to the sums.
        macro_rules! stage {
            ($i:literal: $($j:literal)*) => {{
                let stage = scales.stage($i);
                let from_start = speed.times(T::of(const { Self::NODES[$i] }));
                let at = weighted_sum!(from_start, Self::STAGE_WEIGHTS[$i], k $($j)*);
                let liouville = system.material.liouville(scales.taper, &from, stage);
                let ([c, s], bent, angles) = at_chi!($i, liouville.inverse_scale, at);
                let (pull, climb) = S::pull(c, s, bent, angles);
                let weight = const { Self::SPEED_WEIGHTS[$i] };
                if weight != 0.0 {
                    rise = rise.plus(T::of(weight) * stage.grown, ([-s], climb));
                }
                let pull: Levers<T, S> = ([-c], pull);
                let pull = pull.times(reach * liouville.forcing);
                k[$i] = match liouville.potential {
                    Some(potential) => pull.plus(h * h * potential, at),
                    None => pull,
                };
            }};
        }
        stage!(1: 0);
        stage!(2: 0 1);
        stage!(3: 0 1 2);
        stage!(4: 0 1 2 3);
        stage!(5: 0 1 2 3 4);
        stage!(6: 0 1 2 3 4 5);
        stage!(7: 0 1 2 3 4 5 6);
        let chi = weighted_sum!(speed, Self::POSITION_WEIGHTS, k 0 2 3 4 5 6);
        let speed = weighted_sum!(speed, Self::SPEED_WEIGHTS, k 0 2 3 4 5 6 7);
        let end = scales.end();
        let liouville = system.material.liouville(scales.taper, &from, end);
        let ([c, s], bent, angles) = at_chi!(STAGES - 1, liouville.inverse_scale, chi);
        let scale =
            system.material.liouville_scale(scales.taper, &from, end, liouville.inverse_scale);
        // `X = m (chi' - (m'/m) chi)`.
        let ([x], levers) = match scale {
            Some([growth, scale]) => speed.plus(-h * growth, chi).times(scale),
            None => speed,
        };
        let ([climb], sums_climb) = rise;
        let rod = [c, s, x, reach.mul_add(climb, y), bent];
        let rest = I::after(&course, end.along);
        (rest, (rod, (angles, (levers, sums.plus(reach, sums_climb)))))
    }
}
