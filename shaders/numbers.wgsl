// Functions of one number. Builtin exp and log have wide error bounds in f32 and none worth trusting in f64.

// Compilers fold `x != x`; bits they leave alone. What overflows f32 counts as not finite, too.
fn is_finite(x: real) -> bool {
    return (bitcast<u32>(f32(x)) & 0x7f800000u) != 0x7f800000u;
}

// (exp(x) - 1)/x for |x| <= 0.4: Taylor polynomial of degree 12, truncation below 1e-16.
fn expm1_over_small(x: real) -> real {
    return 1.0 + x * (1.0 / 2.0) * (1.0 + x * (1.0 / 3.0) * (1.0 + x * (1.0 / 4.0) * (1.0 + x * (1.0 / 5.0) * (1.0
        + x * (1.0 / 6.0) * (1.0 + x * (1.0 / 7.0) * (1.0 + x * (1.0 / 8.0) * (1.0 + x * (1.0 / 9.0) * (1.0
        + x * (1.0 / 10.0) * (1.0 + x * (1.0 / 11.0) * (1.0 + x * (1.0 / 12.0) * (1.0 + x * (1.0 / 13.0))))))))))));
}

// exp(x) - 1 for |x| <= 0.4.
fn expm1_small(x: real) -> real {
    return x * expm1_over_small(x);
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
