// Readout: regime, status and every channel at the pointer, also in words for screen readers, and the command for the same state.

import { css, regimeColour } from './colours.js';
import { toml } from './compute.js';
import { debounced, el, find } from './dom.js';
import { known, state } from './state.js';
import { CHANNELS, exact, inUnit, sideOf, spoken, unit, withUnit } from './text.js';

// The values of a state.
const values = (own) => (own ? { ...own.verdict.values, ...own.stable.state } : {});

const reason = (own) => (own.stable.points ? null : own.stable.none);

// Shows the state at the pointer.
export function showState() {
    const own = known.state;
    const [mine, pinned] = [values(own), values(known.pinnedState)];
    const { regime, status } = own.verdict;
    const code = known.scene.regimes.find(({ name }) => name === regime)?.code;
    find('regime').replaceChildren(el('span', { class: 'dot' }), regime ?? 'unresolved');
    find('regime').firstChild.style.background = css(regimeColour(code));
    find('place').textContent = `${withUnit('push_angle_deg', own.push_angle_deg)} ${sideOf(own.push_angle_deg)}, ${withUnit('distance_mm', own.distance_mm)}`;
    find('place').dataset.at = JSON.stringify({ distance: own.distance_mm, push: own.push_angle_deg });
    find('why').textContent = reason(own) ?? status;
    const head = state.pinned ? [el('tr', {}, el('th', {}), el('th', { scope: 'col' }, 'this'), el('th', { scope: 'col' }, 'pinned'), el('th', {}))] : [];
    find('channels').replaceChildren(...head, ...Object.entries(CHANNELS).map(([name, title]) => el('tr', { 'data-channel': name },
        el('th', { scope: 'row' }, title),
        el('td', { 'data-value': exact(mine[name]) }, inUnit(name, mine[name])),
        ...(state.pinned ? [el('td', { class: 'pinned' }, inUnit(name, pinned[name]))] : []),
        el('td', { class: 'unit' }, unit(name)))));
    showCommand();
    speak();
}

// True if the scene is not that of a file: it has other values, is one of a sweep, or comes from a map.
function isChanged() {
    const { origin, values } = state.whisker;
    return known.scene.is_of_sweep || Object.keys(values).length > 0 || !/\.toml$/i.test(origin);
}

// The command line that computes the state at the pointer or, without a state, the ends of contact at its distance. A scene that differs from
// its file is on standard input.
function showCommand() {
    const { push_angle_deg: push, distance_mm: distance, stable } = known.state;
    const scene = isChanged() ? '-' : `'${state.whisker.origin.replace(/^-/, './-').replace(/'/g, "'\\''")}'`;
    const [name, place] = stable.points ? ['shape', ` --push-angle ${exact(push)}`] : ['curve', ''];
    find('command').textContent = `whiskmap ${name} ${scene} --distance ${exact(distance)}${place}`;
    find('command-note').textContent = isChanged() ? 'the copy contains the scene of this whisker, as a here-document' : '';
}

// The text that reproduces the state in a shell. No line of the scene ends the here-document.
export async function command() {
    const line = find('command').textContent;
    if (!isChanged()) return line;
    const text = await toml();
    let end = 'SCENE';
    while (text?.includes(end)) end += '_';
    return text && `${line} <<'${end}'\n${text.trimEnd()}\n${end}\n`;
}

const speak = debounced(500, () => {
    const own = known.state;
    const mine = values(own);
    const numbers = ['force_un', 'base_moment_nnm', 'margin_deg'].filter((name) => mine[name] != null);
    const words = numbers.map((name) => `${CHANNELS[name]} ${spoken(name, mine[name], 3)}`);
    const place = `Push angle ${spoken('push_angle_deg', own.push_angle_deg, 4)}, distance ${spoken('distance_mm', own.distance_mm, 4)}`;
    find('spoken').textContent = [`${place}: ${own.verdict.regime}`, reason(own), ...words].filter(Boolean).join('. ');
});

// Says that there is no state, with the reason.
export const showNoState = (message) => (find('why').textContent = message);
