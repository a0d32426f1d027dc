// Plots in SVG: axes with ticks, lines and dots in the units of the axes.

import { svg } from './dom.js';
import { shown } from './text.js';

// Round numbers between the ends of an axis, about `count` of them.
export function ticks([from, to], count) {
    const rough = (to - from) / Math.max(count, 1);
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 2.5, 5, 10].map((part) => part * power).find((own) => own >= rough);
    const first = Math.ceil(from / step - 1e-9);
    const all = [];
    for (let i = first; i * step <= to + 1e-9 * step; i++) all.push(Number((i * step).toPrecision(12)));
    return all;
}

// Powers of ten and their doubles and fivefolds between the ends of a logarithmic axis.
export function logTicks([from, to]) {
    const decades = Math.log10(to / from);
    const parts = decades > 3 ? [1] : decades > 1 ? [1, 3] : [1, 2, 5];
    const all = [];
    for (let power = Math.floor(Math.log10(from)); power <= Math.log10(to); power++) {
        all.push(...parts.map((part) => part * 10 ** power));
    }
    return all.filter((value) => value >= from && value <= to);
}

// The ends of the finite values of an axis, with a margin; `also` lists values that must lie between them.
export function ends(values, also = []) {
    const finite = [...values, ...also].filter(Number.isFinite);
    if (!finite.length) return [0, 1];
    const [least, most] = [Math.min(...finite), Math.max(...finite)];
    const margin = 0.04 * (most - least) || Math.abs(most) || 1;
    return [also.includes(least) ? least : least - margin, most + margin];
}

// Size of text, in pixels.
export const rem = () => parseFloat(getComputedStyle(document.documentElement).fontSize);

const path = (points, place) =>
    points.map(([x, y], i) => `${i ? 'L' : 'M'}${place.x(x).toFixed(2)} ${place.y(y).toFixed(2)}`).join('');

// Draws a plot into an SVG element, which is empty afterwards but for the plot:
// `{ x, y, xTitle, yTitle, yNames, lines: [{ points, class }], bars: [{ from, to, class, title }], dots: [{ at, class, error, title }],
// vertical, horizontal, margin }`. With `yNames`, the places 0, 1, ... of the vertical axis have names.
// Returns the places of values in the element, and back.
export function draw(node, spec) {
    const { width, height } = node.getBoundingClientRect();
    const em = rem();
    const { left, right, top, bottom } = { left: 3.7 * em, right: em, top: 10, bottom: 2.9 * em, ...spec.margin };
    const [w, h] = [Math.max(width - left - right, 10), Math.max(height - top - bottom, 10)];
    const [[x0, x1], [y0, y1]] = [spec.x, spec.y];
    const place = {
        left, top, width: w, height: h,
        x: (value) => ((value - x0) / (x1 - x0)) * w,
        y: (value) => (1 - (value - y0) / (y1 - y0)) * h,
        value: (px, py) => [x0 + ((px - left) / w) * (x1 - x0), y1 - ((py - top) / h) * (y1 - y0)],
    };
    const axes = svg('g', { class: 'axes', transform: `translate(${left} ${top})` });
    for (const value of ticks(spec.x, Math.max(w / 70, 3))) {
        const x = place.x(value);
        axes.append(svg('line', { class: 'grid', x1: x, x2: x, y1: 0, y2: h }), svg('text', { x, y: h + 1.15 * em, 'text-anchor': 'middle' }, shown(value)));
    }
    for (const value of spec.yNames?.keys() ?? ticks(spec.y, h / 45)) {
        const y = place.y(value);
        const label = spec.yNames?.[value] ?? shown(value);
        axes.append(svg('line', { class: 'grid', x1: 0, x2: w, y1: y, y2: y }), svg('text', { x: -7, y: y + 4, 'text-anchor': 'end' }, label));
    }
    axes.append(
        svg('text', { class: 'title', x: w / 2, y: h + 2.45 * em, 'text-anchor': 'middle' }, spec.xTitle),
        svg('text', { class: 'title', transform: `translate(${0.95 * em - left} ${h / 2}) rotate(-90)`, 'text-anchor': 'middle' }, spec.yTitle ?? ''),
    );
    // A nested element cuts off what lies beyond the axes.
    const inside = svg('svg', { x: left, y: top, width: w, height: h, overflow: 'hidden' });
    for (const line of spec.lines ?? []) inside.append(svg('path', { class: `line ${line.class}`, d: path(line.points, place) }));
    for (const { from, to, class: name, title } of spec.bars ?? []) {
        const [xs, ys] = [[from[0], to[0]].map(place.x), [from[1], to[1]].map(place.y)];
        inside.append(svg('rect', { class: `effect ${name}`, x: Math.min(...xs), width: Math.abs(xs[1] - xs[0]), y: Math.min(...ys), height: Math.abs(ys[1] - ys[0]) }, svg('title', {}, title)));
    }
    for (const { at: [x, y], class: name, error, title } of spec.dots ?? []) {
        const [cx, cy] = [place.x(x), place.y(y)];
        if (error) inside.append(svg('path', { class: `line ${name}`, d: path(error, place) }));
        inside.append(svg('circle', { class: `dot ${name}`, cx, cy, r: 3.5 }, ...(title ? [svg('title', {}, title)] : [])));
    }
    const rule = (name, value, ends) => value != null && inside.append(svg('line', { class: `rule ${name}`, ...ends }));
    rule('x', spec.vertical, { x1: place.x(spec.vertical), x2: place.x(spec.vertical), y1: 0, y2: h });
    rule('y', spec.horizontal, { x1: 0, x2: w, y1: place.y(spec.horizontal), y2: place.y(spec.horizontal) });
    const frame = svg('rect', { class: 'frame', x: left, y: top, width: w, height: h });
    node.setAttribute('viewBox', `0 0 ${width} ${height}`);
    node.replaceChildren(axes, inside, frame);
    return place;
}
