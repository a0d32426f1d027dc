// Computation of what is shown: drafts of maps while something moves, then the exact map, curves and states.

import { find } from './dom.js';
import { Solver, Superseded, compiled } from './solver.js';
import { known, on, request, state } from './state.js';

// Cells of a finished map, and of drafts along each axis.
const CELLS = 256;
const DRAFTS = [256, 128, 64, 32];

// A draft may take this long, in ms, and differ this much from the exact boundary, in degrees.
const DRAFT_MS = 45;
const DRAFT_DEG = 0.01;

// Distances of a detachment curve, and points of a branch.
const CURVE = 160;
const BRANCH = 60;

// A map is finished when nothing has moved for this long, in ms.
const QUIET = 80;

let maps, traces, shown;
let draft = 2;

// Starts the solvers. `show` has a function for each result, and for errors.
export async function start(show) {
    shown = show;
    const module = await compiled();
    const busy = {};
    const onBusy = (name) => (running) => {
        busy[name] = running;
        find('stop').hidden = !Object.values(busy).some(Boolean);
    };
    maps = new Solver(module, onBusy('maps'));
    traces = new Solver(module, onBusy('traces'));
    find('stop').addEventListener('click', stop);
    on(['whisker'], describe);
    on(['whisker', 'view', 'channel'], computeMap);
    on(['whisker', 'view'], computeCurve);
    on(['whisker', 'pointer', 'pinned'], computeState);
    on(['pinned', 'view'], computePinned);
    on(['whisker', 'points'], comparePoints);
}

function stop() {
    maps.stop();
    traces.stop();
    shown.stopped();
}

// Answers a request with `f` unless a newer one replaces it; `fail` gets the message of an error.
async function answered(solver, kind, own, f, fail = shown.error) {
    try {
        f(await solver.ask(kind, own));
        return true;
    } catch (error) {
        if (!(error instanceof Superseded)) fail(error.message);
        return false;
    }
}

function describe() {
    answered(traces, 'scene', request('scene'), (scene) => {
        known.scene = scene;
        shown.scene();
    });
}

async function computeMap() {
    const { view, channel, whisker } = state;
    if (!view) return;
    const task = (cells, tolerance_deg) =>
        request({ map: { push_angle_deg: view.push, distance_mm: view.distance, size: [cells, cells], channel, tolerance_deg } });
    const take = (isDraft) => (map) => {
        known.map = { ...map, channel, isDraft, whisker };
        shown.map();
        if (isDraft && map.ms > DRAFT_MS) draft = Math.min(draft + 1, DRAFTS.length - 1);
        if (isDraft && map.ms < DRAFT_MS / 2.5) draft = Math.max(draft - 1, 0);
    };
    const isDrawn = await answered(maps, 'map', task(DRAFTS[draft], DRAFT_DEG), take(true));
    await new Promise((resolve) => setTimeout(resolve, QUIET));
    if (isDrawn && whisker === state.whisker && view === state.view && channel === state.channel) {
        await answered(maps, 'map', task(CELLS, null), take(false));
    }
}

const curve = (whisker) => request({ curve: { distance_mm: state.view.distance, count: CURVE } }, whisker);

function computeCurve() {
    if (!state.view) return;
    answered(traces, 'curve', curve(), (found) => {
        known.curve = found;
        shown.curve();
    }, () => {});
}

function computePinned() {
    known.pinnedCurve = null;
    if (!state.pinned || !state.view) return shown.curve();
    answered(traces, 'pinned', curve(state.pinned), (found) => {
        known.pinnedCurve = found;
        shown.curve();
    });
}

function computeState() {
    const { pointer, pinned } = state;
    if (!pointer) return;
    const task = { state: { push_angle_deg: pointer.push, distance_mm: pointer.distance } };
    answered(traces, 'state', request(task), (own) => {
        known.state = own;
        shown.state();
    }, shown.noState);
    if (pinned) {
        answered(traces, 'pinned state', request(task, pinned), (own) => {
            known.pinnedState = own;
            shown.state();
        }, () => {});
    } else {
        known.pinnedState = null;
    }
    answered(traces, 'branches', request({ branches: { distance_mm: pointer.distance, count: BRANCH } }), (own) => {
        known.branches = own;
        shown.branches();
    }, () => {});
}

function comparePoints() {
    known.points = null;
    if (!state.points) return shown.points();
    const task = { points: { ...state.points, free: [] } };
    answered(traces, 'points', request(task), (own) => {
        known.points = own;
        shown.points();
    }, shown.pointsError);
}

// Fits parameters to the points; resolves to the estimates, or to nothing.
export async function fit(free) {
    let found;
    const task = { points: { ...state.points, free } };
    await answered(traces, 'fit', request(task), (own) => (found = own), shown.pointsError);
    return found;
}

// The scene with the page's values, as TOML.
export async function toml() {
    let text;
    await answered(traces, 'toml', request('toml'), (own) => (text = own.toml));
    return text;
}

// The detachment curve as its columns and rows.
export const curveRows = () => known.curve?.rows ?? [];
