//! Detachment curves: the ends of pushes from first touch, for each distance.

use super::columns::{StateRow, row};
use crate::classify::{RowBoundary, TIE};
use crate::friction::{ContactHistory, Sliding, surely_slides_to_end};
use crate::scene::{Pole, Whisker};
use crate::sheet::{Crossing, Edge, LevelCurve, Sheet, SheetRequest, SheetUse, rows_per_batch};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::rod::{Rest, Side};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
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
    of_one(resolution, (whisker, pole, side), distances_mm, EndDetail::All)
}

/// Computes the ends of the detachment curve of [`curve_at`] alone, without largest strains and snaps.
#[must_use]
pub fn ends_at(
    resolution: Resolution,
    whisker: &Whisker,
    pole: &Pole,
    side: Side,
    distances_mm: &[f64],
) -> Vec<Detachment> {
    of_one(resolution, (whisker, pole, side), distances_mm, EndDetail::State)
}

/// Detachments of one whisker, `[distance]`.
fn of_one(
    resolution: Resolution,
    (whisker, pole, side): (&Whisker, &Pole, Side),
    distances_mm: &[f64],
    detail: EndDetail,
) -> Vec<Detachment> {
    let pushed = PushedWhisker { whisker, pole, side, distances_mm };
    let never = AtomicBool::new(false);
    let ends = detachments(resolution, &[pushed], detail, &never, |_, end, _| end);
    ends.unwrap_or_default().concat()
}

/// Whisker that is pushed against a pole on one side, from first touch at some distances.
#[derive(Clone, Copy, Debug)]
pub struct PushedWhisker<'a> {
    /// Whisker that is pushed.
    pub whisker: &'a Whisker,
    /// Pole in front of the whisker.
    pub pole: &'a Pole,
    /// Side of the whisker that the pole is on.
    pub side: Side,
    /// Distances of first touch in mm, which must increase.
    pub distances_mm: &'a [f64],
}

impl PushedWhisker<'_> {
    /// Returns the request for the sheet of its ends with this `detail`.
    fn request(&self, detail: EndDetail) -> SheetRequest {
        let rod = self.whisker.rod(self.pole, self.side);
        let distances = self.distances_mm.iter();
        SheetRequest {
            serves: match detail {
                EndDetail::State => SheetUse::FirstEnds,
                // The history of a contact that sticks needs states before the end.
                EndDetail::All if rod.friction != 0.0 => SheetUse::Guesses,
                EndDetail::Snaps | EndDetail::All => SheetUse::Ends,
            },
            rod,
            side: self.side,
            distances: distances.map(|d| d / self.whisker.length_mm).collect(),
        }
    }
}

/// Detail with which the end of a push is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum EndDetail {
    /// Detachment without largest strain and snaps: the end of the push and the state there.
    State,
    /// Detachment without largest strain. The push angle up to which the whisker may snap needs other states on the level curve.
    Snaps,
    /// Whole detachment. The largest strain takes a trajectory more, and with friction, the sliding direction follows from the contact's history.
    All,
}

/// Computes the detachments of each of `pushed` with this `detail`, and returns `keep(index, detachment, crossing)` of each: `[pushed][distance]`.
/// The crossing is the end of the push; `None` if the push has no end.
///
/// The ends of all whiskers share batches. Results do not depend on the other whiskers. If `cancel` is true, the function soon returns `None`.
pub(crate) fn detachments<T: Send>(
    resolution: Resolution,
    pushed: &[PushedWhisker],
    detail: EndDetail,
    cancel: &AtomicBool,
    keep: impl Fn(usize, Detachment, Option<Crossing>) -> T + Sync,
) -> Option<Vec<Vec<T>>> {
    let method = Method::new(resolution);
    let requests = pushed.iter().map(|pushed| pushed.request(detail));
    let sheets = Sheet::several(method, requests.collect(), cancel)?;
    let row_ends = RowEnd::of(method, &sheets, detail);
    let of_sheet = |(index, (sheet, row_ends)): (usize, (&Sheet, Vec<Result<RowEnd, _>>))| {
        let PushedWhisker { whisker, side, distances_mm, .. } = pushed[index];
        let units = whisker.units();
        let reader = Reader::new(units, &sheet.rod);
        let slidings = match detail {
            EndDetail::All => slidings(sheet, &row_ends, cancel)?,
            EndDetail::State | EndDetail::Snaps => vec![None; row_ends.len()],
        };
        let detachment = |(row, row_end): (usize, Result<RowEnd, DetachmentKind>)| {
            let place = &sheet.rows[row];
            let none = Detachment {
                side,
                distance_mm: distances_mm[row],
                pole_distance_mm: Some(place.pole_distance * whisker.length_mm),
                ..Detachment::default()
            };
            let row_end = match row_end {
                Ok(row_end) => row_end,
                Err(kind) => return keep(index, Detachment { kind, ..none }, None),
            };
            let (peak, has_snaps) = (row_end.peak, detail >= EndDetail::Snaps);
            // The residual of the crossing estimates the error after its last Newton step; `off` is the miss of this trajectory.
            let off = libm::log(place.pole_distance / row_end.state.full.map.pole.length()).abs();
            let by_state = || Sliding::of(&row_end.state, &sheet.rod, row_end.crossing.tau);
            let end = Detachment {
                kind: row_end.kind(),
                push_angle_deg: Some((side.sign() * row_end.crossing.push).to_degrees()),
                peak_strain: peak.map(|peak| peak.strain * units.strain),
                peak_strain_mm: peak.map(|peak| peak.arclength * whisker.length_mm),
                residual: Some(row_end.crossing.residual + off),
                sliding: slidings[row].or_else(by_state),
                snaps_deg: has_snaps.then(|| snaps_deg(sheet, row)).flatten(),
                ..none.with_state(Some(&row_end.reading(&reader, sheet, row)))
            };
            keep(index, end, Some(row_end.crossing))
        };
        Some(row_ends.into_iter().enumerate().map(detachment).collect())
    };
    let ends = sheets.par_iter().zip(row_ends).enumerate();
    ends.map(of_sheet).collect()
}

/// End of a push from first touch, with its state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowEnd {
    /// Crossing of the row over the edge of the sheet.
    pub crossing: Crossing,
    /// State at the crossing, with its derivatives.
    pub state: FirstVariation,
    /// Largest strain of the state; only with [`EndDetail::All`].
    pub peak: Option<PeakStrain>,
}

impl RowEnd {
    /// Computes the ends of pushes in the rows of `sheets`, `[sheet][row]`, or the reasons why there are none. All ends share a batch by `method`, and
    /// their strains another one with twice the steps.
    pub fn of(
        method: Method,
        sheets: &[Sheet],
        detail: EndDetail,
    ) -> Vec<Vec<Result<Self, DetachmentKind>>> {
        let ends: Vec<Vec<Result<Crossing, _>>> = sheets.iter().map(crossings).collect();
        let pairs = sheets.iter().zip(&ends).flat_map(|(sheet, ends)| {
            let ends = ends.iter().flatten();
            ends.map(move |end| (&sheet.rod, end))
        });
        let conditions = pairs.map(|(rod, end)| InitialCondition::new(rod, (end.tau, end.load)));
        let conditions: Vec<InitialCondition> = conditions.collect();
        let mut states = Batch::new(method).shoot(&conditions).into_iter();
        let peaks: Vec<PeakStrain> = match detail {
            EndDetail::All => Batch::new(method.doubled()).shoot(&conditions),
            EndDetail::State | EndDetail::Snaps => Vec::new(),
        };
        let mut peaks = peaks.into_iter();
        let mut row_end = |end: Result<Crossing, DetachmentKind>| {
            Ok(Self {
                crossing: end?,
                state: states.next().ok_or(DetachmentKind::Unresolved)?,
                peak: peaks.next(),
            })
        };
        let of_sheet = |ends: Vec<_>| ends.into_iter().map(&mut row_end).collect();
        ends.into_iter().map(of_sheet).collect()
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
        let (touch, signed_push) = (sheet.rows[row].touch, sheet.side.sign() * push);
        reader.read(tau, &self.state.full, touch, signed_push)
    }
}

/// Returns the crossing of each row of `sheet` at which a push from first touch ends, `[row]`, or the reason why there is none.
pub(crate) fn crossings(sheet: &Sheet) -> Vec<Result<Crossing, DetachmentKind>> {
    let of_row = |row: usize| {
        if !sheet.touches(row) {
            return Err(DetachmentKind::OutOfReach);
        }
        let boundary = RowBoundary::new(true, &sheet.crossings[row]);
        let end = boundary.detachment().map(|span| span.end);
        end.ok_or(DetachmentKind::Unresolved)
    };
    (0..sheet.rows.len()).map(of_row).collect()
}

/// Returns the signed push angle, in degrees, up to which the whisker in `row` of `sheet` may snap to other stable states: the end of
/// [`RowBoundary::snap`].
pub(crate) fn snaps_deg(sheet: &Sheet, row: usize) -> Option<f64> {
    let boundary = RowBoundary::new(sheet.touches(row), &sheet.crossings[row]);
    let span = boundary.snap()?;
    Some((sheet.side.sign() * span.to()).to_degrees())
}

/// Returns the sliding direction of the contact at the detachment of each row of `sheet` by its history, `[row]`; `None` without friction or
/// an end, and where the history is not found. If `cancel` is true, the function soon returns `None`.
fn slidings(
    sheet: &Sheet,
    ends: &[Result<RowEnd, DetachmentKind>],
    cancel: &AtomicBool,
) -> Option<Vec<Option<Sliding>>> {
    let mut slidings = vec![None; sheet.rows.len()];
    if sheet.rod.friction == 0.0 {
        return Some(slidings);
    }
    let rows = ends.iter().enumerate().filter_map(|(row, end)| {
        let RowEnd { crossing, state, .. } = *end.as_ref().ok()?;
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
    let of_batch = |rows: &[(usize, f64)]| {
        if cancel.load(Ordering::Relaxed) {
            return None;
        }
        let levels: Vec<LevelCurve> = rows.iter().map(|(row, _)| sheet.level(*row)).collect();
        let histories = rows.iter().zip(ContactHistory::of(&levels));
        let known = histories.map(|((row, push), history)| {
            (*row, history.and_then(|history| history.sliding_at_end(*push)))
        });
        Some(known.collect::<Vec<_>>())
    };
    let batches = doubtful.par_chunks(rows_per_batch(doubtful.len()));
    let known: Vec<_> = batches.map(of_batch).collect::<Option<_>>()?;
    for (row, sliding) in known.into_iter().flatten() {
        slidings[row] = sliding;
    }
    Some(slidings)
}
