//! What threads spend their CPU time on.
//!
//! A thread works for one [`Account`] at a time, or for none. While it waits for its part of some parallel work, it may be given a task
//! of another account: that one is opened for so long, so that every second is one account's.

use std::cell::RefCell;
use std::marker::PhantomData;
use std::mem;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// CPU time of all threads that have worked for it.
///
/// ```
/// use rayon::prelude::*;
/// use whiskmap_mechanics::account::{Account, carried};
///
/// let (outer, inner) = (Account::default(), Account::default());
/// let sum: u64 = outer.of(|| {
///     let squares = (0..1000_u64).into_par_iter();
///     let squares = squares.map_init(carried(), |_, x| inner.of(|| x * x));
///     squares.sum()
/// });
/// assert_eq!(sum, 332_833_500);
/// assert!(outer.time().as_nanos() > 0 && inner.time().as_nanos() > 0);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Account(Arc<AtomicU64>);

impl Account {
    /// Does `work`, for which this thread works for this account.
    pub fn of<R>(&self, work: impl FnOnce() -> R) -> R {
        let _turn = Turn::new(Some(self.clone()));
        work()
    }

    /// All of it, but for the turns that threads are at.
    #[must_use]
    pub fn time(&self) -> Duration {
        Duration::from_nanos(self.0.load(Ordering::Relaxed))
    }

    fn add(&self, time: Duration) {
        self.0.fetch_add(time.as_nanos() as u64, Ordering::Relaxed);
    }
}

/// Work of one thread for one account, or for none, until it is dropped.
#[derive(Debug)]
#[must_use = "it ends where it is dropped"]
pub struct Turn {
    /// What the thread works for after it.
    before: Option<Account>,
    /// It stays on its thread.
    thread: PhantomData<*const ()>,
}

impl Turn {
    fn new(account: Option<Account>) -> Self {
        Self {
            before: switch(account),
            thread: PhantomData,
        }
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        switch(self.before.take());
    }
}

/// Begins turns, on any thread, for what this thread works for now: for `map_init` and its like, where the leaves of parallel work begin.
pub fn carried() -> impl Fn() -> Turn + Send + Sync {
    let account = OPEN.with_borrow(|open| open.account.clone());
    move || Turn::new(account.clone())
}

/// What a thread works for.
#[derive(Default)]
struct Open {
    account: Option<Account>,
    /// The thread's time at which that began.
    since: Duration,
}

thread_local! {
    static OPEN: RefCell<Open> = RefCell::default();
}

/// Opens an account on this thread, and returns the one before. Where they are the same, no clock is read.
fn switch(account: Option<Account>) -> Option<Account> {
    OPEN.with_borrow_mut(|open| {
        let place = |account: &Option<Account>| account.as_ref().map(|own| Arc::as_ptr(&own.0));
        if place(&open.account) != place(&account) {
            let now = thread_time();
            let spent = now.saturating_sub(open.since);
            open.account.iter().for_each(|own| own.add(spent));
            open.since = now;
        }
        mem::replace(&mut open.account, account)
    })
}

/// CPU time of this thread.
#[cfg(unix)]
#[must_use]
pub fn thread_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Without such a clock, any time.
#[cfg(not(unix))]
#[must_use]
pub fn thread_time() -> Duration {
    static START: std::sync::LazyLock<std::time::Instant> =
        std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed()
}
