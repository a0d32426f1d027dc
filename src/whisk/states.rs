//! States of a course on one side, in batches.

use crate::classify::RowBoundary;
use crate::refine::{CellTarget, RefineOutcome, refine};
use crate::rod::Side;
use crate::scene::{Pole, Whisker};
use crate::sheet::Sheet;
use crate::sheet::{Crossing, Edge};
use crate::shooting::batch::{Batch, Method};
use crate::shooting::{FirstVariation, Reader, Reading, Resolution};
use crate::trace::{Branch, DetachmentKind};

/// Stable states of one side, from first touch to the end of the push.
pub struct SideStates {
    whisker: Whisker,
    pole: Pole,
    distance_mm: f64,
    sheet: Sheet,
    reader: Reader,
    end: Crossing,
    /// State at the end of the push.
    pub at_end: Reading,
}

impl SideStates {
    /// Computes the sheet and the end of the push on `side` for a first touch at `distance_mm`; `None` if the end is not found.
    pub fn new(whisker: &Whisker, pole: &Pole, side: Side, distance_mm: f64) -> Option<Self> {
        let rod = whisker.rod(pole, side);
        let method = Method::new(Resolution::FINE);
        let sheet = Sheet::new(method, &rod, side, &[distance_mm / whisker.length_mm]);
        let boundary = RowBoundary::new(true, &sheet.crossings[0]);
        let end = *boundary.detachment().and(sheet.crossings[0].first())?;
        let reader = Reader::new(whisker.units(), &rod);
        let at_end: Vec<FirstVariation> = Batch::new(method).shoot_at(&rod, [(end.tau, end.load)]);
        let at_end = at_end.first()?;
        let push = side.sign() * end.push;
        Some(Self {
            at_end: reader.read(end.tau, &at_end.full, sheet.rows[0].touch, push),
            whisker: whisker.clone(),
            pole: *pole,
            distance_mm,
            sheet,
            reader,
            end,
        })
    }

    /// Returns the push at which the whisker detaches, in radians, as a magnitude.
    pub fn end(&self) -> f64 {
        self.end.push
    }

    /// Returns the kind of the detachment.
    pub fn kind(&self) -> DetachmentKind {
        match self.end.edge {
            Edge::Fold => DetachmentKind::SlipOff,
            Edge::Tip => DetachmentKind::PullOff,
        }
    }

    /// Returns the states at `pushes`, magnitudes in radians, `[push]`; `None` where no state is found.
    pub fn at(&self, pushes: &[f64]) -> Vec<Option<Reading>> {
        let row = &self.sheet.rows[0];
        let sign = self.sheet.side.sign();
        let mut order: Vec<usize> = (0..pushes.len()).collect();
        order.sort_by(|a, b| pushes[*a].total_cmp(&pushes[*b]));
        let growing: Vec<f64> = order.iter().map(|i| pushes[*i]).collect();
        let guesses = self.sheet.guesses(0, growing.iter().copied());
        let guessed = order.iter().zip(guesses);
        let guessed = guessed.filter_map(|(i, guess)| Some((*i, guess?)));
        let (places, targets): (Vec<usize>, Vec<CellTarget>) = guessed
            .map(|(i, guess)| {
                let target = CellTarget {
                    rod: 0,
                    tau: guess.tau,
                    load: guess.load,
                    pole: row.pole(sign * pushes[i]),
                };
                (i, target)
            })
            .unzip();
        let mut states = vec![None; pushes.len()];
        let found = refine(Method::new(Resolution::FINE), &[&self.sheet], &targets);
        for (i, cell) in places.into_iter().zip(found) {
            if cell.outcome == RefineOutcome::Solved {
                let state = cell.state;
                let push = sign * pushes[i];
                states[i] = Some(self.reader.read(state.tau, &state.full, row.touch, push));
            }
        }
        self.fill(pushes, &mut states);
        states
    }

    /// Fills the states that Newton's method has not found: at touch, at the end, and by continuation.
    fn fill(&self, pushes: &[f64], states: &mut [Option<Reading>]) {
        let row = &self.sheet.rows[0];
        let side = self.sheet.side;
        let mut branch: Option<Option<Branch>> = None;
        for (state, push) in states.iter_mut().zip(pushes) {
            if *push <= 0.0 {
                *state = Some(
                    self.reader
                        .at_first_touch(row.contact.min(row.end), row.touch),
                );
            } else if *push >= self.end.push {
                *state = Some(self.at_end);
            } else if state.is_none() {
                let branch = branch.get_or_insert_with(|| {
                    Branch::new(&self.whisker, &self.pole, side, self.distance_mm).ok()
                });
                let found = branch.as_ref().and_then(|branch| {
                    let state = branch.state(side.sign() * push, true).ok()?;
                    Some(branch.read(&state))
                });
                *state = found;
            }
        }
    }
}
