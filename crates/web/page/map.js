// The map: its cells on a canvas, axes, boundary and points above them, zoom, and the place of the pointer.

import { blank, blankPixel, css, hatched, isDark, regimeColour, regimePixels, scaleOf, stripesOf } from './colours.js';
import { el, find, svg } from './dom.js';
import { draw, extent, labels, logTicks, ticks, widest } from './plot.js';
import { change, fitted, known, on, state } from './state.js';
import { inUnit, isLoad, sizeOf, spoken, titled, unit, withUnit } from './text.js';

const plane = find('plane');
const [canvas, overlay] = plane.children;
const cells = document.createElement('canvas');
let place, image, scale, drag, hasMarks;
const touches = new Map();

// Draws a new map.
export function drawMap() {
    paint();
    drawPlane();
    drawLegend();
}

// The cells of the map as pixels, the greatest distance on top.
function paint() {
    const { size: [width, height], numbers, channel } = known.map;
    const count = width * height;
    const values = channel ? numbers.subarray(2 * count) : null;
    scale = values && scaleOf(values, state.scale, state.range, isLoad(channel));
    const picture = new ImageData(width, height);
    const pixels = new Uint32Array(picture.data.buffer);
    const [none, ofRegime] = [blankPixel(), regimePixels()];
    const marked = known.scene?.state_channels.includes(channel) ? known.scene.marks : [];
    const isMarked = (cell) => marked.includes(numbers[count + cell]);
    const ofValue = (cell, x, y) => {
        if (!scale) return none;
        const own = scale.pixel(values[cell]);
        return isMarked(cell) ? hatched(own, x, y) : own;
    };
    hasMarks = marked.length > 0 && numbers.subarray(count, 2 * count).some((code) => marked.includes(code));
    const colour = values ? ofValue : (cell, x, y) => ofRegime(numbers[cell], x, y);
    for (let row = 0; row < height; row++) {
        const from = (height - 1 - row) * width;
        for (let column = 0; column < width; column++) pixels[from + column] = colour(row * width + column, column, row);
    }
    cells.width = width;
    cells.height = height;
    cells.getContext('2d').putImageData(picture, 0, 0);
    // The first and last cells are centred on the ends; a single one fills the axis.
    const around = ([from, to], count) => (count > 1 ? [from - (to - from) / (count - 1) / 2, to + (to - from) / (count - 1) / 2] : extent([from, to]));
    image = { push: around(known.map.push_angle_deg, width), distance: around(known.map.distance_mm, height) };
}

// The detachments of one side as a line of the map, across the map if it has one distance.
function boundary(curve, side) {
    const points = curve.rows.filter((row) => row.side === side && row.push_angle_deg != null).map((row) => [row.push_angle_deg, row.distance_mm]);
    return points.length === 1 ? extent(state.view.distance).map((end) => [points[0][0], end]) : points;
}

const boundaries = (curve, name) => (curve ? ['cf', 'cb'].map((side) => ({ points: boundary(curve, side), class: name })) : []);

// The axes and what lies above the cells, and the cells at their places.
export function drawPlane() {
    if (!state.view) return;
    const { push, distance } = state.view;
    const isPush = known.points?.angle !== 'push_chord_deg';
    const measured = isPush ? (known.points?.beside.rows ?? []) : [];
    place = draw(overlay, {
        x: push,
        y: distance,
        xTitle: plane.clientWidth > 600 ? `Push angle since first touch (${unit('push_deg')}): pole on the concave side (CF) < 0 < convex side (CB)` : `Push angle (${unit('push_deg')}): CF < 0 < CB`,
        xName: 'push_angle_deg',
        yName: 'distance_mm',
        lines: [...boundaries(known.pinnedCurve, 'pinned casing'), ...boundaries(known.pinnedCurve, 'pinned'), ...boundaries(known.curve, 'casing'), ...boundaries(known.curve, 'edge')],
        dots: measured.map((row) => ({
            at: [row.measured_deg, row.distance_mm],
            class: 'measured',
            error: row.sd_deg ? [[row.measured_deg - row.sd_deg, row.distance_mm], [row.measured_deg + row.sd_deg, row.distance_mm]] : null,
            title: `${row.side.toUpperCase()}, ${withUnit('distance_mm', row.distance_mm)}: measured ${withUnit('measured_deg', row.measured_deg)}, computed ${withUnit('predicted_deg', row.predicted_deg)}`,
        })),
    });
    overlay.append(svg('g', { class: 'cross' }), svg('rect', { class: 'box', width: 0, height: 0 }));
    drawCross();
    const { width, height } = plane.getBoundingClientRect();
    const ratio = devicePixelRatio;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    if (!image) return;
    const context = canvas.getContext('2d');
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.beginPath();
    context.rect(place.left, place.top, place.width, place.height);
    context.clip();
    context.fillStyle = css(blank());
    context.fillRect(place.left, place.top, place.width, place.height);
    context.imageSmoothingEnabled = false;
    const [x0, x1] = image.push.map((value) => place.left + place.x(value));
    const [y1, y0] = image.distance.map((value) => place.top + place.y(value));
    context.drawImage(cells, x0, y0, x1 - x0, y1 - y0);
}

// The cross at the pointer.
export function drawCross() {
    const { pointer } = state;
    const cross = overlay.querySelector('.cross');
    if (!pointer || !cross) return;
    plane.dataset.pointer = JSON.stringify(pointer);
    const [x, y] = [place.left + place.x(pointer.push), place.top + place.y(pointer.distance)];
    const [right, bottom] = [place.left + place.width, place.top + place.height];
    const isInside = x >= place.left && x <= right && y >= place.top && y <= bottom;
    const lines = isInside ? [{ x1: x, x2: x, y1: place.top, y2: bottom }, { x1: place.left, x2: right, y1: y, y2: y }] : [];
    cross.replaceChildren(...lines.map((line) => svg('line', line)), ...(isInside ? [svg('circle', { cx: x, cy: y, r: 4.5 })] : []));
}

function drawLegend() {
    const { channel, numbers, size } = known.map;
    const stripe = (colour, x) => svg('path', { d: `M${x} 9L${x + 9} 0h4L${x + 4} 9Z`, fill: colour });
    const entry = (colour, name, stripes) => el('li', {}, svg('svg', { class: 'swatch', viewBox: '0 0 18 9' }, svg('rect', { width: 18, height: 9, fill: colour }), ...(stripes ? [-6, 3, 12].map((x) => stripe(stripes, x)) : [])), name);
    if (!channel) {
        const codes = new Set(numbers.subarray(0, size[0] * size[1]));
        const present = known.scene?.regimes.filter(({ code }) => codes.has(code)) ?? [];
        find('legend').replaceChildren(...present.map(({ code, name }) => entry(css(regimeColour(code)), name, stripesOf(code))));
        return;
    }
    if (!scale) {
        find('legend').replaceChildren(el('li', {}, 'No colours: the values are equal, or not above 0 on a logarithmic scale.'));
        return;
    }
    const bar = svg('svg', { class: 'bar', viewBox: '0 0 320 34', role: 'img', 'aria-label': `${titled(channel)} from ${spoken(channel, scale.from)} to ${spoken(channel, scale.to)}` });
    for (let i = 0; i < 80; i++) bar.append(svg('rect', { x: 25 + i * 3.375, y: 0, width: 4, height: 14, fill: css(scale.colour(i / 79)) }));
    const ends = [scale.from, scale.to].map((value) => value / sizeOf(channel));
    const marks = scale.isLog ? logTicks(ends) : ticks(ends, 5);
    const texts = scale.isLog ? marks.map((value) => labels([value])[0]) : labels(marks);
    let free = 0;
    marks.forEach((value, i) => {
        const [x, half] = [25 + 270 * scale.part(value * sizeOf(channel)), widest([texts[i]]) / 2];
        bar.append(svg('line', { x1: x, x2: x, y1: 14, y2: 18 }), ...(x - half < free ? [] : [svg('text', { x, y: 30, 'text-anchor': 'middle' }, texts[i])]));
        if (x - half >= free) free = x + half + 4;
    });
    const ignored = `The range is ignored: its ends must grow${scale.isLog ? ', and be above 0' : ''}.`;
    find('legend').replaceChildren(...(scale.isIgnored ? [el('li', { class: 'error', role: 'alert' }, ignored)] : []), el('li', {}, titled(channel)), el('li', {}, bar), entry(css(blank()), 'no contact'), ...(hasMarks ? [entry(css(blank()), 'slides to base, or sticks', isDark() ? '#fff' : '#000')] : []));
}

// Zooms by a factor around a place.
function zoom(factor, [push, distance]) {
    if (!state.view) return;
    const around = ([from, to], at) => [at + (from - at) * factor, at + (to - at) * factor];
    setView(around(state.view.push, push), around(state.view.distance, distance));
}

// Shows a part of the map, within what the solver allows.
function setView(push, distance) {
    const view = fitted({ push, distance });
    if (view) change({ view });
}

const at = (event) => {
    const box = overlay.getBoundingClientRect();
    return place.value(event.clientX - box.left, event.clientY - box.top);
};

// Moves the pointer, within the view.
function point(push, distance) {
    if (!state.view) return;
    const within = (value, [from, to]) => Math.min(Math.max(value, from), to);
    // Six digits are finer than pixels, and people can copy them.
    const rounded = (value, ends) => within(Number(value.toPrecision(6)), ends);
    change({ pointer: { push: rounded(push, state.view.push), distance: rounded(distance, state.view.distance) } });
}

function moved(event) {
    if (touches.has(event.pointerId)) touches.set(event.pointerId, event);
    if (touches.size === 2) return pinch();
    const [push, distance] = at(event);
    if (drag) {
        drag.end = [push, distance];
        const [[p0, d0], [p1, d1]] = [drag.start, drag.end];
        const [x0, x1, y0, y1] = [place.x(p0), place.x(p1), place.y(d0), place.y(d1)];
        const box = { x: place.left + Math.min(x0, x1), y: place.top + Math.min(y0, y1), width: Math.abs(x1 - x0), height: Math.abs(y1 - y0) };
        drag.isBox = Math.min(box.width, box.height) > 6;
        for (const [name, value] of Object.entries(box)) overlay.querySelector('.box').setAttribute(name, drag.isBox ? value : 0);
    }
    point(push, distance);
}

function pinch() {
    const [a, b] = [...touches.values()];
    const apart = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
    const [[p0, d0], [p1, d1]] = [at(a), at(b)];
    if (drag?.apart) zoom(drag.apart / apart, [(p0 + p1) / 2, (d0 + d1) / 2]);
    drag = { apart };
}

function released(event) {
    touches.delete(event.pointerId);
    const own = drag;
    drag = null;
    if (!own?.isBox) return;
    const sorted = (i) => [own.start[i], own.end[i]].sort((a, b) => a - b);
    setView(sorted(0), sorted(1));
}

const KEYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

function pressed(event) {
    if (!state.view) return;
    const { push, distance } = state.view;
    const step = event.shiftKey ? 0.05 : 0.004;
    const here = state.pointer ?? { push: (push[0] + push[1]) / 2, distance: (distance[0] + distance[1]) / 2 };
    const move = KEYS[event.key];
    if (move) point(here.push + move[0] * step * (push[1] - push[0]), here.distance + move[1] * step * (distance[1] - distance[0]));
    else if (event.key === '+' || event.key === '=') zoom(0.7, [here.push, here.distance]);
    else if (event.key === '-') zoom(1 / 0.7, [here.push, here.distance]);
    else if (event.key === '0') change({ view: known.whole });
    else return;
    event.preventDefault();
}

// Starts to listen to pointer, wheel, keys, and changes of the size.
export function startMap() {
    plane.addEventListener('pointermove', (event) => place && moved(event));
    plane.addEventListener('pointerdown', (event) => {
        if (!place) return;
        plane.setPointerCapture(event.pointerId);
        if (event.pointerType === 'touch') touches.set(event.pointerId, event);
        else drag = { start: at(event), end: at(event) };
        moved(event);
    });
    for (const name of ['pointerup', 'pointercancel']) plane.addEventListener(name, released);
    plane.addEventListener('dblclick', () => change({ view: known.whole }));
    plane.addEventListener('wheel', (event) => {
        event.preventDefault();
        if (place) zoom(1.0015 ** event.deltaY, at(event));
    }, { passive: false });
    plane.addEventListener('keydown', (event) => place && pressed(event));
    new ResizeObserver(drawPlane).observe(plane);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => known.map && drawMap());
    on(['view'], drawPlane);
    on(['pointer'], drawCross);
    on(['scale', 'range', 'units'], () => known.map && drawMap());
}
