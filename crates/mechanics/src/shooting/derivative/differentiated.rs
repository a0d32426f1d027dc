//! State and derivatives of each lane, from the dual numbers of a trajectory at the base.

use super::VariationDerivative;
use crate::numerics::{Dual, Lanes, WIDTH};
use crate::shooting::batch::Complex;
use crate::shooting::sensitivity::Arrival;
use crate::shooting::{FullState, ShootingMap, StateDerivative};
use glam::DVec2;

/// State of the trajectory, and its derivatives, `[lane]`.
pub type Differentiated = (FullState, [VariationDerivative; WIDTH]);

/// State and derivatives of each lane from a trajectory that has arrived at the base. `poles` are the pole's centre, and the derivatives
/// of `ln D + i phi` by contact and load.
#[inline(always)]
pub fn spread<T: Lanes>(
    arrival: &Arrival<Dual<T>>,
    [pole, by_tau, by_load]: [Complex<Dual<T>>; 3],
    energy: Dual<T>,
) -> Differentiated {
    let [c, s, x, y, _] = arrival.rod;
    let force = arrival.contact.force;
    let columns =
        [c, s, x, y, force, energy, pole.re, pole.im, by_tau.re, by_tau.im, by_load.re, by_load.im];
    let mut values = [0.0; 12];
    let mut lanes = [[0.0; WIDTH]; 12];
    for (i, column) in columns.iter().enumerate() {
        values[i] = column.value.unpack()[0];
        lanes[i] = column.derivative.unpack();
    }
    transposed(&values, &lanes)
}

/// State and derivatives of each lane from the numbers of [`spread`], `[column]` and `[column][lane]`. It is outside the kernels, because
/// it computes little.
#[inline(never)]
fn transposed(values: &[f64; 12], columns: &[[f64; WIDTH]; 12]) -> Differentiated {
    let pairs = |values: &[f64; 12]| {
        let pair = |i: usize| DVec2::new(values[i], values[i + 1]);
        [0, 2, 6, 8, 10].map(pair)
    };
    let [tangent, position, pole, by_tau, by_load] = pairs(values);
    let full = FullState {
        map: ShootingMap { pole, by_tau, by_load },
        tangent,
        position,
        force: values[4],
        energy: values[5],
    };
    let mut derivatives = [VariationDerivative::default(); WIDTH];
    for (lane, derivative) in derivatives.iter_mut().enumerate() {
        let lane_values = columns.map(|column| column[lane]);
        let [turned, moved, pole, by_tau, by_load] = pairs(&lane_values);
        let centre = full.map.pole;
        *derivative = VariationDerivative {
            state: StateDerivative {
                angle: tangent.perp_dot(turned),
                position: moved,
                force: lane_values[4],
                energy: lane_values[5],
            },
            ln_pole: DVec2::new(centre.dot(pole), centre.perp_dot(pole)) / centre.length_squared(),
            by_tau,
            by_load,
        };
    }
    (full, derivatives)
}
