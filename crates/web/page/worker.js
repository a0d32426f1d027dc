// Worker: computes the response to one request at a time with the solver. Errors of the solver end the worker, so handlers are not
// asynchronous: an error of a promise would not reach the page.

let solver;

function start(module) {
    solver = new WebAssembly.Instance(module, {}).exports;
    postMessage({ ready: true });
}

function respond(id, request) {
    const begun = performance.now();
    const bytes = new TextEncoder().encode(JSON.stringify(request));
    // The memory may move when it grows.
    const place = solver.input(bytes.length);
    new Uint8Array(solver.memory.buffer, place, bytes.length).set(bytes);
    solver.respond();
    const { buffer } = solver.memory;
    const text = new TextDecoder().decode(new Uint8Array(buffer, solver.text(), solver.text_length()));
    const numbers = new Float32Array(buffer, solver.numbers(), solver.numbers_length()).slice();
    const ms = performance.now() - begun;
    postMessage({ id, response: JSON.parse(text), numbers, ms }, [numbers.buffer]);
}

addEventListener('message', ({ data }) => data.module ? start(data.module) : respond(data.id, data.request));
