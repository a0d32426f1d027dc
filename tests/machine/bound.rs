//! Residuals of cells: bounds on how far from the wanted place the pole really is, as a trajectory in `f64` sees it.

use crate::cells::Cells;
use crate::compute::{open, open_with};
use crate::kinds::every_kind;
use crate::random_rods::USUAL;
use whiskmap::engine::gpu::{Gpu, Precision, shaders};
use whiskmap::engine::{BasePoint, CellDifference};
use whiskmap::rod::Rod;
use whiskmap::shooting::ShootingMap;
use whiskmap::shooting::batch::{Batch, InitialCondition, Method};

tests! {
    Precision:
        residuals_are_bounds;
    Adapter:
        a_wrong_shader_breaks_its_bounds;
}

/// The `(tau, load)` of a cell on a rod.
type Place = fn(&Rod, &BasePoint, &CellDifference) -> (f64, f64);

/// From arclength and force.
fn from_numbers(rod: &Rod, reference: &BasePoint, cell: &CellDifference) -> (f64, f64) {
    cell.point(rod, reference)
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

fn from_parts(_: &Rod, reference: &BasePoint, cell: &CellDifference) -> (f64, f64) {
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
    /// Miss over bound, at the worst.
    of_bound: f64,
}

impl Seen {
    fn of(cells: &Cells, gpu: &mut Gpu, place: Place) -> Self {
        let answers = cells.solve(gpu);
        let (mut found, mut before, mut wanted) = (Vec::new(), Vec::new(), Vec::new());
        for ((cell, (reference, _)), shot) in answers.iter().zip(cells.places()).zip(&cells.shots) {
            if cell.outcome.is_vouched_for() {
                let rod = &cells.rods[shot.rod as usize];
                let reference = &cells.references[reference];
                let (tau, load) = place(rod, reference, cell);
                found.push(InitialCondition { rod, tau, load });
                let BasePoint { tau, load, .. } = *reference;
                before.push(InitialCondition { rod, tau, load });
                wanted.push((shot.pole, f64::from(cell.residual)));
            }
        }
        let maps = Batch::new(cells.method).shoot::<ShootingMap>(&found);
        // A cell goes along the steps of its reference, and a trajectory of its own may have more or fewer.
        let truncated = [&found, &before].map(|conditions| truncation(cells.method, conditions));
        let (mut misses, mut of_bound) = (Vec::new(), 0.0_f64);
        for (i, (map, (pole, bound))) in maps.iter().zip(wanted).enumerate() {
            let miss = map.pole.distance(pole);
            misses.push(miss);
            of_bound = of_bound.max((miss - truncated[0][i] - truncated[1][i]) / bound);
        }
        misses.sort_by(f64::total_cmp);
        Self {
            solved: misses.len(),
            median_miss: misses[misses.len() / 2],
            worst_miss: misses[misses.len() - 1],
            of_bound,
        }
    }
}

/// How far from where they belong the poles are, in whisker lengths, for want of steps.
fn truncation(method: Method, conditions: &[InitialCondition]) -> Vec<f64> {
    let finer = Method {
        resolution: method.resolution.doubled(),
        ..method
    };
    let [maps, finer] =
        [method, finer].map(|method| Batch::new(method).shoot::<ShootingMap>(conditions));
    let pairs = maps.iter().zip(&finer);
    pairs
        .map(|(map, finer)| map.pole.distance(finer.pole))
        .collect()
}

fn residuals_are_bounds(precision: Precision) {
    let (mut gpu, place, median, worst) = match precision {
        Precision::F32 => (open(precision), from_numbers as Place, 2e-9, 1e-7),
        Precision::F64 => (
            open_with(precision, telling_all()),
            from_parts as Place,
            1e-14,
            1e-11,
        ),
    };
    for (name, cells) in every_kind(100) {
        let seen = Seen::of(&cells, &mut gpu, place);
        let is_close = seen.median_miss < median && seen.worst_miss < worst;
        assert!(
            seen.solved > 1000 && seen.of_bound <= 1.0 && is_close,
            "{name}: {seen:?}"
        );
    }
}

/// A wrong constant anywhere shows.
fn a_wrong_shader_breaks_its_bounds() {
    let cells = Cells::random(USUAL, 40, 3, |_, _| ());
    let text = shaders::cells(Precision::F32);
    for (good, bad) in [
        ("(1175.0 / 8064.0) * k3", "(1176.0 / 8064.0) * k3"),
        ("forcing * (3.0 + forcing", "forcing * (3.001 + forcing"),
        (
            "let faster = slower + softer",
            "let faster = slower - softer",
        ),
        ("slower * (2.0 + slower)", "slower * (2.001 + slower)"),
        (
            "ds *= expm1_over_small(path.widening * left)",
            "ds *= expm1_over_small(1.1 * path.widening * left)",
        ),
        ("- path.rest_at_contact;", "- 0.999 * path.rest_at_contact;"),
        (
            "1.5 * path.rod.taper * path.h;",
            "1.501 * path.rod.taper * path.h;",
        ),
        (
            "let angle = apart.bent - rest_at_contact;",
            "let angle = apart.bent;",
        ),
        (
            "let back = sine_and_versine(-angle);",
            "let back = sine_and_versine(-1.0001 * angle);",
        ),
    ] {
        assert_eq!(text.matches(good).count(), 1, "{good}");
        let mut gpu = open_with(Precision::F32, text.replace(good, bad));
        let seen = Seen::of(&cells, &mut gpu, from_numbers);
        assert!(seen.of_bound > 3.0, "{bad}: {seen:?}");
    }
}
