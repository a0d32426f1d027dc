// Readout: regime, status and every channel at the pointer, also in words for screen readers, and the command for the same state.

import { css, regimeColour } from './colours.js';
import { debounced, el, find } from './dom.js';
import { known, state } from './state.js';
import { CHANNELS, exact, shown, sideOf, unit } from './text.js';

// The values of a state.
function values(own) {
    if (!own) return {};
    return { ...own.verdict.values, ...own.stable.state };
}

const reason = (own) => (own.stable.points ? null : own.stable.none);

// Shows the state at the pointer.
export function showState() {
    const own = known.state;
    const [mine, pinned] = [values(own), values(known.pinnedState)];
    const { regime, status } = own.verdict;
    const code = known.scene.regimes.find(({ name }) => name === regime)?.code;
    find('regime').replaceChildren(el('span', { class: 'dot' }), regime ?? 'unresolved');
    find('regime').firstChild.style.background = css(regimeColour(code));
    find('place').textContent = `${shown(own.push_angle_deg)}\u00b0 ${sideOf(own.push_angle_deg)}, ${shown(own.distance_mm)} mm`;
    find('why').textContent = reason(own) ?? status;
    const head = state.pinned ? [el('tr', {}, el('th', {}), el('th', { scope: 'col' }, 'this'), el('th', { scope: 'col' }, 'pinned'), el('th', {}))] : [];
    find('channels').replaceChildren(...head, ...Object.entries(CHANNELS).map(([name, title]) => el('tr', { 'data-channel': name },
        el('th', { scope: 'row' }, title),
        el('td', { 'data-value': exact(mine[name]) }, shown(mine[name])),
        ...(state.pinned ? [el('td', { class: 'pinned' }, shown(pinned[name]))] : []),
        el('td', { class: 'unit' }, unit(name)))));
    showCommand();
    speak();
}

// The command line that computes the state at the pointer.
function showCommand() {
    const { push_angle_deg: push, distance_mm: distance } = known.state;
    const changed = Object.keys(state.whisker.values).length > 0;
    const scene = `${known.scene.name}.toml`.replace(/'/g, "'\\''");
    find('command').textContent = `whiskmap shape '${scene}' --distance ${exact(distance)} --push-angle ${exact(push)}`;
    find('command-note').textContent = changed ? 'after \u201cscene.toml\u201d: values differ from the file' : '';
}

const speak = debounced(500, () => {
    const own = known.state;
    const mine = values(own);
    const numbers = ['force_un', 'base_moment_nnm', 'margin_deg'].filter((name) => mine[name] != null);
    const words = numbers.map((name) => `${CHANNELS[name]} ${shown(mine[name], 3)} ${unit(name)}`);
    find('spoken').textContent = [`Push angle ${shown(own.push_angle_deg, 4)} degrees, distance ${shown(own.distance_mm, 4)} millimetres: ${own.verdict.regime}`, reason(own), ...words].filter(Boolean).join('. ');
});

// Says that there is no state, with the reason.
export const showNoState = (message) => (find('why').textContent = message);
