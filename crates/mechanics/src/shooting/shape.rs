//! Shapes of deflected whiskers, as points along them.

use crate::rod::{Rest, Rod, arclength};
use crate::shooting::contact::Contact;
use crate::shooting::sensitivity::{Arrival, BaseDerivatives, GeneralFirst, SensitivitySet};
use crate::shooting::{
    BackwardCompliance, Bent, Carried, Graded, Intrinsic, Measured, NoSensitivity, PieceSteps,
    Planar, Polynomial, Resolution, RodSystem, Scales, Section, Spiral, TrajectoryState, collocate,
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
    let trajectory = ShapeTrajectory::new(rod, tau, load, resolution);
    let (loaded, free) = at.split_at(trajectory.loaded_count(at));
    let states = trajectory.states::<NoSensitivity>(loaded);
    let states = loaded.iter().zip(states);
    let points = states.map(|(s, (state, _))| trajectory.loaded(*s, state));
    let free = free.iter().map(|s| trajectory.free(*s));
    points.chain(free).collect()
}

/// Returns the points of [`profile`] before the contact, `[point]`, each with the derivatives of its position and tangent by `tau` and load at a
/// fixed arclength, in the frame of the contact.
#[must_use]
pub fn varied_profile(
    rod: &Rod,
    tau: f64,
    load: f64,
    resolution: Resolution,
    at: &[f64],
) -> Vec<(RodPoint, BaseDerivatives<f64>)> {
    let trajectory = ShapeTrajectory::new(rod, tau, load, resolution);
    let loaded = &at[..trajectory.loaded_count(at)];
    let states = trajectory.states::<GeneralFirst>(loaded);
    let states = loaded.iter().zip(states);
    let varied = |(s, (state, carried)): (&f64, (Planar<f64>, _))| {
        // The carried derivatives hold at a fixed arclength all along the trajectory, not at the base alone.
        let arrival = Arrival { contact: trajectory.start(), taper: rod.taper, rod: state };
        let by = GeneralFirst::at_base(&arrival, carried);
        (trajectory.loaded(*s, state), by)
    };
    states.map(varied).collect()
}

/// Number and length of the steps over a `part` of `whole`, which takes `steps`.
fn share(steps: u32, whole: f64, part: f64) -> (u32, f64) {
    let steps = ((f64::from(steps) * part / whole).ceil() as u32).max(1);
    (steps, part / f64::from(steps))
}

/// State of a rod before the contact, with the derivatives that it carries.
type LoadedState<S> = (Planar<f64>, Carried<f64, S>);

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

impl<'a> ShapeTrajectory<'a> {
    fn new(rod: &'a Rod, tau: f64, load: f64, resolution: Resolution) -> Self {
        let radius = rod.radius(tau);
        Self {
            rod,
            rest: Rest::new(rod),
            tau,
            contact: arclength(rod, tau),
            force: load * radius * radius,
            tangent: rod.contact_tangent(),
            steps: resolution.steps(rod, tau, load),
            pieces: resolution.of_pieces(rod, tau, load),
        }
    }

    /// Returns the number of the growing arclengths `at` that are before the contact.
    fn loaded_count(&self, at: &[f64]) -> usize {
        at.partition_point(|s| *s < self.contact)
    }

    /// Returns the contact at which the trajectory starts. First derivatives need no slope of the curvature.
    fn start(&self) -> Contact<f64> {
        Contact {
            radius: self.rod.radius(self.tau),
            force: self.force,
            tangent: self.tangent.to_array(),
            stiffness: self.rod.stiffness(self.contact),
            curvature: self.rest.curvature(self.contact),
            curvature_slope: 0.0,
        }
    }

    /// Returns the states of the rod with the derivatives that they carry, `[point]`, at each of the growing arclengths `at` before the contact.
    fn states<S: SensitivitySet<f64>>(&self, at: &[f64]) -> Vec<LoadedState<S>> {
        if let Some(polynomial) = &self.rod.polynomial {
            let centred = *polynomial.centred();
            return self.states_on::<_, S>(Polynomial { centred }, (), at);
        }
        match self.rod.spiral {
            Some([at_base, slope]) => self.states_on::<_, S>(Spiral { at_base, slope }, (), at),
            None => {
                let twice_bend = 2.0 * self.rod.bend;
                let rest = Rest::parabola_tangent(self.rod, self.contact).to_array();
                self.states_on::<_, S>(Bent { twice_bend }, rest, at)
            }
        }
    }

    /// Returns the states of a rod of this rest shape, as [`ShapeTrajectory::states`] does.
    fn states_on<I: Intrinsic<f64>, S: SensitivitySet<f64>>(
        &self,
        intrinsic: I,
        rest: I::State,
        at: &[f64],
    ) -> Vec<LoadedState<S>> {
        let tangent = self.tangent;
        let rod = [tangent.x, tangent.y, 0.0, 0.0, 0.0];
        let mut state: TrajectoryState<f64, I, S> = (rest, (rod, S::start(&self.start())));
        let mut from = self.tau;
        let states = at.iter().rev().map(|s| {
            let to = self.rod.tau(*s);
            state = self.advance::<I, S>(intrinsic, (from, to), state);
            from = to;
            state.1
        });
        let mut states: Vec<LoadedState<S>> = states.collect();
        states.reverse();
        states
    }

    /// Integrates `state` from one `tau` back to a smaller one, piece by piece.
    fn advance<I: Intrinsic<f64>, S: SensitivitySet<f64>>(
        &self,
        intrinsic: I,
        (mut from, to): (f64, f64),
        mut state: TrajectoryState<f64, I, S>,
    ) -> TrajectoryState<f64, I, S> {
        let gradient = self.rod.gradient;
        let Some(profile) = &self.rod.profile else {
            let (steps, h) = share(self.steps, self.tau, from - to);
            let system = self.system(intrinsic, Graded { gradient });
            let scales = Scales::tapered(self.rod.taper, h);
            let section = self.section(from);
            return integrate::<f64, _, _, S>(&system, &scales, section, steps, state, &mut ());
        };
        let mut ahead = self.tau;
        let last = self.rod.piece(self.contact);
        for (k, piece) in profile.pieces[..=last].iter().enumerate().rev() {
            let (whole, end) = (ahead - piece.tau, piece.tau.max(to));
            ahead = piece.tau;
            if end < from {
                let steps = self.pieces.of(profile, k);
                let (steps, h) = share(steps, whole, from - end);
                let material =
                    Measured { from: piece.from, cubic: piece.cubic, gradient: Some(gradient) };
                let system = self.system(intrinsic, material);
                let scales = Scales::tapered(self.rod.taper, h);
                let mut section = self.section(from);
                for _ in 0..steps {
                    let computed = BackwardCompliance {
                        material: &material,
                        from: section.arclength,
                        length: section.rho * scales.end().along,
                    };
                    state = collocate::<f64, _, S>(
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
        RodSystem { force: self.force, intrinsic, material }
    }

    fn section(&self, tau: f64) -> Section<f64> {
        let rho = self.rod.radius(tau);
        Section { rho, inverse_cube: 1.0 / (rho * rho * rho), arclength: arclength(self.rod, tau) }
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
