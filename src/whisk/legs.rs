//! Legs of a course: straight lines of the base's angle from sample to sample, with the events on them.

use super::contact::CourseContact;
use super::friction::FrictionCourse;
use super::phase::{Obstacles, Passage, Phase};
use super::states::SideStates;
use super::turns::Turns;
use super::{Undecided, WhiskEventKind};
use crate::friction::Snap;

/// Sample of a course, before its state is computed.
#[derive(Clone, Copy, Debug)]
pub struct LegSample {
    /// Phase of the course at the sample: free, in contact or undecided.
    pub phase: Phase,
    /// Contact of the whisker at the sample; `None` without one.
    pub contact: Option<CourseContact>,
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
    /// Kind of the event; `None` where a detachment's kind is that of the end of the push.
    pub kind: Option<WhiskEventKind>,
    /// Contact that begins, ends or changes; its push is NaN if the course is undecided from here on.
    pub contact: CourseContact,
}

/// Course in progress: legs between samples, with the samples and events so far.
pub struct Legs<'a> {
    turns: &'a Turns,
    phase: Phase,
    friction: FrictionCourse<'a>,
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
        let part = if to == from {
            1.0
        } else {
            (angle - from) / (to - from)
        };
        (self.times[1] - self.times[0]).mul_add(part, self.times[0])
    }
}

impl<'a> Legs<'a> {
    /// Creates the course in progress that begins in `phase`. `sides` are the states on `[CB, CF]`.
    pub fn new(turns: &'a Turns, phase: Phase, sides: [Option<&'a SideStates>; 2]) -> Self {
        Self {
            turns,
            phase,
            friction: FrictionCourse::new(sides),
            samples: Vec::new(),
            events: Vec::new(),
        }
    }

    /// Adds the first sample of the course, at the `angle` of the base, in radians, and the time in s. A contact has moved there from
    /// first touch.
    pub fn first(&mut self, angle: f64, time_s: f64) {
        if let Phase::Contact { side, obstacle } = self.phase {
            let push = self.turns.push(side, obstacle, angle).max(0.0);
            self.friction.touch(side, push);
        }
        self.end(Leg {
            angles: [angle; 2],
            times: [time_s; 2],
        });
    }

    /// Moves the base through `angles`, in radians, in the `times`, in s. Adds the events between, and the sample at the end.
    pub fn leg(&mut self, angles: [f64; 2], times: [f64; 2]) {
        let leg = Leg { angles, times };
        let mut passages = Vec::new();
        let [from, to] = angles;
        self.turns
            .pass(&mut self.phase, from, to, |passage| passages.push(passage));
        for passage in passages {
            if !self.friction.is_lost {
                self.pass(&leg, passage);
            }
        }
        self.end(leg);
    }

    fn pass(&mut self, leg: &Leg, passage: Passage) {
        let Passage {
            angle,
            event,
            side,
            push,
            ..
        } = passage;
        let contact = match event {
            Some(WhiskEventKind::Touch) => self.friction.touch(side, push),
            Some(WhiskEventKind::Undecided) => CourseContact {
                side,
                push,
                phase: None,
            },
            _ => {
                let contact = self.to(
                    leg,
                    angle,
                    CourseContact {
                        side,
                        push,
                        phase: None,
                    },
                );
                self.friction.leave(event.is_some());
                contact
            }
        };
        self.add(leg, angle, event, contact);
    }

    /// Moves the contact to a push and the `angle` of the base there, in radians. Adds the snaps on the way.
    fn to(&mut self, leg: &Leg, angle: f64, contact: CourseContact) -> CourseContact {
        let CourseContact { side, push, .. } = contact;
        let (contact, snaps) = self.friction.to(side, push);
        for Snap {
            push: at, before, ..
        } in snaps
        {
            let phase = Some(before);
            let snap = CourseContact {
                side,
                push: at,
                phase,
            };
            let angle = side.sign().mul_add(at - push, angle);
            self.add(leg, angle, Some(WhiskEventKind::Snap), snap);
        }
        contact
    }

    /// Adds an event, or the last one if the contact is lost.
    fn add(&mut self, leg: &Leg, angle: f64, kind: Option<WhiskEventKind>, contact: CourseContact) {
        let mut event = LegEvent {
            time_s: leg.time(angle),
            angle,
            kind,
            contact,
        };
        if self.friction.is_lost {
            event.kind = Some(WhiskEventKind::Undecided);
            event.contact.push = f64::NAN;
        }
        self.events.push(event);
    }

    /// Adds the sample at the end of a leg.
    fn end(&mut self, leg: Leg) {
        let angle = leg.angles[1];
        let mut contact = None;
        if let Phase::Contact { side, obstacle } = self.phase
            && !self.friction.is_lost
        {
            let push = self.turns.push(side, obstacle, angle).max(0.0);
            let phase = None;
            let reached = self.to(&leg, angle, CourseContact { side, push, phase });
            if self.friction.is_lost {
                self.add(&leg, angle, None, reached);
            }
            contact = Some(reached);
        }
        let mut phase = self.phase;
        if self.friction.is_lost {
            let reason = Undecided::Stuck;
            (phase, contact) = (
                Phase::Undecided {
                    obstacle: 0,
                    reason,
                },
                None,
            );
        }
        self.samples.push(LegSample {
            phase,
            contact,
            dissipated: self.friction.dissipated(),
        });
    }
}
