//! States of a course on one side of its obstacles, in batches.

use super::WhiskEventKind;
use super::phase::ContactEnd;
use crate::classify::TIE;
use crate::friction::{ContactPhase, ContactQuery, CourseLimits, FrictionState, Sliding};
use crate::refine::{CellTarget, refine};
use crate::scene::{Pole, Whisker};
use crate::sheet::{Crossing, Edge, Path, Sheet, Stretch};
use crate::trace::{EndDetail, RowEnd, snaps_deg};
use glam::DVec2;
use std::collections::BTreeMap;
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::batch::Method;
use whiskmap_mechanics::shooting::shape::profile;
use whiskmap_mechanics::shooting::{FullState, Reader, Reading, Resolution};

/// Contact of the whisker at one time: side, pole, push and, with friction, the phase of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PushedContact {
    /// Side of the whisker that the pole is on.
    pub side: Side,
    /// Row of the pole in the states of the side; 0 for a single pole.
    pub row: usize,
    /// Push since the touch, in radians, as a magnitude.
    pub push: f64,
    /// Phase of the contact; `None` without friction.
    pub phase: Option<ContactPhase>,
}

/// Stable states on one side of poles at several distances, from first touch to the end of the push.
pub struct SideStates {
    length_mm: f64,
    sheet: Sheet,
    reader: Reader,
    ends: Vec<RowEnd>,
    /// Limits of sliding, `[row]`; empty without friction.
    limits: Vec<CourseLimits>,
}

/// State of a contact: its values in physical units, and what its shape follows from.
#[derive(Clone, Copy, Debug)]
pub struct CourseState {
    pub reading: Reading,
    /// Sliding direction of the contact; `None` without friction.
    pub sliding: Option<Sliding>,
    /// Contact and load, `(tau, load)`.
    point: DVec2,
    /// Force ratio: tangential over normal force, with the sign of the side; 0 without friction.
    ratio: f64,
}

impl CourseState {
    /// Creates a state without friction, or without a load.
    fn smooth(reading: Reading, point: DVec2) -> Self {
        Self { reading, sliding: None, point, ratio: 0.0 }
    }
}

/// Solver for states with friction, one for each query: [`states`](crate::friction::states) or [`held`](crate::friction::held). `None` where no state
/// is found.
pub type SolveContacts = fn(&[ContactQuery]) -> Vec<Option<FrictionState>>;

impl SideStates {
    /// Computes the sheet and the ends of the pushes on `side` for first touches at `distances_mm`, which must increase; with friction, also
    /// the limits of sliding. The error is the index of a distance without an end, or where the contact sticks at the end.
    pub fn new(
        whisker: &Whisker,
        pole: &Pole,
        side: Side,
        distances_mm: &[f64],
    ) -> Result<Self, usize> {
        let rod = whisker.rod(pole, side);
        let method = Method::new(Resolution::FINE);
        let distances: Vec<f64> = distances_mm.iter().map(|d| d / whisker.length_mm).collect();
        let sheet = Sheet::new(method, &rod, side, &distances);
        let solved = RowEnd::of(method, std::slice::from_ref(&sheet), EndDetail::State);
        let solved = solved.into_iter().flatten().enumerate();
        let found = solved.map(|(row, end)| end.map_err(|_| row));
        let ends: Vec<RowEnd> = found.collect::<Result<_, _>>()?;
        let limits_of = |(row, end): (usize, &RowEnd)| {
            let limits = CourseLimits::new(&sheet.level(row));
            let detaching = limits.filter(|limits| limits.detaches_at(end.crossing.push));
            detaching.ok_or(row)
        };
        let limits: Vec<CourseLimits> = match rod.friction {
            0.0 => Vec::new(),
            _ => ends.iter().enumerate().map(limits_of).collect::<Result<_, _>>()?,
        };
        Ok(Self {
            ends,
            limits,
            reader: Reader::new(whisker.units(), &rod),
            length_mm: whisker.length_mm,
            sheet,
        })
    }

    /// Returns the end of a push against the pole of `row`.
    pub fn end(&self, row: usize) -> ContactEnd {
        let Crossing { push, edge, .. } = self.ends[row].crossing;
        let kind = match edge {
            Edge::Fold => WhiskEventKind::SlipOff,
            Edge::Tip => WhiskEventKind::PullOff,
        };
        ContactEnd { push, kind }
    }

    /// Returns the push angle, in degrees, up to which the first row has other stable states at its detachment.
    pub fn snaps_deg(&self) -> Option<f64> {
        snaps_deg(&self.sheet, 0)
    }

    /// Returns the limits of sliding in `row`; `None` without friction.
    pub fn limits(&self, row: usize) -> Option<&CourseLimits> {
        self.limits.get(row)
    }

    /// Returns the curvature of the whisker in `state` at the arclength `at_mm`, in 1/mm.
    pub fn curvature_per_mm(&self, state: &CourseState, at_mm: f64) -> f64 {
        let length = self.length_mm;
        let rod = self.sheet.rod.with_friction(state.ratio);
        let (tau, load) = state.point.into();
        let points = profile(&rod, tau, load, Resolution::FINE, &[at_mm / length]);
        points.first().map_or(f64::NAN, |point| point.curvature / length)
    }

    /// Returns the states of `contacts`, `[contact]`; `None` where no state is found. States with friction are solved by `solve`.
    fn at(&self, contacts: &[PushedContact], solve: SolveContacts) -> Vec<Option<CourseState>> {
        if self.limits.is_empty() {
            return self.without_friction(contacts);
        }
        // A contact that sticks when the push is back at 0 is not at first touch: the whisker is still bent.
        let is_inside = |contact: &PushedContact| {
            let is_stuck = matches!(contact.phase, Some(ContactPhase::Sticks(_)));
            (contact.push > 0.0 || is_stuck && contact.push == 0.0)
                && contact.push < self.end(contact.row).push
        };
        let inside = contacts.iter().filter(|contact| is_inside(contact));
        let query = |contact: &PushedContact| {
            Some(self.limits[contact.row].query(contact.phase?, contact.push))
        };
        let queries = inside.filter_map(query);
        let mut solved = solve(&queries.collect::<Vec<_>>()).into_iter();
        let states = contacts.iter().map(|contact| {
            if is_inside(contact) {
                let state = contact.phase.and_then(|_| solved.next()?)?;
                let reader = self.reader.with_contact(&state.rod(&self.sheet.rod));
                let touch = self.sheet.rows[contact.row].touch;
                let signed_push = self.sheet.side.sign() * contact.push;
                return Some(CourseState {
                    reading: reader.read(
                        state.at.point.x,
                        &state.variation.full,
                        touch,
                        signed_push,
                    ),
                    sliding: Some(state.sliding),
                    point: state.at.point,
                    ratio: state.at.ratio,
                });
            }
            let state = match contact.push > 0.0 {
                true => self.at_end(contact.row),
                false => self.at_touch(contact.row),
            };
            let sliding = contact.phase.map(|phase| phase.sliding());
            Some(CourseState { sliding, ..state })
        });
        states.collect()
    }

    /// Returns the state at the end of the push of `row`, where the contact slides.
    fn at_end(&self, row: usize) -> CourseState {
        let end = &self.ends[row];
        let reading = end.reading(&self.reader, &self.sheet, row);
        let point = DVec2::new(end.crossing.tau, end.crossing.load);
        CourseState { ratio: self.sheet.rod.friction, ..CourseState::smooth(reading, point) }
    }

    fn at_touch(&self, row: usize) -> CourseState {
        let row = &self.sheet.rows[row];
        let point = row.first_touch(&self.sheet.rod);
        CourseState::smooth(row.read_first_touch(&self.reader), point)
    }

    /// Returns the states without friction at `contacts`, `[contact]`; `None` where no state is found.
    fn without_friction(&self, contacts: &[PushedContact]) -> Vec<Option<CourseState>> {
        let sign = self.sheet.side.sign();
        let mut order: Vec<usize> = (0..contacts.len()).collect();
        let (row, push) = (|i: &usize| contacts[*i].row, |i: &usize| contacts[*i].push);
        order.sort_by(|a, b| row(a).cmp(&row(b)).then(push(a).total_cmp(&push(b))));
        let (mut places, mut targets) = (Vec::new(), Vec::new());
        for same in order.chunk_by(|a, b| row(a) == row(b)) {
            let row = row(&same[0]);
            let pushes: Vec<f64> = same.iter().map(push).collect();
            let guesses = self.sheet.guesses(row, &pushes);
            for (i, guess) in same.iter().zip(guesses) {
                let Some(guess) = guess else { continue };
                places.push(*i);
                targets.push(CellTarget {
                    rod: 0,
                    guess,
                    pole: self.sheet.rows[row].pole(sign * push(i)),
                });
            }
        }
        let mut states = vec![None; contacts.len()];
        let found = refine(Method::new(Resolution::FINE), &[&self.sheet], &targets);
        for (i, cell) in places.into_iter().zip(found) {
            if cell.outcome.is_solved() {
                let state = &cell.state;
                states[i] = Some(self.smooth(row(&i), push(&i), state.point, &state.full));
            }
        }
        self.fill(contacts, &mut states);
        states
    }

    /// Fills the states that Newton's method has not found: at touch, at the end, and by continuation along the row.
    fn fill(&self, contacts: &[PushedContact], states: &mut [Option<CourseState>]) {
        let mut paths: BTreeMap<usize, Option<Path>> = BTreeMap::new();
        for (state, &PushedContact { row, push, .. }) in states.iter_mut().zip(contacts) {
            if push <= 0.0 {
                *state = Some(self.at_touch(row));
            } else if push >= self.end(row).push {
                *state = Some(self.at_end(row));
            } else if state.is_none() {
                let path = paths.entry(row).or_insert_with(|| {
                    let level = self.sheet.level(row);
                    level.continuation(level.touch(), Stretch::Stable)
                });
                let signed_push = self.sheet.side.sign() * push;
                let node = path
                    .as_ref()
                    .and_then(|path| path.level.state_at_push(path.stable(), signed_push));
                let followed = node.map(|node| self.smooth(row, push, node.point, &node.full));
                // The ends of the path and of the push are computed apart.
                let is_end = push >= self.end(row).push - TIE;
                *state = followed.or_else(|| is_end.then(|| self.at_end(row)));
            }
        }
    }

    /// Returns the state without friction at `push` in `row`, a magnitude in radians, from its `(tau, load)` and its `full` state.
    fn smooth(&self, row: usize, push: f64, point: DVec2, full: &FullState) -> CourseState {
        let (touch, signed_push) = (self.sheet.rows[row].touch, self.sheet.side.sign() * push);
        CourseState::smooth(self.reader.read(point.x, full, touch, signed_push), point)
    }
}

/// States of both whisker sides; `None` for a side that the resting whisker does not reach.
pub struct BothSides {
    pub cb: Option<SideStates>,
    pub cf: Option<SideStates>,
}

impl BothSides {
    pub const fn of(&self, side: Side) -> Option<&SideStates> {
        match side {
            Side::Cb => self.cb.as_ref(),
            Side::Cf => self.cf.as_ref(),
        }
    }

    /// Returns the state of each of the `contacts`, `[contact]`; `None` where there is none. States with friction are solved by `solve`.
    pub fn at(
        &self,
        contacts: &[Option<PushedContact>],
        solve: SolveContacts,
    ) -> Vec<Option<CourseState>> {
        let mut found = vec![None; contacts.len()];
        for side in Side::BOTH {
            let indexed = contacts.iter().enumerate();
            let on_side = indexed.filter_map(|(i, contact)| {
                Some((i, contact.filter(|contact| contact.side == side)?))
            });
            let (places, contacts): (Vec<usize>, Vec<PushedContact>) = on_side.unzip();
            let states = self.of(side).map(|states| states.at(&contacts, solve));
            for (i, state) in places.into_iter().zip(states.into_iter().flatten()) {
                found[i] = state;
            }
        }
        found
    }
}
