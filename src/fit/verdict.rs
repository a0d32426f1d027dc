//! Verdict on a fit: refusal of best values with which no whisker of the scene's kind explains the points.

use crate::measured::MeasuredPoints;
use crate::scene::{Scene, digits, rounded};
use std::fmt;

/// The largest root mean square of residuals, in degrees. Theory and real whiskers differ by a few degrees; the measured
/// ends of a push go from a few degrees to 90.
const LARGEST_RMS_DEG: f64 = 5.0;

/// Largest RMS as a fraction of the range of the measured angles and 0, the angle at first touch. Without 0, the range of
/// repeated measurements at one distance would be the range of their errors.
const LARGEST_PART: f64 = 1.0 / 3.0;

/// Largest excess of a reduced chi-square over 1, in its own standard deviations `sqrt(2 / freedom)`.
const DEVIATIONS: f64 = 5.0;

/// Largest reduced chi-square of a fit: residuals are 20 times their standard deviations.
const LARGEST_REDUCED: f64 = 400.0;

/// Least number that exceeds every angle in radians: one turn is 2 pi.
const TURN: f64 = 6.3;

/// Least predicted angle in degrees that shows measured angles in radians.
const TENS_DEG: f64 = 10.0;

/// Reason why the best values are not a fit: sizes of the residuals.
#[derive(Clone, Debug, PartialEq)]
pub struct NotAFit {
    /// Root mean square of the residuals, measured less predicted angles, in degrees.
    pub rms_deg: f64,
    /// Largest root mean square of the residuals that a fit may have, in degrees: 5, or a third of the width of the smallest range that contains
    /// 0 and all measured angles if that is less.
    pub largest_rms_deg: f64,
    /// Chi-square over the degrees of freedom, dimensionless; `None` if the points have no standard deviations.
    pub reduced_chi_square: Option<f64>,
    /// Likely mistake in the file of points; `None` without one.
    pub cause: Option<LikelyCause>,
}

/// Likely mistake in a file of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LikelyCause {
    /// Angles in radians: all are below 6.3, and the scene predicts tens of degrees.
    Radians,
    /// Distances in centimetres: ten times the distances are within reach, and at least halve the RMS at the start.
    Centimetres,
    /// Standard deviations in radians: in degrees they would explain the residuals, and all given ones are below 6.3 degrees in radians.
    RadianDeviations,
}

impl NotAFit {
    /// Returns the verdict on a fit of the `used` points, from `start` on, whose residuals end with this RMS; `None` for a fit.
    ///
    /// Without standard deviations, a fit has a small RMS. With them, points of low precision may be far off: a fit has a
    /// small RMS or a chi-square that the deviations explain, and its reduced chi-square is at most 400.
    pub(super) fn new(
        used: &MeasuredPoints,
        start: &Scene,
        rms_deg: Option<f64>,
        chi_square: f64,
        freedom: usize,
    ) -> Option<Self> {
        let angles = used.points.iter().map(|point| point.angle_deg);
        let [least, most] =
            angles.fold([0.0_f64; 2], |[least, most], angle| [least.min(angle), most.max(angle)]);
        let largest_rms_deg = LARGEST_RMS_DEG.min(LARGEST_PART * (most - least));
        let rms_deg = rms_deg?;
        let is_near = rms_deg <= largest_rms_deg;
        let reduced = chi_square / freedom.max(1) as f64;
        let reduced = used.have_deviations.then_some(reduced);
        let is_fit = match reduced {
            Some(reduced) => {
                reduced <= LARGEST_REDUCED && (is_near || is_explained(chi_square, freedom))
            }
            None => is_near,
        };
        (!is_fit).then(|| Self {
            rms_deg,
            largest_rms_deg,
            reduced_chi_square: reduced,
            cause: match reduced {
                Some(reduced) if is_near => LikelyCause::of_deviations(used, reduced),
                _ => LikelyCause::of(used, start),
            },
        })
    }
}

/// Returns true if standard deviations explain residuals with this chi-square.
pub(super) fn is_explained(chi_square: f64, freedom: usize) -> bool {
    let freedom = freedom.max(1) as f64;
    chi_square / freedom <= 1.0 + DEVIATIONS * (2.0 / freedom).sqrt()
}

impl LikelyCause {
    /// The mistake that a comparison of `points` with the theory of `scene` shows.
    fn of(points: &MeasuredPoints, scene: &Scene) -> Option<Self> {
        let whiskers = points.whiskers_in(scene).ok()?;
        let comparison = points.beside_all(&whiskers);
        let predicted = comparison.rows.iter().filter_map(|row| row.predicted_deg);
        let has_tens = predicted.fold(0.0, |most: f64, angle| most.max(angle.abs())) >= TENS_DEG;
        if has_tens && points.points.iter().all(|point| point.angle_deg.abs() < TURN) {
            return Some(Self::Radians);
        }
        let mut farther = points.clone();
        for point in &mut farther.points {
            point.distance_mm *= 10.0;
        }
        farther.check_reach_of(&whiskers).ok()?;
        let rms_deg = farther.beside_all(&whiskers).rms_deg()?;
        (rms_deg < comparison.rms_deg()? / 2.0).then_some(Self::Centimetres)
    }

    /// The mistake that the standard deviations of `points` show with this reduced chi-square. Deviations in radians are
    /// `180 / pi` times too small, and the residuals show this factor within 2.
    fn of_deviations(points: &MeasuredPoints, reduced: f64) -> Option<Self> {
        let turn = 1.0_f64.to_degrees();
        let is_turned = (turn / 2.0..=2.0 * turn).contains(&reduced.sqrt());
        let mut points = points.points.iter();
        let is_small = points.all(|point| point.sd_deg < TURN / turn);
        (is_turned && is_small).then_some(Self::RadianDeviations)
    }
}

impl fmt::Display for NotAFit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [rms, largest] = [self.rms_deg, self.largest_rms_deg].map(three_digits);
        write!(f, "not a fit: RMS {rms} deg")?;
        if self.rms_deg > self.largest_rms_deg {
            write!(f, ", must be at most {largest} deg")?;
        }
        if let Some(reduced) = self.reduced_chi_square {
            let reduced = three_digits(reduced);
            write!(f, "; reduced chi-square {reduced}, must be about 1")?;
        }
        match self.cause {
            Some(LikelyCause::Radians) => {
                f.write_str("; all measured angles are below 6.3, predicted ones are tens: are they in radians?")
            }
            Some(LikelyCause::Centimetres) => {
                f.write_str("; ten times the distances fit better: are they in cm?")
            }
            Some(LikelyCause::RadianDeviations) => {
                f.write_str("; residuals are tens of times as large as sd_deg: are the deviations in radians?")
            }
            None => Ok(()),
        }
    }
}

/// A number to three digits.
fn three_digits(number: f64) -> String {
    digits(rounded(number, 3))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failure fails the test")]
mod tests {
    use super::*;
    use crate::measured::Comparison;
    use crate::scene::SweptWhisker;

    fn cone() -> Scene {
        Scene::read("scenes/cone.toml").unwrap()
    }

    /// One point for each pair of a distance in mm and an angle in degrees, on the convex side.
    fn points(all: &[[f64; 2]], sd_deg: Option<f64>) -> MeasuredPoints {
        let (name, sd) = sd_deg.map_or(("", String::new()), |sd| (",sd_deg", format!(",{sd}")));
        let mut text = format!("side,distance_mm,push_angle_deg{name}\n");
        for [distance_mm, angle_deg] in all {
            text += &format!("cb,{distance_mm},{angle_deg}{sd}\n");
        }
        MeasuredPoints::parse(&text, "points.csv").unwrap()
    }

    fn compared(points: &MeasuredPoints) -> Comparison {
        let SweptWhisker { whisker, pole, .. } = cone().first_whisker();
        points.beside(&whisker, &pole)
    }

    /// The verdict on points `off_deg` away from the theory of the cone.
    fn verdict(
        off_deg: f64,
        sd_deg: Option<f64>,
        chi_square: f64,
        freedom: usize,
    ) -> Option<NotAFit> {
        let places = [8.0, 10.0, 12.0].map(|distance_mm| [distance_mm, 20.0]);
        let theory = compared(&points(&places, None));
        let places = theory
            .rows
            .iter()
            .map(|row| [row.distance_mm.unwrap(), row.predicted_deg.unwrap() + off_deg]);
        let near = points(&places.collect::<Vec<_>>(), sd_deg);
        NotAFit::new(&near, &cone(), compared(&near).rms_deg(), chi_square, freedom)
    }

    #[test]
    fn a_fit_is_within_five_degrees() {
        assert_eq!(verdict(4.9, None, 1.0, 2), None);
        assert_eq!(verdict(5.1, None, 1.0, 2).unwrap().largest_rms_deg, 5.0);
    }

    #[test]
    fn a_fit_is_within_a_third_of_the_range() {
        let small = points(&[[8.0, 2.0], [10.0, 6.0], [12.0, 9.0]], None);
        let why = NotAFit::new(&small, &cone(), compared(&small).rms_deg(), 1.0, 2).unwrap();
        assert_eq!(why.largest_rms_deg, 3.0);
    }

    #[test]
    fn residuals_of_a_fit_are_at_most_twenty_deviations() {
        assert_eq!(verdict(1.0, Some(0.1), 399.0 * 7.0, 7), None);
        let why = verdict(1.0, Some(0.1), 401.0 * 7.0, 7).unwrap();
        assert_eq!(why.reduced_chi_square, Some(401.0));
    }

    /// The reduced chi-square of 50 degrees of freedom has the standard deviation 0.2.
    #[test]
    fn deviations_explain_residuals_up_to_five_of_their_own() {
        assert!(is_explained(50.0 * 1.99, 50) && !is_explained(50.0 * 2.01, 50));
        assert_eq!(verdict(20.0, Some(20.0), 50.0 * 1.99, 50), None);
        assert!(verdict(20.0, Some(20.0), 50.0 * 2.01, 50).is_some());
    }

    #[test]
    fn angles_below_a_turn_beside_predicted_tens_are_radians() {
        for (angle, cause) in [(6.2, Some(LikelyCause::Radians)), (6.4, None)] {
            let found = LikelyCause::of(&points(&[[10.0, 0.3], [12.0, angle]], None), &cone());
            assert_eq!(found, cause, "{angle}");
        }
        let mut counts = [0; 2];
        for i in 0..20 {
            let places = points(&[[15.0 + 0.2 * f64::from(i), 0.1]], None);
            let Some(predicted) = compared(&places).rows[0].predicted_deg else {
                continue;
            };
            let is_radians = LikelyCause::of(&places, &cone()) == Some(LikelyCause::Radians);
            assert_eq!(is_radians, predicted >= 10.0, "{predicted}");
            counts[usize::from(is_radians)] += usize::from((5.0..20.0).contains(&predicted));
        }
        assert!(counts.iter().all(|count| *count > 0), "{counts:?}");
    }
}
