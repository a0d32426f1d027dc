// Cells of rows, one per invocation. A row comes as Chebyshev expansions of the differences from its end, divided by the difference of their
// argument: f(x) = f(end) - left q(end - left), with left = end - x. The push angle that is left to the end is inverted for `left`.

// Run of cells of one row: its first cell, its first push angle, its first coefficients, and their number.
alias Head = vec4<u32>;

struct Row {
    // push angle at the end as two numbers
    end: vec2<real>,
    // argument of the expansions at the end
    place: real,
    distance: real,
    // push angle left to the end, as a parabola in `left`
    slope: real,
    curvature: real,
    residual: real,
    // tau at the end less that of the tip, its difference within which a contact is at the tip, and the radius there
    to_tip: real,
    tip_tie: real,
    tip_radius: real,
}

// Twelve functions of a row: push angle, tau and load, and the channels. The last two groups are 0 without a channel that is wanted.
struct Functions {
    state: vec4<real>,
    middle: vec4<real>,
    last: vec4<real>,
}

@group(0) @binding(0) var<storage, read> heads: array<Head>;
@group(0) @binding(1) var<storage, read> rows: array<Row>;
// For each run, the values at the end, then the coefficients of the quotients, in the groups of functions that are wanted.
@group(0) @binding(2) var<storage, read> terms: array<vec4<real>>;
// Magnitudes of push angles as two numbers.
@group(0) @binding(3) var<storage, read> pushes: array<vec2<real>>;
// Planes: residuals or outcomes, channels, points.
@group(0) @binding(4) var<storage, read_write> planes: array<f32>;

fn is_wanted(channels: u32) -> bool {
    return (CHANNELS_WANTED & channels) != 0u;
}

// Number of planes.
fn plane_count() -> u32 {
    return 1u + countOneBits(CHANNELS_WANTED) + select(0u, 4u, HAS_POINTS);
}

// Place in `terms` of the first group of functions of the coefficients `index`.
fn place_of(index: u32) -> u32 {
    return index * (1u + u32(is_wanted(MIDDLE_CHANNELS)) + u32(is_wanted(LAST_CHANNELS)));
}

// The coefficients `index` of all functions.
fn terms_at(index: u32) -> Functions {
    var place = place_of(index);
    var found = Functions();
    found.state = terms[place];
    if is_wanted(MIDDLE_CHANNELS) {
        place++;
        found.middle = terms[place];
    }
    if is_wanted(LAST_CHANNELS) {
        place++;
        found.last = terms[place];
    }
    return found;
}

struct Cell {
    numbers: array<f32, CHANNELS>,
    // tau and load
    point: vec2<real>,
    // bound on the residual, or the outcome
    residual: f32,
}

// Run of the cell `id`.
fn run_of(id: u32) -> u32 {
    var first = 0u;
    var end = arrayLength(&heads);
    while end - first > 1u {
        let middle = (first + end) / 2u;
        if heads[middle].x <= id {
            first = middle;
        } else {
            end = middle;
        }
    }
    return first;
}

// Taylor coefficients around `x` of the push angle's quotient.
fn push_series(first: u32, count: u32, x: real) -> vec3<real> {
    let y = 2.0 * x - 1.0;
    var later = vec3<real>();
    var latest = vec3<real>();
    for (var power = count - 1u; power > 0u; power--) {
        let sum = 2.0 * (y * later + 2.0 * vec3<real>(real(0.0), later.x, later.y)) - latest
            + vec3<real>(terms[place_of(first + power)].x, real(0.0), real(0.0));
        latest = later;
        later = sum;
    }
    return y * later + 2.0 * vec3<real>(real(0.0), later.x, later.y) - latest
        + vec3<real>(terms[place_of(first)].x, real(0.0), real(0.0));
}

// All quotients at `x`.
fn quotients(first: u32, count: u32, x: real) -> Functions {
    let y = 2.0 * x - 1.0;
    var later = Functions();
    var latest = Functions();
    for (var power = count; power > 0u; power--) {
        let at_power = terms_at(first + power - 1u);
        let factor = select(2.0 * y, y, power == 1u);
        var sum = Functions();
        sum.state = factor * later.state + (at_power.state - latest.state);
        if is_wanted(MIDDLE_CHANNELS) {
            sum.middle = factor * later.middle + (at_power.middle - latest.middle);
        }
        if is_wanted(LAST_CHANNELS) {
            sum.last = factor * later.last + (at_power.last - latest.last);
        }
        latest = later;
        later = sum;
    }
    return later;
}

// Root of `slope d + half d^2 = rest` next to 0, or the vertex of the parabola where there is none.
fn quadratic_root(rest: real, slope: real, half: real) -> real {
    let discriminant = slope * slope + 4.0 * half * rest;
    return 2.0 * rest / (slope + sqrt(max(discriminant, real(0.0))) + TINY);
}

// Steps from the parabola through both ends of the row: each one cubes the error.
const STEPS = 4;

// Solves the cell of `row` at `push` before the end of the row, whose quotients have `count` coefficients from `first` on.
fn solve(row: Row, push: vec2<real>, first: u32, count: u32) -> Cell {
    var cell = Cell();
    let rest = (row.end.x - push.x) + (row.end.y - push.y);
    let to_end = max(rest, real(0.0));
    var left = quadratic_root(to_end, row.slope, row.curvature);
    for (var step = 0; step < STEPS; step++) {
        // In `left`, odd powers have the other sign.
        let q = push_series(first, count, row.place - left);
        left += quadratic_root(to_end - left * q.x, q.x - left * q.y, left * q.z - q.y);
    }
    let quotient = quotients(first, count, row.place - left);
    let end = terms_at(first - 1u);
    let state = end.state - left * quotient.state;
    let middle = end.middle - left * quotient.middle;
    let last = end.last - left * quotient.last;
    cell.numbers = array<f32, CHANNELS>(
        f32(state.w), f32(middle.x), f32(middle.y), f32(middle.z), f32(middle.w),
        f32(last.x), f32(last.y), f32(last.z), f32(last.w),
    );
    cell.point = state.yz;
    let missed = abs(left * quotient.state.x - rest);
    let exact = row.residual + missed * row.distance;
    let residual = exact + ROUNDING;
    let clear = abs(row.to_tip - left * quotient.state.y) - row.tip_tie - CLEAR_OF_TIP * state.y;
    cell.residual = f32(residual);
    if !(clear * row.tip_radius > exact) {
        cell.residual = NEAR_EDGE;
    }
    // The host refuses numbers that are not finite.
    if !(residual <= GOAL && left >= -OUTSIDE && left <= row.place + OUTSIDE) {
        cell.residual = MISSED;
    }
    return cell;
}

fn write_cell(id: u32, cell: Cell) {
    let stride = arrayLength(&planes) / plane_count();
    planes[id] = cell.residual;
    var plane = stride + id;
    for (var i = 0u; i < CHANNELS; i++) {
        if is_wanted(1u << i) {
            planes[plane] = cell.numbers[i];
            plane += stride;
        }
    }
    if HAS_POINTS {
        let rounded = vec2<f32>(cell.point);
        let rest = vec2<f32>(cell.point - vec2<real>(rounded));
        planes[plane] = rounded.x;
        planes[plane + stride] = rest.x;
        planes[plane + 2u * stride] = rounded.y;
        planes[plane + 3u * stride] = rest.y;
    }
}

@compute @workgroup_size(WORKGROUP)
fn solve_cells(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let id = invocation.x;
    if id >= arrayLength(&planes) / plane_count() {
        return;
    }
    let run = run_of(id);
    let head = heads[run];
    let push = pushes[head.y + id - head.x];
    let cell = solve(rows[run], push, head.z + 1u, head.w - 1u);
    write_cell(id, cell);
}
