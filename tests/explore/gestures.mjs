// Tests of two fingers, of the stop button, and of workers that are replaced while they compute or after they fail.

import { assert, built, compareState, drop, enter, finished, open, root, sceneText, until } from './page.mjs';

const measured = `${root}/scenes/measured.toml`;

// Sends two fingers to the map, `apart` pixels from each other.
async function fingers(page, session, type, apart) {
    const box = await page.locator('#plane > svg').boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const touchPoints = type === 'touchEnd' ? [] : [{ x: x - apart / 2, y, id: 1 }, { x: x + apart / 2, y, id: 2 }];
    await session.send('Input.dispatchTouchEvent', { type, touchPoints });
}

// Opens the built page, and drops the scene with measured radii on it.
async function openMeasured() {
    const page = await open(built);
    await drop(page, 'measured.toml', sceneText(measured));
    await until('the title', () => page.title(), (title) => title.startsWith('A whisker with measured radii'));
    return page;
}

const setField = (page, name, value) => enter(page, `field-${name}`, value);

export const gestures = {
    async 'two fingers zoom'() {
        const page = await open(built, { size: [400, 860], hasTouch: true });
        const session = await page.context().newCDPSession(page);
        await fingers(page, session, 'touchStart', 60);
        for (const apart of [80, 100, 120]) await fingers(page, session, 'touchMove', apart);
        await fingers(page, session, 'touchEnd');
        await finished(page, (_, push) => push[1] - push[0] < 80 && push[1] - push[0] > 60);
        await page.context().close();
    },

    async 'measured radii have the states of whiskmap shape'() {
        const page = await openMeasured();
        await compareState(page, measured);
        // Each value replaces a map that is still computed, and the last one is drawn.
        for (const friction of [0.9, 0.8, 0.7, 0.6]) await setField(page, 'friction', friction);
        await finished(page, (values) => values.friction === 0.6);
        await page.context().close();
    },

    async 'stop ends the work, and the next change computes again'() {
        const page = await openMeasured();
        await setField(page, 'friction', 0.9);
        await page.waitForSelector('#stop:not([hidden])');
        await page.click('#stop');
        await until('stopped', () => page.textContent('#failure'), (text) => text.startsWith('stopped'));
        await page.waitForSelector('#stop', { state: 'hidden' });
        const [isDraft, values] = JSON.parse(await page.$eval('#engine', (own) => own.dataset.drawn));
        assert(isDraft || values.friction !== 0.9, 'the work went on to its end');
        await setField(page, 'friction', 0.8);
        await finished(page, (own) => own.friction === 0.8);
        assert((await page.textContent('#failure')) === '', 'the message stays');
        await page.click('#whole');
        await page.waitForSelector('#stop:not([hidden])');
        await page.click('#stop');
        await page.click('#again');
        await finished(page, (own) => own.friction === 0.8);
        await page.context().close();
    },

    async 'a failed worker is replaced'() {
        const page = await open(built, { onStart: () => {
            const { postMessage } = Worker.prototype;
            // The request is that of the field, not one that the page still sends for the row. No JSON has such a number.
            Worker.prototype.postMessage = function (data) {
                const fails = data.request?.task === 'scene' && window.failures > 0 && window.failures--;
                postMessage.call(this, fails ? { ...data, request: 1n } : data);
            };
        } });
        await page.evaluate(() => (window.failures = 1));
        await setField(page, 'friction', 0.2);
        await until('the message', () => page.textContent('#error-friction'), (text) => text.startsWith('the solver has failed'));
        await setField(page, 'friction', 0.3);
        await finished(page, (values) => values.friction === 0.3);
        assert(await page.textContent('#error-friction') === '', 'the message stays');
        await page.context().close();
    },
};
