//! The shaders' pieces against their twins in Rust: numbers in, numbers out.

use crate::bench::Bench;
use crate::shots::{Random, USUAL};
use bytemuck::Pod;
use whiskmap::integrate::gpu::{Precision, shaders};
use whiskmap::numerics::Real;
use whiskmap::rod::{Effects, Rest, Rod, arclength};
use whiskmap::shooting::sensitivity::{GeneralFirst, SimilarFirst};
use whiskmap::shooting::{
    Bent, Graded, Intrinsic, Material, Rk4, RodSystem, Scales, Section, Sensitivity, State,
    Straight, Uniform, integrate,
};

const PROBE: &str = include_str!("../../shaders/probe.wgsl");

/// A scalar of the shaders.
trait Number: Real + Pod + Into<f64> {
    const PRECISION: Precision;
}

impl Number for f32 {
    const PRECISION: Precision = Precision::F32;
}

impl Number for f64 {
    const PRECISION: Precision = Precision::F64;
}

/// The twin of `probe_steps`.
fn steps<T: Number>(effects: Effects, steps: u32, case: &[T]) -> Vec<T> {
    let [force, twice_bend, taper, h, rho, gradient, arclength] = case[..7] else {
        unreachable!("a case has 19 numbers")
    };
    let scales = if effects.taper || effects.gradient {
        Scales::tapered::<Rk4>(taper, h)
    } else {
        Scales::cylinder::<Rk4>(h)
    };
    let from = Section {
        rho,
        inverse_cube: T::of(1.0) / (rho * rho * rho),
        arclength,
    };
    let rest: [T; 2] = case[7..9].try_into().unwrap();
    let rod: [T; 4] = case[9..13].try_into().unwrap();
    let first: [T; 5] = case[13..18].try_into().unwrap();
    let [c, s, x, y] = rod;
    let [theta_f, x_f, y_f, theta_s, x_s] = first;
    let zero = T::of(0.0);
    let rod = [c, s, x, y, zero];
    let state = (rod, ([theta_f, theta_s], ([x_f, x_s], [y_f])));
    let run = Run {
        force,
        scales,
        from,
        steps,
    };
    let graded = Graded { gradient };
    let (rest, (rod, carried)) = match (effects.curvature, effects.gradient) {
        (true, false) => run.end::<GeneralFirst, _, _>(Bent { twice_bend }, Uniform, (rest, state)),
        (true, true) => run.end::<GeneralFirst, _, _>(Bent { twice_bend }, graded, (rest, state)),
        (false, true) => (
            rest,
            run.end::<GeneralFirst, _, _>(Straight, graded, ((), state))
                .1,
        ),
        (false, false) => {
            // Derivatives by the arclength are not carried: they stay what they were.
            let state = ((), (rod, ([theta_f], ([x_f], [y_f]))));
            let (_, (rod, ([theta_f], ([x_f], y_f)))) =
                run.end::<SimilarFirst, _, _>(Straight, Uniform, state);
            (rest, (rod, ([theta_f, theta_s], ([x_f, x_s], y_f))))
        }
    };
    let ([theta_f, theta_s], ([x_f, x_s], [y_f])) = carried;
    let first = [theta_f, x_f, y_f, theta_s, x_s];
    [&rest[..], &rod[..4], &first].concat()
}

/// Some steps, whatever the rest shape and the material.
struct Run<T> {
    force: T,
    scales: Scales<T>,
    from: Section<T>,
    steps: u32,
}

impl<T: Number> Run<T> {
    fn end<S: Sensitivity<T>, I: Intrinsic<T>, C: Material<T>>(
        &self,
        intrinsic: I,
        material: C,
        start: State<T, I, S>,
    ) -> State<T, I, S> {
        let system = RodSystem {
            force: self.force,
            intrinsic,
            material,
        };
        integrate::<Rk4, T, I, C, S>(&system, &self.scales, self.from, self.steps, start)
    }
}

/// Cases for `probe_steps`: random states on random rods, `steps` steps away from the base at least.
fn cases<T: Number>(effects: Effects, count: u32, steps: u32) -> Vec<Vec<T>> {
    let mut random = Random(11);
    let mut case = || {
        let taper = random.between(0.0, 0.99);
        let tau = random.between(0.5, 4.0);
        let taper = if effects.taper || !effects.gradient {
            taper
        } else {
            0.0
        };
        let rho = if effects.taper {
            f64::exp(-taper * tau)
        } else {
            1.0
        };
        let gradient = random.between(-0.2, 1.0);
        // The base lies where the 64 steps end.
        let arclength = if effects.taper {
            (1.0 - rho) / taper
        } else {
            tau
        };
        let force = random.between(-6.0, 6.0) * rho * rho;
        let twice_bend = random.between(0.0, 1.6);
        let (at_rest, tilt) = (random.between(-1.0, 1.0), random.between(-3.0, 3.0));
        let mut near = || rho * random.between(0.1, 1.0);
        let h = tau / 64.0;
        vec![
            force,
            twice_bend,
            taper,
            h,
            rho,
            gradient,
            arclength,
            at_rest.cos(),
            at_rest.sin(),
            tilt.cos(),
            tilt.sin(),
            -near(),
            near(),
            near(),
            near(),
            near(),
            near(),
            -1.0,
            f64::from(steps),
        ]
    };
    (0..count)
        .map(|_| case().into_iter().map(T::of).collect())
        .collect()
}

/// Rest tangent, tangent, position, derivatives by force and by arclength.
const GROUPS: [std::ops::Range<usize>; 5] = [0..2, 2..4, 4..6, 6..9, 9..11];

/// The worst difference between a shader's text and the twin, each group of numbers by its own size.
fn difference<T: Number>(bench: &Bench, text: &str, effects: Effects, count: u32) -> f64 {
    let cases = cases::<T>(effects, 2000, count);
    let overrides = shaders::overrides(effects);
    let shader = bench.run(text, "probe_steps", &overrides, &cases, 11);
    let mut worst = 0.0_f64;
    for (case, shader) in cases.iter().zip(shader) {
        let rust = steps(effects, count, case);
        for group in GROUPS {
            let size = |x: &[T]| x.iter().map(|&x| x.into().abs()).fold(0.0, f64::max);
            let apart: Vec<T> = group.clone().map(|i| shader[i] - rust[i]).collect();
            let apart = size(&apart) / size(&rust[group.clone()]).max(size(&case[7..][group]));
            assert!(apart.is_finite());
            worst = worst.max(apart);
        }
    }
    worst
}

fn a_step_is_the_twins<T: Number>(one: f64, whole: f64) {
    let Some(bench) = Bench::open(T::PRECISION) else {
        return;
    };
    let text = shaders::model(T::PRECISION, Effects::default()) + PROBE;
    // The others have other states.
    let carried = |effects: &Effects| !effects.profile && !effects.spiral;
    for effects in crate::effect_sets::all().filter(carried) {
        let (found_one, found_whole) = (
            difference::<T>(&bench, &text, effects, 1),
            difference::<T>(&bench, &text, effects, 64),
        );
        eprintln!("{effects:?}: one step {found_one:.1e}, 64 steps {found_whole:.1e}");
        assert!(found_one < one && found_whole < whole);
    }
    // A wrong constant anywhere shows.
    let all = Effects {
        gradient: true,
        ..USUAL
    };
    for (good, bad) in [
        ("let third = h / 3.0;", "let third = h / 3.0001;"),
        ("let half = 0.5 * h;", "let half = 0.499 * h;"),
        (
            "-3.0 * x * expm1_over(-3.0 * x)",
            "-3.0 * x * expm1_over(-2.99 * x)",
        ),
        ("w * (f * y.by_force.y + x)", "w * (f * y.by_force.y - x)"),
        (
            "material.gradient * section.arclength",
            "material.gradient * section.rho",
        ),
        (
            "at_rest * y.rest.y, -at_rest",
            "at_rest * y.rest.y, at_rest",
        ),
    ] {
        assert!(text.contains(good), "{good}");
        let spoiled = difference::<T>(&bench, &text.replace(good, bad), all, 1);
        assert!(spoiled > 2.0 * one, "{bad}: {spoiled:e}");
    }
}

#[test]
fn a_step_is_the_twins_in_f32() {
    // Measured 5.3e-7, and 3.1e-4 where a trajectory magnifies what it starts with.
    a_step_is_the_twins::<f32>(1.5e-6, 2e-3);
}

#[test]
fn a_step_is_the_twins_in_f64() {
    // Measured 9.1e-16 and 6.5e-13.
    a_step_is_the_twins::<f64>(4e-15, 5e-12);
}

/// The contact against that of the rod in `f64`: exp, expm1, asinh and the inversion of the arclength.
fn contacts_are_right<T: Number>(tolerance: f64) {
    let Some(bench) = Bench::open(T::PRECISION) else {
        return;
    };
    let mut random = Random(5);
    let mut cases: Vec<Vec<T>> = Vec::new();
    for taper in [0.0, 1e-12, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.99, 1.0] {
        for bend in [1e-3, 0.1, 0.8, 3.0] {
            for reach in [1e-3, 0.1, 0.3, 0.5, 0.9, 1.0] {
                let slope = random.between(-3.0, 3.0);
                let rod = Rod {
                    taper,
                    bend,
                    slope,
                    ..Rod::default()
                };
                let tau = reach * rod.tau_tip();
                let case = [taper, bend, slope, tau, random.between(-8.0, 8.0)];
                cases.push(case.map(T::of).to_vec());
            }
        }
    }
    let text = shaders::model(T::PRECISION, Effects::default()) + PROBE;
    let overrides = shaders::overrides(USUAL);
    let found = bench.run(&text, "probe_start", &overrides, &cases, 5);
    let mut worst = 0.0_f64;
    for (case, found) in cases.iter().zip(found) {
        let case: Vec<f64> = case.iter().map(|&x| x.into()).collect();
        let rod = Rod {
            taper: case[0],
            bend: case[1],
            slope: case[2],
            ..Rod::default()
        };
        let (radius, s) = (rod.radius(case[3]), arclength(&rod, case[3]));
        let rest = Rest::parabola_tangent(&rod, s);
        let right = [radius, s, case[4] * radius * radius, rest.x, rest.y];
        // Radius, arclength and force by their own sizes, and by that of the exponent beta tau (21 at most),
        // whose rounding they magnify; cos and sin by 1.
        let magnified = 1.0 + rod.taper * case[3];
        let size = |i: usize| {
            if i < 3 {
                right[i].abs() * magnified
            } else {
                1.0
            }
        };
        for i in 0..5 {
            worst = worst.max((found[i].into() - right[i]).abs() / size(i));
        }
    }
    eprintln!("contacts in {}: {worst:.1e}", T::PRECISION);
    assert!(worst < tolerance);
}

#[test]
fn contacts_are_right_in_f32() {
    // Measured 1.4e-7.
    contacts_are_right::<f32>(1e-6);
}

#[test]
fn contacts_are_right_in_f64() {
    // Measured 2.9e-16.
    contacts_are_right::<f64>(2e-15);
}
