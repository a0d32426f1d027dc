//! Detachment curves: the ends of pushes from first touch, for each distance.

use super::columns::{StateRow, row};
use crate::classify::{RowBoundary, TIE};
use crate::friction::{ContactHistory, Sliding, surely_slides_to_end};
use crate::scene::{Pole, Whisker};
use crate::sheet::{Crossing, Edge, Sheet, SheetRequest, SheetUse};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use whiskmap_mechanics::rod::{Rest, Side};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method, OutputSet};
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
    of_one(
        resolution,
        (whisker, pole, side),
        distances_mm,
        EndDetail::All,
    )
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
    of_one(
        resolution,
        (whisker, pole, side),
        distances_mm,
        EndDetail::State,
    )
}

/// Detachments of one whisker, `[distance]`.
fn of_one(
    resolution: Resolution,
    (whisker, pole, side): (&Whisker, &Pole, Side),
    distances_mm: &[f64],
    detail: EndDetail,
) -> Vec<Detachment> {
    let pushed = PushedWhisker {
        whisker,
        pole,
        side,
        distances_mm,
    };
    detachments(resolution, &[pushed], detail, |_, end, _| end).concat()
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
/// The detachment is read from the crossing of the sheet's edge; `None` without an end.
///
/// The ends of all whiskers share batches. Results do not depend on the other whiskers.
pub(crate) fn detachments<T: Send>(
    resolution: Resolution,
    pushed: &[PushedWhisker],
    detail: EndDetail,
    keep: impl Fn(usize, Detachment, Option<Crossing>) -> T + Sync,
) -> Vec<Vec<T>> {
    let method = Method::new(resolution);
    let requests = pushed.iter().map(|pushed| pushed.request(detail));
    let sheets = Sheet::several(method, requests.collect());
    let row_ends = RowEnd::of(method, &sheets);
    let (has_strain, has_snaps) = (detail == EndDetail::All, detail >= EndDetail::Snaps);
    let peaks: Vec<Vec<Option<PeakStrain>>> = match has_strain {
        true => {
            let crossing = |end: &Result<RowEnd, _>| end.as_ref().ok().map(|end| end.crossing);
            let of_sheet = |ends: &Vec<_>| ends.iter().map(crossing).collect();
            let crossings: Vec<Vec<_>> = row_ends.iter().map(of_sheet).collect();
            shoot_ends(method.doubled(), &sheets, &crossings)
        }
        false => row_ends.iter().map(|ends| vec![None; ends.len()]).collect(),
    };
    let kept = |(index, (row_ends, peaks)): (usize, (Vec<Result<RowEnd, _>>, Vec<_>))| {
        let PushedWhisker {
            whisker,
            side,
            distances_mm,
            ..
        } = pushed[index];
        let sheet = &sheets[index];
        let units = whisker.units();
        let reader = Reader::new(units, &sheet.rod);
        let slidings = match has_strain {
            true => slidings(sheet, &row_ends),
            false => vec![None; row_ends.len()],
        };
        let detachment = |row: usize,
                          row_end: Result<RowEnd, DetachmentKind>,
                          peak: Option<PeakStrain>| {
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
        let ends = row_ends.into_iter().zip(peaks).enumerate();
        ends.map(|(row, (end, peak))| detachment(row, end, peak))
            .collect()
    };
    let ends: Vec<_> = row_ends.into_iter().zip(peaks).collect();
    ends.into_par_iter().enumerate().map(kept).collect()
}

/// Integrates the trajectories from the `ends` of pushes in the rows of `sheets` in one batch, `[sheet][row]`; `None` without an end.
fn shoot_ends<O: OutputSet>(
    method: Method,
    sheets: &[Sheet],
    ends: &[Vec<Option<Crossing>>],
) -> Vec<Vec<Option<O>>> {
    let pairs = sheets.iter().zip(ends).flat_map(|(sheet, ends)| {
        let ends = ends.iter().flatten();
        ends.map(move |end| (&sheet.rod, end))
    });
    let conditions = pairs.map(|(rod, end)| InitialCondition {
        rod,
        tau: end.tau,
        load: end.load,
    });
    let conditions: Vec<InitialCondition> = conditions.collect();
    let mut outputs = Batch::new(method).shoot(&conditions).into_iter();
    let of_sheet = |ends: &Vec<Option<Crossing>>| {
        let output = |end: &Option<Crossing>| end.and_then(|_| outputs.next());
        ends.iter().map(output).collect()
    };
    ends.iter().map(of_sheet).collect()
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
    /// Computes the ends of pushes in the rows of `sheets` with the integration `method`, `[sheet][row]`, or the reasons why there are none.
    pub fn of(method: Method, sheets: &[Sheet]) -> Vec<Vec<Result<Self, DetachmentKind>>> {
        let crossings: Vec<Vec<Result<Crossing, _>>> = sheets.iter().map(crossings).collect();
        let known = |end: &Result<Crossing, _>| end.ok();
        let of_sheet = |ends: &Vec<_>| ends.iter().map(known).collect();
        let ends: Vec<Vec<Option<Crossing>>> = crossings.iter().map(of_sheet).collect();
        let states = shoot_ends(method, sheets, &ends);
        let end = |(crossing, state): (Result<Crossing, _>, Option<FirstVariation>)| {
            let crossing = crossing?;
            let state = state.ok_or(DetachmentKind::Unresolved)?;
            Ok(Self { crossing, state })
        };
        let pairs = crossings.into_iter().zip(states);
        pairs
            .map(|(crossings, states)| crossings.into_iter().zip(states).map(end).collect())
            .collect()
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
pub(crate) fn crossings(sheet: &Sheet) -> Vec<Result<Crossing, DetachmentKind>> {
    let of_row = |row: usize| {
        if !sheet.touches(row) {
            return Err(DetachmentKind::OutOfReach);
        }
        let boundary = RowBoundary::new(true, &sheet.crossings[row]);
        let detachment = boundary.detachment().ok_or(DetachmentKind::Unresolved);
        detachment.map(|span| span.end)
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
