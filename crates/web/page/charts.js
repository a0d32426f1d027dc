// Charts: the branches and sensitivities at the row of the pointer, the detachment curve, and residuals of measured points.

import { find } from './dom.js';
import { draw, ends } from './plot.js';
import { known, state, title } from './state.js';
import { withUnit } from './text.js';

// Stable and unstable parts of both branches as lines of a value by push angle; the parts meet at the fold.
function branchLines(name) {
    return ['cf', 'cb'].flatMap((side) => {
        const points = known.branches[side].points ?? [];
        const fold = points.findIndex((point) => !point.stable);
        const part = (own) => own.map((point) => [point.push_angle_deg, point[name]]);
        const stable = { points: part(fold < 0 ? points : points.slice(0, fold)), class: 'stable' };
        return fold < 0 ? [stable] : [stable, { points: part(points.slice(fold - 1)), class: 'unstable' }];
    });
}

const MARKS = { 'slip-off': 'fold', 'pull-off': 'tip' };

// Draws a bifurcation diagram and the force curve, with the pointer's push angle.
export function drawBranches() {
    if (!known.branches || !state.pointer) return;
    const { distance } = state.pointer;
    for (const [id, name] of [['bifurcation', 'arc_length_mm'], ['force', 'force_un']]) {
        const lines = branchLines(name);
        const all = lines.flatMap((line) => line.points);
        const marked = ['cf', 'cb'].flatMap((side) => (known.branches[side].points ?? []).filter((point) => point.mark in MARKS));
        draw(find(id), {
            x: ends(all.map(([x]) => x), [0]),
            y: ends(all.map(([, y]) => y), name === 'force_un' ? [0] : []),
            xName: 'push_angle_deg',
            yName: name,
            lines,
            dots: marked.map((point) => ({ at: [point.push_angle_deg, point[name]], class: 'end', title: `${point.mark} at ${withUnit('push_angle_deg', point.push_angle_deg)}` })),
            vertical: state.pointer.push,
        });
        find(`${id}-note`).textContent = `at ${withUnit('distance_mm', distance)}; stable solid, unstable dashed`;
    }
}

// Variables with the largest effects that are shown, and half the height of a bar.
const [MOST, HALF] = [12, 0.2];

const variable = (name) => (name === 'distance_mm' ? 'distance' : title(name).replace(/ \(.*\)/, ''));

// Draws what a change of 1 % of each number does to the detachments, with one bar for each side; the largest is at the top.
export function drawSensitivities() {
    if (!known.sensitivities) return;
    const { rows, distance_mm } = known.sensitivities;
    const size = (name) => Math.max(...rows.filter((row) => row.variable === name).map((row) => Math.abs(row.push_of_1_percent_deg ?? 0)));
    const names = [...new Set(rows.map((row) => row.variable))].filter((name) => size(name) > 0);
    const largest = names.sort((a, b) => size(b) - size(a)).slice(0, MOST).reverse();
    const shownRows = rows.filter((row) => largest.includes(row.variable) && row.push_of_1_percent_deg != null);
    const bars = shownRows.map(({ side, variable: name, push_of_1_percent_deg: change }) => {
        const y = largest.indexOf(name) + (side === 'cb' ? HALF : -HALF);
        return { from: [0, y - HALF], to: [change, y + HALF], class: side, title: `${variable(name)}, ${side.toUpperCase()}: ${withUnit('change_deg', change)}` };
    });
    draw(find('sensitivities'), {
        x: ends(shownRows.map((row) => row.push_of_1_percent_deg), [0]),
        y: [-0.7, Math.max(largest.length, 1) - 0.3],
        xName: 'change_deg',
        yNames: largest.map(variable),
        bars,
        vertical: 0,
    });
    const end = (side) => {
        const { kind, push_angle_deg: push, reason } = rows.find((row) => row.side === side);
        return `${side.toUpperCase()}: ${push == null ? (reason ?? kind) : `${kind} at ${withUnit('push_angle_deg', push, 4)}`}`;
    };
    find('sensitivities-note').textContent = rows.length ? `+1 % of each number at ${withUnit('distance_mm', distance_mm)}; ${end('cb')}; ${end('cf')}` : '';
}

const curveLine = (curve, side, name) =>
    curve.rows.filter((row) => row.side === side && row.push_angle_deg != null).map((row) => [row.distance_mm, row[name]]);

// Draws the detachment curve with measured points, and the residuals of the points below.
export function drawDetachment() {
    if (!known.curve || !state.view) return find('detachment').replaceChildren();
    const name = known.points?.angle ?? 'push_angle_deg';
    const lines = [[known.pinnedCurve, 'pinned'], [known.curve, 'stable']].flatMap(([curve, kind]) =>
        curve ? ['cf', 'cb'].map((side) => ({ points: curveLine(curve, side, name), class: kind })) : []);
    const rows = known.points?.beside.rows ?? [];
    const bars = (value, row) => row.sd_deg && [[row.distance_mm, value - row.sd_deg], [row.distance_mm, value + row.sd_deg]];
    const dots = (key) => rows.filter((row) => row[key] != null).map((row) => ({
        at: [row.distance_mm, row[key]],
        class: 'measured',
        error: bars(row[key], row),
        title: `line ${row.line}: measured ${withUnit('measured_deg', row.measured_deg)}, computed ${withUnit('predicted_deg', row.predicted_deg)}`,
    }));
    const x = state.view.distance;
    // A line of one distance would not be seen.
    const single = lines.filter(({ points }) => points.length === 1).map(({ points: [at], class: kind }) => ({ at, class: kind === 'pinned' ? kind : 'end' }));
    const inView = (points) => points.filter(([at]) => at >= x[0] && at <= x[1]).map(([, y]) => y);
    draw(find('detachment'), {
        x,
        y: ends([...lines.flatMap((line) => inView(line.points)), ...inView(rows.map((row) => [row.distance_mm, row.measured_deg]))], [0]),
        xName: 'distance_mm',
        yName: name,
        lines,
        dots: [...single, ...dots('measured_deg')],
        vertical: state.pointer?.distance,
    });
    find('residual-figure').hidden = !rows.length;
    if (!rows.length) return;
    draw(find('residuals'), {
        x,
        y: ends(rows.flatMap((row) => [row.residual_deg - (row.sd_deg ?? 0), row.residual_deg + (row.sd_deg ?? 0)]), [0]),
        xName: 'distance_mm',
        yName: 'residual_deg',
        dots: dots('residual_deg'),
        horizontal: 0,
    });
}
