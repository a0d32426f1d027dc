// Fields of numbers. A field whose text is refused keeps it, with a message of its own below, until it gets a number that is accepted.

const NUMBER = /^[+-]?(\d+([.,]\d*)?|[.,]\d+)(e[+-]?\d+)?$/i;
// A comma that may separate thousands as well as decimals.
const AMBIGUOUS = /^[+-]?[1-9]\d{0,2},\d{3}(e|$)/i;

const MUST = 'must be a number such as 0.5 or 0,5, without separators of thousands';

// The number in a text, with a decimal point or comma; NaN for any other text.
export function parsed(text) {
    const plain = text.trim().replace(/\u2212/g, '-');
    const value = NUMBER.test(plain) && !AMBIGUOUS.test(plain) ? Number(plain.replace(',', '.')) : NaN;
    return Number.isFinite(value) ? value : NaN;
}

// Starts a field. `accept` gets each number, or null for an empty text if `isOptional`, and returns a message, which is empty if it accepts
// the number, or null if a newer number replaces it; it may return a promise.
export function startField(field, error, accept, isOptional = false) {
    let count = 0;
    const say = (message) => {
        error.textContent = message;
        field.setAttribute('aria-invalid', String(message !== ''));
    };
    const enter = async (value) => {
        const own = ++count;
        const message = Number.isNaN(value) ? `${field.value.trim() || 'empty'}: ${MUST}` : await accept(value);
        if (own === count && message !== null) say(message);
    };
    field.addEventListener('change', () => enter(isOptional && !field.value.trim() ? null : parsed(field.value)));
    const show = (text) => error.textContent || document.activeElement === field || (field.value = text);
    return { enter, show, clear: () => (count++, say('')) };
}
