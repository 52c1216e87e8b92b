//! A computation beside the session: it can be watched, given up within a fifth of a second, and cannot take the
//! session down with it.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::watch::Watch;

/// Between two looks at whether the user wants to stop.
const LOOK: Duration = Duration::from_millis(20);

/// How the computation ended without a result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WorkerError {
    /// The user stopped it.
    #[error("interrupted: the session is as it was")]
    Interrupted,
    /// The system has no thread for it, usually for want of memory.
    #[error("nothing can be computed: the system gives no thread ({0}); free some memory, or raise the limit of it")]
    NoThread(String),
    /// It panicked: an error of this program.
    #[error("internal error in the computation ({0}): the session is as it was; please report the scenario")]
    Panicked(String),
}

/// What the computation sees of the one who waits for it.
#[derive(Default)]
struct WatchAdapter {
    stop: AtomicBool,
    progress: Mutex<Option<(String, f64)>>,
}

impl Watch for WatchAdapter {
    fn progress(&self, what: &str, done: f64) {
        let mut progress = self.progress.lock().unwrap_or_else(PoisonError::into_inner);
        *progress = Some((what.to_owned(), done));
    }

    fn stop(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// Runs `job` on a thread of its own and passes its progress on to `watch`.
///
/// When `watch` asks to stop, the job is told so and no longer waited for: a job inside a long factorization ends
/// by itself later and its result is dropped.
///
/// # Errors
/// [`WorkerError`] if it was stopped or panicked.
pub fn run<T: Send + 'static>(
    watch: &dyn Watch,
    job: impl FnOnce(&dyn Watch) -> T + Send + 'static,
) -> Result<T, WorkerError> {
    run_patiently(watch, Duration::ZERO, job)
}

/// As [`run`], for a job that has something to show when it is stopped: its result is waited for this long.
///
/// # Errors
/// As [`run`].
pub fn run_patiently<T: Send + 'static>(
    watch: &dyn Watch,
    patience: Duration,
    job: impl FnOnce(&dyn Watch) -> T + Send + 'static,
) -> Result<T, WorkerError> {
    let result = Arc::new(Mutex::new(None));
    let theirs = Arc::clone(&result);
    run_boxed(
        watch,
        patience,
        Box::new(move |watch| {
            let found = job(watch);
            *theirs.lock().unwrap_or_else(PoisonError::into_inner) = Some(found);
        }),
    )?;
    let found = result.lock().unwrap_or_else(PoisonError::into_inner).take();
    found.ok_or_else(|| WorkerError::Panicked("it left no result".to_owned()))
}

/// Work that leaves its result where its caller finds it.
type Job = Box<dyn FnOnce(&dyn Watch) + Send>;

/// As [`run_patiently`], compiled once, not for every kind of result.
fn run_boxed(watch: &dyn Watch, patience: Duration, job: Job) -> Result<(), WorkerError> {
    if watch.stop() {
        return Err(WorkerError::Interrupted);
    }
    let desk = Arc::new(WatchAdapter::default());
    let (sender, receiver) = mpsc::channel();
    let theirs = Arc::clone(&desk);
    let spawned = std::thread::Builder::new()
        .name("solver".to_owned())
        // deep elimination trees recurse
        .stack_size(64 << 20)
        .spawn(move || {
            let ended = catch_unwind(AssertUnwindSafe(|| job(&*theirs)));
            // the receiver is gone if the user gave up: nothing is left to say
            let _ = sender.send(ended);
        });
    if let Err(error) = spawned {
        return Err(WorkerError::NoThread(error.to_string()));
    }
    let mut stopped: Option<Instant> = None;
    loop {
        match receiver.recv_timeout(LOOK) {
            Ok(Ok(())) => return Ok(()),
            Ok(Err(panic)) => return Err(WorkerError::Panicked(panic_text(panic.as_ref()))),
            Err(RecvTimeoutError::Disconnected) => {
                return Err(WorkerError::Panicked("its thread vanished".to_owned()));
            }
            Err(RecvTimeoutError::Timeout) => {
                if watch.stop() {
                    desk.stop.store(true, Ordering::Relaxed);
                    if stopped.get_or_insert_with(Instant::now).elapsed() >= patience {
                        return Err(WorkerError::Interrupted);
                    }
                    continue;
                }
                let news = desk.progress.lock().unwrap_or_else(PoisonError::into_inner).clone();
                // At every look, new or not: whoever shows it now and then shows the latest.
                if let Some((what, done)) = news {
                    watch.progress(&what, done);
                }
            }
        }
    }
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> String {
    panic
        .downcast_ref::<&str>()
        .map(|text| (*text).to_owned())
        .or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "a panic without text".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Impatient(Instant);
    impl Watch for Impatient {
        fn progress(&self, _: &str, _: f64) {}
        fn stop(&self) -> bool {
            self.0.elapsed() > Duration::from_millis(50)
        }
    }

    #[test]
    fn a_job_that_does_not_listen_is_left_alone_in_time() {
        let start = Instant::now();
        let result = run(&Impatient(start), |_| std::thread::sleep(Duration::from_secs(2)));
        assert_eq!(result, Err(WorkerError::Interrupted));
        assert!(start.elapsed() < Duration::from_millis(200));
    }

    #[test]
    fn what_a_stopped_job_has_is_waited_for() {
        let start = Instant::now();
        let result = run_patiently(&Impatient(start), Duration::from_secs(5), |watch| {
            while !watch.stop() {
                std::thread::sleep(Duration::from_millis(1));
            }
            "half"
        });
        assert_eq!(result, Ok("half"));
    }

    #[test]
    fn a_panic_is_an_error() {
        let result: Result<(), _> = run(&crate::watch::Quiet, |_| panic!("no {}", 1));
        assert!(matches!(result, Err(WorkerError::Panicked(text)) if text == "no 1"));
    }
}
