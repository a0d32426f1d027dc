// The course of whisking in front of the pole at the pointer's distance: an animation, and the force over time.

import { find, svg } from './dom.js';
import { draw, ends } from './plot.js';
import { change, isCourse, known, on, state } from './state.js';
import { shown } from './text.js';

// Samples of the course for a ms of the animation: a period takes 4 s.
const PER_MS = 0.03;

const LIMITS = 'must be above 0, and at most 180\u00b0 and 1000 Hz';
const [picture, slider] = [find('whisk-shape'), find('whisk-time')];
let [playing, box, refused] = [null, null, ''];

// Shows a new course, or the message why there is none.
export function showCourse(message) {
    const course = (known.whisk = message ? null : known.whisk);
    find('whisk-error').textContent = message || refused;
    find('whisk-note').textContent = course ? `at ${shown(course.distance_mm)} mm, without inertia; detachments lose ${shown(course.lost_nj, 4)} nJ` : '';
    slider.disabled = find('whisk-play').disabled = !course;
    if (course) {
        slider.max = course.samples.length - 1;
        box = [0, 1].map((axis) => {
            const own = course.numbers.filter((value, i) => i % 2 === axis && Number.isFinite(value));
            return [own.reduce((a, b) => Math.min(a, b), 0), own.reduce((a, b) => Math.max(a, b), 0)];
        });
    } else pause();
    drawCourse();
}

// Draws the whisker at the chosen time, and the force over time.
export function drawCourse() {
    if (!known.whisk) {
        for (const id of ['whisk-shape', 'whisk-force', 'whisk-now']) find(id).replaceChildren();
        return;
    }
    const { samples, events } = known.whisk;
    const sample = samples[slider.value];
    const time = ({ time_s }) => 1000 * time_s;
    draw(find('whisk-force'), {
        x: [0, time(samples[samples.length - 1])],
        y: ends([...samples, ...events].map(({ force_un }) => force_un), [0]),
        xTitle: 'Time (ms)',
        yTitle: 'Contact force (\u00b5N)',
        lines: [{ points: samples.filter(({ force_un }) => force_un != null).map((own) => [time(own), own.force_un]), class: 'stable' }],
        dots: events.map((own) => ({ at: [time(own), own.force_un ?? 0], class: /-off$/.test(own.event) ? 'end' : 'touch', title: `${own.event} on ${own.side.toUpperCase()} at ${shown(own.angle_deg)}\u00b0` })),
        vertical: time(sample),
    });
    drawShape(known.whisk);
    const { regime, side, force_un, reason } = sample;
    const words = [regime, side?.toUpperCase(), reason, force_un > 0 && `${shown(force_un, 3)} \u00b5N`].filter(Boolean);
    find('whisk-now').textContent = `${shown(time(sample), 4)} ms, base at ${shown(sample.angle_deg, 3)}\u00b0: ${words.join(', ')}`;
    slider.setAttribute('aria-valuetext', find('whisk-now').textContent);
}

// The whisker of the chosen sample, in the same equal scales for the whole course.
function drawShape({ numbers, points, pole_mm, pole_radius_mm }) {
    const { width, height } = picture.getBoundingClientRect();
    const [[x0, x1], [y0, y1]] = box;
    const scale = 0.92 * Math.min(width / (x1 - x0), height / (y1 - y0));
    const place = (x, y) => [width / 2 + (x - (x0 + x1) / 2) * scale, height / 2 - (y - (y0 + y1) / 2) * scale];
    const first = 2 * points * slider.value;
    const line = Array.from({ length: points }, (_, i) => place(numbers[first + 2 * i], numbers[first + 2 * i + 1]).map((value) => value.toFixed(2)).join(' '));
    const [[cx, cy], [bx, by]] = [place(...pole_mm), place(0, 0)];
    picture.setAttribute('viewBox', `0 0 ${width} ${height}`);
    picture.replaceChildren(
        svg('circle', { class: 'pole', cx, cy, r: Math.max(pole_radius_mm * scale, 2) }),
        ...(Number.isFinite(numbers[first]) ? [svg('path', { class: 'line stable', d: `M${line.join('L')}` })] : []),
        svg('circle', { class: 'base', cx: bx, cy: by, r: 4 }),
    );
}

function pause() {
    cancelAnimationFrame(playing);
    playing = null;
    find('whisk-play').textContent = 'Play';
}

function play() {
    find('whisk-play').textContent = 'Pause';
    let [at, before] = [Number(slider.value), performance.now()];
    const step = (now) => {
        // A reader who moves the slider goes on from there.
        if (Math.floor(at) !== Number(slider.value)) at = Number(slider.value);
        at = (at + (now - before) * PER_MS) % slider.max;
        before = now;
        slider.value = Math.floor(at);
        drawCourse();
        playing = requestAnimationFrame(step);
    };
    playing = requestAnimationFrame(step);
}

export function startWhisk() {
    const fields = { amplitude_deg: find('whisk-amplitude'), frequency_hz: find('whisk-frequency') };
    for (const [name, field] of Object.entries(fields)) {
        field.addEventListener('change', () => {
            const whisk = { ...state.whisk, [name]: Number(field.value) };
            refused = isCourse(whisk) ? '' : `${name} = ${field.value}: ${LIMITS}`;
            if (refused) find('whisk-error').textContent = refused;
            else change({ whisk });
        });
    }
    const show = () => Object.entries(fields).forEach(([name, field]) => (field.value = state.whisk[name]));
    on(['whisk'], show);
    show();
    slider.addEventListener('input', drawCourse);
    find('whisk-play').addEventListener('click', () => (playing ? pause() : play()));
}
