//! Table `[surface]` of a scene: a rough surface, over which the whisker sweeps.

use super::error::{SceneError, SceneFault};
use super::grid::{FARTHEST, NEAREST};
use super::limits::NumberLimits;
use super::whisker::{Pole, Whisker};
use crate::random::RandomStream;
use serde::{Deserialize, Serialize};

/// Rough surface: asperities on a line. They are small poles without friction.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// Smallest distance from the base to the line through the centres of the asperities, in mm.
    pub distance_mm: f64,
    /// Mean distance between the centres of neighbouring asperities, in um.
    pub spacing_um: f64,
    /// Radius of the asperities, in um; 0 makes point contacts.
    pub asperity_radius_um: f64,
    /// Length of the line, in mm. Its middle is nearest to the base.
    pub length_mm: f64,
    /// Width of the random shift of each asperity along the line, over the spacing: at least 0 and less than 1.
    #[serde(default)]
    pub jitter: f64,
    /// Seed of the random shifts. Equal seeds give equal surfaces.
    #[serde(default)]
    pub seed: u32,
}

/// Most asperities of a surface.
const MOST_ASPERITIES: u32 = 100_000;

impl Surface {
    /// Returns the positions of the asperities along the line, in mm from its middle, `[asperity]`; they grow.
    #[must_use]
    pub fn asperities_mm(&self) -> Vec<f64> {
        let spacing_mm = 1e-3 * self.spacing_um;
        // A length that is a multiple of the spacing ends in an asperity, in spite of rounding.
        let last = (self.length_mm / spacing_mm * (1.0 + 4.0 * f64::EPSILON)).floor();
        let position = |asperity: u32| {
            let mut random = RandomStream::new(self.seed.into(), asperity.into());
            let shift = self.jitter * (random.uniform() - 0.5);
            spacing_mm * (f64::from(asperity) - 0.5 * last + shift)
        };
        (0..=last as u32).map(position).collect()
    }

    /// Returns an asperity as a pole.
    #[must_use]
    pub const fn asperity(&self) -> Pole {
        Pole::smooth(1e-3 * self.asperity_radius_um)
    }

    /// Checks the numbers of the surface in front of `whisker`.
    ///
    /// # Errors
    /// If a number is out of its range.
    pub fn check(&self, whisker: &Whisker) -> Result<(), SceneError> {
        let refused = |fault| SceneError::of_fault("", "", fault);
        self.checked(whisker).map(drop).map_err(refused)
    }

    /// Checks the numbers of a surface in front of `whisker`.
    pub(super) fn checked(self, whisker: &Whisker) -> Result<Self, SceneFault> {
        let length = whisker.length_mm;
        let near = ("length_mm / 1000", length / NEAREST);
        let far = ("10 * length_mm", FARTHEST * length);
        let reach = NumberLimits::between(near, far);
        reach.check("surface.distance_mm", self.distance_mm)?;
        NumberLimits::between(1e-3, 1e8).check("surface.spacing_um", self.spacing_um)?;
        NumberLimits::below(0.0, 1.0).check("surface.jitter", self.jitter)?;
        let most = f64::from(MOST_ASPERITIES - 1) * self.spacing_um / 1e3;
        let most = ("99,999 spacings", most);
        NumberLimits::between(0.0, most).check("surface.length_mm", self.length_mm)?;
        let touching = 0.5 * self.spacing_um * (1.0 - self.jitter);
        let sharpest = 1e3 / whisker.sharpest_bend_per_mm();
        let ends = [
            ("spacing_um * (1 - jitter) / 2, at which asperities touch", touching),
            ("the whisker's smallest radius of curvature in um", sharpest),
            ("the distance in um", 1e3 * self.distance_mm),
        ];
        let end = ends.into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
        let radius = NumberLimits::below(0.0, end.unwrap_or(("spacing_um", self.spacing_um)));
        radius.check("surface.asperity_radius_um", self.asperity_radius_um)?;
        Ok(self)
    }
}
