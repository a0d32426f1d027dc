//! Estimated cost of a map, from samples that are computed and discarded.

use super::failure::Failure;
use super::map_format::MapFormat;
use std::time::Instant;
use whiskmap::engine::Engine;
use whiskmap::map::{self, Panel, Stage, Summary, process_seconds};
use whiskmap::plan::{Plan, SAMPLE_LINES, SAMPLE_VALUES};
use whiskmap::scene::Scene;

/// Estimated cost of a map without its files.
pub struct MapCost {
    /// CPU seconds of the map on all threads, scaled from samples. Other load on this machine does not count.
    pub cpu_seconds: f64,
    /// Newton steps per cell of the map, each one trajectory.
    pub steps_per_cell: f64,
}

/// Estimated cost of the files of a map.
pub struct FileCost {
    pub format: MapFormat,
    /// Size of the files on disk, in bytes.
    pub bytes: f64,
    /// CPU seconds to pack the files on all threads, scaled from samples.
    pub cpu_seconds: f64,
}

/// Returns the elapsed seconds of work with these CPU seconds, if no other work is on the cores and all threads of the pool share it.
pub fn on_idle_cores(cpu_seconds: f64) -> f64 {
    cpu_seconds / rayon::current_num_threads() as f64
}

/// Shortest work, in elapsed seconds, whose CPU time counts: the system may add that of running threads at its ticks only.
const MANY_TICKS: f64 = 0.05;

/// CPU seconds of work that took `elapsed` seconds, as the clock of the system shows them in `used`. For short work, and where the system has no clock,
/// all threads count as busy.
fn cpu_seconds_of(elapsed: f64, used: Option<f64>) -> f64 {
    let used = used.filter(|used| elapsed > MANY_TICKS && *used > 0.0);
    used.unwrap_or(elapsed * rayon::current_num_threads() as f64)
}

/// CPU seconds of work that began at `start` with `cpu_start`.
fn cpu_seconds_since(start: Instant, cpu_start: Option<f64>) -> f64 {
    let used = process_seconds().zip(cpu_start).map(|(now, before)| now - before);
    cpu_seconds_of(start.elapsed().as_secs_f64(), used)
}

/// Approximate number of cells of the packed sample. It has many lines, because denser cells pack better.
const PACKED_CELLS: usize = 1 << 18;

/// Estimates the cost of the files of `plan` in these `formats`, from a packed sample, `[format]`.
pub fn file_costs(
    scene: &Scene,
    plan: &Plan,
    formats: &[MapFormat],
) -> Result<Vec<FileCost>, Failure> {
    let whiskers = scene.thinned(1, SAMPLE_VALUES).whisker_count();
    let lines = (PACKED_CELLS / whiskers).isqrt().max(1);
    let (small, small_plan) = thinned(scene, plan, [lines, lines])?;
    let mut groups: Vec<Vec<Panel>> = Vec::new();
    map::run_to_end(&small, &small_plan, None, |panels| {
        groups.push(std::mem::take(panels));
    });
    let by_cells = plan.cells as f64 / small_plan.cells as f64;
    let packed = formats.iter().map(|format| {
        let (start, cpu_start) = (Instant::now(), process_seconds());
        let packed = groups.iter().map(|panels| format.pack(&small, &small_plan, panels));
        let bytes = packed.sum::<u64>() as f64 * by_cells;
        let cpu_seconds = cpu_seconds_since(start, cpu_start) * by_cells;
        FileCost { format: *format, bytes, cpu_seconds }
    });
    Ok(packed.collect())
}

/// Returns a sample of at most these numbers of push angles and distances, and its plan.
fn thinned(scene: &Scene, plan: &Plan, lines: [usize; 2]) -> Result<(Scene, Plan), Failure> {
    let small = scene.thinned_to(lines, SAMPLE_VALUES);
    let small_plan = Plan {
        method: plan.method,
        channels: plan.channels,
        digits: plan.digits,
        ..Plan::new(&small)?
    };
    Ok((small, small_plan))
}

/// Push angles and distances of the first sample.
const FIRST_LINES: usize = 8;

/// Ratio of the numbers of push angles, and of distances, of successive samples.
const DENSER: usize = 2;

/// Estimates the cost of `plan` with an engine, or on the CPU alone, from samples of increasing density.
///
/// The stages of the densest sample are scaled: sheets by whiskers, sides and distances, the others by cells. It is computed up to three times, of which
/// the one with the least CPU time counts. The samples take about `seconds` together on idle cores, unless the first one takes longer. Their density
/// depends on their CPU time alone, because sparse samples cost more by cell: other load on this machine must not change the estimate.
pub fn estimate(
    scene: &Scene,
    plan: &Plan,
    engine: &mut Option<Box<dyn Engine>>,
    seconds: f64,
) -> Result<MapCost, Failure> {
    let (mut lines, mut left) = (FIRST_LINES, seconds);
    let mut found: Vec<MapCost> = Vec::new();
    loop {
        let (start, cpu_start) = (Instant::now(), process_seconds());
        let sample = MapSample::measure(scene, plan, engine, [lines, lines])?;
        let last = on_idle_cores(cpu_seconds_since(start, cpu_start));
        left -= last;
        found.push(sample.scaled_to(scene, plan));
        match denser(lines, last, left) {
            Some(denser) if found.len() == 1 => {
                lines = denser;
                found.clear();
            }
            _ if found.len() < SAMPLES && last <= left => {}
            _ => break,
        }
    }
    let least = found.into_iter().reduce(|one, other| match one.cpu_seconds <= other.cpu_seconds {
        true => one,
        false => other,
    });
    least.ok_or_else(|| Failure::Input("no sample was computed".to_owned()))
}

/// Maximum number of samples of the largest density.
const SAMPLES: usize = 3;

/// Most push angles of a sample for an engine, whose expansions of a row cost the same for any number of cells in it.
const WIDE: usize = 2048;

/// Distances of the first sample of [`compare`]: with this many rows of a wide grid, a net pays.
const COMPARED_LINES: usize = 32;

/// Timed rounds of [`compare`]: a single one may be disturbed.
const ROUNDS: f64 = 3.0;

/// Estimates the seconds of `plan` by each of two `engines`, scaled by cells: `[engine]`.
///
/// Samples are timed in turn, as dense as `seconds` in all allow; the fastest of each counts. A first sample, in which the second engine
/// compiles, does not count.
///
/// # Errors
/// If an engine fails.
pub fn compare(
    scene: &Scene,
    plan: &Plan,
    engines: [&mut Option<Box<dyn Engine>>; 2],
    seconds: f64,
) -> Result<[f64; 2], Failure> {
    let [first, second] = engines;
    MapSample::measure(scene, plan, second, [WIDE, COMPARED_LINES])?;
    let (mut lines, mut left) = (COMPARED_LINES, seconds);
    let mut fastest = [f64::INFINITY; 2];
    loop {
        let start = Instant::now();
        let samples = [
            MapSample::measure(scene, plan, first, [WIDE, lines])?,
            MapSample::measure(scene, plan, second, [WIDE, lines])?,
        ];
        let seconds = samples.map(|sample| sample.summary.wall_seconds * sample.by_cells(plan));
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

/// Returns the lines of the next samples if the last ones took `last` seconds and `left` remain; `None` if they were the last.
fn denser(lines: usize, last: f64, left: f64) -> Option<usize> {
    let is_short = last * (DENSER * DENSER) as f64 <= left;
    (is_short && lines < SAMPLE_LINES).then_some(lines * DENSER)
}

/// Computed sample of a map.
struct MapSample {
    scene: Scene,
    plan: Plan,
    summary: Summary,
}

impl MapSample {
    /// Computes a sample of at most these numbers of push angles and distances.
    fn measure(
        scene: &Scene,
        plan: &Plan,
        engine: &mut Option<Box<dyn Engine>>,
        lines: [usize; 2],
    ) -> Result<Self, Failure> {
        let (scene, plan) = thinned(scene, plan, lines)?;
        let engine = engine.as_mut().map(|engine| &mut **engine as _);
        let summary = map::run_to_end(&scene, &plan, engine, |_| ());
        match summary.engine_failure {
            Some(failure) => Err(failure.into()),
            None => Ok(Self { scene, plan, summary }),
        }
    }

    fn scaled_to(&self, scene: &Scene, plan: &Plan) -> MapCost {
        let rows = |scene: &Scene, plan: &Plan| {
            (plan.whiskers * plan.sides.len() * scene.grid.distance_mm.len()) as f64
        };
        let by_rows = rows(scene, plan) / rows(&self.scene, &self.plan);
        let scaled = Stage::ALL.map(|(stage, _)| match stage {
            Stage::Sheets => self.summary.stage_seconds(stage) * by_rows,
            _ => self.summary.stage_seconds(stage) * self.by_cells(plan),
        });
        let seconds: f64 = scaled.iter().sum();
        // Other processes may take the processor between two stages.
        let stages = Stage::ALL.map(|(stage, _)| self.summary.stage_seconds(stage));
        let elapsed: f64 = stages.iter().sum();
        let busy_threads = cpu_seconds_of(elapsed, self.summary.cpu_seconds) / elapsed;
        MapCost {
            cpu_seconds: seconds * busy_threads,
            steps_per_cell: self.summary.steps as f64 / self.summary.cells() as f64,
        }
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
