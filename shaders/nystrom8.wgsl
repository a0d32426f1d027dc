// The 8th-order formula of Dormand, El-Mikkawy and Prince's Nystrom pair for a reference and a cell side by side; the twin of
// `nystrom8.rs`, `intrinsic.rs` and `material.rs` in `crates/mechanics/src/shooting/`, where the equations are.

struct Rod {
    taper: real,
    bend: real,
    // [k0, k1] of an Euler spiral
    spiral: vec2<real>,
}

// Where a step of the reference starts.
struct StepStart {
    // radius, arclength, how far bending has turned the rod since the contact, and position across the force
    place: vec4<real>,
    // cos and sin: of the rod, and of the whisker at rest
    tangents: vec4<real>,
}

// What changes from the start of a step to one of its stages.
struct Stage {
    // arclength toward the base, over the radius at the start of the step
    along: real,
    // the part of the whole way to the base
    part: real,
    // m_0/m, (rho/m)/(rho_0/m_0), rho/rho_0
    inverse_scale: Both,
    forcing: Both,
    grown: Both,
}

// What is the same in all steps: the way from the contact to the base, of the reference and the cell.
struct Path {
    rod: Rod,
    // of the contact
    tau: Both,
    // a step
    h: Both,
    force: Both,
    // ln of the cell's radius over the reference's, at the contact
    widening: real,
    // how much farther the cell's whisker at rest has turned at the contact
    rest_at_contact: real,
}

// A step.
struct Step {
    // the part of the whole way that is left to the base
    left: real,
    radius: real,
    arclength: real,
    tangent: vec2<real>,
    rest: vec2<real>,
    // how far bending has turned the rod since the contact
    bent: Both,
    // h F/rho^3 and h rho
    turning: Both,
    reach: Both,
    // h^2 m''/m
    potential: Both,
    // of the resting whisker's tangent along the step: see `Bent` in Rust
    rest_rate: real,
    rest_terms: array<real, REST_TERMS>,
}

// The rod of the cell less that of the reference.
struct Apart {
    bent: real,
    x: real,
    y: real,
    // the integral of how far it has turned along -X
    along: real,
}

fn stage_at(path: Path, steps: real, node: real) -> Stage {
    let half = 0.5 * node * path.rod.taper * path.h.x;
    let shrinks = expm1_small(-half);
    let shrunk = 1.0 + shrinks;
    let grown = 1.0 / (shrunk * shrunk);
    // of the cell's over the reference's
    let forcing = expm1_small(0.5 * node * path.widening / steps);
    let inverse_scale = forcing * (3.0 + forcing * (3.0 + forcing));
    let growth = -forcing * (2.0 + forcing) / ((1.0 + forcing) * (1.0 + forcing));
    let cube = shrunk * shrunk * shrunk;
    let x = 2.0 * half;
    return Stage(
        node * path.h.x * expm1_over_small(x),
        node / steps,
        Both(cube, cube * inverse_scale),
        Both(shrunk, shrunk * forcing),
        Both(grown, grown * growth),
    );
}

// How far the whisker at rest turns from the start of a step to a stage.
fn rest_turn(path: Path, step: Step, stage: Stage) -> real {
    if SPIRAL {
        let along = -step.radius * stage.along;
        return along * (path.rod.spiral[0] + path.rod.spiral[1] * (step.arclength + 0.5 * along));
    }
    // A loop would keep the terms in memory.
    let t = step.rest_terms;
    let x = step.rest_rate * stage.along;
    return step.rest.x * x * (t[0] + x * (t[1] + x * (t[2] + x * (t[3] + x * (t[4] + x * (t[5] + x * (t[6] + x * (t[7] + x * (t[8]
        + x * (t[9] + x * (t[10] + x * t[11])))))))))));
}

// How much farther than the tangent `rest` at arclength `s` the whisker at rest has turned `ds` further on.
fn rest_apart(rod: Rod, rest: vec2<real>, s: real, ds: real) -> real {
    if SPIRAL {
        return ds * (rod.spiral[0] + rod.spiral[1] * (s + 0.5 * ds));
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

// The rods at a stage: how far bending has turned them, and their tangents.
struct Pose {
    bent: Both,
    tangent: Tangent,
}

// The poses at a stage where `chi` has come so far.
fn pose_at(path: Path, step: Step, stage: Stage, chi: Both) -> Pose {
    let bend = product(product(step.turning, stage.inverse_scale), chi);
    let bent = step.bent + bend;
    var turn = bend.x;
    var apart = bent.y;
    if CURVATURE || SPIRAL {
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

// chi''.
fn pull(step: Step, stage: Stage, pose: Pose, chi: Both) -> Both {
    let forced = product(product(step.reach, stage.forcing), pose.tangent.cos);
    if TAPER {
        return product(step.potential, chi) - forced;
    }
    return -forced;
}

// What the stage adds to Y and, in the second pair, to the integral of the bend along -X.
fn climb(step: Step, stage: Stage, pose: Pose) -> vec4<real> {
    let reach = product(step.reach, stage.grown);
    return vec4<real>(-product(reach, pose.tangent.sin), product(reach, product(pose.tangent.cos, pose.bent)));
}

// From the contact to the base, along the reference's steps from `first` on.
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
