//! Rows of whiskers, sides and distances.
//!
//! One sheet serves all rows with the same whisker and side. Different whiskers share batches.

use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap::Side;
use whiskmap::mechanics::shooting::Resolution;
use whiskmap::scene::{Parameter, Scene, SceneBuilder};
use whiskmap::sensitivity::{Derivatives, DetachmentDerivatives, Variable, detachments_of};
use whiskmap::trace::{Detachment, EndDetail, PushedWhisker, sides_at_once};
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

/// Rows of one whisker and side that the scene accepts.
struct CheckedRows {
    scene: Scene,
    side: Side,
    /// Distances of the rows in growing order, in mm, each once.
    distances: Vec<f64>,
    rows: Vec<usize>,
}

/// Error of a row whose numbers a scene refuses.
pub struct RefusedRow {
    pub row: usize,
    pub why: Box<whiskmap::scene::SceneError>,
}

impl DetachmentRows<'_> {
    /// Returns the end of every row in any order, and the refused rows in order. After a cancellation, rows are missing.
    pub fn ends(&self, cancel: &Arc<AtomicBool>) -> (Vec<RowEnd>, Vec<RefusedRow>) {
        let groups = self.groups();
        let distances = self.distance_mm.len().div_ceil(groups.len().max(1));
        let of_chunk = |groups: &[Vec<usize>]| {
            let checked = groups.iter().map(|rows| self.checked(rows.clone()));
            let (checked, refused): (Vec<_>, Vec<_>) = checked.unzip();
            let checked: Vec<CheckedRows> = checked.into_iter().flatten().collect();
            (self.ends_of(&checked), refused)
        };
        let chunks = groups
            .par_chunks(sides_at_once(groups.len(), distances))
            .filter(|_| !cancel.load(Ordering::Relaxed));
        let (ends, refused): (Vec<_>, Vec<Vec<Vec<RefusedRow>>>) = chunks.map(of_chunk).unzip();
        let refused = refused.into_iter().flatten().flatten();
        let mut refused: Vec<RefusedRow> = refused.collect();
        refused.sort_by_key(|refused| refused.row);
        (ends.into_iter().flatten().collect(), refused)
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

    /// Checks rows of one whisker and side. A refused distance leaves the others; `None` if all are refused.
    fn checked(&self, mut rows: Vec<usize>) -> (Option<CheckedRows>, Vec<RefusedRow>) {
        let mut refused = Vec::new();
        loop {
            let Some(first) = rows.first() else {
                return (None, refused);
            };
            let side = if self.is_cb[*first] { Side::Cb } else { Side::Cf };
            let mut distances: Vec<f64> = rows.iter().map(|row| self.distance_mm[*row]).collect();
            distances.dedup();
            let mut builder = self.base.clone().distance_mm(&*distances);
            for (parameter, values) in &self.varying {
                builder = builder.set(*parameter, values[*first]);
            }
            let why = match builder.build() {
                Ok(scene) => {
                    let checked = CheckedRows { scene, side, distances, rows };
                    return (Some(checked), refused);
                }
                Err(why) => why,
            };
            let place = why.key().and_then(|key| {
                if key == Parameter::PoleRadiusMm.key() {
                    // The nearest pole would reach the base; farther ones may not.
                    return Some(0);
                }
                let place = key.strip_prefix("grid.distance_mm[")?.strip_suffix(']')?;
                place.parse::<usize>().ok()
            });
            let distance = place.and_then(|place| distances.get(place).copied());
            let is_refused = |row: &mut usize| {
                distance.is_none_or(|distance| self.distance_mm[*row] == distance)
            };
            refused.extend(rows.extract_if(.., is_refused).map(|row| {
                let why = Box::new(why.clone());
                RefusedRow { row, why }
            }));
        }
    }

    /// The ends of the rows of some whiskers and sides with their derivatives and marks, in any order.
    fn ends_of(&self, checked: &[CheckedRows]) -> Vec<RowEnd> {
        let base = Variable::from(Parameter::BaseRadiusUm);
        let base = self.variables.iter().position(|variable| self.have_taper && *variable == base);
        let mut variables = self.variables.clone();
        variables.extend(base.map(|_| Variable::from(Parameter::TipRadiusUm)));
        let pushed = checked.iter().map(|checked| PushedWhisker {
            whisker: &checked.scene.whisker,
            pole: &checked.scene.pole,
            side: checked.side,
            distances_mm: &checked.distances,
        });
        let pushed: Vec<PushedWhisker> = pushed.collect();
        let found = detachments_of(Resolution::FINE, &pushed, EndDetail::Snaps, &variables);
        let ends = checked.iter().zip(found).flat_map(|(checked, found)| {
            let CheckedRows { scene, distances, rows, .. } = checked;
            let (whisker, pole) = (&scene.whisker, &scene.pole);
            let end = |derivatives: DetachmentDerivatives| {
                let mut by: Vec<Option<Derivatives>> =
                    derivatives.by.into_iter().map(Result::ok).collect();
                if let Some(base) = base {
                    let tip = by.pop().flatten();
                    by[base] =
                        by[base].zip(tip).map(|(base, tip)| base.plus(1.0 - whisker.taper(), &tip));
                }
                let mark = PushMark::of_end(whisker, pole, &derivatives.end);
                (derivatives.end, by, mark)
            };
            let found: Vec<_> = found.into_iter().map(end).collect();
            rows.iter().map(move |&row| {
                let place = distances.partition_point(|distance| *distance < self.distance_mm[row]);
                let (end, by, mark) = found[place].clone();
                RowEnd { row, end, by, mark }
            })
        });
        ends.collect()
    }
}
