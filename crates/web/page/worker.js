// Worker: computes the response to one request at a time with the solver.

let solver;

addEventListener('message', async ({ data }) => {
    if (data.module) {
        solver = (await WebAssembly.instantiate(data.module, {})).exports;
        postMessage({ ready: true });
        return;
    }
    const begun = performance.now();
    const request = new TextEncoder().encode(JSON.stringify(data.request));
    // The memory may move when it grows.
    const place = solver.input(request.length);
    new Uint8Array(solver.memory.buffer, place, request.length).set(request);
    solver.respond();
    const { buffer } = solver.memory;
    const text = new TextDecoder().decode(new Uint8Array(buffer, solver.text(), solver.text_length()));
    const numbers = new Float32Array(buffer, solver.numbers(), solver.numbers_length()).slice();
    const ms = performance.now() - begun;
    postMessage({ id: data.id, response: JSON.parse(text), numbers, ms }, [numbers.buffer]);
});
