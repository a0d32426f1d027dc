//! Rows of a net: the states of one row at Chebyshev points of its part of the load.

use super::panel::PanelLine;
use crate::sheet::Row;
use crate::sheet::case::SheetCase;
use whiskmap_mechanics::numerics::tensor::LevelBlock;
use whiskmap_mechanics::numerics::{
    LaneNumbers, Lanes, SimdTask, Unit, WIDTH, keep, nearest_turn, pack,
};
use whiskmap_mechanics::rod::radius_and_arclength;
use whiskmap_mechanics::shooting::StateNumbers;
use whiskmap_mechanics::shooting::contact::{direction, exp};

/// Number of functions of a tensor.
pub const FUNCTIONS: usize = 7;

/// States of a row side by side in SIMD lanes.
#[derive(Clone, Copy, Debug)]
pub struct NetBlock {
    /// Number of states of the block.
    pub count: usize,
    /// Magnitudes of the push angles since first touch, in radians: `[state]`.
    pub push: LaneNumbers,
    /// Contact coordinates `tau` of the states, dimensionless: `[state]`.
    pub tau: LaneNumbers,
    /// Signed loads `f/rho^2` of the states, dimensionless: `[state]`.
    pub load: LaneNumbers,
    /// Other numbers of the states: `[state]`.
    pub numbers: StateNumbers<LaneNumbers>,
}

/// Row of a net: its states at the Chebyshev points of a parameter, which is in proportion to the part `p` of the load.
#[derive(Clone, Debug)]
pub struct NetRow {
    /// States of the row by growing load, in blocks of [`WIDTH`].
    pub blocks: Vec<NetBlock>,
    /// Parameter of the row's end, in `[0, 1]`.
    pub end: f64,
}

impl NetRow {
    /// Computes the states at the points of `line`, which belongs to this `row`.
    pub(super) fn of(case: SheetCase, row: &Row, line: &PanelLine<FUNCTIONS>) -> Self {
        let unit = Unit::detect();
        let (touch, points) = (row.touch, &line.points);
        // Angle of the contact's tangent from the normal of the force.
        let tilt = case.rod.contact_tangent().to_angle();
        // The first state is next to first touch.
        let turned = nearest_turn(touch, points[0].values[1][0]);
        let parts = line.parts.chunks(WIDTH);
        let blocks = points.iter().zip(parts).map(|(points, parts)| {
            let mut padded = [0.0; WIDTH];
            padded[..parts.len()].copy_from_slice(parts);
            unit.run(States {
                points,
                parts: &padded,
                taper: case.rod.taper,
                sign: case.side.sign(),
                tilt,
                turned,
                turns: turned - touch,
            })
        });
        Self { blocks: blocks.collect(), end: line.end }
    }
}

/// Numbers of the states of one block of columns.
struct States<'a> {
    points: &'a LevelBlock<FUNCTIONS, 2>,
    parts: &'a LaneNumbers,
    taper: f64,
    sign: f64,
    tilt: f64,
    /// Direction of the pole at first touch, in radians with the turns of the net, and these turns.
    turned: f64,
    turns: f64,
}

impl SimdTask for States<'_> {
    type Output = NetBlock;

    #[inline(always)]
    fn run<T: Lanes>(self) -> NetBlock {
        let mut block = NetBlock {
            count: self.points.count,
            push: [0.0; WIDTH],
            tau: [0.0; WIDTH],
            load: [0.0; WIDTH],
            numbers: StateNumbers::default(),
        };
        for from in (0..block.count).step_by(T::LANES) {
            let [_, phi, angle, x, y, chord, energy] =
                self.points.values.each_ref().map(|lanes| pack::<T>(lanes, from));
            let [ln_tau, ln_q] = self.points.along.each_ref().map(|lanes| pack::<T>(lanes, from));
            let (sign, tau) = (T::of(self.sign), exp(ln_tau));
            let load = sign * pack(self.parts, from) * exp(ln_q - ln_tau - ln_tau);
            let [radius, arclength] = radius_and_arclength(T::of(self.taper), tau);
            let force = load * radius * radius;
            keep(&mut block.push, from, sign * (phi - T::of(self.turned)));
            keep(&mut block.tau, from, tau);
            keep(&mut block.load, from, load);
            let numbers = StateNumbers {
                arclength,
                contact_angle: angle - T::of(self.turns),
                force,
                tangent: direction(T::of(self.tilt) - angle),
                position: [x, y],
                chord,
                energy: energy * sign * force * arclength,
            };
            block.numbers.keep(from, numbers);
        }
        block
    }
}
