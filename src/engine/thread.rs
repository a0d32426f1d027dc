//! Work of an engine on a thread of its own.

use super::{Cells, Engine, EngineError, Nodes, RowBatch};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender};
use std::time::{Duration, Instant};
use whiskmap_mechanics::shooting::PlainState;

/// Batches that an engine has at once: it prepares one while it solves another.
const AT_ONCE: usize = 2;

/// Request to an engine.
pub enum Request {
    Cells(Arc<RowBatch>),
    Nodes(Arc<Nodes>),
}

/// Response to a request: the result, and the busy time since the previous response. After a failure, there is none.
pub type Response<R> = Result<(R, Duration), EngineError>;

/// Serves requests by `engine` until they end or responses are no longer received: `cells` in the order of their batches, and `states` of nodes.
/// Unless the engine fails, no batch stays submitted.
pub fn serve(
    engine: &mut dyn Engine,
    requested: &Receiver<Request>,
    cells: &Sender<Response<Cells>>,
    states: &Sender<Response<Vec<PlainState>>>,
) {
    let (mut submitted, mut is_received) = (0, true);
    let mut since = Instant::now();
    loop {
        let request = match submitted {
            _ if !is_received => None,
            0 => requested.recv().ok(),
            1..AT_ONCE => requested.try_recv().ok(),
            _ => None,
        };
        if submitted == 0 {
            since = Instant::now();
        }
        let sent = match request {
            Some(Request::Cells(batch)) => match engine.submit(batch) {
                Ok(()) => {
                    submitted += 1;
                    continue;
                }
                Err(failure) => Err(failure),
            },
            Some(Request::Nodes(nodes)) => {
                let found = engine.shoot_nodes(&nodes);
                found.map(|found| send(states, found, &mut since))
            }
            None if submitted == 0 => return,
            None => {
                submitted -= 1;
                let solved = engine.collect();
                solved.map(|solved| send(cells, solved, &mut since))
            }
        };
        match sent {
            Ok(sent) => is_received &= sent,
            Err(failure) => {
                // Whatever the caller waits for. A caller that no longer receives has ended.
                let _ = (cells.send(Err(failure.clone())), states.send(Err(failure)));
                return;
            }
        }
    }
}

/// Sends the result of a request, for which the engine has been busy `since` the previous one. Returns false if it is not received.
fn send<R>(to: &Sender<Response<R>>, result: R, since: &mut Instant) -> bool {
    let now = Instant::now();
    let busy = now - std::mem::replace(since, now);
    to.send(Ok((result, busy))).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{EngineDescription, Worker};
    use std::sync::mpsc::channel;
    use whiskmap_mechanics::shooting::batch::Method;

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

        fn has_device(&self) -> bool {
            true
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
        Counting { submitted: 0, collected: 0, most, panics }
    }

    fn nothing() -> Arc<RowBatch> {
        Arc::new(RowBatch::new(Method::fine(), [].into(), []))
    }

    /// Returns how many of `count` batches stay submitted, how many are collected, and the number of responses.
    fn served(count: usize, most: usize, is_received: bool) -> (usize, usize, usize) {
        let mut engine = counting(most, false);
        let ((requests, requested), (cells, responses)) = (channel(), channel());
        for _ in 0..count {
            requests.send(Request::Cells(nothing())).unwrap_or_default();
        }
        drop(requests);
        let responses = is_received.then_some(responses);
        let (states, _) = channel();
        serve(&mut engine, &requested, &cells, &states);
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
        let (collected, is_working, failure) = Worker::with(Some(&mut engine), |mut worker| {
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
