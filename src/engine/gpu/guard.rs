//! Driver calls that may panic, on a thread of their own.
//!
//! When a device is lost during a wait, wgpu 30 panics in `Device::poll`, which has no variant that returns. `request_device` panics
//! where memory ends. The panic hook belongs to the program: it can skip threads named [`DRIVER_CALL`], since their panics are returned.

use std::thread;

/// Name of the threads whose panics become an [`EngineError`](crate::engine::EngineError).
pub const DRIVER_CALL: &str = "driver call";

/// Returns the result of `call`, or the message with which it panicked.
pub(super) fn guarded<T: Send>(call: impl FnOnce() -> T + Send) -> Result<T, String> {
    thread::scope(|scope| {
        let thread = thread::Builder::new().name(DRIVER_CALL.to_owned()).spawn_scoped(scope, call);
        thread.map_err(|error| error.to_string())?.join().map_err(|payload| {
            let built = payload.downcast_ref::<String>().map(String::as_str);
            let message = built.or_else(|| payload.downcast_ref::<&str>().copied());
            message.unwrap_or("panic without a message").to_owned()
        })
    })
}

#[cfg(test)]
#[allow(clippy::panic, reason = "panics are what is tested")]
mod tests {
    use super::*;
    use std::panic;
    use std::sync::mpsc;

    #[test]
    fn a_panic_becomes_its_message_and_the_hook_stays_the_programs() {
        let (sender, skipped) = mpsc::channel();
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            match thread::current().name() == Some(DRIVER_CALL) {
                true => sender.send(()).unwrap_or_default(),
                false => before(info),
            }
        }));
        assert_eq!(guarded(|| 7), Ok(7));
        let plain = guarded(|| -> u32 { panic!("lost") });
        assert_eq!(plain, Err("lost".to_owned()));
        let calls = std::hint::black_box(3);
        let built = guarded(|| -> u32 { panic!("lost after {calls}") });
        assert_eq!(built, Err("lost after 3".to_owned()));
        assert_eq!(skipped.try_iter().count(), 2);
    }
}
