//! Derivatives of states by the numbers of a rod, against differences of trajectories with twice the steps.

use super::effects::{conditions, rods};
use glam::DVec2;
use whiskmap_mechanics::rod::{Rest, Rod, RodDerivative};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap_mechanics::shooting::{
    FirstVariation, Resolution, TrajectoryVariable, VariationDerivative, differentiate,
};

/// A change of a rod by one of its numbers.
type Change = (fn(&mut Rod, f64), RodDerivative);

/// Every number of a rod with its rest shape.
fn changes(rod: &Rod) -> Vec<Change> {
    let zero = RodDerivative::default;
    let mut all: Vec<Change> = vec![
        (|rod, h| rod.pole += h, RodDerivative { pole: 1.0, ..zero() }),
        (|rod, h| rod.gradient += h, RodDerivative { gradient: 1.0, ..zero() }),
        (|rod, h| rod.friction += h, RodDerivative { friction: 1.0, ..zero() }),
    ];
    if rod.profile.is_none() {
        all.push((|rod, h| rod.taper += h, RodDerivative { taper: 1.0, ..zero() }));
    }
    if rod.spiral.is_some() {
        all.push((
            |rod, h| rod.spiral = rod.spiral.map(|[k0, k1]| [k0 + h, k1]),
            RodDerivative { spiral: [1.0, 0.0], ..zero() },
        ));
        all.push((
            |rod, h| rod.spiral = rod.spiral.map(|[k0, k1]| [k0, k1 + h]),
            RodDerivative { spiral: [0.0, 1.0], ..zero() },
        ));
    } else if rod.polynomial.is_none() {
        all.push((|rod, h| rod.bend += h, RodDerivative { bend: 1.0, ..zero() }));
        all.push((|rod, h| rod.slope += h, RodDerivative { slope: 1.0, ..zero() }));
    }
    all
}

fn moved(rod: &Rod, change: fn(&mut Rod, f64), h: f64) -> Rod {
    let mut moved = rod.clone();
    change(&mut moved, h);
    moved
}

/// Richardson's extrapolation of central differences with the steps `h` and `h/2`: its error is of order `h^4`.
fn richardson<const N: usize>(h: f64, at: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let central = |h: f64| {
        let (low, high) = (at(-h), at(h));
        std::array::from_fn::<f64, N, _>(|i| (high[i] - low[i]) / (2.0 * h))
    };
    let (whole, half) = (central(h), central(0.5 * h));
    std::array::from_fn(|i| (4.0 * half[i] - whole[i]) / 3.0)
}

/// Angle from one vector to another, exact for small angles.
fn turn(from: DVec2, to: DVec2) -> f64 {
    from.perp_dot(to).atan2(from.dot(to))
}

fn numbers(of: &VariationDerivative) -> [f64; 11] {
    let (state, tau, load) = (of.state, of.by_tau, of.by_load);
    let (position, ln_pole) = (state.position, of.ln_pole);
    [
        state.angle,
        position.x,
        position.y,
        state.force,
        state.energy,
        ln_pole.x,
        ln_pole.y,
        tau.x,
        tau.y,
        load.x,
        load.y,
    ]
}

/// The numbers whose derivatives [`numbers`] lists; angles near those of `here`.
fn values(method: Method, condition: &InitialCondition, here: &FirstVariation) -> [f64; 11] {
    let there = Batch::new(method).shoot::<FirstVariation>(std::slice::from_ref(condition))[0];
    let (full, map) = (there.full, there.full.map);
    let from = here.full.map.pole;
    [
        turn(here.full.tangent, full.tangent),
        full.position.x,
        full.position.y,
        full.force,
        full.energy,
        map.pole.length().ln(),
        turn(from, map.pole),
        map.by_tau.x,
        map.by_tau.y,
        map.by_load.x,
        map.by_load.y,
    ]
}

/// Measured: 1e-10, what differences leave.
#[test]
fn trajectories_are_differentiated_by_every_number() {
    let rods = rods();
    let fine = Method::fine();
    for condition in conditions(&rods) {
        let InitialCondition { rod, tau, load } = condition;
        let here = Batch::new(fine).shoot::<FirstVariation>(&[condition])[0];
        let changes = changes(rod);
        let mut variables = vec![TrajectoryVariable::Tau, TrajectoryVariable::Load];
        variables.extend(changes.iter().map(|(_, by)| TrajectoryVariable::Rod(by)));
        let (full, by) = differentiate(Resolution::FINE, &condition, &variables);
        assert!((full.map.pole - here.full.map.pole).length() < 1e-11);
        assert!((by[0].ln_pole - here.full.map.by_tau).length() < 1e-9);
        assert!((by[1].ln_pole - here.full.map.by_load).length() < 1e-9);
        let doubled = Method::new(Resolution::FINE.doubled());
        for (i, variable) in variables.iter().enumerate() {
            // Change over which the state changes as a whole.
            let size = match (variable, i) {
                (TrajectoryVariable::Tau, _) => 0.3 * tau,
                (TrajectoryVariable::Load, _) => load,
                (_, 2) => 0.1,
                _ => 1.0,
            };
            let at = |h: f64| match (variable, i.checked_sub(2)) {
                (TrajectoryVariable::Tau, _) => {
                    values(doubled, &InitialCondition { tau: tau + h, ..condition }, &here)
                }
                (_, Some(i)) => {
                    let rod = &moved(rod, changes[i].0, h);
                    values(doubled, &InitialCondition { rod, tau, load }, &here)
                }
                _ => values(doubled, &InitialCondition { load: load + h, ..condition }, &here),
            };
            let differences = richardson(1e-3 * size, at);
            for (k, (exact, difference)) in numbers(&by[i]).into_iter().zip(differences).enumerate()
            {
                let apart = (exact - difference).abs() / (1.0 / size + difference.abs());
                assert!(apart < 1e-8, "{rod:?} {variable:?} number {k}: {exact} {difference}");
            }
        }
    }
}

/// The pole at first touch moves with the rest shape, the pole's radius and the distance.
#[test]
fn first_touch_is_differentiated() {
    for rod in rods() {
        let rest = Rest::new(&rod);
        for (change, by) in changes(&rod) {
            for distance in [0.3, 0.8] {
                let (moved_pole, pole) =
                    (rest.touch_derivative(distance, 0.7, &by), rest.pole_at_distance(distance));
                let point = rest.point_derivative(distance, 0.7, &by);
                let at = |h: f64| {
                    let rest = Rest::new(&moved(&rod, change, h));
                    let there = rest.pole_at_distance(distance + 0.7 * h);
                    let point = rest.point_at_distance(distance + 0.7 * h);
                    [there.length().ln(), turn(pole, there), point.x, point.y]
                };
                let differences = richardson(1e-4, at);
                let exact = [moved_pole.x, moved_pole.y, point.x, point.y];
                for (exact, difference) in exact.into_iter().zip(differences) {
                    assert!(
                        (exact - difference).abs() < 1e-10,
                        "{rod:?} {by:?}: {exact} {difference}"
                    );
                }
            }
        }
    }
}
