//! One pole in front of a base that can turn around it: the same obstacle after each turn.

use super::Undecided;
use super::phase::{ContactEnd, Obstacles, Phase, ROUNDING};
use std::f64::consts::TAU;
use whiskmap_mechanics::rod::Side;

/// Angles of one turn at which the phase of a course changes, in radians. The number of an obstacle counts whole turns of the base.
#[derive(Clone, Copy, Debug)]
pub struct Turns {
    /// Angle of the base at first touch on CF, in radians. On CB it is 0.
    pub cf_touch: f64,
    /// End of a push on CB.
    pub cb_end: ContactEnd,
    /// End of a push on CF; `None` if the resting whisker does not reach the pole on CF.
    pub cf_end: Option<ContactEnd>,
}

impl Turns {
    /// Returns the phase in which a course begins at `angle`, in radians; `None` in contact.
    pub fn begin(&self, angle: f64) -> Option<Phase> {
        // At first touch on CB the whisker counts as not yet past the pole. Without this, rounding would decide in front of a point contact, whose
        // two sides are touched at the same angle.
        let cb_touch = (angle / TAU).round();
        let turn = match (angle - TAU * cb_touch).abs() <= ROUNDING {
            true => cb_touch - 1.0,
            false => ((angle + ROUNDING - self.cf_touch) / TAU).floor(),
        };
        let is_free = angle <= TAU * (turn + 1.0) + ROUNDING;
        // Courses have at most a turn to each side.
        let after = turn as i32;
        is_free.then_some(Phase::Free { after })
    }

    /// Returns the contacts that hold the whisker at `angle`, in radians, `[contact]`: at most one a side. CB comes first.
    pub fn held(&self, angle: f64) -> impl Iterator<Item = Phase> {
        let cf_turn = ((angle - self.cf_touch) / TAU).ceil();
        let touches = [(Side::Cb, (angle / TAU).floor()), (Side::Cf, cf_turn)];
        touches.into_iter().filter_map(move |(side, turn)| {
            // Courses have at most a turn to each side.
            let obstacle = turn as i32;
            let end = self.end(side, obstacle)?;
            let is_held = self.push(side, obstacle, angle) < end.push;
            is_held.then_some(Phase::Contact { side, obstacle })
        })
    }

    /// Returns every phase in which a whisker of unknown history can be at `angle`, in radians, `[phase]`.
    pub fn possible(&self, angle: f64) -> Vec<Phase> {
        let free = self.begin(angle);
        // Between both touches of a thick pole, the whisker may lie on the pole.
        let on_the_pole = free.is_none().then(|| Phase::Undecided {
            obstacle: (angle / TAU).floor() as i32,
            reason: Undecided::OnThePole,
        });
        let known = free.into_iter().chain(on_the_pole);
        known.chain(self.held(angle)).collect()
    }
}

impl Obstacles for Turns {
    fn touch(&self, side: Side, turn: i32) -> f64 {
        let from_turn = match side {
            Side::Cb => 0.0,
            Side::Cf => self.cf_touch,
        };
        from_turn + TAU * f64::from(turn)
    }

    fn end(&self, side: Side, _turn: i32) -> Option<ContactEnd> {
        match side {
            Side::Cb => Some(self.cb_end),
            Side::Cf => self.cf_end,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::whisk::WhiskEventKind;

    const TURNS: Turns =
        Turns { cf_touch: 0.1, cb_end: slip_off(0.5), cf_end: Some(slip_off(0.7)) };

    const fn slip_off(push: f64) -> ContactEnd {
        let kind = WhiskEventKind::SlipOff;
        ContactEnd { push, kind }
    }

    /// Events of a course through these angles: what happens, on which side, and at which angle.
    fn events(turns: &Turns, angles: &[f64]) -> Vec<(WhiskEventKind, Side, f64)> {
        let mut events = Vec::new();
        let mut phase = turns.begin(angles[0]).unwrap_or(Phase::Free { after: 99 });
        for pair in angles.windows(2) {
            turns.pass(&mut phase, pair[0], pair[1], |passage| {
                events.push((passage.event, passage.side, passage.angle));
            });
        }
        events
    }

    #[test]
    fn a_whisker_that_slips_off_comes_back_on_the_other_side() {
        use WhiskEventKind::{Release, SlipOff, Touch};
        let found = events(&TURNS, &[-0.2, 1.0, -1.0]);
        let end = 0.1 - 0.7;
        let wanted = [
            (Touch, Side::Cb, 0.0),
            (SlipOff, Side::Cb, 0.5),
            (Touch, Side::Cf, 0.1),
            (SlipOff, Side::Cf, end),
        ];
        assert_eq!(found, wanted);
        // A push that turns back is released where it began.
        let found = events(&TURNS, &[0.0, 0.4, -0.2, 0.5]);
        let wanted = [(Touch, Side::Cb, 0.0), (Release, Side::Cb, 0.0), (Touch, Side::Cb, 0.0)];
        assert_eq!(found, wanted);
    }

    #[test]
    fn a_whole_turn_touches_from_behind() {
        let found = events(&TURNS, &[0.2, 6.0, 7.0]);
        assert_eq!(found[0], (WhiskEventKind::Touch, Side::Cb, TAU));
        assert_eq!(found[1], (WhiskEventKind::SlipOff, Side::Cb, TAU + 0.5));
        assert_eq!(found.len(), 2);
    }

    #[test]
    fn a_course_cannot_begin_in_contact() {
        assert_eq!(TURNS.begin(0.05), None);
        assert_eq!(TURNS.begin(0.0), Some(Phase::Free { after: -1 }));
        assert_eq!(TURNS.begin(0.1), Some(Phase::Free { after: 0 }));
        // In front of a point both touches are at the same angle, and a push to CB comes first.
        let point = Turns { cf_touch: 0.0, ..TURNS };
        assert_eq!(point.begin(0.0), Some(Phase::Free { after: -1 }));
        assert_eq!(point.begin(0.1), Some(Phase::Free { after: 0 }));
    }

    /// Before a thick pole, a short push ends where the resting whisker would cross the pole.
    #[test]
    fn a_whisker_on_the_pole_is_undecided() {
        let thick = Turns { cf_touch: 0.4, cb_end: slip_off(0.2), cf_end: Some(slip_off(0.1)) };
        let mut phase = Phase::Free { after: -1 };
        let mut last = None;
        thick.pass(&mut phase, -0.1, 0.35, |passage| last = Some(passage.event));
        assert_eq!(last, Some(WhiskEventKind::Undecided));
        let reason = Undecided::OnThePole;
        assert_eq!(phase, Phase::Undecided { obstacle: 0, reason });
        thick.pass(&mut phase, 0.35, 0.45, |_| {});
        assert_eq!(phase, Phase::Free { after: 0 });
        // A side that holds the whisker takes it over.
        let held = Turns { cf_end: Some(slip_off(0.3)), ..thick };
        let mut phase = Phase::Free { after: -1 };
        held.pass(&mut phase, -0.1, 0.35, |_| {});
        let side = Side::Cf;
        assert_eq!(phase, Phase::Contact { side, obstacle: 0 });
        // Without a touch on CF, the tip's edge meets the pole.
        let short = Turns { cf_end: None, ..thick };
        let mut phase = Phase::Free { after: 0 };
        short.pass(&mut phase, 0.5, 0.3, |_| {});
        let reason = Undecided::TipEdge;
        assert_eq!(phase, Phase::Undecided { obstacle: 0, reason });
    }

    #[test]
    fn a_contact_begins_on_the_side_that_holds_the_whisker() {
        let contact = |side, obstacle| Some(Phase::Contact { side, obstacle });
        for (angle, wanted) in [
            (0.3, contact(Side::Cb, 0)),
            (0.05, contact(Side::Cb, 0)),
            (0.6, None),
            (-0.3, contact(Side::Cf, 0)),
            (-0.65, None),
            (0.3 - TAU, contact(Side::Cb, -1)),
            (TAU - 0.3, contact(Side::Cf, 1)),
        ] {
            assert_eq!(TURNS.held(angle).next(), wanted, "{angle}");
        }
        let short = Turns { cf_end: None, ..TURNS };
        assert_eq!(short.held(-0.3).next(), None);
    }

    /// Without its history, a whisker is free or in a contact that holds it. It is certainly free only beyond the ends of both pushes.
    #[test]
    fn a_whisker_of_unknown_history_has_all_possible_phases() {
        let (before, past) = (Phase::Free { after: -1 }, Phase::Free { after: 0 });
        let [cb, cf] = [Side::Cb, Side::Cf].map(|side| Phase::Contact { side, obstacle: 0 });
        let reason = Undecided::OnThePole;
        let on_the_pole = Phase::Undecided { obstacle: 0, reason };
        for (angle, wanted) in [
            (-0.65, vec![before]),
            (-0.3, vec![before, cf]),
            (0.05, vec![on_the_pole, cb, cf]),
            (0.3, vec![past, cb]),
            (0.55, vec![past]),
        ] {
            assert_eq!(TURNS.possible(angle), wanted, "{angle}");
        }
    }
}
