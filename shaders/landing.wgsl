// The pole as the base sees it, and Newton's step; the twin of `src/model/landing.rs`.

struct Landing {
    pole: vec2<real>,
    // d(ln D, phi)/dtau at fixed load, and by the load
    by_tau: vec2<real>,
    by_load: vec2<real>,
}

// Product of complex numbers.
fn times(a: vec2<real>, b: vec2<real>) -> vec2<real> {
    return vec2<real>(a.x * b.x - a.y * b.y, a.y * b.x + a.x * b.y);
}

// Quotient of complex numbers.
fn over(a: vec2<real>, b: vec2<real>) -> vec2<real> {
    return times(a, vec2<real>(b.x, -b.y)) / (b.x * b.x + b.y * b.y);
}

fn cross2(a: vec2<real>, b: vec2<real>) -> real {
    return a.x * b.y - a.y * b.x;
}

// One trajectory, in `steps` steps, or as many for every piece of a profile.
fn land(rod: Rod, tau: real, start: Start, steps: u32) -> Landing {
    let at_contact = State(
        vec2<real>(start.cos, start.sin),
        vec4<real>(start.tangent, 0.0, 0.0),
        vec3<real>(),
        vec3<real>(-curvature(rod, start), -start.tangent),
    );
    let y = travel(rod, tau, start, steps, at_contact);
    let to_pole = rod.pole * vec2<real>(start.tangent.y, -start.tangent.x);
    let w = to_pole - y.rod.zw;
    let f = over(-y.by_force.yz, w) - vec2<real>(0.0, y.by_force.x);
    let s = over(-y.by_arclength.yz, w) - vec2<real>(0.0, y.by_arclength.x);
    let rho = start.radius;
    return Landing(
        times(vec2<real>(y.rod.x, -y.rod.y), w),
        rho * s - 2.0 * rod.taper * start.force * f,
        rho * rho * f,
    );
}

// Newton's step (tau, load) toward `wanted` from the contact at arclength s, shortened as a whole.
fn newton_step(landing: Landing, wanted: vec2<real>, s: real, load: real) -> vec2<real> {
    let residual = over(wanted - landing.pole, landing.pole);
    let det = cross2(landing.by_tau, landing.by_load);
    let full = vec2<real>(cross2(residual, landing.by_load), cross2(landing.by_tau, residual)) / det;
    let length = max(abs(full.x) / s, abs(full.y) / (abs(load) + 1.0 / (s * s)));
    return full / max(length / LONGEST_STEP, 1.0);
}
