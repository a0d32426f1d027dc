// Computation of what is shown: maps, curves and states. Where a map takes long, drafts are shown while something moves.

import { debounced, find } from './dom.js';
import { Solver, Superseded, compiled } from './solver.js';
import { change, known, on, placed, request, state } from './state.js';

// Cells of a finished map, and of a draft, along each axis. A draft may differ this much from the exact boundary, in degrees.
const CELLS = 256;
const DRAFT = 64;
const DRAFT_DEG = 0.01;

// A map after one that took longer than this, in ms, begins with a draft.
const QUICK_MS = 100;

// Distances of a detachment curve, and points of a branch.
const CURVE = 160;
const BRANCH = 60;

// A row's sensitivities and course are computed when the pointer has rested for this long, in ms, and a map is finished when nothing moves.
const REST = 150;
const QUIET = 80;

let scenes, maps, traces, rows, courses, shown;
let isQuick = false;

// Starts the solvers. `show` has a function for each result, and for errors.
export async function start(show) {
    shown = show;
    const module = await compiled();
    const busy = {};
    const onBusy = (name) => (running) => {
        busy[name] = running;
        find('stop').hidden = !Object.values(busy).some(Boolean);
    };
    [scenes, maps, traces, rows, courses] = ['scenes', 'maps', 'traces', 'rows', 'courses'].map((name) => new Solver(module, onBusy(name)));
    find('stop').addEventListener('click', stop);
    on(['whisker', 'view', 'channel'], () => (drawn.map = computeMap()));
    on(['whisker', 'view'], () => (drawn.curve = computeCurve()));
    on(['whisker', 'pointer', 'pinned'], computeState);
    on(['pinned', 'view'], computePinned);
    on(['whisker', 'points'], comparePoints);
    on(['whisker', 'pointer'], debounced(REST, computeRow));
    on(['whisk'], computeWhisk);
}

function stop() {
    for (const solver of [scenes, maps, traces, rows, courses]) solver.stop();
    shown.error('stopped');
}

let adopted = Promise.resolve();
const newest = new Map();

// Changes the whisker, and other parts of the state, if the solver accepts its scene; otherwise the last one stays. `whiskerOf` makes it from
// the present one. Resolves to the message of an error, empty without one, or to null if a newer whisker of its kind replaces it. The
// kind `scene` replaces all.
export function adopt(kind, whiskerOf, parts = {}) {
    const own = {};
    if (kind === 'scene') newest.clear();
    newest.set(kind, own);
    const next = adopted.then(async () => {
        if (newest.get(kind) !== own) return null;
        const whisker = whiskerOf(state.whisker);
        const [scene, message] = await described(whisker);
        if (!scene) return message;
        known.scene = scene;
        const { view, pointer } = { ...state, ...parts };
        const places = Object.entries(placed(view, pointer));
        const moved = places.filter(([part, own]) => part in parts || JSON.stringify(own) !== JSON.stringify(state[part]));
        change({ ...parts, ...Object.fromEntries(moved), whisker });
        return '';
    });
    adopted = next.catch(() => null);
    return next;
}

// The description of a whisker's scene, or the message why there is none.
export const described = (whisker, kind = 'scene') => scenes.compute(kind, request('scene', whisker)).then((scene) => [scene, ''], ({ message }) => [null, message]);

const drawn = { map: null, curve: null };

// Waits for map and curve of what is shown last. Resolves to whether both are finished; they may have failed.
export async function finished() {
    for (;;) {
        const own = { ...drawn };
        const isDone = await Promise.all([own.map, own.curve]);
        if (own.map === drawn.map && own.curve === drawn.curve) return isDone.every(Boolean);
    }
}

// Calls `f` with the response to a request unless a newer one replaces it; `fail` gets the message of an error.
async function responded(solver, kind, own, f, fail = shown.error) {
    try {
        f(await solver.compute(kind, own));
        return true;
    } catch (error) {
        if (!(error instanceof Superseded)) fail(error.message);
        return false;
    }
}

// Computes a part of what is known, for the whisker of the page, and shows it.
const fill = (solver, part, own, fail, { whisker } = state) => responded(solver, part, own, (response) => {
    known[part] = { ...response, whisker };
    shown[part]();
}, fail);

const quiet = () => {};
async function computeMap() {
    const { view, channel, whisker } = state;
    if (!view) return false;
    const size = (cells) => [view.push, view.distance].map(([from, to]) => (from < to ? cells : 1));
    const task = (cells, tolerance_deg) =>
        request({ map: { push_angle_deg: view.push, distance_mm: view.distance, size: size(cells), channel, tolerance_deg } });
    const take = (isDraft) => (map) => {
        known.map = { ...map, channel, isDraft, whisker };
        shown.map();
        if (!isDraft) isQuick = map.ms <= QUICK_MS;
    };
    const finish = () => responded(maps, 'map', task(CELLS, null), take(false));
    if (isQuick) return finish();
    const isDrawn = await responded(maps, 'map', task(DRAFT, DRAFT_DEG), take(true));
    await new Promise((resolve) => setTimeout(resolve, QUIET));
    const isLast = whisker === state.whisker && view === state.view && channel === state.channel;
    return isDrawn && isLast && finish();
}

function curve(whisker) {
    const [from, to] = state.view.distance;
    return request({ curve: { distance_mm: [from, to], count: from < to ? CURVE : 1 } }, whisker);
}

// Without a curve, the one of another whisker must not stay.
const noCurve = () => ((known.curve = null), shown.curve());
const computeCurve = () => state.view && fill(courses, 'curve', curve(), noCurve);

function computePinned() {
    known.pinnedCurve = null;
    if (state.pinned && state.view) fill(courses, 'pinnedCurve', curve(state.pinned));
    else shown.curve();
}

function computeState() {
    const { pointer, pinned } = state;
    if (!pointer) return;
    const task = { state: { push_angle_deg: pointer.push, distance_mm: pointer.distance } };
    fill(traces, 'state', request(task), shown.noState);
    if (pinned) fill(traces, 'pinnedState', request(task, pinned), quiet);
    else known.pinnedState = null;
    const row = { distance_mm: pointer.distance, push_angle_deg: pointer.push, count: BRANCH };
    fill(rows, 'branches', request({ branches: row }), quiet);
}

function computeRow() {
    if (!state.pointer) return;
    fill(courses, 'sensitivities', request({ sensitivities: { distance_mm: state.pointer.distance } }), quiet);
    computeWhisk();
}

function computeWhisk() {
    if (state.pointer) fill(courses, 'whisk', request({ whisk: { distance_mm: state.pointer.distance, ...state.whisk } }), shown.noWhisk);
}

function comparePoints() {
    known.points = null;
    if (state.points) fill(traces, 'points', request({ points: { ...state.points, free: [] } }), shown.pointsError);
    else shown.points();
}

// Fits parameters to the points; resolves to the estimates, or to nothing.
export async function fit(free) {
    let found;
    const task = { points: { ...state.points, free } };
    await responded(traces, 'fit', request(task), (own) => (found = own), shown.pointsError);
    return found;
}

// The scene with the page's values, as TOML.
export async function toml() {
    let text;
    await responded(traces, 'toml', request('toml'), (own) => (text = own.toml));
    return text;
}
