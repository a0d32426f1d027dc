//! Drafts of sheets: samples, crossings of rows, and continuation of the rows for which the samples do not suffice.

use super::case::SheetCase;
use super::continuation::level_curve::LevelCurve;
use super::continuation::pieces::{ContinuedRow, stable_pieces};
use super::edges::crossings::crossings;
use super::net::{FOLD_ERRORS, GUESS_ERRORS, KNOWN_ROW_ERRORS};
use super::row::{Crossing, Row};
use super::samples::SheetSamples;
use super::span::RowSpan;
use super::{Sheet, rows_per_batch};
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use whiskmap_mechanics::rod::{Rest, Rod, Side};
use whiskmap_mechanics::shooting::batch::Method;

/// What the rows of a sheet are for: how accurate its net is, and which pieces of rows are followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SheetUse {
    /// Guesses for all push angles.
    Guesses,
    /// [Known rows](Sheet::known_residuals): guesses are less accurate.
    KnownRows,
    /// Crossings alone: rows may have no guesses.
    Ends,
    /// Ends of pushes from first touch alone: rows may have no other crossings, and no guesses.
    FirstEnds,
}

impl SheetUse {
    /// Returns the errors of the panels to try, one after the other, until the panels show all folds.
    const fn errors(self) -> &'static [f64] {
        match self {
            Self::Guesses => &GUESS_ERRORS,
            Self::KnownRows => &KNOWN_ROW_ERRORS,
            Self::Ends | Self::FirstEnds => &FOLD_ERRORS,
        }
    }
}

/// Whisker side of which a sheet is computed.
#[derive(Clone, Debug)]
pub struct SheetRequest {
    /// Whisker and pole, in dimensionless form.
    pub rod: Rod,
    /// Whisker side.
    pub side: Side,
    /// Distances of the rows at first touch, in whisker lengths: `[row]`.
    pub distances: Vec<f64>,
    /// What the rows are for.
    pub serves: SheetUse,
}

/// Sheet with rows that are still to be followed, as its samples are not certified there.
pub(super) struct SheetDraft {
    pub sheet: Sheet,
    serves: SheetUse,
    /// Indices of the rows to follow.
    open_rows: Vec<usize>,
    /// True if there are samples, certified or not.
    has_samples: bool,
}

impl SheetDraft {
    /// Samples the sheet, and finds where its rows cross the edges.
    pub fn new(method: Method, request: SheetRequest) -> Self {
        let SheetRequest { rod, side, distances, serves } = request;
        let rest = Rest::new(&rod);
        let rows: Vec<Row> = distances.iter().map(|d| Row::new(&rest, *d)).collect();
        let nearest = rows.iter().min_by(|a, b| a.pole_distance.total_cmp(&b.pole_distance));
        let case = SheetCase { method, rod: &rod, side };
        let sample = |nearest| SheetSamples::new(case, nearest, &rows, serves.errors());
        let samples = nearest.and_then(sample);
        let is_certified = samples.as_ref().is_some_and(|samples| samples.panels.is_some());
        let crossings = match &samples {
            Some(samples) => crossings(case, &samples.edges, &rows),
            None => vec![Vec::new(); rows.len()],
        };
        let fold_grows = samples.as_ref().is_some_and(|samples| samples.edges.fold_grows);
        let is_open = |(row, crossings): (&Row, &[Crossing])| {
            let touches = row.is_reached();
            let is_pair = usize::from(touches) + crossings.len() == 2;
            let is_simple = crossings.is_empty() && !touches
                || fold_grows && is_pair && crossings.iter().all(Crossing::is_sound);
            // Where the tip moves away from the pole under a load, the level curve is this point alone, which no continuation can follow.
            let is_point = row.is_at_reach() && matches!(crossings, [end] if end.is_at_touch());
            let is_inside = row.pole_distance <= rod.pole.abs();
            !(is_certified && is_simple || is_point) || is_inside
        };
        let open = (0..rows.len()).filter(|&row| is_open((&rows[row], &crossings[row])));
        let tip = rod.tau_tip();
        Self {
            open_rows: open.collect(),
            serves,
            has_samples: samples.is_some(),
            sheet: Sheet {
                side,
                tip: [tip, rod.radius(tip)],
                continued: vec![Vec::new(); rows.len()],
                rows,
                crossings,
                method,
                samples: samples.filter(|_| is_certified).map(Arc::new),
                net: None,
                rod,
            },
        }
    }
}

/// Follows the open rows of all `drafts` by continuation, and sets their crossings and spans. If `cancel` is true, the function soon returns `None`, and
/// the drafts have open rows.
pub fn follow(drafts: &mut [SheetDraft], cancel: &AtomicBool) -> Option<()> {
    let rows = drafts.iter().enumerate().flat_map(|(index, draft)| {
        let rows = draft.open_rows.iter();
        rows.map(move |row| (index, *row))
    });
    let rows: Vec<(usize, usize)> = rows.collect();
    let of_batch = |rows: &[(usize, usize)]| {
        let rows = rows.iter().map(|(index, row)| (&drafts[*index], *row));
        let levels = rows.clone().map(|(draft, row)| draft.sheet.level(row));
        let levels: Vec<LevelCurve> = levels.collect();
        let continued = rows.clone().zip(&levels).map(|((draft, row), level)| {
            let SheetDraft { sheet, serves, .. } = draft;
            ContinuedRow {
                level,
                touches: sheet.touches(row),
                crossings: &sheet.crossings[row],
                is_first_alone: *serves == SheetUse::FirstEnds,
            }
        });
        let found = stable_pieces(&continued.collect::<Vec<_>>(), cancel)?;
        let ends = rows.zip(found).map(|((draft, row), found)| {
            let is_incomplete = !found.are_complete && !found.pieces.is_empty();
            let has_unknown = is_incomplete || !draft.has_samples && !draft.sheet.touches(row);
            let crossings = found.ends().chain(has_unknown.then(Crossing::unknown));
            let pieces = found.pieces.iter();
            let spans = pieces.filter_map(|piece| piece.span(draft.sheet.side));
            (crossings.collect(), spans.collect())
        });
        Some(ends.collect::<Vec<(Vec<Crossing>, Vec<RowSpan>)>>())
    };
    let batches = rows.par_chunks(rows_per_batch(rows.len()));
    let found: Vec<_> = batches.map(of_batch).collect::<Option<_>>()?;
    for ((index, row), (crossings, spans)) in rows.into_iter().zip(found.into_iter().flatten()) {
        let sheet = &mut drafts[index].sheet;
        sheet.crossings[row] = crossings;
        sheet.continued[row] = spans;
    }
    Some(())
}
