//! The 8th-order formula of Dormand, El-Mikkawy and Prince's Nystrom pair 8(6), with fixed steps.
//!
//! A lever `X` turns an angle, and the angle moves the lever: `theta' = f X/m^2`, `X' = -rho cos(theta)`, where `m^2` is the
//! inverse compliance. With `chi = m (theta - theta_0)/f` this is an equation of second order without a first derivative,
//! `chi'' = (m''/m) chi - (rho/m) cos(theta)` (Liouville's transformation), and so is each of its derivatives by a
//! parameter. Nystrom's methods are made for these: 8 evaluations for order 8, and half the steps of a Runge-Kutta method
//! of the same order (`benches/NOTES.md`).
//!
//! Coefficients: J. R. Dormand, M. E. A. El-Mikkawy, P. J. Prince, "High-order embedded Runge-Kutta-Nystrom formulae",
//! IMA Journal of Numerical Analysis 7 (1987) 423-430, with the corrigendum in 11 (1991) 297. The error weights are not
//! needed: every map carries its residual, and accuracy is measured against finer runs.

use crate::numerics::{Real, Vector, rotated_by_small};
use crate::shooting::integrator::{Integrator, STAGES, Scales};
use crate::shooting::{Intrinsic, Material, RodSystem, Section, Sensitivity, State};

/// Order 8, 8 stages.
#[derive(Clone, Copy, Debug)]
pub struct Nystrom8;

/// `a/b`.
const fn ratio(a: i64, b: i64) -> f64 {
    a as f64 / b as f64
}

/// `y + sum(a_i k_i)`.
macro_rules! sum {
    ($y:expr $(, $a:expr, $k:expr)*) => {{
        let sum = $y;
        $(let sum = sum.plus(T::of(const { $a }), $k);)*
        sum
    }};
}

/// What turns the rod, and its derivatives: `X` and the levers of the sensitivities.
type Levers<T, S> = ([T; 1], <S as Sensitivity<T>>::Pairs);

impl Integrator for Nystrom8 {
    const NODES: [f64; STAGES] = [0.0, 0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0];

    #[inline(always)]
    #[rustfmt::skip]
    fn step<T: Real, I: Intrinsic<T>, C: Material<T>, S: Sensitivity<T>>(
        system: &RodSystem<T, I, C>,
        scales: &Scales<T>,
        from: Section<T>,
        (rest, (rod, (angles, (levers, sums)))): State<T, I, S>,
    ) -> State<T, I, S> {
        let [c, s, x, y, bent] = rod;
        let h = scales.end().sigma;
        let speed: Levers<T, S> = ([x], levers);
        let reach = h * from.rho;
        // `chi` is counted in steps, so that no step is too short.
        let compliance = h * system.material.compliance(&from);
        let course = system.intrinsic.course(&from, rest);
        // Tangent, bend and angles at a stage where `chi` has come to `at`.
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
        let mut rise = ([-s], start.1).times(T::of(const { ratio(223, 7938) }));
        let k1: Levers<T, S> = ([-c], start.0).times(reach);
        // `chi''` at a stage, and the sums with the share of its weight.
        macro_rules! stage {
            ($i:literal, $weight:expr, $($sum:tt)*) => {{
                let stage = scales.stage($i);
                let at = sum!(speed.times(T::of(Self::NODES[$i])), $($sum)*);
                let liouville = system.material.liouville(scales.taper, &from, stage);
                let ([c, s], bent, angles) = at_chi!($i, liouville.inverse_scale, at);
                let (pull, climb) = S::pull(c, s, bent, angles);
                if const { $weight != 0.0 } {
                    rise = rise.plus(T::of($weight) * stage.grown, ([-s], climb));
                }
                let pull: Levers<T, S> = ([-c], pull);
                let pull = pull.times(reach * liouville.forcing);
                match liouville.potential {
                    Some(potential) => pull.plus(h * h * potential, at),
                    None => pull,
                }
            }};
        }
        let k2 = stage!(1, 0.0, ratio(1, 800), k1);
        let k3 = stage!(2, ratio(5875, 36288), ratio(1, 600), k1, ratio(1, 300), k2);
        let k4 = stage!(3, ratio(4625, 21168),
            ratio(9, 200), k1, ratio(-9, 100), k2, ratio(9, 100), k3);
        let k5 = stage!(4, ratio(41, 224),
            ratio(-66701, 197_352), k1, ratio(28325, 32892), k2,
            ratio(-2665, 5482), k3, ratio(2170, 24669), k4);
        let k6 = stage!(5, ratio(4625, 21168),
            ratio(227_015_747, 304_251_000), k1, ratio(-54_897_451, 30_425_100), k2,
            ratio(12_942_349, 10_141_700), k3, ratio(-9499, 304_251), k4,
            ratio(539, 9250), k5);
        let k7 = stage!(6, ratio(5875, 36288),
            ratio(-1_131_891_597, 901_789_000), k1, ratio(41_964_921, 12_882_700), k2,
            ratio(-6_663_147, 3_220_675), k3, ratio(270_954, 644_135), k4,
            ratio(-108, 5875), k5, ratio(114, 1645), k6);
        let k8 = stage!(7, ratio(223, 7938),
            ratio(13_836_959, 3_667_458), k1, ratio(-17_731_450, 1_833_729), k2,
            ratio(1_063_919_505, 156_478_208), k3, ratio(-33_213_845, 39_119_552), k4,
            ratio(13335, 28544), k5, ratio(-705, 14272), k6, ratio(1645, 57088), k7);
        let chi = sum!(speed,
            ratio(223, 7938), k1, ratio(1175, 8064), k3, ratio(925, 6048), k4,
            ratio(41, 448), k5, ratio(925, 14112), k6, ratio(1175, 72576), k7);
        let speed = sum!(speed,
            ratio(223, 7938), k1, ratio(5875, 36288), k3, ratio(4625, 21168), k4,
            ratio(41, 224), k5, ratio(4625, 21168), k6, ratio(5875, 36288), k7,
            ratio(223, 7938), k8);
        let liouville = system.material.liouville(scales.taper, &from, scales.end());
        let ([c, s], bent, angles) = at_chi!(STAGES - 1, liouville.inverse_scale, chi);
        // `X = m (chi' - (m'/m) chi)`.
        let ([x], levers) = match system.material.liouville_scale(scales.taper, &from, scales.end(), liouville.inverse_scale) {
            Some([growth, scale]) => speed.plus(-h * growth, chi).times(scale),
            None => speed,
        };
        let ([climb], sums_climb) = rise;
        let rod = [c, s, x, reach.mul_add(climb, y), bent];
        let rest = I::after(&course, scales.end().along);
        (
            rest,
            (rod, (angles, (levers, sums.plus(reach, sums_climb)))),
        )
    }
}
