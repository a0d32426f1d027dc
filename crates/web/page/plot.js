// Plots in SVG: axes with ticks, lines and dots in the units of the data; the ticks have the units that the reader has chosen.

import { svg } from './dom.js';
import { shown, sizeOf, titled } from './text.js';

// Most ticks of an axis. A range that doubles cannot divide has fewer than it wants.
const MOST_TICKS = 100;

// More dots than this, such as those of a whole file, are drawn as one path, without titles, at whole pixels, each once.
const MOST_DOTS = 2000;

// Round numbers between the ends of an axis, about `count` of them.
export function ticks([from, to], count) {
    const rough = (to - from) / Math.max(count, 1);
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 2.5, 5, 10].map((part) => part * power).find((own) => own >= rough);
    const first = Math.ceil(from / step - 1e-9);
    const last = Math.floor(to / step + 1e-9);
    if (!Number.isSafeInteger(first) || !Number.isSafeInteger(last)) return [from];
    const length = Math.min(last - first + 1, MOST_TICKS);
    return Array.from({ length }, (_, i) => Number(((first + i) * step).toPrecision(12)));
}

// Powers of ten and their threefolds, or doubles and fivefolds, between the ends of a logarithmic axis, at most about ten.
export function logTicks([from, to]) {
    const [low, high] = [from, to].map(Math.log10);
    const parts = high - low > 3 ? [1] : high - low > 1 ? [1, 3] : [1, 2, 5];
    const every = Math.ceil((high - low) / 10) || 1;
    const powers = Array.from({ length: Math.floor((high - low) / every) + 2 }, (_, i) => 10 ** ((Math.floor(low / every) + i) * every));
    return powers.flatMap((power) => parts.map((part) => part * power)).filter((value) => value >= from && value <= to);
}

// Labels of the ticks of an axis: neighbours differ.
export function labels(values) {
    const most = values.reduce((own, value) => Math.max(own, Math.abs(value)), 0);
    const digits = values.length > 1 ? Math.ceil(Math.log10(most / (values[1] - values[0]))) + 2 : 12;
    return values.map((value) => shown(value, Math.min(Math.max(digits, 5), 15)));
}

// Ticks of an axis with the numbers of a name, in the reader's unit: `{ value, label }`, at values in the unit of the data.
function marks([from, to], count, name) {
    const values = from < to ? ticks([from / sizeOf(name), to / sizeOf(name)], count) : [from / sizeOf(name)];
    const all = labels(values);
    return values.map((value, i) => ({ value: value * sizeOf(name), label: all[i] }));
}

// The ends of the finite values of an axis, with a margin; `also` lists values that must lie between them.
export function ends(values, also = []) {
    const finite = [...values, ...also].filter(Number.isFinite);
    if (!finite.length) return [0, 1];
    const [least, most] = [finite.reduce((a, b) => Math.min(a, b)), finite.reduce((a, b) => Math.max(a, b))];
    const margin = 0.04 * (most - least) || Math.abs(most) || 1;
    return [also.includes(least) ? least : least - margin, most + margin];
}

// What an axis shows: around a single value, as much on both sides.
export const extent = ([from, to]) => (from < to ? [from, to] : [from - (Math.abs(from) / 20 || 1), from + (Math.abs(from) / 20 || 1)]);

// Size of text, in pixels.
const rem = () => parseFloat(getComputedStyle(document.documentElement).fontSize);

let pen;

// Width of the widest of some texts of a plot, in pixels.
export function widest(texts) {
    pen ??= document.createElement('canvas').getContext('2d');
    pen.font = `${0.86 * rem()}px ${getComputedStyle(document.body).fontFamily}`;
    return texts.reduce((own, text) => Math.max(own, pen.measureText(text).width), 0);
}

// A path through points; it breaks at points without a value.
const path = (points, place) =>
    points.map(([x, y], i) => (y == null ? '' : `${i && points[i - 1][1] != null ? 'L' : 'M'}${place.x(x).toFixed(2)} ${place.y(y).toFixed(2)}`)).join('');

// The title of an axis, at the middle of the axis if it fits between two ends there. A longer one is narrowed.
function titleOf(text, [from, to], middle, placed) {
    const [length, most] = [widest([text]), to - from];
    const at = Math.min(Math.max(middle, from + length / 2), to - length / 2);
    const own = length > most ? { ...placed((from + to) / 2), textLength: most, lengthAdjust: 'spacingAndGlyphs' } : placed(at);
    return svg('text', { class: 'title', 'text-anchor': 'middle', ...own }, text);
}

// Draws a plot into an SVG element, which is empty afterwards but for the plot:
// `{ x, y, xName, yName, xTitle, yNames, lines: [{ points, class }], bars: [{ from, to, class, title }], dots: [{ at, class, error, title }],
// vertical, horizontal }`. The names of the axes give their units, and their titles without `xTitle`. With `yNames`, the places 0, 1, ... of
// the vertical axis have names. Returns the places of values in the element, and back.
export function draw(node, spec) {
    const { width, height } = node.getBoundingClientRect();
    const em = rem();
    const [top, bottom] = [10, 2.9 * em];
    const h = Math.max(height - top - bottom, 10);
    const yMarks = spec.yNames?.map((label, value) => ({ value, label })) ?? marks(spec.y, h / 45, spec.yName);
    const left = Math.max(3.7 * em, widest(yMarks.map(({ label }) => label)) + 12 + (spec.yNames ? 0 : 1.4 * em));
    const most = Math.max((width - left) / 70, 3);
    const wide = (own) => widest(own.map(({ label }) => label));
    const fewer = Math.min(most, (width - left) / (wide(marks(spec.x, most, spec.xName)) + 12));
    const xMarks = marks(spec.x, fewer, spec.xName);
    const right = Math.max(em, wide(xMarks) / 2 + 2);
    const w = Math.max(width - left - right, 10);
    const [[x0, x1], [y0, y1]] = [extent(spec.x), extent(spec.y)];
    const place = {
        left, top, width: w, height: h,
        x: (value) => ((value - x0) / (x1 - x0)) * w,
        y: (value) => (1 - (value - y0) / (y1 - y0)) * h,
        value: (px, py) => [x0 + ((px - left) / w) * (x1 - x0), y1 - ((py - top) / h) * (y1 - y0)],
    };
    const axes = svg('g', { class: 'axes', transform: `translate(${left} ${top})` });
    for (const { value, label } of xMarks) {
        const x = place.x(value);
        axes.append(svg('line', { class: 'grid', x1: x, x2: x, y1: 0, y2: h }), svg('text', { x, y: h + 1.15 * em, 'text-anchor': 'middle' }, label));
    }
    for (const { value, label } of yMarks) {
        const y = place.y(value);
        axes.append(svg('line', { class: 'grid', x1: 0, x2: w, y1: y, y2: y }), svg('text', { x: -7, y: y + 4, 'text-anchor': 'end' }, label));
    }
    axes.append(titleOf(spec.xTitle ?? titled(spec.xName), [-left, w + right], w / 2, (x) => ({ x, y: h + 2.45 * em })));
    if (!spec.yNames) axes.append(titleOf(titled(spec.yName), [-top, h + bottom], h / 2, (y) => ({ transform: `translate(${0.95 * em - left} ${y}) rotate(-90)` })));
    // A nested element cuts off what lies beyond the axes.
    const inside = svg('svg', { x: left, y: top, width: w, height: h, overflow: 'hidden' });
    for (const line of spec.lines ?? []) inside.append(svg('path', { class: `line ${line.class}`, d: path(line.points, place) }));
    for (const { from, to, class: name, title } of spec.bars ?? []) {
        const [xs, ys] = [[from[0], to[0]].map(place.x), [from[1], to[1]].map(place.y)];
        inside.append(svg('rect', { class: `effect ${name}`, x: Math.min(...xs), width: Math.abs(xs[1] - xs[0]), y: Math.min(...ys), height: Math.abs(ys[1] - ys[0]) }, svg('title', {}, title)));
    }
    const dots = spec.dots ?? [];
    if (dots.length > MOST_DOTS) {
        const places = new Set(dots.map(({ at: [x, y] }) => `M${Math.round(place.x(x))} ${Math.round(place.y(y))}h0`));
        inside.append(svg('path', { class: 'dots', d: [...places].join('') }));
    } else for (const { at: [x, y], class: name, error, title } of dots) {
        if (error) inside.append(svg('path', { class: `line ${name}`, d: path(error, place) }));
        inside.append(svg('circle', { class: `dot ${name}`, cx: place.x(x), cy: place.y(y), r: 3.5 }, ...(title ? [svg('title', {}, title)] : [])));
    }
    const rule = (name, value, at) => value != null && inside.append(svg('line', { class: `rule ${name}`, ...at }));
    rule('x', spec.vertical, { x1: place.x(spec.vertical), x2: place.x(spec.vertical), y1: 0, y2: h });
    rule('y', spec.horizontal, { x1: 0, x2: w, y1: place.y(spec.horizontal), y2: place.y(spec.horizontal) });
    const frame = svg('rect', { class: 'frame', x: left, y: top, width: w, height: h });
    node.setAttribute('viewBox', `0 0 ${width} ${height}`);
    node.replaceChildren(axes, inside, frame);
    return place;
}
