//! Exact derivatives of detachments.

mod differences;
mod random_whiskers;

use differences::compare;
use whiskmap::rod::Side;
use whiskmap::scene::{Curvature, EulerSpiral, Parameter, Scene};
use whiskmap::sensitivity::{NoDerivative, Variable, detachments};
use whiskmap::trace::{corner, reach_mm};

/// Random whiskers with all effects, by every variable. The worst difference of 1,174 was 1.2e-8, relative.
#[test]
fn detachments_of_random_whiskers_are_differentiated() {
    let (mut count, mut left_out, mut worst) = (0, 0, 0.0_f64);
    for index in 0..100 {
        let compared = compare(index);
        count += compared.count;
        left_out += compared.left_out;
        worst = worst.max(compared.worst);
    }
    assert!(worst < 1e-7, "{worst:e}");
    assert!(count > 300 && left_out < count / 10, "{count} {left_out}");
}

/// Where a derivative does not exist, the result is the reason.
#[test]
fn missing_derivatives_have_reasons() {
    let cone = Scene::read("scenes/cone.toml").unwrap();
    let (whisker, pole) = (&cone.whisker, &cone.pole);
    let taper = [Variable::from(Parameter::Taper)];
    let by = |distance: f64| detachments(whisker, pole, Side::Cb, &[distance], &taper)[0].by[0];
    let reach = reach_mm(whisker, pole, Side::Cb);
    let corner = corner(whisker, pole, Side::Cb).distance_mm.unwrap();
    assert!(by(15.0).is_ok());
    assert_eq!(by(reach), Err(NoDerivative::AtTouch));
    assert_eq!(by(1.01 * reach), Err(NoDerivative::NoDetachment));
    assert_eq!(by(corner), Err(NoDerivative::Corner));
    let absent = [
        Variable::from(Parameter::SpiralPerMm),
        Variable::ProfileRadiusUm(0),
    ];
    let ends = detachments(whisker, pole, Side::Cb, &[15.0], &absent);
    assert_eq!(ends[0].by, [Err(NoDerivative::NotGiven); 2]);
}

/// A straight whisker has derivatives by the coefficients of the shapes that it can take.
#[test]
fn a_straight_whisker_begins_to_bend() {
    let mut straight = Scene::read("scenes/cone.toml").unwrap().whisker.clone();
    straight.curvature = None;
    let pole = Scene::read("scenes/cone.toml").unwrap().pole;
    let push = |bend: f64, spiral: bool| {
        let mut bent = straight.clone();
        if spiral {
            let (per_mm, per_mm2) = (2.0 * bend, 0.0);
            bent.euler_spiral = Some(EulerSpiral { per_mm, per_mm2 });
        } else {
            bent.curvature = Some(Curvature {
                parabola_per_mm: bend,
                vertex_mm: 0.0,
            });
        }
        detachments(&bent, &pole, Side::Cb, &[15.0], &[])[0]
            .end
            .push_angle_deg
            .unwrap()
    };
    for (parameter, spiral) in [
        (Parameter::ParabolaPerMm, false),
        (Parameter::SpiralPerMm, true),
    ] {
        let ends = detachments(&straight, &pole, Side::Cb, &[15.0], &[parameter.into()]);
        let own = ends[0].by[0].unwrap().push_angle_deg;
        let own = if spiral { 2.0 * own } else { own };
        let h = 1e-4;
        let one_sided = |h: f64| (push(h, spiral) - ends[0].end.push_angle_deg.unwrap()) / h;
        let difference = 2.0 * one_sided(0.5 * h) - one_sided(h);
        assert!(
            (own / difference - 1.0).abs() < 1e-4,
            "{parameter:?}: {own} {difference}"
        );
    }
}
