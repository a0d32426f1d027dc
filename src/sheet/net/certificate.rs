//! Certificate of panels: trajectories at places of rows between the nodes.

use super::PanelRow;
use super::bound::{MARGIN, VALUE_WEIGHT, larger, largest};
use super::row::NetRow;
use super::values::{SMALLEST_RESIDUAL, ValuePanel};
use crate::numerics::WIDTH;
use crate::numerics::expansion::Chebyshev;
use crate::sheet::{Row, Sheet};
use crate::shooting::PlainState;

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
                all.map(|own: &[f64; WIDTH]| own[lane])
            })
        });
        let values: Vec<Checked> = values.collect();
        let end = sheet.crossings[index].first()?;
        let rod = &sheet.rod;
        let arc = crate::rod::arclength(rod, end.tau);
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

/// Returns a bound on the errors of the states of `panel`, in whisker lengths. It follows from trajectories at places of some of its `rows`,
/// and from the error `by_decay` that the coefficients left out are expected to make. It is at least
/// [`SMALLEST_RESIDUAL`]; NaN if a number is, or if no row has states.
pub(super) fn certified(
    sheet: &Sheet,
    panel: &ValuePanel,
    rows: &[PanelRow],
    by_decay: f64,
) -> f64 {
    let last = rows.len() - 1;
    let mut chosen: Vec<usize> = (0..CHECKS)
        .map(|i| rows[i * last / (CHECKS - 1)].row)
        .collect();
    chosen.dedup();
    let checked = chosen.into_iter().filter_map(|row| {
        let states = panel.row(sheet, row)?;
        CheckedRow::new(sheet, row, &states)
    });
    let checked: Vec<CheckedRow> = checked.collect();
    if checked.is_empty() {
        return f64::NAN;
    }
    // Even parts are no Chebyshev points.
    let place = |i: usize| (i as f64 + 0.37) / CHECKS as f64;
    let expanded = checked
        .iter()
        .flat_map(|own| (0..CHECKS).map(move |i| (own, own.functions.at(place(i) * own.end))));
    let expanded: Vec<(&CheckedRow, Checked)> = expanded.collect();
    let points = expanded.iter().map(|(_, own)| (own[1], own[2]));
    let exact: Vec<PlainState> = sheet.case().shoot(points);
    let sign = sheet.side.sign();
    let misses = expanded.iter().zip(&exact).map(|((own, found), exact)| {
        let [push, tau, _, angle, x, y, chord, energy] = *found;
        let push = sign * push;
        let numbers = panel
            .reader
            .numbers(tau, exact, own.row.touch + push, chord);
        let [exact_x, exact_y] = numbers.position;
        let errors = [
            angle - numbers.contact_angle,
            x - exact_x,
            y - exact_y,
            chord - numbers.chord,
            energy - numbers.energy,
        ];
        let miss = exact.pole.distance(own.row.pole(push));
        larger(miss, largest(&errors, &own.weights))
    });
    larger(MARGIN * misses.fold(by_decay, larger), SMALLEST_RESIDUAL)
}

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]
mod tests {
    use super::super::panel::{NetPanel, along};
    use super::super::row::FUNCTIONS;
    use super::super::size::NetSize;
    use super::super::values::{ALONG, tensor};
    use super::*;
    use crate::numerics::tensor::ChebyshevTensor;
    use crate::rod::{Rod, Side};
    use crate::sheet::Edge;
    use crate::sheet::net::NET_RESIDUAL as MOST;
    use crate::shooting::batch::Method;

    /// Error of a coefficient, as a part of the largest coefficient of its function.
    const SPOIL: f64 = 1e-6;

    /// Coefficients between two spoiled ones: coprime to the sizes, so that all functions and all powers are among them.
    const STRIDE: usize = 11;

    /// The cone of the paper, with rows that end at the fold and at the tip.
    fn cone() -> (Sheet, Vec<PanelRow>) {
        let rod = Rod {
            taper: 0.95,
            bend: 0.4,
            pole: 0.0125,
            ..Rod::default()
        };
        let distances: Vec<f64> = (0..60).map(|i| 0.4 + 0.01 * f64::from(i)).collect();
        let sheet = Sheet::new(Method::fine(), &rod, Side::Cb, &distances);
        let rows = sheet.rows.iter().enumerate();
        let rows = rows.filter_map(|(row, place)| {
            let end = sheet.simple_end(row)?;
            PanelRow::new(&rod, row, place, end.tau)
        });
        let rows = rows.collect();
        (sheet, rows)
    }

    const SIZE: NetSize = NetSize {
        contacts: 28,
        loads: 24,
    };

    fn panel(sheet: &Sheet, rows: &[PanelRow]) -> ValuePanel {
        let last = rows.iter().map(|own| own.contacts[1]);
        let contacts = [rows[0].contacts[0], last.fold(0.0, f64::max)];
        let samples = sheet.samples.as_ref().unwrap();
        let along = along(&sheet.rod, &samples.contacts, contacts, ALONG);
        let panel = ValuePanel::new(sheet, rows, contacts, along, SIZE, MOST);
        panel.unwrap_or_else(|_| panic!("refused"))
    }

    fn bound(sheet: &Sheet, rows: &[PanelRow], panel: &ValuePanel) -> f64 {
        certified(sheet, panel, rows, 0.0)
    }

    /// The tensor of a panel with all its coefficients.
    fn whole(sheet: &Sheet, panel: &ValuePanel) -> ChebyshevTensor<FUNCTIONS> {
        tensor(sheet.case(), &panel.reader, SIZE, &panel.panel.along)
    }

    fn with_tensor(panel: &ValuePanel, tensor: ChebyshevTensor<FUNCTIONS>) -> ValuePanel {
        let NetPanel {
            contacts, along, ..
        } = &panel.panel;
        ValuePanel {
            panel: NetPanel::new(*contacts, along.clone(), SIZE, tensor, SIZE.columns()),
            ..panel.clone()
        }
    }

    /// A single wrong coefficient of any power of any function exceeds the bound, although all others decay. With NaN there is no bound.
    #[test]
    fn a_spoiled_coefficient_is_refused() {
        let (sheet, rows) = cone();
        let edge = |row: &PanelRow| sheet.crossings[row.row][0].edge;
        assert!(
            [Edge::Fold, Edge::Tip]
                .iter()
                .all(|own| rows.iter().any(|row| edge(row) == *own))
        );
        let sound = panel(&sheet, &rows);
        assert!(bound(&sheet, &rows, &sound) <= sound.residual);
        let NetSize { contacts, loads } = SIZE;
        let whole = whole(&sheet, &sound);
        let largest = whole.coefficients.iter().flatten();
        let largest = largest.fold([0.0; FUNCTIONS], |most, own| {
            std::array::from_fn(|i| f64::max(most[i], own[i].abs()))
        });
        for place in (0..contacts * loads * FUNCTIONS).step_by(STRIDE) {
            let (power, function) = (place / FUNCTIONS, place % FUNCTIONS);
            let (in_u, in_p) = (power / loads, power % loads);
            let spoiled = |change: &dyn Fn(&mut f64)| {
                let mut tensor = whole.clone();
                change(&mut tensor.coefficients[in_u][in_p][function]);
                bound(&sheet, &rows, &with_tensor(&sound, tensor))
            };
            let wrong = spoiled(&|own| *own += SPOIL * largest[function]);
            let without = spoiled(&|own| *own = f64::NAN);
            assert!(
                (wrong > MOST || wrong.is_nan()) && without.is_nan(),
                "function {function}, powers {in_u} and {in_p}: {wrong:e} {without:e}"
            );
        }
    }

    /// A wrong node, or a wrong scale of the load, is found by the decay of the coefficients or by the trajectories.
    #[test]
    fn a_spoiled_node_is_refused() {
        let (sheet, rows) = cone();
        let sound = panel(&sheet, &rows);
        let whole = whole(&sheet, &sound);
        let NetSize { contacts, loads } = SIZE;
        for node in (0..contacts * loads).step_by(29) {
            let (in_u, in_p) = (node / loads, node % loads);
            let weight = |count: usize, node: usize| {
                let mut values = vec![[0.0; 1]; count];
                values[node] = [1.0];
                Chebyshev::through(&values).coefficients
            };
            let (by_u, by_p) = (weight(contacts, in_u), weight(loads, in_p));
            for function in 0..FUNCTIONS {
                let mut tensor = whole.clone();
                for (terms, [by_u]) in tensor.coefficients.iter_mut().zip(&by_u) {
                    for (term, [by_p]) in terms.iter_mut().zip(&by_p) {
                        term[function] += 1e-6 * by_u * by_p;
                    }
                }
                let spoiled = with_tensor(&sound, tensor);
                let error = certified(&sheet, &spoiled, &rows, spoiled.error());
                assert!(
                    error > MOST || error.is_nan(),
                    "node {node}, function {function}: {error:e}"
                );
            }
        }
    }

    /// States of the net at random contacts and loads of a row are those of trajectories.
    #[test]
    fn a_bound_is_four_times_the_largest_error() {
        let (sheet, rows) = cone();
        let sound = panel(&sheet, &rows);
        let by_decay = |error: f64| certified(&sheet, &sound, &rows, error);
        assert_eq!(by_decay(1e-6), 4e-6);
        let own = by_decay(0.0);
        assert!((1e-12..1e-10).contains(&own), "{own:e}");
        let spoiled = |function: usize, change: f64| {
            let mut tensor = sound.panel.tensor.clone();
            tensor.coefficients[0][0][function] += change;
            bound(&sheet, &rows, &with_tensor(&sound, tensor))
        };
        // The direction of the pole: the pole is missed by its distance times the change.
        let farthest = sheet.rows[rows[rows.len() - 1].row].pole_distance;
        let by_phi = spoiled(1, SPOIL) / (MARGIN * SPOIL);
        assert!((by_phi / farthest - 1.0).abs() < 1e-3, "{by_phi}");
        let by_angle = spoiled(2, SPOIL) / (MARGIN * SPOIL * VALUE_WEIGHT);
        assert!((by_angle - 1.0).abs() < 1e-3, "{by_angle}");
    }
}
