//! What a map would take, measured: samples of it are computed and thrown away.

use super::failure::Failure;
use clap::ValueEnum;
use std::convert::Infallible;
use std::time::Instant;
use whiskmap::engine::Engine;
use whiskmap::map::{self, Panel, Stage, Summary};
use whiskmap::plan::{Plan, SAMPLE_LINES, SAMPLE_VALUES};
use whiskmap::scene::Scene;
use whiskmap::store::{self, MapWriter, ZarrStore};

/// What a map would take.
pub struct Estimate {
    /// Wall seconds on all threads, without the files.
    pub seconds: f64,
    /// Newton steps per cell, each one trajectory.
    pub steps_per_cell: f64,
}

/// What the files of a map take.
pub struct Files {
    /// Their format.
    pub format: Format,
    /// Bytes on disk.
    pub bytes: f64,
    /// Wall seconds on all threads to pack them.
    pub seconds: f64,
}

/// Formats of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// One OpenEXR file, and a picture of it
    Exr,
    /// A Zarr store, for any number of axes, runs and machines
    Zarr,
}

impl Format {
    /// Those that can hold a map of `scene`.
    pub fn of(scene: &Scene) -> Vec<Self> {
        let mut formats = vec![Self::Exr, Self::Zarr];
        formats.retain(|format| *format == Self::Zarr || scene.grid.sweep.len() <= 2);
        formats
    }

    /// Packs some panels of `scene`, and tells how many bytes they take.
    fn pack(self, scene: &Scene, plan: &Plan, panels: &[Panel]) -> Result<u64, store::Error> {
        match self {
            Self::Exr => Ok(MapWriter::sample(&scene.grid, plan.channels, panels)),
            Self::Zarr => ZarrStore::sample(scene, plan.channels, panels),
        }
    }
}

/// Cells of the sample that is packed, about: many lines, because the closer cells are, the better they pack.
const PACKED_CELLS: usize = 1 << 18;

/// What the files of `plan` would take in these `formats`, from a packed sample.
pub fn files(scene: &Scene, plan: &Plan, formats: &[Format]) -> Result<Vec<Files>, Failure> {
    let whiskers = scene.thinned(1, SAMPLE_VALUES).whisker_count();
    let lines = (PACKED_CELLS / whiskers).isqrt().max(1);
    let (small, small_plan) = thinned(scene, plan, [lines, lines])?;
    let mut groups: Vec<Vec<Panel>> = Vec::new();
    let mut keep = |panels| {
        groups.push(panels);
        Ok::<(), Infallible>(())
    };
    let Ok(_) = map::run(&small, &small_plan, None, &mut |_| (), &mut keep);
    let by_cells = plan.cells as f64 / small_plan.cells as f64;
    let packed = formats.iter().map(|format| {
        let start = Instant::now();
        let mut bytes = 0;
        for panels in &groups {
            bytes += format.pack(&small, &small_plan, panels)?;
        }
        Ok(Files {
            format: *format,
            bytes: bytes as f64 * by_cells,
            seconds: start.elapsed().as_secs_f64() * by_cells,
        })
    });
    packed.collect()
}

/// A sample of at most so many push angles and distances, and its plan.
fn thinned(scene: &Scene, plan: &Plan, lines: [usize; 2]) -> Result<(Scene, Plan), Failure> {
    let small = scene.thinned_to(lines, SAMPLE_VALUES);
    let small_plan = Plan {
        method: plan.method,
        channels: plan.channels,
        ..Plan::new(&small)?
    };
    Ok((small, small_plan))
}

/// Lines of the first sample.
const FIRST_LINES: usize = 8;

/// From one sample to the next: so many times as many push angles, and distances.
const DENSER: usize = 2;

/// Measures samples of `scene` on the CPU alone, each [`DENSER`] than the one before, and scales the last one's stages to `plan`: sheets
/// by whiskers, sides and distances, the rest by cells. All samples, but for the first, take so many `seconds` together, as the ones
/// before foretell.
pub fn estimate(scene: &Scene, plan: &Plan, seconds: f64) -> Result<Estimate, Failure> {
    let (mut lines, mut left) = (FIRST_LINES, seconds);
    loop {
        let start = Instant::now();
        let sample = measured(scene, plan, &mut None, [lines, lines])?;
        let last = start.elapsed().as_secs_f64();
        left -= last;
        match denser(lines, last, left) {
            Some(denser) => lines = denser,
            None => return Ok(sample.scaled_to(scene, plan)),
        }
    }
}

/// Most push angles of a sample for an engine, whose references cost the same for a row of few cells as for one of many.
const WIDE: usize = 2048;

/// Rounds for which [`compare`] keeps time: one alone may have been held up.
const ROUNDS: f64 = 3.0;

/// Seconds that `plan` would take the CPU alone, and with `engine`, scaled by cells: samples in turn, as dense as so many `seconds` in all
/// allow, and of each the fastest. Before them `engine` has one that does not count, for which it compiles.
///
/// # Errors
/// When the engine fails.
pub fn compare(
    scene: &Scene,
    plan: &Plan,
    engine: &mut Option<Box<dyn Engine>>,
    seconds: f64,
) -> Result<[f64; 2], Failure> {
    measured(scene, plan, engine, [WIDE, FIRST_LINES])?;
    let (mut lines, mut left) = (FIRST_LINES, seconds);
    let mut fastest = [f64::INFINITY; 2];
    loop {
        let start = Instant::now();
        let cpu = measured(scene, plan, &mut None, [WIDE, lines])?;
        let with_engine = measured(scene, plan, engine, [WIDE, lines])?;
        let seconds = [cpu, with_engine].map(|sample| sample.wall_seconds(plan));
        fastest = [0, 1].map(|i| f64::min(fastest[i], seconds[i]));
        let last = start.elapsed().as_secs_f64();
        left -= last;
        if let Some(denser) = denser(lines, ROUNDS * last, left) {
            (lines, fastest) = (denser, [f64::INFINITY; 2]);
        } else if left < last {
            return Ok(fastest);
        }
    }
}

/// The lines of the samples after some that took `last` seconds, with so many `left`; none where those are the last.
fn denser(lines: usize, last: f64, left: f64) -> Option<usize> {
    let is_short = last * (DENSER * DENSER) as f64 <= left;
    (is_short && lines < SAMPLE_LINES).then_some(lines * DENSER)
}

/// A sample of a map.
struct Sample {
    scene: Scene,
    plan: Plan,
    summary: Summary,
}

/// Measures a sample of at most so many push angles and distances.
fn measured(
    scene: &Scene,
    plan: &Plan,
    engine: &mut Option<Box<dyn Engine>>,
    lines: [usize; 2],
) -> Result<Sample, Failure> {
    let (scene, plan) = thinned(scene, plan, lines)?;
    let engine = engine.as_mut().map(|engine| &mut **engine as _);
    let discard = &mut |_| Ok::<(), Infallible>(());
    let Ok(summary) = map::run(&scene, &plan, engine, &mut |_| (), discard);
    match summary.engine_failure {
        Some(failure) => Err(failure.into()),
        None => Ok(Sample {
            scene,
            plan,
            summary,
        }),
    }
}

impl Sample {
    /// What `plan` of `scene` would take.
    fn scaled_to(&self, scene: &Scene, plan: &Plan) -> Estimate {
        let rows = |scene: &Scene, plan: &Plan| {
            (plan.whiskers * plan.sides.len() * scene.grid.distance_mm.len()) as f64
        };
        let by_rows = rows(scene, plan) / rows(&self.scene, &self.plan);
        let seconds = Stage::ALL.map(|(stage, _)| match stage {
            Stage::Sheets => self.summary.stage_seconds(stage) * by_rows,
            _ => self.summary.stage_seconds(stage) * self.by_cells(plan),
        });
        Estimate {
            seconds: seconds.iter().sum(),
            steps_per_cell: self.summary.steps as f64 / self.summary.cells() as f64,
        }
    }

    /// Seconds that `plan` would take where a row of it is like one of the sample.
    fn wall_seconds(&self, plan: &Plan) -> f64 {
        self.summary.wall_seconds() * self.by_cells(plan)
    }

    fn by_cells(&self, plan: &Plan) -> f64 {
        plan.cells as f64 / self.plan.cells as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_sample_is_the_last() {
        assert_eq!(denser(8, 0.01, 0.05), Some(16));
        assert_eq!(denser(64, 0.01, 0.05), Some(SAMPLE_LINES));
        assert_eq!(denser(SAMPLE_LINES, 0.01, 0.05), None);
        assert_eq!(denser(8, 0.01, 0.03), None);
        assert_eq!(denser(8, 0.01, -0.01), None);
    }
}
