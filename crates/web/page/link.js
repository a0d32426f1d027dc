// Links: the state of the page as the part of an address after `#`.

import { COURSE, state } from './state.js';
import { CHANNELS, UNITS } from './text.js';

const STORED = ['whisker', 'pinned', 'view', 'channel', 'scale', 'range', 'pointer', 'points', 'whisk', 'units'];

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
            throw new RangeError('it holds more than 4 MiB');
        }
        parts.push(part.value);
    }
    return new Uint8Array(await new Blob(parts).arrayBuffer());
}

// The state as the part of a link after `#`.
export async function link() {
    const stored = Object.fromEntries(STORED.map((part) => [part, state[part]]));
    const text = new TextEncoder().encode(JSON.stringify(stored));
    const packed = text.length > MOST_BYTES ? [] : await through(new CompressionStream('deflate-raw'), text);
    if (!packed.length) throw new RangeError('the scene is too large for a link');
    const characters = Array.from(packed, (byte) => String.fromCharCode(byte)).join('');
    return btoa(characters).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '');
}

const isRange = (ends) => Array.isArray(ends) && ends.length === 2 && ends.every(Number.isFinite) && ends[0] <= ends[1];

const isWhisker = (own) =>
    typeof own?.text === 'string' && typeof own.origin === 'string' && own.values && Object.values(own.values).every(Number.isFinite) && ['string', 'undefined'].includes(typeof own.row);

// The state in a link, with the names of its parts that are not valid, which are left out.
export async function fromLink(hash) {
    const packed = Uint8Array.from(atob(hash.replace(/-/g, '+').replace(/_/g, '/')), (character) => character.charCodeAt(0));
    const stored = JSON.parse(new TextDecoder().decode(await through(new DecompressionStream('deflate-raw'), packed)));
    const isValid = {
        whisker: isWhisker,
        pinned: (own) => own === null || isWhisker(own),
        view: (own) => own === null || (isRange(own?.push) && isRange(own?.distance)),
        channel: (own) => own === null || Object.hasOwn(CHANNELS, own),
        scale: (own) => ['auto', 'linear', 'log'].includes(own),
        range: (own) => Array.isArray(own) && own.length === 2 && own.every((end) => end === null || Number.isFinite(end)),
        pointer: (own) => own === null || (Number.isFinite(own?.push) && Number.isFinite(own?.distance)),
        whisk: (own) => Object.entries(COURSE).every(([name, most]) => own?.[name] > 0 && own[name] <= most),
        points: (own) => own === null || (typeof own?.name === 'string' && typeof own.csv === 'string'),
        units: (own) => Object.keys(state.units).every((quantity) => Object.hasOwn(UNITS[quantity], own?.[quantity])),
    };
    const given = STORED.filter((part) => part in stored);
    const [good, bad] = [true, false].map((is) => given.filter((part) => Boolean(isValid[part](stored[part])) === is));
    return { parts: Object.fromEntries(good.map((part) => [part, stored[part]])), bad };
}
