//! Detachment curves: where pushes from first touch end, distance by distance.

use crate::classify::RowBoundary;
use crate::rod::{Rest, Side};
use crate::scene::{Pole, Whisker};
use crate::sheet::{Edge, Sheet};
use crate::shooting::Reader;
use crate::shooting::batch::{Batch, InitialCondition, Method};
use crate::shooting::{FirstVariation, Resolution};
use serde::Serialize;

/// How a push from first touch ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// At the fold.
    SlipOff,
    /// With the tip at the pole.
    PullOff,
    /// It never begins: the resting whisker does not reach the pole.
    OutOfReach,
    /// The boundary was not found.
    Unresolved,
}

/// The end of a push at one distance; without values where there is none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Detachment {
    /// The side.
    pub side: Side,
    /// From the base to the contact at first touch.
    pub distance_mm: f64,
    /// From the base to the pole's centre.
    pub pole_distance_mm: f64,
    /// How the push ends.
    pub kind: Kind,
    /// Rotation of the base since first touch.
    pub push_angle_deg: Option<f64>,
    /// The push angle of the paper's Fig. 1D.
    pub push_chord_deg: Option<f64>,
    /// From the base to the contact.
    pub contact_distance_mm: Option<f64>,
    /// The same along the whisker.
    pub arc_length_mm: Option<f64>,
    /// Between pole and whisker.
    pub force_un: Option<f64>,
    /// That the pole puts on the base, along its tangent.
    pub base_force_x_un: Option<f64>,
    /// The same across its tangent.
    pub base_force_y_un: Option<f64>,
    /// The same as a moment.
    pub base_moment_nnm: Option<f64>,
    /// Of the tangent at the contact, from the base's tangent.
    pub contact_angle_deg: Option<f64>,
    /// Remaining error relative to the distance of the pole.
    pub residual: Option<f64>,
}

/// Where slip-off turns into pull-off, if it does: the fold with the contact at the tip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Corner {
    /// The side.
    pub side: Side,
    /// From the base to the contact at first touch.
    pub distance_mm: Option<f64>,
    /// Rotation of the base since first touch.
    pub push_angle_deg: Option<f64>,
}

/// The detachment curve of `whisker` on one side of `pole`, at growing `distances_mm`.
#[must_use]
pub fn curve(whisker: &Whisker, pole: &Pole, side: Side, distances_mm: &[f64]) -> Vec<Detachment> {
    curve_at(Resolution::FINE, whisker, pole, side, distances_mm)
}

/// The same at another resolution.
#[must_use]
pub fn curve_at(
    resolution: Resolution,
    whisker: &Whisker,
    pole: &Pole,
    side: Side,
    distances_mm: &[f64],
) -> Vec<Detachment> {
    let rod = whisker.rod(pole, side);
    let method = Method::new(resolution);
    let reader = Reader::new(whisker.units(), &rod);
    let rest = Rest::new(&rod);
    let distances: Vec<f64> = distances_mm.iter().map(|d| d / whisker.length_mm).collect();
    let sheet = Sheet::new(method, &rod, side, &distances);
    let mut rows: Vec<Detachment> = distances_mm
        .iter()
        .zip(&distances)
        .map(|(distance_mm, distance)| {
            let pole = rest.pole_at_distance(*distance).length() * whisker.length_mm;
            blank(side, *distance_mm, pole)
        })
        .collect();
    let Some(sheet) = sheet else {
        return rows;
    };
    let mut ends = Vec::new();
    for (i, row) in rows.iter_mut().enumerate() {
        let boundary = RowBoundary::new(sheet.touches(i), &sheet.crossings[i]);
        if !sheet.touches(i) {
            row.kind = Kind::OutOfReach;
        } else if let (Some(_), Some(end)) = (boundary.detachment(), sheet.crossings[i].first()) {
            ends.push((i, end));
        }
    }
    let conditions: Vec<InitialCondition> = ends
        .iter()
        .map(|(_, end)| InitialCondition {
            rod: &rod,
            tau: end.tau,
            load: end.load,
        })
        .collect();
    let states = Batch::new(method).shoot::<FirstVariation>(&conditions);
    for ((i, end), FirstVariation { full, .. }) in ends.into_iter().zip(&states) {
        let push = side.sign() * end.push;
        // The crossing's own residual foretells what its last step leaves; this trajectory has gone there.
        let distance = full.map.pole.length();
        let off = (sheet.rows[i].pole_distance / distance).ln().abs();
        let reading = reader.read(end.tau, full, sheet.rows[i].touch, push);
        rows[i] = Detachment {
            kind: match end.edge {
                Edge::Fold => Kind::SlipOff,
                Edge::Tip => Kind::PullOff,
            },
            push_angle_deg: Some(push.to_degrees()),
            push_chord_deg: Some(reading.push_chord_deg),
            contact_distance_mm: Some(reading.contact_distance_mm),
            arc_length_mm: Some(reading.arc_length_mm),
            force_un: Some(reading.force_un),
            base_force_x_un: Some(reading.base_force_un.x),
            base_force_y_un: Some(reading.base_force_un.y),
            base_moment_nnm: Some(reading.base_moment_nnm),
            contact_angle_deg: Some(reading.contact_angle_deg),
            residual: Some(end.residual + off),
            ..rows[i]
        };
    }
    rows
}

fn blank(side: Side, distance_mm: f64, pole_distance_mm: f64) -> Detachment {
    Detachment {
        side,
        distance_mm,
        pole_distance_mm,
        kind: Kind::Unresolved,
        push_angle_deg: None,
        push_chord_deg: None,
        contact_distance_mm: None,
        arc_length_mm: None,
        force_un: None,
        base_force_x_un: None,
        base_force_y_un: None,
        base_moment_nnm: None,
        contact_angle_deg: None,
        residual: None,
    }
}

/// The corner of `whisker` on one side of `pole`; without values where there is none: a perfect cone always slips off,
/// and other whiskers may be too short to be pulled off.
#[must_use]
pub fn corner(whisker: &Whisker, pole: &Pole, side: Side) -> Corner {
    let rod = whisker.rod(pole, side);
    let length = whisker.length_mm;
    let end = |distance: f64| curve(whisker, pole, side, &[distance])[0];
    let switches = |distance: &f64| {
        let kinds = [-1.0, 1.0].map(|sign| end(distance + sign * CORNER_TOLERANCE * length).kind);
        kinds == [Kind::SlipOff, Kind::PullOff]
    };
    let tip = (rod.taper < 1.0).then(|| Sheet::fold_at_tip(Method::fine(), &rod, side));
    let distance = tip.flatten().and_then(|fold| {
        let pole = fold.variation.map.pole.length();
        let at_tip = Rest::new(&rod).distance_of_pole(pole) * length;
        Some(at_tip)
            .filter(switches)
            .or_else(|| switch(&end, length, rod.pole.abs()))
    });
    let push = distance.and_then(|distance| end(distance).push_angle_deg);
    Corner {
        side,
        distance_mm: distance.filter(|_| push.is_some()),
        push_angle_deg: push,
    }
}

/// Half the width, in whisker lengths, of the gap in which slip-off must turn into pull-off.
const CORNER_TOLERANCE: f64 = 1e-10;

/// Samples among which the switch is looked for where it is not at the fold with the contact at the tip.
const CORNER_SAMPLES: u32 = 128;

/// The distance at which slip-off turns into pull-off, by bisection: with friction it can lie where the branches of two
/// poles swap their ends. No pole is nearer than `nearest`, in whisker lengths.
fn switch(end: &impl Fn(f64) -> Detachment, length: f64, nearest: f64) -> Option<f64> {
    let samples: Vec<f64> = (1..=CORNER_SAMPLES)
        .map(|i| nearest + (1.0 - nearest) * f64::from(i) / f64::from(CORNER_SAMPLES))
        .map(|distance| distance * length)
        .collect();
    let pulled = samples.iter().position(|d| end(*d).kind == Kind::PullOff)?;
    let (mut low, mut high) = (samples[pulled.checked_sub(1)?], samples[pulled]);
    while high - low > CORNER_TOLERANCE * length {
        let middle = 0.5 * (low + high);
        match end(middle).kind {
            Kind::SlipOff => low = middle,
            Kind::PullOff => high = middle,
            Kind::OutOfReach | Kind::Unresolved => return None,
        }
    }
    Some(low)
}
