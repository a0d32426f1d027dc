// State of the page: the whisker, what is shown of it, and the place of the pointer. Listeners are called when a part changes.

// `whisker` is `{ text, origin, values, row }`: a valid scene, the values that replace those in it, and the name of a whisker of its table.
export const state = {
    whisker: null, pinned: null, view: null, channel: null, scale: 'auto', range: [null, null], pointer: null, points: null,
    whisk: { amplitude_deg: 25, frequency_hz: 10 },
    units: { length: 'mm', angle: '\u00b0', force: '\u00b5N', moment: 'nN m', energy: 'nJ', time: 'ms' },
};

// The greatest values of a course of whisking.
export const COURSE = { amplitude_deg: 180, frequency_hz: 1000 };

// Responses of the solver; `scene` is `description` in the solver. `whole` is the view of the whole map.
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
    for (const { parts: own, f } of listeners) if (own.some((part) => part in parts)) f();
}

// A whisker with other values. A taper and a radius at the tip are one number.
export function withValues(whisker, values) {
    const all = { ...whisker.values };
    for (const [name, value] of Object.entries(values)) {
        if (name === 'taper') delete all.tip_radius_um;
        if (name === 'tip_radius_um') delete all.taper;
        delete all[name];
        all[name] = value;
    }
    return { ...whisker, values: all };
}

// A request to the solver for a whisker.
export const request = (task, { text, origin, values, row } = state.whisker) => ({ text, origin, values: Object.entries(values), whisker: row, task });

// The narrowest views: in degrees, and as a part of the greatest distance.
const NARROW_DEG = 1e-4;
const NARROW = 1e-6;

const within = (value, [least, most]) => Math.min(Math.max(value, least), most);

// Push angles and distances of which the solver makes maps.
function limits() {
    const [nearest, farthest] = known.scene.distances_mm;
    return { push: [-180, 180], distance: [nearest * 1.0001, Math.min(farthest, 1.5 * known.whole.distance[1])] };
}

// The part of a view within the limits; null if it is too narrow. A map of one push angle or one distance stays one.
export function fitted(view) {
    const { whole } = known;
    const part = (name) => (whole[name][0] === whole[name][1] ? whole[name] : view[name].map((end) => within(end, limits()[name])));
    const [push, distance] = [part('push'), part('distance')];
    const isWide = ([from, to], least, own) => own[0] === own[1] || to - from > least;
    return isWide(push, NARROW_DEG, whole.push) && isWide(distance, NARROW * whole.distance[1], whole.distance) ? { push, distance } : null;
}

// View and pointer of the scene that is known now, as near to the given ones as it allows.
export function placed(view, pointer) {
    const single = ([from, to], least) => (to - from > least ? [from, to] : [from, from]);
    const { push_angle_deg: push, distance_mm: distance } = known.scene;
    known.whole = { push: single(push, NARROW_DEG), distance: single(distance, NARROW * distance[1]) };
    const middle = ([from, to]) => Number((from + 0.56 * (to - from)).toPrecision(from < to ? 3 : 17));
    const at = pointer ?? { push: middle(push), distance: middle(distance) };
    const clamped = (name) => within(at[name], known.whole[name][0] === known.whole[name][1] ? known.whole[name] : limits()[name]);
    return { view: (view && fitted(view)) ?? known.whole, pointer: { push: clamped('push'), distance: clamped('distance') } };
}
