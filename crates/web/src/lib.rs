//! The solver of the page that `whiskmap explore` writes, as a WebAssembly module without imports.
//!
//! A caller writes a [`Request`](request::Request) as JSON where [`input`] points, calls [`answer`], and reads the answer: a JSON text
//! where [`text`] points, and numbers where [`numbers`] points. An answer without a result is `{"error": message}`, with the message of
//! the command line. Positions are valid until the next call.
#![allow(
    unsafe_code,
    reason = "exported functions need names; no function here reads or writes through a pointer"
)]

mod answer;
mod map;
mod points;
mod request;
mod scene;
mod traces;

use std::cell::RefCell;

/// Memory that the caller and the solver share.
#[derive(Default)]
struct Exchange {
    input: Vec<u8>,
    text: String,
    numbers: Vec<f32>,
}

thread_local! {
    /// A module has one thread, and its caller one request at a time.
    static EXCHANGE: RefCell<Exchange> = RefCell::default();
}

/// Makes room for a request of `length` bytes. Returns where the caller writes it.
#[unsafe(no_mangle)]
pub extern "C" fn input(length: usize) -> *mut u8 {
    EXCHANGE.with_borrow_mut(|exchange| {
        exchange.input.resize(length, 0);
        exchange.input.as_mut_ptr()
    })
}

/// Answers the request that was written.
#[unsafe(no_mangle)]
pub extern "C" fn answer() {
    EXCHANGE.with_borrow_mut(|exchange| {
        let answer = request::answer(&exchange.input);
        (exchange.text, exchange.numbers) = (answer.text.to_string(), answer.numbers);
    });
}

/// Returns where the text of the last answer begins, in UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn text() -> *const u8 {
    EXCHANGE.with_borrow(|exchange| exchange.text.as_ptr())
}

/// Returns the length of the text of the last answer, in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn text_length() -> usize {
    EXCHANGE.with_borrow(|exchange| exchange.text.len())
}

/// Returns where the numbers of the last answer begin, of type `f32`.
#[unsafe(no_mangle)]
pub extern "C" fn numbers() -> *const f32 {
    EXCHANGE.with_borrow(|exchange| exchange.numbers.as_ptr())
}

/// Returns how many numbers the last answer has.
#[unsafe(no_mangle)]
pub extern "C" fn numbers_length() -> usize {
    EXCHANGE.with_borrow(|exchange| exchange.numbers.len())
}
