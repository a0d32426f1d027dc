// Files that the reader saves: the scene, the detachment curve, and pictures of the map.

import { toml } from './compute.js';
import { find, save, svg } from './dom.js';
import { known, link } from './state.js';
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
    const rows = known.curve?.rows ?? [];
    const columns = Object.keys(rows[0] ?? {});
    return [columns, ...rows.map((row) => columns.map((column) => exact(row[column])))].map((cells) => `${cells.join(',')}\n`).join('');
}

async function copyLink() {
    location.hash = await link();
    const done = await navigator.clipboard?.writeText(location.href).then(() => true, () => false);
    find('saved').textContent = done ? 'link copied' : 'the address of this page is the link';
}

const SAVE = {
    'save-toml': async () => {
        const text = await toml();
        if (text) save(`${known.scene.name}.toml`, text, 'application/toml');
    },
    'save-csv': () => save(`${known.scene.name}-curve.csv`, csv(), 'text/csv'),
    'save-svg': () => save(`${known.scene.name}.svg`, picture().text, 'image/svg+xml'),
    'save-png': savePng,
    'copy-link': copyLink,
    'copy-command': () => navigator.clipboard?.writeText(find('command').textContent),
};

export function startFiles() {
    for (const [id, f] of Object.entries(SAVE)) find(id).addEventListener('click', f);
}
