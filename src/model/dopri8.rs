//! The 8th-order weights of Dormand and Prince's 8(5,3) pair, 12 stages, with fixed steps.
//!
//! Coefficients: E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd ed.,
//! section II.5 (the code DOP853). The error weights are not needed: every map carries its residual, and
//! accuracy is measured against finer runs.

use super::integrator::{Integrator, STAGES, Scales};
use super::rhs::{Intrinsic, Material, RodSystem, Sensitivity, State};
use super::{Real, Section, Vector};

/// Order 8, 12 stages.
#[derive(Clone, Copy, Debug)]
pub struct Dopri8;

/// `y + h sum(a_i k_i)` with the increment summed first: fewer roundings of `y`.
macro_rules! combine {
    ($y:expr, $h:expr, $a:expr, $k:expr $(, $b:expr, $l:expr)*) => {{
        let increment = $k.times(T::of($a));
        $(let increment = increment.plus(T::of($b), $l);)*
        $y.plus($h, increment)
    }};
}

impl Integrator for Dopri8 {
    const NODES: [f64; STAGES] = [
        0.0,
        0.052_600_151_958_767_73,
        0.078_900_227_938_151_6,
        0.118_350_341_907_227_4,
        0.281_649_658_092_772_6,
        0.333_333_333_333_333_3,
        0.25,
        0.307_692_307_692_307_7,
        0.651_282_051_282_051_3,
        0.6,
        0.857_142_857_142_857_1,
        1.0,
    ];

    #[inline(always)]
    #[rustfmt::skip]
    fn step<T: Real, I: Intrinsic<T>, C: Material<T>, S: Sensitivity<T>>(
        system: &RodSystem<T, I, C>,
        scales: &Scales<T>,
        from: Section<T>,
        h: T,
        y: State<T, I, S>,
    ) -> State<T, I, S> {
        macro_rules! rhs {
            ($stage:expr, $state:expr) => {
                system.rhs::<S>(scales.at($stage, from), $state)
            };
        }
        let k1 = rhs!(0, y);
        let k2 = rhs!(1, combine!(y, h,
            0.052_600_151_958_767_73, k1));
        let k3 = rhs!(2, combine!(y, h,
            0.019_725_056_984_537_9, k1,
            0.059_175_170_953_613_7, k2));
        let k4 = rhs!(3, combine!(y, h,
            0.029_587_585_476_806_85, k1,
            0.088_762_756_430_420_54, k3));
        let k5 = rhs!(4, combine!(y, h,
            0.241_365_134_159_266_7, k1,
            -0.884_549_479_328_286_1, k3,
            0.924_834_003_261_792, k4));
        let k6 = rhs!(5, combine!(y, h,
            0.037_037_037_037_037_035, k1,
            0.170_828_608_729_473_86, k4,
            0.125_467_687_566_822_42, k5));
        let k7 = rhs!(6, combine!(y, h,
            0.037_109_375, k1,
            0.170_252_211_019_544_05, k4,
            0.060_216_538_980_455_96, k5,
            -0.017_578_125, k6));
        let k8 = rhs!(7, combine!(y, h,
            0.037_092_000_118_504_79, k1,
            0.170_383_925_712_239_98, k4,
            0.107_262_030_446_373_28, k5,
            -0.015_319_437_748_624_402, k6,
            0.008_273_789_163_814_023, k7));
        let k9 = rhs!(8, combine!(y, h,
            0.624_110_958_716_075_7, k1,
            -3.360_892_629_446_941_4, k4,
            -0.868_219_346_841_726, k5,
            27.592_099_699_446_71, k6,
            20.154_067_550_477_894, k7,
            -43.489_884_181_069_96, k8));
        let k10 = rhs!(9, combine!(y, h,
            0.477_662_536_438_264_34, k1,
            -2.488_114_619_971_667_7, k4,
            -0.590_290_826_836_843, k5,
            21.230_051_448_181_193, k6,
            15.279_233_632_882_423, k7,
            -33.288_210_968_984_86, k8,
            -0.020_331_201_708_508_627, k9));
        let k11 = rhs!(10, combine!(y, h,
            -0.937_142_430_085_987_3, k1,
            5.186_372_428_844_064, k4,
            1.091_437_348_996_729_5, k5,
            -8.149_787_010_746_927, k6,
            -18.520_065_659_996_96, k7,
            22.739_487_099_350_505, k8,
            2.493_605_552_679_652_3, k9,
            -3.046_764_471_898_219_6, k10));
        let k12 = rhs!(11, combine!(y, h,
            2.273_310_147_516_538, k1,
            -10.534_495_466_737_25, k4,
            -2.000_872_058_224_862_5, k5,
            -17.958_931_863_118_8, k6,
            27.948_884_529_419_96, k7,
            -2.858_998_277_135_023_5, k8,
            -8.872_856_933_530_63, k9,
            12.360_567_175_794_303, k10,
            0.643_392_746_015_763_6, k11));
        combine!(y, h,
            0.054_293_734_116_568_765, k1,
            4.450_312_892_752_409, k6,
            1.891_517_899_314_500_3, k7,
            -5.801_203_960_010_585, k8,
            0.311_164_366_957_819_9, k9,
            -0.152_160_949_662_516_1, k10,
            0.201_365_400_804_030_34, k11,
            0.044_710_615_727_772_59, k12)
    }
}
