// The whisker in equal scales: at rest, deformed, and in the unstable state, with the pole and its force.

import { find, svg } from './dom.js';
import { known, state } from './state.js';
import { ticks, widest } from './plot.js';
import { withUnit } from './text.js';

const picture = find('whisker');

// Draws the state at the pointer. The picture has the same extent for all states of a whisker, in whisker lengths.
export function drawWhisker() {
    const { width, height } = picture.getBoundingClientRect();
    const own = known.state;
    if (!own || !width) return;
    const { length_mm: length } = known.scene;
    const [x0, x1, middle] = [-0.16 * length, 1.06 * length, 0];
    const scale = Math.min(width / (x1 - x0), height / (1.25 * length));
    const place = ([x, y]) => [(x - x0) * scale + (width - (x1 - x0) * scale) / 2, height / 2 - (y - middle) * scale];
    const line = (points, name) => svg('path', { class: `line ${name}`, d: points.map((point, i) => `${i ? 'L' : 'M'}${place(point).map((value) => value.toFixed(2)).join(' ')}`).join('') });
    const parts = [scaleBar(length, scale, height)];
    const { stable } = own;
    // The unstable state comes with the branches, after the stable state.
    const isSame = ['whisker', 'distance_mm', 'push_angle_deg'].every((name) => known.branches?.[name] === own[name]);
    const unstable = isSame ? known.branches.unstable : {};
    const { pole_mm, pole_radius_mm } = stable.points ? stable : unstable;
    if (pole_mm) {
        const [cx, cy] = place(pole_mm);
        parts.push(svg('circle', { class: 'pole', cx, cy, r: Math.max(pole_radius_mm * scale, 2) }));
    }
    const pinned = known.pinnedState;
    if (state.pinned && pinned?.stable.points) parts.push(line(pinned.stable.points, 'pinned'));
    parts.push(line(own.rest, 'rest'));
    if (unstable.points) parts.push(line(unstable.points, 'unstable'));
    if (stable.points) parts.push(line(stable.points, 'stable'), ...force(stable, place, length));
    const [bx, by] = place([0, 0]);
    parts.push(svg('circle', { class: 'base', cx: bx, cy: by, r: 4 }));
    picture.setAttribute('viewBox', `0 0 ${width} ${height}`);
    picture.setAttribute('aria-label', `Whisker at rest${stable.points ? ', deformed by the pole' : ''}${unstable.points ? ', and in its unstable state' : ''}`);
    picture.replaceChildren(...parts);
}

// The force of the pole on the whisker, as an arrow at the contact that grows with the force up to a quarter of the whisker.
function force({ points, contact, state: found }, place, length) {
    const { force_un, base_force_x_un: along, base_force_y_un: across, push_angle_deg } = found;
    if (!(force_un > 0)) return [];
    const turn = (-push_angle_deg * Math.PI) / 180;
    const [x, y] = [along * Math.cos(turn) - across * Math.sin(turn), along * Math.sin(turn) + across * Math.cos(turn)];
    const size = (0.25 * length * force_un) / (force_un + known.scene.unit_force_un) / Math.hypot(x, y);
    const [from, to] = [points[contact], points[contact].map((value, i) => value + size * [x, y][i])].map(place);
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    const span = Math.hypot(dx, dy) || 1;
    const [ux, uy] = [(dx / span) * 7, (dy / span) * 7];
    const label = withUnit('force_un', force_un, 3);
    const [long, { width, height }] = [widest([label]) + 4, picture.getBoundingClientRect()];
    const x0 = Math.min(Math.max(to[0] + ux - (ux < 0 ? long : 0), 4), width - long);
    const head = `M${to[0]} ${to[1]}L${to[0] - ux - uy / 2} ${to[1] - uy + ux / 2}L${to[0] - ux + uy / 2} ${to[1] - uy - ux / 2}Z`;
    return [
        svg('line', { class: 'line force', x1: from[0], y1: from[1], x2: to[0] - ux / 2, y2: to[1] - uy / 2 }),
        svg('path', { class: 'arrow', d: head }),
        svg('text', { class: 'force', x: x0, y: Math.min(Math.max(to[1] + uy + 4, 14), height - 34) }, label),
    ];
}

function scaleBar(length, scale, height) {
    const [, size] = ticks([0, length], 4);
    const [x, y] = [10, height - 12];
    return svg('g', { class: 'scale' }, svg('line', { x1: x, x2: x + size * scale, y1: y, y2: y }), svg('text', { x, y: y - 6 }, withUnit('length_mm', size)));
}
