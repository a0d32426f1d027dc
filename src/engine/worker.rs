//! Worker: the connection to an engine. A device's engine has a thread of its own: while it solves one batch, the next one waits there,
//! so that the device never waits for the host. An engine of the CPU works on the threads of the current pool, where it is called.
//!
//! After its first failure an engine gets no further batch.

use super::thread::{Response, serve};
use super::{Cells, Engine, EngineError, RowBatch};
use crate::stopwatch::Stopwatch;
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Duration;

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
