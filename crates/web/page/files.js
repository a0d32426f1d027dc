// Files that the reader saves: the scene, the detachment curve, and pictures of the map.

import { finished, toml } from './compute.js';
import { find, save, svg } from './dom.js';
import { link } from './link.js';
import { command } from './readout.js';
import { known } from './state.js';
import { exact } from './text.js';

// Properties of style that a picture outside the page must carry itself.
const STYLE = ['fill', 'stroke', 'stroke-width', 'stroke-dasharray', 'stroke-linecap', 'stroke-linejoin', 'font-family', 'font-size', 'font-weight', 'fill-opacity', 'stroke-opacity', 'paint-order'];

// The map as an SVG: the cells as pixels, axes, lines and texts as vectors.
function picture() {
    const [canvas, overlay] = find('plane').children;
    const { width, height } = overlay.getBoundingClientRect();
    const copy = overlay.cloneNode(true);
    const [own, made] = [overlay, copy].map((node) => [...node.querySelectorAll('*')]);
    own.forEach((node, i) => {
        const style = getComputedStyle(node);
        for (const name of STYLE) made[i].setAttribute(name, style.getPropertyValue(name));
    });
    copy.querySelector('.cross')?.remove();
    copy.querySelector('.box')?.remove();
    const ground = svg('rect', { width, height, fill: getComputedStyle(document.body).backgroundColor });
    const cells = svg('image', { href: canvas.toDataURL('image/png'), width, height });
    copy.prepend(ground, cells);
    for (const [name, value] of Object.entries({ width, height })) copy.setAttribute(name, value);
    return { text: new XMLSerializer().serializeToString(copy), width, height };
}

async function savePng() {
    const { text, width, height } = picture();
    const image = new Image();
    image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
    await image.decode();
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [2 * width, 2 * height];
    canvas.getContext('2d').drawImage(image, 0, 0, canvas.width, canvas.height);
    canvas.toBlob((blob) => save(`${known.scene.name}.png`, blob));
}

// The detachment curve with the columns of `whiskmap curve`.
function csv() {
    const { rows, columns } = known.curve;
    return [columns, ...rows.map((row) => columns.map((column) => exact(row[column])))].map((cells) => `${cells.join(',')}\n`).join('');
}

const say = (message) => (find('saved').textContent = message);

const copied = (text) => navigator.clipboard?.writeText(text).then(() => true, () => false);

async function copyLink() {
    location.hash = await link();
    say((await copied(location.href)) ? 'link copied' : 'the address of this page is the link');
}

async function copyCommand() {
    const text = await command();
    if (text) say((await copied(text)) ? 'command copied' : 'the browser does not allow copying');
}

// Saves what is drawn once it is finished.
const whenFinished = (f) => async () => {
    say('waiting for the finished map');
    const isFinished = await finished();
    say(isFinished ? '' : 'nothing is saved, because the map is not finished');
    if (isFinished) await f();
};

const SAVE = {
    'save-toml': async () => {
        const text = await toml();
        if (text) save(`${known.scene.name}.toml`, text, 'application/toml');
    },
    'save-csv': whenFinished(() => save(`${known.scene.name}-curve.csv`, csv(), 'text/csv')),
    'save-svg': whenFinished(() => save(`${known.scene.name}.svg`, picture().text, 'image/svg+xml')),
    'save-png': whenFinished(savePng),
    'copy-link': copyLink,
    'copy-command': copyCommand,
};

export function startFiles() {
    for (const [id, f] of Object.entries(SAVE)) find(id).addEventListener('click', async () => {
        try {
            await f();
        } catch ({ message }) {
            say(message);
        }
    });
}
