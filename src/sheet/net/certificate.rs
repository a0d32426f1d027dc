//! Certificate of panels: trajectories at places of rows between the nodes.

use super::PanelRow;
use super::bound::{MARGIN, SMALLEST_RESIDUAL, VALUE_WEIGHT, larger, largest};
use super::row::NetRow;
use crate::sheet::{Row, Sheet};
use whiskmap_mechanics::numerics::WIDTH;
use whiskmap_mechanics::numerics::expansion::Chebyshev;
use whiskmap_mechanics::shooting::{PlainState, Reader};

/// Number of rows of a panel, and of places along each, at which states are checked.
const CHECKS: usize = 8;

/// Number of checked functions of a state.
const CHECKED: usize = 8;

/// Checked functions of a state, `[function]`: magnitude of the push angle, `tau`, load, contact angle, position `[x, y]` of the base, chord
/// angle, energy.
type Checked = [f64; CHECKED];

/// Expansions of the checked functions along a row.
struct CheckedRow {
    row: Row,
    functions: Chebyshev<CHECKED>,
    /// Weights that convert errors of position, contact angle, chord angle and energy to whisker lengths.
    weights: [f64; 5],
    end: f64,
}

impl CheckedRow {
    fn new(sheet: &Sheet, index: usize, states: &NetRow) -> Option<Self> {
        let values = states.blocks.iter().flat_map(|block| {
            (0..block.count).map(|lane| {
                let numbers = &block.numbers;
                let [x, y] = &numbers.position;
                let all = [
                    &block.push,
                    &block.tau,
                    &block.load,
                    &numbers.contact_angle,
                    x,
                    y,
                    &numbers.chord,
                    &numbers.energy,
                ];
                all.map(|lanes: &[f64; WIDTH]| lanes[lane])
            })
        });
        let values: Vec<Checked> = values.collect();
        let end = sheet.crossings[index].first()?;
        let rod = &sheet.rod;
        let arc = whiskmap_mechanics::rod::arclength(rod, end.tau);
        let force = (end.load * rod.radius(end.tau).powi(2)).abs();
        let push = end.push.min(1.0);
        let sizes = [1.0, arc, arc, push, push * force * arc];
        Some(Self {
            row: sheet.rows[index],
            functions: Chebyshev::through(&values),
            weights: sizes.map(|size| VALUE_WEIGHT / size),
            end: states.end,
        })
    }
}

/// Returns a bound on the errors of the `states` of a panel, in whisker lengths. It follows from trajectories at places of some of its `rows`,
/// and from the error `by_decay` that the coefficients left out are expected to make. It is at least
/// [`SMALLEST_RESIDUAL`]; NaN if a number is, or if no row has states.
pub(super) fn certified(
    sheet: &Sheet,
    reader: &Reader,
    rows: &[PanelRow],
    states: impl Fn(usize) -> Option<NetRow>,
    by_decay: f64,
) -> f64 {
    let last = rows.len() - 1;
    let mut chosen: Vec<usize> = (0..CHECKS).map(|i| rows[i * last / (CHECKS - 1)].row).collect();
    chosen.dedup();
    let checked = chosen.into_iter().filter_map(|row| CheckedRow::new(sheet, row, &states(row)?));
    let checked: Vec<CheckedRow> = checked.collect();
    if checked.is_empty() {
        return f64::NAN;
    }
    // Even parts are no Chebyshev points.
    let place = |i: usize| (i as f64 + 0.37) / CHECKS as f64;
    let expanded = checked
        .iter()
        .flat_map(|row| (0..CHECKS).map(move |i| (row, row.functions.at(place(i) * row.end))));
    let expanded: Vec<(&CheckedRow, Checked)> = expanded.collect();
    let points = expanded.iter().map(|(_, functions)| (functions[1], functions[2]));
    let exact: Vec<PlainState> = sheet.case().shoot(points);
    let sign = sheet.side.sign();
    let misses = expanded.iter().zip(&exact).map(|((checked_row, found), exact)| {
        let [push, tau, _, angle, x, y, chord, energy] = *found;
        let signed_push = sign * push;
        let numbers = reader.numbers(tau, exact, checked_row.row.touch + signed_push, chord);
        let [exact_x, exact_y] = numbers.position;
        let errors = [
            angle - numbers.contact_angle,
            x - exact_x,
            y - exact_y,
            chord - numbers.chord,
            energy - numbers.energy,
        ];
        let miss = exact.pole.distance(checked_row.row.pole(signed_push));
        larger(miss, largest(&errors, &checked_row.weights))
    });
    larger(MARGIN * misses.fold(by_decay, larger), SMALLEST_RESIDUAL)
}
