// The 8th-order formula of Dormand, El-Mikkawy and Prince's Nystrom pair. The twin of `integrator/nystrom8.rs` in
// `crates/mechanics/src/shooting/`.

// Integrates from the contact to the base, along the `count` steps of the base point from `first` on.
fn integrate(path: Path, first: u32, count: u32) -> Apart {
    let steps = real(count);
    let none = Stage(0.0, 0.0, Both(1.0, 0.0), Both(1.0, 0.0), Both(1.0, 0.0));
    let s2 = stage_at(path, steps, NODE_2);
    let s3 = stage_at(path, steps, NODE_3);
    let s4 = stage_at(path, steps, NODE_4);
    let s5 = stage_at(path, steps, NODE_5);
    let s6 = stage_at(path, steps, NODE_6);
    let s7 = stage_at(path, steps, NODE_7);
    let s8 = stage_at(path, steps, NODE_8);
    let slower = path.tau.y / path.tau.x;
    let potential = 2.25 * path.rod.taper * path.rod.taper * path.h.x * path.h.x;
    // X = m (chi' - (m'/m) chi).
    let growth = 1.5 * path.rod.taper * path.h;
    let scale = expm1_small(0.5 * growth.x);
    let at_end = (1.0 + scale) * (1.0 + scale);
    let end_scale = Both(at_end, at_end * expm1_small(growth.y));
    var apart = Apart(0.0, 0.0, 0.0, 0.0);
    for (var k = 0u; k < count; k++) {
        let start = starts[first + k];
        let radius = start.place.x;
        let rest = start.tangents.zw;
        var rest_terms: array<real, REST_TERMS>;
        if CURVATURE {
            rest_terms = rest_terms_at(rest.y);
        }
        if POLYNOMIAL {
            rest_terms = polynomial_terms(path.rod, start.place.y);
        }
        let left = 1.0 - real(k) / steps;
        let wider = expm1_small(path.widening * left);
        let softer = expm1_small(-3.0 * path.widening * left);
        let w = path.h.x / (radius * radius * radius);
        let faster = slower + softer + slower * softer;
        let reach = path.h.x * radius;
        let step = Step(
            left,
            radius,
            start.place.y,
            start.tangents.xy,
            rest,
            Both(start.place.z, apart.bent),
            w * product(Both(1.0, faster), path.force),
            reach * Both(1.0, slower + wider + slower * wider),
            potential * Both(1.0, slower * (2.0 + slower)),
            -2.0 * path.rod.bend * radius * rest.x * rest.x,
            rest_terms,
        );
        let speed = Both(start.place.w, apart.x);
        let p1 = pose_at(path, step, none, Both(0.0, 0.0));
        let k1 = -product(step.reach, p1.tangent.cos);
        var rise = SPEED_1 * climb(step, none, p1);
        var chi = NODE_2 * speed + STAGE_2_1 * k1;
        let k2 = pull(step, s2, pose_at(path, step, s2, chi), chi);
        chi = NODE_3 * speed + STAGE_3_1 * k1 + STAGE_3_2 * k2;
        let p3 = pose_at(path, step, s3, chi);
        let k3 = pull(step, s3, p3, chi);
        rise += SPEED_3 * climb(step, s3, p3);
        chi = NODE_4 * speed + STAGE_4_1 * k1 + STAGE_4_2 * k2 + STAGE_4_3 * k3;
        let p4 = pose_at(path, step, s4, chi);
        let k4 = pull(step, s4, p4, chi);
        rise += SPEED_4 * climb(step, s4, p4);
        chi = NODE_5 * speed + STAGE_5_1 * k1 + STAGE_5_2 * k2 + STAGE_5_3 * k3 + STAGE_5_4 * k4;
        let p5 = pose_at(path, step, s5, chi);
        let k5 = pull(step, s5, p5, chi);
        rise += SPEED_5 * climb(step, s5, p5);
        chi = NODE_6 * speed + STAGE_6_1 * k1 + STAGE_6_2 * k2 + STAGE_6_3 * k3 + STAGE_6_4 * k4 + STAGE_6_5 * k5;
        let p6 = pose_at(path, step, s6, chi);
        let k6 = pull(step, s6, p6, chi);
        rise += SPEED_6 * climb(step, s6, p6);
        chi = NODE_7 * speed + STAGE_7_1 * k1 + STAGE_7_2 * k2 + STAGE_7_3 * k3 + STAGE_7_4 * k4 + STAGE_7_5 * k5
            + STAGE_7_6 * k6;
        let p7 = pose_at(path, step, s7, chi);
        let k7 = pull(step, s7, p7, chi);
        rise += SPEED_7 * climb(step, s7, p7);
        chi = speed + STAGE_8_1 * k1 + STAGE_8_2 * k2 + STAGE_8_3 * k3 + STAGE_8_4 * k4 + STAGE_8_5 * k5
            + STAGE_8_6 * k6 + STAGE_8_7 * k7;
        let p8 = pose_at(path, step, s8, chi);
        let k8 = pull(step, s8, p8, chi);
        rise += SPEED_8 * climb(step, s8, p8);
        let end = speed + POSITION_1 * k1 + POSITION_3 * k3 + POSITION_4 * k4 + POSITION_5 * k5 + POSITION_6 * k6
            + POSITION_7 * k7;
        let end_speed = speed + SPEED_1 * k1 + SPEED_3 * k3 + SPEED_4 * k4 + SPEED_5 * k5 + SPEED_6 * k6
            + SPEED_7 * k7 + SPEED_8 * k8;
        apart.bent += product(product(step.turning, s8.inverse_scale), end).y;
        apart.y += rise.y;
        apart.along += rise.w;
        if TAPER {
            apart.x = product(end_speed - product(growth, end), end_scale).y;
        } else {
            apart.x = end_speed.y;
        }
    }
    return apart;
}
