//! Speed and accuracy of every engine on this machine: `cargo bench --bench engines -- [shots]`.
//!
//! A trajectory is one integration with first derivatives; a shot takes three or four. The miss is the
//! distance, in whisker lengths, of the pole from where it should be, as `f64` sees it.
#![allow(
    clippy::print_stdout,
    reason = "a table on the screen is what this program is for"
)]

#[allow(dead_code, reason = "the tests use the rest")]
#[path = "../tests/gpu_engine/shots.rs"]
mod shots;

use shots::Range;
use std::time::Instant;
use whiskmap::integrate::gpu::{Gpu, Precision};
use whiskmap::integrate::{Cpu, Engine, EngineError, Outcome};
use whiskmap::model::Effects;

fn main() -> Result<(), EngineError> {
    let count = std::env::args()
        .nth(1)
        .and_then(|text| text.parse().ok())
        .unwrap_or(200_000);
    let mut engines: Vec<Box<dyn Engine>> = vec![Box::new(Cpu)];
    for precision in [Precision::F32, Precision::F64] {
        match Gpu::new(precision) {
            Ok(gpu) => engines.push(Box::new(gpu)),
            Err(error) => println!("no gpu {precision}: {error}"),
        }
    }
    for engine in &engines {
        println!("{:?}", engine.describe());
    }
    println!(
        "taper  curv.  engine   Mtraj/s Mshots/s  converged  miss: median      99 %     worst"
    );
    for effects in Effects::all() {
        let range = Range::new(effects, count, 6.5, 7);
        for engine in &mut engines {
            // The first dispatch compiles.
            engine.shoot(effects, &range.rods, &range.shots)?;
            let start = Instant::now();
            let hits = engine.shoot(effects, &range.rods, &range.shots)?;
            let micros = start.elapsed().as_secs_f64() * 1e6;
            let converged = hits.iter().filter(|hit| hit.outcome == Outcome::Converged);
            let trajectories: f64 = hits.iter().map(|hit| f64::from(hit.steps)).sum();
            let mut misses = range.misses(hits.iter().map(|hit| (hit.tau, hit.load)));
            misses.sort_by(f64::total_cmp);
            println!(
                "{:5}  {:5}  {:8} {:7.2} {:8.2} {:10} {:13.1e} {:9.1e} {:9.1e}",
                effects.taper,
                effects.curvature,
                engine.describe().engine,
                trajectories / micros,
                count as f64 / micros,
                converged.count(),
                misses[count / 2],
                misses[count * 99 / 100],
                misses[count - 1],
            );
        }
    }
    Ok(())
}
