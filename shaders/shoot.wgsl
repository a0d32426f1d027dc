// Newton's method, one shot per invocation; the twin of `src/bench/solver.rs`.

struct Shot {
    tau: real,
    load: real,
    pole_x: real,
    pole_y: real,
    rod: u32,
    steps: u32,
}

struct Hit {
    tau: real,
    load: real,
    residual: real,
    steps: u32,
    outcome: u32,
}

@group(0) @binding(0) var<storage, read> rods: array<Rod>;
@group(0) @binding(1) var<storage, read> shots: array<Shot>;
@group(0) @binding(2) var<storage, read_write> hits: array<Hit>;

fn solve(rod: Rod, shot: Shot) -> Hit {
    let wanted = vec2<real>(shot.pole_x, shot.pole_y);
    var hit = Hit(shot.tau, shot.load, 0.0, 0u, STALLED);
    for (var round = 0u; round <= MOST_STEPS; round++) {
        let start = start_at(rod, hit.tau, hit.load);
        let map = shoot_once(rod, hit.tau, start, shot.steps);
        hit.residual = length(map.pole - wanted);
        if !is_finite(hit.residual) {
            hit.outcome = NOT_FINITE;
            break;
        }
        if hit.residual <= TOLERANCE {
            hit.outcome = CONVERGED;
        }
        if round < MOST_STEPS {
            let step = newton_step(map, wanted, start.arclength, hit.load);
            hit.tau += step.x;
            hit.load += step.y;
            hit.steps += 1u;
        }
        if hit.outcome == CONVERGED {
            break;
        }
    }
    return hit;
}

@compute @workgroup_size(WORKGROUP)
fn shoot(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&hits) {
        let shot = shots[id.x];
        hits[id.x] = solve(rods[shot.rod], shot);
    }
}
