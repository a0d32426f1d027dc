// The rod and its contact; the twin of `rod.rs`, `contact.rs` and `rest/parabola.rs` in `crates/mechanics/src/rod/`.

// Lengths in whisker lengths; as in Rust.
struct Rod {
    taper: real,
    bend: real,
    slope: real,
    pole: real,
    friction: real,
    gradient: real,
    // [k0, k1] of an Euler spiral
    spiral: array<real, 2>,
}

struct Start {
    radius: real,
    arclength: real,
    force: real,
    tangent: vec2<real>,
    cos: real,
    sin: real,
}

// Four times `bend` times the arclength of the parabola from its vertex to the slope t.
fn arc(t: real) -> real {
    return t * sqrt(1.0 + t * t) + arsinh(t);
}

// Slope of the parabola at arclength s: two steps of Halley's method.
fn slope_at(rod: Rod, s: real) -> real {
    let z = 4.0 * rod.bend * s + arc(rod.slope);
    let power = 1.0 + z * z * (0.253 + 0.0437 * abs(z) + z * z / 256.0);
    var t = 0.5 * z / sqrt(sqrt(sqrt(power)));
    for (var i = 0; i < 2; i++) {
        let root = sqrt(1.0 + t * t);
        let miss = arc(t) - z;
        t -= miss * root / (2.0 * root * root - 0.5 * miss * t / root);
    }
    return t;
}

// The whisker's tangent at the contact, in axes whose second one is along the force.
fn contact_tangent(rod: Rod) -> vec2<real> {
    return vec2<real>(1.0, rod.friction) / sqrt(1.0 + rod.friction * rod.friction);
}

// The contact at tau with load = force/radius^2.
fn start_at(rod: Rod, tau: real, load: real) -> Start {
    var start = Start(1.0, tau, load, contact_tangent(rod), 1.0, 0.0);
    if TAPER {
        start.radius = exponential(-rod.taper * tau);
        start.arclength = tau * expm1_over(-rod.taper * tau);
        start.force = load * start.radius * start.radius;
    }
    if CURVATURE {
        let slope = slope_at(rod, start.arclength);
        start.cos = 1.0 / sqrt(1.0 + slope * slope);
        start.sin = slope * start.cos;
    }
    return start;
}

// Curvature at rest at a contact.
fn curvature(rod: Rod, start: Start) -> real {
    if SPIRAL {
        return rod.spiral[0] + rod.spiral[1] * start.arclength;
    }
    return 2.0 * rod.bend * start.cos * start.cos * start.cos;
}
