//! Points of several whiskers together, each compared with its own whisker, as fits do.

use super::{Comparison, MeasuredPoint, MeasuredPoints};
use crate::input::{CsvError, did_you_mean, shortened};
use crate::scene::{Pole, SceneData, SweptWhisker, Whisker};
use crate::sensitivity::{DetachmentDerivatives, Variable};

impl MeasuredPoints {
    /// Returns the whisker of `scene` for each name of the points, `[whisker]`; without names, the first whisker of the scene.
    ///
    /// # Errors
    /// The scene has no table of whiskers or another axis, or its table has no row, or a row without a whisker, of a name.
    pub(crate) fn whiskers_in(&self, scene: &SceneData) -> Result<Vec<SweptWhisker>, CsvError> {
        if self.whiskers.is_empty() {
            return Ok(vec![scene.first_whisker()]);
        }
        let names = match &*scene.grid.sweep {
            [axis] if !axis.variable.names().is_empty() => axis.variable.names(),
            _ => return Err(self.without_table()),
        };
        let of_name = |(index, name): (usize, &String)| {
            let refused = |why: String| {
                let all = self.points.iter().chain(&self.incomplete);
                let lines = all.filter(|point| point.whisker == index);
                let line = lines.map(|point| point.line).min().unwrap_or_default();
                let what = format!("whisker = {}: {why}", shortened(name));
                CsvError::at(&self.origin, line, what)
            };
            let place = (0..scene.whisker_count()).map(|index| scene.grid.place(index));
            let mut places = place.filter(|place| place.whisker() == Some(name));
            let place = places.next().ok_or_else(|| {
                let hint = did_you_mean(name, names.iter().map(String::as_str));
                let must = "must be a whisker of the scene's table";
                refused(format!("{must}, such as {}{hint}", shortened(&names[0])))
            })?;
            scene
                .whisker_at(place)
                .map_err(|why| refused(format!("its row has no whisker: {}", why.reason)))
        };
        self.whiskers.iter().enumerate().map(of_name).collect()
    }

    /// Checks that each of the resting `whiskers`, which [`Self::whiskers_in`] returns, touches its pole at the distances of its points.
    ///
    /// # Errors
    /// The first point that is out of reach.
    pub(crate) fn check_reach_of(&self, whiskers: &[SweptWhisker]) -> Result<(), CsvError> {
        let mut indexed = whiskers.iter().enumerate();
        indexed.try_for_each(|(index, swept)| {
            let points = self.of_whisker(index);
            points.check_reach(&swept.whisker, &swept.pole)
        })
    }

    /// Returns the first point at whose distance its resting whisker does not touch its pole; `None` if all are within reach.
    pub(crate) fn first_out_of_reach_of(&self, whiskers: &[SweptWhisker]) -> Option<MeasuredPoint> {
        let mut indexed = whiskers.iter().enumerate();
        indexed.find_map(|(index, swept)| {
            let points = self.of_whisker(index);
            points.first_out_of_reach(&swept.whisker, &swept.pole).copied()
        })
    }

    /// Compares the points with the detachments of their `whiskers`, as [`Self::beside`] does.
    pub(crate) fn beside_all(&self, whiskers: &[SweptWhisker]) -> Comparison {
        self.with_incomplete(self.compared(with_poles(whiskers)))
    }

    /// Returns the points that detach by the theory of their `whiskers`.
    pub(crate) fn detaching(&self, whiskers: &[SweptWhisker]) -> Self {
        let pairs = self.points.iter().zip(self.compared(with_poles(whiskers)));
        let detaching = pairs.filter(|(_, row)| row.residual_deg.is_some());
        Self {
            points: detaching.map(|(point, _)| *point).collect(),
            incomplete: Vec::new(),
            ..self.clone()
        }
    }

    /// Returns the residuals of the points, and their derivatives by each of `variables`. `None` where a point is out of reach or never detaches.
    pub(crate) fn residuals(
        &self,
        whiskers: &[SweptWhisker],
        variables: &[Variable],
    ) -> Option<Residuals> {
        self.check_reach_of(whiskers).ok()?;
        let predicted = self.predicted(with_poles(whiskers), variables);
        let pairs = || self.points.iter().zip(&predicted);
        let residual = |(point, predicted): (&MeasuredPoint, &DetachmentDerivatives)| {
            Some((self.angle.of_end(&predicted.end)? - point.angle_deg) / point.sd_deg)
        };
        let of_variable = |variable: usize| {
            let by = pairs().map(|(point, predicted)| {
                let by = predicted.by[variable].as_ref().ok()?;
                Some(self.angle.of_derivatives(by) / point.sd_deg)
            });
            by.collect()
        };
        Some(Residuals {
            values: pairs().map(residual).collect::<Option<_>>()?,
            by: (0..variables.len()).map(of_variable).collect(),
        })
    }
}

/// Predicted less measured angles over their standard deviations, dimensionless.
pub(crate) struct Residuals {
    /// Residual of each point, `[point]`.
    pub values: Vec<f64>,
    /// Derivatives of the residuals per unit of each variable, `[variable][point]`. `None` if one of them does not exist.
    pub by: Option<Vec<Vec<f64>>>,
}

/// Returns the function from the index of a swept whisker to the whisker and its pole.
fn with_poles<'a>(whiskers: &'a [SweptWhisker]) -> impl Fn(usize) -> (&'a Whisker, &'a Pole) {
    move |index| (&whiskers[index].whisker, &whiskers[index].pole)
}
