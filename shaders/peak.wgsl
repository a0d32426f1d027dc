// Peak rate of the device: only multiplications with additions, in independent accumulators.

const ROUNDS = 64u;

@group(0) @binding(0) var<storage, read_write> ends: array<real>;

// Eight operations in a row, so that the cost of the loop is negligible.
fn chain(x: vec4<real>, factor: vec4<real>, term: vec4<real>) -> vec4<real> {
    let two = fma(fma(x, factor, term), factor, term);
    let four = fma(fma(two, factor, term), factor, term);
    let six = fma(fma(four, factor, term), factor, term);
    return fma(fma(six, factor, term), factor, term);
}

fn sum_of(x: vec4<real>) -> real {
    return x.x + x.y + x.z + x.w;
}

@compute @workgroup_size(WORKGROUP)
fn peak_of_8(@builtin(global_invocation_id) id: vec3<u32>) {
    let factor = vec4<real>(0.75);
    let term = vec4<real>(ends[id.x]);
    var a = term;
    var b = term + 1.0;
    for (var round = 0u; round < ROUNDS; round++) {
        a = chain(a, factor, term);
        b = chain(b, factor, term);
    }
    ends[id.x] = sum_of(a + b);
}

@compute @workgroup_size(WORKGROUP)
fn peak_of_16(@builtin(global_invocation_id) id: vec3<u32>) {
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
    ends[id.x] = sum_of(a + b + c + d);
}
