//! A trajectory seen at points along the whisker.

use crate::rod::{Rest, Rod, arclength};
use crate::shooting::{
    Bent, Graded, Intrinsic, Material, Measured, Nystrom8, Resolution, RodSystem, Scales, Section,
    Shape, Spiral, State, integrate,
};
use glam::DVec2;

/// The whisker at one of its points, as seen from the contact, in axes whose second one is along the force; lengths in whisker
/// lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RodPoint {
    /// Arclength from the base.
    pub arclength: f64,
    /// Position.
    pub position: DVec2,
    /// Unit tangent.
    pub tangent: DVec2,
    /// `dtheta/ds`.
    pub curvature: f64,
    /// Bending moment, in `E I_base/L_w`; 0 beyond the contact.
    pub moment: f64,
}

/// The points at growing arclengths `at` of the whisker in contact at `tau` under `load`; beyond the contact it keeps
/// its rest shape.
#[must_use]
pub fn profile(
    rod: &Rod,
    tau: f64,
    load: f64,
    resolution: Resolution,
    at: &[f64],
) -> Vec<RodPoint> {
    let (radius, contact) = (rod.radius(tau), arclength(rod, tau));
    let way = Way {
        rod,
        tau,
        contact,
        force: load * radius * radius,
        tangent: rod.contact_tangent(),
        steps: resolution.steps(rod, tau, load),
    };
    match rod.spiral {
        Some([at_base, slope]) => way.points(Spiral { at_base, slope }, (), at),
        None => {
            let twice_bend = 2.0 * rod.bend;
            let rest = Rest::parabola_tangent(rod, contact).to_array();
            way.points(Bent { twice_bend }, rest, at)
        }
    }
}

/// The way from a contact to the base.
struct Way<'a> {
    rod: &'a Rod,
    /// `tau` of the contact.
    tau: f64,
    /// Arclength of the contact.
    contact: f64,
    /// The whole force, signed.
    force: f64,
    /// The whisker's tangent at the contact.
    tangent: DVec2,
    /// Steps that the whole way would take, or a piece of a profile.
    steps: u32,
}

impl Way<'_> {
    fn points<I: Intrinsic<f64>>(&self, intrinsic: I, rest: I::State, at: &[f64]) -> Vec<RodPoint> {
        let deflected = at.partition_point(|s| *s < self.contact);
        let tangent = self.tangent;
        let mut state: State<f64, I, Shape> = (
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
        mut state: State<f64, I, Shape>,
    ) -> State<f64, I, Shape> {
        let gradient = self.rod.gradient;
        let Some(profile) = &self.rod.profile else {
            return self.integrate(intrinsic, Graded { gradient }, self.tau, (from, to), state);
        };
        let mut ahead = self.tau;
        let pieces = &profile.pieces[..=self.rod.piece(self.contact)];
        for piece in pieces.iter().rev() {
            let begin = self.rod.tau(piece.from);
            let (whole, end) = (ahead - begin, begin.max(to));
            ahead = begin;
            if end < from {
                let material = Measured {
                    from: piece.from,
                    cubic: piece.cubic,
                    gradient,
                };
                state = self.integrate(intrinsic, material, whole, (from, end), state);
                from = end;
            }
        }
        state
    }

    /// Takes the share of the steps over `whole` that the part from `from` to `to` has.
    fn integrate<I: Intrinsic<f64>, C: Material<f64>>(
        &self,
        intrinsic: I,
        material: C,
        whole: f64,
        (from, to): (f64, f64),
        state: State<f64, I, Shape>,
    ) -> State<f64, I, Shape> {
        let share = f64::from(self.steps) * (from - to) / whole;
        let steps = (share.ceil() as u32).max(1);
        let h = (from - to) / f64::from(steps);
        let rho = self.rod.radius(from);
        let section = Section {
            rho,
            inverse_cube: 1.0 / (rho * rho * rho),
            arclength: arclength(self.rod, from),
        };
        let system = RodSystem {
            force: self.force,
            intrinsic,
            material,
        };
        let scales = Scales::tapered::<Nystrom8>(self.rod.taper, h);
        integrate::<Nystrom8, f64, _, _, Shape>(&system, &scales, section, steps, state)
    }

    fn loaded(&self, s: f64, [c, sin, x, y, _]: [f64; 5]) -> RodPoint {
        let moment = -self.force * x;
        RodPoint {
            arclength: s,
            position: DVec2::new(x, y),
            tangent: DVec2::new(c, sin),
            curvature: Rest::new(self.rod).curvature(s) + moment / self.rod.stiffness(s),
            moment,
        }
    }

    fn free(&self, s: f64) -> RodPoint {
        let rest = Rest::new(self.rod);
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
