//! A call that may panic, made to return.
//!
//! When the driver reports during a wait that the device is lost, wgpu 30 panics in `Device::poll`, and it has no wait
//! that returns; so it does in `request_device` where memory ends while wgpu makes things for itself. Such a panic is
//! expected, so its message is kept from standard error; every other panic is left alone.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

thread_local! {
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// What `call` returns, or the message with which it panicked.
pub fn guarded<T>(call: impl FnOnce() -> T) -> Result<T, String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !GUARDED.get() {
                before(info);
            }
        }));
    });
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

    #[test]
    fn a_panic_becomes_its_message() {
        assert_eq!(guarded(|| 7), Ok(7));
        let plain = guarded(|| -> u32 { panic!("lost") });
        assert_eq!(plain, Err("lost".to_owned()));
        let calls = std::hint::black_box(3);
        let built = guarded(|| -> u32 { panic!("lost after {calls}") });
        assert_eq!(built, Err("lost after 3".to_owned()));
    }
}
