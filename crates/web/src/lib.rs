//! The solver of the page that `whiskmap explore` writes, as a WebAssembly module without imports.
//!
//! A caller writes a request (`src/request.rs`) as JSON where [`input`] points, calls [`respond`], and reads the response: a JSON
//! text where [`text`] points, and numbers where [`numbers`] points. A response without a result is `{"error": message}`, with the message of
//! the command line. Positions are valid until the next call.
#![allow(
    unsafe_code,
    reason = "exported functions need names; no function here reads or writes through a pointer"
)]

mod course;
mod map;
mod points;
mod request;
mod response;
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

/// Computes the response to the request that was written.
#[unsafe(no_mangle)]
pub extern "C" fn respond() {
    EXCHANGE.with_borrow_mut(|exchange| {
        let response = request::respond(&exchange.input);
        (exchange.text, exchange.numbers) = (response.text.to_string(), response.numbers);
    });
}

/// Returns where the text of the last response begins, in UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn text() -> *const u8 {
    EXCHANGE.with_borrow(|exchange| exchange.text.as_ptr())
}

/// Returns the length of the text of the last response, in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn text_length() -> usize {
    EXCHANGE.with_borrow(|exchange| exchange.text.len())
}

/// Returns where the numbers of the last response begin, of type `f32`.
#[unsafe(no_mangle)]
pub extern "C" fn numbers() -> *const f32 {
    EXCHANGE.with_borrow(|exchange| exchange.numbers.as_ptr())
}

/// Returns how many numbers the last response has.
#[unsafe(no_mangle)]
pub extern "C" fn numbers_length() -> usize {
    EXCHANGE.with_borrow(|exchange| exchange.numbers.len())
}
