// Cells of rows, one per invocation: guess, trajectory, Newton step and channel values, all as differences from the nearest base point of
// the row.

// Cells of one base point: its index, the index of the first push angle, the index of the first cell, and their number.
alias Group = vec4<u32>;

@group(0) @binding(0) var<storage, read> groups: array<Group>;
@group(0) @binding(1) var<storage, read> base_points: array<vec4<real>>;
// All invocations of a group read the same elements: a software adapter reads uniforms faster.
@group(0) @binding(2) var<uniform> starts: array<StepStart, MOST_STEPS>;
@group(0) @binding(3) var<storage, read> pushes: array<vec2<real>>;
@group(0) @binding(4) var<storage, read_write> cells: array<array<vec4<u32>, 3>>;

// State of a cell less that of its base point.
struct Cell {
    numbers: array<f32, CHANNELS>,
    residual: f32,
    outcome: u32,
}

// Solves the cell at a push angle that is larger by `push` than the base point's, along `steps` of its steps.
fn solve(push: real, steps: u32) -> Cell {
    var cell = Cell();
    let tau = base_point[CONTACT].x;
    let load = base_point[CONTACT].y;
    let radius = base_point[CONTACT].z;
    let s = base_point[CONTACT].w;
    let rod = Rod(
        base_point[ROD].x,
        base_point[ROD].y,
        base_point[ROD].zw,
        base_point[POWERS_AT_REST],
        base_point[POWERS_AT_REST + 1u],
    );
    let to_pole = base_point[POSITIONS].xy;
    let position = base_point[POSITIONS].zw;
    let distance = length(to_pole);
    let w = w_at(push);
    let further = value_at(of_row(TAU_BY_W), w);
    let jacobian = jacobian_at(w);
    let longer = further / tau;
    let less = -longer * (2.0 + longer) / ((1.0 + longer) * (1.0 + longer));
    let by = vec2<real>(further, base_point[REST].w * w * (1.0 + less) + load * less);

    // The trajectory.
    let widening = -rod.taper * by.x;
    let squared = expm1_small(2.0 * widening);
    let force = radius * radius * Both(load, by.y * (1.0 + squared) + load * squared);
    let ds = radius * by.x * expm1_over_small(widening);
    var rest_at_contact = real(0.0);
    if CURVATURE || SPIRAL || POLYNOMIAL {
        rest_at_contact = rest_apart(rod, base_point[REST].xy, s, ds);
    }
    let trip = Path(
        rod,
        Both(tau, by.x),
        Both(tau, by.x) / real(steps),
        force,
        widening,
        rest_at_contact,
    );
    let apart = integrate(trip, u32(base_point[PUSH].w), steps);
    let angle = apart.bent - rest_at_contact;

    // Newton step. The residual is ln of the factor from the pole's position to the wanted one; near 1 it is the factor less 1, up to its
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
    let residual = left * (s + distance) + ROUNDING_OF_MOTION * moves + ROUNDING;
    cell.residual = f32(residual);

    // Channel values.
    let end = by + step;
    let theta = angle + base_point[BY_TAU].x * step.x + base_point[BY_LOAD].x * step.y;
    let shift = vec2<real>(
        apart.x + base_point[BY_TAU].y * step.x + base_point[BY_LOAD].y * step.y,
        apart.y + base_point[BY_TAU].z * step.x + base_point[BY_LOAD].z * step.y,
    );
    let tangent = tangents(base_point[BASE].xy, theta);
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
    cell.numbers[6] = f32(angle_of(moved_contact) - theta - value_at(of_row(RESTING_BY_W), w));
    cell.numbers[7] = f32(dot(shift, 2.0 * position + shift) / (length(position + shift) + length(position)));
    let energy = Both(base_point[BASE].w, product(Both(position.x, apart.x), Both(base_point[BASE].z, apart.bent)).y + apart.along);
    cell.numbers[8] = f32(0.5 * product(force, energy).y
        + base_point[BY_TAU].w * step.x + base_point[BY_LOAD].w * step.y);

    // Certificate.
    cell.outcome = SOLVED;
    let to_tip = base_point[REST].z - end.x;
    if det < CLEAR_OF_FOLD * length(by_tau) * length(by_load) || to_tip < CLEAR_OF_TIP * tau {
        cell.outcome = NEAR_EDGE;
    }
    let turned = max(max(abs(angle), abs(apart.bent)), abs(push));
    let largest = max(max(turned, abs(3.0 * widening)), 2.0 * max(length(moved_contact), length(moved)));
    // Rotation of the whisker at rest between any points of the base point and the cell: rho l is at most 1 or 1/(e beta tau).
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

// Writes four numbers at a time: a software adapter takes as long for one.
fn write_cell(id: u32, cell: Cell) {
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
    for (var i = own; i < BASE_POINT_QUADS; i += WORKGROUP) {
        base_point[i] = base_points[group.x * BASE_POINT_QUADS + i];
    }
    workgroupBarrier();
    let here = pushes[group.y + min(own, group.w - 1u)];
    let push = (here.x - base_point[PUSH].x) + (here.y - base_point[PUSH].y);
    // Invocations beyond the last cell take no steps.
    let has_cell = own < group.w;
    let steps = select(0u, u32(base_point[PUSH].z), has_cell);
    let cell = solve(push, steps);
    let id = group.z + own;
    if has_cell {
        write_cell(id, cell);
    }
}
