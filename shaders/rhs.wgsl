// The right-hand sides, in sigma = tau_contact - tau; the twin of `rhs.rs`, `intrinsic.rs` and `sensitivity/` in
// `crates/mechanics/src/shooting/`.

struct Section {
    rho: real,
    inverse_cube: real,
    // from the base; only where it is needed
    arclength: real,
}

struct State {
    // cos and sin of the rest tangent
    rest: vec2<real>,
    // c, s, X, Y
    rod: vec4<real>,
    // d(theta, X, Y) by the force
    by_force: vec3<real>,
    // d(theta, X) by the arclength of the contact; not where the rod is similar
    by_arclength: vec2<real>,
}

struct System {
    force: real,
    twice_bend: real,
    spiral: array<real, 2>,
    material: Material,
}

fn rhs(system: System, section: Section, y: State) -> State {
    let f = system.force;
    let rho = section.rho;
    let w = compliance(system.material, section);
    let c = y.rod.x;
    let s = y.rod.y;
    let x = y.rod.z;
    var turn = -f * x * w;
    var rest = vec2<real>();
    if CURVATURE {
        let at_rest = rho * system.twice_bend * y.rest.x * y.rest.x * y.rest.x;
        rest = vec2<real>(at_rest * y.rest.y, -at_rest * y.rest.x);
        turn += at_rest;
    }
    if SPIRAL {
        turn += rho * (system.spiral[0] + system.spiral[1] * section.arclength);
    }
    let theta_f = y.by_force.x;
    var by_arclength = vec2<real>();
    if !SIMILAR {
        by_arclength = vec2<real>(w * f * y.by_arclength.y, rho * s * y.by_arclength.x);
    }
    return State(
        rest,
        vec4<real>(turn * s, -turn * c, -rho * c, -rho * s),
        vec3<real>(w * (f * y.by_force.y + x), rho * s * theta_f, -rho * c * theta_f),
        by_arclength,
    );
}

fn plus(y: State, h: real, k: State) -> State {
    return State(
        y.rest + h * k.rest,
        y.rod + h * k.rod,
        y.by_force + h * k.by_force,
        y.by_arclength + h * k.by_arclength,
    );
}
