//! Detachments between frames, for `fit`.

use super::TrackedFrame;
use super::frame_curve::NearestPlace;
use crate::trace::row;
use serde::Serialize;
use whiskmap_mechanics::rod::Side;

row! {
    /// Detachment between two frames, with the columns that `fit` reads.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct TrackedDetachment {
        pub side: Side,
        /// Distance from the base to the contact at first touch, in mm: in the first frame in contact.
        pub distance_mm: f64,
        /// Rotation of the base from first touch to detachment, in degrees: positive CB, negative CF. Both are in the middle between two frames.
        pub push_angle_deg: f64,
        /// Time of the last frame in contact, in s.
        pub time_s: f64,
    }
}

/// Returns the contacts that end with the pole on the other side of the whisker. A contact counts if the frames before and after it are no gaps.
pub(super) fn detachments(
    rows: &[TrackedFrame],
    places: &[Option<NearestPlace>],
) -> Vec<TrackedDetachment> {
    let mut found = Vec::new();
    let mut touch: Option<usize> = None;
    for i in 1..rows.len() {
        match [rows[i - 1].contact, rows[i].contact] {
            [Some(0), Some(1)] => touch = Some(i),
            [Some(1), Some(0)] => found.extend(
                touch
                    .take()
                    .and_then(|touch| detachment(rows, places, touch, i)),
            ),
            // A gap before the first touch or after the last one hides when it was.
            [None, Some(0)] | [Some(0), None] => touch = None,
            _ => {}
        }
    }
    found
}

/// The detachment after a contact that begins with frame `touch` and ends before frame `end`; `None` if the whisker was released.
fn detachment(
    rows: &[TrackedFrame],
    places: &[Option<NearestPlace>],
    touch: usize,
    end: usize,
) -> Option<TrackedDetachment> {
    let is_left = |i: usize| Some(places[i]?.offset_mm > 0.0);
    if is_left(touch - 1)? == is_left(end)? {
        return None;
    }
    let between = |i: usize| Some(0.5 * (rows[i - 1].angle_deg? + rows[i].angle_deg?));
    let push_angle_deg = between(end)? - between(touch)?;
    Some(TrackedDetachment {
        side: if is_left(touch - 1)? {
            Side::Cf
        } else {
            Side::Cb
        },
        distance_mm: places[touch]?.at_mm.length(),
        push_angle_deg,
        time_s: rows[end - 1].time_s,
    })
}
