// Functions of one number. Builtin exp and log have wide error bounds in f32 and none worth trusting in f64.

// Compilers fold `x != x`; bits they leave alone. What overflows f32 counts as not finite, too.
fn is_finite(x: real) -> bool {
    return (bitcast<u32>(f32(x)) & 0x7f800000u) != 0x7f800000u;
}

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

// exp(x) - 1 for |x| <= 0.4.
fn expm1_small(x: real) -> real {
    return x * expm1_over_small(x);
}

// sin(x) and 1 - cos(x) for |x| <= 0.5: what is left out of x and x^2/2 is in f64 below 3e-14, in f32 below 2e-8.
fn sine_and_versine(x: real) -> vec2<real> {
    let y = x * x;
    var tail = vec2<real>();
    if DOUBLE {
        tail = y * (vec2<real>(1.0 / 362880.0, 1.0 / 3628800.0) - y * vec2<real>(1.0 / 39916800.0, 1.0 / 479001600.0));
    }
    let sine = 1.0 - y * (1.0 / 6.0 - y * (1.0 / 120.0 - y * (1.0 / 5040.0 - tail.x)));
    let versine = 0.5 - y * (1.0 / 24.0 - y * (1.0 / 720.0 - y * (1.0 / 40320.0 - tail.y)));
    return vec2<real>(x * sine, y * versine);
}
