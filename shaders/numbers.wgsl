// Functions of real and complex numbers. WGSL's exp and log have wide error bounds in f32 and none in f64.

// Compilers fold `x != x` but not operations on bits. A number that overflows f32 is not finite, either.
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

// sin(x) and 1 - cos(x) for |x| <= 0.5: relative truncation errors are below 3e-14 in f64 and 2e-8 in f32.
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

// Angle of 1 + z.
fn angle_of(z: vec2<real>) -> real {
    let t = z.y / (1.0 + z.x);
    let y = t * t;
    return t * (1.0 - y * (1.0 / 3.0 - y * (1.0 / 5.0 - y * (1.0 / 7.0 - y * (1.0 / 9.0 - y * (1.0 / 11.0 - y * (1.0 / 13.0)))))));
}
