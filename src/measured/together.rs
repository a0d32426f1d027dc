//! Points of several whiskers together, each compared with its own whisker, as fits do.

use super::{ComparedPoint, Comparison, MeasuredPoint, MeasuredPoints};
use crate::input::{CsvError, did_you_mean, shortened};
use crate::scene::{SceneData, SweptWhisker};
use crate::sensitivity::Variable;
use rayon::prelude::*;

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
        self.with_incomplete(self.compared_with(whiskers))
    }

    /// Returns the points that have all of their values, with the predictions for their `whiskers`: `[point]`.
    pub(crate) fn compared_with(&self, whiskers: &[SweptWhisker]) -> Vec<ComparedPoint> {
        let compared = whiskers.par_iter().enumerate().map(|(index, swept)| {
            let points = self.of_whisker(index);
            points.compared(&swept.whisker, &swept.pole)
        });
        self.in_order(compared.collect())
    }

    /// Returns the derivatives of the predicted angles as [`Self::derivatives`] does, each for the point's own whisker.
    pub(crate) fn derivatives_with(
        &self,
        whiskers: &[SweptWhisker],
        variables: &[Variable],
    ) -> Option<Vec<Vec<f64>>> {
        let derivatives = whiskers.par_iter().enumerate().map(|(index, swept)| {
            let points = self.of_whisker(index);
            points.derivatives(&swept.whisker, &swept.pole, variables)
        });
        let derivatives: Vec<Vec<Vec<f64>>> = derivatives.collect::<Option<_>>()?;
        let of_variable = |variable: usize| {
            let values = derivatives.iter().map(|of_whisker| of_whisker[variable].clone());
            self.in_order(values.collect())
        };
        Some((0..variables.len()).map(of_variable).collect())
    }

    /// Returns values of the points of each whisker, `[whisker][point]`, in the order of all points: `[point]`.
    fn in_order<T>(&self, values: Vec<Vec<T>>) -> Vec<T> {
        let mut values: Vec<_> = values.into_iter().map(Vec::into_iter).collect();
        let points = self.points.iter();
        points.filter_map(|point| values[point.whisker].next()).collect()
    }
}
