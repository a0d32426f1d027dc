// Elements. Text enters the page only as text nodes.

const SVG = 'http://www.w3.org/2000/svg';

export const find = (id) => document.getElementById(id);

function made(node, attributes, children) {
    for (const [name, value] of Object.entries(attributes)) {
        if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
        else if (value !== false && value != null) node.setAttribute(name, value === true ? '' : value);
    }
    node.append(...children);
    return node;
}

// An HTML element with attributes, listeners (`onclick`) and children.
export const el = (tag, attributes = {}, ...children) => made(document.createElement(tag), attributes, children);

// An SVG element with attributes and children.
export const svg = (tag, attributes = {}, ...children) => made(document.createElementNS(SVG, tag), attributes, children);

// Calls `f` when the calls have paused for `ms`.
export function debounced(ms, f) {
    let timer;
    return (...values) => {
        clearTimeout(timer);
        timer = setTimeout(() => f(...values), ms);
    };
}

// Saves a file to the downloads.
export function save(name, content, type) {
    const url = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
    el('a', { href: url, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(url), 1e4);
}
