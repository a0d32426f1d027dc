// The course of whisking in front of the pole at the pointer's distance: an animation, and the force over time.

import { find, svg } from './dom.js';
import { startField } from './field.js';
import { draw, ends } from './plot.js';
import { COURSE, change, known, on, state } from './state.js';
import { shown, spoken, withUnit } from './text.js';

// Samples of the course for a ms of the animation: a period takes 4 s.
const PER_MS = 0.03;

const [picture, slider] = [find('whisk-shape'), find('whisk-time')];
let [playing, box] = [null, null];

// Shows a new course, or the message why there is none.
export function showCourse(message) {
    const course = (known.whisk = message ? null : known.whisk);
    find('whisk-error').textContent = message;
    find('whisk-note').textContent = course ? `at ${withUnit('distance_mm', course.distance_mm)}, without inertia; detachments lose ${withUnit('lost_nj', course.lost_nj, 4)}` : '';
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

// The force over time through the events: as `plot` in `src/render/courses.rs`.
function forceLine({ samples, events }) {
    let next = 0;
    return samples.flatMap(({ time_s, force_un, regime }) => {
        const own = [];
        for (; next < events.length && events[next].time_s <= time_s; next++) own.push([events[next].time_s, events[next].force_un]);
        if (own.length && regime === 'free') own.push([own[own.length - 1][0], 0]);
        return [...own, [time_s, force_un]];
    });
}

// Draws the whisker at the chosen time, and the force over time.
export function drawCourse() {
    if (!known.whisk) {
        for (const id of ['whisk-shape', 'whisk-force', 'whisk-now']) find(id).replaceChildren();
        return;
    }
    const { samples, events } = known.whisk;
    const sample = samples[slider.value];
    draw(find('whisk-force'), {
        x: [0, samples[samples.length - 1].time_s],
        y: ends([...samples, ...events].map(({ force_un }) => force_un), [0]),
        xName: 'time_s',
        yName: 'force_un',
        lines: [{ points: forceLine(known.whisk), class: 'stable' }],
        dots: events.map((own) => ({ at: [own.time_s, own.force_un ?? 0], class: /-off$/.test(own.event) ? 'end' : 'touch', title: `${own.event} on ${own.side.toUpperCase()} at ${withUnit('angle_deg', own.angle_deg)}` })),
        vertical: sample.time_s,
    });
    drawShape(known.whisk);
    const { regime, side, force_un, reason } = sample;
    const words = [regime, side?.toUpperCase(), reason, force_un > 0 && withUnit('force_un', force_un, 3)].filter(Boolean);
    find('whisk-now').textContent = `${withUnit('time_s', sample.time_s, 4)}, base at ${withUnit('angle_deg', sample.angle_deg, 3)}: ${words.join(', ')}`;
    const force = force_un > 0 ? `, ${spoken('force_un', force_un, 3)}` : '';
    slider.setAttribute('aria-valuetext', `${spoken('time_s', sample.time_s, 4)}, base at ${spoken('angle_deg', sample.angle_deg, 3)}: ${words.slice(0, force ? -1 : undefined).join(', ')}${force}`);
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
    const entries = Object.entries(fields).map(([name, field]) => {
        const entry = startField(field, find(`error-${name}`), (value) => {
            if (!(value > 0 && value <= COURSE[name])) return `${name} = ${shown(value)}: must be above 0 and at most ${COURSE[name]}`;
            change({ whisk: { ...state.whisk, [name]: value } });
            return '';
        });
        return () => entry.show(shown(state.whisk[name], 6));
    });
    const show = () => entries.forEach((entry) => entry());
    on(['whisk'], show);
    show();
    slider.addEventListener('input', drawCourse);
    find('whisk-play').addEventListener('click', () => (playing ? pause() : play()));
}
