//! The numbers of a state by channel, in the units of the map.

use super::STATE_CHANNELS;
use crate::integrate::{CellDifference, Reference};
use crate::shooting::{Reader, Reading};

/// One number for each of [`STATE_CHANNELS`].
pub type Numbers = [f64; STATE_CHANNELS.len()];

/// The channels of a reading.
pub fn channels(reading: &Reading) -> Numbers {
    [
        reading.arc_length_mm,
        reading.contact_angle_deg,
        reading.force_un,
        reading.base_force_un.x,
        reading.base_force_un.y,
        reading.base_moment_nnm,
        reading.push_chord_deg,
        reading.contact_distance_mm,
        reading.energy_nj,
    ]
}

/// The channels of `reference`, which is in contact since first touch in the direction `touch`.
pub fn of_reference(reader: &Reader, reference: &Reference, touch: f64) -> Numbers {
    let Reference {
        tau, state, push, ..
    } = reference;
    channels(&reader.read(*tau, &state.full, touch, *push))
}

/// The channels of a cell that differs from its reference, whose `channels` are these; `of_one` is what a difference of one is there.
pub fn of_cell(channels: &Numbers, of_one: &Numbers, difference: &CellDifference) -> Numbers {
    let mut cell = *channels;
    for ((number, of_one), difference) in cell.iter_mut().zip(of_one).zip(difference.numbers) {
        *number += of_one * f64::from(difference);
    }
    // Rounding at first touch.
    cell[2] = cell[2].max(0.0);
    cell
}
