//! Threads that answer reads.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, Thread};

type Job = Box<dyn FnOnce() + Send>;

/// A few threads that take jobs in the order in which they come. They end when the value goes.
///
/// The thread that was busy last is the first to be busy again: it has what the next edit needs in its caches.
pub(super) struct Workers {
    shared: Arc<Shared>,
}

#[derive(Default)]
struct Shared(Mutex<Queue>);

#[derive(Default)]
struct Queue {
    jobs: VecDeque<Job>,
    /// Threads that wait, the one that was busy last on top.
    idle: Vec<Thread>,
    is_closed: bool,
}

/// A check of the whole project, findings of what was just typed, and what the user asks meanwhile.
const COUNT: usize = 4;

impl Workers {
    pub(super) fn new() -> Self {
        let shared = Arc::new(Shared::default());
        for number in 0..COUNT {
            let shared = shared.clone();
            let run = move || {
                while let Some(job) = shared.next() {
                    job();
                }
            };
            // Without any thread, requests stay unanswered; nothing better can be done then.
            let _ = thread::Builder::new().name(format!("worker {number}")).stack_size(16 << 20).spawn(run);
        }
        Self { shared }
    }

    pub(super) fn run(&self, job: impl FnOnce() + Send + 'static) {
        let mut queue = self.shared.queue();
        queue.jobs.push_back(Box::new(job));
        if let Some(thread) = queue.idle.pop() {
            thread.unpark();
        }
    }
}

impl Drop for Workers {
    fn drop(&mut self) {
        let mut queue = self.shared.queue();
        queue.is_closed = true;
        queue.idle.drain(..).for_each(|it| it.unpark());
    }
}

impl Shared {
    fn queue(&self) -> MutexGuard<'_, Queue> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for a job; `None` when there will be no more.
    fn next(&self) -> Option<Job> {
        let own = thread::current();
        loop {
            let mut queue = self.queue();
            // Nobody may have woken it.
            queue.idle.retain(|it| it.id() != own.id());
            if let Some(job) = queue.jobs.pop_front() {
                return Some(job);
            }
            if queue.is_closed {
                return None;
            }
            queue.idle.push(own.clone());
            drop(queue);
            thread::park();
        }
    }
}
