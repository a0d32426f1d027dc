//! Cost per cell by size of the map and number of whiskers: `cargo bench --bench sizes -- [runs]`.
//!
//! It maps `scenes/cone.toml` on one thread, without a file: from 64 x 64 to 2048 x 2048 cells, then 128 x 128 cells for each of 4 to
//! 1024 whiskers. It prints wall microseconds per cell and stage of the fastest of some interleaved runs. Small maps are repeated, so
//! that each run takes long enough for the clock.
#![allow(clippy::print_stdout, reason = "the program prints a table")]
#![allow(clippy::expect_used, reason = "a benchmark that cannot start panics")]

use whiskmap::map::{self, Stage};
use whiskmap::plan::Plan;
use whiskmap::scene::Scene;

/// Minimum number of cells of a run.
const CELLS: usize = 1 << 18;

fn main() {
    let runs = std::env::args().find_map(|text| text.parse().ok()).unwrap_or(5);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.expect("a thread can be started");
    let sides = [64, 128, 256, 512, 1024, 2048].map(|side| (side, 1));
    let whiskers = [4, 16, 64, 256, 1024].map(|whiskers| (128, whiskers));
    let maps: Vec<Map> = sides.into_iter().chain(whiskers).map(Map::new).collect();
    let mut fastest = vec![vec![f64::INFINITY]; maps.len()];
    for _ in 0..runs {
        for (map, fastest) in maps.iter().zip(&mut fastest) {
            let micros = pool.install(|| map.micros_per_cell());
            if micros.iter().sum::<f64>() < fastest.iter().sum() {
                *fastest = micros;
            }
        }
    }
    print!("      cells  us/cell");
    for (_, name) in Stage::ALL {
        print!("  {name}");
    }
    println!();
    for (map, fastest) in maps.iter().zip(&fastest) {
        print!("{:>11}  {:7.3}", map.name, fastest.iter().sum::<f64>());
        for (micros, (_, name)) in fastest.iter().zip(Stage::ALL) {
            print!("  {micros:width$.3}", width = name.len());
        }
        println!();
    }
}

/// Map that is measured.
struct Map {
    name: String,
    scene: Scene,
    plan: Plan,
}

impl Map {
    fn new((side, whiskers): (usize, usize)) -> Self {
        let taper = format!("taper = {{ from = 0.9, to = 0.95, count = {whiskers} }}\n\n[output]");
        let mut text =
            include_str!("../scenes/cone.toml").replace("count = 512", &format!("count = {side}"));
        let mut name = format!("{side}^2");
        if whiskers > 1 {
            text = text.replace("[output]", &taper);
            text = text.replace("tip_radius_um", "# tip_radius_um");
            name = format!("{whiskers} x {name}");
        }
        let scene = Scene::parse(&text, "cone.toml").expect("the scene is valid");
        let plan = Plan::new(&scene).expect("the map fits into memory");
        assert_eq!(plan.cells, side * side * whiskers, "the scene's text has changed");
        Self { name, scene, plan }
    }

    /// Wall microseconds per cell, one value per stage.
    fn micros_per_cell(&self) -> Vec<f64> {
        let repeats = CELLS.div_ceil(self.plan.cells);
        let mut seconds = [0.0; Stage::ALL.len()];
        for _ in 0..repeats {
            let summary = map::run_to_end(&self.scene, &self.plan, None, |_| ());
            for (sum, (stage, _)) in seconds.iter_mut().zip(Stage::ALL) {
                *sum += summary.stage_seconds(stage);
            }
        }
        let cells = (repeats * self.plan.cells) as f64;
        seconds.iter().map(|stage| 1e6 * stage / cells).collect()
    }
}
