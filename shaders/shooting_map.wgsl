// The pole as the base sees it, and Newton's step; the twin of `map.rs`, `sensitivity/` and `batch/pole.rs` in
// `crates/mechanics/src/shooting/`.

struct ShootingMap {
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

// d(theta, X, Y) at the base by tau at fixed load, and by the load.
struct BaseDerivatives {
    by_tau: vec3<real>,
    by_load: vec3<real>,
}

// The twin of `SensitivitySet::at_base`.
fn at_base(rod: Rod, start: Start, y: State) -> BaseDerivatives {
    let f = start.force;
    let x = y.rod.z;
    let by_load = start.radius * start.radius * y.by_force;
    if SIMILAR {
        return BaseDerivatives(vec3<real>(f * x, -rod.taper * y.rod.zw - y.rod.xy), by_load);
    }
    let theta_s = y.by_arclength.x;
    let x_s = y.by_arclength.y;
    let y_s = theta_s * (f * y.by_force.y + x) - f * y.by_force.x * x_s - start.tangent.y;
    return BaseDerivatives(
        start.radius * vec3<real>(theta_s, x_s, y_s) - 2.0 * rod.taper * f * y.by_force,
        by_load,
    );
}

// A derivative of (ln D, phi) from that of theta, X and Y; the twin of `Centre::ln_pole_by`.
fn ln_pole_by(by: vec3<real>, w: vec2<real>) -> vec2<real> {
    return over(-by.yz, w) - vec2<real>(0.0, by.x);
}

// One trajectory, in `steps` steps, or as many for every piece of a profile.
fn shoot_once(rod: Rod, tau: real, start: Start, steps: u32) -> ShootingMap {
    let at_contact = State(
        vec2<real>(start.cos, start.sin),
        vec4<real>(start.tangent, 0.0, 0.0),
        vec3<real>(),
        vec2<real>(-curvature(rod, start), -start.tangent.x),
    );
    let y = travel(rod, tau, start, steps, at_contact);
    let to_pole = rod.pole * vec2<real>(start.tangent.y, -start.tangent.x);
    let w = to_pole - y.rod.zw;
    let first = at_base(rod, start, y);
    return ShootingMap(
        times(vec2<real>(y.rod.x, -y.rod.y), w),
        ln_pole_by(first.by_tau, w),
        ln_pole_by(first.by_load, w),
    );
}

// Newton's step (tau, load) toward `wanted` from the contact at arclength s, shortened as a whole.
fn newton_step(map: ShootingMap, wanted: vec2<real>, s: real, load: real) -> vec2<real> {
    let residual = over(wanted - map.pole, map.pole);
    let det = cross2(map.by_tau, map.by_load);
    let full = vec2<real>(cross2(residual, map.by_load), cross2(map.by_tau, residual)) / det;
    let length = max(abs(full.x) / s, abs(full.y) / (abs(load) + 1.0 / (s * s)));
    return full / max(length / LONGEST_STEP, 1.0);
}
