// For tests only: the pieces' numbers laid bare. One invocation per case.

@group(0) @binding(0) var<storage, read> cases: array<real>;
@group(0) @binding(1) var<storage, read_write> answers: array<real>;

// force, twice_bend, taper, h, rho, gradient, arclength, then the state, then the steps; answers the state after them.
@compute @workgroup_size(1)
fn probe_steps(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = 19u * id.x;
    let system = System(cases[i], cases[i + 1u], array<real, 2>(), Material(cases[i + 5u]));
    let h = cases[i + 3u];
    let rho = cases[i + 4u];
    let y = integrate(
        system,
        gains(cases[i + 2u], h),
        Section(rho, 1.0 / (rho * rho * rho), cases[i + 6u]),
        h,
        u32(cases[i + 18u]),
        State(
            vec2<real>(cases[i + 7u], cases[i + 8u]),
            vec4<real>(cases[i + 9u], cases[i + 10u], cases[i + 11u], cases[i + 12u]),
            vec3<real>(cases[i + 13u], cases[i + 14u], cases[i + 15u]),
            vec2<real>(cases[i + 16u], cases[i + 17u]),
        ),
    );
    let o = 11u * id.x;
    answers[o] = y.rest.x;
    answers[o + 1u] = y.rest.y;
    answers[o + 2u] = y.rod.x;
    answers[o + 3u] = y.rod.y;
    answers[o + 4u] = y.rod.z;
    answers[o + 5u] = y.rod.w;
    answers[o + 6u] = y.by_force.x;
    answers[o + 7u] = y.by_force.y;
    answers[o + 8u] = y.by_force.z;
    answers[o + 9u] = y.by_arclength.x;
    answers[o + 10u] = y.by_arclength.y;
}

// taper, bend, slope, tau, load; answers radius, arclength, force, cos, sin.
@compute @workgroup_size(1)
fn probe_start(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = 5u * id.x;
    let rod = Rod(cases[i], cases[i + 1u], cases[i + 2u], 0.0, 0.0, 0.0, array<real, 2>());
    let start = start_at(rod, cases[i + 3u], cases[i + 4u]);
    answers[i] = start.radius;
    answers[i + 1u] = start.arclength;
    answers[i + 2u] = start.force;
    answers[i + 3u] = start.cos;
    answers[i + 4u] = start.sin;
}
