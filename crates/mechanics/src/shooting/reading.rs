//! Readings: states of the whisker in physical units.

use super::{FullState, PlainState};
use crate::numerics::{LaneNumbers, Lanes, Real, keep, nearest_turn, pack};
use crate::rod::{Rest, Rod, Units, arclength_at};
use glam::DVec2;

/// A reading: a state of the whisker in physical units. The first axis of the base frame is the base's tangent. Force and moment are
/// those that the pole exerts at the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Arc length from the base to the contact, in millimetres.
    pub arc_length_mm: f64,
    /// Angle of the whisker's tangent at the contact from the base's tangent, in degrees.
    pub contact_angle_deg: f64,
    /// Normal force between pole and whisker, in micronewtons.
    pub force_un: f64,
    /// Force `[x, y]` on the base, in the base frame, in micronewtons.
    pub base_force_un: DVec2,
    /// Moment on the base, in nanonewton metres, positive if it turns the base's tangent toward its normal.
    pub base_moment_nnm: f64,
    /// Chord angle of the paper's Fig. 1D, in degrees: between the directions from the base to the contact and to the point of the
    /// resting whisker at the same distance.
    pub push_chord_deg: f64,
    /// Straight distance from the base to the contact, in millimetres.
    pub contact_distance_mm: f64,
    /// Bending energy of the whisker, in nanojoules.
    pub energy_nj: f64,
}

impl Reading {
    /// Returns the size of the whole force between pole and whisker, in micronewtons: its normal part is [`Reading::force_un`], the other one
    /// is friction. The pole alone puts a force on the whisker, so that it is the force on the base.
    #[must_use]
    pub fn contact_force_un(&self) -> f64 {
        self.base_force_un.length()
    }
}

/// Dimensionless numbers of a state from which its reading follows, or of several states in SIMD lanes. Lengths are in whisker lengths,
/// angles in radians.
#[derive(Clone, Copy, Debug, Default)]
pub struct StateNumbers<T> {
    /// Arclength of the contact.
    pub arclength: T,
    /// Angle of the whisker's tangent at the contact from the base's tangent.
    pub contact_angle: T,
    /// Signed force at the contact, with the sign of the load, in `E I_base/L_w^2`.
    pub force: T,
    /// Unit tangent `[cos, sin]` of the base in the frame of [`FullState`].
    pub tangent: [T; 2],
    /// Position of the base in the frame of [`FullState`].
    pub position: [T; 2],
    /// Chord angle of the paper's Fig. 1D.
    pub chord: T,
    /// Bending energy, in `E I_base/L_w`.
    pub energy: T,
}

impl StateNumbers<LaneNumbers> {
    /// Returns the numbers of the states from the index `from` on in SIMD lanes.
    #[must_use]
    #[inline(always)]
    pub fn pack<T: Lanes>(&self, from: usize) -> StateNumbers<T> {
        let two = |own: &[LaneNumbers; 2]| own.each_ref().map(|own| pack(own, from));
        StateNumbers {
            arclength: pack(&self.arclength, from),
            contact_angle: pack(&self.contact_angle, from),
            force: pack(&self.force, from),
            tangent: two(&self.tangent),
            position: two(&self.position),
            chord: pack(&self.chord, from),
            energy: pack(&self.energy, from),
        }
    }

    /// Stores the numbers of states in SIMD lanes, from the index `from` on.
    #[inline(always)]
    pub fn keep<T: Lanes>(&mut self, from: usize, states: StateNumbers<T>) {
        keep(&mut self.arclength, from, states.arclength);
        keep(&mut self.contact_angle, from, states.contact_angle);
        keep(&mut self.force, from, states.force);
        for i in 0..2 {
            keep(&mut self.tangent[i], from, states.tangent[i]);
            keep(&mut self.position[i], from, states.position[i]);
        }
        keep(&mut self.chord, from, states.chord);
        keep(&mut self.energy, from, states.energy);
    }
}

/// Converter of the states of one rod to physical units.
#[derive(Clone, Debug)]
pub struct Reader {
    units: Units,
    taper: f64,
    rest: Rest,
    to_pole: DVec2,
    /// Angle of the contact's tangent from the normal of the force, in radians.
    tilt: f64,
    /// Normal force over the whole force.
    normal: f64,
}

impl Reader {
    /// Creates the converter from states of `rod` to `units`.
    #[must_use]
    pub fn new(units: Units, rod: &Rod) -> Self {
        Self {
            units,
            taper: rod.taper,
            rest: Rest::new(rod),
            to_pole: DVec2::ZERO,
            tilt: 0.0,
            normal: 1.0,
        }
        .with_contact(rod)
    }

    /// Returns this converter with the pole and the friction of `rod`, which is the same rod otherwise.
    #[must_use]
    pub fn with_contact(&self, rod: &Rod) -> Self {
        let tangent = rod.contact_tangent();
        Self {
            to_pole: rod.to_pole(),
            tilt: tangent.to_angle(),
            normal: tangent.x,
            rest: self.rest.clone(),
            ..*self
        }
    }

    /// Returns the change of a reading for a change of 1 in each dimensionless number of a state: lengths in whisker lengths, angles in
    /// radians, whole forces with the sign `side`.
    #[must_use]
    pub fn of_one(&self, side: f64) -> Reading {
        let units = &self.units;
        let degrees = 1f64.to_degrees();
        Reading {
            arc_length_mm: units.length_mm,
            contact_angle_deg: degrees,
            force_un: side * self.normal * units.force_un,
            base_force_un: DVec2::splat(units.force_un),
            base_moment_nnm: units.moment_nnm,
            push_chord_deg: degrees,
            contact_distance_mm: units.length_mm,
            energy_nj: units.moment_nnm,
        }
    }

    /// Returns the reading at first touch: the resting whisker without a load. The contact is at arclength `contact`, in whisker lengths,
    /// and the pole in the direction `touch`, in radians.
    #[must_use]
    pub fn at_first_touch(&self, contact: f64, touch: f64) -> Reading {
        let (point, tangent) = self.rest.at_arclength(contact);
        Reading {
            arc_length_mm: contact * self.units.length_mm,
            contact_angle_deg: nearest_turn(tangent.to_angle(), touch).to_degrees(),
            force_un: 0.0,
            base_force_un: DVec2::ZERO,
            base_moment_nnm: 0.0,
            push_chord_deg: 0.0,
            contact_distance_mm: point.length() * self.units.length_mm,
            energy_nj: 0.0,
        }
    }

    /// Returns the reading of the state `full` with the contact at `tau`, at the signed push angle `push` from first touch in the
    /// direction `touch`. Both angles are in radians.
    #[must_use]
    pub fn read(&self, tau: f64, full: &FullState, touch: f64, push: f64) -> Reading {
        let numbers = self.numbers(tau, &full.plain(), touch + push, push);
        let [arc, angle, force, x, y, moment, chord, distance, energy] = self.channels(numbers);
        Reading {
            arc_length_mm: arc,
            contact_angle_deg: angle,
            force_un: force,
            base_force_un: DVec2::new(x, y),
            base_moment_nnm: moment,
            push_chord_deg: chord,
            contact_distance_mm: distance,
            energy_nj: energy,
        }
    }

    /// Returns the numbers of a `state` with the contact at `tau`. The pole is in the direction `phi` from the base, and `chord` is near the
    /// chord angle: both in radians, with whole turns.
    #[must_use]
    pub fn numbers(&self, tau: f64, state: &PlainState, phi: f64, chord: f64) -> StateNumbers<f64> {
        let to_base = DVec2::new(state.tangent.x, -state.tangent.y);
        let contact = to_base.rotate(-state.position);
        let to_pole = self.to_pole - state.position;
        let resting = self.rest.point_at_distance(contact.length());
        let own_chord = DVec2::new(resting.x, -resting.y).rotate(contact).to_angle();
        StateNumbers {
            arclength: arclength_at(self.taper, tau),
            contact_angle: phi - to_pole.to_angle() + self.tilt,
            force: state.force,
            tangent: state.tangent.to_array(),
            position: state.position.to_array(),
            chord: nearest_turn(own_chord, chord),
            energy: state.energy,
        }
    }

    /// Returns the channels of a state from its `numbers`, in the order and the units of the fields of [`Reading`].
    #[must_use]
    #[inline(always)]
    pub fn channels<T: Real>(&self, numbers: StateNumbers<T>) -> [T; 9] {
        let StateNumbers {
            force,
            tangent: [cos, sin],
            position: [x, y],
            ..
        } = numbers;
        let Units {
            length_mm,
            force_un,
            moment_nnm,
            ..
        } = self.units;
        let (length, degrees) = (T::of(length_mm), T::of(1f64.to_degrees()));
        let whole = (force * force).sqrt();
        [
            numbers.arclength * length,
            numbers.contact_angle * degrees,
            whole * T::of(self.normal) * T::of(force_un),
            force * sin * T::of(force_un),
            force * cos * T::of(force_un),
            -force * x * T::of(moment_nnm),
            numbers.chord * degrees,
            (x * x + y * y).sqrt() * length,
            numbers.energy * T::of(moment_nnm),
        ]
    }
}
