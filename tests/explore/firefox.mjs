// The page in Firefox, over Marionette: firefox.mjs WHISKMAP FIREFOX FOLDER ROOT. It opens, computes, and has the numbers of the program.

import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import net from 'node:net';

const [whiskmap, firefox, folder, root] = process.argv.slice(2);
const PORT = 2828;

const later = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

async function until(what, get, is, ms = 60000) {
    const end = Date.now() + ms;
    for (;;) {
        const value = await get().catch((error) => error.message);
        if (is(value)) return value;
        if (Date.now() > end) throw new Error(`${what}: ${JSON.stringify(value)}`);
        await later(100);
    }
}

// A connection to Marionette: messages are `[type, id, error, result]` in JSON, after their length and a colon.
function session(socket) {
    const waiting = new Map();
    let [bytes, last] = [Buffer.alloc(0), 0];
    socket.on('data', (data) => {
        bytes = Buffer.concat([bytes, data]);
        for (;;) {
            const colon = bytes.indexOf(':');
            const end = colon + 1 + Number(bytes.subarray(0, colon));
            if (colon < 0 || bytes.length < end) return;
            const message = JSON.parse(bytes.subarray(colon + 1, end));
            bytes = bytes.subarray(end);
            if (!Array.isArray(message)) continue;
            const [, id, error, result] = message;
            if (error) waiting.get(id).reject(new Error(error.message));
            else waiting.get(id).resolve(result);
        }
    });
    return (name, parameters = {}) => new Promise((resolve, reject) => {
        const text = JSON.stringify([0, ++last, name, parameters]);
        waiting.set(last, { resolve, reject });
        socket.write(`${Buffer.byteLength(text)}:${text}`);
    });
}

const connected = () => new Promise((resolve, reject) => {
    const socket = net.connect(PORT, '127.0.0.1', () => resolve(socket));
    socket.on('error', reject);
});

const profile = mkdtempSync(`${folder}/firefox-`);
const browser = spawn(firefox, ['--headless', '--marionette', '--no-remote', '-profile', profile], { stdio: 'ignore', env: { ...process.env, HOME: profile } });
try {
    const send = session(await until('Firefox', connected, (own) => own instanceof net.Socket));
    const { capabilities } = await send('WebDriver:NewSession');
    const evaluate = async (script) => (await send('WebDriver:ExecuteScript', { script, args: [] })).value;
    await send('WebDriver:Navigate', { url: `file://${root}/crates/cli/explore.html` });
    const drawn = () => evaluate("return document.getElementById('engine').dataset.drawn ?? ''");
    await until('a finished map', drawn, (text) => text.startsWith('[false'));
    await until('a course', () => evaluate("return document.querySelectorAll('#whisk-force .dot').length"), (count) => count > 0);
    await until('bars', () => evaluate("return document.querySelectorAll('#sensitivities .effect').length"), (count) => count > 0);
    const words = (await evaluate("return document.getElementById('command').textContent")).match(/--distance (\S+) --push-angle (\S+)$/);
    execFileSync(whiskmap, ['shape', `${root}/scenes/cone.toml`, `--distance=${words[1]}`, `--push-angle=${words[2]}`, '--state', 'firefox.csv', '--csv', 'shape.csv'], { cwd: folder, stdio: 'ignore' });
    const [names, values] = readFileSync(`${folder}/firefox.csv`, 'utf8').trim().split('\n').map((line) => line.split(','));
    for (const name of ['force_un', 'base_moment_nnm', 'energy_nj', 'peak_strain']) {
        const own = Number(await evaluate(`return document.querySelector('[data-channel="${name}"] td').dataset.value`));
        const program = Number(values[names.indexOf(name)]);
        if (!(Math.abs(own - program) <= 1e-9 * Math.max(1, Math.abs(program)))) throw new Error(`${name}: ${own} on the page, ${program} by the program`);
    }
    await evaluate("const field = document.getElementById('field-taper'); field.value = '0.5'; field.dispatchEvent(new Event('change'))");
    await until('another map', drawn, (text) => text.startsWith('[false,{"taper":0.5}'));
    const { value } = await send('WebDriver:TakeScreenshot', { full: true });
    writeFileSync(`${folder}/firefox.png`, Buffer.from(value, 'base64'));
    console.log(`ok the page in Firefox ${capabilities.browserVersion}`);
} finally {
    browser.kill();
    await new Promise((resolve) => browser.on('exit', resolve));
    rmSync(profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
}
process.exit(0);
