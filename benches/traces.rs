//! Cost of curves, branches and shapes on one thread: `cargo bench --bench traces`.
#![allow(missing_docs, reason = "criterion's macros make public functions")]
#![allow(clippy::expect_used, reason = "a benchmark that cannot start panics")]

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use whiskmap::rod::Side;
use whiskmap::scene::{Scene, Whisker};
use whiskmap::sensitivity::{Variable, detachments};
use whiskmap::trace::{Branch, WhiskerShape, corner, curve};

fn traces(criterion: &mut Criterion) {
    let text = include_str!("../scenes/cone.toml");
    let scene = Scene::parse(text, "cone.toml").expect("the scene is valid");
    let (whisker, pole) = (&scene.whisker, &scene.pole);
    let distances: Vec<f64> = (0..256)
        .map(|i| 2.0 + 18.0 * f64::from(i) / 255.0)
        .collect();
    let branch = Branch::new(whisker, pole, Side::Cb, 10.0).expect("the whisker reaches the pole");
    let state = branch.state(0.5, true).expect("the state exists");

    let mut group = criterion.benchmark_group("traces");
    group.bench_function("curve, 256 distances, both sides", |bench| {
        bench.iter(|| Side::BOTH.map(|side| curve(whisker, pole, side, black_box(&distances))));
    });
    let variables = Variable::of_detachments(&scene);
    let twelve: Vec<Variable> = variables.iter().copied().cycle().take(12).collect();
    for (name, variables) in [
        ("1 detachment, no derivative", &[][..]),
        ("1 detachment, 12 derivatives", &twelve),
    ] {
        group.bench_function(name, |bench| {
            bench.iter(|| detachments(black_box(whisker), pole, Side::Cb, &[15.66], variables));
        });
    }
    for (name, variables) in [
        ("256 detachments, no derivative", &[][..]),
        ("256 detachments, 12 derivatives", &twelve),
    ] {
        group.bench_function(name, |bench| {
            bench.iter(|| detachments(black_box(whisker), pole, Side::Cb, &distances, variables));
        });
    }
    let five = &twelve[..5];
    let whiskers: Vec<Whisker> = (0..100)
        .map(|i| Whisker {
            tip_radius_um: 1.0 + 0.1 * f64::from(i),
            ..whisker.clone()
        })
        .collect();
    for (name, variables) in [
        ("100 whiskers, both sides", &[][..]),
        ("100 whiskers, both sides, 5 derivatives", five),
    ] {
        group.bench_function(name, |bench| {
            bench.iter(|| {
                let ends =
                    |own| Side::BOTH.map(|side| detachments(own, pole, side, &[15.66], variables));
                whiskers.iter().map(ends).collect::<Vec<_>>()
            });
        });
    }
    group.bench_function("corner", |bench| {
        bench.iter(|| corner(black_box(whisker), pole, Side::Cb));
    });
    group.bench_function("branch, 200 points, one side", |bench| {
        bench.iter(|| {
            let branch = Branch::new(black_box(whisker), pole, Side::Cb, 10.0);
            branch.and_then(|branch| branch.points(200))
        });
    });
    group.bench_function("shape, 200 places", |bench| {
        bench.iter(|| WhiskerShape::new(&branch, black_box(&state), 200));
    });
    group.finish();
}

/// Runs the benchmarks on one thread.
fn one_thread(criterion: &mut Criterion) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    pool.build_global()
        .expect("the global pool is not built yet");
    traces(criterion);
}

criterion_group!(benches, one_thread);
criterion_main!(benches);
