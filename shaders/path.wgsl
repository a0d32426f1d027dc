// Path from the contact to the base, and its steps and stages, for a base point and a cell side by side.

struct Rod {
    taper: real,
    bend: real,
    // [k0, k1] of an Euler spiral
    spiral: vec2<real>,
    // coefficients of a polynomial curvature in s - 1/2: of the powers 0 to 3, and 4 to 6
    low: vec4<real>,
    high: vec4<real>,
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
    // series of the resting whisker's tangent along the step: see `Bent` and `Polynomial` in Rust
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
