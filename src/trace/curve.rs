//! Detachment curves: the ends of pushes from first touch, for each distance.

use super::columns::{StateRow, row};
use crate::classify::{RowBoundary, TIE};
use crate::friction::{ContactHistory, Sliding, surely_slides_to_end};
use crate::scene::{Pole, Whisker};
use crate::sheet::{Crossing, Edge, Sheet};
use serde::{Deserialize, Serialize};
use whiskmap_mechanics::rod::{Rest, Side};
use whiskmap_mechanics::shooting::batch::{Batch, Method};
use whiskmap_mechanics::shooting::{FirstVariation, PeakStrain, Reader, Reading, Resolution};

/// Kind of the end of a push from first touch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DetachmentKind {
    /// The push ends at the fold.
    SlipOff,
    /// The push ends with the contact at the tip.
    PullOff,
    /// The push does not begin: the resting whisker does not reach the pole.
    OutOfReach,
    /// The end of the push is unknown: the boundary of the row was not found.
    #[default]
    Unresolved,
    /// There is no push: the row of the table of whiskers has no whisker.
    NoWhisker,
}

row! {
    /// End of a push at one distance; the values are `None` if no end exists or was found.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct Detachment of a state {
        pub side: Side,
        pub distance_mm: f64,
        /// Distance from the base to the pole's centre, in mm, constant in a push.
        pub pole_distance_mm: Option<f64>,
        /// End of the push: slip-off, pull-off, out-of-reach, unresolved or no-whisker.
        pub kind: DetachmentKind,
        pub push_angle_deg: Option<f64>,
        pub push_chord_deg: Option<f64> = place,
        pub contact_distance_mm: Option<f64> = place,
        pub arc_length_mm: Option<f64> = place,
        pub force_un: Option<f64> = load,
        pub contact_force_un: Option<f64> = load,
        pub base_force_x_un: Option<f64> = load,
        pub base_force_y_un: Option<f64> = load,
        pub base_moment_nnm: Option<f64> = load,
        pub energy_nj: Option<f64> = load,
        pub peak_strain: Option<f64>,
        pub peak_strain_mm: Option<f64>,
        pub contact_angle_deg: Option<f64> = place,
        /// Remaining error of the detachment, relative to the distance of the pole.
        pub residual: Option<f64>,
        /// Sliding direction, with friction; the end assumes tip.
        pub sliding: Option<Sliding>,
        pub snaps_deg: Option<f64>,
    }
}

impl Detachment {
    /// Returns the detachments of a row of a table that has no whisker, `[distance]`: without values.
    #[must_use]
    pub fn without_whisker(side: Side, distances_mm: &[f64]) -> Vec<Self> {
        let end = |distance_mm: &f64| Self {
            side,
            distance_mm: *distance_mm,
            kind: DetachmentKind::NoWhisker,
            ..Self::default()
        };
        distances_mm.iter().map(end).collect()
    }
}

/// Returns the distance in mm at which the tip of the resting whisker touches the pole: the largest distance of a detachment curve.
#[must_use]
pub fn reach_mm(whisker: &Whisker, pole: &Pole, side: Side) -> f64 {
    Rest::new(&whisker.rod(pole, side)).reach() * whisker.length_mm
}

/// Computes the detachment curve of `whisker` on one `side`: one end for each of `distances_mm`, which must increase, `[distance]`.
#[must_use]
pub fn curve(whisker: &Whisker, pole: &Pole, side: Side, distances_mm: &[f64]) -> Vec<Detachment> {
    curve_at(Resolution::FINE, whisker, pole, side, distances_mm)
}

/// Computes the detachment curve as [`curve`] does, at another resolution.
#[must_use]
pub fn curve_at(
    resolution: Resolution,
    whisker: &Whisker,
    pole: &Pole,
    side: Side,
    distances_mm: &[f64],
) -> Vec<Detachment> {
    let pushed = (whisker, pole, side);
    detachments(resolution, pushed, distances_mm, true, |end, _| end)
}

/// Computes the detachment curve as [`curve_at`] does, but leaves out the largest strain, which takes a trajectory more for each end.
#[must_use]
pub fn curve_without_strain(
    resolution: Resolution,
    whisker: &Whisker,
    pole: &Pole,
    side: Side,
    distances_mm: &[f64],
) -> Vec<Detachment> {
    let pushed = (whisker, pole, side);
    detachments(resolution, pushed, distances_mm, false, |end, _| end)
}

/// Computes what to `keep` of detachments, each with the crossing of the sheet's edge from which it is read, `[distance]`; `None` without an end.
/// If `has_strain` is true, each has its largest strain, and its sliding direction by the contact's history.
pub(crate) fn detachments<T>(
    resolution: Resolution,
    (whisker, pole, side): (&Whisker, &Pole, Side),
    distances_mm: &[f64],
    has_strain: bool,
    keep: impl Fn(Detachment, Option<Crossing>) -> T,
) -> Vec<T> {
    let rod = &whisker.rod(pole, side);
    let method = Method::new(resolution);
    let units = whisker.units();
    let reader = Reader::new(units, rod);
    let distances: Vec<f64> = distances_mm.iter().map(|d| d / whisker.length_mm).collect();
    // The history of a contact that sticks needs states before the end.
    let sheet = match has_strain && rod.friction != 0.0 {
        true => Sheet::new(method, rod, side, &distances),
        false => Sheet::of_ends(method, rod, side, &distances),
    };
    let row_ends = RowEnd::of(method, &sheet);
    let (peaks, slidings): (Vec<PeakStrain>, _) = match has_strain {
        true => {
            let crossings = row_ends.iter().flatten().map(|end| &end.crossing);
            let points = crossings.map(|crossing| (crossing.tau, crossing.load));
            let peaks = Batch::new(method.doubled()).shoot_at(rod, points);
            (peaks, slidings(&sheet, &row_ends))
        }
        false => (Vec::new(), vec![None; distances.len()]),
    };
    let mut peaks = peaks.into_iter();
    let rows = distances_mm.iter().zip(&sheet.rows).enumerate();
    let found = rows.zip(row_ends.into_iter().zip(slidings));
    let detachments = found.map(|((index, (distance_mm, row)), (row_end, sliding))| {
        let none = Detachment {
            side,
            distance_mm: *distance_mm,
            pole_distance_mm: Some(row.pole_distance * whisker.length_mm),
            ..Detachment::default()
        };
        let row_end: RowEnd = match row_end {
            Ok(row_end) => row_end,
            Err(kind) => return keep(Detachment { kind, ..none }, None),
        };
        // The residual of the crossing estimates the error after its last Newton step; `off` is the miss of this trajectory.
        let off = libm::log(row.pole_distance / row_end.state.full.map.pole.length()).abs();
        let peak = peaks.next();
        let end = Detachment {
            kind: row_end.kind(),
            push_angle_deg: Some((side.sign() * row_end.crossing.push).to_degrees()),
            peak_strain: peak.map(|peak| peak.strain * units.strain),
            peak_strain_mm: peak.map(|peak| peak.arclength * whisker.length_mm),
            residual: Some(row_end.crossing.residual + off),
            sliding: sliding.or(Sliding::of(&row_end.state, rod, row_end.crossing.tau)),
            snaps_deg: snaps_deg(&sheet, index),
            ..none.with_state(Some(&row_end.reading(&reader, &sheet, index)))
        };
        keep(end, Some(row_end.crossing))
    });
    detachments.collect()
}

/// End of a push from first touch, with its state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowEnd {
    /// Crossing of the row over the edge of the sheet.
    pub crossing: Crossing,
    /// State at the crossing, with its derivatives.
    pub state: FirstVariation,
}

impl RowEnd {
    /// Computes the ends of pushes in the rows of `sheet` with the integration `method`, `[row]`, or the reasons why there are none.
    pub fn of(method: Method, sheet: &Sheet) -> Vec<Result<Self, DetachmentKind>> {
        let crossings = crossings(sheet);
        let points = crossings.iter().flatten().map(|end| (end.tau, end.load));
        let mut states = Batch::new(method).shoot_at(&sheet.rod, points).into_iter();
        let end = |crossing: Result<&Crossing, _>| {
            let (crossing, state) = (*crossing?, states.next());
            let state = state.ok_or(DetachmentKind::Unresolved)?;
            Ok(Self { crossing, state })
        };
        crossings.into_iter().map(end).collect()
    }

    /// Returns the kind of the end.
    pub fn kind(&self) -> DetachmentKind {
        match self.crossing.edge {
            Edge::Fold => DetachmentKind::SlipOff,
            Edge::Tip => DetachmentKind::PullOff,
        }
    }

    /// Returns the state in physical units, as the end of this `row` of `sheet`.
    pub fn reading(&self, reader: &Reader, sheet: &Sheet, row: usize) -> Reading {
        let Crossing { tau, push, .. } = self.crossing;
        let (touch, push) = (sheet.rows[row].touch, sheet.side.sign() * push);
        reader.read(tau, &self.state.full, touch, push)
    }
}

/// Returns the crossing of each row of `sheet` at which a push from first touch ends, `[row]`, or the reason why there is none.
pub(crate) fn crossings(sheet: &Sheet) -> Vec<Result<&Crossing, DetachmentKind>> {
    let of_row = |row: usize| {
        if !sheet.touches(row) {
            return Err(DetachmentKind::OutOfReach);
        }
        let boundary = RowBoundary::new(true, &sheet.crossings[row]);
        let end = boundary.detachment().and(sheet.crossings[row].first());
        end.ok_or(DetachmentKind::Unresolved)
    };
    (0..sheet.rows.len()).map(of_row).collect()
}

/// Returns the signed push angle, in degrees, up to which the whisker in `row` of `sheet` may snap to other stable states: the end of
/// [`RowBoundary::snap`].
pub(crate) fn snaps_deg(sheet: &Sheet, row: usize) -> Option<f64> {
    let boundary = RowBoundary::new(sheet.touches(row), &sheet.crossings[row]);
    let span = boundary.snap()?;
    Some((sheet.side.sign() * span.to).to_degrees())
}

/// Returns the sliding direction of the contact at the detachment of each row of `sheet` by its history, `[row]`; `None` without friction or
/// an end, and where the history is not found.
fn slidings(sheet: &Sheet, ends: &[Result<RowEnd, DetachmentKind>]) -> Vec<Option<Sliding>> {
    let mut slidings = vec![None; sheet.rows.len()];
    if sheet.rod.friction == 0.0 {
        return slidings;
    }
    let rows = ends.iter().enumerate().filter_map(|(row, end)| {
        let RowEnd { crossing, state } = *end.as_ref().ok()?;
        (crossing.push > TIE).then_some((row, crossing, state))
    });
    let rows: Vec<(usize, Crossing, FirstVariation)> = rows.collect();
    let mut doubtful = Vec::new();
    for ((row, end, _), is_sure) in rows.iter().zip(surely_slides_to_end(sheet, &rows)) {
        match is_sure {
            true => slidings[*row] = Some(Sliding::Tip),
            false => doubtful.push((*row, end.push)),
        }
    }
    let levels = doubtful.iter().map(|(row, _)| sheet.level(*row));
    let histories = ContactHistory::of(&levels.collect::<Vec<_>>());
    for ((row, push), history) in doubtful.into_iter().zip(histories) {
        slidings[row] = history.and_then(|history| history.sliding_at_end(push));
    }
    slidings
}
