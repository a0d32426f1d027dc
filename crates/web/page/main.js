// The page: its parts, and what each does when a result arrives.

import { drawBranches, drawDetachment, drawSensitivities } from './charts.js';
import { start } from './compute.js';
import { makeControls, showError, showPinned, showValues, startControls } from './controls.js';
import { debounced, el, find } from './dom.js';
import { startFiles } from './files.js';
import { drawMap, drawPlane, startMap } from './map.js';
import { showPoints, showPointsError, startPoints } from './points.js';
import { showNoState, showState } from './readout.js';
import { change, fromLink, known, link, on, state } from './state.js';
import { CHANNELS, shown, titled } from './text.js';
import { drawCourse, showCourse, startWhisk } from './whisk.js';
import { drawWhisker } from './whisker.js';

// The scene whose controls are on the page.
let opened = null;

// What is done with each result.
const show = {
    scene() {
        const { title, push_angle_deg: push, distance_mm: distance } = known.scene;
        find('title').textContent = title;
        document.title = `${title} \u00b7 whiskmap`;
        if (opened === state.whisker.text) return showValues();
        opened = state.whisker.text;
        known.whole = { push, distance };
        makeControls();
        const middle = ([from, to]) => Number((from + 0.56 * (to - from)).toPrecision(3));
        change({ view: state.view ?? known.whole, pointer: state.pointer ?? { push: middle(push), distance: middle(distance) } });
    },
    map() {
        const { ms, engine, size, unresolved } = known.map;
        find('engine').textContent = `${size.join(' \u00d7 ')} cells, ${Math.round(ms)} ms, ${engine}${unresolved ? `, ${unresolved} unresolved` : ''}`;
        drawMap();
        find('engine').dataset.drawn = JSON.stringify([known.map.isDraft, known.map.whisker.values, known.map.push_angle_deg, known.map.distance_mm]);
    },
    curve() {
        drawPlane();
        drawDetachment();
    },
    pinnedCurve: () => show.curve(),
    state() {
        showState();
        drawWhisker();
    },
    pinnedState: () => show.state(),
    branches: () => (drawBranches(), drawWhisker()),
    sensitivities: drawSensitivities,
    whisk: () => showCourse(''),
    points() {
        showPoints();
        show.curve();
    },
    error: showError,
    noState: showNoState,
    noWhisk: showCourse,
    pointsError: showPointsError,
    stopped: () => showError('stopped; change a number to compute again'),
};

function startTools() {
    find('channel').append(el('option', { value: '' }, 'Regimes'), ...Object.keys(CHANNELS).slice(0, 11).map((name) => el('option', { value: name }, titled(name))));
    find('channel').addEventListener('change', ({ target }) => change({ channel: target.value || null }));
    find('scale').addEventListener('change', ({ target }) => change({ scale: target.value }));
    const ends = [find('range-from'), find('range-to')];
    const end = ({ value }) => (value.trim() !== '' && Number.isFinite(Number(value)) ? Number(value) : null);
    for (const field of ends) field.addEventListener('change', () => change({ range: ends.map(end) }));
    find('whole').addEventListener('click', () => change({ view: known.whole }));
    on(['channel', 'scale', 'range'], showTools);
    on(['pinned'], showPinned);
    const remember = debounced(400, async () => history.replaceState(null, '', `#${await link()}`));
    on(['whisker', 'pinned', 'view', 'channel', 'scale', 'range', 'pointer', 'points', 'whisk'], remember);
    for (const id of ['bifurcation', 'whisker']) new ResizeObserver(() => redraw()).observe(find(id));
}

function showTools() {
    find('channel').value = state.channel ?? '';
    find('scale').value = state.scale;
    find('quantity').hidden = !state.channel;
    ['range-from', 'range-to'].forEach((id, i) => (find(id).value = state.range[i] ?? ''));
}

function redraw() {
    drawBranches();
    drawWhisker();
    drawSensitivities();
    drawCourse();
    if (state.view) drawDetachment();
}

// The scene of the page, or what the link says instead.
async function first() {
    const { scene, points } = JSON.parse(find('start').textContent);
    const own = { whisker: { ...scene, values: {} }, points };
    const hash = location.hash.slice(1);
    return hash ? { ...own, ...(await fromLink(hash).catch(() => ({}))) } : own;
}

startMap();
startControls();
startPoints();
startFiles();
startTools();
startWhisk();
await start(show);
change({ ...state, ...(await first()) });
addEventListener('hashchange', async () => {
    if (location.hash.slice(1) !== (await link())) change({ ...state, ...(await first()) });
});
