//! Checks against closed forms, limits and symmetries.

use super::check::{CLOSED, Check, EXACT, end, near};
use super::elastica::{elastica, fold};
use super::whiskers::{CONE, CYLINDER, POLE, whisker};
use crate::scene::{Pole, Whisker};
use crate::trace::{DetachmentKind, NoState, StableBranch, StateAtPush, corner, curve};
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::Reading;

pub fn checks() -> Vec<Check> {
    [straight_cylinder(), straight_cone(), symmetries()].concat()
}

/// A point contact.
const POINT: Pole = Pole::smooth(0.0);
const STRAIGHT_CYLINDER: Whisker = whisker([20.0, 30.0, 30.0], 0.0, 0.0);
const STRAIGHT_CONE: Whisker = whisker([20.0, 30.0, 0.0], 0.0, 0.0);
const STRAIGHT_WHISKER: Whisker = whisker([20.0, 30.0, 1.5], 0.0, 0.0);

/// The stable state of `whisker` at a point contact, first touched at `distance_mm`, after a push in radians.
fn pushed(
    whisker: &Whisker,
    distance_mm: f64,
    push: f64,
) -> Result<(StateAtPush, Reading), NoState> {
    let branch = StableBranch::new(whisker, &POINT, Side::Cb, distance_mm)?;
    let state = branch.state(push)?;
    Ok((state, branch.read(&state)))
}

/// Checks against the classical elastica. The digits are from an independent evaluation of the elliptic integrals; `elastica`
/// reproduces all digits.
fn straight_cylinder() -> Vec<Check> {
    let case = "straight cylinder, point contact";
    let end = end(&STRAIGHT_CYLINDER, &POINT, Side::Cb, 8.0);
    let arc = end.arc_length_mm.map(|arc| arc / 8.0);
    let corner = corner(&STRAIGHT_CYLINDER, &POINT, Side::Cb);
    let reach = corner.distance_mm.map(|mm| mm / STRAIGHT_CYLINDER.length_mm);
    let exact = elastica(60_f64.to_radians());
    let at_60 = "straight cylinder, pushed by 39.75122968 deg";
    let turned = pushed(&STRAIGHT_CYLINDER, 8.0, 39.751_229_68_f64.to_radians()).ok();
    let angle = turned.map(|(_, reading)| reading.contact_angle_deg);
    let arc_60 = turned.map(|(state, _)| state.point.x / 0.4);
    let load_60 = turned.map(|(state, _)| state.point.y * 0.16);
    let push = end.push_angle_deg;
    // 39.75122968 is known to 5e-9, and the turning angle grows 1.6 times as fast.
    #[rustfmt::skip]
    let checks = vec![
        near(case, "slip-off (deg)", CLOSED, (99.568_498_75, 5e-9), push),
        near(case, "slip-off (deg)", "elastica", (fold().push.to_degrees(), 1e-10), push),
        near(case, "s_obj/d at slip-off", CLOSED, (1.790_383_51, 5e-9), arc),
        near(case, "pulled off beyond d/L_w", CLOSED, (0.558_54, 5e-6), reach),
        near(at_60, "turning angle (deg)", CLOSED, (60.0, 1e-8), angle),
        near(at_60, "s_obj/d", CLOSED, (1.051_451_76, 5e-9), arc_60),
        near(at_60, "F d^2/(E I)", CLOSED, (1.967_754_50, 5e-9), load_60),
        near(at_60, "F d^2/(E I)", "elastica", (exact.load, 5e-9), load_60),
    ];
    checks
}

/// Checks against the limit of small loads: `M = 3 E I_base theta (L - a)/(a L)`, `L` the virtual cone's length; the next term is
/// smaller by the square of the angle.
fn straight_cone() -> Vec<Check> {
    let push = 1e-5;
    [("perfect cone", STRAIGHT_CONE), ("truncated cone", STRAIGHT_WHISKER)]
        .into_iter()
        .flat_map(|(name, cone)| [5.0, 15.0].map(|a| (name, cone.clone(), a)))
        .map(|(name, cone, a)| {
            let length = cone.length_mm / (1.0 - cone.tip_radius_um / cone.base_radius_um);
            let units = cone.units();
            let exact =
                3.0 * units.moment_nnm * cone.length_mm * push * (length - a) / (a * length);
            let moment = pushed(&cone, a, push).map(|(_, reading)| reading.base_moment_nnm);
            near(
                format!("straight {name} at a = {a} mm, small load"),
                "base moment over formula",
                CLOSED,
                (1.0, 1e-8),
                moment.ok().map(|moment| moment / exact),
            )
        })
        .collect()
}

/// Checks of quantities that scaling and mirroring leave alone.
fn symmetries() -> Vec<Check> {
    let push = |whisker: &Whisker, pole: &Pole, side, d| end(whisker, pole, side, d).push_angle_deg;
    let sum = |a: Option<f64>, b: Option<f64>, sign: f64| Some(a? + sign * b?);
    let scaled = whisker([1000.0, 1500.0, 75.0], 4e-4, 0.0);
    let mut soft = CONE;
    soft.youngs_modulus_gpa = 1.0;
    let mut thin = CYLINDER;
    (thin.base_radius_um, thin.tip_radius_um) = (3.0, 3.0);
    let distances: Vec<f64> = (1..=64).map(|i| 0.3 * f64::from(i)).collect();
    let perfect = whisker([20.0, 30.0, 0.0], 0.02, 0.0);
    let pulled = Side::BOTH
        .iter()
        .flat_map(|side| curve(&perfect, &POLE, *side, &distances))
        .filter(|end| end.kind == DetachmentKind::PullOff)
        .count() as f64;
    let thick = Pole::smooth(50.0 * POLE.radius_mm);
    let cone = push(&CONE, &POLE, Side::Cb, 14.0);
    let mirror = |side| push(&STRAIGHT_WHISKER, &POLE, side, 14.0);
    let mirrored = sum(mirror(Side::Cb), mirror(Side::Cf), 1.0);
    let softer = sum(push(&soft, &POLE, Side::Cb, 14.0), cone, -1.0);
    let cylinders = [thin, CYLINDER].map(|whisker| push(&whisker, &POLE, Side::Cb, 14.0));
    let thinner = sum(cylinders[0], cylinders[1], -1.0);
    let larger = sum(push(&scaled, &thick, Side::Cb, 700.0), cone, -1.0);
    #[rustfmt::skip]
    let checks = vec![
        near("straight whisker", "slip-off, CB and CF together (deg)", EXACT, (0.0, 0.0), mirrored),
        near("cone, Young's modulus over 3", "slip-off, change (deg)", EXACT, (0.0, 0.0), softer),
        near("cylinder, radius over 10", "pull-off, change (deg)", EXACT, (0.0, 0.0), thinner),
        near("cone, every length times 50", "slip-off, change (deg)", EXACT, (0.0, 1e-10), larger),
        near("perfect cone, 128 pushes", "pull-offs", EXACT, (0.0, 0.0), Some(pulled)),
    ];
    checks
}
