//! Residuals of cells: bounds on how far from the wanted place the pole really is, as a trajectory in `f64` sees it.

use crate::cells::{RandomRows, near_touch, places, solve};
use crate::compute::{open, open_with};
use crate::kinds::rows_of_every_kind;
use crate::random_rods::USUAL;
use whiskmap::classify::Outcome;
use whiskmap::engine::gpu::{Gpu, Precision, shaders};
use whiskmap::mechanics::shooting::ShootingMap;
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition};

tests! {
    Precision:
        residuals_are_bounds;
    Adapter:
        a_wrong_shader_breaks_its_bounds;
}

/// What was seen of the poles of solved cells.
#[derive(Debug)]
struct Seen {
    solved: usize,
    /// In whisker lengths.
    median_miss: f64,
    worst_miss: f64,
    /// Miss over bound, at the worst.
    of_bound: f64,
}

impl Seen {
    /// Misses and bounds of the cells that `gpu` solves.
    fn of(rows: &RandomRows, gpu: &mut Gpu) -> Self {
        let batch = rows.batch(gpu);
        let cells = solve(gpu, &batch);
        let (mut found, mut wanted) = (Vec::new(), Vec::new());
        for (index, (side, row, push)) in places(&batch).into_iter().enumerate() {
            if cells.outcome[index] != Outcome::Solved {
                continue;
            }
            let sheet = &batch.sides[side].sheet;
            let [tau, load] = cells.points[index].to_array();
            let rod = &sheet.rod;
            found.push(InitialCondition { rod, tau, load });
            let bound = f64::from(cells.residual[index]);
            wanted.push((sheet.rows[row].pole(push), bound));
        }
        let maps = Batch::new(batch.method).shoot::<ShootingMap>(&found);
        let misses = maps.iter().zip(&wanted);
        let misses = misses.map(|(map, (pole, _))| map.pole.distance(*pole));
        let mut misses: Vec<f64> = misses.collect();
        let of_bound = misses.iter().zip(&wanted).map(|(miss, (_, bound))| miss / bound);
        let of_bound = of_bound.fold(0.0, f64::max);
        misses.sort_by(f64::total_cmp);
        Self {
            solved: misses.len(),
            median_miss: misses.get(misses.len() / 2).copied().unwrap_or(0.0),
            worst_miss: misses.last().copied().unwrap_or(0.0),
            of_bound,
        }
    }
}

fn residuals_are_bounds(precision: Precision) {
    let mut gpu = open(precision);
    let (median, worst) = match precision {
        Precision::F32 => (1e-7, 1e-6),
        _ => (1e-11, 1e-10),
    };
    let mut solved = 0;
    for (name, rows) in rows_of_every_kind(160, 4) {
        let seen = Seen::of(&rows, &mut gpu);
        let is_close = seen.median_miss < median && seen.worst_miss < worst;
        assert!(seen.of_bound <= 1.0 && is_close, "{name}: {seen:?}");
        solved += seen.solved;
    }
    assert!(solved > 500_000, "{solved}");
}

/// Approximate number of cells that a sound shader solves in the test of wrong ones.
const SOUND: usize = 20_000;

/// A wrong constant anywhere shows: the pole is missed, or hardly any cell is certified.
fn a_wrong_shader_breaks_its_bounds() {
    let rows = RandomRows::many(160, USUAL, 3, 3, |_, _| ());
    let text = shaders::cells(Precision::F32);
    for (good, bad) in [
        ("let to_end = max(", "let to_end = 1.001 * max("),
        ("end.state - left", "end.state - 1.001 * left"),
        ("row.place - left);\n    let end", "row.place - 0.99 * left);\n    let end"),
        ("pushes[head.y + id - head.x]", "pushes[head.y + id - head.x + 1u]"),
        ("return first;", "return max(first, 1u) - 1u;"),
        ("select(2.0 * y, y, power == 1u)", "2.0 * y"),
    ] {
        assert_eq!(text.matches(good).count(), 1, "{good}");
        let mut gpu = open_with(Precision::F32, text.replace(good, bad));
        let seen = Seen::of(&rows, &mut gpu);
        let batch = rows.batch(&gpu);
        let near_touch = |row| near_touch(&batch, row, Precision::F32);
        let on_host: usize = (0..batch.rows.len()).map(near_touch).sum();
        let is_refused = seen.solved < on_host + SOUND / 100;
        assert!(is_refused || seen.of_bound > 3.0, "{bad}: {seen:?}");
    }
}
