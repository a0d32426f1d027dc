//! Numbers and outcomes of cells, against the states that the refinement finds.

use crate::cells::Cells;
use crate::compute::{open, open_with};
use crate::kinds::every_kind;
use crate::random_rods::USUAL;

use whiskmap::engine::BasePoint;
use whiskmap::engine::gpu::{Gpu, Precision, shaders};
use whiskmap::plan::STATE_CHANNELS;
use whiskmap::refine::{End, Refined};
use whiskmap::rod::Units;
use whiskmap::shooting::{Reader, Reading};

tests! {
    Precision:
        cells_are_those_of_the_refinement;
    Adapter:
        a_wrong_number_shows;
}

type Numbers = [f64; STATE_CHANNELS.len()];

fn numbers(reading: &Reading) -> Numbers {
    [
        reading.arc_length_mm,
        reading.contact_angle_deg,
        reading.force_un,
        reading.base_force_un.x,
        reading.base_force_un.y,
        reading.base_moment_nnm,
        reading.push_chord_deg,
        reading.contact_distance_mm,
        reading.energy_nj,
    ]
}

/// The part of the cells that is solved at least. Measured 97 % in `f32`, and 83 % in `f64`, with the most friction.
const SOLVED: f64 = 0.8;

/// How far numbers may be off, in parts of the largest along the whisker. Measured 1.4e-9 in the median, and at worst 1.1e-6 at the tip
/// of a sharp cone.
const MEDIAN: f64 = 3e-9;
const WORST: f64 = 2e-6;

/// What was seen of cells that the engine solved.
#[derive(Debug)]
struct Seen {
    asked: usize,
    solved: usize,
    /// Cells of which the refinement says something else.
    contradicted: usize,
    /// Median and worst difference of a number, in parts of its largest value along the whisker.
    apart: [(f64, f64); STATE_CHANNELS.len()],
}

impl Seen {
    fn worst(&self) -> f64 {
        self.apart.iter().map(|apart| apart.1).fold(0.0, f64::max)
    }
}

/// Compares what `gpu` makes of `cells` with the refinement.
fn compare(cells: &Cells, gpu: &mut Gpu) -> Seen {
    const NO_UNITS: Units = Units {
        length_mm: 1.0,
        force_un: 1.0,
        moment_nnm: 1.0,
    };
    let answers = cells.solve(gpu);
    let refined = cells.refined();
    let mut largest = vec![Numbers::default(); cells.rods.len()];
    let mut differences: Vec<(usize, Numbers)> = Vec::new();
    let (mut solved, mut contradicted) = (0, 0);
    for (((cell, refined), (index, push)), shot) in answers
        .iter()
        .zip(&refined)
        .zip(cells.places())
        .zip(&cells.shots)
    {
        if !cell.outcome.is_vouched_for() {
            continue;
        }
        solved += 1;
        if refined.end != End::Solved {
            contradicted += 1;
            continue;
        }
        let rod = shot.rod as usize;
        let reader = Reader::new(NO_UNITS, &cells.rods[rod]);
        let BasePoint {
            tau,
            state,
            push: at,
            ..
        } = &cells.references[index];
        let touch = cells.touches[index];
        let known = numbers(&reader.read(*tau, &state.full, touch, *at));
        let Refined { state, .. } = refined;
        let right = numbers(&reader.read(state.tau, &state.full, touch, push));
        let of_one = numbers(&reader.of_one(cells.sheets[rod].side.sign()));
        let found = |i: usize| known[i] + of_one[i] * f64::from(cell.numbers[i]);
        for (largest, right) in largest[rod].iter_mut().zip(right) {
            *largest = f64::max(*largest, right.abs());
        }
        let apart = std::array::from_fn(|i| (found(i) - right[i]).abs());
        differences.push((rod, apart));
    }
    let apart = |i: usize| {
        let parts = differences
            .iter()
            .map(|(rod, apart)| apart[i] / largest[*rod][i]);
        let mut parts: Vec<f64> = parts.filter(|part| !part.is_nan()).collect();
        parts.sort_by(f64::total_cmp);
        (parts[parts.len() / 2], parts[parts.len() - 1])
    };
    Seen {
        asked: answers.len(),
        solved,
        contradicted,
        apart: std::array::from_fn(apart),
    }
}

fn cells_are_those_of_the_refinement(precision: Precision) {
    let mut gpu = open(precision);
    for (name, cells) in every_kind(100) {
        let seen = compare(&cells, &mut gpu);
        let most = |pick: fn(&(f64, f64)) -> f64| seen.apart.iter().map(pick).fold(0.0, f64::max);
        let (median, worst) = (most(|apart| apart.0), most(|apart| apart.1));
        let solved = seen.solved as f64 / seen.asked as f64;
        assert!(
            solved > SOLVED && seen.contradicted == 0 && median < MEDIAN && worst < WORST,
            "{name}: {seen:?}"
        );
    }
}

/// A wrong constant in any of the numbers shows.
fn a_wrong_number_shows() {
    let cells = Cells::random(USUAL, 40, 3, |_, _| ());
    let text = shaders::cells(Precision::F32);
    for (good, bad) in [
        (
            "cell.numbers[0] = f32(radius * end.x",
            "cell.numbers[0] = f32(1.001 * radius * end.x",
        ),
        ("f32(push - angle_of", "f32(push + 1e-5 - angle_of"),
        ("f32(end_force.y)", "f32(1.0001 * end_force.y)"),
        (
            "product(end_force, tangent.sin)",
            "product(end_force, -tangent.sin)",
        ),
        (
            "product(end_force, tangent.cos)",
            "product(end_force, 1.0001 * tangent.cos)",
        ),
        ("Both(position.x, shift.x)", "Both(position.x, shift.y)"),
        (
            "angle_of(moved_contact) - theta",
            "angle_of(moved_contact) - 1.001 * theta",
        ),
        ("2.0 * position + shift", "2.0 * position - shift"),
        (
            "0.5 * product(force, energy).y",
            "0.5001 * product(force, energy).y",
        ),
    ] {
        assert_eq!(text.matches(good).count(), 1, "{good}");
        let mut gpu = open_with(Precision::F32, text.replace(good, bad));
        let seen = compare(&cells, &mut gpu);
        assert!(seen.worst() > 3.0 * WORST, "{bad}: {:.1e}", seen.worst());
    }
}
