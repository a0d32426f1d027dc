// Solvers: workers that respond to requests. Of each kind of request only the newest counts.

import { find } from './dom.js';

// A request that runs for longer than this, in ms, is given up when a newer one of its kind comes.
const PATIENCE = 250;

// The compiled solver, from the page's own text.
export async function compiled() {
    const packed = Uint8Array.from(atob(find('wasm').textContent), (character) => character.charCodeAt(0));
    const bytes = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
    return WebAssembly.compile(await new Response(bytes).arrayBuffer());
}

// Error of a request that a newer one has replaced, or that was stopped.
export class Superseded extends Error {}

export class Solver {
    constructor(module, onBusy) {
        Object.assign(this, { module, onBusy, waiting: new Map(), running: null, count: 0 });
        this.url = URL.createObjectURL(new Blob([find('worker').textContent], { type: 'text/javascript' }));
        this.start();
    }

    start() {
        const worker = new Worker(this.url);
        this.worker = worker;
        this.isReady = false;
        // A message of an ended worker may still arrive.
        worker.addEventListener('message', ({ data }) => worker === this.worker && this.receive(data));
        worker.addEventListener('error', (event) => {
            event.preventDefault();
            if (worker === this.worker) this.broke();
        });
        worker.postMessage({ module: this.module });
    }

    // Computes the task of a request. The promise rejects with the message of the solver, or with `Superseded`.
    compute(kind, request) {
        return new Promise((resolve, reject) => {
            this.waiting.get(kind)?.reject(new Superseded('stopped'));
            this.waiting.set(kind, { kind, request, resolve, reject, id: ++this.count });
            if (!this.worker) this.start();
            const { running } = this;
            if (running?.kind === kind && performance.now() - running.begun > PATIENCE) {
                this.fail(new Superseded('stopped'));
            }
            this.next();
        });
    }

    next() {
        const [first] = this.waiting.values();
        this.onBusy?.(this.running ?? first ?? null);
        if (this.running || !this.isReady || !first) return;
        this.waiting.delete(first.kind);
        this.running = Object.assign(first, { begun: performance.now() });
        this.worker.postMessage({ id: first.id, request: first.request });
    }

    receive({ ready, id, response, numbers, ms }) {
        if (ready) {
            this.isReady = true;
        } else if (id === this.running?.id) {
            const { resolve, reject } = this.running;
            this.running = null;
            if (response.error) reject(new Error(response.error));
            else resolve({ ...response, numbers, ms, id });
        }
        this.next();
    }

    // Starts a new worker after an error of this one, unless it could not even start.
    broke() {
        if (this.isReady) {
            this.fail(new Error('the solver has failed; the last valid result stays'));
            return;
        }
        this.worker = null;
        for (const { reject } of this.waiting.values()) reject(new Error('the solver cannot start in this browser'));
        this.waiting.clear();
        this.onBusy?.(null);
    }

    // Ends the running request with an error, and starts a new worker.
    fail(error) {
        this.worker?.terminate();
        this.running?.reject(error);
        this.running = null;
        this.start();
    }

    // Gives up all requests.
    stop() {
        for (const { reject } of this.waiting.values()) reject(new Superseded('stopped'));
        this.waiting.clear();
        this.fail(new Superseded('stopped'));
        this.next();
    }
}
