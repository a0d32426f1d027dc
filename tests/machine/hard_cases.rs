//! What the GPU makes of hard cases, in rows of many cells: the map is the CPU's, and most cells are the GPU's.

use crate::by_cpu::by_cpu;
use crate::case::{Case, compute};
use crate::compute::{differences, median_and_worst, open};
use crate::named::named;
use crate::random::{always_the_same, cases};
use crate::shipped;
use proptest::prelude::*;
use std::cell::RefCell;
use std::fmt::Write;
use whiskmap::engine::Engine;
use whiskmap::engine::gpu::{Gpu, Precision};
use whiskmap::map::{EngineCells, STATE_CHANNELS};

tests! {
    Precision:
        named_cases_are_solved_or_fall_back,
        engines_agree_on_random_whiskers;
}

/// What was seen of maps: what became of their cells, and how far those that the engine solved are from those of the CPU.
#[derive(Debug, Default)]
struct Seen {
    cells: EngineCells,
    apart: [Vec<f32>; STATE_CHANNELS.len()],
}

impl Seen {
    /// Of the map of `case` by `gpu`; why it is not that of the CPU, from which states may be as far as `most`.
    fn of(case: &Case, gpu: &mut Gpu, most: f32) -> Result<Self, String> {
        let scene = case.scene();
        let (of_cpu, by_cpu) = by_cpu(&scene);
        let (summary, panel) = compute(&scene, Some(gpu));
        if panel.regime != by_cpu[0].regime || summary.disagreements != of_cpu.disagreements {
            return Err(format!("other regimes: {summary:?}"));
        }
        if summary.audit.differing > 0 {
            return Err(format!("a false alarm: {:?}", summary.audit));
        }
        let apart = differences(&by_cpu[0], &panel);
        for (channel, apart) in STATE_CHANNELS.iter().zip(&apart) {
            let (_, worst) = median_and_worst(apart);
            if worst > most {
                return Err(format!("{channel}: {worst:.1e}"));
            }
        }
        Ok(Self { cells: summary.engine_cells, apart })
    }

    fn add(&mut self, more: Self) {
        let EngineCells { solved, near_edge, missed, not_finite, without_row, on_cpu_instead } =
            more.cells;
        let sum = &mut self.cells;
        sum.solved += solved;
        sum.near_edge += near_edge;
        sum.missed += missed;
        sum.not_finite += not_finite;
        sum.without_row += without_row;
        sum.on_cpu_instead += on_cpu_instead;
        for (sum, more) in self.apart.iter_mut().zip(more.apart) {
            sum.extend(more);
        }
    }

    /// The median and the worst of each channel.
    fn of_channels(&self) -> [(f32, f32); STATE_CHANNELS.len()] {
        self.apart.each_ref().map(|apart| {
            let mut sorted = apart.clone();
            sorted.sort_by(f32::total_cmp);
            median_and_worst(&sorted)
        })
    }

    /// The largest median of a channel, and the worst of all.
    fn medians_and_worst(&self) -> (f32, f32) {
        let each = self.of_channels();
        let largest = |part: fn(&(f32, f32)) -> f32| each.iter().map(part).fold(0.0, f32::max);
        (largest(|each| each.0), largest(|each| each.1))
    }

    /// A line of the table.
    fn line(&self, name: &str) -> String {
        let cells = &self.cells;
        let (median, worst) = self.medians_and_worst();
        format!(
            "{name:36} {:6} {:9} {:6} {:10} {:12}  {median:7.1e} {worst:7.1e}\n",
            cells.solved, cells.near_edge, cells.missed, cells.not_finite, cells.without_row,
        )
    }
}

fn named_cases_are_solved_or_fall_back(precision: Precision) {
    let mut gpu = open(precision);
    let mut table = format!(
        "What {} makes of hard cases in {precision}, against f64 on the CPU.\n\
         WHISKMAP_WRITE_TABLES=1 cargo test --profile checked --test machine named_cases_are_solved\n\n\
         solved: by the GPU; fallback to the CPU: next to the tip, too large a\n\
         bound, numbers that are not finite; no row: cells of rows that no net has\n\
         apart: how far the states that the GPU solved are from those of the CPU, in parts of a channel's largest value along\n\
         the whisker; the largest median of a channel, and the worst of all\n\n\
         {:36} solved near edge missed not finite       no row   median   worst\n",
        gpu.describe().adapter,
        "case",
    );
    let mut all = Seen::default();
    for (name, case) in named() {
        let case = case.dense();
        let seen =
            Seen::of(&case, &mut gpu, WORST_OF_HARD).unwrap_or_else(|why| panic!("{name}: {why}"));
        table += &seen.line(name);
        all.add(seen);
    }
    let EngineCells { solved, without_row, .. } = all.cells;
    // Sheets with several folds have no net.
    assert!(2 * solved > without_row, "{:?}", all.cells);
    table += &all.line("all");
    let _ = writeln!(
        table,
        "\n{:36}                                                  median   worst",
        "channel"
    );
    for (channel, (median, worst)) in STATE_CHANNELS.iter().zip(all.of_channels()) {
        let _ = writeln!(table, "{channel:36} {:48} {median:7.1e} {worst:7.1e}", "");
    }
    let to_write = std::env::var_os("WHISKMAP_WRITE_TABLES").is_some_and(|x| x == "1");
    if to_write && precision == Precision::F32 {
        std::fs::write(shipped::root().join("outputs/f32_stability.txt"), &table).unwrap();
    }
}

/// Number of random whiskers.
const RANDOM: u32 = 100;

/// How far states of hard cases may be from those of the CPU, in parts of a channel's largest value. Measured 1.3e-6 in `f32`.
const WORST_OF_HARD: f32 = 3e-6;

fn engines_agree_on_random_whiskers(precision: Precision) {
    let (gpu, all) = (RefCell::new(open(precision)), RefCell::new(Seen::default()));
    let whiskers = cases().prop_map(|case| case.dense());
    let holds = |case: Case| {
        let seen = Seen::of(&case, &mut gpu.borrow_mut(), WORST_OF_HARD);
        let seen = seen.map_err(TestCaseError::fail)?;
        all.borrow_mut().add(seen);
        Ok(())
    };
    always_the_same(RANDOM).run(&whiskers, holds).unwrap();
    let cells = all.into_inner().cells;
    assert!(2 * cells.solved > cells.without_row, "{cells:?}");
}
