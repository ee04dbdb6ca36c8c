//! Threads that answer reads.

use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

type Job = Box<dyn FnOnce() + Send>;

/// A few threads that take jobs in the order in which they come. They end when the value goes.
pub(super) struct Workers {
    jobs: Sender<Job>,
}

/// A check of the whole project, findings of what was just typed, and what the user asks meanwhile.
const COUNT: usize = 4;

impl Workers {
    pub(super) fn new() -> Self {
        let (jobs, queue) = channel::<Job>();
        let queue = Arc::new(Mutex::new(queue));
        for number in 0..COUNT {
            let queue = queue.clone();
            let run = move || {
                loop {
                    let job = queue.lock().unwrap_or_else(PoisonError::into_inner).recv();
                    match job {
                        Ok(job) => job(),
                        Err(_) => break,
                    }
                }
            };
            // Without any thread, requests stay unanswered; nothing better can be done then.
            let _ = thread::Builder::new().name(format!("worker {number}")).stack_size(16 << 20).spawn(run);
        }
        Self { jobs }
    }

    pub(super) fn run(&self, job: impl FnOnce() + Send + 'static) {
        // Fails when all threads are gone.
        let _ = self.jobs.send(Box::new(job));
    }
}
