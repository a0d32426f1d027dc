// Cells of rows, one per invocation: guess, trajectory, Newton's step and what people want to know of the state, all as differences
// from the nearest reference of the row.

// Some cells of one reference: its index, the first of their push angles, the first of their answers, and how many they are.
alias Group = vec4<u32>;

@group(0) @binding(0) var<storage, read> groups: array<Group>;
@group(0) @binding(1) var<storage, read> references: array<vec4<real>>;
// Invocations of a group read the same: a software adapter takes uniforms faster.
@group(0) @binding(2) var<uniform> starts: array<StepStart, MOST_STEPS>;
@group(0) @binding(3) var<storage, read> pushes: array<vec2<real>>;
@group(0) @binding(4) var<storage, read_write> cells: array<array<vec4<u32>, 3>>;

// Base point of the workgroup: an exact state of the row, and its neighbourhood on the row, in the layout of the Rust struct. Outside of
// loops, a software adapter reads a constant index of it once for all invocations.
var<workgroup> reference: array<vec4<real>, REFERENCE_QUADS>;

// The state of a cell less that of its reference.
struct Cell {
    numbers: array<f32, CHANNELS>,
    residual: f32,
    outcome: u32,
}

// d(ln D, phi) by tau and by load.
fn jacobian_at(way: real) -> vec4<real> {
    return reference[JACOBIAN] + way * (reference[JACOBIAN + 1u] + way * (reference[JACOBIAN + 2u] + way * (reference[JACOBIAN + 3u]
        + way * (reference[JACOBIAN + 4u] + way * (reference[JACOBIAN + 5u] + way * (reference[JACOBIAN + 6u]
        + way * reference[JACOBIAN + 7u]))))));
}

// Coefficients of a polynomial without a constant.
struct Polynomial {
    first: vec4<real>,
    middle: vec4<real>,
    last: vec4<real>,
}

// Polynomial of the base point's row that begins at the index `first`.
fn of_row(first: u32) -> Polynomial {
    return Polynomial(reference[first], reference[first + 1u], reference[first + 2u]);
}

fn at_way(p: Polynomial, x: real) -> real {
    return x * (p.first.x + x * (p.first.y + x * (p.first.z + x * (p.first.w + x * (p.middle.x + x * (p.middle.y + x * (p.middle.z
        + x * (p.middle.w + x * (p.last.x + x * (p.last.y + x * p.last.z))))))))));
}

fn slope_at(p: Polynomial, x: real) -> real {
    return p.first.x + x * (2.0 * p.first.y + x * (3.0 * p.first.z + x * (4.0 * p.first.w + x * (5.0 * p.middle.x
        + x * (6.0 * p.middle.y + x * (7.0 * p.middle.z + x * (8.0 * p.middle.w + x * (9.0 * p.last.x + x * (10.0 * p.last.y
        + x * 11.0 * p.last.z)))))))));
}

// The way along the row to where the push angle has changed by `push`: from the root of a parabola on by Newton's method.
fn way_to(push: real) -> real {
    let p = of_row(PUSH_BY_WAY);
    let root = sqrt(max(p.first.x * p.first.x + 4.0 * p.first.y * push, 0.0));
    var way = 2.0 * push / (p.first.x + select(-root, root, p.first.x > 0.0));
    for (var round = 0; round < 4; round++) {
        way -= (at_way(p, way) - push) / slope_at(p, way);
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

// The cell at a push angle that is larger by `push` than the reference's, along so many of its steps.
fn solve(push: real, steps: u32) -> Cell {
    var cell = Cell();
    let tau = reference[CONTACT].x;
    let load = reference[CONTACT].y;
    let radius = reference[CONTACT].z;
    let s = reference[CONTACT].w;
    let rod = Rod(reference[ROD].x, reference[ROD].y, reference[ROD].zw);
    let to_pole = reference[PLACES].xy;
    let position = reference[PLACES].zw;
    let distance = length(to_pole);
    let way = way_to(push);
    let further = at_way(of_row(TAU_BY_WAY), way);
    let jacobian = jacobian_at(way);
    let longer = further / tau;
    let less = -longer * (2.0 + longer) / ((1.0 + longer) * (1.0 + longer));
    let by = vec2<real>(further, reference[REST].w * way * (1.0 + less) + load * less);

    // The trajectory.
    let widening = -rod.taper * by.x;
    let squared = expm1_small(2.0 * widening);
    let force = radius * radius * Both(load, by.y * (1.0 + squared) + load * squared);
    let ds = radius * by.x * expm1_over_small(widening);
    var rest_at_contact = real(0.0);
    if CURVATURE || SPIRAL {
        rest_at_contact = rest_apart(rod, reference[REST].xy, s, ds);
    }
    let trip = Path(
        rod,
        Both(tau, by.x),
        Both(tau, by.x) / real(steps),
        force,
        widening,
        rest_at_contact,
    );
    let apart = integrate(trip, u32(reference[PUSH].w), steps);
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
    let theta = angle + reference[BY_TAU].x * step.x + reference[BY_LOAD].x * step.y;
    let shift = vec2<real>(
        apart.x + reference[BY_TAU].y * step.x + reference[BY_LOAD].y * step.y,
        apart.y + reference[BY_TAU].z * step.x + reference[BY_LOAD].z * step.y,
    );
    let tangent = tangents(reference[BASE].xy, theta);
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
    cell.numbers[6] = f32(angle_of(moved_contact) - theta - at_way(of_row(RESTING_BY_WAY), way));
    cell.numbers[7] = f32(dot(shift, 2.0 * position + shift) / (length(position + shift) + length(position)));
    let energy = Both(reference[BASE].w, product(Both(position.x, apart.x), Both(reference[BASE].z, apart.bent)).y + apart.along);
    cell.numbers[8] = f32(0.5 * product(force, energy).y
        + reference[BY_TAU].w * step.x + reference[BY_LOAD].w * step.y);

    // Whether all of this holds.
    cell.outcome = SOLVED;
    let to_tip = reference[REST].z - end.x;
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
        cell.outcome = OUTSIDE_TRUST;
    }
    if residual > GOAL * min(1.0, 2.0 * s) || step_length > LONGEST_STEP {
        cell.outcome = MISSED;
    }
    if !is_finite(residual + theta + shift.x + shift.y + end.x + end.y) {
        cell.outcome = NOT_FINITE;
    }
    return cell;
}

// Four numbers at a time: a software adapter takes as long for one.
fn answer(id: u32, cell: Cell) {
    let n = cell.numbers;
    cells[id] = array<vec4<u32>, 3>(
        bitcast<vec4<u32>>(vec4<f32>(n[0], n[1], n[2], n[3])),
        bitcast<vec4<u32>>(vec4<f32>(n[4], n[5], n[6], n[7])),
        vec4<u32>(bitcast<u32>(n[8]), bitcast<u32>(cell.residual), cell.outcome, 0u),
    );
}

@compute @workgroup_size(WORKGROUP)
fn solve_cells(@builtin(workgroup_id) of_group: vec3<u32>, @builtin(local_invocation_index) own: u32) {
    let group = groups[of_group.x];
    for (var i = own; i < REFERENCE_QUADS; i += WORKGROUP) {
        reference[i] = references[group.x * REFERENCE_QUADS + i];
    }
    workgroupBarrier();
    let here = pushes[group.y + min(own, group.w - 1u)];
    let push = (here.x - reference[PUSH].x) + (here.y - reference[PUSH].y);
    // Invocations beyond the last cell take no steps.
    let is_asked = own < group.w;
    let steps = select(0u, u32(reference[PUSH].z), is_asked);
    let cell = solve(push, steps);
    let id = group.z + own;
    if is_asked {
        answer(id, cell);
    }
}
