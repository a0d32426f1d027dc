// Controls: a slider and a number field for each number of the scene.

import { adopt } from './compute.js';
import { el, find } from './dom.js';
import { startField } from './field.js';
import { change, known, state, withValues } from './state.js';
import { ownUnit, shown } from './text.js';

// Parameters with the ends of their sliders, by the whisker of the file: `of` has its numbers.
const PARAMETERS = {
    taper: () => [0, 1],
    tip_radius_um: (of) => [0, of.base_radius_um],
    base_radius_um: (of) => [of.base_radius_um / 3, of.base_radius_um * 3],
    length_mm: (of) => [of.length_mm / 2, of.length_mm * 2],
    profile_scale: (of) => [of.profile_scale / 3, of.profile_scale * 3],
    tip_extension_mm: (of) => [0, Math.max(4 * of.tip_extension_mm, of.length_mm / 10)],
    parabola_per_mm: (of) => [0, Math.max(0.8 / of.length_mm, 2 * of.parabola_per_mm)],
    vertex_mm: (of) => [-of.length_mm / 2, of.length_mm / 2],
    spiral_per_mm: (of) => [-3 / of.length_mm, 3 / of.length_mm],
    spiral_per_mm2: (of) => [-4 / of.length_mm ** 2, 4 / of.length_mm ** 2],
    pole_radius_mm: (of) => [0, Math.max(of.length_mm / 20, 2 * of.pole_radius_mm)],
    friction: () => [0, 1],
    youngs_modulus_gpa: (of) => [of.youngs_modulus_gpa / 5, of.youngs_modulus_gpa * 5],
    modulus_tip_to_base: () => [0.2, 5],
    arc_stretch: () => [1, 1.2],
    follicle_stiffness_nnm_per_rad: (of) => [of.follicle_stiffness_nnm_per_rad / 5, of.follicle_stiffness_nnm_per_rad * 5],
};

const rows = new Map();

// Makes the controls of a scene that has just been opened.
export function makeControls() {
    const { parameters, whiskers, whisker } = known.scene;
    find('row').parentElement.hidden = !whiskers.length;
    find('row').replaceChildren(...whiskers.map((name) => el('option', { selected: name === whisker }, name)));
    const of = { length_mm: known.scene.length_mm, ...Object.fromEntries(parameters.map(({ name, value }) => [name, value])) };
    rows.clear();
    const names = Object.keys(PARAMETERS).filter((name) => parameters.some((own) => own.name === name));
    find('numbers').replaceChildren(...names.map((name) => {
        const own = parameters.find((parameter) => parameter.name === name);
        const [from, to] = PARAMETERS[name](of);
        const field = el('input', { id: `field-${name}`, type: 'text', inputmode: 'decimal', autocomplete: 'off', spellcheck: 'false', 'aria-describedby': `error-${name}` });
        const error = el('p', { class: 'error', id: `error-${name}`, role: 'alert' });
        const entry = startField(field, error, (value) => adopt(name, (whisker) => withValues(whisker, { [name]: value })));
        const slider = el('input', { type: 'range', min: from, max: to, step: 'any', 'aria-label': own.title, oninput: (event) => entry.enter(Number(Number(event.target.value).toPrecision(4))) });
        rows.set(name, { entry, slider });
        return el('div', { class: 'control' }, el('label', { for: field.id, title: `${own.title}: ${own.key}` }, own.title.replace(/ \(.*\)/, '')), el('span', { class: 'value' }, field, el('span', { class: 'unit' }, ownUnit(name))), slider, error);
    }));
    showValues();
}

// Shows the values of the scene, but for fields whose text is refused.
export function showValues() {
    for (const { name, value } of known.scene.parameters) {
        const row = rows.get(name);
        if (!row) continue;
        row.entry.show(shown(value, 6));
        row.slider.value = value;
        row.slider.setAttribute('aria-valuetext', `${shown(value)} ${ownUnit(name)}`);
    }
    find('effects').replaceChildren(...known.scene.effects.map((effect) => el('li', { class: effect.on ? 'on' : 'off', title: effect.why }, effect.name)));
    find('warnings').textContent = known.scene.warnings.join('\n');
}

// The list of the whiskers of a table, and buttons for all values: back to the file, and a second whisker for comparison.
export function startControls() {
    find('row').addEventListener('change', ({ target }) => adopt('scene', (whisker) => ({ ...whisker, values: {}, row: target.value }), { view: null, pointer: null }));
    find('reset').addEventListener('click', () => {
        for (const { entry } of rows.values()) entry.clear();
        adopt('scene', (whisker) => ({ ...whisker, values: {} }));
    });
    find('pin').addEventListener('click', () => change({ pinned: state.pinned ? null : state.whisker }));
}

export function showPinned() {
    find('pin').setAttribute('aria-pressed', String(Boolean(state.pinned)));
    find('pin').textContent = state.pinned ? 'Unpin' : 'Pin for comparison';
}
