// What the device could do at best: nothing but multiplications with additions, in chains side by side.

const ROUNDS = 512u;

@group(0) @binding(0) var<storage, read_write> ends: array<real>;

@compute @workgroup_size(WORKGROUP)
fn peak(@builtin(global_invocation_id) id: vec3<u32>) {
    let factor = vec4<real>(0.75);
    let term = vec4<real>(ends[id.x]);
    var a = term;
    var b = term + 1.0;
    var c = term + 2.0;
    var d = term + 3.0;
    for (var round = 0u; round < ROUNDS; round++) {
        a = a * factor + term;
        b = b * factor + term;
        c = c * factor + term;
        d = d * factor + term;
    }
    let sum = a + b + c + d;
    ends[id.x] = sum.x + sum.y + sum.z + sum.w;
}
