//! Detachments between frames, for `fit`.

use super::frame_curve::NearestPlace;
use super::{Remarks, TrackedFrame};
use crate::scene::{digits, rounded};
use crate::trace::row;
use glam::DVec2;
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

/// Largest way of the pole from first touch to detachment, as seen from the base, without a warning, in parts of its distance: 0.6 degrees.
const STILL: f64 = 0.01;

/// Returns the contacts that end with the pole on the other side of the whisker. A contact counts if the frames before and after it are known
/// to be without contact. A note gives the number of the others. A gap in a contact counts as contact, unless it has the pole on other sides before
/// and after. A warning says if pole or base move, because the push angle of the model is the rotation of a base in front of a still pole.
pub(super) fn detachments(
    rows: &[TrackedFrame],
    places: &[Option<NearestPlace>],
    remarks: &mut Remarks,
) -> Vec<TrackedDetachment> {
    let known = |(i, row): (usize, &TrackedFrame)| Some((i, row.contact? == 1));
    let known: Vec<(usize, bool)> = rows.iter().enumerate().filter_map(known).collect();
    let mut found = Vec::new();
    let mut touch: Option<usize> = None;
    let mut left_out = 0;
    let is_left = |i: usize| places[i].map(|place| place.offset_mm > 0.0);
    for pair in known.windows(2) {
        let [(before, was_in_contact), (after, is_in_contact)] = [pair[0], pair[1]];
        // A gap before the first touch or after the last one hides when it was.
        let is_shown = after == before + 1;
        match (was_in_contact, is_in_contact) {
            (false, true) => touch = is_shown.then_some(after),
            (true, false) => match touch.take().filter(|_| is_shown) {
                Some(touch) => found.extend(detachment(rows, places, touch, after)),
                None => left_out += 1,
            },
            // The gap hides the end of one contact and the first touch of another one.
            (true, true) if !is_shown && is_left(before) != is_left(after) => {
                touch = None;
                left_out += 1;
            }
            _ => {}
        }
    }
    let ways = found.iter().map(|(_, way)| *way).filter(|[_, part, _]| *part > STILL);
    let ways: Vec<[f64; 3]> = ways.collect();
    if !ways.is_empty() {
        let most = |i: usize| ways.iter().map(|way| way[i].abs()).fold(0.0, f64::max);
        let [mm, deg] = [most(0), most(2)].map(|most| digits(rounded(most, 2)));
        remarks.warnings.push(format!(
            "in {} of {} detachments, the pole moves by up to {mm} mm, as seen from the base, between first touch and detachment: push_angle_deg is the \
             rotation of the base in the image, which is a push angle only if base and pole stand still; the pole's direction changes by up to {deg} deg",
            ways.len(),
            found.len()
        ));
    }
    left_out += u32::from(known.last().is_some_and(|(_, is_in_contact)| *is_in_contact));
    if left_out > 0 {
        remarks.notes.push(format!(
            "contacts that give no detachment, as first touch or end is next to a gap or outside the film: {left_out}"
        ));
    }
    found.into_iter().map(|(detachment, _)| detachment).collect()
}

/// Returns the detachment after a contact that begins with frame `touch` and ends before frame `end`, and the way of the pole meanwhile, as seen from the
/// base: in mm, in parts of its distance, and the change of its direction in degrees. `None` if the whisker was released.
fn detachment(
    rows: &[TrackedFrame],
    places: &[Option<NearestPlace>],
    touch: usize,
    end: usize,
) -> Option<(TrackedDetachment, [f64; 3])> {
    let is_left = |i: usize| Some(places[i]?.offset_mm > 0.0);
    if is_left(touch - 1)? == is_left(end)? {
        return None;
    }
    let between = |i: usize| Some(0.5 * (rows[i - 1].angle_deg? + rows[i].angle_deg?));
    let push_angle_deg = between(end)? - between(touch)?;
    // From the base to the pole, in the axes of the image.
    let pole = |i: usize| {
        let axis = DVec2::from_angle(-rows[i].angle_deg?.to_radians());
        Some(axis.rotate(places[i]?.pole_mm()))
    };
    let [first, last] = [pole(touch)?, pole(end - 1)?];
    let way_mm = (last - first).length();
    let way = [way_mm, way_mm / first.length(), first.angle_to(last).to_degrees()];
    let detachment = TrackedDetachment {
        side: if is_left(touch - 1)? { Side::Cf } else { Side::Cb },
        distance_mm: places[touch]?.at_mm.length(),
        push_angle_deg,
        time_s: rows[end - 1].time_s,
    };
    Some((detachment, way))
}
