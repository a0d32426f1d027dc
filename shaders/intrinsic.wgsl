// Shape at rest and equation of motion at one stage of a step, for a base point and a cell side by side. The twin of `intrinsic.rs`,
// `parabola.rs` and `material.rs` in `crates/mechanics/src/shooting/`, where the equations are.

// Coefficients of the rotation over the arclength from `s` on, along a polynomial curvature: repeated synthetic division, integrated.
fn polynomial_terms(rod: Rod, s: real) -> array<real, REST_TERMS> {
    let x = s - 0.5;
    var t: array<real, REST_TERMS>;
    let g = rod.high.z;
    var f = rod.high.y;
    var e = rod.high.x;
    var d = rod.low.w;
    var c = rod.low.z;
    var b = rod.low.y;
    var a = rod.low.x;
    f += g * x;
    e += f * x;
    d += e * x;
    c += d * x;
    b += c * x;
    a += b * x;
    t[0] = a;
    f += g * x;
    e += f * x;
    d += e * x;
    c += d * x;
    b += c * x;
    t[1] = b * real(1.0 / 2.0);
    f += g * x;
    e += f * x;
    d += e * x;
    c += d * x;
    t[2] = c * real(1.0 / 3.0);
    f += g * x;
    e += f * x;
    d += e * x;
    t[3] = d * real(1.0 / 4.0);
    f += g * x;
    e += f * x;
    t[4] = e * real(1.0 / 5.0);
    f += g * x;
    t[5] = f * real(1.0 / 6.0);
    t[6] = g * real(1.0 / 7.0);
    return t;
}

// Rotation along a polynomial curvature from arclength `s` to `s + ds`: the divided difference of the antiderivative, times `ds`.
fn polynomial_apart(rod: Rod, s: real, ds: real) -> real {
    let here = s - 0.5;
    let there = here + ds;
    // Partial values of the antiderivative at `s`, from the highest power on, and their divided differences.
    var value = rod.high.z * real(1.0 / 7.0);
    var divided = value;
    value = value * here + rod.high.y * real(1.0 / 6.0);
    divided = divided * there + value;
    value = value * here + rod.high.x * real(1.0 / 5.0);
    divided = divided * there + value;
    value = value * here + rod.low.w * real(1.0 / 4.0);
    divided = divided * there + value;
    value = value * here + rod.low.z * real(1.0 / 3.0);
    divided = divided * there + value;
    value = value * here + rod.low.y * real(1.0 / 2.0);
    divided = divided * there + value;
    value = value * here + rod.low.x;
    divided = divided * there + value;
    return ds * divided;
}

// Rotation of the whisker at rest from the start of a step to a stage.
fn rest_turn(path: Path, step: Step, stage: Stage) -> real {
    if SPIRAL {
        let along = -step.radius * stage.along;
        return along * (path.rod.spiral[0] + path.rod.spiral[1] * (step.arclength + 0.5 * along));
    }
    if POLYNOMIAL {
        let p = step.rest_terms;
        let along = -step.radius * stage.along;
        return along * (p[0] + along * (p[1] + along * (p[2] + along * (p[3] + along * (p[4] + along * (p[5] + along * p[6]))))));
    }
    // A loop would keep the terms in memory.
    let t = step.rest_terms;
    let x = step.rest_rate * stage.along;
    return step.rest.x * x * (t[0] + x * (t[1] + x * (t[2] + x * (t[3] + x * (t[4] + x * (t[5] + x * (t[6] + x * (t[7] + x * (t[8]
        + x * (t[9] + x * (t[10] + x * t[11])))))))))));
}

// Rotation of the whisker at rest from the tangent `rest` at arclength `s` to arclength `s + ds`.
fn rest_apart(rod: Rod, rest: vec2<real>, s: real, ds: real) -> real {
    if SPIRAL {
        return ds * (rod.spiral[0] + rod.spiral[1] * (s + 0.5 * ds));
    }
    if POLYNOMIAL {
        return polynomial_apart(rod, s, ds);
    }
    let x = 2.0 * rod.bend * rest.x * rest.x * ds;
    let sin = rest.y;
    let y = sin * sin;
    let odd = sin * (-1.5 + x * x * ((57.0 - 162.0 * y) * (1.0 / 24.0)
        + x * x * ((-2739.0 + y * (21504.0 - 29160.0 * y)) * (1.0 / 720.0)
        + x * x * (82267.0 / 13440.0 + y * (-618007.0 / 6720.0 + y * (74147.0 / 240.0 - y * (2187.0 / 8.0)))))));
    let even = (3.0 * y - 0.5) + x * x * ((57.0 - y * (1056.0 - 1944.0 * y)) * (1.0 / 120.0)
        + x * x * (-913.0 / 1680.0 + y * (2449.0 / 120.0 + y * (-20411.0 / 210.0 + y * (729.0 / 7.0)))));
    return rest.x * x * (1.0 + x * (odd + x * even));
}

// Rods at a stage: their rotation by bending, and their tangents.
struct Pose {
    bent: Both,
    tangent: Tangent,
}

// Poses at a stage with the value `chi`.
fn pose_at(path: Path, step: Step, stage: Stage, chi: Both) -> Pose {
    let bend = product(product(step.turning, stage.inverse_scale), chi);
    let bent = step.bent + bend;
    var turn = bend.x;
    var apart = bent.y;
    if CURVATURE || SPIRAL || POLYNOMIAL {
        let at_rest = rest_turn(path, step, stage);
        let left = step.left - stage.part;
        let radius = step.radius * stage.grown.x;
        var ds = radius * path.tau.y * left;
        if TAPER {
            ds *= expm1_over_small(path.widening * left);
        }
        let s = step.arclength - step.radius * stage.along;
        turn += at_rest;
        apart += rest_apart(path.rod, rotated(step.rest, at_rest), s, ds) - path.rest_at_contact;
    }
    return Pose(bent, tangents(rotated(step.tangent, turn), apart));
}

// Second derivative of chi.
fn pull(step: Step, stage: Stage, pose: Pose, chi: Both) -> Both {
    let forced = product(product(step.reach, stage.forcing), pose.tangent.cos);
    if TAPER {
        return product(step.potential, chi) - forced;
    }
    return -forced;
}

// Integrand of a stage: of Y and, in the second pair, of the rotation by bending along -X.
fn climb(step: Step, stage: Stage, pose: Pose) -> vec4<real> {
    let reach = product(step.reach, stage.grown);
    return vec4<real>(-product(reach, pose.tangent.sin), product(reach, product(pose.tangent.cos, pose.bent)));
}
