//! Command `whiskmap curve --samples`: the detachment curve of randomly drawn whiskers.

use super::arguments::whole;
use super::failure::{Failure, check_resolved, message};
use super::pole::check_single;
use super::progress::Progress;
use clap::Args;
use whiskmap::Side;
use whiskmap::mechanics::shooting::Resolution;
use whiskmap::scene::Scene;
use whiskmap::uncertainty::{Draws, EndSpread, LargestSpread};

#[derive(Debug, Args)]
pub struct SampleArgs {
    /// Draw N whiskers from the scene's [uncertainty]; the table has percentiles of their push angles, and a plot shows them
    /// as bands
    #[arg(long, value_name = "N", value_parser = whole(2..=1_000_000), conflicts_with = "derivatives")]
    samples: Option<u32>,
    /// Add the percentiles of the largest contact force, moment at the base and strain over the push of each sample; each takes some milliseconds
    #[arg(long, requires = "samples", conflicts_with = "data")]
    pub largest: bool,
    /// Seed of the samples
    #[arg(long, value_name = "S", default_value = "1", requires = "samples", value_parser = whole(0..=u32::MAX))]
    seed: u32,
}

impl SampleArgs {
    /// Returns true with --samples.
    pub const fn draws(&self) -> bool {
        self.samples.is_some()
    }

    /// Draws the random whiskers of a scene; `None` without --samples.
    pub fn draw(&self, scene: &Scene) -> Result<Option<Draws>, Failure> {
        let Some(samples) = self.samples else {
            return Ok(None);
        };
        check_single(scene, "curve --samples")?;
        let draws = Draws::new(scene, samples as usize, u64::from(self.seed));
        let refused = |why| Failure::Input(format!("--samples {samples}: {why}"));
        draws.map(Some).map_err(refused)
    }
}

/// Computes the percentiles of the `draws`, `[side][distance]`. Prints the number of repeated draws.
pub fn spread(draws: &Draws, resolution: Resolution) -> Vec<EndSpread> {
    let bar = Progress::over(Side::BOTH.len() * draws.len(), "curves");
    let spread = |side| draws.spread(resolution, side, &|| bar.inc(1));
    let rows: Vec<EndSpread> = Side::BOTH.into_iter().flat_map(spread).collect();
    bar.finish();
    if draws.refused > 0 {
        let (refused, kept) = (draws.refused, draws.len());
        message(&format!(
            "note: {refused} of {} draws were outside the scene's limits and were repeated",
            refused + kept as u64
        ));
    }
    rows
}

/// Computes the percentiles of the largest loads of the `draws`, `[side][distance]`, in the order of [`spread`].
pub fn largest(draws: &Draws) -> Vec<LargestSpread> {
    let bar = Progress::over(Side::BOTH.len() * draws.len(), "whiskers");
    let spread = |side| draws.largest(side, &|| bar.inc(1));
    let rows = Side::BOTH.into_iter().flat_map(spread).collect();
    bar.finish();
    rows
}

/// Returns an error if the end of every sample is unresolved.
pub fn check(rows: &[EndSpread], draws: &Draws) -> Result<(), Failure> {
    let unresolved = rows.iter().map(|row| row.unresolved).sum();
    let all = rows.len() * draws.len();
    check_resolved(unresolved, all as u64, "sampled ends", "the column `unresolved`")
}
