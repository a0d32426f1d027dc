// Tests of the charts at the pointer's distance, whose numbers the program gives too: branches, sensitivities, whisking.

import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { assert, cone, enter, finished, folder, move, near, respond, root, run, sceneText, shownAt, table, until, whiskmap } from './page.mjs';

const DISTANCE = 15.66;

const read = (name) => table(readFileSync(`${folder}/${name}`, 'utf8'));

// Compares columns of a response's rows with those of the program.
function compareRows(own, program, columns) {
    assert(own.length === program.length, `${own.length} rows, ${program.length} by the program`);
    own.forEach((row, i) => {
        for (const column of columns) {
            const [mine, its] = [row[column] ?? '', program[i][column]];
            if (typeof mine === 'number') near(mine, Number(its), `${column} in row ${i}`);
            else assert(String(mine) === its, `${column} in row ${i}: ${mine} on the page, ${its} by the program`);
        }
    });
}

// Distance of a point from a line through points `x, y, x, y, ...`.
function distanceTo([px, py], line) {
    const parts = line.slice(2).flatMap((_, i) => (i % 2 ? [] : [line.slice(i, i + 4)]));
    return Math.min(...parts.map(([x0, y0, x1, y1]) => {
        const [dx, dy] = [x1 - x0, y1 - y0];
        const along = Math.min(Math.max(((px - x0) * dx + (py - y0) * dy) / (dx * dx + dy * dy), 0), 1);
        return Math.hypot(px - x0 - along * dx, py - y0 - along * dy);
    }));
}

const BRANCH = ['stable', 'push_angle_deg', 'arc_length_mm', 'contact_angle_deg', 'force_un', 'base_moment_nnm', 'energy_nj', 'mark'];

// Compares the branches of both sides of a scene with `whiskmap branch`.
async function compareBranches(page, scene, distance = DISTANCE) {
    const { cf, cb } = await respond(page, { branches: { distance_mm: distance, count: 60 } }, sceneText(scene));
    for (const [side, own] of Object.entries({ cf, cb })) {
        compareRows(own.points, table(run('branch', scene, `--distance=${distance}`, '--side', side, '--points=60')), BRANCH);
    }
}

const SENSITIVITY = ['side', 'kind', 'push_angle_deg', 'variable', 'value', 'd_push_deg', 'push_of_1_percent_deg', 'reason'];

// Compares the sensitivities of a scene with `whiskmap sensitivity`.
async function compareSensitivities(page, scene, distance = DISTANCE) {
    const { rows: own } = await respond(page, { sensitivities: { distance_mm: distance } }, sceneText(scene));
    compareRows(own, table(run('sensitivity', scene, `--distance=${distance}`)), SENSITIVITY);
}

export const rows = {
    async 'branches are those of whiskmap branch'(page) {
        await compareBranches(page, cone);
    },

    async 'the unstable state is that of whiskmap shape, and is drawn'(page) {
        const push = 10;
        const { unstable } = await respond(page, { branches: { distance_mm: DISTANCE, push_angle_deg: push, count: 60 } });
        run('shape', cone, `--distance=${DISTANCE}`, `--push-angle=${push}`, '--branch', 'unstable', '--csv', 'whisker.csv', '--state', 'state.csv');
        const [state] = read('state.csv');
        for (const name of ['force_un', 'base_moment_nnm', 'energy_nj']) near(unstable.state[name], Number(state[name]), name);
        const tip = read('whisker.csv').at(-1);
        unstable.points.at(-1).forEach((value, i) => near(value, Number([tip.x_mm, tip.y_mm][i]), 'tip'));
        await move(page, 0.55, 0.6);
        await shownAt(page);
        await until('the unstable state', () => page.locator('#whisker .unstable').count(), (count) => count === 1);
    },

    async 'rest shapes and profiles that share kernels have the rows of the program'(page) {
        for (const name of ['cylinder', 'euler_spiral', 'traced', 'measured', 'fig4_hair']) {
            const scene = `${root}/scenes/${name}.toml`;
            await compareBranches(page, scene, 9);
            await compareSensitivities(page, scene, 9);
        }
    },

    async 'sensitivities are those of whiskmap sensitivity'(page) {
        await compareSensitivities(page, cone);
        const { distance } = await shownAt(page);
        const some = table(run('sensitivity', cone, `--distance=${distance}`)).filter((row) => Number(row.push_of_1_percent_deg) !== 0);
        await until('bars', () => page.locator('#sensitivities .effect').count(), (count) => count === some.length);
    },

    async 'whisking is that of whiskmap whisk'(page) {
        const own = await respond(page, { whisk: { distance_mm: DISTANCE, amplitude_deg: 25, frequency_hz: 10 } });
        const course = ['whisk', cone, `--distance=${DISTANCE}`, '--sine=25,10,0.2', '--rate=1200'];
        run(...course, '--events', 'events.csv', '--csv', 'samples.csv');
        compareRows(own.samples, read('samples.csv'), ['time_s', 'angle_deg', 'regime', 'side', 'push_angle_deg', 'force_un', 'base_moment_nnm', 'energy_nj']);
        compareRows(own.events, read('events.csv'), ['time_s', 'event', 'side', 'angle_deg', 'force_un']);
        const contact = own.samples.findIndex((sample) => sample.side === 'cb');
        run('shape', cone, `--distance=${DISTANCE}`, `--push-angle=${own.samples[contact].push_angle_deg}`, '--csv', 'whisker.csv');
        const tip = read('whisker.csv').at(-1);
        const [x, y] = own.numbers.slice(2 * own.points * (contact + 1) - 2);
        near(x, Number(tip.x_mm), 'tip', 1e-7);
        near(y, Number(tip.y_mm), 'tip', 1e-7);
        // On both sides, the whisker lies on the pole, up to the height of an arc over its chord: 0.0008 mm measured.
        own.samples.forEach((sample, i) => {
            const apart = distanceTo(own.pole_mm, own.numbers.slice(2 * own.points * i, 2 * own.points * (i + 1)));
            const gap = apart - own.pole_radius_mm;
            if (sample.regime === 'contact') assert(Math.abs(gap) < 0.01, `${gap} mm from the pole in sample ${i} on ${sample.side}`);
        });
    },

    async 'the course plays, pauses and scrubs'(page) {
        const time = () => page.$eval('#whisk-time', (own) => Number(own.value));
        await until('events', () => page.locator('#whisk-force .dot').count(), (count) => count > 3);
        await page.click('#whisk-play');
        await until('the animation', time, (value) => value > 5);
        await page.click('#whisk-play');
        const paused = await time();
        assert((await page.textContent('#whisk-play')) === 'Play', 'the button of a paused course');
        await page.focus('#whisk-time');
        await page.keyboard.press('ArrowRight');
        assert((await time()) === paused + 1, `${await time()} after ${paused}`);
        await enter(page, 'whisk-frequency', 20);
        await until('the last time', () => page.$eval('#whisk-now', (own) => own.textContent), (text) => text !== '');
        await enter(page, 'whisk-amplitude', -5);
        const message = () => page.textContent('#error-amplitude_deg');
        await until('a message', message, (text) => text.includes('must be above 0'));
        await enter(page, 'whisk-frequency', 15);
        await until('a course of the other number', () => page.textContent('#whisk-now'), (text) => text !== '');
        assert((await page.inputValue('#whisk-amplitude')) === '-5', 'the refused text has gone');
        // A course of the last valid numbers leaves the message of the field.
        const note = await page.textContent('#whisk-note');
        await page.focus('#plane');
        await page.keyboard.press('Shift+ArrowUp');
        await until('a course elsewhere', () => page.textContent('#whisk-note'), (text) => text !== note);
        assert((await message()).includes('must be above 0'), 'the message has gone');
        await enter(page, 'whisk-amplitude', 25);
        await until('no message', message, (text) => text === '');
    },

    async 'a course that the program refuses shows its message'(page) {
        await enter(page, 'field-friction', 0.2);
        await finished(page, (values) => values.friction === 0.2);
        const { distance } = await shownAt(page);
        const program = spawnSync(whiskmap, ['whisk', '-', `--distance=${distance}`, '--sine=25,10,0.2'], { encoding: 'utf8', input: `${readFileSync(cone, 'utf8')}\n[contact]\nfriction = 0.2\n` });
        const refused = program.status !== 0;
        await until('a message', () => page.textContent('#whisk-error'), (text) => (refused ? text !== '' && program.stderr.includes(text) : text === ''));
        await page.click('#reset');
        await finished(page, (values) => Object.keys(values).length === 0);
    },
};
