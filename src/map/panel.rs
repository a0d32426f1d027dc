//! Panels: the maps of single whiskers.

use crate::classify::{Regime, Status};
use crate::plan::{Channel, Channels, STATE_CHANNELS};
use crate::scene::Parameter;
use std::ops::Range;
use std::slice::ChunksMut;

/// Names of the derivatives, `[parameter]`.
const DERIVATIVES: [&str; Parameter::ALL.len()] = {
    let (mut names, mut place) = ([""; Parameter::ALL.len()], 0);
    while place < names.len() {
        names[place] = Parameter::ALL[place].push_derivative();
        place += 1;
    }
    names
};

/// Panel: the map of one whisker. Every vector has `distances * push_angles` cells; cell `(row, column)` is at `row * push_angles +
/// column`. Row 0 is the first distance, column 0 the first push angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// [`Regime`] code of each cell: `[distance][push_angle]`.
    pub regime: Vec<u32>,
    /// [`Status`] code of each cell: `[distance][push_angle]`.
    pub status: Vec<u32>,
    /// Channel values in map units: `[channel][distance][push_angle]`, a vector per name in [`STATE_CHANNELS`]. NaN without contact; empty
    /// if the channel is not computed.
    pub state: [Vec<f32>; STATE_CHANNELS.len()],
    /// Residual of each cell: distance of the pole's centre from its target, in whisker lengths, `[distance][push_angle]`. In an
    /// unresolved cell it belongs to the last state computed. NaN without contact.
    pub residual: Vec<f32>,
    /// Margin of each cell: push angle left until detachment, in degrees, `[distance][push_angle]`; NaN without contact.
    pub margin_deg: Vec<f32>,
    /// Largest bending strain at the surface in each cell: `[distance][push_angle]`. NaN without contact; empty if it is not computed.
    pub peak_strain: Vec<f32>,
    /// Derivative of the push angle at detachment by each parameter, in degrees per unit of the parameter:
    /// `[parameter][distance][push_angle]`, in the order of [`Parameter::ALL`]. NaN without contact; empty if it is not computed.
    pub push_derivatives: [Vec<f32>; Parameter::ALL.len()],
    /// Number of Newton steps of each cell, engine and refinement together: `[distance][push_angle]`.
    pub newton_steps: Vec<u32>,
}

impl Panel {
    /// Creates a panel of unresolved cells: residual and margin are NaN. A channel in [`STATE_CHANNELS`] is NaN if it is one of `channels`,
    /// and otherwise empty.
    #[must_use]
    pub fn unresolved(cells: usize, channels: Channels) -> Self {
        let mut panel = Self::unwritten(cells, channels);
        panel.regime.fill(Regime::Unresolved.code());
        panel.status.fill(Status::NotConverged.code());
        let numbers = [&mut panel.residual, &mut panel.margin_deg];
        let on_demand = panel.state.iter_mut().chain(&mut panel.push_derivatives);
        for numbers in on_demand.chain(numbers).chain([&mut panel.peak_strain]) {
            numbers.fill(f32::NAN);
        }
        panel
    }

    /// Creates the panel of a row of a table that has no whisker.
    pub(super) fn without_whisker(cells: usize, channels: Channels) -> Self {
        let mut panel = Self::unresolved(cells, channels);
        panel.status.fill(Status::NoWhisker.code());
        panel
    }

    /// Changes the number of cells and the channels. Every cell must be written afterwards.
    pub(super) fn resized(mut self, cells: usize, channels: Channels) -> Self {
        for codes in [&mut self.regime, &mut self.status, &mut self.newton_steps] {
            codes.resize(cells, 0);
        }
        for numbers in [&mut self.residual, &mut self.margin_deg] {
            numbers.resize(cells, 0.0);
        }
        let names = STATE_CHANNELS.into_iter().chain(DERIVATIVES);
        let names = names.chain([Channel::PeakStrain.name()]);
        let on_demand = self.state.iter_mut().chain(&mut self.push_derivatives);
        for (name, numbers) in names.zip(on_demand.chain([&mut self.peak_strain])) {
            let cells = if channels.contains(name) { cells } else { 0 };
            numbers.resize(cells, 0.0);
        }
        self
    }

    /// Creates a panel of zeros, of which every cell must be written. Zeroed memory costs nothing until it is written, on all threads.
    pub(super) fn unwritten(cells: usize, channels: Channels) -> Self {
        let on_demand = |name| {
            let cells = if channels.contains(name) { cells } else { 0 };
            vec![0.0; cells]
        };
        Self {
            regime: vec![0; cells],
            status: vec![0; cells],
            state: STATE_CHANNELS.map(on_demand),
            residual: vec![0.0; cells],
            margin_deg: vec![0.0; cells],
            peak_strain: on_demand(Channel::PeakStrain.name()),
            push_derivatives: DERIVATIVES.map(on_demand),
            newton_steps: vec![0; cells],
        }
    }

    /// Returns the values of `channel` in the panel, in the channel's unit, of shape `[distance][push_angle]`. NaN without a state; empty
    /// if the channel is not computed.
    #[must_use]
    pub fn channel(&self, channel: Channel) -> &[f32] {
        match channel {
            Channel::Residual => &self.residual,
            Channel::Margin => &self.margin_deg,
            Channel::PeakStrain => &self.peak_strain,
            state => &self.state[state as usize],
        }
    }

    /// Returns the values of a derivative by the name of its channel, such as `d_push_d_taper`: `[distance][push_angle]`. `None` for other
    /// channels.
    #[must_use]
    pub fn push_derivative_mut(&mut self, name: &str) -> Option<&mut Vec<f32>> {
        let place = DERIVATIVES.iter().position(|derivative| *derivative == name)?;
        Some(&mut self.push_derivatives[place])
    }

    /// Returns the values of the channel `name` in the panel as bytes, 4 for each cell; none if the channel is not computed.
    pub(crate) fn bytes(&self, name: &str) -> &[u8] {
        let codes = match name {
            "regime" => &self.regime,
            "status" => &self.status,
            "newton_steps" => &self.newton_steps,
            _ => {
                let by = || DERIVATIVES.iter().position(|derivative| *derivative == name);
                let values = match Channel::of(name) {
                    Some(channel) => self.channel(channel),
                    None => by().map_or(&[][..], |place| &self.push_derivatives[place]),
                };
                return bytemuck::cast_slice(values);
            }
        };
        bytemuck::cast_slice(codes)
    }

    /// Returns the regime of each cell of the panel, in the order of [`Panel::regime`].
    pub fn regimes(&self) -> impl ExactSizeIterator<Item = Regime> + '_ {
        let of = |code: &u32| Regime::ALL.into_iter().find(|regime| regime.code() == *code);
        self.regime.iter().map(move |code| of(code).unwrap_or(Regime::Unresolved))
    }

    /// Returns the `rows` of a panel that is `width` cells wide, which can be written in parallel.
    pub(super) fn rows_mut(&mut self, width: usize, rows: Range<usize>) -> Vec<RowMut<'_>> {
        let cells = rows.start * width..rows.end * width;
        let mut state = self.state.each_mut().map(|channel| rows_of(channel, &cells, width));
        let mut push_derivatives =
            self.push_derivatives.each_mut().map(|channel| rows_of(channel, &cells, width));
        let mut peak_strain = rows_of(&mut self.peak_strain, &cells, width);
        let [regime, status, newton_steps] =
            [&mut self.regime, &mut self.status, &mut self.newton_steps]
                .map(|codes| codes[cells.clone()].chunks_mut(width));
        let [residual, margin_deg] = [&mut self.residual, &mut self.margin_deg]
            .map(|numbers| numbers[cells.clone()].chunks_mut(width));
        let codes = regime.zip(status).zip(newton_steps);
        let rows = codes.zip(residual.zip(margin_deg));
        rows.map(|(((regime, status), newton_steps), (residual, margin_deg))| RowMut {
            regime,
            status,
            state: state.each_mut().map(|channel| channel.next().unwrap_or_default()),
            residual,
            margin_deg,
            peak_strain: peak_strain.next().unwrap_or_default(),
            push_derivatives: push_derivatives
                .each_mut()
                .map(|channel| channel.next().unwrap_or_default()),
            newton_steps,
        })
        .collect()
    }
}

/// Writable row of a panel.
pub(super) struct RowMut<'a> {
    pub regime: &'a mut [u32],
    pub status: &'a mut [u32],
    /// Channel values of the row in map units: `[channel][push_angle]`; empty if the channel is not computed.
    pub state: [&'a mut [f32]; STATE_CHANNELS.len()],
    pub residual: &'a mut [f32],
    pub margin_deg: &'a mut [f32],
    /// Largest bending strains of the row: `[push_angle]`; empty if not computed.
    pub peak_strain: &'a mut [f32],
    /// Derivatives of the row: `[parameter][push_angle]`; empty if not computed.
    pub push_derivatives: [&'a mut [f32]; Parameter::ALL.len()],
    pub newton_steps: &'a mut [u32],
}

/// The rows of these cells of a channel; none if it is not computed.
fn rows_of<'a>(channel: &'a mut [f32], cells: &Range<usize>, width: usize) -> ChunksMut<'a, f32> {
    let cells = if channel.is_empty() { 0..0 } else { cells.clone() };
    channel[cells].chunks_mut(width)
}
