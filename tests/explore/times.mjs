// Times of the page, printed as medians in ms. They depend on the machine, and nothing is required of them.

import { built, open } from './page.mjs';

// Runs in the page: times from `events` to the next frame after a change of an element, one after the other. With `isFinal`, to
// the finished map.
async function timesOf({ target, kind, count, isFinal = false }) {
    const find = (id) => document.getElementById(id);
    const slider = document.querySelector('.control:has(#field-length_mm) input[type=range]');
    const plane = find('plane');
    const box = plane.getBoundingClientRect();
    const events = {
        slider(i) {
            slider.value = 20 + 0.05 * (i + 1);
            slider.dispatchEvent(new Event('input'));
        },
        pointer: (i) => plane.dispatchEvent(new PointerEvent('pointermove', { clientX: box.x + box.width * (0.45 + 0.005 * i), clientY: box.y + box.height * (0.4 + 0.01 * i) })),
    };
    const times = [];
    for (let i = 0; i < count; i++) {
        const begun = performance.now();
        times.push(await new Promise((resolve) => {
            const before = find('engine').dataset.drawn;
            const observer = new MutationObserver(() => {
                const { drawn } = find('engine').dataset;
                if (isFinal && (drawn === before || JSON.parse(drawn)[0])) return;
                observer.disconnect();
                requestAnimationFrame(() => resolve(performance.now() - begun));
            });
            observer.observe(find(target), { attributes: true, childList: true, subtree: true });
            events[kind](i);
        }));
        await new Promise((resolve) => setTimeout(resolve, 1500));
    }
    return times;
}

const median = (times) => times.sort((a, b) => a - b)[times.length >> 1].toFixed(0);

export const times = {
    async 'times in ms, medians'() {
        const first = [];
        for (let i = 0; i < 5; i++) {
            const page = await open(built, { onStart: () => new MutationObserver((_, own) => {
                if (!document.getElementById('engine')?.dataset.drawn) return;
                own.disconnect();
                requestAnimationFrame(() => (window.firstMap = performance.now()));
            }).observe(document, { attributes: true, childList: true, subtree: true }) });
            first.push(await page.evaluate(() => window.firstMap));
            if (i === 4) {
                const slider = await page.evaluate(timesOf, { target: 'engine', kind: 'slider', count: 15 });
                const final = await page.evaluate(timesOf, { target: 'engine', kind: 'slider', count: 15, isFinal: true });
                const pointer = await page.evaluate(timesOf, { target: 'whisker', kind: 'pointer', count: 15 });
                console.log(`start to first map ${median(first)}, slider to draft ${median(slider)}, to finished map ${median(final)}, pointer to shape ${median(pointer)}`);
            }
            await page.context().close();
        }
    },
};
