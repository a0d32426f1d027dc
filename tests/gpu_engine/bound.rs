//! Residuals of cells: bounds on how far from the wanted place the pole really is, as a trajectory in `f64` sees it.

use crate::cells::Cells;
use crate::compute::{open, open_with};
use crate::random_rods::USUAL;
use crate::every_kind;
use whiskmap::integrate::gpu::{Gpu, Precision, shaders};
use whiskmap::integrate::{CellDifference, Reference};
use whiskmap::rod::{Rest, Rod, arclength};
use whiskmap::shooting::FirstVariation;
use whiskmap::shooting::batch::{Batch, InitialCondition};

/// The `(tau, load)` of a cell on a rod.
type Place = fn(&Rod, &Reference, &CellDifference) -> (f64, f64);

/// From arclength and force.
fn from_numbers(rod: &Rod, reference: &Reference, cell: &CellDifference) -> (f64, f64) {
    let radius = rod.radius(reference.tau);
    let longer = f64::from(cell.numbers[0]) / radius;
    let by = match rod.taper {
        0.0 => longer,
        taper => -(-taper * longer).ln_1p() / taper,
    };
    let tau = reference.tau + by;
    let force = reference.load * radius * radius + f64::from(cell.numbers[2]);
    (tau, force / rod.radius(tau).powi(2))
}

/// The shader, made to tell `tau` and load in two parts each: the file's `f32` would hide what `f64` has found.
fn telling_all() -> String {
    let text = shaders::cells(Precision::F64);
    let before = "// Whether all of this holds.";
    assert_eq!(text.matches(before).count(), 1);
    let numbers = "
        cell.numbers[0] = f32(end.x);
        cell.numbers[1] = f32(end.x - real(cell.numbers[0]));
        cell.numbers[2] = f32(end.y);
        cell.numbers[3] = f32(end.y - real(cell.numbers[2]));
    ";
    text.replace(before, numbers)
}

fn from_parts(_: &Rod, reference: &Reference, cell: &CellDifference) -> (f64, f64) {
    let [a, b, c, d, ..] = cell.numbers.map(f64::from);
    (reference.tau + (a + b), reference.load + (c + d))
}

/// What was seen of the poles of solved cells.
#[derive(Debug)]
struct Seen {
    solved: usize,
    /// In whisker lengths.
    median_miss: f64,
    worst_miss: f64,
    /// Miss over bound at the worst, and over how far base and pole move from the reference to the cell, in the median and at the worst.
    of_bound: f64,
    median_of_moves: f64,
    of_moves: f64,
}

/// The direction of the resting whisker at `tau`.
fn resting(rod: &Rod, tau: f64) -> f64 {
    let s = arclength(rod, tau);
    match rod.spiral {
        Some([k0, k1]) => s * (k0 + 0.5 * k1 * s),
        None => Rest::parabola_tangent(rod, s).to_angle(),
    }
}

fn look(cells: &Cells, gpu: &mut Gpu, place: Place) -> Seen {
    let answers = cells.solve(gpu);
    let solved = answers.iter().zip(cells.places()).zip(&cells.shots);
    let solved = solved.filter(|((cell, _), _)| cell.outcome.is_solved());
    let solved: Vec<_> = solved
        .map(|((cell, (reference, _)), shot)| (cell, &cells.references[reference], shot))
        .collect();
    let condition = |&(cell, reference, shot): &(&CellDifference, &Reference, _)| {
        let shot: &whiskmap::refine::Shot = shot;
        let rod = &cells.rods[shot.rod as usize];
        let (tau, load) = place(rod, reference, cell);
        InitialCondition { rod, tau, load }
    };
    let conditions: Vec<InitialCondition> = solved.iter().map(condition).collect();
    let states = Batch::new(cells.method).shoot::<FirstVariation>(&conditions);
    let (mut misses, mut of_bound, mut of_moves) = (Vec::new(), 0.0_f64, Vec::new());
    for (((cell, reference, shot), here), map) in solved.iter().zip(&conditions).zip(&states) {
        let map = map.full;
        let miss = map.map.pole.distance(shot.pole);
        misses.push(miss);
        of_bound = of_bound.max(miss / f64::from(cell.residual));
        let before = reference.state.full;
        let turn = (map.tangent.to_angle() - before.tangent.to_angle()).abs();
        let bent = (turn - resting(here.rod, here.tau) + resting(here.rod, reference.tau)).abs();
        let bent = bent.min((-turn - resting(here.rod, here.tau) + resting(here.rod, reference.tau)).abs());
        let moves = turn.max(bent) * shot.pole.length() + map.position.distance(before.position);
        // What rounding alone leaves of a miss says nothing of the way.
        of_moves.push((miss - 1e-13) / moves);
    }
    misses.sort_by(f64::total_cmp);
    of_moves.sort_by(f64::total_cmp);
    Seen {
        solved: misses.len(),
        median_miss: misses[misses.len() / 2],
        worst_miss: misses[misses.len() - 1],
        of_bound,
        median_of_moves: of_moves[of_moves.len() / 2],
        of_moves: of_moves[of_moves.len() - 1],
    }
}

#[test]
fn residuals_are_bounds() {
    for (name, cells) in every_kind(100) {
        let gpus = [
            (open(Precision::F32), from_numbers as Place),
            (open_with(Precision::F64, telling_all()), from_parts),
        ];
        for (gpu, place) in gpus {
            let Some(mut gpu) = gpu else { continue };
            let seen = look(&cells, &mut gpu, place);
            eprintln!("{name}: {seen:?}");
        }
    }
}

/// A wrong constant anywhere shows.
#[test]
fn a_wrong_shader_breaks_its_bounds() {
    let cells = Cells::random(USUAL, 40, 3, |_, _| ());
    let text = shaders::cells(Precision::F32);
    for (good, bad) in [
        ("(1175.0 / 8064.0) * k3", "(1176.0 / 8064.0) * k3"),
        ("forcing * (3.0 + forcing", "forcing * (3.001 + forcing"),
        ("let faster = slower + softer", "let faster = slower - softer"),
        ("slower * (2.0 + slower)", "slower * (2.001 + slower)"),
        ("- way.rest_at_contact;", "- 0.999 * way.rest_at_contact;"),
        ("1.5 * way.rod.taper * way.h;", "1.501 * way.rod.taper * way.h;"),
        ("let angle = apart.bent - rest_at_contact;", "let angle = apart.bent;"),
        ("let back = sine_and_versine(-angle);", "let back = sine_and_versine(-1.0001 * angle);"),
    ] {
        assert_eq!(text.matches(good).count(), 1, "{good}");
        let Some(mut gpu) = open_with(Precision::F32, text.replace(good, bad)) else {
            return;
        };
        let seen = look(&cells, &mut gpu, from_numbers);
        eprintln!("{bad}: {seen:?}");
    }
}
