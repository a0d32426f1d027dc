//! Rows of frames, for `whisk` and `force`.

use super::frame_curve::{FrameCurve, NearestPlace};
use super::options::{TrackingError, TrackingOptions, refused};
use super::rods::BESIDE;
use super::{CurvedFrame, Remarks};
use crate::quantile::median;
use crate::scene::{digits, rounded};
use crate::trace::row;
use rayon::prelude::*;
use serde::Serialize;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::numerics::nearest_turn;

/// Part of the median length at which the curvature is given if no arclength is.
const CURVATURE_AT: f64 = 0.25;

/// Reason why a frame is a gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoFrame {
    /// The tracker has lost the whisker or its base, or has too few points.
    Missing,
    /// The points lie along no smooth curve.
    NoCurve,
}

row! {
    /// Frame of a film, with the columns that `whisk` and `force` read. Numbers of a gap are empty.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct TrackedFrame {
        /// Number of the frame in the film.
        pub frame: u64,
        /// Time of the frame, in s: its number over the frames per second.
        pub time_s: f64,
        /// Angle of the base, in degrees: 0 in the frame that the notes name, positive pushes CB.
        pub angle_deg: Option<f64>,
        /// Curvature of the whisker at the arclength of at_arc_length_mm, in 1/mm; positive turns to the left, as a parabola does.
        pub curvature_per_mm: Option<f64>,
        /// Arclength from the base to the place of the curvature, in mm.
        pub at_arc_length_mm: Option<f64>,
        /// Position of this place along the base's tangent, in mm.
        pub at_x_mm: Option<f64>,
        /// Position of this place to the left of the base's tangent, in mm.
        pub at_y_mm: Option<f64>,
        /// 1 if the whisker is in contact with the pole, 0 if it is not; empty if that is not known.
        pub contact: Option<u8>,
        /// Position of the contact along the base's tangent, in mm; empty without contact.
        pub contact_x_mm: Option<f64>,
        /// Position of the contact to the left of the base's tangent, in mm; empty without contact.
        pub contact_y_mm: Option<f64>,
        /// Angle of the tangent at the contact, from the base's tangent, in degrees; empty without contact.
        pub contact_angle_deg: Option<f64>,
        /// Length of the traced whisker, in mm.
        pub length_mm: Option<f64>,
        /// Root mean square of the distances of the points from the curve, in mm.
        pub rms_mm: Option<f64>,
        /// Reason of a gap: missing or no-curve.
        pub reason: Option<NoFrame>,
    }
}

/// Computes the rows of all frames, and the nearest place to the pole in each; adds notes and warnings. If `cancel` becomes true, the remaining
/// rows have no numbers.
pub(super) fn frames(
    curves: &[CurvedFrame],
    options: &TrackingOptions,
    cancel: &AtomicBool,
    remarks: &mut Remarks,
) -> Result<(Vec<TrackedFrame>, Vec<Option<NearestPlace>>), TrackingError> {
    let Remarks { notes, warnings } = remarks;
    let known = || curves.iter().filter_map(|frame| frame.curve.as_ref().ok());
    let length_mm = median(known().map(|curve| curve.length_mm));
    let near_mm = median(known().map(FrameCurve::near_mm));
    let is_mean = known().any(|curve| curve.rms_mm.is_none());
    let at_mm = match options.curvature_at_mm {
        Some(mm) if (0.0..=near_mm).contains(&mm) => Some(mm),
        Some(mm) => {
            let must = format!(
                "must be between 0 and {}, the median length in mm of the part whose curvature is known",
                digits(rounded(near_mm, 4))
            );
            return Err(refused("curvature_at_mm", &digits(mm), must));
        }
        None if is_mean => {
            notes.push(
                "curvatures are the means of whiskers, given at half their length".to_owned(),
            );
            None
        }
        None => {
            let mm = rounded(CURVATURE_AT * length_mm, 2).min(near_mm);
            notes.push(format!(
                "curvatures are those at {} mm from the base, a quarter of the median length",
                digits(mm)
            ));
            Some(mm)
        }
    };
    let goes_on = || !cancel.load(Ordering::Relaxed);
    let places = curves.par_iter().map(|frame| {
        let curve = frame.curve.as_ref().ok().filter(|_| goes_on())?;
        Some(curve.nearest(frame.pole_mm?))
    });
    let places: Vec<Option<NearestPlace>> = places.collect();
    let within = options.contact_within_mm.unwrap_or_default();
    let mut angle = None;
    let mut angles = Vec::with_capacity(curves.len());
    for frame in curves {
        let turned = frame.curve.as_ref().ok().map(|curve| {
            // A positive angle pushes CB: the base turns clockwise.
            let turned = -curve.angle();
            angle.map_or(turned, |before| nearest_turn(turned, before))
        });
        angle = turned.or(angle);
        angles.push(turned);
    }
    let row = |((frame, place), angle): ((&CurvedFrame, &Option<NearestPlace>), &Option<f64>)| {
        let curve = frame.curve.as_ref().ok().filter(|_| goes_on());
        let at = curve.map(|curve| at_mm.unwrap_or(0.5 * curve.length_mm));
        let at = at.filter(|at| curve.is_some_and(|curve| *at <= curve.near_mm()));
        let position = curve.zip(at).map(|(curve, at)| curve.position_mm(at));
        let shown = place.filter(|_| curve.is_some_and(|curve| curve.shows_contact));
        let is_near = shown.map(|place| place.offset_mm.abs() <= within);
        let contact = place.filter(|_| is_near == Some(true));
        TrackedFrame {
            frame: frame.number,
            time_s: frame.number as f64 / options.fps,
            angle_deg: angle.map(f64::to_degrees),
            curvature_per_mm: curve.zip(at).map(|(curve, at)| curve.curvature_per_mm(at)),
            at_arc_length_mm: at,
            at_x_mm: position.map(|point| point.x),
            at_y_mm: position.map(|point| point.y),
            contact: is_near.map(u8::from),
            contact_x_mm: contact.map(|place| place.at_mm.x),
            contact_y_mm: contact.map(|place| place.at_mm.y),
            contact_angle_deg: contact.map(|place| place.angle.to_degrees()),
            length_mm: curve.map(|curve| curve.length_mm),
            rms_mm: curve.and_then(|curve| curve.rms_mm),
            reason: frame.curve.as_ref().err().copied(),
        }
    };
    let rows = curves.par_iter().zip(&places).zip(&angles).map(row);
    let mut rows: Vec<TrackedFrame> = rows.collect();
    let reach_mm = within + BESIDE * length_mm;
    warnings.extend(aside(&rows, &places, reach_mm));
    warnings.extend(hide_ahead(&mut rows, &places));
    let zero_deg = zero(&rows, options, notes)?;
    for row in &mut rows {
        row.angle_deg = row.angle_deg.map(|angle| angle - zero_deg);
    }
    count(&rows, notes);
    Ok((rows, places))
}

/// Returns a warning if no frame is within this distance of the pole's centre.
fn aside(rows: &[TrackedFrame], places: &[Option<NearestPlace>], reach_mm: f64) -> Option<String> {
    let pairs = rows.iter().zip(places);
    let all = pairs.filter_map(|(row, place)| Some((row.frame, place.as_ref()?.offset_mm.abs())));
    let (frame, least_mm) = all.min_by(|one, other| one.1.total_cmp(&other.1))?;
    (least_mm > reach_mm).then(|| {
        format!(
            "no frame comes near the pole: the whisker is {} mm or more from its centre (frame {frame}); check its position, whose y axis points downward, and `mm_per_pixel`",
            digits(rounded(least_mm, 2))
        )
    })
}

/// In a film without contact, removes that of frames whose whisker may reach the pole beyond its traced end; returns a warning.
fn hide_ahead(rows: &mut [TrackedFrame], places: &[Option<NearestPlace>]) -> Option<String> {
    if rows.iter().any(|row| row.contact == Some(1)) {
        return None;
    }
    let mut count = 0;
    for (row, _) in rows
        .iter_mut()
        .zip(places)
        .filter(|(row, place)| row.contact.is_some() && place.is_some_and(|place| place.is_ahead))
    {
        row.contact = None;
        count += 1;
    }
    (count > 0).then(|| {
        format!(
            "in {count} of {} frames, the pole is ahead of the end of the trace: contact is not known, and empty; trace the whisker past the pole",
            rows.len()
        )
    })
}

/// Returns the angle of the base in the frame whose angle is 0, in degrees.
fn zero(
    rows: &[TrackedFrame],
    options: &TrackingOptions,
    notes: &mut Vec<String>,
) -> Result<f64, TrackingError> {
    if let Some(time_s) = options.zero_s {
        let near = rows.iter().min_by(|one, other| {
            (one.time_s - time_s).abs().total_cmp(&(other.time_s - time_s).abs())
        });
        let near = near.filter(|row| (row.time_s - time_s).abs() <= 0.5001 / options.fps);
        return near.and_then(|row| row.angle_deg).ok_or_else(|| {
            let known = || rows.iter().filter(|row| row.angle_deg.is_some());
            let ends =
                [known().next(), known().next_back()].map(|row| row.map_or(0.0, |row| row.time_s));
            let must = format!(
                "must be the time of a frame with a whisker, between {} and {} s in steps of 1/{} s",
                digits(rounded(ends[0], 6)),
                digits(rounded(ends[1], 6)),
                digits(options.fps)
            );
            refused("zero_s", &digits(time_s), must)
        });
    }
    let touches = || {
        let pairs = rows.windows(2);
        pairs.filter(|pair| pair[0].contact == Some(0) && pair[1].contact == Some(1))
    };
    // On CB, the base turns on in the positive direction.
    let is_cb = |pair: &&[TrackedFrame]| pair[1].angle_deg > pair[0].angle_deg;
    let of_cb = touches().find(is_cb).map(|pair| (&pair[1], "first touch on CB"));
    let other = "first touch on CF; in `whisk`, angles are 0 at first touch on CB";
    let of_cf = || Some((touches().next()?.last()?, other));
    let any =
        || Some((rows.iter().find(|row| row.angle_deg.is_some())?, "the first one with a whisker"));
    let found = of_cb.or_else(of_cf).or_else(any);
    if let Some((row, what)) = found {
        notes.push(format!("angles of the base are 0 in frame {}, {what}", row.frame));
    }
    Ok(found.and_then(|(row, _)| row.angle_deg).unwrap_or_default())
}

/// Adds a note with the numbers of gaps, and of frames in contact.
fn count(rows: &[TrackedFrame], notes: &mut Vec<String>) {
    let all = rows.len();
    let of = |reason: NoFrame| rows.iter().filter(|row| row.reason == Some(reason)).count();
    let [missing, off] = [NoFrame::Missing, NoFrame::NoCurve].map(of);
    if missing + off > 0 {
        notes.push(format!(
            "{} of {all} frames are gaps: {missing} without base or enough points (missing), {off} along no smooth curve (no-curve)",
            missing + off
        ));
    }
    let is_known = rows.iter().any(|row| row.contact.is_some());
    if is_known {
        let touching = rows.iter().filter(|row| row.contact == Some(1)).count();
        notes.push(format!("{touching} of {all} frames are in contact"));
    }
}
