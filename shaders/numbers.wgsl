// Functions of one number. Builtin exp and log have wide error bounds in f32 and none worth trusting in f64.

// Compilers fold `x != x`; bits they leave alone. What overflows f32 counts as not finite, too.
fn is_finite(x: real) -> bool {
    return (bitcast<u32>(f32(x)) & 0x7f800000u) != 0x7f800000u;
}

// (exp(x) - 1)/x for |x| <= 0.4: Taylor polynomial of degree 12, truncation below 1e-16.
fn expm1_over_small(x: real) -> real {
    var sum = real(1.0);
    for (var n = 13; n > 1; n--) {
        sum = 1.0 + sum * x / real(n);
    }
    return sum;
}

// exp(x) for |x| < 87: 2^k exp(r) with |r| <= ln(2)/2; ln(2) in two parts, the first with few digits.
fn exponential(x: real) -> real {
    let k = floor(x * 1.4426950408889634 + 0.5);
    let r = x - k * 0.693359375 + k * 2.12194440054690583e-4;
    let power = real(bitcast<f32>(u32(clamp(i32(k), -126, 127) + 127) << 23u));
    return power * (1.0 + r * expm1_over_small(r));
}

// (exp(x) - 1)/x without cancellation.
fn expm1_over(x: real) -> real {
    if abs(x) <= 0.4 {
        return expm1_over_small(x);
    }
    return (exponential(x) - 1.0) / x;
}

// asinh(t): halved with sinh(u/2) = sinh(u)/sqrt(2 + 2 cosh(u)) until small, then 2 atanh(tanh(u/2)).
fn arsinh(t: real) -> real {
    var small = t;
    var scale = real(2.0);
    for (var i = 0; i < 10 && abs(small) > 0.25; i++) {
        small = small / sqrt(2.0 + 2.0 * sqrt(1.0 + small * small));
        scale = 2.0 * scale;
    }
    let w = small / (1.0 + sqrt(1.0 + small * small));
    var sum = real(1.0 / 17.0);
    for (var n = 15; n > 0; n -= 2) {
        sum = 1.0 / real(n) + w * w * sum;
    }
    return scale * w * sum;
}
