//! Readings: states of the whisker in physical units.

use super::{FullState, PlainState};
use crate::numerics::{LaneNumbers, Lanes, Real, keep, nearest_turn, pack};
use crate::rod::{Rest, Rod, Units, arclength_at};
use glam::DVec2;

/// Dimension of a channel of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Length or distance, in mm.
    Length,
    /// Angle, in degrees.
    Angle,
    /// Normal part of the force between pole and whisker, in uN.
    NormalForce,
    /// Component of the force between pole and whisker, in uN.
    Force,
    /// Moment in nN m, or energy in nJ.
    Moment,
}

/// Defines [`Reading`] by its columns, and the macro `state_column`, which has their descriptions for tables.
macro_rules! reading {
    ($($(#[doc = $text:literal])+ $column:ident: $dimension:ident,)*; $(#[doc = $derived:literal])+ $last:ident = $value:expr) => {
        /// A reading: a state of the whisker in physical units. The first axis of the base frame is the base's tangent. Force and moment are
        /// those that the pole exerts at the base.
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct Reading {
            $($(#[doc = $text])+ pub $column: f64,)*
            $(#[doc = $derived])+ pub $last: f64,
        }

        impl Reading {
            /// Names of the channels of a state, `[channel]`: the fields but the last one.
            pub const CHANNELS: [&str; [$(stringify!($column)),*].len()] = [$(stringify!($column)),*];

            /// Dimensions of the channels of a state, `[channel]`.
            pub const DIMENSIONS: [Dimension; Self::CHANNELS.len()] = [$(Dimension::$dimension),*];

            /// Returns the values of the channels, in the order of [`Reading::CHANNELS`].
            #[must_use]
            pub const fn channels(&self) -> [f64; Self::CHANNELS.len()] {
                [$(self.$column),*]
            }

            /// Creates the reading with the values of [`Reading::CHANNELS`].
            #[must_use]
            pub fn of([$($column),*]: [f64; Self::CHANNELS.len()]) -> Self {
                let $last = $value;
                Self { $($column,)* $last }
            }
        }

        /// Expands to the description of a field of [`Reading`], for tables that have it as a column.
        #[macro_export]
        macro_rules! state_column {
            $(($column) => { concat!($($text),+) };)*
            ($last) => { concat!($($derived),+) };
        }
    };
}

reading! {
    /// Arclength from the base to the contact, in mm.
    arc_length_mm: Length,
    /// Angle of the tangent at the contact, from the base's tangent, in degrees.
    contact_angle_deg: Angle,
    /// Normal part of the force between pole and whisker, in uN; never negative.
    force_un: NormalForce,
    /// Force that the pole puts on the base, along the base's tangent, in uN.
    base_force_x_un: Force,
    /// Force that the pole puts on the base, to the left of its tangent, in uN.
    base_force_y_un: Force,
    /// Moment of the pole on the base, in nN m: positive turns it to the left.
    base_moment_nnm: Moment,
    /// Chord angle: from the resting whisker as far away to the contact, in degrees.
    push_chord_deg: Angle,
    /// Straight distance from the base to the contact, in mm.
    contact_distance_mm: Length,
    /// Bending energy of the whisker, in nJ.
    energy_nj: Moment,
    ;
    /// Size of the whole force between pole and whisker, with friction, in uN.
    contact_force_un = DVec2::new(base_force_x_un, base_force_y_un).length()
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
        let two = |pair: &[LaneNumbers; 2]| pair.each_ref().map(|numbers| pack(numbers, from));
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

    /// Returns the changes of [`Reading::CHANNELS`] for a change of 1 in each dimensionless number of a state: lengths in whisker lengths, angles
    /// in radians, whole forces with the sign `side`.
    #[must_use]
    pub fn of_one(&self, side: f64) -> [f64; Reading::CHANNELS.len()] {
        let Units { length_mm, force_un, moment_nnm, .. } = self.units;
        Reading::DIMENSIONS.map(|dimension| match dimension {
            Dimension::Length => length_mm,
            Dimension::Angle => 1f64.to_degrees(),
            Dimension::NormalForce => side * self.normal * force_un,
            Dimension::Force => force_un,
            Dimension::Moment => moment_nnm,
        })
    }

    /// Returns the reading at first touch: the resting whisker without a load. The contact is at arclength `contact`, in whisker lengths,
    /// and the pole in the direction `touch`, in radians.
    #[must_use]
    pub fn at_first_touch(&self, contact: f64, touch: f64) -> Reading {
        let (point, tangent) = self.rest.at_arclength(contact);
        Reading {
            arc_length_mm: contact * self.units.length_mm,
            contact_angle_deg: nearest_turn(tangent.to_angle(), touch).to_degrees(),
            contact_distance_mm: point.length() * self.units.length_mm,
            ..Reading::default()
        }
    }

    /// Returns the reading of the state `full` with the contact at `tau`, at the push angle `signed_push` from first touch in the
    /// direction `touch`. Both angles are in radians.
    #[must_use]
    pub fn read(&self, tau: f64, full: &FullState, touch: f64, signed_push: f64) -> Reading {
        Reading::of(self.values(tau, full, touch, signed_push))
    }

    /// Returns the channels of [`Reader::read`], in the order of [`Reading::CHANNELS`].
    #[must_use]
    pub fn values(
        &self,
        tau: f64,
        full: &FullState,
        touch: f64,
        signed_push: f64,
    ) -> [f64; Reading::CHANNELS.len()] {
        self.channels(self.numbers(tau, &full.plain(), touch + signed_push, signed_push))
    }

    /// Returns the numbers of a `state` with the contact at `tau`. The pole is in the direction `phi` from the base, and `chord` is near the
    /// chord angle: both in radians, with whole turns.
    #[must_use]
    pub fn numbers(&self, tau: f64, state: &PlainState, phi: f64, chord: f64) -> StateNumbers<f64> {
        let to_base = DVec2::new(state.tangent.x, -state.tangent.y);
        let contact = to_base.rotate(-state.position);
        let to_pole = self.to_pole - state.position;
        let resting = self.rest.point_at_distance(contact.length());
        let principal_chord = DVec2::new(resting.x, -resting.y).rotate(contact).to_angle();
        StateNumbers {
            arclength: arclength_at(self.taper, tau),
            contact_angle: phi - to_pole.to_angle() + self.tilt,
            force: state.force,
            tangent: state.tangent.to_array(),
            position: state.position.to_array(),
            chord: nearest_turn(principal_chord, chord),
            energy: state.energy,
        }
    }

    /// Returns the channels of a state from its `numbers`, in the order and the units of [`Reading::CHANNELS`].
    #[must_use]
    #[inline(always)]
    pub fn channels<T: Real>(&self, numbers: StateNumbers<T>) -> [T; Reading::CHANNELS.len()] {
        let StateNumbers { force, tangent: [cos, sin], position: [x, y], .. } = numbers;
        let Units { length_mm, force_un, moment_nnm, .. } = self.units;
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
