// Trajectories from the contact to the base, one per invocation, with the 8th-order formula of Dormand, El-Mikkawy and Prince's Nystrom pair.
// The twin of `contact.rs`, `resolution.rs`, `integrator/nystrom8.rs`, `intrinsic.rs`, `parabola.rs` and `material.rs` in
// `crates/mechanics/src/shooting/`, where the equations are.

struct Rod {
    taper: real,
    twice_bend: real,
    // curvature of an Euler spiral, and its slope
    spiral: vec2<real>,
    // coefficients of a polynomial curvature in s - 1/2: of the powers 0 to 3, and 4 to 6
    low: vec4<real>,
    high: vec4<real>,
    // tangent at the contact
    tangent: vec2<real>,
    // gradient of the modulus
    gradient: real,
    // t sqrt(1 + t^2) + asinh(t) for the slope t of a parabola at the base
    arc_at_base: real,
    // least number of steps, largest curvature at rest, steps of the longest length over tau, and an unused number
    steps: vec4<real>,
}

// State at the base: tangent, position, then energy and force.
alias State = array<vec2<real>, 3>;

@group(0) @binding(0) var<storage, read> rods: array<Rod>;
// Rod, and tau and load, of each trajectory.
@group(0) @binding(1) var<storage, read> rod_of: array<u32>;
@group(0) @binding(2) var<storage, read> points: array<vec2<real>>;
@group(0) @binding(3) var<storage, read_write> states: array<State>;

// (exp(x) - 1)/x for |x| <= 0.4: Taylor polynomial; of degree 12 in f64 and 7 in f32 truncation is below 1e-16 and 2e-9.
fn expm1_over_small(x: real) -> real {
    var tail = real(0.0);
    if DOUBLE {
        tail = x * (1.0 / 362880.0 + x * (1.0 / 3628800.0 + x * (1.0 / 39916800.0 + x * (1.0 / 479001600.0
            + x * (1.0 / 6227020800.0)))));
    }
    return 1.0 + x * (1.0 / 2.0 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * (1.0 / 120.0 + x * (1.0 / 720.0 + x * (1.0 / 5040.0
        + x * (1.0 / 40320.0 + tail)))))));
}

// Radius over the base radius, and arclength, at tau. Each halving of the exponent, of at most 25.6, doubles the rounding.
fn radius_and_arclength(taper: real, tau: real) -> vec2<real> {
    var part = -taper * tau;
    var halvings = 0;
    while part < -0.4 && halvings < 6 {
        part *= 0.5;
        halvings++;
    }
    var growth = expm1_over_small(part);
    var radius = 1.0 + part * growth;
    for (var halving = 0; halving < halvings; halving++) {
        growth *= 1.0 + 0.5 * part * growth;
        part += part;
        radius *= radius;
    }
    return vec2<real>(radius, tau * growth);
}

// t sqrt(1 + t^2) + asinh(t), by halving the argument of asinh three times.
fn arc(t: real) -> real {
    let root = sqrt(1.0 + t * t);
    let first = sqrt(0.5 * (1.0 + root));
    let second = sqrt(0.5 * (1.0 + first));
    let third = sqrt(0.5 * (1.0 + second));
    let w = t / (8.0 * first * second * third * third);
    return t * root + 8.0 * w * arc_series(w * w);
}

// Unit tangent of a parabola at rest at the arclength s.
fn parabola_tangent(rod: Rod, s: real) -> vec2<real> {
    let z = 2.0 * rod.twice_bend * s + rod.arc_at_base;
    let square = z * z;
    let power = 1.0 + square * (0.253 + 0.0437 * sqrt(square) + (1.0 / 256.0) * square);
    let start = 0.5 * z / sqrt(sqrt(sqrt(power)));
    let t2 = start * start;
    let root_square = 1.0 + t2;
    let d = 0.5 * (z - arc(start)) / sqrt(root_square);
    let e = d / root_square;
    let c2 = -0.5 * start;
    let c3 = 0.5 * t2 - 1.0 / 6.0;
    let c4 = start * (13.0 / 24.0 - (15.0 / 24.0) * t2);
    let c5 = t2 * ((105.0 / 120.0) * t2 - 162.0 / 120.0) + 13.0 / 120.0;
    let c6 = start * (t2 * ((2202.0 / 720.0) - (945.0 / 720.0) * t2) - 493.0 / 720.0);
    let t = start + d * (1.0 + e * (c2 + e * (c3 + e * (c4 + e * (c5 + e * c6)))));
    let cos = 1.0 / sqrt(1.0 + t * t);
    return vec2<real>(cos, t * cos);
}

// Number of steps from tau and arclength, rounded up to three significant bits.
fn steps_of(rod: Rod, tau: real, load: real, s: real) -> u32 {
    var bending = abs(load) * s * s;
    if GRADIENT {
        bending /= min(real(1.0), 1.0 + rod.gradient * s);
    }
    let root = sqrt(f32(bending));
    let turn = f32(rod.steps.y * s);
    let fall = f32(rod.taper * tau);
    let weight = STEPS_AT_REST + STEPS_BY_ROOT * root + STEPS_BY_COIL * max(root - COILING, 0.0)
        + STEPS_BY_TURN * turn * min(turn, 2.0) + STEPS_BY_FALL * fall * min(fall, 2.0);
    let steps = max(f32(rod.steps.x) * weight, f32(rod.steps.z * tau));
    let whole = min(u32(ceil(clamp(steps, 1.0, MOST_STEPS))), u32(MOST_STEPS));
    let rest = (1u << (max(firstLeadingBit(whole), 2u) - 2u)) - 1u;
    return (whole + rest) & ~rest;
}

// Unit vector rotated by an angle of at most 0.5: relative truncation errors are below 5e-14 in f64 and 2e-8 in f32.
fn rotated(unit: vec2<real>, angle: real) -> vec2<real> {
    let y = angle * angle;
    var tail = vec2<real>();
    if DOUBLE {
        tail = y * (vec2<real>(1.0 / 362880.0, 1.0 / 3628800.0) - y * vec2<real>(1.0 / 39916800.0, 1.0 / 479001600.0));
    }
    let sine = angle * (1.0 - y * (1.0 / 6.0 - y * (1.0 / 120.0 - y * (1.0 / 5040.0 - tail.x))));
    let versine = y * (0.5 - y * (1.0 / 24.0 - y * (1.0 / 720.0 - y * (1.0 / 40320.0 - tail.y))));
    return unit + sine * vec2<real>(-unit.y, unit.x) - versine * unit;
}

// Changes of the cross-section from the start of a step to a stage.
struct Stage {
    // arclength toward the base, over the radius at the start of the step
    along: real,
    // rho/rho_0, and its inverse square root
    grown: real,
    shrunk: real,
}

fn stage_at(rod: Rod, h: real, node: real) -> Stage {
    let half = 0.5 * node * h;
    if TAPER {
        let x = rod.taper * half;
        let growth = expm1_over_small(x);
        let root = 1.0 + x * growth;
        return Stage(half * growth * (root + 1.0), root * root, 1.0 - x * expm1_over_small(-x));
    }
    return Stage(2.0 * half, real(1.0), real(1.0));
}

// Whisker at the start of a step.
struct Section {
    radius: real,
    arclength: real,
    // modulus over that at the base
    modulus: real,
    // unit tangents of the whisker, and of a parabola at rest
    tangent: vec2<real>,
    rest: vec2<real>,
    // rotation by bending since the contact
    bent: real,
    // h F/(modulus rho^3) and h rho
    turning: real,
    reach: real,
    // rotation of the whisker at rest, as a polynomial
    rest_rate: real,
    rest_terms: array<real, REST_TERMS>,
}

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

// Rotation of the whisker at rest from the start of a step to a stage.
fn rest_turn(rod: Rod, section: Section, along: real) -> real {
    if SPIRAL {
        let way = -section.radius * along;
        return way * (rod.spiral.x + rod.spiral.y * (section.arclength + 0.5 * way));
    }
    let p = section.rest_terms;
    if POLYNOMIAL {
        let way = -section.radius * along;
        return way * (p[0] + way * (p[1] + way * (p[2] + way * (p[3] + way * (p[4] + way * (p[5] + way * p[6]))))));
    }
    if CURVATURE {
        // A loop would keep the terms in memory.
        let x = section.rest_rate * along;
        return section.rest.x * x * (p[0] + x * (p[1] + x * (p[2] + x * (p[3] + x * (p[4] + x * (p[5] + x * (p[6] + x * (p[7] + x * (p[8]
            + x * (p[9] + x * (p[10] + x * p[11])))))))))));
    }
    return real(0.0);
}

// Change of the material from the start of a step to a stage.
struct Material {
    // square root of the modulus at the start over that at the stage
    softer: real,
    // rate at which the logarithm of the modulus falls toward the base, along tau
    fall: real,
}

fn material_at(rod: Rod, section: Section, stage: Stage) -> Material {
    if GRADIENT {
        let inverse = 1.0 / (1.0 + rod.gradient * (section.arclength - section.radius * stage.along));
        return Material(sqrt(section.modulus * inverse), rod.gradient * section.radius * stage.grown * inverse);
    }
    return Material(real(1.0), real(0.0));
}

// Tangent and rotation by bending at a stage, where chi is given, and chi'' there.
struct Pose {
    tangent: vec2<real>,
    bent: real,
    pull: real,
}

fn pose_at(rod: Rod, h: real, section: Section, stage: Stage, chi: real) -> Pose {
    let material = material_at(rod, section, stage);
    let bend = section.turning * stage.shrunk * stage.shrunk * stage.shrunk * material.softer * chi;
    let turn = bend + rest_turn(rod, section, stage.along);
    let tangent = rotated(section.tangent, turn);
    // m''/m
    var potential = 2.25 * rod.taper * rod.taper;
    if GRADIENT {
        potential -= material.fall * (0.25 * material.fall + 2.0 * rod.taper);
    }
    let pull = h * h * potential * chi - section.reach * stage.shrunk * material.softer * tangent.x;
    return Pose(tangent, section.bent + bend, pull);
}

// Integrands of Y, and of the rotation by bending along -X.
fn climb(stage: Stage, pose: Pose) -> vec2<real> {
    return stage.grown * vec2<real>(-pose.tangent.y, pose.tangent.x * pose.bent);
}

@compute @workgroup_size(WORKGROUP)
fn shoot(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let id = invocation.x;
    if id >= arrayLength(&points) {
        return;
    }
    let rod = rods[rod_of[id]];
    let tau = points[id].x;
    let load = points[id].y;
    var radius = real(1.0);
    var arclength = tau;
    if TAPER {
        let both = radius_and_arclength(rod.taper, tau);
        radius = both.x;
        arclength = both.y;
    }
    let force = load * radius * radius;
    let steps = steps_of(rod, tau, load, arclength);
    let h = tau / real(steps);
    let s2 = stage_at(rod, h, NODE_2);
    let s3 = stage_at(rod, h, NODE_3);
    let s4 = stage_at(rod, h, NODE_4);
    let s5 = stage_at(rod, h, NODE_5);
    let s6 = stage_at(rod, h, NODE_6);
    let s7 = stage_at(rod, h, NODE_7);
    let end = stage_at(rod, h, NODE_8);
    var section = Section();
    section.radius = radius;
    section.arclength = arclength;
    section.modulus = real(1.0);
    section.tangent = rod.tangent;
    if CURVATURE {
        section.rest = parabola_tangent(rod, arclength);
    }
    var x = real(0.0);
    var y = real(0.0);
    var along = real(0.0);
    for (var step = 0u; step < steps; step++) {
        if GRADIENT {
            section.modulus = 1.0 + rod.gradient * section.arclength;
        }
        section.turning = h * force / (section.modulus * section.radius * section.radius * section.radius);
        section.reach = h * section.radius;
        if CURVATURE {
            section.rest_rate = -section.radius * rod.twice_bend * section.rest.x * section.rest.x;
            section.rest_terms = rest_terms_at(section.rest.y);
        }
        if POLYNOMIAL {
            section.rest_terms = polynomial_terms(rod, section.arclength);
        }
        let reach = section.reach;
        let k1 = -reach * section.tangent.x;
        var rise = SPEED_1 * vec2<real>(-section.tangent.y, section.tangent.x * section.bent);
        var chi = NODE_2 * x + STAGE_2_1 * k1;
        var pose = pose_at(rod, h, section, s2, chi);
        let k2 = pose.pull;
        chi = NODE_3 * x + STAGE_3_1 * k1 + STAGE_3_2 * k2;
        pose = pose_at(rod, h, section, s3, chi);
        let k3 = pose.pull;
        rise += SPEED_3 * climb(s3, pose);
        chi = NODE_4 * x + STAGE_4_1 * k1 + STAGE_4_2 * k2 + STAGE_4_3 * k3;
        pose = pose_at(rod, h, section, s4, chi);
        let k4 = pose.pull;
        rise += SPEED_4 * climb(s4, pose);
        chi = NODE_5 * x + STAGE_5_1 * k1 + STAGE_5_2 * k2 + STAGE_5_3 * k3 + STAGE_5_4 * k4;
        pose = pose_at(rod, h, section, s5, chi);
        let k5 = pose.pull;
        rise += SPEED_5 * climb(s5, pose);
        chi = NODE_6 * x + STAGE_6_1 * k1 + STAGE_6_2 * k2 + STAGE_6_3 * k3 + STAGE_6_4 * k4 + STAGE_6_5 * k5;
        pose = pose_at(rod, h, section, s6, chi);
        let k6 = pose.pull;
        rise += SPEED_6 * climb(s6, pose);
        chi = NODE_7 * x + STAGE_7_1 * k1 + STAGE_7_2 * k2 + STAGE_7_3 * k3 + STAGE_7_4 * k4 + STAGE_7_5 * k5 + STAGE_7_6 * k6;
        pose = pose_at(rod, h, section, s7, chi);
        let k7 = pose.pull;
        rise += SPEED_7 * climb(s7, pose);
        chi = x + STAGE_8_1 * k1 + STAGE_8_2 * k2 + STAGE_8_3 * k3 + STAGE_8_4 * k4 + STAGE_8_5 * k5 + STAGE_8_6 * k6
            + STAGE_8_7 * k7;
        pose = pose_at(rod, h, section, end, chi);
        let k8 = pose.pull;
        rise += SPEED_8 * climb(end, pose);
        chi = x + POSITION_1 * k1 + POSITION_3 * k3 + POSITION_4 * k4 + POSITION_5 * k5 + POSITION_6 * k6 + POSITION_7 * k7;
        let speed = x + SPEED_1 * k1 + SPEED_3 * k3 + SPEED_4 * k4 + SPEED_5 * k5 + SPEED_6 * k6 + SPEED_7 * k7 + SPEED_8 * k8;
        pose = pose_at(rod, h, section, end, chi);
        // X = m (chi' - (m'/m) chi).
        let material = material_at(rod, section, end);
        x = (speed - h * (1.5 * rod.taper - 0.5 * material.fall) * chi) * end.grown * end.grown * end.shrunk / material.softer;
        y += reach * rise.x;
        along += reach * rise.y;
        if CURVATURE {
            section.rest = rotated(section.rest, rest_turn(rod, section, end.along));
        }
        // Without this, the drift of the tangent's length would scale the rest of the trajectory.
        section.tangent = (1.5 - 0.5 * dot(pose.tangent, pose.tangent)) * pose.tangent;
        section.bent = pose.bent;
        section.arclength -= section.radius * end.along;
        section.radius *= end.grown;
    }
    let energy = 0.5 * force * (x * section.bent + along);
    states[id] = State(section.tangent, vec2<real>(x, y), vec2<real>(energy, force));
}
