// Measured points: a CSV file, its residuals, and fits.

import { el, find } from './dom.js';
import { adopt, fit } from './compute.js';
import { change, known, state, title, withValues } from './state.js';
import { ownUnit, shown, withUnit } from './text.js';

// Largest size of a file, in bytes: the limit of scenes.
const LARGEST = 1 << 20;

// Parameters that a fit is likely to free, in this order.
const LIKELY = ['tip_radius_um', 'parabola_per_mm', 'vertex_mm', 'length_mm', 'base_radius_um', 'pole_radius_mm', 'friction', 'modulus_tip_to_base', 'arc_stretch', 'follicle_stiffness_nnm_per_rad'];

// Opens a file: a scene, or else measured points.
export async function open(file) {
    if (file.size > LARGEST) return showPointsError(`${file.name}: must be at most 1 MiB`);
    const text = await file.text();
    if (!/\.toml$/i.test(file.name)) return change({ points: { name: file.name, csv: text } });
    const message = await adopt('scene', () => ({ text, origin: file.name, values: {} }), { view: null, pointer: null, pinned: null });
    showPointsError(message ? `${message}\nThe last scene stays.` : '');
}

// Shows the points and their misfit.
export function showPoints() {
    const { points } = known;
    find('fit-controls').hidden = !points;
    showPointsError('');
    if (!state.points) return;
    find('points-name').textContent = state.points.name;
    if (!points) return;
    const { count, rms_deg, bias_deg, rows, of_another_kind } = points.beside;
    const kinds = of_another_kind ? `, ${of_another_kind} of another kind` : '';
    find('misfit').textContent = `${count} of ${rows.length} points: RMS ${withUnit('rms_deg', rms_deg, 3)}, bias ${withUnit('bias_deg', bias_deg, 3)}${kinds}`;
    find('misfit').dataset.rms = rms_deg;
    if (find('free').childElementCount) return;
    const names = LIKELY.filter((name) => known.scene.parameters.some((own) => own.name === name));
    find('free').replaceChildren(...names.map((name, i) => el('label', {}, el('input', { type: 'checkbox', value: name, checked: i === 0 }), ` ${title(name)}`)));
}

export const showPointsError = (message) => (find('points-error').textContent = message);

async function fitted() {
    const free = [...find('free').querySelectorAll('input:checked')].map((box) => box.value);
    if (!free.length) return showPointsError('no parameter is free');
    find('fit').disabled = true;
    showPointsError('');
    const found = await fit(free);
    find('fit').disabled = false;
    if (!found) return;
    const message = await adopt('fit', (whisker) => withValues(whisker, Object.fromEntries(found.estimates.map(({ name, value }) => [name, value]))));
    showPointsError(message ?? '');
    const estimates = found.estimates.map(({ name, value, standard_error, is_at_limit }) => {
        const error = standard_error == null ? (is_at_limit ? ' (at its limit)' : ' (not determined)') : ` \u00b1 ${shown(standard_error, 2)}`;
        return el('li', { 'data-name': name, 'data-value': value }, `${title(name)} ${shown(value)}${error} ${ownUnit(name)}`);
    });
    const verdict = found.not_a_fit ? [el('li', { class: 'error' }, found.not_a_fit)] : [];
    find('estimates').replaceChildren(...estimates, ...verdict);
}

// Starts to listen to files, chosen or dropped anywhere on the page, and to the buttons.
export function startPoints() {
    find('file').addEventListener('change', ({ target }) => {
        if (target.files[0]) open(target.files[0]);
        target.value = '';
    });
    addEventListener('dragover', (event) => event.preventDefault());
    addEventListener('drop', (event) => {
        event.preventDefault();
        for (const file of event.dataTransfer.files) open(file);
    });
    find('fit').addEventListener('click', fitted);
    find('forget').addEventListener('click', () => (find('estimates').replaceChildren(), (find('points-name').textContent = ''), change({ points: null })));
}
