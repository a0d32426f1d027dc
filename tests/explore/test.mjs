// Tests of the page of `whiskmap explore`; see run.sh.

import { readFileSync, writeFileSync } from 'node:fs';
import { gestures } from './gestures.mjs';
import { assert, built, close, compareState, cone, drop, faults, finished, folder, move, near, open, only, respond, root, run, shownAt, table, until } from './page.mjs';
import { inputs } from './inputs.mjs';
import { rows } from './rows.mjs';
import { times } from './times.mjs';

const tests = {
    async 'the page shows the map, and states as whiskmap shape'(page) {
        assert((await page.title()).startsWith('Conical mouse whisker'), 'title');
        await compareState(page, cone);
        await move(page, 0.5, 0.6);
        await until('regime', () => page.textContent('#regime'), (text) => text === 'contact');
        await compareState(page, cone);
        await move(page, 0.9, 0.2);
        await until('regime', () => page.textContent('#regime'), (text) => text === 'slip-off');
        assert((await page.textContent('#why')).startsWith('slipped off at'), 'reason');
    },

    async 'the curve is that of whiskmap curve'(page) {
        const [download] = await Promise.all([page.waitForEvent('download'), page.click('#save-csv')]);
        const rows = table(readFileSync(await download.path(), 'utf8'));
        const distances = [...new Set(rows.map((row) => row.distance_mm))];
        writeFileSync(`${folder}/curve.toml`, readFileSync(cone, 'utf8').replace(/^distance_mm = .*$/m, `distance_mm = [${distances}]`));
        const own = new Map(table(run('curve', 'curve.toml')).map((row) => [`${row.side} ${Number(row.distance_mm)}`, row]));
        assert(rows.length === own.size, `${rows.length} rows, ${own.size} by the program`);
        for (const row of rows) {
            const program = own.get(`${row.side} ${Number(row.distance_mm)}`);
            assert(row.kind === program.kind, `kind at ${row.distance_mm}`);
            for (const name of ['push_angle_deg', 'force_un', 'energy_nj']) near(Number(row[name]), Number(program[name]), name);
        }
    },

    async 'the map has the regimes and values of whiskmap map'(page) {
        const size = [256, 256];
        writeFileSync(`${folder}/cells.toml`, readFileSync(cone, 'utf8').replaceAll('count = 512', 'count = 256'));
        run('map', 'cells.toml', '--engine', 'spectral', '--no-png', '-o', '.');
        run('extract', 'cone.exr', '--channel', 'regime', '--channel', 'force_un', '-o', 'cells.csv');
        const rows = table(readFileSync(`${folder}/cells.csv`, 'utf8'));
        const task = { map: { push_angle_deg: [-70, 70], distance_mm: [2, 20], size, channel: 'force_un', tolerance_deg: null } };
        const { numbers } = await respond(page, task);
        const count = size[0] * size[1];
        assert(rows.length === count && numbers.length === 3 * count, `${rows.length} rows, ${numbers.length} numbers`);
        rows.forEach((row, i) => {
            assert(numbers[i] === Number(row.regime), `regime of ${JSON.stringify(row)}: ${numbers[i]}`);
            const force = numbers[2 * count + i];
            if (row.force_un === '') assert(force === null, `force of ${JSON.stringify(row)}: ${force}`);
            else near(force, Number(row.force_un), 'force', 2e-7);
        });
    },

    async 'a slider changes the whisker, and a bad value says what is allowed'(page) {
        await page.fill('#field-tip_radius_um', '6');
        await page.press('#field-tip_radius_um', 'Enter');
        await finished(page, (values) => values.tip_radius_um === 6);
        writeFileSync(`${folder}/thick.toml`, readFileSync(cone, 'utf8').replace('tip_radius_um = 1.5', 'tip_radius_um = 6.0'));
        await move(page, 0.5, 0.6);
        await compareState(page, 'thick.toml');
        const slider = page.locator('.control:has(#field-taper) input[type=range]');
        await slider.focus();
        await page.keyboard.press('ArrowLeft');
        await finished(page, (values) => values.taper < 0.8 && !('tip_radius_um' in values));
        await page.fill('#field-pole_radius_mm', '-1');
        await page.press('#field-pole_radius_mm', 'Enter');
        const message = await until('message', () => page.textContent('#error-pole_radius_mm'), Boolean);
        assert(message.includes('pole.radius_mm = -1: must be at least 0'), message);
        await page.click('#reset');
        await finished(page, (values) => Object.keys(values).length === 0);
        assert((await page.textContent('#error-pole_radius_mm')) === '', 'the message stays');
    },

    async 'wheel, box and keys zoom'(page) {
        await move(page, 0.5, 0.5);
        await page.mouse.wheel(0, -600);
        await finished(page, (_, push) => push[1] - push[0] < 100);
        await page.keyboard.press('Escape');
        await page.focus('#plane');
        await page.keyboard.press('0');
        await finished(page, (_, push) => push[0] === -70 && push[1] === 70);
        await move(page, 0.4, 0.3);
        await page.mouse.down();
        await move(page, 0.6, 0.7);
        await page.mouse.up();
        await finished(page, (_, push) => push[1] - push[0] < 40);
        await page.click('#whole');
        await finished(page, (_, push) => push[0] === -70);
        const before = await shownAt(page);
        await page.focus('#plane');
        await page.keyboard.press('Shift+ArrowUp');
        await until('keys', () => shownAt(page), ({ distance }) => Number(distance) > Number(before.distance));
    },

    async 'points are compared and fitted'(page) {
        const csv = readFileSync(`${root}/scenes/cone_points.csv`, 'utf8');
        await drop(page, 'points.csv', csv);
        await page.waitForSelector('#fit-controls:not([hidden])');
        const rms = await until('misfit', () => page.$eval('#misfit', (own) => Number(own.dataset.rms)), (value) => value > 0);
        const text = run('fit', cone, '--data', `${root}/scenes/cone_points.csv`, '--free', 'tip_radius_um', '--json', '-');
        const fit = JSON.parse(text);
        await page.click('#fit');
        const value = await until('estimate', () => page.$eval('#estimates', (own) => Number(own.firstElementChild?.dataset.value ?? NaN)), (own) => own > 0);
        const estimate = fit.values.tip_radius_um;
        near(value, estimate, 'tip radius', 1e-6);
        const after = await until('misfit', () => page.$eval('#misfit', (own) => Number(own.dataset.rms)), (own) => own < rms);
        assert(after < rms, 'the fit is no better');
        await page.click('#forget');
        await page.click('#reset');
    },

    async 'a link holds scene and view'(page) {
        await page.fill('#field-length_mm', '18');
        await page.press('#field-length_mm', 'Enter');
        await page.selectOption('#channel', 'energy_nj');
        await finished(page, (values) => values.length_mm === 18);
        await page.click('#copy-link');
        await until('link', () => page.textContent('#saved'), (text) => text.includes('link'));
        const url = await page.evaluate(() => location.href);
        const other = await open(url);
        await finished(other, (values) => values.length_mm === 18);
        assert((await other.inputValue('#channel')) === 'energy_nj', 'channel');
        await other.reload();
        await finished(other, (values) => values.length_mm === 18);
        const broken = await open(`${built}#notalink`);
        assert((await broken.title()).startsWith('Conical'), 'a broken link');
        await Promise.all([other.context().close(), broken.context().close()]);
        await page.selectOption('#channel', '');
        await page.click('#reset');
        await finished(page, (values) => Object.keys(values).length === 0);
    },

    async 'files are saved'(page) {
        const saved = async (id) => {
            const [download] = await Promise.all([page.waitForEvent('download'), page.click(id)]);
            return readFileSync(await download.path());
        };
        assert((await saved('#save-toml')).equals(readFileSync(cone)), 'scene.toml');
        assert((await saved('#save-png')).subarray(1, 4).toString() === 'PNG', 'PNG');
        assert((await saved('#save-svg')).toString().startsWith('<svg'), 'SVG');
    },

    async 'a title is text, and a page of the command has scene and points'() {
        const title = '</script><img src=x onerror=alert(1)>';
        writeFileSync(`${folder}/evil.toml`, readFileSync(cone, 'utf8').replace(/^title = .*$/m, `title = '${title}'`));
        const dropped = await open(built);
        await drop(dropped, 'evil.toml', readFileSync(`${folder}/evil.toml`, 'utf8'));
        await until('title', () => dropped.textContent('#title'), (text) => text === title);
        assert((await dropped.locator('img').count()) === 0, 'an element');
        await dropped.context().close();
        run('explore', 'evil.toml', '--data', `${root}/scenes/cone_points.csv`, '-o', 'evil.html', '--no-open');
        const other = await open(`file://${folder}/evil.html`);
        assert((await other.textContent('#title')) === title, 'title');
        assert((await other.locator('img').count()) === 0, 'an element');
        await until('points', () => other.textContent('#misfit'), (text) => text.includes('points'));
        await other.context().close();
    },

    ...inputs,
    ...rows,
    ...gestures,
    ...times,

    async 'screenshots'() {
        for (const colorScheme of ['light', 'dark']) {
            for (const size of [[400, 860], [1280, 900], [2560, 1440]]) {
                const page = await open(built, { size, colorScheme });
                await until('branches', () => page.locator('#force path').count(), (count) => count > 2);
                await until('the course', () => page.locator('#whisk-force path').count(), (count) => count > 0);
                await page.$eval('#whisk-time', (own) => ((own.value = 30), own.dispatchEvent(new Event('input'))));
                const wide = await page.evaluate(() => document.documentElement.scrollWidth);
                assert(wide <= size[0], `${wide} pixels on ${size[0]}`);
                await page.screenshot({ path: `${folder}/${colorScheme}-${size[0]}.png`, fullPage: true });
                await page.context().close();
            }
        }
    },
};

// Nothing is required of times, so they are measured only by name.
const isWanted = (name) => (only === '' ? !(name in times) : name.includes(only));
const page = await open(built);
for (const [name, test] of Object.entries(tests).filter(([name]) => isWanted(name))) {
    const begun = Date.now();
    await test(page);
    assert(faults.length === 0, `${name}: ${faults.join('\n')}`);
    console.log(`ok ${name} (${Date.now() - begun} ms)`);
}
await close();
