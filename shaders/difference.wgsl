// Pairs of a number of the base point and the difference of the cell's. No operation cancels, so small differences keep all digits of
// an f32.

// Number of the base point, and the cell's less that.
alias Both = vec2<real>;

fn product(a: Both, b: Both) -> Both {
    return Both(a.x * b.x, a.y * (b.x + b.y) + a.x * b.y);
}

// Unit vector rotated by a small angle.
fn rotated(unit: vec2<real>, angle: real) -> vec2<real> {
    let turn = sine_and_versine(angle);
    return unit + turn.x * vec2<real>(-unit.y, unit.x) - turn.y * unit;
}

// cos and sin of an angle, and their differences at an angle that is larger by `apart`.
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
