//! Detachments between frames, for `fit`.

use super::frame_curve::NearestPlace;
use super::{CurvedFrame, Remarks, TrackedFrame};
use crate::quantile::median;
use crate::trace::row;
use glam::DVec2;
use serde::Serialize;
use whiskmap_mechanics::rod::Side;

row! {
    /// Detachment between two frames, with the columns that `fit` reads.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct TrackedDetachment {
        pub side: Side,
        /// Distance from the base to the contact at first touch, in mm: of the whisker without load, at the distance of the pole in the last frame in
        /// contact.
        pub distance_mm: f64,
        /// Rotation of the base against the direction of the pole from first touch to detachment, in degrees: positive CB, negative CF. The detachment is
        /// in the middle between two frames.
        pub push_angle_deg: f64,
        /// Time of the last frame in contact, in s.
        pub time_s: f64,
    }
}

/// Most frames before first touch that show the whisker without load.
const FREE: usize = 5;

/// Returns the contacts that end with the pole on the other side of the whisker. A contact counts if the frames before and after it are known
/// to be without contact, and those before it show the whisker at the distance of the pole. A note gives the number of the others. A gap in a
/// contact counts as contact, unless it has the pole on other sides before and after.
pub(super) fn detachments(
    curves: &[CurvedFrame],
    rows: &[TrackedFrame],
    places: &[Option<NearestPlace>],
    remarks: &mut Remarks,
) -> Vec<TrackedDetachment> {
    let known = |(i, row): (usize, &TrackedFrame)| Some((i, row.contact? == 1));
    let known: Vec<(usize, bool)> = rows.iter().enumerate().filter_map(known).collect();
    let film = Film { curves, rows, places };
    let mut found = Vec::new();
    let mut touch: Option<usize> = None;
    let mut left_out = 0;
    for pair in known.windows(2) {
        let [(before, was_in_contact), (after, is_in_contact)] = [pair[0], pair[1]];
        // A gap before the first touch or after the last one hides when it was.
        let is_shown = after == before + 1;
        match (was_in_contact, is_in_contact) {
            (false, true) => touch = is_shown.then_some(after),
            (true, false) => match touch.take().filter(|_| is_shown) {
                Some(touch) if film.is_left(touch - 1) == film.is_left(after) => {}
                Some(touch) => match film.detachment(touch, after) {
                    Some(detachment) => found.push(detachment),
                    None => left_out += 1,
                },
                None => left_out += 1,
            },
            // The gap hides the end of one contact and the first touch of another one.
            (true, true) if !is_shown && film.is_left(before) != film.is_left(after) => {
                touch = None;
                left_out += 1;
            }
            _ => {}
        }
    }
    left_out += u32::from(known.last().is_some_and(|(_, is_in_contact)| *is_in_contact));
    if left_out > 0 {
        remarks.notes.push(format!(
            "contacts that give no detachment: {left_out} (first touch or end next to a gap or outside the film, or a trace that ends before the pole)"
        ));
    }
    found
}

/// Frames with their curves, rows and nearest places to the pole, `[frame]`.
struct Film<'a> {
    curves: &'a [CurvedFrame],
    rows: &'a [TrackedFrame],
    places: &'a [Option<NearestPlace>],
}

impl Film<'_> {
    /// Returns true if the pole is on the left of the whisker in a frame; `None` if that is not known.
    fn is_left(&self, frame: usize) -> Option<bool> {
        self.places[frame].map(|place| place.offset_mm > 0.0)
    }

    /// Returns the pole's centre in a frame, seen from the base and its tangent, in mm.
    fn pole_mm(&self, frame: usize) -> Option<DVec2> {
        let CurvedFrame { curve, pole_mm, .. } = &self.curves[frame];
        Some(curve.as_ref().ok()?.seen_from_base((*pole_mm)?))
    }

    /// Returns the detachment after a contact that begins with frame `touch` and ends before frame `end`. The push turns the pole, as seen from the
    /// base and its tangent: from first touch of the whisker without load, at the distance that the pole has in the end.
    fn detachment(&self, touch: usize, end: usize) -> Option<TrackedDetachment> {
        let last = self.pole_mm(end - 1)?;
        // The pole's radius, as the frames in contact show it.
        let held = self.rows.iter().zip(self.places).filter(|(row, _)| row.contact == Some(1));
        let offset_mm = median(held.filter_map(|(_, place)| Some(place.as_ref()?.offset_mm.abs())));
        let is_left = self.is_left(touch - 1)?;
        let offset_mm = if is_left { offset_mm } else { -offset_mm };
        let free = (0..touch).rev().take_while(|&i| self.rows[i].contact == Some(0)).take(FREE);
        let touched = free.filter_map(|i| {
            let curve = self.curves[i].curve.as_ref().ok()?;
            let direction = self.pole_mm(i)?.normalize_or_zero();
            curve.first_touch(last.length() * direction, offset_mm)
        });
        let touched: Vec<[DVec2; 2]> = touched.collect();
        if touched.is_empty() {
            return None;
        }
        let count = touched.len() as f64;
        let mean = |of: &dyn Fn(&[DVec2; 2]) -> f64| touched.iter().map(of).sum::<f64>() / count;
        // The pole turns by less than half a turn from frame to frame.
        let places: Vec<DVec2> = (touch..end).filter_map(|i| self.pole_mm(i)).collect();
        let turned: f64 = places.windows(2).map(|pair| pair[0].angle_to(pair[1])).sum();
        // The detachment is between the last frame in contact and the next one.
        let turned = turned + 0.5 * last.angle_to(self.pole_mm(end)?);
        let push = turned - mean(&|[pole, _]| places[0].angle_to(*pole));
        Some(TrackedDetachment {
            side: if is_left { Side::Cf } else { Side::Cb },
            distance_mm: mean(&|[_, other]| other.length()),
            push_angle_deg: push.to_degrees(),
            time_s: self.rows[end - 1].time_s,
        })
    }
}
