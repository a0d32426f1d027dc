// Numbers, units, channels and parameters in words.

import { state } from './state.js';

const MINUS = '\u2212';

// A number with a few digits, for people.
export function shown(value, digits = 5) {
    if (value == null || !Number.isFinite(value)) return '\u2013';
    const size = Math.abs(value);
    const text = size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(digits - 2) : value.toPrecision(digits);
    return (text.includes('e') ? text.replace(/\.?0*e\+?/, 'e') : text.includes('.') ? text.replace(/\.?0+$/, '') : text).replace(/-/g, MINUS);
}

// A number with all its digits, for files and commands.
export const exact = (value) => (value == null ? '' : String(value));

// Units of each quantity that the reader can choose, with their sizes in the unit of the data.
export const UNITS = {
    length: { mm: 1, cm: 10, m: 1e3, '\u00b5m': 1e-3 },
    angle: { '\u00b0': 1, rad: 180 / Math.PI },
    force: { '\u00b5N': 1, nN: 1e-3, mN: 1e3, N: 1e6 },
    moment: { 'nN m': 1, '\u00b5N m': 1e3, 'mN m': 1e6, 'N m': 1e9, '\u00b5N mm': 1, 'mN mm': 1e3, 'N mm': 1e6 },
    energy: { nJ: 1, '\u00b5J': 1e3, mJ: 1e6, J: 1e9 },
    time: { ms: 1e-3, s: 1 },
};

// The quantity, or else the unit, at the end of a name such as `force_un`.
const ENDS = [['_per_mm2', '1/mm\u00b2'], ['_per_mm', '1/mm'], ['_mm', 'length'], ['_deg', 'angle'], ['_un', 'force'], ['_nnm', 'moment'], ['_nj', 'energy'], ['_s', 'time'], ['_um', '\u00b5m'], ['_gpa', 'GPa']];

const kind = (name) => ENDS.find(([end]) => name.endsWith(end))?.[1] ?? (name === 'residual' ? 'lengths' : '');

// The unit in which the numbers of a name are shown, and its size in the unit of the data.
export const unit = (name) => state.units[kind(name)] ?? kind(name);
export const sizeOf = (name) => UNITS[kind(name)]?.[unit(name)] ?? 1;

// The unit of a parameter in a scene, which the reader cannot choose.
export const ownUnit = (name) => Object.keys(UNITS[kind(name)] ?? { [kind(name)]: 1 })[0];

// A value of a name in the unit that the reader has chosen, without and with the unit.
export const inUnit = (name, value, digits) => shown(value == null ? value : value / sizeOf(name), digits);
export const withUnit = (name, value, digits) => `${inUnit(name, value, digits)}${unit(name) === '\u00b0' ? '' : ' '}${unit(name)}`.trim();

const SPOKEN = { m: 'metre', N: 'newton', J: 'joule', s: 'second', rad: 'radian', '\u00b0': 'degree', lengths: 'length' };
const PREFIXES = { '\u00b5': 'micro', n: 'nano', m: 'milli', c: 'centi' };

// A value with its unit in words, for screen readers.
export function spoken(name, value, digits) {
    const word = (own) => (SPOKEN[own] ? SPOKEN[own] : `${PREFIXES[own[0]] ?? ''}${SPOKEN[own.slice(1)] ?? own}`);
    return `${inUnit(name, value, digits)} ${unit(name) ? `${unit(name).split(' ').map(word).join(' ')}s` : ''}`.trim();
}

// Channels by name.
export const CHANNELS = {
    force_un: 'Contact force', base_moment_nnm: 'Bending moment at the base', base_force_x_un: 'Force on the base along the whisker',
    base_force_y_un: 'Force on the base across the whisker', energy_nj: 'Bending energy', arc_length_mm: 'Arc length from base to contact',
    contact_distance_mm: 'Distance from base to contact', contact_angle_deg: 'Contact angle', push_chord_deg: 'Chord angle',
    margin_deg: 'Push angle left until detachment', residual: 'Residual', peak_strain: 'Largest bending strain',
    peak_strain_mm: 'Arc length to the largest bending strain',
};

const AXES = { push_angle_deg: 'Push angle', distance_mm: 'Distance at first touch', time_s: 'Time', change_deg: 'Change of push angle', residual_deg: 'Measured \u2212 computed' };

// A name with its unit, as the title of an axis.
export const titled = (name) => `${CHANNELS[name] ?? AXES[name]}${unit(name) ? ` (${unit(name)})` : ''}`;

// Loads and energies span decades, as they vanish at first touch.
export const isLoad = (name) => /_(un|nnm|nj)$/.test(name);

// A push angle with the side of the pole.
export const sideOf = (push) => (push < 0 ? 'CF' : 'CB');
