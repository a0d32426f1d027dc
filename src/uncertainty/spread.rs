//! Spread of many ends of pushes: percentiles, mean and standard deviation.

use super::PushEnd;
use crate::quantile::quantile;
use crate::trace::{DetachmentKind, row};
use serde::Serialize;
use whiskmap_mechanics::rod::Side;

/// Defines a [`row!`] with statistics of samples. For each quantity, `[p5, p25, p50, p75, p95, mean, sd]` names the columns of its statistics,
/// and a text completes their descriptions.
macro_rules! spread {
    ($(#[$outer:meta])* pub struct $name:ident {
        $(
            $($(#[doc = $text:literal])* pub $column:ident: $kind:ty,)*
            [$p5:ident, $p25:ident, $p50:ident, $p75:ident, $p95:ident, $mean:ident, $sd:ident] of $what:literal,
        )*
    }) => {
        row! {
            $(#[$outer])* pub struct $name {
                $(
                    $($(#[doc = $text])* pub $column: $kind,)*
                    #[doc = " 5th percentile of the "] #[doc = $what] pub $p5: Option<f64>,
                    #[doc = " 25th percentile of the "] #[doc = $what] pub $p25: Option<f64>,
                    #[doc = " Median of the "] #[doc = $what] pub $p50: Option<f64>,
                    #[doc = " 75th percentile of the "] #[doc = $what] pub $p75: Option<f64>,
                    #[doc = " 95th percentile of the "] #[doc = $what] pub $p95: Option<f64>,
                    #[doc = " Mean of the "] #[doc = $what] pub $mean: Option<f64>,
                    #[doc = " Standard deviation of the "] #[doc = $what] pub $sd: Option<f64>,
                )*
            }
        }

        impl $name {
            /// Returns the row with the statistics of `samples`, which have a value of each quantity, in order.
            fn of_samples(mut self, samples: impl IntoIterator<Item = [f64; 3]>) -> Self {
                let mut values: [Vec<f64>; 3] = Default::default();
                for sample in samples {
                    values.iter_mut().zip(sample).for_each(|(all, value)| all.push(value));
                }
                [$([self.$p5, self.$p25, self.$p50, self.$p75, self.$p95, self.$mean, self.$sd]),*] = values.map(statistics);
                self
            }
        }
    };
}

spread! {
    /// Spread of the ends of pushes at one distance. Percentiles are those of the detachments, of either kind.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct EndSpread {
        pub side: Side,
        pub distance_mm: f64,
        /// End of the scene's own push: slip-off, pull-off, out-of-reach or unresolved.
        pub kind: DetachmentKind,
        /// Push angle of the scene's detachment, in degrees: positive CB, negative CF.
        pub push_angle_deg: Option<f64>,
        /// Number of samples that slip off.
        pub slip_off: u64,
        /// Number of samples that are pulled off.
        pub pull_off: u64,
        /// Number of samples that do not reach the pole.
        pub out_of_reach: u64,
        /// Number of samples whose end was not found.
        pub unresolved: u64,
        [p5_deg, p25_deg, p50_deg, p75_deg, p95_deg, mean_deg, sd_deg] of "push angles at detachment, in degrees.",
        /// Standard deviation of the push angle to first order, in degrees.
        pub sd_first_order_deg: Option<f64>,
        /// Force of the scene's detachment, in uN.
        pub force_un: Option<f64>,
        [force_p5_un, force_p25_un, force_p50_un, force_p75_un, force_p95_un, force_mean_un, force_sd_un]
            of "forces at detachment, in uN.",
        /// Moment at the base of the scene's detachment, in nN m.
        pub base_moment_nnm: Option<f64>,
        [base_moment_p5_nnm, base_moment_p25_nnm, base_moment_p50_nnm, base_moment_p75_nnm, base_moment_p95_nnm,
            base_moment_mean_nnm, base_moment_sd_nnm] of "moments at detachment, in nN m.",
    }
}

row! {
    /// Percentiles of the push angles of samples at the distance of a measured point, in degrees.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct PointSpread {
        /// 5th percentile of the samples' push angles at the point's distance, in degrees.
        pub p5_deg: Option<f64>,
        /// 25th percentile of the samples' push angles at the point's distance, in degrees.
        pub p25_deg: Option<f64>,
        /// Median of the samples' push angles at the point's distance, in degrees.
        pub p50_deg: Option<f64>,
        /// 75th percentile of the samples' push angles at the point's distance, in degrees.
        pub p75_deg: Option<f64>,
        /// 95th percentile of the samples' push angles at the point's distance, in degrees.
        pub p95_deg: Option<f64>,
    }
}

spread! {
    /// Spread of the largest loads of pushes at one distance, from first touch to the detachment. Percentiles are those of the samples that
    /// detach.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct LargestSpread {
        /// Largest contact force of the scene's push, in uN.
        pub max_contact_force_un: Option<f64>,
        [max_contact_force_p5_un, max_contact_force_p25_un, max_contact_force_p50_un, max_contact_force_p75_un,
            max_contact_force_p95_un, max_contact_force_mean_un, max_contact_force_sd_un]
            of "largest contact forces of pushes, in uN.",
        /// Largest moment at the base of the scene's push, in nN m.
        pub max_base_moment_nnm: Option<f64>,
        [max_base_moment_p5_nnm, max_base_moment_p25_nnm, max_base_moment_p50_nnm, max_base_moment_p75_nnm,
            max_base_moment_p95_nnm, max_base_moment_mean_nnm, max_base_moment_sd_nnm]
            of "largest moments at the base, in nN m.",
        /// Largest bending strain of the scene's push, dimensionless.
        pub max_strain: Option<f64>,
        [max_strain_p5, max_strain_p25, max_strain_p50, max_strain_p75, max_strain_p95, max_strain_mean, max_strain_sd]
            of "largest strains of pushes, dimensionless.",
    }
}

impl LargestSpread {
    /// Computes the spread of the largest loads of samples beside the loads of the scene: `[contact force, moment, strain]` of each push that
    /// detaches.
    pub(super) fn new(
        scene_loads: Option<[f64; 3]>,
        samples: impl Iterator<Item = [f64; 3]>,
    ) -> Self {
        Self {
            max_contact_force_un: scene_loads.map(|loads| loads[0]),
            max_base_moment_nnm: scene_loads.map(|loads| loads[1]),
            max_strain: scene_loads.map(|loads| loads[2]),
            ..Self::default()
        }
        .of_samples(samples)
    }
}

impl EndSpread {
    /// Returns the percentiles of the push angles at detachment, in degrees.
    #[must_use]
    pub fn of_push_angles(&self) -> PointSpread {
        PointSpread {
            p5_deg: self.p5_deg,
            p25_deg: self.p25_deg,
            p50_deg: self.p50_deg,
            p75_deg: self.p75_deg,
            p95_deg: self.p95_deg,
        }
    }

    /// Computes the spread of the `ends` of samples around `scene_end`, the end in the scene itself.
    pub(super) fn new(
        side: Side,
        distance_mm: f64,
        scene_end: PushEnd,
        ends: impl Iterator<Item = PushEnd>,
        sd_first_order_deg: Option<f64>,
    ) -> Self {
        // In the order of the kinds.
        let mut counts = [0; 4];
        let samples = ends.filter_map(|end| {
            counts[end.kind as usize] += 1;
            end.loads
        });
        let loads = scene_end.loads;
        let spread = Self {
            side,
            distance_mm,
            kind: scene_end.kind,
            push_angle_deg: loads.map(|[push, ..]| push),
            sd_first_order_deg,
            force_un: loads.map(|[_, force, _]| force),
            base_moment_nnm: loads.map(|[.., moment]| moment),
            ..Self::default()
        }
        .of_samples(samples);
        let [slip_off, pull_off, out_of_reach, unresolved] = counts;
        Self { slip_off, pull_off, out_of_reach, unresolved, ..spread }
    }
}

/// Percentiles 5, 25, 50, 75 and 95, mean and standard deviation of values; `None` without enough of these.
fn statistics(mut values: Vec<f64>) -> [Option<f64>; 7] {
    values.sort_by(f64::total_cmp);
    let count = values.len() as f64;
    let mean = (count > 0.0).then(|| values.iter().sum::<f64>() / count);
    let variance = mean.filter(|_| count > 1.0).map(|mean| {
        let squares = values.iter().map(|value| (value - mean).powi(2));
        squares.sum::<f64>() / (count - 1.0)
    });
    let [p5, p25, p50, p75, p95] =
        [0.05, 0.25, 0.5, 0.75, 0.95].map(|part| quantile(&values, part));
    [p5, p25, p50, p75, p95, mean, variance.map(f64::sqrt)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_without_detachment_are_counted_and_left_out() {
        use DetachmentKind::{OutOfReach, PullOff, SlipOff, Unresolved};
        let ends = [
            (SlipOff, Some([3.0, 1.0, -2.0])),
            (OutOfReach, None),
            (PullOff, Some([1.0, 2.0, -1.0])),
            (Unresolved, None),
            (SlipOff, Some([5.0, 6.0, -6.0])),
        ]
        .map(|(kind, loads)| PushEnd { kind, loads });
        let spread = EndSpread::new(Side::Cb, 10.0, ends[0], ends.into_iter(), None);
        let counts = [spread.slip_off, spread.pull_off, spread.out_of_reach, spread.unresolved];
        assert_eq!(counts, [2, 1, 1, 1]);
        assert_eq!((spread.mean_deg, spread.sd_deg), (Some(3.0), Some(2.0)));
        let forces = (spread.force_mean_un, spread.force_p50_un);
        assert_eq!(forces, (Some(3.0), Some(2.0)));
        let moments = (spread.base_moment_mean_nnm, spread.base_moment_p50_nnm);
        assert_eq!(moments, (Some(-3.0), Some(-2.0)));
        let nothing = EndSpread::new(Side::Cb, 10.0, ends[1], std::iter::empty(), None);
        let pushes = [nothing.p50_deg, nothing.mean_deg, nothing.sd_deg];
        assert_eq!(pushes, [None; 3]);
    }
}
