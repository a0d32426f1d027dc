//! The answer for one cell, in the units of the map.

use super::cells::{Cell, State};
use super::channels::{Numbers, channels, of_cell, of_reference};
use super::{STATE_CHANNELS, WhiskerSide};
use crate::classify::{Regime, RowBoundary, Status};
use crate::engine::BasePoint;
use crate::sheet::Sheet;
use crate::shooting::Reader;
use glam::DVec2;

/// What turns the states of a row into numbers of the map.
pub struct Readings<'a> {
    reader: Reader,
    /// What a difference of one is.
    of_one: Numbers,
    touch: f64,
    /// The reference that was read last.
    reference: Option<(&'a BasePoint, Numbers)>,
}

impl<'a> Readings<'a> {
    /// On `row` of `face`.
    pub fn new(reader: Reader, face: &WhiskerSide, row: usize) -> Self {
        Self {
            of_one: channels(&reader.of_one(face.sheet.side.sign())),
            touch: face.sheet.rows[row].touch,
            reader,
            reference: None,
        }
    }

    /// The channels of a cell in contact.
    fn read(&mut self, cell: &Cell<'a>) -> Option<Numbers> {
        match cell.state {
            State::Unknown => None,
            State::FirstTouch(row) => {
                let contact = row.contact.min(row.end);
                let reading = self.reader.at_first_touch(contact, row.touch);
                Some(channels(&reading))
            }
            State::Refined(state) => {
                let reading = self
                    .reader
                    .read(state.tau, &state.full, self.touch, cell.push.angle);
                Some(channels(&reading))
            }
            State::Different(reference, difference) => {
                let [known, of_one] = self.of_reference(reference);
                Some(of_cell(&known, &of_one, difference))
            }
        }
    }

    /// The channels of `reference`, and what a difference of one is there.
    pub fn of_reference(&mut self, reference: &'a BasePoint) -> [Numbers; 2] {
        let known = self
            .reference
            .filter(|(known, _)| std::ptr::eq(*known, reference));
        let (_, numbers) =
            known.unwrap_or_else(|| (reference, of_reference(&self.reader, reference, self.touch)));
        self.reference = Some((reference, numbers));
        [numbers, self.of_one]
    }
}

/// What a panel holds of one cell, and where on the sheet its state is.
pub struct Answer {
    pub regime: Regime,
    pub status: Status,
    /// `(tau, load)`.
    pub point: Option<DVec2>,
    /// One number for each of [`STATE_CHANNELS`].
    pub state: Numbers,
    pub residual: f32,
    pub margin_deg: f32,
    pub steps: u32,
}

impl Answer {
    /// Without a state.
    pub const fn new(regime: Regime, status: Status, steps: u32) -> Self {
        Self {
            regime,
            status,
            point: None,
            state: [f64::NAN; STATE_CHANNELS.len()],
            residual: f32::NAN,
            margin_deg: f32::NAN,
            steps,
        }
    }
}

/// The answer for `cell` on `sheet`, with its state if there are `readings`.
pub fn answer<'a>(
    cell: &Cell<'a>,
    sheet: &Sheet,
    boundary: &RowBoundary,
    readings: Option<&mut Readings<'a>>,
) -> Answer {
    let push = cell.push.angle;
    let span = boundary.span(push.abs());
    // At the tip both verdicts are right; the boundary's is taken.
    let status = match cell.state {
        State::Refined(state)
            if cell.status == Status::Solved && span.is_none() && state.is_at_tip(sheet) =>
        {
            Status::BeyondTip
        }
        _ => cell.status,
    };
    let (regime, status) = boundary.judge(push.abs(), status);
    let mut answer = Answer::new(regime, status, cell.steps);
    let residual = match cell.state {
        State::Unknown => return answer,
        State::FirstTouch(row) => {
            answer.point = Some(row.first_touch(&sheet.rod));
            0.0
        }
        State::Refined(state) => {
            answer.point = Some(DVec2::new(state.tau, state.load));
            state.residual as f32
        }
        State::Different(reference, difference) => {
            let rod = &sheet.rod;
            let point = || DVec2::from(difference.point(rod, reference));
            // Only friction asks for it.
            answer.point = (rod.friction != 0.0).then(point);
            difference.residual
        }
    };
    if matches!(regime, Regime::Contact | Regime::Unreachable) {
        if let Some(numbers) = readings.and_then(|readings| readings.read(cell)) {
            answer.state = numbers;
        }
        answer.residual = residual;
        answer.margin_deg = span.map_or(f32::NAN, |span| span.margin_deg(push.abs()));
    } else if regime == Regime::Unresolved {
        answer.residual = residual;
    }
    answer
}
