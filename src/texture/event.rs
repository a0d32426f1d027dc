//! Events of a course behind a surface.

use super::rows::TextureEvent;
use super::sample::{Held, SurfaceCrossing};
use crate::trace::StateRow;
use crate::whisk::phase::Passage;
use crate::whisk::{WhiskEventKind, signed_deg};
use whiskmap_mechanics::rod::Side;

/// Returns the events of a course up to the first crossing, `[event]`.
pub fn events(
    passages: &[(f64, Passage)],
    held: &[Option<Held>],
    crossed: Option<SurfaceCrossing>,
) -> Vec<TextureEvent> {
    let energy = |i: usize| Some(held[i].as_ref()?.reading()?.energy_nj);
    let is_before = |time_s: f64| crossed.is_none_or(|crossing| time_s < crossing.time_s);
    let before = (0..passages.len()).take_while(|i| is_before(passages[*i].0));
    let events = before.map(|i| {
        let (time_s, passage) = &passages[i];
        // A whisker that is held or undecided at once after a detachment has the energy of that state, known or not.
        let next = passages.get(i + 1);
        let after = match next.is_some_and(|(_, next)| next.angle == passage.angle) {
            true => energy(i + 1),
            false => Some(0.0),
        };
        let lost = energy(i).zip(after).map(|(before, after)| before - after);
        TextureEvent {
            lost_nj: lost.filter(|_| passage.event.is_detachment()),
            ..TextureEvent::new(passage.event, [*time_s, passage.angle], passage.side, held[i])
        }
    });
    let end = crossed.map(|crossing| {
        let moment = [crossing.time_s, crossing.angle];
        TextureEvent::new(
            WhiskEventKind::Undecided,
            moment,
            crossing.held.side,
            Some(crossing.held),
        )
    });
    events.chain(end).collect()
}

impl TextureEvent {
    /// Creates an event at `[time in s, angle in radians]` that loses no energy.
    fn new(
        event: WhiskEventKind,
        [time_s, angle]: [f64; 2],
        side: Side,
        held: Option<Held>,
    ) -> Self {
        let tip = held.and_then(|held| held.state).map(|(_, tip)| tip);
        let event = Self {
            time_s,
            event,
            asperity: held.map(|held| held.asperity),
            side,
            angle_deg: angle.to_degrees(),
            push_angle_deg: held.map(|held| signed_deg(held.side, held.push)),
            tip_x_mm: tip.map(|tip| tip.x_mm),
            ..Self::default()
        };
        event.with_state(held.as_ref().and_then(Held::reading))
    }
}
