// The page in a browser, and the program beside it.

import { execFileSync } from 'node:child_process';
import { chromium } from 'playwright-core';

export const [whiskmap, executablePath, folder, root] = process.argv.slice(2);

const FLAGS = ['--no-sandbox', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--disable-quic'];

// Whatever a page does that it must not do.
export const faults = [];

let browser;

// Opens a page at an address, in a window of some size and colour scheme, and waits for its finished map.
export async function open(url, { size = [1280, 900], colorScheme = 'light' } = {}) {
    browser ??= await chromium.launch({ executablePath, args: FLAGS });
    const [width, height] = size;
    const context = await browser.newContext({ viewport: { width, height }, colorScheme, acceptDownloads: true });
    const page = await context.newPage();
    page.on('console', (message) => faults.push(`console: ${message.text()}`));
    page.on('pageerror', (error) => faults.push(`error: ${error.stack}`));
    page.on('dialog', (dialog) => faults.push(`dialog: ${dialog.message()}`));
    page.on('request', (request) => {
        if (!/^(file|blob|data):/.test(request.url())) faults.push(`request: ${request.url()}`);
    });
    await page.goto(url);
    await finished(page);
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
    const end = Date.now() + 20000;
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
