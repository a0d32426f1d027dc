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
// Colours of a scale in a map.
const STEPS = 512;

const RED_BLUE = [0x2166ac, 0x67a9cf, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xef8a62, 0xb2182b];

export const isDark = () => matchMedia('(prefers-color-scheme: dark)').matches;

// The colour of a regime, without the stripes that it may have.
export function regimeColour(code) {
    const { colour, dark } = REGIMES[code] ?? REGIMES[255];
    return isDark() ? (dark ?? colour) : colour;
}

export const stripesOf = (code) => REGIMES[code]?.stripes && css(REGIMES[code].stripes);

// The colour of cells without a value.
export const blank = () => (isDark() ? [0x2a, 0x30, 0x36] : [0xe9, 0xea, 0xeb]);

// A colour as a pixel of an image.
const pixel = ([red, green, blue]) => ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;

// True where a stripe runs through a cell: stripes run from the lower left to the upper right.
const isStripe = (x, y) => (x - y + 4096) % 8 < 3;

// The pixel of a marked cell of a colour: black or white stripes, whichever contrast more (luma by ITU-R BT.601).
export function hatched(own, x, y) {
    if (!isStripe(x, y)) return own;
    const luma = 0.299 * (own & 255) + 0.587 * ((own >> 8) & 255) + 0.114 * ((own >> 16) & 255);
    return luma > 127.5 ? 0xff000000 : 0xffffffff;
}

// The pixels of cells without a value.
export const blankPixel = () => pixel(blank());

// A function that returns the pixel of a regime, with its stripes.
export function regimePixels() {
    const pixels = Object.fromEntries(Object.keys(REGIMES).map((code) => [code, pixel(regimeColour(code))]));
    const stripes = Object.fromEntries(Object.entries(REGIMES).map(([code, own]) => [code, own.stripes ? pixel(own.stripes) : pixels[code]]));
    return (code, x, y) => (isStripe(x, y) ? stripes : pixels)[code] ?? pixels[255];
}

export const css = ([red, green, blue]) => `rgb(${red} ${green} ${blue})`;

function between(stops, at) {
    const place = Math.min(Math.max(at, 0), 1) * (stops.length - 1);
    const stop = Math.min(Math.floor(place), stops.length - 2);
    return [16, 8, 0].map((shift) => {
        const [from, to] = [stops[stop], stops[stop + 1]].map((colour) => (colour >> shift) & 255);
        return Math.round(from + (place - stop) * (to - from));
    });
}

// The scale of a channel: which fraction of its colours a value has, and the colours; null if no value has a colour. `kind` is `auto`, `linear`
// or `log`; a range `[from, to]` by hand may leave out an end, and is ignored if it does not grow or is not above 0 on a logarithmic scale.
export function scaleOf(values, kind, range, isLoad) {
    const sorted = values.filter(Number.isFinite).sort();
    if (!sorted.length) return null;
    const quantile = (part, from = 0) => sorted[Math.min(from + Math.floor(part * (sorted.length - from)), sorted.length - 1)];
    const positive = sorted.findIndex((value) => value > 0);
    const low = positive < 0 ? NaN : quantile(0.01, positive);
    const greatest = sorted[sorted.length - 1];
    const isLog = kind === 'log' || (kind === 'auto' && isLoad && sorted[0] >= 0 && greatest / low > 100 && range.every((end) => end === null || end > 0));
    let [from, to] = isLog ? [low, greatest] : [sorted[0], greatest];
    const isDiverging = !isLog && from < 0 && to > 0;
    if (isDiverging) [from, to] = [-Math.max(-from, to), Math.max(-from, to)];
    const fits = ([low, high]) => high > low && (!isLog || low > 0);
    const wanted = [range[0] ?? from, range[1] ?? to];
    const isIgnored = range.some((end) => end !== null) && !fits(wanted);
    if (!isIgnored) [from, to] = wanted;
    if (!fits([from, to])) return null;
    const stops = isDiverging ? RED_BLUE : VIRIDIS;
    const part = isLog ? (value) => Math.log(value / from) / Math.log(to / from) : (value) => (value - from) / (to - from);
    const colour = (at) => between(stops, at);
    const steps = Uint32Array.from({ length: STEPS }, (_, i) => pixel(colour(i / (STEPS - 1))));
    const none = blankPixel();
    const step = (at) => Math.round(Math.min(Math.max(at, 0), 1) * (STEPS - 1));
    return { from, to, isLog, isIgnored, part, colour, pixel: (value) => (Number.isFinite(value) ? steps[step(part(value))] : none) };
}
