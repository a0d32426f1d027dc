// The page in a browser, and the program beside it.

import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { chromium } from 'playwright-core';

export const [whiskmap, executablePath, folder, root, only = ''] = process.argv.slice(2);

export const built = `file://${root}/crates/cli/explore.html`;
export const cone = `${root}/scenes/cone.toml`;

const FLAGS = ['--no-sandbox', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--disable-quic'];

// Whatever a page does that it must not do.
export const faults = [];

let browser;

// Opens a page at an address, in a window of some size and colour scheme, runs `onStart` in it, and waits for its finished map or else
// for `isReady`.
export async function open(url, { size = [1280, 900], colorScheme = 'light', hasTouch = false, onStart = null, isReady = finished } = {}) {
    browser ??= await chromium.launch({ executablePath, args: FLAGS });
    const [width, height] = size;
    const context = await browser.newContext({ viewport: { width, height }, colorScheme, hasTouch, acceptDownloads: true, permissions: ['clipboard-read', 'clipboard-write'] });
    const page = await context.newPage();
    page.on('console', (message) => faults.push(`console: ${message.text()}`));
    page.on('pageerror', (error) => faults.push(`error: ${error.stack}`));
    page.on('dialog', (dialog) => faults.push(`dialog: ${dialog.message()}`));
    page.on('request', (request) => {
        if (!/^(file|blob|data):/.test(request.url())) faults.push(`request: ${request.url()}`);
    });
    if (onStart) await page.addInitScript(onStart);
    await page.goto(url);
    await isReady(page);
    return page;
}

export const close = () => browser.close();

// Waits for the finished map whose values, push angles and distances satisfy `is`.
export async function finished(page, is = () => true) {
    const drawn = () => page.$eval('#engine', (own) => own.dataset.drawn ?? '[true]');
    await until(`a finished map: ${is}`, drawn, (text) => {
        const [isDraft, ...map] = JSON.parse(text);
        return !isDraft && is(...map);
    });
}

// Waits for a value of the page that satisfies `is`, and returns it.
export async function until(what, get, is) {
    const end = Date.now() + 60000;
    for (;;) {
        const value = await get();
        if (is(value)) return value;
        assert(Date.now() < end, `${what}: ${value}`);
        await new Promise((resolve) => setTimeout(resolve, 20));
    }
}

export function assert(condition, message) {
    if (!condition) throw new Error(message);
}

export function near(a, b, what, tolerance = 1e-9) {
    assert(Math.abs(a - b) <= tolerance * Math.max(1, Math.abs(b)), `${what}: ${a} on the page, ${b} by the program`);
}

// Output of the program.
export const run = (...words) => execFileSync(whiskmap, words, { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });

// Rows of a CSV table by column.
export function table(text) {
    const [head, ...rows] = text.trim().split('\n').map((line) => line.match(/("[^"]*"|[^,"]*)(,|$)/g).map((cell) => cell.replace(/,$/, '')));
    return rows.map((row) => Object.fromEntries(head.map((name, i) => [name, row[i] ?? ''])));
}

const channel = (page, name) => page.$eval(`[data-channel="${name}"] td`, (cell) => Number(cell.dataset.value));

// The push angle and the distance of the state that is shown, once it is that of the pointer.
export async function shownAt(page) {
    const place = () => page.evaluate(() => {
        const shown = JSON.parse(document.getElementById('place').dataset.at ?? '{}');
        const pointer = JSON.parse(document.getElementById('plane').dataset.pointer);
        return { ...shown, pointer };
    });
    return until('the pointer', place, ({ distance, push, pointer }) => distance === pointer.distance && push === pointer.push);
}

// Compares the state on the page with `whiskmap shape`.
export async function compareState(page, scene) {
    const { distance, push } = await shownAt(page);
    const files = ['--state', 'state.csv', '--csv', 'shape.csv'];
    run('shape', scene, `--distance=${distance}`, `--push-angle=${push}`, ...files);
    const [state] = table(readFileSync(`${folder}/state.csv`, 'utf8'));
    for (const name of ['force_un', 'base_moment_nnm', 'arc_length_mm', 'contact_angle_deg', 'energy_nj', 'peak_strain']) {
        await until(name, () => channel(page, name), (value) => Math.abs(value - state[name]) <= 1e-9 * Math.max(1, Math.abs(state[name])));
    }
}

// Enters a text into a field.
export async function enter(page, id, text) {
    await page.fill(`#${id}`, String(text));
    await page.press(`#${id}`, 'Enter');
}

// Drops a file on the page.
export const drop = (page, name, text) => page.evaluate(([name, text]) => {
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File([text], name));
    dispatchEvent(new DragEvent('drop', { dataTransfer, cancelable: true }));
}, [name, text]);

// Moves the pointer to a part of the map, from the left and from the top.
export async function move(page, x, y) {
    const box = await page.locator('#plane > svg').boundingBox();
    await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
}

// Runs in the page: the response of the page's own solver to a request, as its JSON and its numbers.
async function responseOf(request) {
    const packed = Uint8Array.from(atob(document.getElementById('wasm').textContent), (own) => own.charCodeAt(0));
    const bytes = await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'))).arrayBuffer();
    const { exports: solver } = (await WebAssembly.instantiate(bytes, {})).instance;
    const text = new TextEncoder().encode(JSON.stringify(request));
    const place = solver.input(text.length);
    new Uint8Array(solver.memory.buffer, place, text.length).set(text);
    solver.respond();
    const { buffer } = solver.memory;
    const numbers = [...new Float32Array(buffer, solver.numbers(), solver.numbers_length())].map((own) => (Number.isNaN(own) ? null : own));
    return { ...JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, solver.text(), solver.text_length()))), numbers };
}

// Response of the page's own solver to a task for a scene, by default that of the page.
export const respond = (page, task, text = readFileSync(cone, 'utf8')) => page.evaluate(responseOf, { text, origin: 'cone.toml', values: [], task });

// The text of a scene as the page of the program holds it, with the numbers of the files that the scene names.
export function sceneText(scene) {
    run('explore', scene, '-o', 'scene.html', '--no-open');
    const [, start] = readFileSync(`${folder}/scene.html`, 'utf8').match(/ id="start">(.*?)<\/script>/);
    return JSON.parse(start).scene.text;
}
