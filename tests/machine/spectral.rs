//! Cells of the spectral engine beside trajectories and the CPU engine.

use crate::cells::{places, solve};
use crate::kinds::rows_of_every_kind;
use whiskmap::engine::{Cpu, Outcome, Spectral};
use whiskmap::shooting::ShootingMap;
use whiskmap::shooting::batch::{Batch, InitialCondition};

tests! {
    Nothing:
        states_and_values_are_within_their_bounds;
}

/// Rows that are expanded alone, and rows in patches. At the contact and load of each solved cell, a trajectory meets the pole to its
/// residual. Channel values differ from those of the CPU engine by at most 1e-9 of their size along the row, beside the rounding to `f32`.
fn states_and_values_are_within_their_bounds() {
    for (rows, count) in [(4, 30), (60, 6)] {
        let (mut solved, mut all) = (0, 0);
        for (name, rows) in rows_of_every_kind(rows, count) {
            let mut engine = Spectral::default();
            let batch = rows.batch(&engine);
            let (cells, wanted) = (solve(&mut engine, &batch), Cpu::default().solve(&batch));
            let places = places(&batch);
            let found = (0..cells.len()).filter(|i| cells.outcome[*i] == Outcome::Solved);
            let found: Vec<usize> = found.collect();
            let conditions = found.iter().map(|i| InitialCondition {
                rod: &batch.sides[places[*i].0].sheet.rod,
                tau: cells.points[*i].x,
                load: cells.points[*i].y,
            });
            let conditions: Vec<InitialCondition> = conditions.collect();
            let maps = Batch::new(batch.method).shoot::<ShootingMap>(&conditions);
            for (i, map) in found.iter().zip(maps) {
                let (side, row, push, _) = places[*i];
                let side = &batch.sides[side];
                let miss = map.pole.distance(side.sheet.rows[row].pole(push));
                let bound = f64::from(cells.residual[*i]);
                assert!(
                    miss <= bound && bound <= 1.01e-10,
                    "{name}: {miss:e} {bound:e}"
                );
                assert_eq!(wanted.outcome[*i], Outcome::Solved, "{name}");
                let sizes = side.sizes(&side.sheet.crossings[row][0]);
                let (own, other) = (cells.get(*i).values, wanted.get(*i).values);
                for (channel, size) in sizes.into_iter().enumerate() {
                    let [own, other] = [own[channel], other[channel]].map(f64::from);
                    let rounding = f64::from(f32::EPSILON) * other.abs();
                    let apart = (own - other).abs();
                    assert!(
                        apart <= 1e-9 * size + rounding,
                        "{name} {channel}: {own} {other}"
                    );
                }
            }
            solved += found.len();
            let is_solved =
                |outcome: &&Outcome| matches!(outcome, Outcome::Solved | Outcome::AtTip);
            all += wanted.outcome.iter().filter(is_solved).count();
        }
        assert!(solved > all * 9 / 10, "{rows} rows: {solved} of {all}");
    }
}
