//! Threads of computations, which run without the interpreter's lock and end on Ctrl-C.

use crate::arguments::whole;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::HashMap;
use std::ops::RangeInclusive;
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Time between two looks at signals.
const TICK: Duration = Duration::from_millis(20);

/// Stack of a thread in bytes, as in the program: GPU drivers compile on it.
const STACK: usize = 8 << 20;

/// Allowed numbers of threads.
const THREADS: RangeInclusive<u32> = 1..=1024;

/// Pools by their number of threads; 0 is a thread for each core, or `RAYON_NUM_THREADS`.
///
/// Pools belong to a process: after `fork`, a pool has no threads in the child.
struct ThreadPools {
    process: u32,
    pools: HashMap<usize, Arc<ThreadPool>>,
}

static POOLS: Mutex<Option<ThreadPools>> = Mutex::new(None);

/// Argument `threads` of a function: at least 1.
#[derive(Clone, Copy, Debug)]
pub struct ThreadCount(usize);

impl ThreadCount {
    /// Returns the number of threads that is given; `None` without one.
    pub fn of(given: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Self>> {
        given.map(|given| Ok(Self(whole("threads", given, &THREADS)?))).transpose()
    }
}

fn pool(threads: Option<ThreadCount>) -> PyResult<Arc<ThreadPool>> {
    let threads = threads.map_or(0, |threads| threads.0);
    let mut all = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let process = process::id();
    if all.as_ref().is_none_or(|pools| pools.process != process) {
        let pools = HashMap::new();
        // The threads of the parent's pools do not exist here, so dropping its pools could wait for ever.
        std::mem::forget(all.replace(ThreadPools { process, pools }));
    }
    let pools =
        &mut all.get_or_insert_with(|| ThreadPools { process, pools: HashMap::new() }).pools;
    if let Some(pool) = pools.get(&threads) {
        return Ok(Arc::clone(pool));
    }
    let pool = ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build();
    let pool = Arc::new(
        pool.map_err(|why| PyRuntimeError::new_err(format!("threads = {threads}: {why}")))?,
    );
    pools.insert(threads, Arc::clone(&pool));
    Ok(pool)
}

/// Runs `job` on a pool of `threads`, without the interpreter's lock. `on_tick` is called from time to time, with the lock.
///
/// A signal or an error of `on_tick` sets the flag that the job gets. The job then ends early, and its result is dropped.
///
/// # Errors
/// If the pool cannot be created, or the exception of a signal handler, such as `KeyboardInterrupt`, or of `on_tick`.
pub fn run<R: Send>(
    py: Python<'_>,
    threads: Option<ThreadCount>,
    mut on_tick: impl FnMut(Python<'_>) -> PyResult<()>,
    job: impl FnOnce(&Arc<AtomicBool>) -> R + Send,
) -> PyResult<R> {
    let pool = pool(threads)?;
    let cancel = Arc::new(AtomicBool::new(false));
    let (sender, mut receiver) = mpsc::channel();
    pool.in_place_scope(|scope| {
        let flag = &cancel;
        // Only a receiver that is gone refuses a result.
        scope.spawn(move |_| drop(sender.send(job(flag))));
        let mut ended = Ok(());
        loop {
            let wait = move || {
                let result = receiver.recv_timeout(TICK);
                (receiver, result)
            };
            let result;
            (receiver, result) = py.detach(wait);
            match result {
                Ok(result) => return ended.map(|()| result),
                // The scope resumes the panic of the job.
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(PyRuntimeError::new_err("the computation panicked"));
                }
                Err(RecvTimeoutError::Timeout) if ended.is_ok() => {
                    ended = py.check_signals().and_then(|()| on_tick(py));
                    cancel.store(ended.is_err(), Ordering::Relaxed);
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    })
}
