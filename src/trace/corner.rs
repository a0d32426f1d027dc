//! Corners of detachment curves, where slip-off turns into pull-off.

use super::columns::row;
use super::curve::{Detachment, DetachmentKind, ends_at};
use crate::scene::{Pole, Whisker};
use crate::sheet::Sheet;
use serde::Serialize;
use whiskmap_mechanics::numerics::{Bracket, WIDTH};
use whiskmap_mechanics::rod::{Rest, Side};
use whiskmap_mechanics::shooting::Resolution;
use whiskmap_mechanics::shooting::batch::Method;

row! {
    /// Corner of a detachment curve: the end at which slip-off turns into pull-off, the fold with the contact at the tip.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct Corner {
        pub side: Side,
        pub distance_mm: Option<f64>,
        pub push_angle_deg: Option<f64>,
        /// Without a corner: always-slips-off, always-pulls-off, not-found or no-whisker.
        pub reason: Option<NoCorner>,
    }
}

/// Reason why a detachment curve has no corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoCorner {
    /// No corner exists: every push that begins ends at the fold, as with most perfect cones and with whiskers that bend away from the pole.
    AlwaysSlipsOff,
    /// No corner exists: every push that begins ends at the tip.
    AlwaysPullsOff,
    /// No corner was found: the fold with the contact at the tip, or an end next to it, is missing, as next to the point of a perfect cone that is
    /// pulled off. With a tip of 1e-4 of the base radius, such a cone has a corner.
    NotFound,
    /// The row of the table of whiskers has no whisker.
    NoWhisker,
}

impl Corner {
    /// Returns the corner of a row of a table that has no whisker.
    #[must_use]
    pub const fn without_whisker(side: Side) -> Self {
        Self { side, distance_mm: None, push_angle_deg: None, reason: Some(NoCorner::NoWhisker) }
    }
}

/// Computes the corner of the detachment curve of `whisker` on one `side`. Without a corner, distance and push angle are `None`, and
/// `reason` says why.
#[must_use]
pub fn corner(whisker: &Whisker, pole: &Pole, side: Side) -> Corner {
    let ends = |distances_mm: &[f64]| ends_at(Resolution::FINE, whisker, pole, side, distances_mm);
    let found = corner_distance(whisker, pole, side, &ends).and_then(|distance| {
        let push = ends(&[distance])[0].push_angle_deg;
        Ok((distance, push.ok_or(NoCorner::NotFound)?))
    });
    let (distance_mm, push_angle_deg) = found.ok().unzip();
    Corner { side, distance_mm, push_angle_deg, reason: found.err() }
}

/// Distance of the corner, in mm: at the fold with the contact at the tip if the ends next to it agree, else by multisection.
fn corner_distance(
    whisker: &Whisker,
    pole: &Pole,
    side: Side,
    ends: &impl Fn(&[f64]) -> Vec<Detachment>,
) -> Result<f64, NoCorner> {
    let rod = whisker.rod(pole, side);
    let (rest, length) = (Rest::new(&rod), whisker.length_mm);
    // A perfect cone is cut a billionth of its length before its point: a corner at the cut is none of the cone.
    let is_pointed = rod.taper >= 1.0;
    let fold = Sheet::fold_at_tip(Method::fine(), &rod, side).filter(|_| !is_pointed);
    if let Some(fold) = fold {
        let at_tip = rest.distance_of_pole(fold.variation.map.pole.length()) * length;
        let beside = [-1.0, 1.0].map(|sign| at_tip + sign * CORNER_TOLERANCE * length);
        let kinds: Vec<DetachmentKind> = ends(&beside).iter().map(|end| end.kind).collect();
        if kinds == [DetachmentKind::SlipOff, DetachmentKind::PullOff] {
            return Ok(at_tip);
        }
    }
    switch(ends, length, [rod.pole.abs(), rest.reach()])
}

/// Half the width of the interval of distances in which slip-off must turn into pull-off, in whisker lengths.
const CORNER_TOLERANCE: f64 = 1e-10;

/// Number of distances at which ends are computed to bracket a corner that is not at the fold with the contact at the tip.
const CORNER_SAMPLES: u32 = 128;

/// Distance at which slip-off turns into pull-off, in the unit of `length`, by multisection. With friction two branches can exchange their
/// ends there. The search is between the `nearest` distance and the `farthest`, in whisker lengths.
fn switch(
    ends: &impl Fn(&[f64]) -> Vec<Detachment>,
    length: f64,
    [nearest, farthest]: [f64; 2],
) -> Result<f64, NoCorner> {
    // Pushes end at the tip at the farthest distances, if at any: the samples are dense there.
    let samples: Vec<f64> = (1..CORNER_SAMPLES)
        .map(|i| f64::from(i) / f64::from(CORNER_SAMPLES))
        .map(|part| nearest + (farthest - nearest) * (1.0 - (1.0 - part).powi(3)))
        .map(|distance| distance * length)
        .collect();
    let is_pulled = |end: &Detachment| end.kind == DetachmentKind::PullOff;
    let sampled = ends(&samples);
    let pulled = sampled.iter().position(is_pulled).ok_or_else(|| {
        let is_unknown = |end: &Detachment| end.kind == DetachmentKind::Unresolved;
        if sampled.iter().any(is_unknown) { NoCorner::NotFound } else { NoCorner::AlwaysSlipsOff }
    })?;
    let before = pulled.checked_sub(1).ok_or(NoCorner::AlwaysPullsOff)?;
    let mut bracket = Bracket { below: samples[before], above: samples[pulled] };
    bracket.multisect(CORNER_TOLERANCE * length, WIDTH, |distances| {
        let ends = ends(distances);
        let slipped = ends.iter().take_while(|end| end.kind == DetachmentKind::SlipOff);
        let slipped = slipped.count();
        match ends.get(slipped) {
            Some(end) if !is_pulled(end) => Err(NoCorner::NotFound),
            _ => Ok(slipped),
        }
    })?;
    Ok(bracket.below)
}
