//! Channels of a map, and the selection that is computed and stored.

use crate::input::did_you_mean;
use crate::scene::{Parameter, SceneData};
use std::fmt;
use std::str::FromStr;
use whiskmap_mechanics::shooting::Reading;

/// Names of the channels of a state, `[channel]`.
pub const STATE_CHANNELS: [&str; 9] = Reading::CHANNELS;

/// Channel of a map: one number for each cell.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Channel {
    /// Arclength from the base to the contact, in mm.
    ArcLength,
    /// Contact angle: of the tangent at the contact from that at the base, in degrees.
    ContactAngle,
    /// Force at the contact, in uN.
    Force,
    /// Force on the base along the whisker, in uN.
    BaseForceX,
    /// Force on the base across the whisker, in uN.
    BaseForceY,
    /// Bending moment at the base, in nN m.
    BaseMoment,
    /// Chord angle: push angle less the rotation of the chord from base to contact, in degrees.
    PushChord,
    /// Distance of the contact from the base, in mm.
    ContactDistance,
    /// Bending energy of the whisker, in nJ.
    Energy,
    /// Residual: bound on the distance of the pole from its target, in whisker lengths.
    Residual,
    /// Margin: push angle left until detachment, in degrees.
    Margin,
    /// Largest bending strain at the surface of the whisker, dimensionless; computed on demand.
    PeakStrain,
}

impl Channel {
    /// All channels of a map, beginning with the channels of a state in the order of [`STATE_CHANNELS`]: `[channel]`.
    pub const ALL: [Self; STATE_CHANNELS.len() + 3] = [
        Self::ArcLength,
        Self::ContactAngle,
        Self::Force,
        Self::BaseForceX,
        Self::BaseForceY,
        Self::BaseMoment,
        Self::PushChord,
        Self::ContactDistance,
        Self::Energy,
        Self::Residual,
        Self::Margin,
        Self::PeakStrain,
    ];

    /// Returns the name of the channel in files, with the unit at its end, such as `force_un`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Residual => RESIDUAL,
            Self::Margin => "margin_deg",
            Self::PeakStrain => PEAK_STRAIN,
            state => STATE_CHANNELS[state as usize],
        }
    }

    /// Returns the channel with this name; `None` for codes, counts, derivatives and other names.
    #[must_use]
    pub fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|channel| channel.name() == name)
    }
}

/// Line of the table of channels: name, unit, meaning, and label in pictures.
pub(crate) type ChannelLine = (&'static str, Option<&'static str>, &'static str, &'static str);

/// All channels but the derivatives, in their order in files. Codes and counts have no unit.
#[rustfmt::skip]
pub(crate) const CHANNELS: [ChannelLine; 15] = [
    ("regime", None, "what happens to the whisker", "regime"),
    ("status", None, "how the regime was found", "status"),
    ("arc_length_mm", Some("mm"), "arclength from base to contact", "arc length from base to contact (mm)"),
    ("contact_angle_deg", Some("degree"), "angle of tangent at contact", "contact angle (deg)"),
    ("force_un", Some("uN"), "normal part of the contact force", "contact force (\u{b5}N)"),
    ("base_force_x_un", Some("uN"), "force on base along its tangent", "force on the base along the whisker (\u{b5}N)"),
    ("base_force_y_un", Some("uN"), "force on base across its tangent", "force on the base across the whisker (\u{b5}N)"),
    ("base_moment_nnm", Some("nN m"), "moment of pole on the base", "bending moment at the base (nN m)"),
    ("push_chord_deg", Some("degree"), "chord angle between contact and rest", "chord angle (deg)"),
    ("contact_distance_mm", Some("mm"), "straight distance from base to contact", "distance from base to contact (mm)"),
    ("energy_nj", Some("nJ"), "energy of bending", "bending energy (nJ)"),
    ("margin_deg", Some("degree"), "push angle left until detachment", "push angle left until detachment (deg)"),
    ("newton_steps", None, "Newton steps", "Newton steps"),
    (RESIDUAL, Some("1"), "distance from pole over whisker length", "residual (whisker lengths)"),
    (PEAK_STRAIN, Some("1"), "largest bending strain at the surface", "largest bending strain"),
];

/// Name of the channel of residuals.
const RESIDUAL: &str = "residual";

/// Name of the channel of the largest bending strain, which takes a trajectory more for each cell.
const PEAK_STRAIN: &str = "peak_strain";

/// Index of the first channel of a state in [`CHANNELS`].
const FIRST_STATE: usize = 2;

/// Number of channels of a map unless others are selected: all but the largest bending strain and the derivatives.
const STANDARD: usize = CHANNELS.len() - 1;

/// Number of channels.
const COUNT: usize = CHANNELS.len() + Parameter::ALL.len();

/// Selection of the channels of a map.
///
/// Derivatives, such as `d_push_d_taper`, are computed on demand: of the push angle at detachment, and so of the margin, by a parameter. The
/// largest bending strain, `peak_strain`, is computed on demand, too, and for a scene with a yield strain.
///
/// ```
/// use whiskmap::plan::Channels;
///
/// let some: Channels = "regime,d_push_d_taper".parse()?;
/// assert!(some.contains("d_push_d_taper") && !some.contains("energy_nj"));
/// assert_eq!(some.to_string(), "regime, d_push_d_taper");
/// assert!("force".parse::<Channels>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Channels([bool; COUNT]);

impl Channels {
    /// The selection of all channels but derivatives and the largest bending strain.
    pub const STANDARD: Self = {
        let (mut chosen, mut place) = ([false; COUNT], 0);
        while place < STANDARD {
            chosen[place] = true;
            place += 1;
        }
        Self(chosen)
    };

    /// Returns the channels of a map of `scene` unless others are selected: [`Self::STANDARD`], and the largest bending strain if any whisker has
    /// a yield strain.
    #[must_use]
    pub fn of_scene(scene: &SceneData) -> Self {
        match scene.has_yield_strain() {
            true => Self::STANDARD.with(PEAK_STRAIN),
            false => Self::STANDARD,
        }
    }

    /// Selects the channels for which `is_wanted` returns true.
    #[must_use]
    pub fn those(is_wanted: impl Fn(&str) -> bool) -> Self {
        let mut chosen = [false; COUNT];
        for (chosen, name) in chosen.iter_mut().zip(names()) {
            *chosen = is_wanted(name);
        }
        Self(chosen)
    }

    /// Returns the selection with the channel `name` added.
    #[must_use]
    pub fn with(self, name: &str) -> Self {
        Self::those(|other| other == name || self.contains(other))
    }

    /// Returns true if the selection has the channel `name`.
    #[must_use]
    pub fn contains(&self, name: &str) -> bool {
        self.names().any(|selected| selected == name)
    }

    /// Returns the parameters by which the selection has derivatives.
    pub fn derivatives(&self) -> impl Iterator<Item = Parameter> {
        let chosen = self.0.into_iter().skip(CHANNELS.len());
        let all = Parameter::ALL.into_iter().zip(chosen);
        all.filter_map(|(parameter, is_chosen)| is_chosen.then_some(parameter))
    }

    /// Returns true if the selection has the largest bending strain.
    #[must_use]
    pub const fn has_strain(&self) -> bool {
        self.0[STANDARD]
    }

    /// Returns the names of the selected channels: regime and status, channels of a state, channels of the numerics, the largest bending
    /// strain, derivatives.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        let chosen = names().zip(self.0);
        chosen.filter_map(|(name, is_chosen)| is_chosen.then_some(name))
    }

    /// Returns which channels of a state are selected, in the order of [`STATE_CHANNELS`], `[channel]`.
    #[must_use]
    pub fn states(&self) -> [bool; STATE_CHANNELS.len()] {
        std::array::from_fn(|channel| self.0[FIRST_STATE + channel])
    }

    /// Returns the selection with all channels of a state added.
    #[must_use]
    pub fn with_states(self) -> Self {
        Self::those(|name| STATE_CHANNELS.contains(&name) || self.contains(name))
    }

    /// Returns true if the selection has a number of states: a channel of a state, its residual, or the largest bending strain. Without one, a cell
    /// only needs to be known to have a state.
    #[must_use]
    pub fn needs_states(&self) -> bool {
        self.has_state() || self.has_strain() || self.contains(RESIDUAL)
    }

    /// Returns true if the selection has a channel of a state.
    #[must_use]
    pub fn has_state(&self) -> bool {
        self.states().contains(&true)
    }
}

/// Returns the names of all channels.
pub fn names() -> impl Iterator<Item = &'static str> + Clone {
    let others = CHANNELS.iter().map(|(name, ..)| *name);
    let derivatives = Parameter::ALL.into_iter().map(Parameter::push_derivative);
    others.chain(derivatives)
}

impl fmt::Display for Channels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.names().collect::<Vec<_>>().join(", "))
    }
}

impl FromStr for Channels {
    type Err = String;

    /// Parses names with commas between them.
    fn from_str(list: &str) -> Result<Self, String> {
        let wanted: Vec<&str> = list.split(',').map(str::trim).collect();
        match wanted.iter().find(|name| !names().any(|known| known == **name)) {
            Some(unknown) => Err(format!(
                "must be names with commas between them, out of {}, {PEAK_STRAIN}, and derivatives such as d_push_d_taper{}",
                Self::STANDARD,
                did_you_mean(unknown, names())
            )),
            None => Ok(Self::those(|name| wanted.contains(&name))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Stores name the columns of states by the table, and the values are in the order of [`STATE_CHANNELS`].
    #[test]
    fn the_table_has_the_channels_of_a_state_in_their_order() {
        let names = CHANNELS.iter().map(|(name, ..)| *name);
        let states = names.skip(FIRST_STATE).take(STATE_CHANNELS.len());
        assert!(states.eq(STATE_CHANNELS));
        assert!(Channel::ALL.iter().all(|channel| Channel::of(channel.name()) == Some(*channel)));
    }
}
