//! Comparison of measured points with theory.

use super::{MeasuredPoint, MeasuredPoints};
use crate::input::shortened;
use crate::scene::{Pole, Whisker, digits};
use crate::sensitivity::{DetachmentDerivatives, Variable, detachments_of};
use crate::trace::row;
use crate::trace::{DetachmentKind, EndDetail, PushedWhisker};
use serde::Serialize;
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::Resolution;

row! {
    /// A measured detachment and the one that the theory predicts.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct ComparedPoint {
        /// Line of the measured point in its file, from 1.
        pub line: usize,
        pub side: Side,
        pub distance_mm: Option<f64>,
        /// Measured angle, in degrees: of the push or of the chord, as in the file.
        pub measured_deg: Option<f64>,
        /// Standard deviation of the measured angle, in degrees; empty where not given.
        pub sd_deg: Option<f64>,
        /// Observed end of the push: slip-off, pull-off or empty.
        pub kind: Option<DetachmentKind>,
        /// Predicted angle of the same kind, in degrees; empty where the side never detaches.
        pub predicted_deg: Option<f64>,
        /// Predicted end of the push: slip-off, pull-off, out-of-reach or unresolved.
        pub predicted_kind: Option<DetachmentKind>,
        /// Measured less predicted angle, in degrees.
        pub residual_deg: Option<f64>,
        /// Reason of a point without a residual: missing (a value) or no-detachment.
        pub reason: Option<NotCompared>,
    }
}

/// Reason why a measured point has no residual.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NotCompared {
    /// A value of the measured point is missing.
    Missing,
    /// By theory, the side of the measured point never detaches.
    NoDetachment,
}

/// Measured points with the predictions for one whisker and pole.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Measured points with their predictions, in the order of the file: `[point]`.
    pub rows: Vec<ComparedPoint>,
}

impl MeasuredPoints {
    /// Returns one line for points whose angle has the other side's sign; `None` without such points.
    #[must_use]
    pub fn crossed(&self) -> Option<String> {
        let is_crossed = |point: &&MeasuredPoint| point.side.sign() * point.angle_deg < 0.0;
        let crossed = self.points.iter().filter(is_crossed).count();
        (crossed > 0).then(|| {
            let (all, origin) = (self.points.len(), &self.origin);
            format!(
                "{crossed} of {all} points in {origin} have an angle of the other side's sign: it is positive for cb, negative for cf"
            )
        })
    }

    /// Returns one line for each point without a prediction in `comparison`, because by theory its side never detaches.
    #[must_use]
    pub fn left_out(&self, comparison: &Comparison) -> Vec<String> {
        let (rows, origin) = (comparison.left_out(), &self.origin);
        let warning = |row: &ComparedPoint| {
            let (line, distance) = (row.line, digits(row.distance_mm.unwrap_or(f64::NAN)));
            format!(
                "{origin}:{line}: left out: by theory this side never detaches at {distance} mm"
            )
        };
        rows.map(warning).collect()
    }

    /// Returns one line for the points with a missing value; `None` without such points.
    #[must_use]
    pub fn missing(&self) -> Option<String> {
        let lines: Vec<String> =
            self.incomplete.iter().map(|point| point.line.to_string()).collect();
        let count = self.points.len() + lines.len();
        (!lines.is_empty()).then(|| {
            format!(
                "{} of {count} points in {} have a missing value and are left out: lines {}",
                lines.len(),
                self.origin,
                shortened(&lines.join(", "))
            )
        })
    }

    /// Compares the points with the detachments of `whisker` at `pole`. Rows of points with a missing value have no prediction.
    #[must_use]
    pub fn beside(&self, whisker: &Whisker, pole: &Pole) -> Comparison {
        self.with_incomplete(self.compared(|_| (whisker, pole)))
    }

    /// Returns compared points together with those that have a missing value, in the order of the file.
    pub(super) fn with_incomplete(&self, mut rows: Vec<ComparedPoint>) -> Comparison {
        let known = |number: f64| Some(number).filter(|number| !number.is_nan());
        let incomplete = self.incomplete.iter().map(|point| ComparedPoint {
            line: point.line,
            side: point.side,
            distance_mm: known(point.distance_mm),
            measured_deg: known(point.angle_deg),
            sd_deg: known(point.sd_deg).filter(|_| self.have_deviations),
            kind: point.kind,
            predicted_deg: None,
            predicted_kind: None,
            residual_deg: None,
            reason: Some(NotCompared::Missing),
        });
        rows.extend(incomplete);
        rows.sort_by_key(|row| row.line);
        Comparison { rows }
    }

    /// Returns the points that have all of their values, each with the prediction for its whisker and pole, which `of_whisker` returns by the
    /// whisker's index: `[point]`.
    pub(super) fn compared<'a>(
        &self,
        of_whisker: impl Fn(usize) -> (&'a Whisker, &'a Pole),
    ) -> Vec<ComparedPoint> {
        let compared = |(point, DetachmentDerivatives { end, .. }): (&MeasuredPoint, _)| {
            let predicted_deg = self.angle.of_end(&end);
            ComparedPoint {
                line: point.line,
                side: point.side,
                distance_mm: Some(point.distance_mm),
                measured_deg: Some(point.angle_deg),
                sd_deg: self.have_deviations.then_some(point.sd_deg),
                kind: point.kind,
                predicted_deg,
                predicted_kind: Some(end.kind),
                residual_deg: predicted_deg.map(|predicted| point.angle_deg - predicted),
                reason: match predicted_deg {
                    None => Some(NotCompared::NoDetachment),
                    Some(_) => None,
                },
            }
        };
        self.points.iter().zip(self.predicted(of_whisker, &[])).map(compared).collect()
    }

    /// Returns the predicted detachments of the points that have all of their values, each for its whisker and pole as in [`Self::compared`], with
    /// derivatives by `variables`: `[point]`.
    pub(super) fn predicted<'a>(
        &self,
        of_whisker: impl Fn(usize) -> (&'a Whisker, &'a Pole),
        variables: &[Variable],
    ) -> Vec<DetachmentDerivatives> {
        let order = |a: &MeasuredPoint, b: &MeasuredPoint| {
            let sides = a.side.sign().total_cmp(&b.side.sign());
            a.whisker.cmp(&b.whisker).then(sides).then(a.distance_mm.total_cmp(&b.distance_mm))
        };
        let mut places = self.points.clone();
        places.sort_by(order);
        places.dedup_by(|a, b| order(a, b).is_eq());
        let sides: Vec<&[MeasuredPoint]> =
            places.chunk_by(|a, b| a.whisker == b.whisker && a.side == b.side).collect();
        let distances = sides.iter().map(|of_side| of_side.iter().map(|place| place.distance_mm));
        let distances: Vec<Vec<f64>> = distances.map(Iterator::collect).collect();
        let pushed = sides.iter().zip(&distances).map(|(of_side, distances_mm)| {
            let MeasuredPoint { whisker, side, .. } = of_side[0];
            let (whisker, pole) = of_whisker(whisker);
            PushedWhisker { whisker, pole, side, distances_mm }
        });
        let pushed: Vec<PushedWhisker> = pushed.collect();
        let ends = detachments_of(Resolution::FINE, &pushed, EndDetail::State, variables).concat();
        let of_point =
            |point| ends[places.partition_point(|place| order(place, point).is_lt())].clone();
        self.points.iter().map(of_point).collect()
    }
}

impl Comparison {
    /// Returns the measured points without a prediction, because by theory their side never detaches.
    pub fn left_out(&self) -> impl Iterator<Item = &ComparedPoint> {
        let reason = Some(NotCompared::NoDetachment);
        self.rows.iter().filter(move |row| row.reason == reason)
    }

    /// Returns the number of measured points with a prediction.
    #[must_use]
    pub fn count(&self) -> usize {
        self.residuals().count()
    }

    /// Returns the number of points with a prediction whose measured kind differs from the predicted one.
    #[must_use]
    pub fn of_another_kind(&self) -> usize {
        let compared = self.rows.iter().filter(|row| row.residual_deg.is_some());
        let differs = |row: &&ComparedPoint| row.kind.is_some() && row.kind != row.predicted_kind;
        compared.filter(differs).count()
    }

    /// Returns the root mean square of the residuals, in degrees; `None` without residuals.
    #[must_use]
    pub fn rms_deg(&self) -> Option<f64> {
        let squares: f64 = self.residuals().map(|residual| residual * residual).sum();
        self.mean(squares).map(f64::sqrt)
    }

    /// Returns the mean of the residuals, in degrees; `None` without residuals.
    #[must_use]
    pub fn bias_deg(&self) -> Option<f64> {
        self.mean(self.residuals().sum())
    }

    fn mean(&self, sum: f64) -> Option<f64> {
        let count = self.count();
        (count > 0).then(|| sum / count as f64)
    }

    fn residuals(&self) -> impl Iterator<Item = f64> {
        self.rows.iter().filter_map(|row| row.residual_deg)
    }
}
