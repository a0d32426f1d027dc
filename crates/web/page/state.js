// State of the page: the whisker, what is shown of it, and the place of the pointer. Listeners are called when a part changes.

// `whisker` is `{ text, origin, values }`: the scene, and the values that replace those in it.
export const state = {
    whisker: null,
    pinned: null,
    view: null,
    channel: null,
    scale: 'auto',
    range: [null, null],
    pointer: null,
    points: null,
    whisk: { amplitude_deg: 25, frequency_hz: 10 },
};

// Responses of the solver; `scene` is `description` in the solver.
export const known = { scene: null, whole: null, map: null, curve: null, pinnedCurve: null, state: null };

// The title of a parameter.
export const title = (name) => known.scene.parameters.find((own) => own.name === name)?.title ?? name;

const listeners = [];

// Calls `f` after each change of one of these parts of the state.
export function on(parts, f) {
    listeners.push({ parts, f });
}

// Changes parts of the state.
export function change(parts) {
    Object.assign(state, parts);
    for (const listener of listeners) {
        if (listener.parts.some((part) => part in parts)) listener.f();
    }
}

// Replaces values of the whisker. A taper and a radius at the tip are one number.
export function changeValues(values) {
    const all = { ...state.whisker.values };
    for (const [name, value] of Object.entries(values)) {
        if (name === 'taper') delete all.tip_radius_um;
        if (name === 'tip_radius_um') delete all.taper;
        delete all[name];
        all[name] = value;
    }
    change({ whisker: { ...state.whisker, values: all } });
}

// A request to the solver for a whisker.
export const request = (task, { text, origin, values } = state.whisker) => ({ text, origin, values: Object.entries(values), task });

const STORED = ['whisker', 'pinned', 'view', 'channel', 'scale', 'range', 'pointer', 'points', 'whisk'];

// Most bytes of the state in a link. A short link can unpack to a thousand times its length.
const MOST_BYTES = 4 << 20;

async function through(stream, bytes) {
    const reader = new Blob([bytes]).stream().pipeThrough(stream).getReader();
    const parts = [];
    let size = 0;
    for (let part = await reader.read(); !part.done; part = await reader.read()) {
        size += part.value.length;
        if (size > MOST_BYTES) {
            await reader.cancel();
            throw new RangeError('the link holds more than 4 MiB');
        }
        parts.push(part.value);
    }
    return new Uint8Array(await new Blob(parts).arrayBuffer());
}

// The state as the part of a link after `#`.
export async function link() {
    const stored = Object.fromEntries(STORED.map((part) => [part, state[part]]));
    const packed = await through(new CompressionStream('deflate-raw'), new TextEncoder().encode(JSON.stringify(stored)));
    return btoa(String.fromCharCode(...packed)).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '');
}

const isRange = (ends) => Array.isArray(ends) && ends.length === 2 && ends.every(Number.isFinite) && ends[0] < ends[1];

const isWhisker = (own) =>
    typeof own?.text === 'string' && typeof own.origin === 'string' && own.values && Object.values(own.values).every(Number.isFinite);

// A course of whisking that the solver accepts.
export const isCourse = (own) =>
    own?.amplitude_deg > 0 && own.amplitude_deg <= 180 && own.frequency_hz > 0 && own.frequency_hz <= 1000;

// The state in a link; what is no valid part of it is left out.
export async function fromLink(hash) {
    const packed = Uint8Array.from(atob(hash.replace(/-/g, '+').replace(/_/g, '/')), (character) => character.charCodeAt(0));
    const stored = JSON.parse(new TextDecoder().decode(await through(new DecompressionStream('deflate-raw'), packed)));
    const isValid = {
        whisker: isWhisker,
        pinned: isWhisker,
        view: (own) => isRange(own?.push) && isRange(own?.distance),
        channel: (own) => own === null || typeof own === 'string',
        scale: (own) => ['auto', 'linear', 'log'].includes(own),
        range: (own) => Array.isArray(own) && own.length === 2 && own.every((end) => end === null || Number.isFinite(end)),
        pointer: (own) => Number.isFinite(own?.push) && Number.isFinite(own?.distance),
        whisk: isCourse,
        points: (own) => typeof own?.name === 'string' && typeof own.csv === 'string',
    };
    return Object.fromEntries(STORED.filter((part) => isValid[part](stored[part])).map((part) => [part, stored[part]]));
}
