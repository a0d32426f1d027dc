// The page: its parts, and what each does when a result arrives.

import { drawBranches, drawDetachment, drawSensitivities } from './charts.js';
import { adopt, described, start } from './compute.js';
import { makeControls, showPinned, showValues, startControls } from './controls.js';
import { debounced, el, find } from './dom.js';
import { startField } from './field.js';
import { startFiles } from './files.js';
import { fromLink, link } from './link.js';
import { drawMap, drawPlane, startMap } from './map.js';
import { showPoints, showPointsError, startPoints } from './points.js';
import { showNoState, showState } from './readout.js';
import { change, known, on, state } from './state.js';
import { CHANNELS, UNITS, inUnit, sizeOf, titled } from './text.js';
import { drawCourse, showCourse, startWhisk } from './whisk.js';
import { drawWhisker } from './whisker.js';

// The scene and the whisker whose controls are on the page.
let opened = null;
let ranges;

// Shows the whisker, with new controls for a new scene.
function showScene() {
    const { title } = known.scene;
    find('title').textContent = title;
    document.title = `${title} \u00b7 whiskmap`;
    const own = JSON.stringify([state.whisker.text, known.scene.whisker]);
    if (opened === own) return showValues();
    opened = own;
    makeControls();
}

// Shows a message about the whole page, until something changes; with `isAgain`, the reader can repeat the computation.
function showFailure(message, isAgain = true) {
    find('failure').textContent = message;
    find('again').hidden = !message || !isAgain;
}

// What is done with each result.
const show = {
    map() {
        const { ms, engine, size, unresolved } = known.map;
        find('engine').textContent = `${size.join(' \u00d7 ')} cells, ${Math.round(ms)} ms, ${engine}${unresolved ? `, ${unresolved} unresolved` : ''}`;
        drawMap();
        find('engine').dataset.drawn = JSON.stringify([known.map.isDraft, known.map.whisker.values, known.map.push_angle_deg, known.map.distance_mm]);
    },
    curve: () => (drawPlane(), drawDetachment()),
    pinnedCurve: () => show.curve(),
    state: () => (showState(), drawWhisker()),
    pinnedState: () => show.state(),
    branches: () => (drawBranches(), drawWhisker()),
    sensitivities: drawSensitivities,
    whisk: () => showCourse(''),
    points: () => (showPoints(), show.curve()),
    error: showFailure,
    noState: showNoState,
    noWhisk: showCourse,
    pointsError: showPointsError,
};

function startTools() {
    find('channel').append(el('option', { value: '' }, 'Regimes'), ...Object.keys(CHANNELS).slice(0, 11).map((name) => el('option', { value: name }, titled(name))));
    find('channel').addEventListener('change', ({ target }) => change({ channel: target.value || null }));
    find('scale').addEventListener('change', ({ target }) => change({ scale: target.value }));
    ranges = ['range-from', 'range-to'].map((id, i) => startField(find(id), find(`error-${id}`), (value) => {
        change({ range: state.range.map((end, own) => (own !== i ? end : value && value * sizeOf(state.channel))) });
        return '';
    }, true));
    find('units').append(...Object.entries(UNITS).map(([quantity, units]) => el('label', {}, `${quantity} `,
        el('select', { id: `unit-${quantity}`, onchange: ({ target }) => change({ units: { ...state.units, [quantity]: target.value } }) },
            ...Object.keys(units).map((name) => el('option', { value: name }, name))))));
    find('again').addEventListener('click', () => change({ whisker: state.whisker }));
    on(['whisker', 'view', 'channel', 'points'], () => showFailure(''));
    on(['whisker'], showScene);
    on(['units'], showUnits);
    find('whole').addEventListener('click', () => change({ view: known.whole }));
    on(['channel', 'scale', 'range', 'units'], showTools);
    on(['pinned'], showPinned);
    const remember = debounced(400, () => link().then((own) => history.replaceState(null, '', `#${own}`)).catch(() => {}));
    on(Object.keys(state), remember);
    for (const id of ['bifurcation', 'whisker']) new ResizeObserver(() => redraw()).observe(find(id));
}

function showTools() {
    find('channel').value = state.channel ?? '';
    find('scale').value = state.scale;
    find('quantity').hidden = !state.channel;
    ranges.forEach((field, i) => field.show(state.range[i] === null || !state.channel ? '' : inUnit(state.channel, state.range[i])));
}

// Shows everything in the reader's units.
function showUnits() {
    for (const [quantity, name] of Object.entries(state.units)) find(`unit-${quantity}`).value = name;
    for (const option of find('channel').options) if (option.value) option.textContent = titled(option.value);
    if (known.state) showState();
    showPoints();
    showCourse(known.whisk ? '' : find('whisk-error').textContent);
    redraw();
}

function redraw() {
    drawBranches();
    drawWhisker();
    drawSensitivities();
    drawCourse();
    if (state.view) drawDetachment();
}

// Opens what the link of the address contains. What is not valid there is left out, with a message: without a valid scene, the present one
// stays, or that of the file opens.
async function open() {
    const { scene, points } = JSON.parse(find('start').textContent);
    const own = { whisker: { ...scene, values: {} }, points };
    const hash = location.hash.slice(1);
    const { parts, bad } = hash ? await fromLink(hash).catch(() => ({ parts: {}, bad: ['everything'] })) : { parts: {}, bad: [] };
    if (parts.pinned && (await described(parts.pinned, 'pinned'))[1]) {
        delete parts.pinned;
        bad.push('pinned');
    }
    const { whisker, ...others } = { ...state, ...(hash && state.whisker ? {} : own), ...parts };
    const message = await adopt('scene', () => whisker, others);
    if (message && !state.whisker) await adopt('scene', () => own.whisker, { points });
    if (!state.whisker) find('engine').textContent = '';
    const damage = bad.length ? `The link is damaged. Left out: ${bad.join(', ')}.\n` : '';
    const refused = message ? `The scene${hash ? ' of the link' : ''} is refused: ${message}` : '';
    if (damage || refused) showFailure(damage + refused, false);
}

startMap();
startControls();
startPoints();
startFiles();
startTools();
startWhisk();
try {
    await start(show);
    await open();
    addEventListener('hashchange', async () => location.hash.slice(1) !== (await link().catch(() => '')) && open());
} catch ({ message }) {
    find('engine').textContent = '';
    showFailure(`the solver cannot start in this browser: ${message}`, false);
}
