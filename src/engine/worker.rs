//! Worker: the connection to an engine. A device's engine has a thread of its own: while it solves one batch, the next one waits there,
//! so that the device never waits for the host. An engine of the CPU works on the threads of the current pool, where it is called.
//!
//! After its first failure an engine gets no further batch.

use super::{Cells, Engine, EngineError, RowBatch};
use crate::stopwatch::Stopwatch;
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

/// Batches that an engine has at once: it prepares one while it solves another.
const AT_ONCE: usize = 2;

/// Response to a batch.
struct Response {
    cells: Result<Cells, EngineError>,
    /// Busy time since the previous response.
    busy: Duration,
}

/// Connection to an engine.
enum Connection<'e> {
    /// The engine has a thread of its own.
    Thread {
        requests: Sender<Arc<RowBatch>>,
        responses: Receiver<Response>,
    },
    /// The engine is called when its cells are collected.
    Call(&'e mut (dyn Engine + 'e)),
}

/// Worker: a handle to an engine.
pub struct Worker<'e> {
    /// None without an engine, and after its failure.
    connection: Option<Connection<'e>>,
    /// The batches submitted and not collected.
    submitted: VecDeque<Arc<RowBatch>>,
    /// Maximum residual bound of a cell that the engine solves, in whisker lengths; 0 without an engine.
    pub residual_bound: f64,
    /// Failure for which the engine is disabled; `None` if it has not failed.
    pub failure: Option<EngineError>,
    /// Wall time in which the engine worked on batches, summed over all responses.
    pub busy: Duration,
}

impl<'e> Worker<'e> {
    /// Calls `work` with a worker for `engine`, whose thread ends before this returns. Without `has_thread`, the engine works where it is
    /// called.
    pub fn with<R>(
        engine: Option<&'e mut (dyn Engine + 'e)>,
        has_thread: bool,
        work: impl FnOnce(Self) -> R,
    ) -> R {
        let residual_bound = engine.as_ref().map_or(0.0, |own| own.residual_bound());
        let worker = |connection| Self {
            connection,
            residual_bound,
            submitted: VecDeque::new(),
            failure: None,
            busy: Duration::ZERO,
        };
        let Some(engine) = engine else {
            return work(worker(None));
        };
        if !has_thread {
            return work(worker(Some(Connection::Call(engine))));
        }
        thread::scope(|scope| {
            let (requests, requested) = channel();
            let (respond, responses) = channel();
            let thread = scope.spawn(move || serve(engine, &requested, &respond));
            let done = work(worker(Some(Connection::Thread {
                requests,
                responses,
            })));
            // A panic of the thread is in `failure` by now, or no cells were collected after it.
            let _ = thread.join();
            done
        })
    }

    /// Returns true if there is an engine that has not failed.
    #[must_use]
    pub const fn is_working(&self) -> bool {
        self.connection.is_some()
    }

    /// Returns true if the engine has a thread of its own, and so solves batches in parallel with the caller.
    #[must_use]
    pub const fn has_thread(&self) -> bool {
        matches!(self.connection, Some(Connection::Thread { .. }))
    }

    /// Submits a batch to the engine; does nothing without a working engine.
    pub fn submit(&mut self, batch: Arc<RowBatch>) {
        match &self.connection {
            None => return,
            // If the thread has ended, its last response is the failure, or `collect` finds none.
            Some(Connection::Thread { requests, .. }) => {
                let _ = requests.send(Arc::clone(&batch));
            }
            Some(Connection::Call(_)) => {}
        }
        self.submitted.push_back(batch);
    }

    /// Waits for the cells of the oldest batch submitted; `None` if there is no such batch or the engine failed.
    pub fn collect(&mut self) -> Option<Cells> {
        let batch = self.submitted.pop_front()?;
        let response = match self.connection.as_mut()? {
            Connection::Thread { responses, .. } => responses.recv().ok(),
            Connection::Call(engine) => {
                let begun = Stopwatch::start();
                let taken = engine.submit(Arc::clone(&batch));
                Some(Response {
                    cells: taken.and_then(|()| engine.collect()),
                    busy: begun.elapsed(),
                })
            }
        };
        let Some(response) = response else {
            let ended = "the engine's thread has panicked".to_owned();
            return self.disable(EngineError::Device(ended));
        };
        self.busy += response.busy;
        match response.cells {
            Ok(cells) if cells.fit(&batch) => Some(cells),
            Ok(cells) => {
                let (found, wanted) = (cells.len(), batch.cells());
                let short = format!("a response of {found} cells to a request of {wanted}");
                self.disable(EngineError::Device(short))
            }
            Err(failure) => self.disable(failure),
        }
    }

    /// Disables the engine after `differing` of `cells` audited cells failed.
    pub fn fail_audit(&mut self, differing: u64, cells: u64) {
        self.disable(EngineError::FailedAudit { differing, cells });
    }

    fn disable(&mut self, failure: EngineError) -> Option<Cells> {
        self.connection = None;
        self.submitted.clear();
        self.failure = Some(failure);
        None
    }
}

/// Solves the `requested` batches by `engine` until the requests end or responses are no longer received. Unless the engine fails, no batch
/// stays submitted.
fn serve(engine: &mut dyn Engine, requested: &Receiver<Arc<RowBatch>>, respond: &Sender<Response>) {
    let (mut submitted, mut is_received) = (0, true);
    let mut since = Instant::now();
    loop {
        let mut taken = Ok(());
        while is_received && submitted < AT_ONCE && taken.is_ok() {
            let batch = match submitted {
                0 => requested.recv().ok(),
                _ => requested.try_recv().ok(),
            };
            let Some(batch) = batch else { break };
            if submitted == 0 {
                since = Instant::now();
            }
            taken = engine.submit(batch);
            submitted += 1;
        }
        if submitted == 0 {
            return;
        }
        let cells = taken.and_then(|()| engine.collect());
        submitted -= 1;
        let has_failed = cells.is_err();
        let now = Instant::now();
        let busy = now - since;
        is_received &= respond.send(Response { cells, busy }).is_ok();
        since = now;
        if has_failed {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::EngineDescription;
    use crate::shooting::batch::Method;

    /// Fails, or panics, after `most` batches.
    struct Counting {
        submitted: usize,
        collected: usize,
        most: usize,
        panics: bool,
    }

    impl Engine for Counting {
        fn describe(&self) -> EngineDescription {
            EngineDescription::of(None)
        }

        fn residual_bound(&self) -> f64 {
            1.0
        }

        fn submit(&mut self, _: Arc<RowBatch>) -> Result<(), EngineError> {
            self.submitted += 1;
            Ok(())
        }

        fn collect(&mut self) -> Result<Cells, EngineError> {
            if self.collected == self.most {
                assert!(!self.panics, "a panic on purpose");
                return Err(EngineError::Device("lost".to_owned()));
            }
            (self.submitted, self.collected) = (self.submitted - 1, self.collected + 1);
            Ok(Cells::default())
        }
    }

    fn counting(most: usize, panics: bool) -> Counting {
        Counting {
            submitted: 0,
            collected: 0,
            most,
            panics,
        }
    }

    fn nothing() -> Arc<RowBatch> {
        Arc::new(RowBatch::new(Method::fine(), [].into(), [].into(), []))
    }

    /// Returns how many of `count` batches stay submitted, how many are collected, and the number of responses.
    fn served(count: usize, most: usize, is_received: bool) -> (usize, usize, usize) {
        let mut engine = counting(most, false);
        let ((requests, requested), (respond, responses)) = (channel(), channel());
        for _ in 0..count {
            requests.send(nothing()).unwrap_or_default();
        }
        drop(requests);
        let responses = is_received.then_some(responses);
        serve(&mut engine, &requested, &respond);
        let received = responses.map_or(0, |responses| responses.try_iter().count());
        (engine.submitted, engine.collected, received)
    }

    #[test]
    fn no_batch_stays_submitted() {
        assert_eq!(served(0, 9, true), (0, 0, 0));
        assert_eq!(served(5, 9, true), (0, 5, 5));
        // Without a receiver, only what has been submitted is finished.
        assert_eq!(served(5, 9, false), (0, AT_ONCE, 0));
        // The failure is the last response.
        assert_eq!(served(5, 3, true), (AT_ONCE, 3, 4));
    }

    #[test]
    fn a_panic_of_an_engine_is_a_failure() {
        let mut engine = counting(1, true);
        let (collected, is_working, failure) =
            Worker::with(Some(&mut engine), true, |mut worker| {
                let collected = [(); 3].map(|()| {
                    worker.submit(nothing());
                    worker.collect().is_some()
                });
                (collected, worker.is_working(), worker.failure)
            });
        assert_eq!((collected, is_working), ([true, false, false], false));
        let failure = failure.map(|failure| failure.to_string());
        let wanted = "GPU: the engine's thread has panicked";
        assert_eq!(failure.as_deref(), Some(wanted));
    }
}
