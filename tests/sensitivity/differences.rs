//! Exact derivatives of detachments against central differences of ends that are computed independently, in twice the steps.

use super::random_whiskers::{Push, push};
use whiskmap::Side;
use whiskmap::mechanics::shooting::Resolution;
use whiskmap::scene::{Parameter, Scene};
use whiskmap::sensitivity::{Derivatives, NoDerivative, Variable, detachments, largest};
use whiskmap::trace::{Detachment, DetachmentKind, ends_at};

/// Result of the comparison of one push.
#[derive(Clone, Copy, Debug, Default)]
pub struct Compared {
    /// Number of derivatives that were compared.
    pub count: usize,
    /// Number of derivatives without differences: an end has another kind, or lies outside of what scenes accept.
    pub left_out: usize,
    /// Largest difference, relative to the derivative and to the quantity over the size of the variable.
    pub worst: f64,
}

fn quantities(end: &Detachment) -> Option<[f64; 11]> {
    Some([
        end.push_angle_deg?,
        end.push_chord_deg?,
        end.contact_distance_mm?,
        end.arc_length_mm?,
        end.force_un?,
        end.contact_force_un?,
        end.base_force_x_un?,
        end.base_force_y_un?,
        end.base_moment_nnm?,
        end.energy_nj?,
        end.contact_angle_deg?,
    ])
}

fn listed(by: &Derivatives) -> [f64; 11] {
    [
        by.push_angle_deg,
        by.push_chord_deg,
        by.contact_distance_mm,
        by.arc_length_mm,
        by.force_un,
        by.contact_force_un,
        by.base_force_x_un,
        by.base_force_y_un,
        by.base_moment_nnm,
        by.energy_nj,
        by.contact_angle_deg,
    ]
}

/// Largest relative error of differences, as estimated by their extrapolation. Next to the reach and to folds that merge, it is larger.
const KNOWN: f64 = 1e-6;

/// Central differences by `variable`, extrapolated twice to a step of 0, with an error of the sixth order of the step. `None` where an end
/// next to `own` has another kind, or the last extrapolation changes a difference by more than [`KNOWN`].
fn differences(push: &Push, variable: Variable, here: &Detachment) -> Option<[f64; 11]> {
    let h = push.step(variable);
    let at = |h: f64| {
        let Push { whisker, pole, side, distance_mm } = push.moved(variable, h);
        let finer = Resolution::FINE.doubled();
        let end = ends_at(finer, &whisker, &pole, side, &[distance_mm]).pop()?;
        quantities(&end).filter(|_| end.kind == here.kind)
    };
    let central = |h: f64| {
        let (low, high) = (at(-h)?, at(h)?);
        Some(std::array::from_fn::<f64, 11, _>(|i| (high[i] - low[i]) / (2.0 * h)))
    };
    let [d1, d2, d4] = [central(h)?, central(0.5 * h)?, central(0.25 * h)?];
    let values = quantities(here)?;
    let mut all = [0.0; 11];
    for i in 0..11 {
        let [first, second] = [(4.0 * d2[i] - d1[i]) / 3.0, (4.0 * d4[i] - d2[i]) / 3.0];
        all[i] = (16.0 * second - first) / 15.0;
        let scale = all[i].abs() + values[i].abs() / push.size(variable);
        if (all[i] - second).abs() > KNOWN * scale {
            return None;
        }
    }
    Some(all)
}

/// Returns true if the numbers of the push stay within what scenes accept when the variable changes.
fn has_room(push: &Push, variable: Variable) -> bool {
    let h = push.step(variable);
    match variable {
        Variable::Parameter(Parameter::PoleRadiusMm) => push.pole.radius_mm > h,
        Variable::Parameter(Parameter::Friction) => push.pole.friction > h,
        Variable::Parameter(Parameter::ArcStretch) => push.whisker.arc_stretch - h > 1.0,
        Variable::Parameter(Parameter::ParabolaPerMm | Parameter::VertexMm) => {
            push.whisker.curvature.is_some()
        }
        Variable::Parameter(Parameter::Taper) => push.whisker.taper() > h,
        Variable::Parameter(Parameter::BaseRadiusUm | Parameter::TipRadiusUm) => {
            push.whisker.taper() > 0.02
        }
        _ => true,
    }
}

/// Largest push, in turns, up to which the ends of a whisker with measured radii are differentiated: beyond it, each of them has a continuation of
/// thousands of nodes, which takes some 4 CPU seconds.
const MEASURED_TURNS: f64 = 2.0;

/// Compares every twelfth derivative of the push with this index, from another one on in turn: differences take most of the time. The last digit of
/// the index is the kind of whisker, so that the turn is that of the other digits.
pub fn compare(index: u64) -> Compared {
    let push = push(index);
    let variables = push.variables();
    let Push { whisker, pole, side, distance_mm } = &push;
    let ends = detachments(whisker, pole, *side, &[*distance_mm], &variables);
    let end = &ends[0].end;
    let mut compared = Compared::default();
    let Some(values) = quantities(end) else {
        let no = |by: &Result<_, _>| {
            matches!(by, Err(NoDerivative::NoDetachment | NoDerivative::NotGiven))
        };
        assert!(ends[0].by.iter().all(no));
        return compared;
    };
    assert!(matches!(end.kind, DetachmentKind::SlipOff | DetachmentKind::PullOff));
    let turns = values[0].abs() / 360.0;
    let is_followed = whisker.profile.is_none() || turns < MEASURED_TURNS;
    let all = variables.iter().zip(&ends[0].by);
    for (variable, by) in all.skip((index / 10 % 12) as usize).step_by(12) {
        let exact = by.as_ref().ok();
        let exact = exact.filter(|_| is_followed && has_room(&push, *variable));
        let exact = exact.and_then(|by| Some((by, differences(&push, *variable, end)?)));
        let Some((by, differences)) = exact else {
            compared.left_out += 1;
            continue;
        };
        compared.count += 1;
        let size = push.size(*variable);
        for ((exact, difference), value) in listed(by).into_iter().zip(differences).zip(values) {
            let apart = (exact - difference).abs() / (difference.abs() + value.abs() / size);
            compared.worst = compared.worst.max(apart);
        }
    }
    compared
}

/// Derivatives of largest loads are differences of largest loads, before the detachment and at it.
#[test]
fn largest_loads_change_by_their_derivatives() {
    use whiskmap::trace::{PushLoad, StableBranch};
    let scene = include_str!("../../scenes/cone.toml");
    let scene = Scene::parse(scene, "cone.toml").unwrap();
    let variables = [Parameter::Taper, Parameter::BaseRadiusUm, Parameter::YoungsModulusGpa]
        .map(Variable::from);
    let mut before = 0;
    for (side, distance_mm) in [(Side::Cb, 15.66), (Side::Cf, 15.66), (Side::Cb, 8.0)] {
        for load in [PushLoad::ContactForce, PushLoad::BaseMoment] {
            let found =
                largest(&scene.whisker, &scene.pole, side, distance_mm, load, &variables).unwrap();
            before += u32::from(found.peak.before_end_deg.is_some());
            for (variable, by) in variables.iter().zip(found.by) {
                let Variable::Parameter(parameter) = variable else { panic!() };
                let current = parameter.value(&scene).unwrap();
                let step = 1e-4 * current;
                let [less, more] = [-step, step].map(|step| {
                    let moved = scene.with(*parameter, current + step).unwrap();
                    let branch =
                        StableBranch::new(&moved.whisker, &moved.pole, side, distance_mm).unwrap();
                    branch.peak(load).size
                });
                let difference = (more - less) / (2.0 * step);
                // Largest values are known to 1e-9, over a step of 1e-4.
                let most = 1e-4 * (difference.abs() + found.peak.size / current * 0.1);
                assert!(
                    (by.unwrap() - difference).abs() < most,
                    "{load:?} {side:?} {variable}: {by:?} {difference}"
                );
            }
        }
    }
    assert!(before > 0);
    let strain =
        largest(&scene.whisker, &scene.pole, Side::Cb, 15.66, PushLoad::Strain, &variables)
            .unwrap();
    assert_eq!(strain.by[0], Err(NoDerivative::Strain));
}
