// Numbers, channels and parameters in words.

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

// The unit at the end of a name, such as `force_un`.
const UNITS = [['_per_mm2', '1/mm\u00b2'], ['_per_mm', '1/mm'], ['_mm', 'mm'], ['_deg', '\u00b0'], ['_un', '\u00b5N'], ['_nnm', 'nN m'], ['_nj', 'nJ'], ['_um', '\u00b5m'], ['_gpa', 'GPa']];

export const unit = (name) => UNITS.find(([end]) => name.endsWith(end))?.[1] ?? (name === 'residual' ? 'lengths' : '');

// Channels by name.
export const CHANNELS = {
    force_un: 'Contact force',
    base_moment_nnm: 'Bending moment at the base',
    base_force_x_un: 'Force on the base along the whisker',
    base_force_y_un: 'Force on the base across the whisker',
    energy_nj: 'Bending energy',
    arc_length_mm: 'Arc length from base to contact',
    contact_distance_mm: 'Distance from base to contact',
    contact_angle_deg: 'Contact angle',
    push_chord_deg: 'Chord angle',
    margin_deg: 'Push angle left until detachment',
    residual: 'Residual',
    peak_strain: 'Largest bending strain',
    peak_strain_mm: 'Arc length to the largest bending strain',
};

// A name with its unit, as the title of an axis.
export const titled = (name) => `${CHANNELS[name]}${unit(name) ? ` (${unit(name)})` : ''}`;

// Loads and energies span decades, as they vanish at first touch.
export const isLoad = (name) => /_(un|nnm|nj)$/.test(name);

// A push angle with the side of the pole.
export const sideOf = (push) => (push < 0 ? 'CF' : 'CB');
