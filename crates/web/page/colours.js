// Colours of maps: the regimes, and scales that people with any colour vision can read.

// Colours of the regimes by code, as in the pictures of the program; `dark` replaces a colour on dark ground. They differ in lightness.
const REGIMES = {
    0: { colour: [0xf2, 0xf3, 0xf4], dark: [0x2a, 0x30, 0x36] },
    1: { colour: [0x83, 0xc4, 0xa4] },
    2: { colour: [0xc8, 0x60, 0x2a] },
    3: { colour: [0x22, 0x47, 0x8a], dark: [0x3a, 0x63, 0xb0] },
    4: { colour: [0xd3, 0xec, 0xdf], stripes: [0x83, 0xc4, 0xa4], dark: [0x3f, 0x5e, 0x50] },
    255: { colour: [0xf0, 0xe4, 0x42] },
};

const VIRIDIS = [0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b, 0xfde725];
const RED_BLUE = [0x2166ac, 0x67a9cf, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xef8a62, 0xb2182b];

export const isDark = () => matchMedia('(prefers-color-scheme: dark)').matches;

// The colour of a regime in a pixel: stripes run from the lower left to the upper right.
export function regimeColour(code, x = 0, y = 0) {
    const { colour, dark, stripes } = REGIMES[code] ?? REGIMES[255];
    if (stripes && (x + y) % 8 < 3) return stripes;
    return isDark() ? (dark ?? colour) : colour;
}

export const blank = () => (isDark() ? [0x2a, 0x30, 0x36] : [0xe9, 0xea, 0xeb]);

export const css = ([red, green, blue]) => `rgb(${red} ${green} ${blue})`;

function between(stops, at) {
    const place = Math.min(Math.max(at, 0), 1) * (stops.length - 1);
    const stop = Math.min(Math.floor(place), stops.length - 2);
    return [16, 8, 0].map((shift) => {
        const [from, to] = [stops[stop], stops[stop + 1]].map((colour) => (colour >> shift) & 255);
        return Math.round(from + (place - stop) * (to - from));
    });
}

// The scale of a channel: which fraction of its colours a value has, and the colours. `kind` is `auto`, `linear` or `log`; a range
// `[from, to]` by hand may leave out an end.
export function scaleOf(values, kind, range, isLoad) {
    const sorted = values.filter(Number.isFinite).sort();
    if (!sorted.length) return null;
    const quantile = (part, from = 0) => sorted[Math.min(from + Math.floor(part * (sorted.length - from)), sorted.length - 1)];
    const positive = sorted.findIndex((value) => value > 0);
    const low = positive < 0 ? NaN : quantile(0.01, positive);
    const greatest = sorted[sorted.length - 1];
    const isLog = kind === 'log' || (kind === 'auto' && isLoad && sorted[0] >= 0 && greatest / low > 100);
    let [from, to] = isLog ? [low, greatest] : [sorted[0], greatest];
    const isDiverging = !isLog && from < 0 && to > 0;
    if (isDiverging) [from, to] = [-Math.max(-from, to), Math.max(-from, to)];
    [from, to] = [range[0] ?? from, range[1] ?? to];
    if (!(to > from) || (isLog && !(from > 0))) return null;
    const stops = isDiverging ? RED_BLUE : VIRIDIS;
    const part = isLog ? (value) => Math.log(value / from) / Math.log(to / from) : (value) => (value - from) / (to - from);
    return { from, to, isLog, part, colour: (at) => between(stops, at) };
}
