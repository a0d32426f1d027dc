//! `whiskmap curve --samples`: the curve with the uncertainty of the scene's numbers.

use super::failure::{Failure, check_resolved, say};
use super::numbers::whole;
use super::outputs::Opened;
use super::progress::Progress;
use super::theory::{AXES, own_curve};
use clap::Args;
use whiskmap::render::{Plot, bands};
use whiskmap::rod::Side;
use whiskmap::scene::Scene;
use whiskmap::shooting::Resolution;
use whiskmap::uncertainty::{Draws, NoDraws, Spread};

/// `--samples` and `--seed`.
#[derive(Debug, Args)]
pub struct Sampling {
    /// Whiskers to draw from the scene's [uncertainty]; the table then has percentiles of their push angles, and a plot shows
    /// them as bands
    #[arg(long, value_name = "N", value_parser = whole(2..=1_000_000))]
    samples: Option<u32>,
    /// Which samples are drawn
    #[arg(long, value_name = "S", default_value = "1", requires = "samples", value_parser = whole(0..=u32::MAX))]
    seed: u32,
}

impl Sampling {
    /// Draws the whiskers, if that was asked.
    pub fn draw(&self, scene: &Scene) -> Result<Option<Draws>, Failure> {
        let Some(samples) = self.samples else {
            return Ok(None);
        };
        let draws = Draws::new(scene, samples as usize, u64::from(self.seed));
        let draws = draws.map_err(|why| match why {
            NoDraws::Sweep(_) => Failure::Input(format!("{why} with --samples")),
            _ => Failure::Input(format!("--samples {samples}: {why}")),
        })?;
        Ok(Some(draws))
    }
}

/// Writes how the `draws` spread, and draws it around the curve of the `scene` itself.
pub fn run(
    scene: &Scene,
    draws: &Draws,
    resolution: Resolution,
    mut outputs: Opened,
) -> Result<(), Failure> {
    let bar = Progress::over(Side::BOTH.len() * draws.len(), "curves");
    let spread = |side| draws.spread(resolution, side, || bar.inc(1));
    let rows: Vec<Spread> = Side::BOTH.into_iter().flat_map(spread).collect();
    bar.finish();
    if draws.refused > 0 {
        let (refused, kept) = (draws.refused, draws.len());
        say(&format!(
            "note: {refused} of {} draws were outside of the scene's limits, and were drawn again",
            refused + kept as u64
        ));
    }
    outputs.rows(&rows)?;
    outputs.finish(scene.title.clone(), || Plot {
        bands: bands(&rows),
        ..own_curve(scene, resolution, AXES)
    })?;
    let unresolved = rows.iter().map(|row| row.unresolved).sum();
    let all = rows.len() * draws.len();
    check_resolved(
        unresolved,
        all as u64,
        "sampled ends",
        "the column `unresolved`",
    )
}
