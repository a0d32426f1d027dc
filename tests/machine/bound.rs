//! Residuals of cells: bounds on how far from the wanted place the pole really is, as a trajectory in `f64` sees it.

use crate::cells::{RandomRows, places, solve};
use crate::compute::{open, open_with};
use crate::kinds::every_kind;
use crate::random_rods::USUAL;
use whiskmap::engine::gpu::{Gpu, Precision, shaders};
use whiskmap::engine::{BasePoint, Cells, Outcome};
use whiskmap::rod::arclength;
use whiskmap::shooting::ShootingMap;
use whiskmap::shooting::batch::{Batch, InitialCondition, Method};

tests! {
    Precision:
        residuals_are_bounds;
    Adapter:
        a_wrong_shader_breaks_its_bounds;
}

/// The shader with the part of each contact and force that `f32` leaves out, in place of the contact and the force.
fn remainders() -> String {
    let mut text = shaders::cells(Precision::F64);
    for number in ["cell.numbers[0] = f32(", "cell.numbers[2] = f32("] {
        assert_eq!(text.matches(number).count(), 1);
        text = text.replace(number, &number.replace("f32(", "remainder("));
    }
    text + "fn remainder(x: real) -> f32 { return f32(x - real(f32(x))); }"
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
    /// Misses and bounds of the cells that `gpu` solves. A second shader, `rest`, adds the digits beyond `f32`.
    fn of(rows: &RandomRows, gpu: &mut Gpu, rest: Option<&mut Gpu>) -> Self {
        let batch = rows.batch(gpu);
        let cells = solve(gpu, &batch);
        let rest = rest.map(|rest| solve(rest, &batch));
        let (mut found, mut before, mut wanted) = (Vec::new(), Vec::new(), Vec::new());
        for (index, (side, row, push, base)) in places(&batch).into_iter().enumerate() {
            let (Outcome::Solved, Some(base)) = (cells.outcome[index], base) else {
                continue;
            };
            let sheet = &batch.sides[side].sheet;
            let base = &batch.base_points[base];
            let rod = &sheet.rod;
            let numbers = |cells: &Cells| {
                let [tau, load] = cells.points[index].to_array();
                [arclength(rod, tau), load * rod.radius(tau).powi(2)]
            };
            let [tau, load] = match &rest {
                None => cells.points[index].to_array(),
                Some(rest) => {
                    let whole = numbers(&cells);
                    let [arc, force] = numbers(rest);
                    let at_base = arclength(rod, base.tau);
                    let tau = rod.tau(whole[0] + (arc - at_base));
                    let force = whole[1] + (force - base.state.full.force);
                    [tau, force / rod.radius(tau).powi(2)]
                }
            };
            found.push(InitialCondition { rod, tau, load });
            let BasePoint { tau, load, .. } = *base;
            before.push(InitialCondition { rod, tau, load });
            let pole = sheet.rows[row].pole(push);
            wanted.push((pole, f64::from(cells.residual[index])));
        }
        let maps = Batch::new(batch.method).shoot::<ShootingMap>(&found);
        // A cell goes along the steps of its base point, and a trajectory of its own may have more or fewer.
        let truncated = [&found, &before].map(|conditions| truncation(batch.method, conditions));
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
    let mut gpu = open(precision);
    let (mut rest, median, worst) = match precision {
        Precision::F32 => (None, 2e-9, 1e-7),
        _ => (Some(open_with(precision, remainders())), 1e-14, 1e-11),
    };
    for (name, rows) in every_kind(100) {
        let seen = Seen::of(&rows, &mut gpu, rest.as_mut());
        let is_close = seen.median_miss < median && seen.worst_miss < worst;
        assert!(
            seen.solved > 1000 && seen.of_bound <= 1.0 && is_close,
            "{name}: {seen:?}"
        );
    }
}

/// A wrong constant anywhere shows.
fn a_wrong_shader_breaks_its_bounds() {
    let rows = RandomRows::new(USUAL, 40, 3, |_, _| ());
    let text = shaders::cells(Precision::F32);
    for (good, bad) in [
        ("POSITION_3 * k3", "1.0009 * POSITION_3 * k3"),
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
        let seen = Seen::of(&rows, &mut gpu, None);
        assert!(seen.of_bound > 3.0, "{bad}: {seen:?}");
    }
}
