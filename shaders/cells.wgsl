// Cells of rows, one per invocation: guess, trajectory, Newton's step and what people want to know of the state, all as differences
// from the nearest reference of the row.

// A state of the row, exact, and its neighbourhood on the row.
struct Reference {
    tau: real,
    load: real,
    radius: real,
    arclength: real,
    // cos and sin of the tangent at rest
    rest: array<real, 2>,
    // from the contact to the tip, in tau
    to_tip: real,
    // of the pole's centre from the base, and of the base from the contact
    to_pole: array<real, 2>,
    position: array<real, 2>,
    tangent: array<real, 2>,
    // d(theta, X, Y) at the base, and of the energy, by tau and by load
    by_tau: array<real, 4>,
    by_load: array<real, 4>,
    // how far bending has turned the base, and twice the energy over the force
    bent: real,
    energy: real,
    // the push angle, and what is left of it
    push: array<real, 2>,
    // the load over the way along the row, which goes with load tau^2
    per_way: real,
    // coefficients of Taylor's polynomials of the row by the way from here: push angle, tau, and direction of the point at rest as far
    // from the base, less their own
    push_by_way: array<real, POWERS>,
    tau_by_way: array<real, POWERS>,
    resting_by_way: array<real, POWERS>,
    // d(ln D, phi) by tau and by load, four numbers for each power
    jacobian: array<real, JACOBIAN_TERMS>,
    // its rod, its first cell and the push angle of that, its steps and the first of them
    rod: u32,
    first_cell: u32,
    first_push: u32,
    steps: u32,
    first_step: u32,
    // so that references of f64 follow each other
    unused: u32,
}

// The state of a cell less that of its reference.
struct Cell {
    numbers: array<f32, CHANNELS>,
    residual: f32,
    outcome: u32,
}

@group(0) @binding(0) var<storage, read> rods: array<Rod>;
@group(0) @binding(1) var<storage, read> references: array<Reference>;
@group(0) @binding(2) var<storage, read> starts: array<StepStart>;
@group(0) @binding(3) var<storage, read> pushes: array<array<real, 2>>;
@group(0) @binding(4) var<storage, read_write> cells: array<Cell>;

fn jacobian_at(r: u32, way: real) -> vec4<real> {
    var sum = vec4<real>();
    for (var i = JACOBIAN_TERMS - 4; i >= 0; i -= 4) {
        sum = sum * way + vec4<real>(
            references[r].jacobian[i],
            references[r].jacobian[i + 1],
            references[r].jacobian[i + 2],
            references[r].jacobian[i + 3],
        );
    }
    return sum;
}

// A polynomial without a constant, and its slope; loops would keep the terms in memory.
fn at_way(t: array<real, POWERS>, x: real) -> real {
    return x * (t[0] + x * (t[1] + x * (t[2] + x * (t[3] + x * (t[4] + x * (t[5] + x * (t[6] + x * (t[7] + x * (t[8] + x * (t[9]
        + x * t[10]))))))))));
}

fn slope_at(t: array<real, POWERS>, x: real) -> real {
    return t[0] + x * (2.0 * t[1] + x * (3.0 * t[2] + x * (4.0 * t[3] + x * (5.0 * t[4] + x * (6.0 * t[5] + x * (7.0 * t[6]
        + x * (8.0 * t[7] + x * (9.0 * t[8] + x * (10.0 * t[9] + x * 11.0 * t[10])))))))));
}

// The way along the row to where the push angle has changed by `push`: from the root of a parabola on by Newton's method.
fn way_to(t: array<real, POWERS>, push: real) -> real {
    let root = sqrt(max(t[0] * t[0] + 4.0 * t[1] * push, 0.0));
    var way = 2.0 * push / (t[0] + select(-root, root, t[0] > 0.0));
    for (var round = 0; round < 4; round++) {
        way -= (at_way(t, way) - push) / slope_at(t, way);
    }
    return way;
}

// Product, and quotient, of complex numbers.
fn times(a: vec2<real>, b: vec2<real>) -> vec2<real> {
    return vec2<real>(a.x * b.x - a.y * b.y, a.y * b.x + a.x * b.y);
}

fn over(a: vec2<real>, b: vec2<real>) -> vec2<real> {
    return times(a, vec2<real>(b.x, -b.y)) / (b.x * b.x + b.y * b.y);
}

fn cross2(a: vec2<real>, b: vec2<real>) -> real {
    return a.x * b.y - a.y * b.x;
}

// The angle of 1 + z.
fn angle_of(z: vec2<real>) -> real {
    let t = z.y / (1.0 + z.x);
    let y = t * t;
    return t * (1.0 - y * (1.0 / 3.0 - y * (1.0 / 5.0 - y * (1.0 / 7.0 - y * (1.0 / 9.0 - y * (1.0 / 11.0 - y * (1.0 / 13.0)))))));
}

fn solve(r: u32, rod: Rod, push: real) -> Cell {
    var cell = Cell();
    let tau = references[r].tau;
    let load = references[r].load;
    let radius = references[r].radius;
    let s = references[r].arclength;
    let steps = references[r].steps;
    let to_pole = vec2<real>(references[r].to_pole[0], references[r].to_pole[1]);
    let distance = length(to_pole);
    let way = way_to(references[r].push_by_way, push);
    let further = at_way(references[r].tau_by_way, way);
    let jacobian = jacobian_at(r, way);
    let longer = further / tau;
    let less = -longer * (2.0 + longer) / ((1.0 + longer) * (1.0 + longer));
    let by = vec2<real>(further, references[r].per_way * way * (1.0 + less) + load * less);

    // The trajectory.
    let widening = -rod.taper * by.x;
    let squared = expm1_small(2.0 * widening);
    let force = radius * radius * Both(load, by.y * (1.0 + squared) + load * squared);
    let ds = radius * by.x * expm1_over_small(widening);
    var rest_at_contact = real(0.0);
    if CURVATURE || SPIRAL {
        rest_at_contact = rest_apart(rod, vec2<real>(references[r].rest[0], references[r].rest[1]), s, ds);
    }
    let trip = Path(
        rod,
        Both(tau, by.x),
        Both(tau, by.x) / real(steps),
        force,
        widening,
        rest_at_contact,
    );
    let apart = integrate(trip, references[r].first_step, steps);
    let angle = apart.bent - rest_at_contact;

    // Newton's step toward ln of what the pole's place must be multiplied by; for ratios near 1 that is the ratio less 1, but for its
    // square, which is in the bound.
    let moved = over(-vec2<real>(apart.x, apart.y), to_pole);
    let back = sine_and_versine(-angle);
    let seen = moved + times(vec2<real>(-back.y, back.x), vec2<real>(1.0 + moved.x, moved.y));
    let wanted = sine_and_versine(push);
    let missed = over(vec2<real>(-wanted.y, wanted.x) - seen, vec2<real>(1.0 + seen.x, seen.y));
    let by_tau = jacobian.xy;
    let by_load = jacobian.zw;
    let det = cross2(by_tau, by_load);
    let step = vec2<real>(cross2(missed, by_load), cross2(by_tau, missed)) / det;
    let per_load = abs(load) + 1.0 / (s * s);
    let step_length = max(abs(step.x) / s, abs(step.y) / per_load);
    let moves = max(abs(angle), abs(apart.bent)) * distance + length(vec2<real>(apart.x, apart.y));
    let left = (LEFT_BY_STEP * step_length + JACOBIAN_ERROR) * step_length;
    let residual = left * (s + distance) + ROUNDING_OF_WAY * moves + ROUNDING;
    cell.residual = f32(residual);

    // What people want to know.
    let end = by + step;
    let theta = angle + references[r].by_tau[0] * step.x + references[r].by_load[0] * step.y;
    let shift = vec2<real>(
        apart.x + references[r].by_tau[1] * step.x + references[r].by_load[1] * step.y,
        apart.y + references[r].by_tau[2] * step.x + references[r].by_load[2] * step.y,
    );
    let position = vec2<real>(references[r].position[0], references[r].position[1]);
    let tangent = tangents(vec2<real>(references[r].tangent[0], references[r].tangent[1]), theta);
    let end_widening = -rod.taper * end.x;
    let end_squared = expm1_small(2.0 * end_widening);
    let end_force = radius * radius * Both(load, end.y * (1.0 + end_squared) + load * end_squared);
    let moved_contact = over(shift, position);
    cell.numbers[0] = f32(radius * end.x * expm1_over_small(end_widening));
    cell.numbers[1] = f32(push - angle_of(over(-shift, to_pole)));
    cell.numbers[2] = f32(end_force.y);
    cell.numbers[3] = f32(product(end_force, tangent.sin).y);
    cell.numbers[4] = f32(product(end_force, tangent.cos).y);
    cell.numbers[5] = f32(-product(end_force, Both(position.x, shift.x)).y);
    cell.numbers[6] = f32(angle_of(moved_contact) - theta - at_way(references[r].resting_by_way, way));
    cell.numbers[7] = f32(dot(shift, 2.0 * position + shift) / (length(position + shift) + length(position)));
    let energy = Both(references[r].energy, product(Both(position.x, apart.x), Both(references[r].bent, apart.bent)).y + apart.along);
    cell.numbers[8] = f32(0.5 * product(force, energy).y
        + references[r].by_tau[3] * step.x + references[r].by_load[3] * step.y);

    // Whether all of this holds.
    cell.outcome = SOLVED;
    let to_tip = references[r].to_tip - end.x;
    if det < CLEAR_OF_FOLD * length(by_tau) * length(by_load) || to_tip < CLEAR_OF_TIP * tau {
        cell.outcome = NEAR_EDGE;
    }
    let turned = max(max(abs(angle), abs(apart.bent)), abs(push));
    let largest = max(max(turned, abs(3.0 * widening)), 2.0 * max(length(moved_contact), length(moved)));
    // How far the whisker at rest bends between any two points of the reference and the cell: rho l is at most 1 or 1/(e beta tau).
    var bends = real(0.0);
    if CURVATURE {
        bends = abs(2.0 * rod.bend * by.x) * min(1.0, 0.37 / (rod.taper * tau + 1e-9));
    }
    if largest > 0.4 || bends > FARTHEST_REST || abs(load) * s * s > LARGEST_Q {
        cell.outcome = FAR;
    }
    if residual > GOAL * min(1.0, 2.0 * s) || step_length > LONGEST_STEP {
        cell.outcome = MISSED;
    }
    if !is_finite(residual + theta + shift.x + shift.y + end.x + end.y) {
        cell.outcome = NOT_FINITE;
    }
    return cell;
}

@compute @workgroup_size(WORKGROUP)
fn solve_cells(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&cells) {
        return;
    }
    // The last reference whose cells begin here or before.
    var r = 0u;
    var beyond = arrayLength(&references);
    while beyond - r > 1u {
        let middle = (r + beyond) / 2u;
        if references[middle].first_cell <= id.x {
            r = middle;
        } else {
            beyond = middle;
        }
    }
    let here = pushes[references[r].first_push + id.x - references[r].first_cell];
    let push = (here[0] - references[r].push[0]) + (here[1] - references[r].push[1]);
    cells[id.x] = solve(r, rods[references[r].rod], push);
}
