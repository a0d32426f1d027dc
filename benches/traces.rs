//! Cost of curves, branches and shapes on one thread: `cargo bench --bench traces`.
#![allow(clippy::print_stdout, reason = "the program prints a table")]
#![allow(clippy::expect_used, reason = "a benchmark that cannot start panics")]

mod measure;

use measure::Group;
use std::hint::black_box;
use whiskmap::Side;
use whiskmap::scene::{Scene, Whisker};
use whiskmap::sensitivity::{Variable, detachments};
use whiskmap::trace::{Branch, corner, curve};

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    pool.build_global().expect("the global pool is not built yet");
    let text = include_str!("../scenes/cone.toml");
    let scene = Scene::parse(text, "cone.toml").expect("the scene is valid");
    let (whisker, pole) = (&scene.whisker, &scene.pole);
    let distances: Vec<f64> = (0..256).map(|i| 2.0 + 18.0 * f64::from(i) / 255.0).collect();
    let branch = Branch::new(whisker, pole, Side::Cb, 10.0).expect("the whisker reaches the pole");
    let state = branch.state(0.5, true).expect("the state exists");

    let group = Group::new("traces");
    group.time("curve, 256 distances, both sides", || {
        Side::BOTH.map(|side| curve(whisker, pole, side, black_box(&distances)))
    });
    let variables = Variable::of_detachments(&scene);
    let twelve: Vec<Variable> = variables.iter().copied().cycle().take(12).collect();
    for (name, variables) in
        [("1 detachment, no derivative", &[][..]), ("1 detachment, 12 derivatives", &twelve)]
    {
        group.time(name, || detachments(black_box(whisker), pole, Side::Cb, &[15.66], variables));
    }
    for (name, variables) in
        [("256 detachments, no derivative", &[][..]), ("256 detachments, 12 derivatives", &twelve)]
    {
        group.time(name, || detachments(black_box(whisker), pole, Side::Cb, &distances, variables));
    }
    let five = &twelve[..5];
    let whiskers: Vec<Whisker> = (0..100)
        .map(|i| Whisker { tip_radius_um: 1.0 + 0.1 * f64::from(i), ..whisker.clone() })
        .collect();
    for (name, variables) in
        [("100 whiskers, both sides", &[][..]), ("100 whiskers, both sides, 5 derivatives", five)]
    {
        group.time(name, || {
            let ends = |whisker| {
                Side::BOTH.map(|side| detachments(whisker, pole, side, &[15.66], variables))
            };
            whiskers.iter().map(ends).collect::<Vec<_>>()
        });
    }
    group.time("corner", || corner(black_box(whisker), pole, Side::Cb));
    group.time("branch, 200 points, one side", || {
        let branch = Branch::new(black_box(whisker), pole, Side::Cb, 10.0);
        branch.and_then(|branch| branch.points(200))
    });
    group.time("shape, 200 places", || branch.shape(black_box(&state), 200));
}
