//! Accounts of CPU time: every second is in one of them, whoever did the work.
//!
//! What has been spent is read from the threads' own clocks, so that a busy machine changes nothing.

use rayon::Yield;
use rayon::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Barrier;
use std::time::Duration;
use whiskmap_mechanics::account::{Account, carried, thread_time};

/// Much more than threads spend on anything else here.
const LONG: Duration = Duration::from_millis(20);

fn spend(time: Duration) {
    let start = thread_time();
    while thread_time() - start < time {}
}

/// Does `work` on so many threads, and tells what these have spent meanwhile.
fn spent(threads: usize, work: impl FnOnce() + Send) -> Duration {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    let pool = pool.build().unwrap();
    let clocks = || -> Duration { pool.broadcast(|_| thread_time()).iter().sum() };
    let before = clocks();
    pool.install(work);
    clocks() - before
}

#[test]
fn a_stolen_task_is_not_the_thiefs() {
    let (outer, inner) = (Account::default(), Account::default());
    let all = spent(1, || {
        rayon::in_place_scope(|scope| {
            scope.spawn(|_| inner.of(|| spend(LONG)));
            outer.of(|| {
                spend(LONG);
                assert_eq!(rayon::yield_now(), Some(Yield::Executed));
                spend(LONG);
            });
            spend(LONG);
        });
    });
    let (outer, inner) = (outer.time(), inner.time());
    assert!(outer >= 2 * LONG && inner >= LONG, "{outer:?} {inner:?}");
    assert!(outer + inner + LONG <= all, "{outer:?} {inner:?} {all:?}");
}

/// Two threads, each of which has to take one of two leaves.
#[test]
fn leaves_on_other_threads_work_for_the_same_account() {
    let (outer, inner) = (Account::default(), Account::default());
    let both = Barrier::new(2);
    let all = spent(2, || {
        outer.of(|| {
            let leaves = (0..2).into_par_iter();
            leaves.for_each_init(carried(), |_, _| {
                both.wait();
                spend(LONG);
                inner.of(|| spend(LONG));
                outer.of(|| spend(LONG));
            });
        });
        spend(LONG);
    });
    let (outer, inner) = (outer.time(), inner.time());
    assert!(
        outer >= 4 * LONG && inner >= 2 * LONG,
        "{outer:?} {inner:?}"
    );
    assert!(outer + inner + LONG <= all, "{outer:?} {inner:?} {all:?}");
}

/// Neither a leaf of work for no account, nor one that panics, leaves its thread to the wrong one.
#[test]
fn a_turn_ends_however_it_ends() {
    let (outer, inner) = (Account::default(), Account::default());
    let for_none = carried();
    let all = spent(1, || {
        outer.of(|| {
            let _turn = for_none();
            spend(LONG);
        });
        outer.of(|| {
            let panic = || inner.of(|| resume_unwind(Box::new("expected")));
            let ended = catch_unwind::<_, ()>(AssertUnwindSafe(panic));
            assert!(ended.is_err());
            spend(LONG);
        });
        spend(LONG);
    });
    let (outer, inner) = (outer.time(), inner.time());
    assert!(outer >= LONG && inner < LONG, "{outer:?} {inner:?}");
    assert!(
        outer + inner + 2 * LONG <= all,
        "{outer:?} {inner:?} {all:?}"
    );
}
