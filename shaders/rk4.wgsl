// The classical Runge-Kutta method of order 4; the twin of `rk4.rs` and `mod.rs` in
// `crates/mechanics/src/shooting/integrator/`.

// What the radius and its inverse cube gain from the start of a step to its middle and to its end, relative, and what
// the arclength gains over the radius.
// Rust multiplies by 1 + gain; in f32 that would bring the same rounding into every step (measured: 2.5 times
// the error of a trajectory).
struct Gains {
    middle: Section,
    end: Section,
}

fn gain(taper: real, h: real) -> Section {
    let x = taper * h;
    let growth = expm1_over_small(x);
    return Section(x * growth, -3.0 * x * expm1_over(-3.0 * x), -h * growth);
}

fn gains(taper: real, h: real) -> Gains {
    return Gains(gain(taper, 0.5 * h), gain(taper, h));
}

fn at(gain: Section, start: Section) -> Section {
    if TAPER {
        return Section(
            start.rho + start.rho * gain.rho,
            start.inverse_cube + start.inverse_cube * gain.inverse_cube,
            start.arclength + start.rho * gain.arclength,
        );
    }
    return start;
}

fn step(system: System, gains: Gains, start: Section, h: real, y: State) -> State {
    let half = 0.5 * h;
    let middle = at(gains.middle, start);
    let end = at(gains.end, start);
    let k1 = rhs(system, start, y);
    let k2 = rhs(system, middle, plus(y, half, k1));
    let k3 = rhs(system, middle, plus(y, half, k2));
    let k4 = rhs(system, end, plus(y, h, k3));
    let sixth = h / 6.0;
    let third = h / 3.0;
    return plus(plus(plus(plus(y, sixth, k1), third, k2), third, k3), sixth, k4);
}

// The rod with its tangent brought back to unit length, to first order in the drift of a step.
fn upright(rod: vec4<real>) -> vec4<real> {
    let scale = 1.5 - 0.5 * dot(rod.xy, rod.xy);
    return vec4<real>(scale * rod.xy, rod.zw);
}

fn integrate(system: System, gains: Gains, start: Section, h: real, steps: u32, at_start: State) -> State {
    var section = start;
    var y = at_start;
    for (var i = 0u; i < steps; i++) {
        y = step(system, gains, section, h, y);
        y.rod = upright(y.rod);
        section = at(gains.end, section);
    }
    return y;
}
