//! Rows of whiskers, sides and distances.
//!
//! Rows with the same whisker and side are computed together: one sheet serves all their distances.

use rayon::iter::Either;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap::Side;
use whiskmap::scene::{Parameter, Scene, SceneBuilder};
use whiskmap::sensitivity::{Derivatives, DetachmentDerivatives, Variable, detachments};
use whiskmap::trace::Detachment;
use whiskmap::yields::PushMark;

/// Maximum number of distances of one sheet.
const MOST_DISTANCES: usize = 4096;

/// Arrays of whiskers, sides and distances, `[row]` each.
pub struct DetachmentRows<'a> {
    /// Description with the numbers that are equal in all rows.
    pub base: SceneBuilder,
    /// Parameters that differ from row to row, with their values.
    pub varying: Vec<(Parameter, &'a [f64])>,
    pub distance_mm: &'a [f64],
    pub is_cb: &'a [bool],
    /// Variables of the derivatives, `[variable]`.
    pub variables: Vec<Variable>,
    /// True if the rows give a taper: then the radius at the base varies at a fixed taper, otherwise at a fixed radius at the tip.
    pub have_taper: bool,
}

/// End of one row, and its derivatives, `[variable]`; `None` where there is none.
pub struct RowEnd {
    pub row: usize,
    pub end: Detachment,
    pub by: Vec<Option<Derivatives>>,
    /// Mark of the push; `None` without a yield strain.
    pub mark: Option<PushMark>,
}

/// End of a push with its derivatives, and the mark of the push.
type MarkedEnd = (Detachment, Vec<Option<Derivatives>>, Option<PushMark>);

/// Error of a row whose numbers a scene refuses.
pub struct RefusedRow {
    pub row: usize,
    pub why: Box<whiskmap::scene::SceneError>,
}

impl DetachmentRows<'_> {
    /// Returns the end of every row in any order, and the refused rows in order. After a cancellation, rows are missing.
    pub fn ends(&self, cancel: &Arc<AtomicBool>) -> (Vec<RowEnd>, Vec<RefusedRow>) {
        let groups = self.groups();
        let ends = groups
            .par_iter()
            .filter(|_| !cancel.load(Ordering::Relaxed))
            .flat_map_iter(|rows| self.ends_of(rows.clone()));
        let (ends, mut refused): (Vec<RowEnd>, Vec<RefusedRow>) =
            ends.partition_map(|end| match end {
                Ok(end) => Either::Left(end),
                Err(refused) => Either::Right(refused),
            });
        refused.sort_by_key(|refused| refused.row);
        (ends, refused)
    }

    /// Rows with the same whisker and side, by growing distance, `[sheet][row]`.
    fn groups(&self) -> Vec<Vec<usize>> {
        let mut places: HashMap<Vec<u64>, usize> = HashMap::new();
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for row in 0..self.distance_mm.len() {
            let numbers = self.varying.iter().map(|(_, values)| values[row].to_bits());
            let key = numbers.chain([u64::from(self.is_cb[row])]).collect();
            let place = *places.entry(key).or_insert(groups.len());
            match groups.get_mut(place) {
                Some(group) => group.push(row),
                None => groups.push(vec![row]),
            }
        }
        for group in &mut groups {
            group.sort_by(|one, other| self.distance_mm[*one].total_cmp(&self.distance_mm[*other]));
        }
        let sheets = groups.iter().flat_map(|group| group.chunks(MOST_DISTANCES));
        sheets.map(<[_]>::to_vec).collect()
    }

    /// The ends of rows of one whisker and side. A refused distance leaves the others.
    fn ends_of(&self, mut rows: Vec<usize>) -> Vec<Result<RowEnd, RefusedRow>> {
        let mut ends = Vec::with_capacity(rows.len());
        let (scene, distances) = loop {
            let Some(first) = rows.first() else {
                return ends;
            };
            let mut distances: Vec<f64> = rows.iter().map(|row| self.distance_mm[*row]).collect();
            distances.dedup();
            let mut builder = self.base.clone().distance_mm(&*distances);
            for (parameter, values) in &self.varying {
                builder = builder.set(*parameter, values[*first]);
            }
            let why = match builder.build() {
                Ok(scene) => break (scene, distances),
                Err(why) => why,
            };
            let place = why.key().and_then(|key| {
                let place = key.strip_prefix("grid.distance_mm[")?.strip_suffix(']')?;
                place.parse::<usize>().ok()
            });
            let distance = place.and_then(|place| distances.get(place).copied());
            let is_refused = |row: &mut usize| {
                distance.is_none_or(|distance| self.distance_mm[*row] == distance)
            };
            ends.extend(rows.extract_if(.., is_refused).map(|row| {
                let why = Box::new(why.clone());
                Err(RefusedRow { row, why })
            }));
        };
        let first = rows[0];
        let side = if self.is_cb[first] {
            Side::Cb
        } else {
            Side::Cf
        };
        let found = self.differentiated(&scene, side, &distances);
        ends.extend(rows.into_iter().map(|row| {
            let place = distances.partition_point(|distance| *distance < self.distance_mm[row]);
            let (end, by, mark) = found[place].clone();
            Ok(RowEnd { row, end, by, mark })
        }));
        ends
    }

    /// The ends of one whisker and side with their derivatives and marks, `[distance]`.
    fn differentiated(&self, scene: &Scene, side: Side, distances: &[f64]) -> Vec<MarkedEnd> {
        let (whisker, pole) = (&scene.whisker, &scene.pole);
        let base = Variable::from(Parameter::BaseRadiusUm);
        let base = self
            .variables
            .iter()
            .position(|variable| self.have_taper && *variable == base);
        let mut variables = self.variables.clone();
        variables.extend(base.map(|_| Variable::from(Parameter::TipRadiusUm)));
        let ends = detachments(whisker, pole, side, distances, &variables);
        let end = |derivatives: DetachmentDerivatives| {
            let mut by: Vec<Option<Derivatives>> =
                derivatives.by.into_iter().map(Result::ok).collect();
            if let Some(base) = base {
                let tip = by.pop().flatten();
                by[base] = by[base]
                    .zip(tip)
                    .map(|(base, tip)| base.plus(1.0 - whisker.taper(), &tip));
            }
            let mark = PushMark::of_end(whisker, pole, &derivatives.end);
            (derivatives.end, by, mark)
        };
        ends.into_iter().map(end).collect()
    }
}
