//! An engine on a thread of its own: it answers one question while others wait for it, so that a device need not wait for the host.
//!
//! Without an engine, and from its first error on, there is none to ask: a device that has failed once is not asked again, so that a run
//! ends after one failure however many cells it has left.

use super::{CellDifference, Engine, EngineError, Question};
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, ScopedJoinHandle};
use std::time::{Duration, Instant};

/// Questions that an engine has at once: while it answers one, it gets the next one ready.
const AT_ONCE: usize = 2;

/// What an engine says to a question, and what it took.
struct Reply {
    answers: Result<Vec<CellDifference>, EngineError>,
    /// For which it had something to do since the last reply.
    busy: Duration,
}

/// The thread of an engine, as those see it who ask.
pub struct Worker {
    /// None without an engine that works.
    questions: Option<Sender<Arc<Question>>>,
    replies: Receiver<Reply>,
    /// The cells of the questions under way.
    cells: VecDeque<usize>,
    /// Why it works no more, if an engine failed.
    pub failure: Option<EngineError>,
    /// For which the engine had something to do.
    pub busy: Duration,
}

impl Worker {
    /// Does `work` with a worker for `engine`, whose thread ends before this returns.
    pub fn with<R>(engine: Option<&mut dyn Engine>, work: impl FnOnce(Self) -> R) -> R {
        thread::scope(|scope| {
            let (questions, asked) = channel();
            let (reply, replies) = channel();
            let serve = |engine| scope.spawn(move || serve(engine, &asked, &reply));
            let thread = engine.map(serve);
            let done = work(Self {
                questions: thread.is_some().then_some(questions),
                replies,
                cells: VecDeque::new(),
                failure: None,
                busy: Duration::ZERO,
            });
            // A thread that has panicked is a failure by now, or was not needed any more.
            let _ = thread.map(ScopedJoinHandle::join);
            done
        })
    }

    /// Whether there is an engine to ask.
    pub const fn is_working(&self) -> bool {
        self.questions.is_some()
    }

    /// Hands a question over.
    pub fn ask(&mut self, question: Arc<Question>) {
        let cells = question.cells();
        let Some(questions) = &self.questions else {
            return;
        };
        // Where the thread has ended, its last reply says why, or that there is none.
        let _ = questions.send(question);
        self.cells.push_back(cells);
    }

    /// The answers to the oldest question under way; `None` where there are none.
    pub fn answers(&mut self) -> Option<Vec<CellDifference>> {
        let asked = self.cells.pop_front()?;
        let Ok(reply) = self.replies.recv() else {
            let ended = "the engine's thread has panicked".to_owned();
            return self.give_up(EngineError::Device(ended));
        };
        self.busy += reply.busy;
        match reply.answers {
            Ok(answers) if answers.len() == asked => Some(answers),
            Ok(answers) => {
                let few = format!("{} answers for {asked} cells", answers.len());
                self.give_up(EngineError::Device(few))
            }
            Err(failure) => self.give_up(failure),
        }
    }

    /// Does without the engine from now on: so many of some `cells` of it were wrong.
    pub fn distrust(&mut self, differing: u64, cells: u64) {
        self.give_up(EngineError::Distrusted { differing, cells });
    }

    fn give_up(&mut self, failure: EngineError) -> Option<Vec<CellDifference>> {
        self.questions = None;
        self.cells.clear();
        self.failure = Some(failure);
        None
    }
}

/// Has `engine` answer what it is `asked` until there is nobody to ask, or to reply to. Unless it fails, nothing is left under way.
fn serve(engine: &mut dyn Engine, asked: &Receiver<Arc<Question>>, reply: &Sender<Reply>) {
    let (mut under_way, mut is_heard) = (0, true);
    let mut since = Instant::now();
    loop {
        let mut taken_on = Ok(());
        while is_heard && under_way < AT_ONCE && taken_on.is_ok() {
            let question = match under_way {
                0 => asked.recv().ok(),
                _ => asked.try_recv().ok(),
            };
            let Some(question) = question else { break };
            if under_way == 0 {
                since = Instant::now();
            }
            taken_on = engine.ask(question);
            under_way += 1;
        }
        if under_way == 0 {
            return;
        }
        let answers = taken_on.and_then(|()| engine.answer());
        under_way -= 1;
        let has_failed = answers.is_err();
        let now = Instant::now();
        let said = reply.send(Reply {
            answers,
            busy: now - since,
        });
        since = now;
        if has_failed {
            return;
        }
        is_heard &= said.is_ok();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::EngineDescription;
    use crate::shooting::Resolution;

    /// Has so many questions to answer, and fails, or panics, after so many answers.
    struct Counting {
        under_way: usize,
        answers: usize,
        most: usize,
        panics: bool,
    }

    impl Engine for Counting {
        fn describe(&self) -> EngineDescription {
            EngineDescription::of(None)
        }

        fn goal(&self) -> f64 {
            1.0
        }

        fn resolution(&self, resolution: Resolution) -> Resolution {
            resolution
        }

        fn ask(&mut self, _: Arc<Question>) -> Result<(), EngineError> {
            self.under_way += 1;
            Ok(())
        }

        fn answer(&mut self) -> Result<Vec<CellDifference>, EngineError> {
            if self.answers == self.most {
                assert!(!self.panics, "a panic on purpose");
                return Err(EngineError::Device("lost".to_owned()));
            }
            (self.under_way, self.answers) = (self.under_way - 1, self.answers + 1);
            Ok(Vec::new())
        }
    }

    /// What is left under way after `count` questions, how many were answered, and how many replies there were.
    fn served(count: usize, most: usize, is_heard: bool) -> (usize, usize, usize) {
        let mut engine = Counting {
            under_way: 0,
            answers: 0,
            most,
            panics: false,
        };
        let ((questions, asked), (reply, replies)) = (channel(), channel());
        for _ in 0..count {
            questions.send(Arc::default()).unwrap_or_default();
        }
        drop(questions);
        let replies = is_heard.then_some(replies);
        serve(&mut engine, &asked, &reply);
        let heard = replies.map_or(0, |replies| replies.try_iter().count());
        (engine.under_way, engine.answers, heard)
    }

    #[test]
    fn nothing_is_left_under_way() {
        assert_eq!(served(0, 9, true), (0, 0, 0));
        assert_eq!(served(5, 9, true), (0, 5, 5));
        // Nobody listens: what has been taken on is finished, and no more is.
        assert_eq!(served(5, 9, false), (0, AT_ONCE, 0));
        // The failure is the last reply.
        assert_eq!(served(5, 3, true), (AT_ONCE, 3, 4));
    }

    #[test]
    fn a_panic_of_an_engine_is_a_failure() {
        let mut engine = Counting {
            under_way: 0,
            answers: 0,
            most: 1,
            panics: true,
        };
        let heard = Worker::with(Some(&mut engine), |mut worker| {
            let answered = [(); 3].map(|()| {
                worker.ask(Arc::default());
                worker.answers().is_some()
            });
            (answered, worker.is_working(), worker.failure)
        });
        let (answered, is_working, failure) = heard;
        assert_eq!((answered, is_working), ([true, false, false], false));
        let failure = failure.map(|failure| failure.to_string());
        assert_eq!(
            failure.as_deref(),
            Some("GPU: the engine's thread has panicked")
        );
    }
}
