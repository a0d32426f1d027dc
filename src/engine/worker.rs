//! Worker: the connection to an engine. A device's engine has a thread of its own: while it solves one batch, the next one waits there,
//! so that the device never waits for the host. An engine of the CPU works on the threads of the current pool, where it is called.
//!
//! After its first failure an engine gets no further batch.

use super::thread::{Request, Response, serve};
use super::{Cells, Engine, EngineError, Nodes, RowBatch};
use crate::stopwatch::Stopwatch;
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Duration;
use whiskmap_mechanics::shooting::PlainState;

/// Connection to an engine.
enum Connection<'e> {
    /// The engine has a thread of its own.
    Thread {
        requests: Sender<Request>,
        cells: Receiver<Response<Cells>>,
        states: Receiver<Response<Vec<PlainState>>>,
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
    /// Number of trajectories of nets that the engine has integrated.
    pub trajectories: u64,
    /// Maximum residual bound of a cell that the engine solves, in whisker lengths; 0 without an engine.
    pub residual_bound: f64,
    /// Maximum residual of the rows that the engine evaluates, in whisker lengths; `None` without an engine.
    pub row_residual: Option<f64>,
    /// Failure for which the engine is disabled; `None` if it has not failed.
    pub failure: Option<EngineError>,
    /// Wall time in which the engine worked on batches, summed over all responses.
    pub busy: Duration,
}

impl<'e> Worker<'e> {
    /// Calls `work` with a worker for `engine`. An engine with a device has a thread, which ends before this returns; others work where they are
    /// called.
    pub fn with<R>(engine: Option<&'e mut (dyn Engine + 'e)>, work: impl FnOnce(Self) -> R) -> R {
        let known = engine.as_ref();
        let residual_bound = known.map_or(0.0, |engine| engine.residual_bound());
        let row_residual = known.map(|engine| engine.row_residual());
        let worker = |connection| Self {
            connection,
            residual_bound,
            row_residual,
            trajectories: 0,
            submitted: VecDeque::new(),
            failure: None,
            busy: Duration::ZERO,
        };
        let Some(engine) = engine else {
            return work(worker(None));
        };
        if !engine.has_device() {
            return work(worker(Some(Connection::Call(engine))));
        }
        thread::scope(|scope| {
            let (requests, requested) = channel();
            let ((to_cells, cells), (to_states, states)) = (channel(), channel());
            let serve = move || serve(engine, &requested, &to_cells, &to_states);
            let thread = scope.spawn(serve);
            let done = work(worker(Some(Connection::Thread { requests, cells, states })));
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
                let _ = requests.send(Request::Cells(Arc::clone(&batch)));
            }
            Some(Connection::Call(_)) => {}
        }
        self.submitted.push_back(batch);
    }

    /// Waits for the cells of the oldest batch submitted; `None` if there is no such batch or the engine failed.
    pub fn collect(&mut self) -> Option<Cells> {
        let batch = self.submitted.pop_front()?;
        let response = match self.connection.as_mut()? {
            Connection::Thread { cells, .. } => cells.recv().ok(),
            Connection::Call(engine) => {
                let begun = Stopwatch::start();
                let taken = engine.submit(Arc::clone(&batch));
                let cells = taken.and_then(|()| engine.collect());
                Some(cells.map(|cells| (cells, begun.elapsed())))
            }
        };
        let cells = self.result(response)?;
        if cells.fit(&batch) {
            return Some(cells);
        }
        let (found, wanted) = (cells.len(), batch.cells());
        let short = format!("a response of {found} cells to a request of {wanted}");
        self.disable(EngineError::Device(short));
        None
    }

    /// Submits the trajectories of `nodes` to the engine's thread; does nothing without it.
    pub fn submit_nodes(&mut self, nodes: &Arc<Nodes>) {
        if let Some(Connection::Thread { requests, .. }) = &self.connection {
            // If the thread has ended, `collect_states` finds no response.
            let _ = requests.send(Request::Nodes(Arc::clone(nodes)));
        }
    }

    /// Waits for the states of `nodes`, the oldest ones submitted and not collected: `[trajectory]`, rod by rod. `None` without an engine's
    /// thread, or if the engine failed.
    pub fn collect_states(&mut self, nodes: &Nodes) -> Option<Vec<PlainState>> {
        let Some(Connection::Thread { states, .. }) = &self.connection else {
            return None;
        };
        let response = states.recv().ok();
        let states = self.result(response)?;
        let (found, wanted) = (states.len(), nodes.count());
        if found == wanted {
            self.trajectories += wanted as u64;
            return Some(states);
        }
        let short = format!("{found} states of {wanted} trajectories");
        self.disable(EngineError::Device(short));
        None
    }

    /// Returns the result of a response; without one, the engine's thread has ended. After a failure, the engine is disabled.
    fn result<R>(&mut self, response: Option<Response<R>>) -> Option<R> {
        let ended = || EngineError::Device("the engine's thread has panicked".to_owned());
        match response.unwrap_or_else(|| Err(ended())) {
            Ok((result, busy)) => {
                self.busy += busy;
                Some(result)
            }
            Err(failure) => {
                self.disable(failure);
                None
            }
        }
    }

    /// Disables the engine after `differing` of `cells` audited cells failed.
    pub fn fail_audit(&mut self, differing: u64, cells: u64) {
        self.disable(EngineError::FailedAudit { differing, cells });
    }

    fn disable(&mut self, failure: EngineError) {
        self.connection = None;
        self.submitted.clear();
        self.failure = Some(failure);
    }
}
