//! Selection of the channels of a planned run.

use super::memory::{BYTES_PER_VALUE, fits};
use super::{Channels, Plan, PlanError};
use crate::scene::{Parameter, Scene};

impl Plan {
    /// Returns the plan of a run of `scene` that computes these `channels`.
    ///
    /// # Errors
    /// When a derivative is by a parameter that the scene does not give, or derivatives take more than
    /// [`MEMORY_LIMIT`](super::MEMORY_LIMIT).
    pub fn with_channels(mut self, channels: Channels, scene: &Scene) -> Result<Self, PlanError> {
        self.channels = channels;
        let mut derivatives = channels.derivatives();
        if let Some(absent) = derivatives.find(|parameter| !parameter.has_derivative(scene)) {
            let all = Parameter::ALL.into_iter();
            let given = all.filter(|parameter| parameter.has_derivative(scene));
            return Err(PlanError::NotGiven {
                name: absent.push_derivative(),
                given: given.map(Parameter::name).collect::<Vec<_>>().join(", "),
            });
        }
        let derivatives = channels.derivatives().count();
        let on_demand = derivatives + usize::from(channels.has_strain());
        self.bytes += (on_demand * self.cells_at_once) as u64 * BYTES_PER_VALUE;
        if !fits(self.bytes, self.gpu_bytes) {
            return Err(PlanError::Derivatives {
                derivatives,
                cells: self.cells_at_once,
                needed: self.bytes.div_ceil(1 << 20),
            });
        }
        Ok(self)
    }
}
