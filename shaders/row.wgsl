// Polynomials of the row around a base point.

// Base point of the workgroup, in the layout of `GpuBasePoint`: an exact state of the row, and the expansion of the row around it. Outside
// of loops, a software adapter reads a constant index of it once for all invocations.
var<workgroup> base_point: array<vec4<real>, BASE_POINT_QUADS>;

// d(ln D, phi) by tau and by load.
fn jacobian_at(w: real) -> vec4<real> {
    return base_point[JACOBIAN] + w * (base_point[JACOBIAN + 1u] + w * (base_point[JACOBIAN + 2u] + w * (base_point[JACOBIAN + 3u]
        + w * (base_point[JACOBIAN + 4u] + w * (base_point[JACOBIAN + 5u] + w * (base_point[JACOBIAN + 6u]
        + w * base_point[JACOBIAN + 7u]))))));
}

// Coefficients of a polynomial without a constant.
struct Polynomial {
    first: vec4<real>,
    middle: vec4<real>,
    last: vec4<real>,
}

// Polynomial of the base point's row that begins at the index `first`.
fn of_row(first: u32) -> Polynomial {
    return Polynomial(base_point[first], base_point[first + 1u], base_point[first + 2u]);
}

fn value_at(p: Polynomial, x: real) -> real {
    return x * (p.first.x + x * (p.first.y + x * (p.first.z + x * (p.first.w + x * (p.middle.x + x * (p.middle.y + x * (p.middle.z
        + x * (p.middle.w + x * (p.last.x + x * (p.last.y + x * p.last.z))))))))));
}

fn slope_at(p: Polynomial, x: real) -> real {
    return p.first.x + x * (2.0 * p.first.y + x * (3.0 * p.first.z + x * (4.0 * p.first.w + x * (5.0 * p.middle.x
        + x * (6.0 * p.middle.y + x * (7.0 * p.middle.z + x * (8.0 * p.middle.w + x * (9.0 * p.last.x + x * (10.0 * p.last.y
        + x * 11.0 * p.last.z)))))))));
}

// Change of the row parameter at which the push angle has changed by `push`: Newton's method from the root of a parabola.
fn w_at(push: real) -> real {
    let p = of_row(PUSH_BY_W);
    let root = sqrt(max(p.first.x * p.first.x + 4.0 * p.first.y * push, 0.0));
    var w = 2.0 * push / (p.first.x + select(-root, root, p.first.x > 0.0));
    for (var round = 0; round < 4; round++) {
        w -= (value_at(p, w) - push) / slope_at(p, w);
    }
    return w;
}
