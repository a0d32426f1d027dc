// Shape at rest and equation of motion at one stage of a step, for a base point and a cell side by side. The twin of `intrinsic.rs` and
// `material.rs` in `crates/mechanics/src/shooting/`, where the equations are.

struct Rod {
    taper: real,
    bend: real,
    // [k0, k1] of an Euler spiral
    spiral: vec2<real>,
}

// Start of a step of the base point's trajectory.
struct StepStart {
    // radius, arclength, rotation by bending since the contact, and position across the force
    place: vec4<real>,
    // cos and sin of the tangents of the rod and of the whisker at rest
    tangents: vec4<real>,
}

// Ratios from the start of a step to one of its stages.
struct Stage {
    // arclength toward the base, over the radius at the start of the step
    along: real,
    // fraction of the path from the contact to the base
    part: real,
    // m_0/m, (rho/m)/(rho_0/m_0), rho/rho_0
    inverse_scale: Both,
    forcing: Both,
    grown: Both,
}

// Path from the contact to the base, the same in all steps.
struct Path {
    rod: Rod,
    // tau of the contact
    tau: Both,
    // step in tau
    h: Both,
    force: Both,
    // ln of the cell's radius at the contact over the base point's
    widening: real,
    // tangent angle of the whisker at rest, at the cell's contact less at the base point's
    rest_at_contact: real,
}

// One step.
struct Step {
    // fraction of the path that is left to the base
    left: real,
    radius: real,
    arclength: real,
    tangent: vec2<real>,
    rest: vec2<real>,
    // rotation by bending since the contact
    bent: Both,
    // h F/rho^3 and h rho
    turning: Both,
    reach: Both,
    // h^2 m''/m
    potential: Both,
    // series of the resting whisker's tangent along the step: see `Bent` in Rust
    rest_rate: real,
    rest_terms: array<real, REST_TERMS>,
}

// Rod of the cell less that of the base point.
struct Apart {
    bent: real,
    x: real,
    y: real,
    // integral of the difference in rotation along -X
    along: real,
}

fn stage_at(path: Path, steps: real, node: real) -> Stage {
    let half = 0.5 * node * path.rod.taper * path.h.x;
    let shrinks = expm1_small(-half);
    let shrunk = 1.0 + shrinks;
    let grown = 1.0 / (shrunk * shrunk);
    // Ratios of the cell's numbers to the base point's, less 1.
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

// Rotation of the whisker at rest from the start of a step to a stage.
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

// Rotation of the whisker at rest from the tangent `rest` at arclength `s` to arclength `s + ds`.
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
