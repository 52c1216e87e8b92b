//! The session on a thread of its own: jobs go in, results come out.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{self, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use std::{io, thread};

use crate::session::language::tokens::quote;
use crate::session::{CommandError, Next, Output, Session};
use crate::view::style::Style;
use crate::watch::Watch;

use super::action::{Action, Done, Job, Loading};
use super::shown::Shown;
use super::vary;

/// Shorter work shows no progress.
const PATIENCE: Duration = Duration::from_millis(400);
/// Between two looks at the progress.
const PACE: Duration = Duration::from_millis(250);

/// What follows the states of a slider or a pivot waits this long for the next one: longer than between two repeats of
/// a held key.
const QUIET: Duration = Duration::from_millis(40);

/// Does one job after `last` was shown. The session is as it was if it fails.
pub fn perform(session: &mut Session, last: &Shown, job: Job, style: Style, watch: &dyn Watch) -> Done {
    let mut output = Vec::new();
    let (mut answers, mut gauges, mut glance, mut asked) = (None, None, None, Vec::new());
    // what is not a command does not ask for it by itself
    let ready = if matches!(job, Job::Set { .. } | Job::Vary { .. }) { Ok(()) } else { session.ensure_whole(watch) };
    let result = ready.and_then(|()| match &job {
        Job::Set { name, value } => slide(session, (name, *value), &mut output, style, watch),
        Job::Vary { name, tenths } => match varied(session, name, tenths) {
            Some(value) => slide(session, (name, value), &mut output, style, watch),
            None => Ok(Next::Continue),
        },
        Job::Step(step) => run(session, &format!("step to {step}"), &mut output, style, watch),
        Job::Line { text, .. } => run(session, text, &mut output, style, watch),
        Job::Pivots => session.ensure_pivots(&mut Output::text(&mut output, style, watch)).map(|()| Next::Continue),
        Job::Show(loading) => show(session, loading, &mut output, style, watch),
        Job::Motion => Ok(Next::Continue),
        Job::Quantities(asked) => {
            let values = session.gauges(asked, last.stage, watch);
            if watch.stop() {
                Err(CommandError::Interrupted)
            } else {
                gauges = Some(values);
                Ok(Next::Continue)
            }
        }
        Job::Remedies => session.ensure_remedies(watch).map(|()| Next::Continue),
        Job::Glance { settings } => session.glance(settings, watch).map(|found| {
            glance = Some(found);
            Next::Continue
        }),
        Job::Answers => session.all_answers(watch).map(|found| {
            answers = Some(found);
            Next::Continue
        }),
    });
    if let (Job::Line { text, .. }, Ok(_)) = (&job, &result) {
        asked = session.quantities_asked(text);
    }
    let (next, error, interrupted) = match result {
        Ok(next) => (next, None, false),
        Err(error) => {
            let interrupted = error.is_interrupted();
            (Next::Continue, Some(error.to_string()), interrupted)
        }
    };
    let shown = match (&job, glance) {
        (Job::Glance { settings: [(_, x), (_, y)] }, Some(glance)) => Shown::beside(last, session, glance, [*x, *y]),
        (Job::Show(Loading::Stage(stage)), _) => Shown::after(last, session).at_stage(*stage, session),
        (Job::Motion, _) if !watch.stop() => {
            let mut shown = Shown::after(last, session);
            shown.complete(session);
            shown
        }
        _ => Shown::after(last, session),
    };
    Done {
        job,
        shown: Arc::new(shown),
        output: String::from_utf8_lossy(&output).into_owned(),
        error,
        interrupted,
        next,
        answers,
        gauges,
        asked,
    }
}

/// Moves a slider: states and forces of the pairs come ahead of the rest.
fn slide(
    session: &mut Session,
    (name, value): (&str, f64),
    output: &mut Vec<u8>,
    style: Style,
    watch: &dyn Watch,
) -> Result<Next, CommandError> {
    let mut io = Output::text(output, style, watch);
    io.joints_first = true;
    session.execute(&format!("set {name} {value}"), &mut io)
}

/// The value of a slider after these keys; `None` where it is not a slider of the scenario any more.
fn varied(session: &Session, name: &str, tenths: &[i8]) -> Option<f64> {
    let parameter = session.scenario().parameters.get(name)?;
    let now = *session.values().get(name)?;
    Some(tenths.iter().fold(now, |value, tenths| vary::varied(value, parameter, *tenths)))
}

/// The answer under another loading. A history that was followed serves all its stages.
fn show(
    session: &mut Session,
    loading: &Loading,
    output: &mut Vec<u8>,
    style: Style,
    watch: &dyn Watch,
) -> Result<Next, CommandError> {
    match loading {
        Loading::Own => run(session, "solve", output, style, watch),
        Loading::Combination(name) => run(session, &format!("combine {}", quote(name)), output, style, watch),
        Loading::Stage(stage) => {
            if session.history_followed().is_none() {
                session.follow_stages(watch)?;
            }
            session.stage_answer(stage + 1).map(|_| Next::Continue)
        }
    }
}

fn run(
    session: &mut Session,
    line: &str,
    output: &mut Vec<u8>,
    style: Style,
    watch: &dyn Watch,
) -> Result<Next, CommandError> {
    let mut io = Output::text(output, style, watch);
    io.has_screen = true;
    session.execute(line, &mut io)
}

/// Job number, job, look of its output.
type Order = (u64, Job, Style);

/// The thread of the session.
pub struct Worker {
    orders: Sender<Order>,
    thread: JoinHandle<Session>,
    given: u64,
    stopped: Arc<AtomicU64>,
}

impl Worker {
    /// Starts the thread; it reports by `send`.
    ///
    /// # Errors
    /// The system has no thread; the session is lost then, which ends the program.
    pub fn start(mut session: Session, send: impl Fn(Action) + Send + Sync + 'static) -> io::Result<Worker> {
        let (orders, incoming) = mpsc::channel::<Order>();
        let stopped = Arc::new(AtomicU64::new(0));
        let asked = Arc::clone(&stopped);
        let work = move || {
            let mut last = Arc::new(Shown::of(&session));
            while let Ok((number, job, style)) = incoming.recv() {
                let watch =
                    WatchAdapter { number, stopped: &asked, send: &send, since: Mutex::new((Instant::now(), None)) };
                let kept = job.clone();
                if matches!(job, Job::Pivots | Job::Motion) {
                    watch.wait(QUIET);
                }
                let done = catch_unwind(AssertUnwindSafe(|| perform(&mut session, &last, job, style, &watch)));
                let done = done.unwrap_or_else(|_| Done {
                    job: kept,
                    shown: Arc::new(Shown::of(&session)),
                    output: String::new(),
                    error: Some("an error of this program: the command was not carried out; please report it".into()),
                    interrupted: false,
                    next: Next::Continue,
                    answers: None,
                    gauges: None,
                    asked: Vec::new(),
                });
                last = Arc::clone(&done.shown);
                send(Action::Done(Box::new(done)));
            }
            session
        };
        let thread = thread::Builder::new().name("session".to_owned()).spawn(work)?;
        Ok(Worker { orders, thread, given: 0, stopped })
    }

    /// Gives a job.
    pub fn order(&mut self, job: Job, style: Style) {
        self.given += 1;
        // the thread lives as long as its orders can come
        let _ = self.orders.send((self.given, job, style));
    }

    /// The jobs given so far are to stop.
    pub fn stop(&self) {
        self.stopped.store(self.given, Ordering::Relaxed);
    }

    /// Stops what is at work and gives the session back.
    ///
    /// # Errors
    /// The thread is gone, and the session with it.
    pub fn end(self) -> io::Result<Session> {
        self.stop();
        drop(self.orders);
        self.thread.join().map_err(|_| io::Error::other("the thread of the session ended by an error of this program"))
    }
}

/// What the computation sees of the screen.
struct WatchAdapter<'a> {
    number: u64,
    stopped: &'a AtomicU64,
    send: &'a (dyn Fn(Action) + Sync),
    /// When it began, and when progress was last told.
    since: Mutex<(Instant, Option<Instant>)>,
}

impl WatchAdapter<'_> {
    /// Lets this time pass, unless it is asked to stop.
    fn wait(&self, time: Duration) {
        const LOOK: Duration = Duration::from_millis(2);
        while !self.stop() && self.since.lock().unwrap_or_else(PoisonError::into_inner).0.elapsed() < time {
            thread::sleep(LOOK);
        }
    }
}

impl Watch for WatchAdapter<'_> {
    fn progress(&self, what: &str, fraction: f64) {
        let mut since = self.since.lock().unwrap_or_else(PoisonError::into_inner);
        let due = since.1.is_none_or(|last| last.elapsed() >= PACE);
        if since.0.elapsed() < PATIENCE || !due {
            return;
        }
        since.1 = Some(Instant::now());
        (self.send)(Action::Progress { what: what.to_owned(), fraction });
    }

    fn stop(&self) -> bool {
        self.stopped.load(Ordering::Relaxed) >= self.number
    }
}
