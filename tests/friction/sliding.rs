//! Directions of sliding, against the dissipated energy, the slid distance and contacts that less friction holds.

use super::cone;
use whiskmap::friction::Sliding;
use whiskmap::mechanics::rod::{Rest, Rod, Side, arclength};
use whiskmap::mechanics::shooting::batch::Method;
use whiskmap::scene::Scene;
use whiskmap::sheet::{CurveNode, LevelCurve, Row, Stretch};
use whiskmap::trace::Branch;

/// Half the push angle between the states of a central difference, in radians; the error is proportional to its square.
const HALF: f64 = 1e-4;

/// Work of friction, relative to the work of the base's rotation, below which rounding and the difference hide its sign.
const NO_WORK: f64 = 1e-6;

/// The work of the base's rotation minus the change of bending energy is the energy that friction dissipates. It is positive where the
/// contact slides in either direction, and 0 where it sticks.
#[test]
fn friction_takes_energy_where_the_contact_slides() {
    let mut counts = [0; 3];
    for (a_per_mm, radius_mm) in [(0.0, 0.0), (0.02, 0.0), (0.02, 0.25), (0.04, 1.0)] {
        let scene = cone(a_per_mm, radius_mm, 0.3);
        for side in Side::BOTH {
            for distance in [1.5, 4.0, 9.0, 15.0, 17.5] {
                let branch = Branch::new(&scene.whisker, &scene.pole, side, distance).unwrap();
                let points = branch.points(60).unwrap();
                let stable = points.iter().filter(|point| point.stable);
                for point in stable.filter(|point| point.mark.is_none()) {
                    let push = point.push_angle_deg.to_radians();
                    let [before, after] = [-HALF, HALF].map(|step| {
                        let state = branch.state(push + side.sign() * step, true);
                        state.map(|state| branch.read(&state).energy_nj)
                    });
                    let (Ok(before), Ok(after)) = (before, after) else {
                        continue;
                    };
                    let put_in = 2.0 * HALF * side.sign() * point.base_moment_nnm;
                    let taken = put_in - (after - before);
                    let state = branch.state(push, true).unwrap();
                    let neighbours = [-HALF, HALF].map(|step| {
                        let state = branch.state(push + side.sign() * step, true);
                        state.unwrap().sliding
                    });
                    if neighbours.iter().any(|neighbour| *neighbour != point.sliding) {
                        continue;
                    }
                    let sliding = point.sliding.unwrap();
                    let case = format!(
                        "{a_per_mm} {radius_mm} {side:?} {distance}: {taken:e} of {put_in:e} {point:?}"
                    );
                    let is_none = taken.abs() < NO_WORK * put_in.abs();
                    match sliding {
                        Sliding::Sticks => assert!(is_none, "{case}"),
                        _ => assert!(is_none || taken > 0.0, "{case}"),
                    }
                    counts[sliding as usize] += 1;
                    assert_eq!(branch.shape(&state, 2).state.sliding, Some(sliding), "{case}");
                }
            }
        }
    }
    assert!(counts[0] > 800 && counts[1] > 60 && counts[2] > 10, "{counts:?}");
}

/// The force on the whisker has the tangential component of its sliding direction: all of the friction, toward where the contact slides.
#[test]
fn sliding_is_the_direction_of_the_friction() {
    let scene = cone(0.02, 0.25, 0.3);
    let mut counts = [[0; 2]; 2];
    for side in Side::BOTH {
        for distance in [1.5, 4.0, 9.0, 15.0] {
            let branch = Branch::new(&scene.whisker, &scene.pole, side, distance).unwrap();
            for point in branch.points(60).unwrap() {
                let sign = match point.sliding {
                    Some(Sliding::Tip) => 1.0,
                    Some(Sliding::Base) => -1.0,
                    _ => continue,
                };
                let (sin, cos) = point.contact_angle_deg.to_radians().sin_cos();
                let [x, y] = [point.base_force_x_un, point.base_force_y_un];
                let [along, across] = [cos * x + sin * y, (cos * y - sin * x).abs()];
                let off = along - sign * 0.3 * across;
                assert!(off.abs() <= 1e-8 * across, "{side:?} {distance}: {off:e} {point:?}");
                counts[usize::from(point.stable)][usize::from(sign < 0.0)] += 1;
            }
        }
    }
    assert!(counts[0][0] > 100 && counts[1].iter().all(|count| *count > 10), "{counts:?}");
}

/// The slid distance is the arclength of the contact minus the distance rolled around the pole, along the stable states of a branch.
#[test]
fn sliding_is_what_is_not_rolled() {
    let mut counts = [0, 0];
    for radius_mm in [0.0, 0.25, 1.0] {
        let scene = cone(0.02, radius_mm, 0.3);
        for side in Side::BOTH {
            for distance in [1.5, 4.0, 9.0, 15.0, 18.5] {
                let branch = Branch::new(&scene.whisker, &scene.pole, side, distance).unwrap();
                let points = branch.points(400).unwrap();
                let stable = points.partition_point(|point| point.stable);
                for pair in points[..stable].windows(2) {
                    let [slid, next] = [pair[0], pair[1]].map(|point| {
                        let turned = (point.contact_angle_deg - point.push_angle_deg).to_radians();
                        point.arc_length_mm + side.sign() * radius_mm * turned
                    });
                    // Between points of different direction the contact reverses.
                    let sticks = pair[0].sliding == Some(Sliding::Sticks);
                    if pair[0].sliding == pair[1].sliding && !sticks {
                        let is_base = next < slid;
                        let case = format!("{radius_mm} {side:?} {distance}: {pair:?}");
                        let sliding = if is_base { Sliding::Base } else { Sliding::Tip };
                        assert_eq!(pair[0].sliding, Some(sliding), "{case}");
                        counts[usize::from(is_base)] += 1;
                    }
                }
            }
        }
    }
    assert!(counts.iter().all(|count| *count > 500), "{counts:?}");
}

/// Slid distance of the contact: arclength minus the distance rolled around the pole, in whisker lengths.
fn place(rod: &Rod, node: &CurveNode) -> f64 {
    arclength(rod, node.point.x) + rod.pole * (node.angle - node.signed_push)
}

/// Row of a branch, for any coefficient of friction.
pub struct Frictions {
    pub rod: Rod,
    pub side: Side,
    pub row: Row,
}

impl Frictions {
    pub fn new(scene: &Scene, side: Side, distance: f64) -> Self {
        let rod = scene.whisker.rod(&scene.pole, side);
        let row = Row::new(&Rest::new(&rod), distance / scene.whisker.length_mm);
        Self { rod, side, row }
    }

    /// Slid distance at each of `pushes` (magnitudes, in radians) with the coefficient `friction`, positive for sliding toward the tip.
    fn places(&self, friction: f64, pushes: &[f64]) -> Vec<Option<f64>> {
        let friction = friction * self.side.sign();
        let rod = Rod { friction, ..self.rod.clone() };
        let level = LevelCurve::new(Method::fine(), &rod, self.side, &self.row);
        let continuation = level.continuation(level.touch(), Stretch::Stable).unwrap();
        let state = |push: &f64| level.state_at_push(&continuation.nodes, self.side.sign() * push);
        let place = |push| Some(place(&rod, &state(push)?));
        pushes.iter().map(place).collect()
    }
}

/// A contact that sticks is held where sliding toward the base has ended, by a friction between the limits. No such friction holds a
/// contact that slides.
#[test]
fn where_the_contact_sticks_less_friction_holds_it() {
    let mut counts = [0; 3];
    for (a_per_mm, radius_mm, friction) in
        [(0.02, 0.0, 0.3), (0.02, 0.25, 0.05), (0.02, 0.25, 0.9), (0.04, 1.0, 0.3)]
    {
        let scene = cone(a_per_mm, radius_mm, friction);
        for distance in [1.5, 4.0, 9.0, 15.0, 18.0] {
            let branch = Branch::new(&scene.whisker, &scene.pole, Side::Cf, distance).unwrap();
            let points = branch.points(120).unwrap();
            let inside = points.iter().filter(|p| p.stable && p.mark.is_none());
            let (pushes, slidings): (Vec<f64>, Vec<Sliding>) =
                inside.map(|p| (p.push_angle_deg.to_radians().abs(), p.sliding.unwrap())).unzip();
            let frictions = Frictions::new(&scene, Side::Cf, distance);
            // The reversal lies between two of the points, and is flat.
            let last = pushes[pushes.len() - 1];
            let fine: Vec<f64> = (0..2000).map(|i| last * f64::from(i) / 2000.0).collect();
            let base_limit = frictions.places(-friction, &fine);
            let reversal = base_limit.iter().flatten().copied().fold(f64::INFINITY, f64::min);
            let reversal_at = base_limit.iter().position(|place| *place == Some(reversal)).unwrap();
            for (push, sliding) in pushes.iter().zip(slidings) {
                let case = format!("{a_per_mm} {radius_mm} {distance}: {push} {sliding:?}");
                let beyond = |friction| frictions.places(friction, &[*push])[0].unwrap() - reversal;
                match sliding {
                    Sliding::Base => assert!(*push <= fine[reversal_at + 1], "{case}"),
                    Sliding::Tip => assert!(beyond(friction) > -1e-7, "{case}"),
                    Sliding::Sticks => {
                        assert!(*push >= fine[reversal_at.saturating_sub(1)], "{case}");
                        let (mut low, mut high) = (-friction, friction);
                        // The position of the reversal has an error of the order of (1/2000)^2.
                        assert!(beyond(low) > -1e-7 && beyond(high) < 0.0, "{case}");
                        for _ in 0..12 {
                            let middle = 0.5 * (low + high);
                            *(if beyond(middle) < 0.0 { &mut high } else { &mut low }) = middle;
                        }
                        assert!(beyond(low).abs() < 1e-4, "{case}: {low} {}", beyond(low));
                    }
                }
                counts[sliding as usize] += 1;
            }
        }
    }
    assert!(counts.iter().all(|count| *count > 10), "{counts:?}");
}
