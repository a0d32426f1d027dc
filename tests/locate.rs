//! Contacts from moment and force at the base against the states that have them.

use crate::random_rods::Random;
use crate::shipped;
use whiskmap::Side;
use whiskmap::locate::{BaseReading, LocatedState, Locator, NoLocation, SensorDeviations};
use whiskmap::scene::{Curvature, EulerSpiral, Pole, Whisker};
use whiskmap::trace::{Branch, BranchPoint};

/// Each two of moment and forces, and all three.
const MEASURED: [[bool; 3]; 4] =
    [[true, true, false], [true, false, true], [false, true, true], [true; 3]];

/// The numbers of a state that are `measured`.
fn reading(state: &BranchPoint, measured: [bool; 3]) -> BaseReading {
    let [moment, x, y] = measured;
    BaseReading {
        moment_nnm: moment.then_some(state.base_moment_nnm),
        force_x_un: x.then_some(state.base_force_x_un),
        force_y_un: y.then_some(state.base_force_y_un),
        angle_deg: None,
    }
}

/// Largest relative difference of contact, distance and force and of the push angle in radians; infinite on another side.
fn off(row: &LocatedState, state: &BranchPoint) -> f64 {
    if row.side != Some(state.side) {
        return f64::INFINITY;
    }
    let relative = |found: Option<f64>, other: f64| (found.unwrap() / other - 1.0).abs();
    let push = row.push_angle_deg.unwrap() - state.push_angle_deg;
    [
        relative(row.arc_length_mm, state.arc_length_mm),
        relative(row.distance_mm, state.distance_mm),
        relative(row.force_un, state.force_un),
        push.to_radians().abs(),
    ]
    .into_iter()
    .fold(0.0, f64::max)
}

/// Random whisker with a taper, a parabola and, every third time, a follicle, in front of a pole.
fn random_whisker(random: &mut Random) -> (Whisker, Pole) {
    let follicle = random.unit() < 0.33;
    let cone = Whisker::cone(20.0, [40.0, random.between(0.2, 30.0)], 3.0);
    let whisker = Whisker {
        curvature: Some(Curvature {
            parabola_per_mm: random.between(0.0, 0.03),
            vertex_mm: random.between(-2.0, 2.0),
        }),
        modulus_tip_to_base: random.between(0.6, 1.6),
        follicle_stiffness_nnm_per_rad: follicle.then(|| random.between(300.0, 3000.0)),
        ..cone
    };
    (whisker, Pole::smooth(random.between(0.0, 0.5)))
}

/// States of `whisker` along pushes at some distances.
fn states(whisker: &Whisker, pole: &Pole, distances: &[f64], parts: &[f64]) -> Vec<BranchPoint> {
    let mut states = Vec::new();
    for side in Side::BOTH {
        for distance in distances {
            let distance_mm = distance * whisker.length_mm;
            let branch = Branch::new(whisker, pole, side, distance_mm).unwrap();
            for part in parts {
                let push = part * branch.stable_end_deg();
                let state = branch.state(push.to_radians(), true).unwrap();
                states.push(branch.point_of(&state));
            }
        }
    }
    states
}

/// Checks that every state comes back from each of its readings, up to the rounding of the states times the condition.
fn check_round_trips(name: &str, whisker: &Whisker, pole: &Pole, states: &[BranchPoint]) {
    let locator = Locator::new(whisker, pole);
    for measured in MEASURED {
        let readings: Vec<BaseReading> = states.iter().map(|s| reading(s, measured)).collect();
        let rows = locator.locate(&readings, None);
        for (i, state) in states.iter().enumerate() {
            let of_reading = rows.iter().filter(|row| row.reading == i + 1);
            let found = of_reading.clone().filter(|row| row.reason.is_none());
            let nearest = found.min_by(|a, b| off(a, state).total_cmp(&off(b, state)));
            let context = || {
                let rows: Vec<_> = of_reading.clone().collect();
                format!("{name} {measured:?} {state:?} {rows:?}")
            };
            let nearest = nearest.unwrap_or_else(|| panic!("{}", context()));
            // Numbers of states are accurate to 1e-11 of the length, or of the force times it.
            let most = 1e-9f64.max(1e-11 * nearest.condition.unwrap());
            assert!(off(nearest, state) < most, "{}", context());
            assert_eq!(of_reading.clone().count(), nearest.states, "{}", context());
        }
    }
}

/// A push against a thick pole moves contacts nearer to the base than the pole's radius.
#[test]
fn contacts_nearer_than_the_radius_of_the_pole_come_back() {
    let whisker = Whisker::cone(20.0, [13.396, 0.2679], 2.602);
    let pole = Pole::smooth(1.6);
    let states = states(&whisker, &pole, &[0.09, 0.0982, 0.11], &[0.3, 0.6, 0.9]);
    let is_near = |state: &&BranchPoint| state.arc_length_mm < pole.radius_mm;
    assert!(states.iter().filter(is_near).count() > 8, "{states:?}");
    check_round_trips("thick pole", &whisker, &pole, &states);
}

#[test]
fn states_of_random_whiskers_come_back() {
    let mut random = Random::new(20);
    for i in 0..24 {
        let (whisker, pole) = random_whisker(&mut random);
        let distances = [random.between(0.15, 0.5), random.between(0.5, 0.93)];
        let states = states(&whisker, &pole, &distances, &[0.02, 0.3, 0.7, 0.98]);
        check_round_trips(&format!("{i} {whisker:?} {pole:?}"), &whisker, &pole, &states);
    }
}

/// In a soft follicle, the frame of the forces turns by some radians along a push.
#[test]
fn states_in_soft_follicles_come_back() {
    let mut random = Random::new(21);
    let mut turned: f64 = 0.0;
    for i in 0..12 {
        let (whisker, pole) = random_whisker(&mut random);
        let stiffness = 10f64.powf(random.between(2.3, 3.2));
        let whisker = Whisker { follicle_stiffness_nnm_per_rad: Some(stiffness), ..whisker };
        let distances = [random.between(0.15, 0.5), random.between(0.5, 0.93)];
        let states = states(&whisker, &pole, &distances, &[0.02, 0.3, 0.7, 0.98]);
        let turns = states.iter().map(|state| state.base_moment_nnm.abs() / stiffness);
        turned = turns.fold(turned, f64::max);
        let name = format!("{i} {whisker:?} {pole:?}");
        check_round_trips(&name, &whisker, &pole, &states);
    }
    assert!(turned > 3.0, "{turned}");
}

#[test]
fn states_of_measured_and_traced_whiskers_come_back() {
    for name in ["measured", "traced", "robot"] {
        let scene = shipped::scene(name);
        let states = states(&scene.whisker, &scene.pole, &[0.3, 0.8], &[0.02, 0.4, 0.98]);
        check_round_trips(name, &scene.whisker, &scene.pole, &states);
    }
}

/// Every state that is returned has the numbers of the reading, at its own distance and push.
#[test]
fn several_states_have_the_same_numbers() {
    let scene = shipped::scene("cone");
    let (whisker, pole) = (&scene.whisker, &scene.pole);
    let states = states(whisker, pole, &[0.3, 0.6, 0.9], &[0.1, 0.3, 0.5, 0.7, 0.9]);
    let locator = Locator::new(whisker, pole);
    let mut several = 0;
    for measured in &MEASURED[..3] {
        let readings: Vec<BaseReading> = states.iter().map(|s| reading(s, *measured)).collect();
        for row in locator.locate(&readings, None) {
            several += usize::from(row.states > 1);
            let side = row.side.unwrap();
            // A resting whisker reaches no pole beyond its tip.
            let Ok(branch) = Branch::new(whisker, pole, side, row.distance_mm.unwrap()) else {
                continue;
            };
            let push = row.push_angle_deg.unwrap().to_radians();
            let Ok(state) = branch.state(push, true) else {
                continue;
            };
            let state = branch.point_of(&state);
            let wanted = &states[row.reading - 1];
            let size = wanted.force_un.abs();
            for (i, [found, other, size]) in [
                [state.base_moment_nnm, wanted.base_moment_nnm, size * whisker.length_mm],
                [state.base_force_x_un, wanted.base_force_x_un, size],
                [state.base_force_y_un, wanted.base_force_y_un, size],
            ]
            .into_iter()
            .enumerate()
            {
                let is_same = (found - other).abs() < 1e-7 * size;
                assert!(is_same || !measured[i], "{row:?} {found} {other}");
            }
        }
    }
    assert!(several > 0);
}

/// The first integral of a rod of constant stiffness that is straight or a circle at rest gives the axial force from the moment:
/// `Fx = -(M^2/2 + M K)` for the curvature `K`, in `E I/L` and `E I/L^2`.
#[test]
fn moment_and_axial_force_of_a_cylinder_determine_no_contact() {
    let straight = Whisker {
        curvature: None,
        modulus_tip_to_base: 1.0,
        tip_radius_um: 40.0,
        follicle_stiffness_nnm_per_rad: None,
        ..random_whisker(&mut Random::new(1)).0
    };
    let circle = Whisker {
        euler_spiral: Some(EulerSpiral { per_mm: 0.04, per_mm2: 0.0 }),
        ..straight.clone()
    };
    let pole = Pole::smooth(0.2);
    for (whisker, curvature) in [(straight, 0.0), (circle, 0.04 * 20.0)] {
        let states = states(&whisker, &pole, &[0.5], &[0.2, 0.8]);
        let locator = Locator::new(&whisker, &pole);
        let units = whisker.units();
        for state in &states {
            let moment = state.base_moment_nnm / units.moment_nnm;
            let axial = state.base_force_x_un / units.force_un;
            let integral = -(0.5 * moment * moment + moment * curvature);
            assert!((axial - integral).abs() < 1e-9, "{axial} {integral}");
            let found = locator.locate(&[reading(state, [true, true, false])], None)[0];
            assert_eq!(found.reason, Some(NoLocation::Undetermined), "{found:?}");
            for measured in [[true, false, true], [false, true, true], [true; 3]] {
                let rows = locator.locate(&[reading(state, measured)], None);
                assert!(rows.iter().any(|row| off(row, state) < 1e-9), "{rows:?}");
            }
        }
    }
}

/// Moment and axial force nearly follow from each other, up to a condition of a million.
#[test]
fn states_of_nearly_straight_cylinders_come_back() {
    let mut random = Random::new(7);
    let mut most: f64 = 0.0;
    for i in 0..40 {
        let tip_radius_um = match i % 2 {
            0 => 8.0,
            _ => 8.0 * (1.0 - 10f64.powf(random.between(-5.0, -2.0))),
        };
        let whisker = Whisker {
            curvature: Some(Curvature {
                parabola_per_mm: 10f64.powf(random.between(-2.5, -0.5)) / 53.0,
                vertex_mm: random.between(-20.0, 20.0),
            }),
            ..Whisker::cone(53.0, [8.0, tip_radius_um], 3.8)
        };
        let pole = Pole::smooth(random.between(0.0, 0.5));
        let distances = [random.between(0.15, 0.5), random.between(0.5, 0.93)];
        let states = states(&whisker, &pole, &distances, &[0.05, 0.4, 0.95]);
        check_round_trips(&format!("{i} {whisker:?} {pole:?}"), &whisker, &pole, &states);
        let readings: Vec<BaseReading> =
            states.iter().map(|state| reading(state, [true, true, false])).collect();
        let rows = Locator::new(&whisker, &pole).locate(&readings, None);
        most = rows.iter().filter_map(|row| row.condition).fold(most, f64::max);
    }
    assert!(most > 1e5, "{most:e}");
}

/// States that rounding cannot distinguish are one state: moment and axial force of a cylinder with hardly any curvature nearly follow from each other.
#[test]
fn states_that_differ_by_rounding_are_one() {
    let pole = Pole::smooth(0.25);
    let (mut most, mut found, mut all): (f64, usize, usize) = (0.0, 0, 0);
    for parabola_per_mm in [1e-4, 3e-4] {
        let whisker = Whisker {
            curvature: Some(Curvature { parabola_per_mm, vertex_mm: 0.0 }),
            ..Whisker::cone(20.0, [30.0, 30.0], 3.0)
        };
        let states = states(&whisker, &pole, &[0.3, 0.6], &[0.05, 0.2, 0.4, 0.7, 0.95]);
        let readings = states.iter().map(|state| reading(state, [true, true, false]));
        let readings: Vec<BaseReading> = readings.collect();
        let rows = Locator::new(&whisker, &pole).locate(&readings, None);
        for rows in rows.chunk_by(|row, next| row.reading == next.reading) {
            (all, found) = (all + 1, found + usize::from(rows[0].states > 0));
            for pair in rows.windows(2) {
                let [row, next] = [&pair[0], &pair[1]];
                let condition = row.condition.unwrap().min(next.condition.unwrap());
                let arcs = row.arc_length_mm.unwrap() / next.arc_length_mm.unwrap();
                let forces = row.force_un.unwrap() / next.force_un.unwrap();
                let apart = arcs.ln().abs().max(forces.ln().abs());
                assert!(apart > (0.5e-11 * condition).min(0.05), "{row:?} {next:?}");
            }
            most = rows.iter().filter_map(|row| row.condition).fold(most, f64::max);
        }
    }
    assert!(most > 1e9, "{most:e}");
    // Next to a fold, the search may miss a state whose condition is above 1e9.
    assert!(10 * found >= 9 * all, "{found} of {all}");
}

/// The condition of moment and axial force grows as a cone becomes a cylinder, for which they determine nothing.
#[test]
fn the_condition_grows_toward_a_singular_line() {
    let (cone, pole) = random_whisker(&mut Random::new(3));
    let condition = |tip_radius_um: f64| {
        let whisker = Whisker {
            tip_radius_um,
            curvature: None,
            modulus_tip_to_base: 1.0,
            follicle_stiffness_nnm_per_rad: None,
            ..cone.clone()
        };
        let state = states(&whisker, &pole, &[0.6], &[0.5])[1];
        let rows =
            Locator::new(&whisker, &pole).locate(&[reading(&state, [true, true, false])], None);
        let nearest = rows.iter().min_by(|a, b| off(a, &state).total_cmp(&off(b, &state)));
        nearest.unwrap().condition.unwrap()
    };
    let conditions = [20.0, 36.0, 39.6].map(condition);
    assert!(conditions[1] > 3.0 * conditions[0], "{conditions:?}");
    assert!(conditions[2] > 7.0 * conditions[1], "{conditions:?}");
}

/// Standard deviations are those of differences of located states.
#[test]
fn deviations_are_first_order_errors() {
    let scene = shipped::scene("cone");
    let (whisker, pole) = (&scene.whisker, &scene.pole);
    let locator = Locator::new(whisker, pole);
    let sensor = SensorDeviations { moment_nnm: 1.0, force_un: 0.3 };
    for state in states(whisker, pole, &[0.6], &[0.4, 0.8]) {
        for measured in &MEASURED[..3] {
            let wanted = reading(&state, *measured);
            let values = |reading: &BaseReading| {
                let rows = locator.locate(std::slice::from_ref(reading), Some(sensor));
                let nearest = rows.iter().min_by(|a, b| off(a, &state).total_cmp(&off(b, &state)));
                *nearest.unwrap()
            };
            let of = |row: &LocatedState| {
                [row.arc_length_mm, row.distance_mm, row.push_angle_deg, row.force_un]
                    .map(Option::unwrap)
            };
            let mut squares = [0.0; 4];
            let step = 1e-5;
            for i in (0..3).filter(|i| measured[*i]) {
                let moved = |sign: f64| {
                    let mut moved = wanted;
                    let add = |number: &mut Option<f64>, sd: f64| {
                        *number = number.map(|number| number + sign * step * sd)
                    };
                    match i {
                        0 => add(&mut moved.moment_nnm, sensor.moment_nnm),
                        1 => add(&mut moved.force_x_un, sensor.force_un),
                        _ => add(&mut moved.force_y_un, sensor.force_un),
                    }
                    of(&values(&moved))
                };
                let [up, down] = [moved(1.0), moved(-1.0)];
                for (k, square) in squares.iter_mut().enumerate() {
                    *square += ((up[k] - down[k]) / (2.0 * step)).powi(2);
                }
            }
            let row = values(&wanted);
            let deviations =
                [row.arc_length_sd_mm, row.distance_sd_mm, row.push_angle_sd_deg, row.force_sd_un];
            for (deviation, square) in deviations.into_iter().zip(squares) {
                let (deviation, wanted) = (deviation.unwrap(), f64::sqrt(square));
                // The truncation of the differences.
                assert!((deviation / wanted - 1.0).abs() < 1e-5, "{deviation} {wanted} {row:?}");
            }
        }
    }
}

#[test]
fn readings_without_a_state_have_a_reason() {
    let scene = shipped::scene("cone");
    let locator = Locator::new(&scene.whisker, &scene.pole);
    let state = states(&scene.whisker, &scene.pole, &[0.6], &[0.5])[1];
    let good = reading(&state, [true, false, true]);
    let readings = [
        BaseReading { force_y_un: None, ..good },
        BaseReading { moment_nnm: Some(0.0), force_y_un: Some(0.0), ..good },
        // No whisker bends its base to the left by a force to the right at every contact.
        BaseReading { moment_nnm: good.moment_nnm.map(|moment| -moment), ..good },
        good,
    ];
    let rows = locator.locate(&readings, None);
    let reasons: Vec<_> = rows.iter().map(|row| (row.reading, row.reason)).collect();
    let expected = [
        (1, Some(NoLocation::Incomplete)),
        (2, Some(NoLocation::NoLoad)),
        (3, Some(NoLocation::NoState)),
        (4, None),
    ];
    assert_eq!(reasons[..4], expected);
}

/// Three numbers that no state has give the nearest state, weighted by their deviations.
#[test]
fn three_numbers_give_the_nearest_state() {
    let scene = shipped::scene("cone");
    let locator = Locator::new(&scene.whisker, &scene.pole);
    let state = states(&scene.whisker, &scene.pole, &[0.6], &[0.5])[1];
    let mut noisy = reading(&state, [true; 3]);
    noisy.force_x_un = noisy.force_x_un.map(|force| force + 0.02 * state.force_un);
    let none = locator.locate(&[noisy], None)[0];
    assert_eq!(none.reason, Some(NoLocation::NoState));
    let sensor = |force_un: f64| SensorDeviations { moment_nnm: 1e-3, force_un };
    let [loose, tight] = [0.02, 0.001].map(|part| sensor(part * state.force_un));
    let found = locator.locate(&[noisy], Some(loose))[0];
    assert!(off(&found, &state) < 0.1 && found.misfit.unwrap() > 0.01, "{found:?}");
    let found = locator.locate(&[noisy], Some(tight))[0];
    assert_eq!(found.reason, Some(NoLocation::NoState));
}

#[test]
fn the_laboratory_is_turned_by_the_angle_of_the_base() {
    let scene = shipped::scene("cone");
    let locator = Locator::new(&scene.whisker, &scene.pole);
    let state = states(&scene.whisker, &scene.pole, &[0.6], &[0.5])[1];
    let turned = BaseReading { angle_deg: Some(90.0), ..reading(&state, [true, false, true]) };
    let row = locator.locate(&[turned], None)[0];
    let near = |found: Option<f64>, other: Option<f64>, sign: f64| {
        assert!((found.unwrap() - sign * other.unwrap()).abs() < 1e-12, "{row:?}");
    };
    near(row.lab_contact_x_mm, row.contact_y_mm, -1.0);
    near(row.lab_contact_y_mm, row.contact_x_mm, 1.0);
    near(row.lab_pole_x_mm, row.pole_y_mm, -1.0);
    near(row.lab_pole_y_mm, row.pole_x_mm, 1.0);
    let gap = f64::hypot(
        row.pole_x_mm.unwrap() - row.contact_x_mm.unwrap(),
        row.pole_y_mm.unwrap() - row.contact_y_mm.unwrap(),
    );
    assert!((gap - scene.pole.radius_mm).abs() < 1e-12);
}

/// Cells of a map have the states and conditions of readings, and singular lines separate cells with different orientations: on them, the condition is
/// large.
#[test]
fn a_map_has_the_conditions_of_its_states() {
    let scene = shipped::scene("cone").thinned_to([96, 48], 1);
    let (whisker, pole, grid) = (&scene.whisker, &scene.pole, &scene.grid);
    let locator = Locator::new(whisker, pole);
    let map = locator.shared_states(whisker, pole, grid);
    assert!(map.states.len() > 2000, "{}", map.states.len());
    let state_at = |distance_mm: f64, push_deg: f64| {
        let side = Side::of_push(push_deg);
        let branch = Branch::new(whisker, pole, side, distance_mm).unwrap();
        let state = branch.state(push_deg.to_radians(), true).unwrap();
        branch.point_of(&state)
    };
    let nearest = |state: &BranchPoint, measured: [bool; 3]| {
        let rows = locator.locate(&[reading(state, measured)], None);
        let by_off = |one: &&LocatedState, other: &&LocatedState| {
            off(one, state).total_cmp(&off(other, state))
        };
        let nearest = *rows.iter().min_by(by_off).unwrap();
        (rows.len(), nearest.condition.unwrap())
    };
    for shared in map.states.iter().step_by(41) {
        let state = state_at(shared.distance_mm, shared.push_angle_deg);
        let found = [
            (shared.moment_x_states, shared.moment_x_condition),
            (shared.moment_y_states, shared.moment_y_condition),
            (shared.force_states, shared.force_condition),
        ];
        for ((states, condition), measured) in found.into_iter().zip(MEASURED) {
            let (expected, of_reading) = nearest(&state, measured);
            assert_eq!(states, expected, "{shared:?} {measured:?}");
            let off = condition.unwrap() / of_reading - 1.0;
            assert!(off.abs() < 1e-4, "{shared:?} {measured:?}: {of_reading}");
        }
    }
    // Between cells, the line is linear.
    for (pair, measured) in MEASURED[..3].iter().enumerate() {
        let segments = &map.singular[pair];
        assert!(segments.len() > 3, "{pair}: {segments:?}");
        for [[push_deg, distance_mm], _] in segments {
            let state = state_at(*distance_mm, *push_deg);
            let (_, condition) = nearest(&state, *measured);
            assert!(condition > 50.0, "{pair}: {state:?}: {condition}");
        }
    }
}
