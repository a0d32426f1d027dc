//! Curve of a whisker at its pole: an elastic rod between base and contact, and its rest shape beyond.
//!
//! The curvature is that at rest plus the moment over the bending stiffness, which falls with the fourth power of the radius. Only the taper
//! and the shape at rest of a whisker enter, because forces are in units of the stiffness at the base. Lengths are in lengths of the whisker.
//!
//! The unknowns of a frame are `[x, y, angle]` of the base and, at the pole, arclength and force of the contact. The residuals are the distances
//! of the points across the curve, the distance of the first point from the base along the curve, and the distance of the pole's centre from
//! the normal of the contact. There is no friction, and the radius of the pole does not enter.

use crate::least_squares::{BoundedProblem, norm, search};
use crate::traced::unit;
use glam::DVec2;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::rod::{CurvaturePolynomial, Rest, Rod};
use whiskmap_mechanics::shooting::Resolution;
use whiskmap_mechanics::shooting::sensitivity::BaseDerivatives;
use whiskmap_mechanics::shooting::shape::{RodPoint, profile, varied_profile};

/// Steps of trajectories: their errors, 1e-6 of the length, are far below those of points.
const RESOLUTION: Resolution = Resolution::COARSE;

/// Relative change of the sum of squares, and of the unknowns, below which the iteration ends.
const TOLERANCE: f64 = 1e-9;

/// As `TOLERANCE`, of a first iteration at a fixed contact.
const COARSE: f64 = 1e-4;

/// Largest distance of the contact from the place of the pole along the line through the points, in lengths of the whisker.
const NEAR: f64 = 0.1;

/// Newton steps to the feet of the points on each curve, from places that are a few hundredths of the length away.
const FOOT_STEPS: usize = 2;

/// Largest place of a point along the whisker: beyond the tip, the curve is straight.
const LAST_PLACE: f64 = 1.2;

/// Range of the arclength of the contact, in lengths of the whisker.
const CONTACTS: [f64; 2] = [0.05, 0.999];

/// Largest load, times the squared arclength of the contact: more than twice that of any stable state.
const MOST_LOAD: f64 = 20.0;

/// Whisker of a film as a rod.
#[derive(Clone, Debug)]
pub(super) struct TrackedRod {
    rod: Rod,
    rest: Rest,
    /// Curvature at rest over the length.
    pub curvature: CurvaturePolynomial,
    /// Length from base to tip, in mm.
    pub length_mm: f64,
}

impl TrackedRod {
    /// Creates a whisker with this taper, curvature at rest over its length, and length in mm.
    pub fn new(taper: f64, curvature: CurvaturePolynomial, length_mm: f64) -> Self {
        let rod = Rod { taper, polynomial: Some(Arc::new(curvature)), ..Rod::default() };
        Self { rest: Rest::new(&rod), rod, curvature, length_mm }
    }

    /// Returns the radius at an arclength over that at the base.
    fn radius(&self, s: f64) -> f64 {
        1.0 - self.rod.taper * s
    }
}

/// Pose of a whisker, and its load.
#[derive(Clone, Copy, Debug)]
pub(super) struct BentPose {
    /// Position of the base, in lengths of the whisker.
    pub base: DVec2,
    /// Angle of the tangent at the base, in radians.
    pub angle: f64,
    /// Arclength of the contact in lengths of the whisker, and force in `E I_base/L^2`, positive CB; `None` for a whisker at rest.
    pub load: Option<[f64; 2]>,
}

/// Point of a curve, with the derivatives of its position by arclength and force of the contact.
#[derive(Clone, Copy, Debug)]
struct BentPoint {
    position: DVec2,
    tangent: DVec2,
    curvature: f64,
    by: [DVec2; 2],
}

/// Points of a curve, and its contact.
struct BentPoints {
    /// Points at the places, `[place]`.
    points: Vec<BentPoint>,
    /// Contact, and the derivatives of its tangent's angle by arclength and force.
    contact: Option<(BentPoint, [f64; 2])>,
}

impl BentPose {
    fn of(x: &[f64]) -> Self {
        Self {
            base: DVec2::new(x[0], x[1]),
            angle: x[2],
            load: x.get(3).zip(x.get(4)).map(|(s, force)| [*s, *force]),
        }
    }

    fn unknowns(&self) -> Vec<f64> {
        let pose = [self.base.x, self.base.y, self.angle];
        pose.into_iter().chain(self.load.into_iter().flatten()).collect()
    }

    /// Returns the pose with the base at the origin and its tangent along the first axis.
    const fn in_base_frame(&self) -> Self {
        Self { base: DVec2::ZERO, angle: 0.0, load: self.load }
    }

    /// Returns the position of the contact in the frame of the base, in lengths of the whisker, and the angle of the tangent there from the
    /// base's, in radians; `None` at rest.
    pub fn contact(&self, whisker: &TrackedRod) -> Option<(DVec2, f64)> {
        let BentPoint { position, tangent, .. } =
            self.in_base_frame().points(whisker, &[]).contact?.0;
        Some((position, libm::atan2(tangent.y, tangent.x)))
    }

    /// Returns the position at an arclength in the frame of the base, in lengths of the whisker, and the curvature in radians per length.
    pub fn at(&self, whisker: &TrackedRod, s: f64) -> (DVec2, f64) {
        let point = self.in_base_frame().points(whisker, &[s]).points[0];
        (point.position, point.curvature)
    }

    /// Points of the curve at growing places, in lengths of the whisker.
    fn points(&self, whisker: &TrackedRod, places: &[f64]) -> BentPoints {
        self.points_by(varied_profile, whisker, places)
    }

    /// Points as of [`Self::points`], without derivatives.
    fn plain_points(&self, whisker: &TrackedRod, places: &[f64]) -> BentPoints {
        let plain = |rod: &Rod, tau: f64, load: f64, resolution: Resolution, at: &[f64]| {
            let points = profile(rod, tau, load, resolution, at).into_iter();
            points.map(|point| (point, BaseDerivatives::default())).collect()
        };
        self.points_by(plain, whisker, places)
    }

    /// Points as of [`Self::points`], with the derivatives of the points of `profile` before the contact.
    fn points_by(
        &self,
        profile: impl Fn(&Rod, f64, f64, Resolution, &[f64]) -> Vec<(RodPoint, BaseDerivatives<f64>)>,
        whisker: &TrackedRod,
        places: &[f64],
    ) -> BentPoints {
        let TrackedRod { rod, rest, .. } = whisker;
        let base_tangent = unit(self.angle);
        let at_rest = |turn: DVec2, s: f64, from: DVec2| {
            let (position, tangent) = rest.at_arclength(s);
            (turn.rotate(position - from), turn.rotate(tangent))
        };
        let Some([contact, force]) = self.load else {
            let point = |s: &f64| {
                let (position, tangent) = at_rest(base_tangent, *s, DVec2::ZERO);
                BentPoint {
                    position: self.base + position,
                    tangent,
                    curvature: rest.curvature(*s),
                    by: [DVec2::ZERO; 2],
                }
            };
            return BentPoints { points: places.iter().map(point).collect(), contact: None };
        };
        let radius = whisker.radius(contact);
        let load = force / (radius * radius);
        let before = places.partition_point(|s| *s < contact);
        let mut at = vec![0.0];
        at.extend_from_slice(&places[..before]);
        let loaded = profile(rod, rod.tau(contact), load, RESOLUTION, &at);
        // Derivatives of angle and position by arclength and force of the contact, from those by tau and load.
        let by = |by_tau: [f64; 3], by_load: [f64; 3]| {
            let by_force = by_load.map(|derivative| derivative / (radius * radius));
            let by_contact = std::array::from_fn(|i| {
                (by_tau[i] + 2.0 * rod.taper * force * by_force[i]) / radius
            });
            [by_contact, by_force]
        };
        let (base, of_base) = &loaded[0];
        let base_by: [[f64; 3]; 2] = by(of_base.by_tau, of_base.by_load);
        let turn = DVec2::new(base.tangent.x, -base.tangent.y).rotate(base_tangent);
        let place = |position: DVec2, tangent: DVec2, curvature: f64, by: [DVec2; 2]| {
            let from_base = turn.rotate(position - base.position);
            let by = [0, 1].map(|i| {
                let [angle, x, y] = base_by[i];
                turn.rotate(by[i] - DVec2::new(x, y)) - angle * from_base.perp()
            });
            BentPoint {
                position: self.base + from_base,
                tangent: turn.rotate(tangent),
                curvature,
                by,
            }
        };
        let before = loaded[1..].iter().map(|(point, of_point)| {
            let point_by: [[f64; 3]; 2] = by(of_point.by_tau, of_point.by_load);
            let position_by = point_by.map(|[_, x, y]| DVec2::new(x, y));
            place(point.position, point.tangent, point.curvature, position_by)
        });
        let (from, axis) = rest.at_arclength(contact);
        let back = DVec2::new(axis.x, -axis.y);
        let at_contact = rest.curvature(contact);
        let beyond = places[loaded.len() - 1..].iter().map(|s| {
            let (position, tangent) = at_rest(back, *s, from);
            let by_contact = -DVec2::X - at_contact * position.perp();
            place(position, tangent, rest.curvature(*s), [by_contact, DVec2::ZERO])
        });
        BentPoints {
            points: before.chain(beyond).collect(),
            contact: Some((
                place(DVec2::ZERO, DVec2::X, at_contact, [DVec2::ZERO; 2]),
                base_by.map(|[angle, ..]| -angle),
            )),
        }
    }
}

/// Points of one frame, to which a curve is fitted, in lengths of the whisker.
pub(super) struct FramePoints {
    /// Points from base to tip, `[point]`.
    pub points: Vec<DVec2>,
    /// Centre of the pole.
    pub pole: DVec2,
    /// Growing places of the points along the whisker, `[point]`, right within a few hundredths; the first one is 0.
    pub places: Vec<f64>,
}

/// Fit of a curve to one frame, in lengths of the whisker.
pub(super) struct FrameFit {
    /// Pose and load of the whisker.
    pub pose: BentPose,
    /// Place of the last point along the whisker.
    pub end: f64,
    /// Distance of the pole's centre from the contact, positive on the whisker's left; `None` at rest, or where the pole is ahead of the tip.
    pub offset: Option<f64>,
    /// Residuals at the minimum: distances of the points, `[point]`, then those of base and pole.
    pub residuals: Vec<f64>,
    /// Number of points.
    count: usize,
}

impl FrameFit {
    /// Returns the distances of the points from the curve, `[point]`, in lengths of the whisker.
    pub fn distances(&self) -> &[f64] {
        &self.residuals[..self.count]
    }

    /// Returns the root mean square of the distances of the points, in lengths of the whisker.
    pub fn rms(&self) -> f64 {
        norm(self.distances()) / (self.count as f64).sqrt()
    }
}

/// Least squares of one frame.
struct FrameProblem<'a> {
    whisker: &'a TrackedRod,
    frame: &'a FramePoints,
    /// Range of the arclength of the contact; `None` for a whisker at rest.
    contacts: Option<[f64; 2]>,
    /// True if the pole's centre is on the normal of the contact.
    is_at_pole: bool,
    cancel: &'a AtomicBool,
}

/// Curve of a pose near the feet of the points.
struct Feet {
    curve: BentPoints,
    /// Place of the last foot.
    end: f64,
    residuals: Vec<f64>,
}

impl AsRef<[f64]> for Feet {
    fn as_ref(&self) -> &[f64] {
        &self.residuals
    }
}

impl FrameProblem<'_> {
    fn feet(&self, pose: &BentPose) -> Feet {
        let mut places = self.frame.places.clone();
        for _ in 0..FOOT_STEPS {
            let here = pose.plain_points(self.whisker, &places);
            let mut least = 0.0;
            let all = places.iter_mut().zip(&here.points);
            // The first point is at the base.
            for ((place, foot), point) in all.zip(&self.frame.points).skip(1) {
                let away = *point - foot.position;
                let slowed = 1.0 - foot.curvature * away.dot(foot.tangent.perp());
                let next = *place + away.dot(foot.tangent) / slowed.max(0.2);
                *place = next.clamp(least, LAST_PLACE);
                least = *place;
            }
        }
        let end = places.last().copied().unwrap_or_default();
        let curve = pose.points(self.whisker, &places);
        Feet { residuals: self.residuals_at(&curve), curve, end }
    }

    /// Returns the residuals of a curve near the feet of the points.
    fn residuals_at(&self, feet: &BentPoints) -> Vec<f64> {
        let points = &self.frame.points;
        let pairs = feet.points.iter().zip(points).enumerate();
        let across = pairs.map(|(i, (foot, point))| {
            let away = *point - foot.position;
            // The parabola of this curvature ends at the foot; that of the first point is at the base.
            let along = if i == 0 { 0.0 } else { away.dot(foot.tangent) };
            away.dot(foot.tangent.perp()) - 0.5 * foot.curvature * along * along
        });
        let base = &feet.points[0];
        let first = (points[0] - base.position).dot(base.tangent);
        let contact = feet.contact.as_ref().filter(|_| self.is_at_pole);
        let pole =
            contact.map(|(contact, _)| (self.frame.pole - contact.position).dot(contact.tangent));
        across.chain([first]).chain(pole).collect()
    }
}

impl BoundedProblem for FrameProblem<'_> {
    type Place = Feet;

    fn count(&self) -> usize {
        self.frame.points.len() + 1 + usize::from(self.is_at_pole)
    }

    fn residuals(&self, x: &[f64]) -> Option<Feet> {
        if !x.iter().all(|unknown| unknown.is_finite()) {
            return None;
        }
        let feet = self.feet(&BentPose::of(x));
        feet.residuals.iter().all(|residual| residual.is_finite()).then_some(feet)
    }

    fn jacobian(&self, x: &[f64], Feet { curve: feet, .. }: &Feet) -> Option<Vec<Vec<f64>>> {
        if self.cancel.load(Ordering::Relaxed) {
            return None;
        }
        let pose = BentPose::of(x);
        let mut columns = vec![Vec::with_capacity(self.count()); x.len()];
        // Row of the residual `axis . (point - foot)`. `across` is its derivative by the angle of the axis.
        let mut push = |axis: DVec2, foot: &BentPoint, across: f64, axis_by: [f64; 2]| {
            let turned = (foot.position - pose.base).perp();
            columns[0].push(-axis.x);
            columns[1].push(-axis.y);
            columns[2].push(across - axis.dot(turned));
            for ((column, by), position_by) in columns[3..].iter_mut().zip(axis_by).zip(foot.by) {
                column.push(by * across - axis.dot(position_by));
            }
        };
        for foot in &feet.points {
            push(foot.tangent.perp(), foot, 0.0, [0.0; 2]);
        }
        let across =
            |foot: &BentPoint, point: DVec2| (point - foot.position).dot(foot.tangent.perp());
        let base = &feet.points[0];
        push(base.tangent, base, across(base, self.frame.points[0]), [0.0; 2]);
        if let Some((contact, angle_by)) = feet.contact.as_ref().filter(|_| self.is_at_pole) {
            push(contact.tangent, contact, across(contact, self.frame.pole), *angle_by);
        }
        Some(columns)
    }

    fn ranges(&self, x: &[f64]) -> Vec<[f64; 2]> {
        let mut ranges = vec![[f64::NEG_INFINITY, f64::INFINITY]; 3];
        if let Some(contacts) = self.contacts {
            let contact = x[3].clamp(contacts[0], contacts[1]);
            let most = MOST_LOAD * (self.whisker.radius(contact) / contact).powi(2);
            ranges.extend([contacts, [-most, most]]);
        }
        ranges
    }
}

/// Load of a whisker to which a curve is fitted, with a guess of its arclength in lengths of the whisker.
#[derive(Clone, Copy, Debug)]
pub(super) enum FittedLoad {
    /// No load: the whisker is at rest.
    Rest,
    /// Load at the pole, which is near this arclength.
    Pole(f64),
    /// Load at this arclength, without a pole.
    Place(f64),
}

/// Fits a curve to a frame with this load. The angle of the base, in radians, is a guess.
///
/// # Errors
/// The reason why the iteration ends before it converges, as when `cancel` is true.
pub(super) fn fit(
    whisker: &TrackedRod,
    frame: &FramePoints,
    angle: f64,
    load: FittedLoad,
    cancel: &AtomicBool,
) -> Result<FrameFit, &'static str> {
    if cancel.load(Ordering::Relaxed) {
        return Err("it is cancelled");
    }
    let contact = match load {
        FittedLoad::Rest => None,
        FittedLoad::Pole(s) | FittedLoad::Place(s) => Some(s.clamp(CONTACTS[0], CONTACTS[1])),
    };
    let start = BentPose { base: frame.points[0], angle, load: contact.map(|s| [s, 0.0]) };
    let mut problem = FrameProblem {
        whisker,
        frame,
        contacts: contact.map(|s| [s; 2]),
        is_at_pole: matches!(load, FittedLoad::Pole(_)),
        cancel,
    };
    let mut guess = start.unknowns();
    let found = |problem: &FrameProblem, x: &[f64], tolerance: f64| {
        search(problem, x, tolerance, "it is cancelled").map(|(x, _)| x)
    };
    if let (FittedLoad::Pole(_), Some(contact)) = (load, contact) {
        // Far from the minimum, a contact that moves may leave the pole.
        guess = found(&problem, &guess, COARSE)?;
        let near = [contact - NEAR, contact + NEAR];
        problem.contacts = Some(near.map(|s| s.clamp(CONTACTS[0], CONTACTS[1])));
    }
    let x = found(&problem, &guess, TOLERANCE)?;
    let pose = BentPose::of(&x);
    let Feet { curve, end, residuals } = problem.feet(&pose);
    let is_beside =
        x.get(3).zip(problem.contacts).is_some_and(|(s, [least, most])| *s > least && *s < most);
    let contact = curve.contact.as_ref().filter(|_| is_beside);
    let offset = contact.map(|(contact, _)| {
        let away = frame.pole - contact.position;
        away.length().copysign(contact.tangent.perp_dot(away))
    });
    Ok(FrameFit { pose, end, offset, residuals, count: frame.points.len() })
}
