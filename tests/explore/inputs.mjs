// Tests of what the page is given, and gives back: fields, links, scenes of one row, commands, units and files.

import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { deflateRawSync } from 'node:zlib';
import { parsed } from './page/field.js';
import { fromLink, link } from './page/link.js';
import { ends, labels, logTicks, ticks } from './page/plot.js';
import { state } from './page/state.js';
import { assert, built, cone, drop, enter, finished, folder, move, near, open, root, run, sceneText, shownAt, table, until, whiskmap } from './page.mjs';

const scene = readFileSync(cone, 'utf8');

// The scene of the cone with other axes.
const withGrid = (push, distance) =>
    scene.replace(/^push_angle_deg = .*$/m, `push_angle_deg = ${push}`).replace(/^distance_mm = .*$/m, `distance_mm = ${distance}`);

// The address of the page with parts of its state.
const address = (parts) => `${built}#${deflateRawSync(JSON.stringify(parts)).toString('base64url')}`;

const whisker = { text: scene, origin: 'cone.toml', values: {} };

const text = (page, id) => page.textContent(`#${id}`);

// Saves a file of the page, and returns its text.
async function saved(page, id) {
    const [download] = await Promise.all([page.waitForEvent('download'), page.click(`#${id}`)]);
    return readFileSync(await download.path(), 'utf8');
}

// Runs the command that the page copies in a shell, with other words after that of the command.
async function copied(page, words = '') {
    // The message of the last copy would end the wait for this one.
    await page.$eval('#saved', (own) => (own.textContent = ''));
    await page.click('#copy-command');
    await until('the copy', () => text(page, 'saved'), (own) => own === 'command copied');
    const command = await page.evaluate(() => navigator.clipboard.readText());
    return execFileSync('bash', ['-c', command.replace(/^whiskmap (\w+)/, `'${whiskmap}' $1 ${words}`)], { cwd: folder, encoding: 'utf8' });
}

export const inputs = {
    async 'a refused field keeps its text and message, and blocks no other field'() {
        const page = await open(built);
        await enter(page, 'field-pole_radius_mm', -1);
        const message = await until('a message', () => text(page, 'error-pole_radius_mm'), Boolean);
        await enter(page, 'field-friction', 'rough');
        await until('another message', () => text(page, 'error-friction'), (own) => own.startsWith('rough: must be a number'));
        await enter(page, 'field-tip_radius_um', 6);
        await finished(page, (values) => values.tip_radius_um === 6);
        assert((await text(page, 'error-pole_radius_mm')) === message && message.includes('pole.radius_mm = -1'), 'the message has moved');
        assert((await page.inputValue('#field-pole_radius_mm')) === '-1', 'the refused text has gone');
        assert((await text(page, 'error-tip_radius_um')) === '', 'a message at a good field');
        await page.click('#copy-link');
        await until('link', () => text(page, 'saved'), (own) => own.includes('link'));
        await page.reload();
        await finished(page, (values) => JSON.stringify(values) === '{"tip_radius_um":6}');
        await page.context().close();
    },

    async 'a link that is damaged says so, and the page goes on'() {
        for (const [link, message] of [
            [`${built}#notalink`, 'The link is damaged. Left out: everything.'],
            [address({ whisker, view: 3, channel: 'constructor', units: { force: 'kg' } }), 'Left out: view, channel, units.'],
            [address({ whisker, pinned: { ...whisker, text: 'title = 1' } }), 'Left out: pinned.'],
            [address({ whisker: { ...whisker, values: { pole_radius_mm: -1 } } }), 'The scene of the link is refused: error: pole.radius_mm = -1'],
            [address({ whisker: { ...whisker, text: 'title = 1' } }), 'The scene of the link is refused: error: '],
        ]) {
            const page = await open(link);
            await until(message, () => text(page, 'failure'), (own) => own.includes(message));
            await enter(page, 'field-tip_radius_um', 6);
            await finished(page, (values) => values.tip_radius_um === 6);
            await page.context().close();
        }
    },

    async 'a browser without the solver says so'() {
        const onStart = () => (WebAssembly.compile = () => Promise.reject(new Error('no WebAssembly')));
        const isReady = (page) => until('the message', () => text(page, 'failure'), (own) => own.includes('cannot start in this browser: no WebAssembly'));
        const page = await open(built, { onStart, isReady });
        assert((await text(page, 'engine')) === '', 'the solver seems to start');
        await page.context().close();
    },

    async 'view and pointer follow the limits of a changed whisker'() {
        const page = await open(address({ whisker, view: { push: [-70, 70], distance: [0.3, 5] }, pointer: { push: 5, distance: 0.5 } }));
        await enter(page, 'field-pole_radius_mm', 1.5);
        await finished(page, (values, _, distance) => values.pole_radius_mm === 1.5 && distance[0] > 1.5);
        assert((await shownAt(page)).distance > 1.5, 'the pointer');
        await page.context().close();
    },

    async 'scenes with one distance or one push angle are drawn'() {
        const page = await open(built);
        const wide = ['{ from = -70, to = 70, count = 512 }', '{ from = 2, to = 20, count = 512 }'];
        for (const [push, distance, size] of [
            [wide[0], '[15]', '256 × 1'],
            ['[10]', wide[1], '1 × 256'],
            ['[10]', '[15]', '1 × 1'],
            [`[10, ${10 + 2e-15}]`, wide[1], '1 × 256'],
        ]) {
            await drop(page, 'row.toml', withGrid(push, distance));
            await until(size, () => text(page, 'engine'), (own) => own.startsWith(`${size} cells`));
            await finished(page);
            const { distance: shown } = await shownAt(page);
            assert(distance !== '[15]' || shown === 15, `${shown} mm`);
            const regime = await page.$$eval('#legend li', (all) => all.map((own) => own.textContent));
            assert(regime.includes('contact'), `${regime}`);
        }
        await drop(page, 'row.toml', withGrid(wide[0], '[15]'));
        await finished(page, (_, push, distance) => push[0] === -70 && distance[0] === 15 && distance[1] === 15);
        await move(page, 0.5, 0.3);
        await page.mouse.wheel(0, -600);
        await finished(page, (_, push, distance) => push[1] - push[0] < 100 && distance[0] === 15);
        assert(table(await saved(page, 'save-csv')).length === 2, 'one end for each side');
        await page.context().close();
    },

    async 'ticks end, and their labels differ'() {
        for (const range of [[10, 10 + 2e-15], [1, 1 + 2 ** -52], [0, 5e-324], [-1e308, 1e308], [5, 5], [0, Infinity]]) {
            assert(ticks(range, 5).length <= 100, `${range}`);
        }
        assert(`${ticks([0, 1], 4)}` === '0,0.25,0.5,0.75,1', `${ticks([0, 1], 4)}`);
        assert(logTicks([1e-320, 1e300]).length <= 20, `${logTicks([1e-320, 1e300])}`);
        for (const range of [[15.66, 15.66003], [10, 10.0001], [-70, 70], [1e-7, 3e-7], [123456, 123457]]) {
            const all = labels(ticks(range, 6));
            assert(new Set(all).size === all.length && all.length > 2, `${all}`);
        }
        const page = await open(address({ whisker, view: { push: [10, 10 + 2e-15], distance: [5, 15] } }));
        await page.context().close();
    },

    async 'a text is one number or none'() {
        for (const [own, value] of [['1.5', 1.5], ['1,5', 1.5], ['0,125', 0.125], ['\u22122e-3', -0.002], [' .5 ', 0.5], ['1000', 1000], ['12,5', 12.5]]) {
            assert(parsed(own) === value, `${own}: ${parsed(own)}`);
        }
        for (const own of ['', '1,000', '12,000', '1,000,000', '1,000.5', '0x10', '1e999', 'Infinity', '1 000', '5mm', '1.2.3']) {
            assert(Number.isNaN(parsed(own)), `${own}: ${parsed(own)}`);
        }
    },

    async 'fields have one rule for numbers, and an ignored range says so'() {
        const page = await open(address({ whisker, channel: 'force_un' }));
        const field = { 'field-length_mm': 'error-length_mm', 'range-from': 'error-range-from', 'whisk-frequency': 'error-frequency_hz' };
        for (const [id, error] of Object.entries(field)) {
            for (const own of ['1,000', '0x10']) {
                await enter(page, id, own);
                await until(`${id} ${own}`, () => text(page, error), (message) => message.startsWith(`${own}: must be a number`));
            }
            await enter(page, id, '19,5');
            await until(`${id} 19,5`, () => text(page, error), (message) => message === '');
        }
        await finished(page, (values) => values.length_mm === 19.5);
        await enter(page, 'range-to', 3);
        await until('ignored', () => text(page, 'legend'), (own) => own.includes('The range is ignored'));
        await enter(page, 'range-to', 30);
        await until('not ignored', () => text(page, 'legend'), (own) => !own.includes('The range is ignored'));
        await page.context().close();
    },

    async 'links hold large scenes and tables, and axes their values'() {
        const digits = (i) => (((i * 7919) % 9973) / 9973).toFixed(4);
        const points = Array.from({ length: 40000 }, (_, i) => `[${i / 2000}, ${digits(i)}]`);
        const rows = Array.from({ length: 130000 }, (_, i) => `cb,${digits(i)},${digits(i + 1)}`);
        for (const parts of [{ whisker: { text: `points = [${points}]`, origin: 'points.toml', values: {} } }, { points: { name: 'rows.csv', csv: rows.join('\n') } }]) {
            Object.assign(state, { whisker, points: null }, parts);
            const { parts: read, bad } = await fromLink(await link());
            assert(bad.length === 0 && JSON.stringify(read) === JSON.stringify(state), `${bad}`);
        }
        Object.assign(state, { points: { name: 'rows.csv', csv: 'x'.repeat(5 << 20) } });
        const refused = await link().catch(({ message }) => message);
        assert(refused === 'the scene is too large for a link', refused);
        const values = Array.from({ length: 300000 }, (_, i) => Number(digits(i)));
        assert(ends(values)[1] > 0.99, `${ends(values)}`);
    },

    async 'a copied command gives what is shown'() {
        writeFileSync(`${folder}/cone.toml`, scene);
        const page = await open(built);
        const compare = async () => {
            await shownAt(page);
            await copied(page, '--state state.csv --csv shape.csv');
            const [state] = table(readFileSync(`${folder}/state.csv`, 'utf8'));
            const force = () => page.$eval('[data-channel="force_un"] td', (cell) => Number(cell.dataset.value));
            await until('the force', force, (own) => Math.abs(own - Number(state.force_un)) < 1e-9 * own);
        };
        await compare();
        await enter(page, 'field-tip_radius_um', 6);
        await finished(page, (values) => values.tip_radius_um === 6);
        await compare();
        await page.click('#reset');
        await finished(page, (values) => Object.keys(values).length === 0);
        await move(page, 0.9, 0.2);
        await until('regime', () => text(page, 'regime'), (own) => own === 'slip-off');
        const end = table(await copied(page)).find((row) => row.side === 'cb').push_angle_deg;
        near(Number((await text(page, 'why')).match(/slipped off at (\S+) deg/)[1]), Number(end), 'slip-off');
        await drop(page, 'sweep.toml', sceneText(`${root}/scenes/morphology.toml`));
        await until('the sweep', () => page.title(), (own) => !own.startsWith('Conical'));
        await finished(page);
        await compare();
        const rows = [['C1', 20], ['none', 'nan'], ['C2', 14]].map(([name, length]) => `{ name = "${name}", length_mm = ${length} }`);
        await drop(page, 'table.toml', `${sceneText(`${root}/scenes/cone.toml`)}\n[whiskers]\ntable = [${rows.join(', ')}]\n`);
        await until('the table', () => page.$$eval('#row option', (all) => all.map((own) => own.textContent).join()), (own) => own === 'C1,C2');
        await finished(page);
        await compare();
        await page.selectOption('#row', 'C2');
        await until('the length', () => page.$eval('#field-length_mm', (field) => field.value), (own) => own === '14');
        await finished(page);
        await move(page, 0.6, 0.2);
        await compare();
        assert((await page.$eval('#row', (own) => own.value)) === 'C2', 'the selected whisker');
        await page.context().close();
    },

    async 'numbers are shown in the chosen units'() {
        const page = await open(address({ whisker, channel: 'force_un' }));
        await page.click('#units-menu');
        const cell = (name) => page.$$eval(`[data-channel="${name}"] td`, (cells) => cells.map((own) => own.textContent));
        const [force] = await cell('force_un');
        for (const [quantity, own] of Object.entries({ force: 'mN', moment: 'N mm', time: 's', length: 'cm' })) await page.selectOption(`#unit-${quantity}`, own);
        const [inMn, unit] = await cell('force_un');
        assert(unit === 'mN', unit);
        near(1000 * Number(inMn), Number(force), 'force', 1e-4);
        assert((await cell('base_moment_nnm'))[1] === 'N mm', 'moment');
        assert((await text(page, 'whisk-force')).includes('Time (s)') && (await text(page, 'force')).includes('Contact force (mN)'), 'axes');
        assert((await text(page, 'plane')).includes('Distance at first touch (cm)') && (await text(page, 'legend')).includes('Contact force (mN)'), 'map');
        await until('the words', () => text(page, 'spoken'), (words) => words.includes('millinewtons') && words.includes('centimetres'));
        assert((await page.getAttribute('.bar', 'aria-label')).includes('millinewtons'), 'the bar');
        assert((await page.getAttribute('#whisk-time', 'aria-valuetext')).includes('seconds'), 'the slider');
        // A range is in the unit that is shown.
        await enter(page, 'range-to', '0.01');
        await until('the bar', () => page.getAttribute('.bar', 'aria-label'), (words) => words.endsWith('to 0.01 millinewtons'));
        await page.context().close();
    },

    async 'a picture waits for the finished map'() {
        const page = await open(built);
        const atSave = await page.evaluate(() => new Promise((resolve) => {
            HTMLAnchorElement.prototype.click = () => resolve(document.getElementById('engine').dataset.drawn);
            const field = document.getElementById('field-length_mm');
            field.value = '17';
            field.dispatchEvent(new Event('change'));
            setTimeout(() => document.getElementById('save-png').click(), 20);
        }));
        const [isDraft, values] = JSON.parse(atSave);
        assert(!isDraft && values.length_mm === 17, atSave);
        await page.context().close();
    },

    async 'a map that takes long begins with a draft'() {
        const onStart = () => {
            const { addEventListener } = Worker.prototype;
            Worker.prototype.addEventListener = function (kind, receive) {
                addEventListener.call(this, kind, (event) => {
                    if (window.takes && event.data?.ms) event.data.ms = window.takes;
                    receive(event);
                });
            };
        };
        const page = await open(built, { onStart });
        const change = async (ms, length) => {
            await page.evaluate((ms) => {
                window.takes = ms;
                window.drawn = [];
                const observer = new MutationObserver(() => window.drawn.push(document.getElementById('engine').dataset.drawn));
                observer.observe(document.getElementById('engine'), { attributes: true });
            }, ms);
            await enter(page, 'field-length_mm', length);
            await finished(page, (values) => values.length_mm === length);
            return page.evaluate(() => window.drawn.some((own) => JSON.parse(own)[0]));
        };
        // The time of one map decides whether the next one has a draft.
        await change(10, 16);
        assert(!(await change(200, 17)), 'a quick map');
        assert(await change(10, 18), 'a slow map');
        assert(!(await change(10, 19)), 'a map that is quick again');
        await page.context().close();
    },

    async 'the force over time passes through the events'() {
        const page = await open(address({ whisker, pointer: { push: 5, distance: 15.66 } }));
        await until('events', () => page.locator('#whisk-force .dot.end').count(), (count) => count > 0);
        const { line, dots } = await page.evaluate(() => ({
            line: document.querySelector('#whisk-force .line').getAttribute('d').split(/[ML]/).slice(1).map((own) => own.split(' ').map(Number)),
            dots: [...document.querySelectorAll('#whisk-force .dot')].map((own) => [own.cx.baseVal.value, own.cy.baseVal.value]),
        }));
        for (const [x, y] of dots) {
            const apart = Math.min(...line.map(([px, py]) => Math.hypot(px - x, py - y)));
            assert(apart < 0.02, `${apart} pixels from an event`);
        }
        await page.context().close();
    },

    async 'saved files have short numbers and the columns of the program'() {
        const page = await open(built);
        await enter(page, 'field-taper', 0.7);
        await finished(page, (values) => values.taper === 0.7);
        const own = await saved(page, 'save-toml');
        // 30 (1 - 0.7) is 9.000000000000002.
        assert(own.includes('tip_radius_um = 9.0 '), own);
        const head = run('curve', cone).split('\n')[0];
        assert((await saved(page, 'save-csv')).split('\n')[0] === head, head);
        await page.context().close();
    },

    async 'texts neither collide nor are cut off'() {
        const long = withGrid('{ from = -70, to = 70, count = 64 }', '{ from = 2000, to = 20000, count = 64 }').replace(/^length_mm = 20.0/m, 'length_mm = 20000.0');
        const deep = { push: [10, 10.0002], distance: [15.66, 15.6601] };
        for (const size of [[380, 800], [1280, 900], [2560, 1440]]) {
            for (const [view, text] of [[null, scene], [deep, scene], [null, long]]) {
                const pointer = { push: 10, distance: view?.distance[0] ?? 12 };
                const page = await open(address({ whisker: { ...whisker, text }, view, channel: 'force_un', pointer }), { size });
                await until('the course', () => page.locator('#whisk-force path').count(), (count) => count > 0);
                await until('bars', () => page.locator('#sensitivities .effect').count(), (count) => count > 0);
                const bad = await page.evaluate(textsInTheWay);
                assert(bad.length === 0, `${size} ${JSON.stringify(view)}: ${bad.join('; ')}`);
                await page.context().close();
            }
        }
    },

    async 'fields show six digits'() {
        for (const size of [[380, 800], [1280, 900], [2560, 1440]]) {
            const page = await open(built, { size });
            for (const [id, own] of [['field-length_mm', '19.8765'], ['field-vertex_mm', '\u22120.123456'], ['range-from', '0.123456'], ['whisk-frequency', '12.3456']]) {
                await page.selectOption('#channel', 'force_un');
                await page.fill(`#${id}`, own);
                const [inner, outer] = await page.$eval(`#${id}`, (field) => [field.scrollWidth, field.clientWidth]);
                assert(inner <= outer, `${id} of ${outer} pixels for ${inner}`);
            }
            await page.context().close();
        }
    },

    async 'on a narrow screen a slider is seen with the map'() {
        const page = await open(built, { size: [380, 800] });
        for (const name of ['taper', 'length_mm', 'friction']) {
            const slider = page.locator(`.control:has(#field-${name}) input[type=range]`);
            await slider.evaluate((own) => scrollTo(0, own.getBoundingClientRect().top + scrollY - 0.85 * innerHeight));
            const seen = await slider.evaluate((own) => {
                const [box, map] = [own, document.querySelector('#plane')].map((node) => node.getBoundingClientRect());
                const isFree = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2) === own;
                return isFree && map.top >= 0 && map.bottom <= box.top && document.elementFromPoint(map.x + map.width / 2, map.y + map.height / 2).closest('#plane') !== null;
            });
            assert(seen, name);
        }
        await page.context().close();
    },
};

// Runs in the page: texts of plots that overlap each other, or leave their plot.
function textsInTheWay() {
    const bad = [];
    for (const plot of document.querySelectorAll('#plane > svg, figure svg, #whisker, .bar')) {
        const frame = plot.getBoundingClientRect();
        const texts = [...plot.querySelectorAll('text')].map((node) => [node.textContent, node.getBoundingClientRect()]).filter(([own]) => own);
        texts.forEach(([own, box], i) => {
            const isOut = box.left < frame.left - 1 || box.right > frame.right + 1 || box.top < frame.top - 4 || box.bottom > frame.bottom + 4;
            if (isOut && !plot.matches('.bar')) bad.push(`${plot.id} cuts off ${own}`);
            if (plot.matches('.bar') && (box.left < 0 || box.right > innerWidth)) bad.push(`the window cuts off ${own}`);
            for (const [other, at] of texts.slice(i + 1)) {
                const isApart = box.right <= at.left + 1 || at.right <= box.left + 1 || box.bottom <= at.top + 4 || at.bottom <= box.top + 4;
                if (!isApart) bad.push(`${plot.id}: ${own} is on ${other}`);
            }
        });
    }
    return bad;
}
