//! Legs of a course: straight lines of the base's angle from sample to sample, with the events on them.
//!
//! Events belong to the course, not to its samples: a contact is moved to events and turning points alone, and read at samples.

use super::contact::{ContactTracker, pushed};
use super::phase::{Obstacles, Passage, Phase};
use super::states::{BothSides, PushedContact};
use super::turns::Turns;
use super::{Undecided, WhiskEventKind};
use whiskmap_mechanics::rod::Side;

/// Sample of a course, before its state is computed.
#[derive(Clone, Copy, Debug)]
pub struct LegSample {
    /// Contact of the whisker at the sample; `None` for a free whisker. The error is the reason why the sample is undecided.
    pub held: Result<Option<PushedContact>, Undecided>,
    /// Energy that friction has dissipated since the start of the course, in `E I_base/L_w`.
    pub dissipated: f64,
}

/// Event of a course, before its state is computed.
#[derive(Clone, Copy, Debug)]
pub struct LegEvent {
    /// Time of the event, in s.
    pub time_s: f64,
    /// Angle of the base at the event, in radians.
    pub angle: f64,
    /// Kind of the event.
    pub kind: WhiskEventKind,
    /// Contact that begins, ends or changes; its push is NaN if the course is undecided from here on.
    pub contact: PushedContact,
}

/// Course in progress: legs between samples, with the samples and events so far.
pub struct Legs<'a> {
    turns: &'a Turns,
    phase: Phase,
    /// Phases in which the course can be after a gap; none while its phase is known.
    possible: Vec<Phase>,
    contacts: ContactTracker<'a>,
    /// Change of the angle on the last leg on which the base moved, in radians; 0 before it.
    heading: f64,
    /// Samples of the course so far, `[sample]`.
    pub samples: Vec<LegSample>,
    /// Events of the course so far, in the order of time, `[event]`.
    pub events: Vec<LegEvent>,
}

/// Leg between two samples: angles of the base in radians, and times in s.
#[derive(Clone, Copy)]
struct Leg {
    angles: [f64; 2],
    times: [f64; 2],
}

impl Leg {
    fn time(&self, angle: f64) -> f64 {
        let [from, to] = self.angles;
        let part = if to == from { 1.0 } else { (angle - from) / (to - from) };
        (self.times[1] - self.times[0]).mul_add(part, self.times[0])
    }
}

impl<'a> Legs<'a> {
    /// Creates the course in progress before its first sample, with the states on both `sides`.
    pub const fn new(turns: &'a Turns, sides: &'a BothSides) -> Self {
        Self {
            turns,
            phase: Phase::Free { after: 0 },
            possible: Vec::new(),
            contacts: ContactTracker::new(sides),
            heading: 0.0,
            samples: Vec::new(),
            events: Vec::new(),
        }
    }

    /// Adds the first sample of the course, in `phase` at the `angle` of the base, in radians, and the time in s. A contact has moved there from
    /// first touch.
    pub fn first(&mut self, phase: Phase, angle: f64, time_s: f64) {
        self.phase = phase;
        if let Phase::Contact { side, obstacle } = self.phase {
            let push = self.turns.push(side, obstacle, angle).max(0.0);
            self.contacts.touch(side, push);
        }
        self.end(Leg { angles: [angle; 2], times: [time_s; 2] });
    }

    /// Continues the course after a gap, or begins it there, at the `angle` of the base, in radians, and the time in s. From here on, all phases
    /// are followed in which the whisker can be.
    pub fn resume(&mut self, angle: f64, time_s: f64) {
        self.possible = self.turns.possible(angle);
        self.contacts.forget();
        self.heading = 0.0;
        self.decide();
        self.end(Leg { angles: [angle; 2], times: [time_s; 2] });
    }

    /// Ends the search for the phase after a gap, if the whisker is free in all phases in which it can be. A contact with friction has a
    /// history of its own.
    fn decide(&mut self) {
        if let [first @ Phase::Free { .. }, others @ ..] = &self.possible[..]
            && others.iter().all(|other| other == first)
        {
            self.phase = *first;
            self.possible.clear();
        }
    }

    /// Moves the base through `angles`, in radians, in the `times`, in s. Adds the events between, and the sample at the end.
    pub fn leg(&mut self, angles: [f64; 2], times: [f64; 2]) {
        let leg = Leg { angles, times };
        let [from, to] = angles;
        if !self.possible.is_empty() {
            for phase in &mut self.possible {
                self.turns.pass(phase, from, to, |_| {});
            }
            self.decide();
            self.end(leg);
            return;
        }
        if to != from {
            self.head(from, to - from);
        }
        let mut passages = Vec::new();
        self.turns.pass(&mut self.phase, from, to, |passage| passages.push(passage));
        for passage in passages {
            self.pass(&leg, passage);
        }
        self.end(leg);
    }

    /// Begins a leg at an `angle` of the base, in radians. Where the base turns back, the contact does so, too.
    fn head(&mut self, angle: f64, heading: f64) {
        if heading * self.heading < 0.0
            && let Some((side, _, push)) = self.contact(angle)
        {
            // The sample at the turning point has the changes before it.
            self.contacts.to(side, push);
        }
        self.heading = heading;
    }

    /// Returns side, obstacle and push of the contact at an `angle` of the base, in radians; `None` without a known one.
    fn contact(&self, angle: f64) -> Option<(Side, i32, f64)> {
        match self.phase {
            Phase::Contact { side, obstacle }
                if self.possible.is_empty() && !self.contacts.is_lost =>
            {
                let push = self.turns.push(side, obstacle, angle).max(0.0);
                Some((side, obstacle, push))
            }
            _ => None,
        }
    }

    fn pass(&mut self, leg: &Leg, passage: Passage) {
        let Passage { angle, event, side, obstacle, push } = passage;
        if self.contacts.is_lost {
            return;
        }
        let mut kind = event;
        let mut contact = pushed(side, push, None);
        match event {
            WhiskEventKind::Touch => contact = self.contacts.touch(side, push),
            WhiskEventKind::Undecided => {}
            _ => {
                let (reached, changes) = self.contacts.to(side, push);
                self.change(leg, obstacle, changes);
                if self.contacts.is_lost {
                    return;
                }
                contact = reached;
                self.contacts.leave(event == WhiskEventKind::Release);
                if self.contacts.is_lost {
                    kind = WhiskEventKind::Undecided;
                }
            }
        }
        self.add(leg, angle, kind, contact);
    }

    /// Adds the `changes` of the contact with an obstacle.
    fn change(&mut self, leg: &Leg, obstacle: i32, changes: Vec<PushedContact>) {
        for contact in changes {
            let PushedContact { side, push, phase, .. } = contact;
            let angle = self.turns.touch(side, obstacle) + side.sign() * push;
            let kind = match phase {
                Some(_) => WhiskEventKind::Snap,
                None => WhiskEventKind::Undecided,
            };
            self.add(leg, angle, kind, contact);
        }
    }

    /// Adds an event.
    fn add(&mut self, leg: &Leg, angle: f64, kind: WhiskEventKind, contact: PushedContact) {
        let push = match kind {
            WhiskEventKind::Undecided => f64::NAN,
            _ => contact.push,
        };
        self.events.push(LegEvent {
            time_s: leg.time(angle),
            angle,
            kind,
            contact: PushedContact { push, ..contact },
        });
    }

    /// Adds the sample at the end of a leg.
    fn end(&mut self, leg: Leg) {
        let mut dissipated = self.contacts.dissipated();
        let mut held = match self.phase {
            _ if !self.possible.is_empty() => Err(Undecided::AfterGap),
            Phase::Undecided { reason, .. } => Err(reason),
            _ => Ok(None),
        };
        if let Some((side, obstacle, push)) = self.contact(leg.angles[1]) {
            let (contact, taken, changes) = self.contacts.at(side, push);
            self.change(&leg, obstacle, changes);
            (held, dissipated) = (Ok(Some(contact)), taken);
        }
        if self.contacts.is_lost {
            held = Err(Undecided::Stuck);
        }
        self.samples.push(LegSample { held, dissipated });
    }
}
