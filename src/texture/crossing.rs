//! First crossing of a course: from there on, the free part of the whisker meets the line of the asperities in a second place.
//!
//! The clearance of the free part is a function of the push against an asperity. It is followed at pushes that depend on neither the course
//! nor its samples. A stretch of pushes is divided until a bound excludes a crossing inside, or the crossing is located.

use super::sample::Held;
use super::tip::Clearance;
use super::{AsperityContact, Contact, Placed};
use crate::rod::Side;
use crate::whisk::phase::Obstacles;
use crate::whisk::states::BothSides;

/// State from which on the course is undecided. Other asperities would bend the whisker there, too.
#[derive(Clone, Copy)]
pub struct Crossing {
    pub time_s: f64,
    /// Angle of the base at the crossing, in radians.
    pub angle: f64,
    pub held: Held,
}

/// Number of equal stretches into which the pushes against one asperity, and then open stretches, are divided.
const STRETCHES: u32 = 16;

/// Width at which a change of sign is located, in parts of the largest push.
const LOCATED: f64 = 1e-13;

/// Width below which a stretch with clearance at both ends is not divided, in parts of the largest push. A crossing inside is as short.
const GRAZED: f64 = 1e-6;

/// Factor by which the clearance may change more along a stretch than from end to end, where direction and contact turn back.
const ALLOWANCE: f64 = 2.0;

/// Clearance of the pushes against one asperity on one side.
struct ClearanceCurve {
    side: Side,
    obstacle: i32,
    /// Pushes in radians, as magnitudes, with the least clearance there; pushes grow: `[node]`.
    nodes: Vec<(f64, f64)>,
}

/// Stretch of the pushes against one asperity.
struct Stretch {
    /// Ends, in parts of the largest push.
    parts: [f64; 2],
    clearances: [Clearance; 2],
}

impl Stretch {
    /// Returns true if a crossing may begin or end inside, and is not located.
    fn is_open(&self) -> bool {
        let width = self.parts[1] - self.parts[0];
        let [from, to] = self.clearances;
        match [from, to].map(|own| own.least < 0.0) {
            [true, true] => false,
            [false, false] => {
                let lowest = from.least + to.least - ALLOWANCE * from.variation(&to);
                width > GRAZED && lowest < 0.0
            }
            _ => width > LOCATED,
        }
    }
}

impl ClearanceCurve {
    /// Returns the first push without clearance between two pushes, in radians, from the first to the second; `None` without one.
    fn first(&self, [from, to]: [f64; 2]) -> Option<f64> {
        let after = self.nodes.partition_point(|(push, _)| *push <= from);
        let around = [after.checked_sub(1)?, after.min(self.nodes.len() - 1)];
        if around.iter().all(|node| self.nodes[*node].1 < 0.0) {
            return Some(from);
        }
        let is_between = |push: f64| (push - from) * (push - to) < 0.0;
        let nodes = self.nodes.iter();
        let mut crossed = nodes.filter(|(push, least)| is_between(*push) && *least < 0.0);
        let found = match from < to {
            true => crossed.next(),
            false => crossed.next_back(),
        };
        found.map(|(push, _)| *push)
    }
}

/// Moment of a course: a sample or a passage.
#[derive(Clone, Copy)]
pub struct Moment {
    pub time_s: f64,
    /// Angle of the base, in radians.
    pub angle: f64,
    pub contact: Contact,
}

impl Placed<'_> {
    /// Returns the first crossing of a course through `moments`, in the order of time, `[moment]`; `None` without one. Between two moments
    /// in one contact, the push grows or falls throughout.
    pub fn crossing(&self, states: &BothSides, moments: &[Moment]) -> Option<Crossing> {
        let ways = moments.windows(2).filter_map(|pair| {
            let contacts = [pair[0].contact?, pair[1].contact?];
            let [from, to] = contacts.map(|own| (own.side, own.obstacle));
            (from == to).then_some((pair, contacts))
        });
        let ways: Vec<_> = ways.collect();
        let mut met: Vec<(Side, i32)> = Vec::new();
        for (_, [from, _]) in &ways {
            let contact = (from.side, from.obstacle);
            if !met.contains(&contact) {
                met.push(contact);
            }
        }
        let curves = self.clearances(states, &met);
        ways.into_iter().find_map(|(pair, [from, to])| {
            let is_own = |curve: &&ClearanceCurve| {
                (curve.side, curve.obstacle) == (from.side, from.obstacle)
            };
            let pushes = [from, to].map(|own| own.row_push.1);
            let push = curves.iter().find(is_own)?.first(pushes)?;
            let part = match pushes[1] - pushes[0] {
                0.0 => 0.0,
                way => (push - pushes[0]) / way,
            };
            let between = |of: fn(&Moment) -> f64| {
                let [from, to] = [of(&pair[0]), of(&pair[1])];
                (to - from).mul_add(part, from)
            };
            let [time_s, angle] = [between(|own| own.time_s), between(|own| own.angle)];
            let contact = self.contact(from.side, from.obstacle, push);
            let held = self.held(states, &[contact], &[[time_s, angle]]).pop()??;
            Some(Crossing {
                time_s,
                angle,
                held,
            })
        })
    }

    /// Returns the clearances of all pushes in the contacts `met`, `[contact]`. A stretch next to a state that is not found is not divided.
    fn clearances(&self, states: &BothSides, met: &[(Side, i32)]) -> Vec<ClearanceCurve> {
        let curves = met.iter().map(|&(side, obstacle)| ClearanceCurve {
            side,
            obstacle,
            nodes: Vec::new(),
        });
        let mut curves: Vec<ClearanceCurve> = curves.collect();
        let whole = (0..curves.len()).map(|curve| (curve, [0.0, 1.0]));
        let mut open: Vec<(usize, [f64; 2])> = whole.collect();
        while !open.is_empty() {
            let divided = open.iter().map(|(curve, [from, to])| {
                let part =
                    move |i: u32| (to - from).mul_add(f64::from(i) / f64::from(STRETCHES), *from);
                (0..=STRETCHES).map(move |i| (*curve, part(i)))
            });
            let places: Vec<(usize, f64)> = divided.flatten().collect();
            let found = self.clearances_at(states, &mut curves, &places);
            let nodes: Vec<_> = places.into_iter().zip(found).collect();
            let stretches = nodes.chunks_exact(STRETCHES as usize + 1);
            let stretches = stretches
                .flat_map(|nodes| nodes.windows(2))
                .filter_map(|pair| {
                    let [((curve, from), clear), ((_, to), clear_to)] = [pair[0], pair[1]];
                    let own = Stretch {
                        parts: [from, to],
                        clearances: [clear?, clear_to?],
                    };
                    own.is_open().then_some((curve, own.parts))
                });
            open = stretches.collect();
        }
        for curve in &mut curves {
            curve.nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        curves
    }

    /// Returns the clearances at `places`, each the index of a curve and a part of its largest push, `[place]`, and adds them to the curves;
    /// `None` where no state is found.
    fn clearances_at(
        &self,
        states: &BothSides,
        curves: &mut [ClearanceCurve],
        places: &[(usize, f64)],
    ) -> Vec<Option<Clearance>> {
        let contacts = places.iter().map(|(curve, part)| {
            let ClearanceCurve { side, obstacle, .. } = curves[*curve];
            let push = part * self.asperities.end(side, obstacle)?;
            self.contact(side, obstacle, push)
        });
        let contacts: Vec<Contact> = contacts.collect();
        let rows = contacts.iter();
        let rows = rows.map(|contact| contact.map(|own: AsperityContact| (own.side, own.row_push)));
        let readings = states.readings(&rows.collect::<Vec<_>>());
        let found = contacts.iter().zip(readings).zip(places);
        let found = found.map(|((contact, reading), (curve, _))| {
            let AsperityContact {
                side,
                obstacle,
                row_push: (_, push),
            } = (*contact)?;
            let angle = self.asperities.touch(side, obstacle) + side.sign() * push;
            let clearance = self.tips.clearance(angle, &reading?);
            curves[*curve].nodes.push((push, clearance.least));
            Some(clearance)
        });
        found.collect()
    }
}
