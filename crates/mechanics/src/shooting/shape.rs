//! Shapes of deflected whiskers, as points along them.

use crate::rod::{Rest, Rod, arclength};
use crate::shooting::{
    BackwardCompliance, Bent, Graded, Intrinsic, Measured, NoSensitivity, Nystrom8, PieceSteps,
    Polynomial, Resolution, RodSystem, Scales, Section, Spiral, TrajectoryState, collocate,
    integrate,
};
use glam::DVec2;

/// A point of a deflected whisker. The frame's origin is the contact; its second axis is along the force. Lengths are in whisker lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RodPoint {
    /// Arclength of the point from the base, in whisker lengths.
    pub arclength: f64,
    /// Position of the point in the frame of the contact, in whisker lengths.
    pub position: DVec2,
    /// Unit tangent of the whisker at the point, in the frame of the contact.
    pub tangent: DVec2,
    /// Curvature `dtheta/ds` of the whisker at the point, in radians per whisker length.
    pub curvature: f64,
    /// Bending moment at the point, in `E I_base/L_w`; 0 beyond the contact.
    pub moment: f64,
}

/// Returns points of the whisker with the contact at `tau` under the signed `load`, `[point]`, one at each of the growing arclengths `at` (whisker
/// lengths). Beyond the contact the whisker keeps its rest shape.
#[must_use]
pub fn profile(
    rod: &Rod,
    tau: f64,
    load: f64,
    resolution: Resolution,
    at: &[f64],
) -> Vec<RodPoint> {
    let (radius, contact) = (rod.radius(tau), arclength(rod, tau));
    let trajectory = ShapeTrajectory {
        rod,
        rest: Rest::new(rod),
        tau,
        contact,
        force: load * radius * radius,
        tangent: rod.contact_tangent(),
        steps: resolution.steps(rod, tau, load),
        pieces: resolution.of_pieces(rod, tau, load),
    };
    if let Some(polynomial) = &rod.polynomial {
        let centred = *polynomial.centred();
        return trajectory.points(Polynomial { centred }, (), at);
    }
    match rod.spiral {
        Some([at_base, slope]) => trajectory.points(Spiral { at_base, slope }, (), at),
        None => {
            let twice_bend = 2.0 * rod.bend;
            let rest = Rest::parabola_tangent(rod, contact).to_array();
            trajectory.points(Bent { twice_bend }, rest, at)
        }
    }
}

/// Number and length of the steps over a `part` of `whole`, which takes `steps`.
fn share(steps: u32, whole: f64, part: f64) -> (u32, f64) {
    let steps = ((f64::from(steps) * part / whole).ceil() as u32).max(1);
    (steps, part / f64::from(steps))
}

/// A trajectory from a contact to the base, to be evaluated at points between.
struct ShapeTrajectory<'a> {
    rod: &'a Rod,
    rest: Rest,
    /// `tau` of the contact.
    tau: f64,
    /// Arclength of the contact.
    contact: f64,
    /// Signed force, with friction.
    force: f64,
    /// Unit tangent of the whisker at the contact.
    tangent: DVec2,
    /// Steps of the whole trajectory, or of a piece of a profile that does all the bending.
    steps: u32,
    /// Steps along the pieces of a profile.
    pieces: PieceSteps,
}

impl ShapeTrajectory<'_> {
    fn points<I: Intrinsic<f64>>(&self, intrinsic: I, rest: I::State, at: &[f64]) -> Vec<RodPoint> {
        let deflected = at.partition_point(|s| *s < self.contact);
        let tangent = self.tangent;
        let mut state: TrajectoryState<f64, I, NoSensitivity> = (
            rest,
            ([tangent.x, tangent.y, 0.0, 0.0, 0.0], ((), ((), ()))),
        );
        let mut from = self.tau;
        let mut points: Vec<RodPoint> = at[..deflected]
            .iter()
            .rev()
            .map(|s| {
                let to = self.rod.tau(*s);
                state = self.advance(intrinsic, (from, to), state);
                from = to;
                let (_, (rod, _)) = state;
                self.loaded(*s, rod)
            })
            .collect();
        points.reverse();
        points.extend(at[deflected..].iter().map(|s| self.free(*s)));
        points
    }

    /// Integrates `state` from one `tau` back to a smaller one, piece by piece.
    fn advance<I: Intrinsic<f64>>(
        &self,
        intrinsic: I,
        (mut from, to): (f64, f64),
        mut state: TrajectoryState<f64, I, NoSensitivity>,
    ) -> TrajectoryState<f64, I, NoSensitivity> {
        let gradient = self.rod.gradient;
        let Some(profile) = &self.rod.profile else {
            let (steps, h) = share(self.steps, self.tau, from - to);
            let system = self.system(intrinsic, Graded { gradient });
            let scales = Scales::tapered::<Nystrom8>(self.rod.taper, h);
            let section = self.section(from);
            return integrate::<Nystrom8, f64, _, _, NoSensitivity>(
                &system, &scales, section, steps, state,
            );
        };
        let mut ahead = self.tau;
        let last = self.rod.piece(self.contact);
        for (k, piece) in profile.pieces[..=last].iter().enumerate().rev() {
            let (whole, end) = (ahead - piece.tau, piece.tau.max(to));
            ahead = piece.tau;
            if end < from {
                let steps = self.pieces.of(profile, k);
                let (steps, h) = share(steps, whole, from - end);
                let material = Measured {
                    from: piece.from,
                    cubic: piece.cubic,
                    gradient: Some(gradient),
                };
                let system = self.system(intrinsic, material);
                let scales = Scales::tapered::<Nystrom8>(self.rod.taper, h);
                let mut section = self.section(from);
                for _ in 0..steps {
                    let computed = BackwardCompliance {
                        material: &material,
                        from: section.arclength,
                        length: section.rho * scales.end().along,
                    };
                    state = collocate::<f64, _, NoSensitivity>(
                        &system,
                        scales.end(),
                        &section,
                        &computed.weights(),
                        state,
                    );
                    section = section.at(scales.end());
                }
                from = end;
            }
        }
        state
    }

    fn system<I, C>(&self, intrinsic: I, material: C) -> RodSystem<f64, I, C> {
        RodSystem {
            force: self.force,
            intrinsic,
            material,
        }
    }

    fn section(&self, tau: f64) -> Section<f64> {
        let rho = self.rod.radius(tau);
        Section {
            rho,
            inverse_cube: 1.0 / (rho * rho * rho),
            arclength: arclength(self.rod, tau),
        }
    }

    fn loaded(&self, s: f64, [c, sin, x, y, _]: [f64; 5]) -> RodPoint {
        let moment = -self.force * x;
        RodPoint {
            arclength: s,
            position: DVec2::new(x, y),
            tangent: DVec2::new(c, sin),
            curvature: self.rest.curvature(s) + moment / self.rod.stiffness(s),
            moment,
        }
    }

    fn free(&self, s: f64) -> RodPoint {
        let rest = &self.rest;
        let (from, axis) = rest.at_arclength(self.contact);
        let (to, tangent) = rest.at_arclength(s);
        let turn = self.tangent.rotate(DVec2::new(axis.x, -axis.y));
        RodPoint {
            arclength: s,
            position: turn.rotate(to - from),
            tangent: turn.rotate(tangent),
            curvature: rest.curvature(s),
            moment: 0.0,
        }
    }
}
