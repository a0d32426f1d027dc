//! Exact derivatives of detachments.

mod differences;
mod maps;
mod random_whiskers;

use crate::shipped;
use differences::{Compared, compare};
use rayon::prelude::*;
use whiskmap::Side;
use whiskmap::scene::{Curvature, EulerSpiral, Parameter};
use whiskmap::sensitivity::{NoDerivative, Variable, detachments};
use whiskmap::trace::{corner, reach_mm};

/// Random whiskers with all effects, by every variable. Without follicles, of 4,182 derivatives, every third one of each whisker, 4,038 could
/// be compared; the worst difference was 1.4e-7, relative. With them, 927 of every twelfth one could be compared, and 103 could not.
#[test]
fn detachments_of_random_whiskers_are_differentiated() {
    let compared: Vec<Compared> = (0..1000).into_par_iter().map(compare).collect();
    let count: usize = compared.iter().map(|part| part.count).sum();
    let left_out: usize = compared.iter().map(|part| part.left_out).sum();
    let worst = compared.iter().fold(0.0, |worst: f64, part| worst.max(part.worst));
    assert!(worst < 2e-7, "{worst:e}");
    assert!(count > 700 && left_out < count / 8, "{count} {left_out}");
}

/// Where a derivative does not exist, the result is the reason.
#[test]
fn missing_derivatives_have_reasons() {
    let cone = shipped::scene("cone");
    let (whisker, pole) = (&cone.whisker, &cone.pole);
    let taper = [Variable::from(Parameter::Taper)];
    let by = |distance: f64| detachments(whisker, pole, Side::Cb, &[distance], &taper)[0].by[0];
    let reach = reach_mm(whisker, pole, Side::Cb);
    let corner = corner(whisker, pole, Side::Cb).distance_mm.unwrap();
    assert!(by(15.0).is_ok());
    assert_eq!(by(reach), Err(NoDerivative::AtTouch));
    assert_eq!(by(1.01 * reach), Err(NoDerivative::NoDetachment));
    assert_eq!(by(corner), Err(NoDerivative::Corner));
    let absent = [Variable::from(Parameter::SpiralPerMm), Variable::ProfileRadiusUm(0)];
    let ends = detachments(whisker, pole, Side::Cb, &[15.0], &absent);
    assert_eq!(ends[0].by, [Err(NoDerivative::NotGiven); 2]);
}

/// A straight whisker has derivatives by the coefficients of the shapes that it can take, alone and together.
#[test]
fn a_straight_whisker_begins_to_bend() {
    let mut straight = shipped::scene("cone").whisker.clone();
    straight.curvature = None;
    let pole = shipped::scene("cone").pole;
    let push = |bend: f64, spiral: bool| {
        let mut bent = straight.clone();
        if spiral {
            let (per_mm, per_mm2) = (2.0 * bend, 0.0);
            bent.euler_spiral = Some(EulerSpiral { per_mm, per_mm2 });
        } else {
            bent.curvature = Some(Curvature { parabola_per_mm: bend, vertex_mm: 0.0 });
        }
        detachments(&bent, &pole, Side::Cb, &[15.0], &[])[0].end.push_angle_deg.unwrap()
    };
    let both = [Parameter::ParabolaPerMm, Parameter::SpiralPerMm].map(Variable::from);
    let together = detachments(&straight, &pole, Side::Cb, &[15.0], &both);
    for (variable, spiral) in both.into_iter().zip([false, true]) {
        let ends = detachments(&straight, &pole, Side::Cb, &[15.0], &[variable]);
        let derivative = ends[0].by[0].unwrap().push_angle_deg;
        let other = together[0].by[usize::from(spiral)].unwrap().push_angle_deg;
        assert_eq!(other, derivative);
        let derivative = if spiral { 2.0 * derivative } else { derivative };
        let h = 1e-4;
        let one_sided = |h: f64| (push(h, spiral) - ends[0].end.push_angle_deg.unwrap()) / h;
        let difference = 2.0 * one_sided(0.5 * h) - one_sided(h);
        assert!(
            (derivative / difference - 1.0).abs() < 1e-4,
            "{variable}: {derivative} {difference}"
        );
    }
}
