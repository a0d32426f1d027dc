// Numbers of a reference trajectory, and by how much those of a cell differ: nothing cancels, so that f32 tells small differences
// to as many digits as it has.

// The reference's number, and the cell's less that.
alias Both = vec2<real>;

fn product(a: Both, b: Both) -> Both {
    return Both(a.x * b.x, a.y * (b.x + b.y) + a.x * b.y);
}

// exp(x) - 1 for |x| <= 0.4: Taylor polynomial of degree 13.
fn expm1_small(x: real) -> real {
    return x * (1.0 + x * (1.0 / 2.0) * (1.0 + x * (1.0 / 3.0) * (1.0 + x * (1.0 / 4.0) * (1.0 + x * (1.0 / 5.0) * (1.0
        + x * (1.0 / 6.0) * (1.0 + x * (1.0 / 7.0) * (1.0 + x * (1.0 / 8.0) * (1.0 + x * (1.0 / 9.0) * (1.0
        + x * (1.0 / 10.0) * (1.0 + x * (1.0 / 11.0) * (1.0 + x * (1.0 / 12.0) * (1.0 + x * (1.0 / 13.0)))))))))))));
}

// sin(x) and 1 - cos(x) for |x| <= 0.5: what is left out is below 3e-14.
fn sine_and_versine(x: real) -> vec2<real> {
    let y = x * x;
    let sine = 1.0 - y * (1.0 / 6.0) * (1.0 - y * (1.0 / 20.0) * (1.0 - y * (1.0 / 42.0) * (1.0 - y * (1.0 / 72.0) * (1.0
        - y * (1.0 / 110.0)))));
    let versine = 1.0 - y * (1.0 / 12.0) * (1.0 - y * (1.0 / 30.0) * (1.0 - y * (1.0 / 56.0) * (1.0 - y * (1.0 / 90.0) * (1.0
        - y * (1.0 / 132.0)))));
    return vec2<real>(x * sine, 0.5 * y * versine);
}

// The unit vector rotated by a small angle.
fn rotated(unit: vec2<real>, angle: real) -> vec2<real> {
    let turn = sine_and_versine(angle);
    return unit + turn.x * vec2<real>(-unit.y, unit.x) - turn.y * unit;
}

// cos and sin of an angle, and by how much those of an angle that is larger by `apart` differ.
struct Tangent {
    cos: Both,
    sin: Both,
}

fn tangents(unit: vec2<real>, apart: real) -> Tangent {
    let turn = sine_and_versine(apart);
    return Tangent(
        Both(unit.x, -turn.x * unit.y - turn.y * unit.x),
        Both(unit.y, turn.x * unit.x - turn.y * unit.y),
    );
}
