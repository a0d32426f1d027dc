//! The numbers of a state by channel, in the units of the map.

use super::STATE_CHANNELS;
use crate::engine::{BasePoint, CellDifference};
use crate::shooting::{Reader, Reading};

/// The place of the force among the channels.
const FORCE: usize = 2;

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
pub fn of_reference(reader: &Reader, reference: &BasePoint, touch: f64) -> Numbers {
    let BasePoint {
        tau, state, push, ..
    } = reference;
    channels(&reader.read(*tau, &state.full, touch, *push))
}

/// The channels of a cell that differs from its reference, whose `channels` are these; `of_one` is what a difference of one is there.
pub fn of_cell(channels: &Numbers, of_one: &Numbers, difference: &CellDifference) -> Numbers {
    std::array::from_fn(|i| number(i, channels[i], of_one[i], difference))
}

/// The channel `i` of a cell whose reference has `known` there.
#[inline]
pub fn number(i: usize, known: f64, of_one: f64, difference: &CellDifference) -> f64 {
    let number = known + of_one * f64::from(difference.numbers[i]);
    // Rounding at first touch.
    if i == FORCE { number.max(0.0) } else { number }
}
