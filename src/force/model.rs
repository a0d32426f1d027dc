//! Force of the full model: the stable state with the measured curvature, at the measured distance of the contact from the base.

use super::bending::Bending;
use super::deviation::{LoadDerivatives, Loads};
use super::state_curve::{Measured, ModelState, StateCurve};
use super::{BaseAxis, CurvatureFrame, FrameContact, FrameForce, NoForce};
use crate::scene::{FrameDeviations, Pole, Whisker};
use crate::sheet::Sheet;
use crate::trace::StateRow;
use glam::DVec2;
use whiskmap_mechanics::rod::{Rest, Rod, Side, Units};
use whiskmap_mechanics::shooting::batch::Method;
use whiskmap_mechanics::shooting::sensitivity::BaseDerivatives;
use whiskmap_mechanics::shooting::shape::{RodPoint, varied_profile};
use whiskmap_mechanics::shooting::{Reader, Reading, Resolution};

/// Number of intervals between the rows of a sheet.
const ROWS: u32 = 16;

/// Model of the whisker, with the pole on each side.
pub struct Model {
    sides: [(Rod, Sheet); 2],
    units: Units,
    axis: BaseAxis,
}

impl Model {
    /// Creates the model in the frame with this `axis`; contacts are at least `nearest_mm` from the base.
    pub fn new(whisker: &Whisker, pole: &Pole, nearest_mm: f64, axis: BaseAxis) -> Self {
        let method = Method::new(Resolution::FINE);
        // A sheet is certified at the contacts of its rows: from the nearest contact to the tip.
        let nearest = (nearest_mm / whisker.length_mm).min(1.0);
        let distance = |i| nearest * libm::pow(1.0 / nearest, f64::from(i) / f64::from(ROWS));
        let distances: Vec<f64> = (0..=ROWS).map(distance).collect();
        let sides = [Side::Cb, Side::Cf].map(|side| {
            let rod = whisker.rod(&Pole::smooth(pole.radius_mm), side);
            let sheet = Sheet::of_ends(method, &rod, side, &distances);
            (rod, sheet)
        });
        Self { sides, units: whisker.units(), axis }
    }

    /// Returns the force in a frame in contact.
    pub fn force(
        &self,
        bending: &Bending,
        frame: &CurvatureFrame,
        contact: &FrameContact,
        sd: &FrameDeviations,
    ) -> FrameForce {
        let none = |reason| bending.none(frame.time_s, reason);
        let length = self.units.length_mm;
        let measured = Measured {
            contact: DVec2::from(contact.contact_mm) / length,
            at: frame.at_arc_length_mm / length,
            change: bending.change_per_mm * length,
            axis: self.axis,
        };
        let [(rod, _), _] = &self.sides;
        let rest = Rest::new(&Rod { pole: 0.0, ..rod.clone() });
        let (s, _) = rest.touch_at_distance(measured.contact.length());
        if s > rest.end() {
            return none(NoForce::OutOfReach);
        }
        let off = |state: &ModelState| state.contact.distance(measured.contact);
        let mut no_force = NoForce::NoLever;
        let found = self.sides.iter().flat_map(|(rod, sheet)| {
            let curve = StateCurve { rod, sheet, measured };
            let samples = curve.samples(rod.tau(s));
            if curve.have_lever(&samples) {
                no_force = NoForce::NoState;
            }
            let states = curve.states(&samples).into_iter();
            states.map(move |state| (rod, sheet.side, state))
        });
        let nearest = found.min_by(|(.., one), (.., other)| off(one).total_cmp(&off(other)));
        let Some((rod, side, state)) = nearest else {
            return none(no_force);
        };
        let ModelState { point, full, .. } = state;
        let reader = Reader::new(self.units, rod);
        let reading = reader.read(point.x, &full, full.map.pole.to_angle(), 0.0);
        let turn = self.axis.turn(rod, &full);
        let on_base = DVec2::new(reading.base_force_x_un, reading.base_force_y_un);
        let on_base = DVec2::from_angle(turn).rotate(on_base);
        let reading = Reading {
            contact_angle_deg: reading.contact_angle_deg + turn.to_degrees(),
            base_force_x_un: on_base.x,
            base_force_y_un: on_base.y,
            ..reading
        };
        let found = FrameForce {
            side: Some(side),
            contact_off_mm: Some(off(&state) * length),
            reason: None,
            ..none(NoForce::NoState).with_state(Some(&reading))
        };
        match self.derivatives(rod, point, &measured) {
            Some(derivatives) => derivatives.deviate(found, sd),
            None => found,
        }
    }

    /// Returns the derivatives of the loads of the state at `point`, `(tau, load)`, by the implicit function theorem: the state has the measured
    /// distance `d` of the contact and the measured change `c` of the curvature, so that `d(tau, load)/d(d, c)` is the inverse of
    /// `d(d, c)/d(tau, load)`. The angle of the contact does not enter. `None` if a point of the state is at the contact.
    fn derivatives(&self, rod: &Rod, point: DVec2, measured: &Measured) -> Option<LoadDerivatives> {
        let (tau, load) = point.into();
        let at = [0.0, measured.at];
        let varied = varied_profile(rod, tau, load, Resolution::FINE, &at);
        let [base, middle] = varied.try_into().ok()?;
        let radius = rod.radius(tau);
        let force = load * radius * radius;
        let force_by = [-2.0 * rod.taper * force, radius * radius];
        let state = VariedState {
            force,
            base,
            middle,
            stiffness: rod.stiffness(measured.at),
            mount: match self.axis {
                BaseAxis::Tangent => 0.0,
                BaseAxis::Follicle => rod.mount,
            },
        };
        let [by_tau, by_load] = [0, 1].map(|i| state.by(i, force_by[i]));
        let [of_tau, of_load] = [by_tau.constraints, by_load.constraints];
        let det = of_tau.perp_dot(of_load);
        let units = &self.units;
        let scale = [units.force_un, units.force_un, units.force_un, units.moment_nnm];
        let along = |tau_by: f64, load_by: f64, unit: f64| {
            let sum = |i: usize| tau_by * by_tau.loads[i] + load_by * by_load.loads[i];
            std::array::from_fn(|i| sum(i) * scale[i] * unit)
        };
        let length = units.length_mm;
        let by_distance: Loads = along(of_load.y / det, -of_tau.y / det, 1.0 / length);
        let by_curvature = along(-of_load.x / det, of_tau.x / det, length);
        let direction = measured.contact.normalize();
        Some(LoadDerivatives {
            by_curvature,
            by_contact: direction.to_array().map(|part| by_distance.map(|by| part * by)),
            by_angle: [0.0; 4],
        })
    }
}

/// Base and measured point of a state, each with its derivatives by `tau` and load.
struct VariedState {
    /// Signed force at the contact, in `E I_base/L_w^2`.
    force: f64,
    base: (RodPoint, BaseDerivatives<f64>),
    middle: (RodPoint, BaseDerivatives<f64>),
    /// Bending stiffness at the measured point over the stiffness at the base.
    stiffness: f64,
    /// Compliance of the mount from the base's tangent to the first axis of the frame.
    mount: f64,
}

/// Derivatives of a state by one of its coordinates.
struct StateBy {
    /// Derivatives of the distance of the contact and of the change of the curvature at the measured point.
    constraints: DVec2,
    /// Derivatives of the loads.
    loads: Loads,
}

impl VariedState {
    /// Returns the derivatives by `tau` (0) or load (1), with the derivative of the force.
    fn by(&self, coordinate: usize, force_by: f64) -> StateBy {
        let of = |(point, by): &(RodPoint, BaseDerivatives<f64>)| {
            let by = [by.by_tau, by.by_load][coordinate];
            (*point, by)
        };
        let (base, [angle_by, x_by, y_by]) = of(&self.base);
        let (middle, [_, middle_by, _]) = of(&self.middle);
        let (force, position) = (self.force, base.position);
        let moment_by = |x: f64, x_by: f64| -(force_by * x + force * x_by);
        let axis = DVec2::from_angle(self.mount * force * position.x).rotate(base.tangent);
        let axis_by = angle_by - self.mount * moment_by(position.x, x_by);
        let [cos, sin] = axis.to_array();
        StateBy {
            constraints: DVec2::new(
                position.dot(DVec2::new(x_by, y_by)) / position.length(),
                moment_by(middle.position.x, middle_by) / self.stiffness,
            ),
            loads: [
                force_by,
                force_by * sin + force * axis_by * cos,
                force_by * cos - force * axis_by * sin,
                moment_by(position.x, x_by),
            ],
        }
    }
}
