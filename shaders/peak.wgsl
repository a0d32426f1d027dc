// What the device could do at best: nothing but multiplications with additions, in chains side by side.

const ROUNDS = 64u;

@group(0) @binding(0) var<storage, read_write> ends: array<real>;

// Eight in a row, so that the loop itself does not count.
fn chain(x: vec4<real>, factor: vec4<real>, term: vec4<real>) -> vec4<real> {
    let two = (x * factor + term) * factor + term;
    let four = (two * factor + term) * factor + term;
    let six = (four * factor + term) * factor + term;
    return (six * factor + term) * factor + term;
}

@compute @workgroup_size(WORKGROUP)
fn peak(@builtin(global_invocation_id) id: vec3<u32>) {
    let factor = vec4<real>(0.75);
    let term = vec4<real>(ends[id.x]);
    var a = term;
    var b = term + 1.0;
    var c = term + 2.0;
    var d = term + 3.0;
    for (var round = 0u; round < ROUNDS; round++) {
        a = chain(a, factor, term);
        b = chain(b, factor, term);
        c = chain(c, factor, term);
        d = chain(d, factor, term);
    }
    let sum = a + b + c + d;
    ends[id.x] = sum.x + sum.y + sum.z + sum.w;
}
