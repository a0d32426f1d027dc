//! A call that may panic, made to return.
//!
//! When the driver reports during a wait that the device is lost, wgpu 30 panics in `Device::poll`, and it has no wait
//! that returns; so it does in `request_device` where memory ends while wgpu makes things for itself. Messages of panics
//! are the program's, not a library's: its hook may ask [`is_guarded`] and keep those silent that are expected here.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};

thread_local! {
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Whether a panic of this thread, now, would be caught and handed on as an [`EngineError`](crate::integrate::EngineError).
#[must_use]
pub fn is_guarded() -> bool {
    GUARDED.get()
}

/// What `call` returns, or the message with which it panicked.
pub(super) fn guarded<T>(call: impl FnOnce() -> T) -> Result<T, String> {
    GUARDED.set(true);
    let result = panic::catch_unwind(AssertUnwindSafe(call));
    GUARDED.set(false);
    result.map_err(|payload| {
        let built = payload.downcast_ref::<String>().map(String::as_str);
        let message = built.or_else(|| payload.downcast_ref::<&str>().copied());
        message.unwrap_or("panic without a message").to_owned()
    })
}

#[cfg(test)]
#[allow(clippy::panic, reason = "panics are what is tested")]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn a_panic_becomes_its_message_and_the_hook_stays_the_programs() {
        static EXPECTED: AtomicUsize = AtomicUsize::new(0);
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if is_guarded() {
                EXPECTED.fetch_add(1, Ordering::Relaxed);
            } else {
                before(info);
            }
        }));
        assert_eq!(guarded(|| 7), Ok(7));
        let plain = guarded(|| -> u32 { panic!("lost") });
        assert_eq!(plain, Err("lost".to_owned()));
        let calls = std::hint::black_box(3);
        let built = guarded(|| -> u32 { panic!("lost after {calls}") });
        assert_eq!(built, Err("lost after 3".to_owned()));
        assert_eq!(EXPECTED.load(Ordering::Relaxed), 2);
        assert!(!is_guarded());
    }
}
