//! A Vulkan driver that is another one, but for one function, which fails from some call on. `driver.rs` builds it.
//!
//! `REAL_DRIVER` is the other driver's library; `FAULT` is `FUNCTION CALLS RESULT`: the function's name, how often it
//! still works, and the `VkResult` from then on.

use std::env;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

type Any = *const c_void;
type GetProc = extern "C" fn(Any, *const c_char) -> Any;
/// Every faulty function takes at most six arguments, all of them pointers, handles or integers.
type Function = extern "C" fn(Any, Any, Any, Any, Any, Any) -> c_int;

unsafe extern "C" {
    fn dlopen(path: *const c_char, flags: c_int) -> Any;
    fn dlsym(library: Any, name: *const c_char) -> Any;
}

struct Fault {
    function: String,
    calls: usize,
    result: c_int,
}

fn fault() -> &'static Fault {
    static FAULT: OnceLock<Fault> = OnceLock::new();
    FAULT.get_or_init(|| {
        let text = env::var("FAULT").unwrap();
        let mut words = text.split(' ');
        let mut next = || words.next().unwrap().to_owned();
        Fault {
            function: next(),
            calls: next().parse().unwrap(),
            result: next().parse().unwrap(),
        }
    })
}

/// A function of the real driver, by its exported name; null where it has none.
fn exported(name: &CStr) -> Any {
    static LIBRARY: OnceLock<usize> = OnceLock::new();
    let library = LIBRARY.get_or_init(|| {
        let path = CString::new(env::var("REAL_DRIVER").unwrap()).unwrap();
        const NOW: c_int = 2;
        unsafe { dlopen(path.as_ptr(), NOW) as usize }
    });
    unsafe { dlsym(*library as Any, name.as_ptr()) }
}

fn instance_proc() -> GetProc {
    let found = exported(c"vk_icdGetInstanceProcAddr");
    assert!(!found.is_null(), "no Vulkan driver");
    unsafe { std::mem::transmute::<Any, GetProc>(found) }
}

static WORKING: AtomicUsize = AtomicUsize::new(0);
static DEVICE_PROC: AtomicUsize = AtomicUsize::new(0);

extern "C" fn faulty(a: Any, b: Any, c: Any, d: Any, e: Any, f: Any) -> c_int {
    static CALLS: AtomicUsize = AtomicUsize::new(0);
    if CALLS.fetch_add(1, Ordering::SeqCst) >= fault().calls {
        return fault().result;
    }
    let working = WORKING.load(Ordering::SeqCst);
    unsafe { std::mem::transmute::<usize, Function>(working)(a, b, c, d, e, f) }
}

/// What the driver answered when asked for `name`, or the faulty function in its stead.
fn replaced(name: *const c_char, found: Any) -> Any {
    let name = unsafe { CStr::from_ptr(name) }.to_str().unwrap();
    if found.is_null() {
        found
    } else if name.trim_end_matches("KHR") == fault().function {
        WORKING.store(found as usize, Ordering::SeqCst);
        faulty as Any
    } else if name == "vkGetDeviceProcAddr" {
        DEVICE_PROC.store(found as usize, Ordering::SeqCst);
        device_proc as Any
    } else {
        found
    }
}

extern "C" fn device_proc(device: Any, name: *const c_char) -> Any {
    let real = DEVICE_PROC.load(Ordering::SeqCst);
    let real = unsafe { std::mem::transmute::<usize, GetProc>(real) };
    replaced(name, real(device, name))
}

#[unsafe(no_mangle)]
extern "C" fn vk_icdGetInstanceProcAddr(instance: Any, name: *const c_char) -> Any {
    replaced(name, instance_proc()(instance, name))
}

#[unsafe(no_mangle)]
extern "C" fn vk_icdNegotiateLoaderICDInterfaceVersion(version: *mut u32) -> c_int {
    let found = exported(c"vk_icdNegotiateLoaderICDInterfaceVersion");
    let negotiate = unsafe { std::mem::transmute::<Any, extern "C" fn(*mut u32) -> c_int>(found) };
    negotiate(version)
}

#[unsafe(no_mangle)]
extern "C" fn vk_icdGetPhysicalDeviceProcAddr(instance: Any, name: *const c_char) -> Any {
    let found = exported(c"vk_icdGetPhysicalDeviceProcAddr");
    if found.is_null() {
        return found;
    }
    unsafe { std::mem::transmute::<Any, GetProc>(found)(instance, name) }
}
