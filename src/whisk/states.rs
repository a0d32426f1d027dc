//! States of a course on one side, in batches.

use super::friction::CourseContact;
use crate::classify::RowBoundary;
use crate::friction::{ContactQuery, CourseLimits, FrictionState, Sliding};
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
    /// Limits of sliding; `None` without friction.
    pub limits: Option<CourseLimits>,
}

/// Solver for states with friction: [`states`](crate::friction::states) or [`held`](crate::friction::held).
pub type SolveContacts = fn(&[ContactQuery]) -> Vec<Option<FrictionState>>;

impl SideStates {
    /// Computes the sheet and the end of the push on `side` for a first touch at `distance_mm`; `None` if the end is not found.
    /// With friction, it computes the limits of sliding; `None` if they are not found, or if the contact sticks at the end.
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
        let limits = match rod.friction {
            0.0 => None,
            _ => {
                let limits = CourseLimits::new(&sheet.level(0))?;
                Some(limits.detaches_at(end.push).then_some(limits)?)
            }
        };
        Some(Self {
            limits,
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

    /// Returns the energy of a dimensionless energy of 1, in nJ.
    pub fn energy_nj(&self) -> f64 {
        self.whisker.units().moment_nnm
    }

    /// Returns the states of `contacts` on this side, with their sliding directions if there is friction, `[contact]`; `None` where no state
    /// is found. States with friction are solved by `solve`.
    pub fn at(
        &self,
        contacts: &[CourseContact],
        solve: SolveContacts,
    ) -> Vec<Option<(Reading, Option<Sliding>)>> {
        let Some(limits) = &self.limits else {
            let pushes: Vec<f64> = contacts.iter().map(|contact| contact.push).collect();
            let states = self.without_friction(&pushes).into_iter();
            return states.map(|state| Some((state?, None))).collect();
        };
        let inside = contacts.iter().filter(|own| self.is_inside(own.push));
        let queries = inside.filter_map(|own| Some(limits.query(own.phase?, own.push)));
        let mut solved = solve(&queries.collect::<Vec<_>>()).into_iter();
        let row = &self.sheet.rows[0];
        let states = contacts.iter().map(|own| {
            if self.is_inside(own.push) {
                let state = own.phase.and_then(|_| solved.next()?)?;
                let reader = self.reader.with_contact(&state.rod(&self.sheet.rod));
                let push = self.sheet.side.sign() * own.push;
                let reading = reader.read(state.at.point.x, &state.full, row.touch, push);
                return Some((reading, Some(state.sliding)));
            }
            let reading = match own.push > 0.0 {
                true => self.at_end,
                false => self.at_touch(),
            };
            Some((reading, own.phase.map(|phase| phase.sliding())))
        });
        states.collect()
    }

    /// Returns true if `push`, a magnitude in radians, lies between first touch and the end.
    fn is_inside(&self, push: f64) -> bool {
        push > 0.0 && push < self.end.push
    }

    fn at_touch(&self) -> Reading {
        let row = &self.sheet.rows[0];
        let contact = row.contact.min(row.end);
        self.reader.at_first_touch(contact, row.touch)
    }

    /// Returns the states without friction at `pushes`, magnitudes in radians, `[push]`; `None` where no state is found.
    fn without_friction(&self, pushes: &[f64]) -> Vec<Option<Reading>> {
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
        let side = self.sheet.side;
        let mut branch: Option<Option<Branch>> = None;
        for (state, push) in states.iter_mut().zip(pushes) {
            if *push <= 0.0 {
                *state = Some(self.at_touch());
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
